//! Running a study of any kind, and how much it will hold.

use kempe_batch::{Executor, Serial};
use kempe_model::{Diagnostic, Model, Study, StudyKind};

use crate::designs::{Parts, Unkept, bytes_of_sweep, sweep};
use crate::result::StudyResult;
use crate::room::{Held, has_room};
use crate::room_of_kinds::bytes_of_one;
use crate::run_one::run_one;
use kempe_motion::progress::Progress;

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
    run_with(model, study, &Serial, progress)
}

/// As [`run`]; studies of many designs are run in pieces on an executor. The results are the same whichever it is.
///
/// # Errors
///
/// See [`run`].
pub fn run_with(
    model: &Model,
    study: &Study,
    executor: &dyn Executor,
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    run_in_parts(model, study, (executor, &mut Unkept), progress)
}

/// As [`run_with`]; what a study computes part by part is kept, and what was kept before is not computed again.
///
/// # Errors
///
/// See [`run`], and why a part is not to be had.
pub fn run_in_parts(
    model: &Model,
    study: &Study,
    (executor, parts): (&dyn Executor, &mut dyn Parts),
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    match &study.kind {
        StudyKind::Sweep(asked) => {
            room_for(model, study)?;
            sweep(model, &study.name, asked, (executor, parts), progress)
        }
        _ => run_one(model, study, (executor, parts), progress),
    }
}

/// What a study will hold, before any of it is computed.
pub fn study_bytes(model: &Model, study: &Study) -> Held {
    match &study.kind {
        StudyKind::Sweep(asked) => bytes_of_sweep(model, asked),
        _ => bytes_of_one(model, study),
    }
}

/// Whether a study has room.
///
/// # Errors
///
/// `too-large`, with what it would take.
pub fn room_for(model: &Model, study: &Study) -> Result<(), Vec<Diagnostic>> {
    has_room(model, &study.name, study_bytes(model, study))
}
