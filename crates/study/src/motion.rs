//! Motion studies: a row for every place along the drives' laws.

use kempe_measure::{Unmeasurable, Unprepared};
use kempe_model::{Diagnostic, Leaf, Measure, Model, MotionStudy, Statistic, Study, StudyKind};
use kempe_motion::drive_path::{DrivePath, is_cycle};
use kempe_motion::events::EventKind;
use kempe_motion::{EndReason, Motion, Stage};
use kempe_units::Dimension;

use crate::along::Along;
use crate::choice::{balance, spring};
use crate::circuit::run_circuit;
use crate::columns::{Asked, Quantity};
use crate::explain::{beyond_limit, stopped};
use crate::findings_forces::something_acts;
use crate::force_columns::standard_plots;
use crate::force_notes::{place, unbounded};
use crate::prepared::{design, motion};
use crate::progress::{Ear, Flow, Progress};
use crate::result::{Event, StudyResult};
use crate::rows::places_along;
use crate::sink::RowSink;
use crate::slot_ends::left_slots;
use crate::table::{Column, Table};
use crate::unit::Units;

/// Runs a study of a model.
///
/// # Errors
///
/// What keeps the study from starting, as diagnostics over the model file: `cannot-assemble`, `range-beyond-limit`,
/// `undetermined`, `locked`, `not-measurable`, `stopped`. A row that cannot be reached is no error: it carries its reason.
pub fn run(
    model: &Model,
    study: &Study,
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    match &study.kind {
        StudyKind::Motion(motion) => run_motion(model, &study.name, motion, progress),
        StudyKind::Forces(forces) => {
            let mut result = run_along(model, &study.name, forces, true, progress)?;
            if !something_acts(model) {
                result.warnings.push(nothing_acts());
            }
            Ok(result)
        }
        StudyKind::Balance(choice) => balance(model, &study.name, choice, progress),
        StudyKind::Spring(choice) => spring(model, &study.name, choice, progress),
    }
}

/// Forces are asked for where there are none.
pub(crate) fn nothing_acts() -> Diagnostic {
    Diagnostic::warning(
        "nothing-acts",
        "nothing acts on the mechanism: there are no forces",
    )
    .note("links have no mass unless it is given")
    .help("say what acts: mass = \"1 kg\" of a link, or [loads], [springs], [dampers]")
}

/// Runs a motion study called `name`.
///
/// # Errors
///
/// See [`run`].
pub fn run_motion(
    model: &Model,
    name: &str,
    study: &MotionStudy,
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    if study.circuit {
        return run_circuit(model, name, study, progress);
    }
    run_along(model, name, study, false, progress)
}

/// Rows along the drives' laws, with forces or without.
pub(crate) fn run_along(
    model: &Model,
    name: &str,
    study: &MotionStudy,
    forces: bool,
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    let design = design(model);
    let motion = motion(&design, progress)?;
    let mut warnings = range_warnings(&motion)?;
    let mut study = study.clone();
    if forces && study.plots.is_empty() {
        study.plots = standard_plots(&design.mechanism);
    }
    let asked = if forces {
        Asked::of_forces(&design.mechanism, &study)
    } else {
        Asked::of_motion(model, &study)
    };
    let quantities: Vec<&Quantity> = asked.all().collect();
    let mut sampler = Along::watched(model, &motion, &quantities, forces, &mut Ear(progress))?;
    let places = places_along(&motion, &study, &design.parameters);
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
        if progress.tick(done + 1, places.len()) == Flow::Stop {
            break;
        }
    }
    let along = abscissa(&motion, &design.parameters);
    if rows.table.unreached() > 0 {
        warnings.push(unreached_warning(name, &rows.table));
    }
    warnings.extend(rows.force_warnings(&design.mechanism, along));
    warnings.extend(without_value(&rows, along, |index| {
        let of_cycles =
            (asked.scalars.get(index)).is_some_and(|q| asks_time_ratio(model, &q.measure));
        of_cycles && !is_cycle(model, &design.parameters)
    }));
    let parameters = &design.parameters;
    warnings.extend(left_slots(model, parameters, &frames, &rows.table, along));
    let met = events(&motion, &units, &parameters_met);
    if forces {
        warnings.extend(unbounded(model, &asked.scalars, &met));
    }
    Ok(StudyResult {
        name: name.to_owned(),
        events: met,
        scalars: rows.scalars.clone(),
        figures: rows.figures(&study.plots),
        table: rows.table,
        frames,
        listings: Vec::new(),
        along,
        assemblies: (motion.assemblies.list.len(), motion.assemblies.rejected),
        warnings,
        demanded_rows: places.len(),
    })
}

/// Why there are no rows, as diagnostics over the model file.
pub(crate) fn unprepared(
    model: &Model,
    quantities: &[&Quantity],
    problem: Unprepared,
) -> Vec<Diagnostic> {
    match problem {
        Unprepared::Unmeasurable(problems) => not_measurable(model, quantities, &problems),
        Unprepared::Stopped => vec![stopped(Stage::Measuring)],
    }
}

/// Columns and numbers over the motion that have no value where the pose is known and no note says why. `lacks_cycle` tells
/// of which numbers that is because the motion is no cycle.
fn without_value(
    rows: &RowSink,
    along: usize,
    lacks_cycle: impl Fn(usize) -> bool,
) -> Vec<Diagnostic> {
    let table = &rows.table;
    let silent = |row: usize| {
        table.closure.get(row).is_some_and(|c| c.is_finite())
            && table.notes.get(row).is_some_and(Option::is_none)
    };
    let columns = table.columns.iter().filter_map(|column| {
        let values = column.values.iter().enumerate();
        let missing: Vec<usize> = values
            .filter(|(row, value)| !value.is_finite() && silent(*row))
            .map(|(row, _)| row)
            .collect();
        let first = *missing.first()?;
        Some(
            Diagnostic::warning(
                "no-value",
                format!(
                    "study `{}`: `{}` has no finite value in {} of {} rows, first at {}",
                    table.name,
                    column.name,
                    missing.len(),
                    table.rows(),
                    place(table, along, first)
                ),
            )
            .help("a quotient by zero, or a root, logarithm or arc of a number outside its range"),
        )
    });
    let numbers = rows.scalars.iter().enumerate();
    let numbers = numbers.filter(|(_, s)| !s.value.is_finite());
    let numbers = numbers.map(|(index, scalar)| {
        let told = Diagnostic::warning(
            "no-value",
            format!("study `{}`: `{}` has no finite value", table.name, scalar.name),
        );
        if lacks_cycle(index) {
            return told
                .note("a time ratio compares both strokes of a cycle, and this motion is none")
                .help("let the drives end where they started, or whole turns from there");
        }
        told.help("what it is taken of has none somewhere, or the place that it asks for is not on the motion")
    });
    let all_reached = table.unreached() == 0;
    columns.chain(numbers.filter(|_| all_reached)).collect()
}

/// Whether a measure asks for a time ratio, itself or by another measure.
fn asks_time_ratio(model: &Model, measure: &Measure) -> bool {
    measure.leaves().any(|leaf| match leaf {
        Leaf::Over(statistic, inner) => {
            *statistic == Statistic::TimeRatio || asks_time_ratio(model, inner)
        }
        Leaf::Named(index) => {
            (model.measures.get(*index)).is_some_and(|m| asks_time_ratio(model, &m.measure))
        }
        Leaf::Rate(inner, _) | Leaf::Coefficient(inner, ..) => asks_time_ratio(model, inner),
        _ => false,
    })
}

/// The column that rows run along: the drive that goes one way through the whole motion, or else time.
fn abscissa(motion: &Motion, parameters: &[f64]) -> usize {
    let model = &motion.mechanism().model;
    let DrivePath::Coordinate { drive, .. } = motion.path else {
        return 0;
    };
    let goes_one_way = model.drives.get(drive).is_some_and(|d| {
        let breaks = d.law.breaks(parameters);
        let at: Vec<f64> = breaks.iter().map(|t| d.law.at(*t, parameters)).collect();
        let ends = [at.first(), at.last()].map(|end| end.copied().unwrap_or(f64::NAN));
        let (low, high) = d.law.extent(parameters);
        // Measured laws may turn between their ends.
        let covers = ends[0].min(ends[1]) <= low && ends[0].max(ends[1]) >= high;
        covers && (at.is_sorted_by(|a, b| a < b) || at.is_sorted_by(|a, b| a > b))
    });
    if goes_one_way { 1 + drive } else { 0 }
}

/// Measures that the mechanism cannot answer, as diagnostics over the model file.
pub(crate) fn not_measurable(
    model: &Model,
    quantities: &[&Quantity],
    problems: &[Unmeasurable],
) -> Vec<Diagnostic> {
    let told = problems.iter().map(|problem| {
        let name = quantities.get(problem.index).map_or("", |q| &q.name);
        let what = Diagnostic::error(
            "not-measurable",
            format!("`{name}` cannot be evaluated: {}", problem.reason),
        );
        match model.measures.iter().find(|m| m.name == name) {
            Some(named) => what.at(named.span.clone(), ""),
            None => what,
        }
    });
    told.collect()
}

/// Nothing, where the demanded range is covered. An error where one drive alone is asked to go beyond its limit; a warning
/// where several drives meet a limit on their way, or the motion could not be followed.
fn range_warnings(motion: &Motion) -> Result<Vec<Diagnostic>, Vec<Diagnostic>> {
    let missed = [
        (motion.ends.0, motion.demanded.0),
        (motion.ends.1, motion.demanded.1),
    ];
    let missed: Vec<_> = missed
        .into_iter()
        .filter(|(reason, at)| *reason != EndReason::Covered && !motion.reaches(*at))
        .collect();
    if missed.is_empty() {
        return Ok(Vec::new());
    }
    let told = beyond_limit(motion, &missed);
    let one_drive = matches!(motion.path, DrivePath::Coordinate { .. });
    if one_drive && missed.iter().any(|(r, _)| *r == EndReason::Limit) {
        return Err(vec![told]);
    }
    Ok(vec![Diagnostic {
        severity: kempe_model::Severity::Warning,
        ..told
    }])
}

pub(crate) fn unreached_warning(name: &str, table: &Table) -> Diagnostic {
    let reason = table.notes.iter().zip(&table.closure);
    let reason = reason
        .filter(|(_, closure)| !closure.is_finite())
        .find_map(|(note, _)| note.as_deref())
        .unwrap_or("no pose was found");
    Diagnostic::warning(
        "rows-not-reached",
        format!(
            "{} of {} rows of study `{name}` could not be reached: {reason}",
            table.unreached(),
            table.rows()
        ),
    )
    .help("the column `note` says why, row by row")
}

/// What the motion met, with the row nearest to each place.
pub(crate) fn events(motion: &Motion, units: &Units, parameters: &[f64]) -> Vec<Event> {
    let model = &motion.mechanism().model;
    let (name, dimension) = match motion.path {
        DrivePath::Coordinate { drive, .. } => model
            .drives
            .get(drive)
            .map_or(("time", Dimension::TIME), |d| {
                (d.name.as_str(), d.dimension)
            }),
        DrivePath::Time { .. } => ("time", Dimension::TIME),
    };
    let nearest = |at: f64| {
        let gap = |row: &usize| (parameters[*row] - at).abs();
        (0..parameters.len())
            .min_by(|a, b| gap(a).total_cmp(&gap(b)))
            .unwrap_or(0)
    };
    let told = motion
        .events
        .iter()
        .filter(|e| e.kind != EventKind::ModeChange);
    told.map(|event| Event {
        kind: event.kind,
        at: event.at,
        place: format!(
            "{name} = {}",
            units.place_text(event.at, dimension, motion.demanded)
        ),
        label: match event.kind {
            EventKind::Limit => "limit of the drive".to_owned(),
            _ => "change point: branches cross, the motion goes on smoothly".to_owned(),
        },
        row: nearest(event.at),
    })
    .collect()
}
