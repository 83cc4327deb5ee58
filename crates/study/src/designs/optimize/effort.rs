//! How far a search goes: designs, starts and steps.

use kempe_model::OptimizeStudy;
use kempe_optimize::{Further, SqpOptions};

/// Designs that are looked at to choose starts from, for each parameter, and how many starts.
pub(super) const LOOKED_AT: usize = 24;
pub(super) const STARTS: usize = 6;
/// As many more follow as long as more than this part of them is expected to lead elsewhere.
pub(super) const UNSEEN: f64 = 0.05;
/// Designs of a global search for each parameter, where the file does not say.
pub(super) const GLOBAL: usize = 400;
/// Steps and designs of one descent.
const STEPS: usize = 150;
const OF_DESCENT: usize = 1000;
const OF_VARIABLE: usize = 500;
/// A violation up to this part of its scale is none.
pub(super) const KEPT: f64 = 1e-7;

pub(super) fn local() -> SqpOptions {
    SqpOptions {
        iterations: STEPS,
        evaluations: OF_DESCENT,
        ..SqpOptions::default()
    }
}

/// Designs of one descent of so many variables: along an edge of what can be asked each step takes many for every variable.
pub(super) fn of_descent(n: usize) -> usize {
    OF_DESCENT.max(OF_VARIABLE * n)
}

/// How long a study goes on to follow starts in a box of so many variables.
pub(super) fn further(study: &OptimizeStudy, n: usize) -> Further {
    Further {
        unseen: UNSEEN,
        evaluations: study.designs.unwrap_or(GLOBAL * n),
    }
}
