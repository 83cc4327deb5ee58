//! How long work tells how far it has come, and how it is stopped.
//!
//! Nothing here knows a clock, a thread or a terminal: whoever starts the work brings an ear.

use std::ops::ControlFlow;

/// What the work is at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// All ways to put the mechanism together are looked for.
    Assembling,
    /// The motion is followed from its start to both ends, or round its circuit.
    Following,
    /// Limits and change points of the motion are located.
    Locating,
    /// Extremes, means and path lengths over the whole motion are found.
    Measuring,
    /// The motion is proved, stretch by stretch.
    Proving,
    /// What could be put on the mechanism is tried, unit by unit.
    Trying,
}

impl Stage {
    /// What is done, for people: `finding assemblies`.
    pub fn text(self) -> &'static str {
        match self {
            Self::Assembling => "finding assemblies",
            Self::Following => "following the motion",
            Self::Locating => "locating limits and change points",
            Self::Measuring => "measuring over the motion",
            Self::Proving => "proving the motion",
            Self::Trying => "trying what each unit does",
        }
    }
}

/// Hears how far long work has come, and says whether it may go on.
///
/// It is asked often, and its answer must not change what is computed, only whether it goes on.
pub trait Watch {
    /// `part` of the stage is done, 0 to 1; `None` where it is not known how much there is.
    fn reached(&mut self, stage: Stage, part: Option<f64>) -> ControlFlow<()>;
}

/// Hears nothing and never stops.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unwatched;

impl Watch for Unwatched {
    fn reached(&mut self, _: Stage, _: Option<f64>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

impl<F: FnMut(Stage, Option<f64>) -> ControlFlow<()>> Watch for F {
    fn reached(&mut self, stage: Stage, part: Option<f64>) -> ControlFlow<()> {
        self(stage, part)
    }
}
