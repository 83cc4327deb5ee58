//! Why there is no motion.

use kempe_mechanism::structure::BodyId;

use crate::assemble::Assemblies;
use crate::progress::Stage;

/// Why there is no motion.
#[derive(Clone, Debug)]
pub enum MotionError {
    /// No drive moves anything.
    NoDrive,
    /// Freedoms that no drive determines.
    Undetermined {
        /// Bodies that stay free.
        bodies: Vec<BodyId>,
    },
    /// The mechanism cannot be assembled at the start.
    CannotAssemble {
        /// Path parameter of the start.
        at: f64,
        /// What was found.
        assemblies: Box<Assemblies>,
    },
    /// It stands where it starts, and there is no direction in which the drive moves it farther than it gives.
    Locked {
        /// Path parameter of the start.
        at: f64,
        /// The assemblies there, the one meant first.
        assemblies: Box<Assemblies>,
    },
    /// The mechanism is too large or too small for numbers: squares of its lengths would overflow or vanish.
    Scale {
        /// Its size, m.
        size: f64,
    },
    /// Branches come so near each other that the trace could not be kept on one of them.
    Entangled {
        /// Path parameter there.
        at: f64,
    },
    /// It was told to stop before the motion was known.
    Stopped {
        /// What it was at.
        stage: Stage,
    },
}
