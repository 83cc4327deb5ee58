//! Running a motion study: along the drives' laws, or round its whole circuit.

use kempe_model::{Diagnostic, Model, MotionStudy};
use kempe_motion::progress::Progress;

use crate::circuit::run_circuit;
use crate::motion::run_along;
use crate::result::StudyResult;
use crate::room::{bytes_of_motion, has_room};

/// Runs a motion study called `name`.
///
/// # Errors
///
/// See [`run`](crate::run).
pub fn run_motion(
    model: &Model,
    name: &str,
    study: &MotionStudy,
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    has_room(model, name, bytes_of_motion(model, study))?;
    if study.circuit {
        return run_circuit(model, name, study, progress);
    }
    run_along(model, name, study, false, progress)
}
