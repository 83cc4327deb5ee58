//! Natural vibrations of a mechanism some of whose drives are let go: about one pose, or about the poses of a motion.
//!
//! `bench.rs` brings the mechanism to a pose and makes it linear there, `pose.rs` tells the modes of one pose, `sweep.rs` their
//! frequencies along a motion, `shapes.rs` makes poses of a mode that can be looked at.

mod bench;
mod pose;
mod shapes;
mod sweep;

use kempe_dynamics::modes;
use kempe_model::{Diagnostic, Model, Rows, VibrationStudy};
use kempe_motion::Progress;

use crate::result::StudyResult;

pub(crate) use shapes::SHAPE_POSES;

/// What is to be told of a study of natural vibrations before anything is let go: what keeps it from starting, and what it leaves
/// out.
pub(crate) fn findings_of_vibrations(
    model: &Model,
    name: &str,
    study: &VibrationStudy,
    progress: &mut dyn Progress,
) -> Vec<Diagnostic> {
    let mut bench = match bench::Bench::new(model, name, study, progress) {
        Ok(bench) => bench,
        Err(refused) => return refused,
    };
    // Along a motion a row without vibrations is a row with a note.
    if study.along.rows == Rows::Count(1)
        && let Err(why) = modes(&bench.here(0.0))
    {
        let failed = bench.failed(bench::Failure::NoModes(why));
        bench.diagnostics.push(failed);
    }
    bench.told()
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
