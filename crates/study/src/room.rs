//! How much a study may hold: its rows are bounded by memory, before any of it is taken. What each kind holds is reckoned in `room_of_kinds.rs`.

use std::mem::size_of;

use kempe_dynamics::ForceArrow;
use kempe_mechanism::Mechanism;
use kempe_model::{Diagnostic, Model, MotionStudy, Rows};

use crate::columns::Asked;
use crate::force_columns::standard_plots;
use crate::result::Frame;
use crate::rows::most;

/// A study holds at most so many bytes: its table, its curves and its poses. Writing it takes about as much again.
pub const MAX_STUDY_BYTES: usize = 2 << 30;

/// Bytes of a number.
pub(crate) const NUMBER: usize = size_of::<f64>();

/// Columns that every table has besides those that are asked for: evidence.
const EVIDENCE: usize = 5;

/// Velocity and acceleration of a point.
const RATES: usize = 4;

/// Each curve of a plot, and each path, is held with its abscissa, in the result and in its picture.
pub(crate) const HELD: usize = 4;

/// Bytes that a row of a study takes, which asks for so many plots.
pub(crate) fn row_bytes(model: &Model, asked: &Asked, plots: usize, forces: bool) -> usize {
    let numbers = 1
        + model.drives.len()
        + asked.columns.len()
        + EVIDENCE
        + HELD * (asked.curves.len() + plots)
        + 3 * model.links.len()
        + (2 + RATES) * model.points.len();
    let note = size_of::<Option<String>>();
    let arrows = if forces { arrows(model) } else { 0 };
    numbers * NUMBER + note + size_of::<Frame>() + arrows * (size_of::<ForceArrow>() + 4 * NUMBER)
}

/// What may act on the links of a row: at each end of what joins them, and on them.
fn arrows(model: &Model) -> usize {
    let actions = &model.actions;
    let between = model.points.len()
        + model.joints.len()
        + model.drives.len()
        + actions.springs.len()
        + actions.dampers.len();
    2 * between + actions.loads.len() + model.links.len()
}

/// What a study holds: so many rows of so many bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Held {
    /// Rows; of a circuit by steps of the drive, which tells them only once it is known, none.
    pub rows: f64,
    /// Bytes of a row.
    pub row: usize,
}

impl Held {
    /// Bytes in all.
    pub fn bytes(self) -> f64 {
        self.rows * self.row as f64
    }
}

/// Bytes of a row of forces.
pub(crate) fn row_of_forces(model: &Model, forces: &MotionStudy) -> usize {
    let mechanism = Mechanism::new(model);
    let mut study = forces.clone();
    if study.plots.is_empty() {
        study.plots = standard_plots(&mechanism);
    }
    let asked = Asked::of_forces(&mechanism, &study);
    row_bytes(model, &asked, study.plots.len(), true)
}

/// What a study of motion will hold.
pub(crate) fn bytes_of_motion(model: &Model, study: &MotionStudy) -> Held {
    let asked = Asked::of_motion(model, study);
    let held = held(
        model,
        study,
        row_bytes(model, &asked, study.plots.len(), false),
    );
    match (study.circuit, &study.rows) {
        (true, Rows::DriveStep(_)) => Held { rows: 0.0, ..held },
        _ => held,
    }
}

/// What a study holds along the drives' laws, whose rows take so many bytes.
pub(crate) fn held(model: &Model, study: &MotionStudy, row: usize) -> Held {
    let rows = most(model, &study.rows, &model.parameter_values());
    Held { rows, row }
}

/// Nothing, where a study has room; or an error that says what is too much.
pub(crate) fn has_room(model: &Model, name: &str, held: Held) -> Result<(), Vec<Diagnostic>> {
    if held.bytes() <= MAX_STUDY_BYTES as f64 {
        return Ok(());
    }
    let gib = f64::from(1 << 30);
    let message = format!(
        "study `{name}`: {:.0} rows of {} bytes each, with their poses, take {:.1} GiB",
        held.rows,
        held.row,
        held.bytes() / gib
    );
    let most = MAX_STUDY_BYTES / held.row.max(1);
    let diagnostic = Diagnostic::error("too-large", message)
        .note(format!(
            "a study holds at most {} GiB",
            MAX_STUDY_BYTES >> 30
        ))
        .help(format!(
            "ask for fewer rows, {most} at most, or for fewer columns and plots"
        ));
    let study = model.studies.iter().find(|s| s.name == name);
    Err(vec![match study {
        Some(study) => diagnostic.at(study.span.clone(), "this study"),
        None => diagnostic,
    }])
}
