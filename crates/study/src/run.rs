//! Running a study of any kind.

use kempe_batch::{Executor, Serial};
use kempe_model::{Diagnostic, Model, Study, StudyKind};

use crate::adjust::adjustment;
use crate::choice::{balance, spring};
use crate::clearance::{clearance, contact};
use crate::designs::{Parts, Unkept, optimization, sweep, tolerance};
use crate::findings_forces::nothing_acts;
use crate::motion::run_along;
use crate::result::StudyResult;
use crate::room::room_for;
use crate::run_motion::run_motion;
use crate::simulation::simulation;
use crate::synthesis::synthesis;
use crate::vibrations::vibrations;
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
    room_for(model, study)?;
    match &study.kind {
        StudyKind::Motion(motion) => run_motion(model, &study.name, motion, progress),
        StudyKind::Forces(forces) => {
            let mut result = run_along(model, &study.name, forces, true, progress)?;
            result.diagnostics.extend(nothing_acts(model));
            Ok(result)
        }
        StudyKind::Balance(choice) => balance(model, &study.name, choice, progress),
        StudyKind::Simulate(it) => {
            simulation(model, &study.name, it, &[], progress).map(|(result, _)| result)
        }
        StudyKind::Spring(choice) => spring(model, &study.name, choice, progress),
        StudyKind::Clearance(play) => clearance(model, &study.name, play, progress),
        StudyKind::Contact(play) => {
            contact(model, &study.name, play, progress).map(|(result, _)| result)
        }
        StudyKind::Vibrations(asked) => vibrations(model, &study.name, asked, progress),
        StudyKind::Adjust(asked) => adjustment(model, &study.name, asked, progress),
        StudyKind::Sweep(asked) => sweep(model, &study.name, asked, (executor, parts), progress),
        StudyKind::Tolerance(asked) => tolerance(model, &study.name, asked, executor, progress),
        StudyKind::Optimize(asked) => {
            optimization(model, &study.name, asked, (executor, parts), progress)
        }
        StudyKind::Synthesize(asked) => synthesis(model, &study.name, asked, progress),
    }
}
