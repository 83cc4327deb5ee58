//! Natural vibrations in the report: each moves in a part of its own.

use kempe_draw::plot::PlotSpec;
use kempe_draw::report::{Evidence, MotionReport};
use kempe_measure::CLOSURE_LIMIT;
use kempe_model::{Model, MotionStudy};

use crate::figures::curves_plot;
use crate::report_motion::shown;
use crate::result::{ModeShape, StudyResult};
use crate::table::Column;
use crate::unit::number_text;
use crate::view::{drawn, mechanism_view};

/// A part of the report for each natural vibration of a study.
pub(crate) fn mode_shapes(
    model: &Model,
    study: &MotionStudy,
    result: &StudyResult,
) -> Vec<MotionReport> {
    let shapes = result.shapes.iter().enumerate();
    shapes
        .map(|(row, shape)| mode_shape(model, study, result, row, shape))
        .collect()
}

fn mode_shape(
    model: &Model,
    study: &MotionStudy,
    result: &StudyResult,
    row: usize,
    shape: &ModeShape,
) -> MotionReport {
    let closure = Column {
        values: shape.closure.clone(),
        ..Column::new("closure", kempe_units::Unit::one())
    };
    let worst = shape.closure.iter().copied().fold(f64::NAN, f64::max);
    let frames = shape.frames.iter();
    MotionReport {
        name: format!("{}-{}", result.name, shape.name),
        summary: shape.about.clone(),
        view: mechanism_view(model, Some(study)),
        frames: frames.map(|f| drawn(model, f, String::new())).collect(),
        columns: shape.columns.iter().map(shown).collect(),
        drive: 1,
        against: None,
        more: Vec::new(),
        tests: vec![shown(&closure)],
        notes: Vec::new(),
        mark: String::new(),
        plots: plots(shape),
        vectors: Vec::new(),
        happenings: Vec::new(),
        events: Vec::new(),
        evidence: Evidence {
            residual: worst.is_finite().then_some((worst, CLOSURE_LIMIT)),
            facts: facts(result, row),
            ..Evidence::default()
        },
    }
}

/// How the drives go over the periods, those of one unit together.
fn plots(shape: &ModeShape) -> Vec<PlotSpec> {
    let Some((along, drives)) = shape.columns.split_first() else {
        return Vec::new();
    };
    let moves = |c: &&Column| c.values.iter().any(|v| Some(v) != c.values.first());
    let mut groups: Vec<Vec<Column>> = Vec::new();
    for drive in drives.iter().filter(moves) {
        match groups.iter_mut().find(|g| g[0].unit == drive.unit) {
            Some(group) => group.push(drive.clone()),
            None => groups.push(vec![drive.clone()]),
        }
    }
    groups
        .iter()
        .map(|g| curves_plot(along, g, Vec::new()))
        .collect()
}

/// The numbers of a mode.
fn facts(result: &StudyResult, row: usize) -> Vec<(String, String)> {
    let columns = result.table.columns.iter().skip(1);
    let known = columns.filter_map(|column| {
        let value = *column.values.get(row)?;
        let text = format!("{} {}", number_text(value), column.unit.text());
        value
            .is_finite()
            .then(|| (column.name.clone(), text.trim_end().to_owned()))
    });
    known.collect()
}
