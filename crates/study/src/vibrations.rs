//! Natural vibrations of a mechanism some of whose drives are let go: about one pose, or about the poses of a motion.
//!
//! `bench.rs` brings the mechanism to a pose and makes it linear there, `pose.rs` tells the modes of one pose, `sweep.rs` their
//! frequencies along a motion, `shapes.rs` makes poses of a mode that can be looked at, `numbers.rs` the numbers by which designs differ.

mod bench;
mod numbers;
mod pose;
mod shapes;
mod sweep;

use kempe_model::{Diagnostic, Model, Rows, VibrationStudy};
use kempe_motion::Progress;

use crate::result::StudyResult;

pub(crate) use numbers::numbers_of_modes;
pub(crate) use shapes::SHAPE_POSES;

/// What is to be told of a study of natural vibrations without its rows: of one about a pose everything, of one along a motion what
/// keeps it from starting, and what it leaves out.
pub(crate) fn findings_of_vibrations(
    model: &Model,
    name: &str,
    study: &VibrationStudy,
    progress: &mut dyn Progress,
) -> Vec<Diagnostic> {
    // One pose is known in no time; along a motion a row without vibrations is a row with a note.
    if study.along.rows == Rows::Count(1) {
        return match vibrations(model, name, study, progress) {
            Ok(found) => found.diagnostics,
            Err(refused) => refused,
        };
    }
    match bench::Bench::new(model, name, study, progress) {
        Ok(bench) => bench.told(),
        Err(refused) => refused,
    }
}

/// Runs a study of natural vibrations.
pub(crate) fn vibrations(
    model: &Model,
    name: &str,
    study: &VibrationStudy,
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    let bench = bench::Bench::new(model, name, study, progress)?;
    match study.along.rows {
        Rows::Count(1) => pose::about(bench, progress),
        _ => sweep::along(bench, progress),
    }
}
