//! Running a study of any kind but a sweep: what a sweep may run for every design.

use kempe_batch::Executor;
use kempe_model::{Diagnostic, Model, Study, StudyKind};
use kempe_motion::progress::Progress;

use crate::adjust::adjustment;
use crate::choice::{balance, spring};
use crate::clearance::{clearance, contact};
use crate::designs::{Parts, optimization, tolerance};
use crate::findings_forces::nothing_acts;
use crate::motion::run_along;
use crate::result::StudyResult;
use crate::room::has_room;
use crate::room_of_kinds::bytes_of_one;
use crate::run_motion::run_motion;
use crate::simulation::simulation;
use crate::synthesis::synthesis;
use crate::vibrations::vibrations;

/// Runs a study that is no sweep.
///
/// # Errors
///
/// See [`run_in_parts`](crate::run_in_parts).
pub(crate) fn run_one(
    model: &Model,
    study: &Study,
    (executor, parts): (&dyn Executor, &mut dyn Parts),
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    has_room(model, &study.name, bytes_of_one(model, study))?;
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
        StudyKind::Sweep(_) => Err(vec![swept_twice(study)]),
        StudyKind::Tolerance(asked) => tolerance(model, &study.name, asked, executor, progress),
        StudyKind::Optimize(asked) => {
            optimization(model, &study.name, asked, (executor, parts), progress)
        }
        StudyKind::Synthesize(asked) => synthesis(model, &study.name, asked, progress),
    }
}

/// That a sweep is not run for every design of another one. No file that is read asks for it.
fn swept_twice(study: &Study) -> Diagnostic {
    let message = format!("the sweep `{}` cannot be run for many designs", study.name);
    Diagnostic::error("bad-choice", message).at(study.span.clone(), "this study")
}
