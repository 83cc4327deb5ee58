//! How long work tells how far it has come, and how it is stopped.
//!
//! Nothing here knows a clock, a thread or a terminal: whoever starts the work brings what hears it.

use std::fmt;
use std::ops::ControlFlow;
use std::sync::Arc;

/// What the work is at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
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
    /// The best of many designs is looked for.
    Searching,
    /// What is let go moves in time.
    Simulating,
    /// What is let go sinks to equilibrium.
    Settling,
    /// Rows of a table are computed, or values of many designs.
    Rows,
    /// Pictures and the report are drawn.
    Drawing,
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
            Self::Searching => "looking for the best design",
            Self::Simulating => "simulating",
            Self::Settling => "finding equilibrium",
            Self::Rows => "computing rows",
            Self::Drawing => "drawing",
        }
    }
}

/// How much of a stage is done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Done {
    /// It is not known how much there is.
    Unknown,
    /// This part of it, 0 to 1.
    Part(f64),
    /// So many of so many.
    Of(usize, usize),
}

impl Done {
    /// The part that is done, 0 to 1, where it is known.
    pub fn part(self) -> Option<f64> {
        match self {
            Self::Unknown => None,
            Self::Part(part) => Some(part.clamp(0.0, 1.0)),
            Self::Of(done, all) => Some(done as f64 / all.max(1) as f64),
        }
    }
}

impl From<Option<f64>> for Done {
    fn from(part: Option<f64>) -> Self {
        part.map_or(Self::Unknown, Self::Part)
    }
}

/// Hears how far long work has come, and says whether it may go on. What is finished when it is stopped is kept where it
/// means something by itself: rows of a table.
///
/// It is asked often, and its answer must not change what is computed, only whether it goes on.
pub trait Progress {
    /// The work has come so far.
    fn reached(&mut self, stage: Stage, done: Done) -> ControlFlow<()>;

    /// The best that was found so far, in words; told before [`reached`](Self::reached), and only where it changed.
    fn found(&mut self, best: &str) {
        let _ = best;
    }

    /// What says on any thread whether to stop: work on many designs asks it in the middle of each. By default nothing does.
    fn watch(&self) -> Watch {
        Watch::default()
    }
}

/// Says on any thread whether work is to stop; the default never does.
#[derive(Clone, Default)]
pub struct Watch(Option<Arc<dyn Fn() -> bool + Send + Sync>>);

impl Watch {
    /// Asks this, often.
    pub fn new(stops: impl Fn() -> bool + Send + Sync + 'static) -> Self {
        Self(Some(Arc::new(stops)))
    }

    /// Whether to stop.
    pub fn stops(&self) -> bool {
        self.0.as_ref().is_some_and(|stops| stops())
    }
}

impl fmt::Debug for Watch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Watch").field(&self.stops()).finish()
    }
}

impl Progress for Watch {
    fn reached(&mut self, _: Stage, _: Done) -> ControlFlow<()> {
        match self.stops() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }

    fn watch(&self) -> Watch {
        self.clone()
    }
}

/// Hears nothing and never stops.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {
    fn reached(&mut self, _: Stage, _: Done) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

impl<F: FnMut(Stage, Done) -> ControlFlow<()>> Progress for F {
    fn reached(&mut self, stage: Stage, done: Done) -> ControlFlow<()> {
        self(stage, done)
    }
}
