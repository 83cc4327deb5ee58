//! Motion studies: a row for every place along the drives' laws.

use std::sync::Arc;

use kempe_measure::measure::visit_leaves;
use kempe_mechanism::Mechanism;
use kempe_model::{Diagnostic, Drive, Leaf, Measure, Model, MotionStudy, Statistic};
use kempe_motion::Motion;
use kempe_motion::drive_path::{DrivePath, is_cycle};
use kempe_units::Dimension;

use crate::along::Along;
use crate::columns::Asked;
use crate::events::events;
use crate::force_columns::standard_plots;
use crate::force_notes::unbounded;
use crate::missing::{Lack, row_warnings, without_value};
use crate::motion_findings::{motion_findings, refused};
use crate::prepared::{design, motion};
use crate::quantity::Quantity;
use crate::result::StudyResult;
use crate::rows::places_along;
use crate::sink::RowSink;
use crate::slots_along::slots_left;
use crate::table::Column;
use crate::unit::Units;
use crate::weak_between::weak_between;
use kempe_motion::progress::{Done, Progress, Stage};

/// Rows along the drives' laws, with forces or without.
pub(crate) fn run_along(
    model: &Model,
    name: &str,
    study: &MotionStudy,
    forces: bool,
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    run_along_with(model, name, study, (forces, &[]), progress).map(|(result, _)| result)
}

/// The same with values (SI) of what is `hidden` in no column, by row.
pub(crate) fn run_along_with(
    model: &Model,
    name: &str,
    study: &MotionStudy,
    (forces, hidden): (bool, &[Quantity]),
    progress: &mut dyn Progress,
) -> Result<(StudyResult, Vec<Vec<f64>>), Vec<Diagnostic>> {
    let motion = motion(&design(model), progress)?;
    let diagnostics = motion_findings(&motion);
    if refused(&motion) {
        return Err(diagnostics);
    }
    let along = abscissa(&motion, &motion.design.parameters);
    let shown = motion.mechanism().clone();
    match rows_of(
        &motion,
        &shown,
        name,
        study,
        (forces, along, hidden),
        progress,
    ) {
        Ok((mut result, values)) => {
            result.diagnostics.splice(0..0, diagnostics);
            Ok((result, values))
        }
        Err(refused) => Err([diagnostics, refused].concat()),
    }
}

/// Rows along a motion, with forces or without, and the column that they run along; the values (SI) of what is `hidden` in no
/// column, by row. What is `shown` is the mechanism that was asked about: that of the motion, or the one for which its drives stand in.
pub(crate) fn rows_of(
    motion: &Arc<Motion>,
    shown: &Arc<Mechanism>,
    name: &str,
    study: &MotionStudy,
    (forces, along, hidden): (bool, usize, &[Quantity]),
    progress: &mut dyn Progress,
) -> Result<(StudyResult, Vec<Vec<f64>>), Vec<Diagnostic>> {
    let design = &motion.design;
    let model = &shown.model;
    let mut diagnostics = Vec::new();
    let mut study = study.clone();
    if forces && study.plots.is_empty() {
        study.plots = standard_plots(shown);
    }
    let mut asked = if forces {
        Asked::of_forces(shown, &study)
    } else {
        Asked::of_motion(model, &study)
    };
    asked.hidden = hidden.to_vec();
    let quantities: Vec<&Quantity> = asked.all().collect();
    let places = places_along(motion, &study, &design.parameters);
    let mut sampler = Along::with_progress(model, motion, &quantities, forces, &places, progress)?;
    let units = Units::of(model);
    let mut rows = RowSink::new(
        name,
        model,
        &units,
        &asked,
        Column::new("time", units.unit(Dimension::TIME)),
    );
    let mut frames = Vec::with_capacity(places.len());
    let mut parameters_met = Vec::with_capacity(places.len());
    for (done, place) in places.iter().enumerate() {
        let row = sampler.row(*place);
        parameters_met.push(row.sample.parameter);
        frames.push(rows.push(&design.mechanism, row.sample.time, row));
        if progress
            .reached(Stage::Rows, Done::Of(done + 1, places.len()))
            .is_break()
        {
            break;
        }
    }
    diagnostics.extend(row_warnings(name, &rows.table, along));
    diagnostics.extend(rows.force_warnings(&design.mechanism, along));
    if forces {
        diagnostics.extend(weak_between(name, motion, &mut sampler, &rows.force_notes));
    }
    diagnostics.extend(sampler.number_warnings(Some(name), &quantities));
    diagnostics.extend(without_value(&rows, along, |index| {
        let number = index.and_then(|index| asked.scalars.get(index));
        let of_cycles = number.is_some_and(|q| asks_time_ratio(shown, &q.measure));
        match of_cycles {
            true if is_cycle(model, &design.parameters) => Lack::Return,
            true => Lack::Cycle,
            false => Lack::Somewhere,
        }
    }));
    diagnostics.extend(slots_left(model, name, motion, &frames));
    let met = events(motion, &parameters_met);
    if forces {
        diagnostics.extend(unbounded(shown, (&asked.scalars, &rows.scalars), &met));
    }
    let hidden = std::mem::take(&mut rows.hidden);
    let result = StudyResult {
        name: name.to_owned(),
        events: met,
        scalars: rows.scalars.clone(),
        figures: rows.figures(&study.plots),
        table: rows.table,
        frames,
        beside: Vec::new(),
        contacts: Vec::new(),
        happenings: Vec::new(),
        listings: Vec::new(),
        shapes: Vec::new(),
        designs: Vec::new(),
        along,
        assemblies: (motion.assemblies.list.len(), motion.assemblies.rejected),
        diagnostics,
        demanded_rows: places.len(),
        stopped_at: None,
    };
    Ok((result, hidden))
}

/// Whether a measure asks for a time ratio, itself or by another measure.
fn asks_time_ratio(mechanism: &Mechanism, measure: &Measure) -> bool {
    let mut found = false;
    visit_leaves(mechanism, measure, &mut |leaf| {
        found |= matches!(leaf, Leaf::Over(Statistic::TimeRatio, _));
    });
    found
}

/// The column that rows run along: the drive that goes one way through the whole motion, or else time.
pub(crate) fn abscissa(motion: &Motion, parameters: &[f64]) -> usize {
    let model = &motion.mechanism().model;
    let DrivePath::Coordinate { drive, .. } = motion.path else {
        return 0;
    };
    let one_way = (model.drives.get(drive)).is_some_and(|d| goes_one_way(d, parameters));
    if one_way { 1 + drive } else { 0 }
}

/// Whether a drive goes one way through its whole law.
pub(crate) fn goes_one_way(drive: &Drive, parameters: &[f64]) -> bool {
    let law = &drive.law;
    let breaks = law.breaks(parameters);
    let at: Vec<f64> = breaks.iter().map(|t| law.at(*t, parameters)).collect();
    let ends = [at.first(), at.last()].map(|end| end.copied().unwrap_or(f64::NAN));
    let (low, high) = law.extent(parameters);
    // Measured laws may turn between their ends.
    let covers = ends[0].min(ends[1]) <= low && ends[0].max(ends[1]) >= high;
    covers && (at.is_sorted_by(|a, b| a < b) || at.is_sorted_by(|a, b| a > b))
}
