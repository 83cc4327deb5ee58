//! A trace that stays on its branch, where others come near it.

use super::MotionError;
use crate::drive_path::DrivePath;
use crate::progress::Stage;
use crate::trace::Follower;

/// Branches meet where both lie within this residual (in mechanism sizes and rad); where they keep farther apart the trace
/// has gone from one to the other, and is repeated with restricted steps.
pub const MEETING: f64 = 1e-11;
/// How often a trace is repeated with steps restricted at one place more.
const REPEATS: usize = 64;

/// Why the events of a motion are not known.
pub(crate) enum Unlocated {
    /// The work was stopped at this.
    Stopped(Stage),
    /// The trace went from one branch to another that does not meet it: they only come near each other at this place.
    Missed {
        /// Scaled unknowns, between the branches.
        z: Vec<f64>,
        /// Largest residual there, in mechanism sizes and rad.
        residual: f64,
    },
}

/// Traces until the trace stays on its branch: with steps restricted at one place more each time that it went to another.
pub(crate) fn restricting_steps<R>(
    follower: &mut Follower<'_, DrivePath>,
    mut trace: impl FnMut(&mut Follower<'_, DrivePath>) -> Result<R, Unlocated>,
) -> Result<R, MotionError> {
    let mut repeats = 0;
    loop {
        match trace(follower) {
            Ok(found) => return Ok(found),
            Err(Unlocated::Stopped(stage)) => return Err(MotionError::Stopped { stage }),
            Err(Unlocated::Missed { z, .. }) if repeats == REPEATS => {
                let at = follower.parameter(&z);
                return Err(MotionError::Entangled { at });
            }
            Err(Unlocated::Missed { z, residual }) => {
                follower.restrict(z, residual);
                repeats += 1;
            }
        }
    }
}
