//! How a study tells how far it has come, and how it is stopped.

use std::ops::ControlFlow;

use kempe_motion::{Stage, Watch};

/// Whether to go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flow {
    /// Go on.
    Continue,
    /// Stop here; finished rows are kept.
    Stop,
}

/// Hears how far a study has come.
pub trait Progress {
    /// `done` of `total` rows are finished. Called after every row.
    fn tick(&mut self, done: usize, total: usize) -> Flow;

    /// What is done before the first row, and the finished part of it where that is known. Called often.
    fn stage(&mut self, stage: Stage, part: Option<f64>) -> Flow {
        let _ = (stage, part);
        Flow::Continue
    }
}

/// Passes on to a study's progress what assembling, following and measuring tell.
pub struct Ear<'a>(pub &'a mut dyn Progress);

impl Watch for Ear<'_> {
    fn reached(&mut self, stage: Stage, part: Option<f64>) -> ControlFlow<()> {
        match self.0.stage(stage, part) {
            Flow::Continue => ControlFlow::Continue(()),
            Flow::Stop => ControlFlow::Break(()),
        }
    }
}

/// Hears nothing and never stops.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {
    fn tick(&mut self, _done: usize, _total: usize) -> Flow {
        Flow::Continue
    }
}

impl<F: FnMut(usize, usize) -> Flow> Progress for F {
    fn tick(&mut self, done: usize, total: usize) -> Flow {
        self(done, total)
    }
}
