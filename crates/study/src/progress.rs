//! How a study tells how far it has come, and how it is stopped.

/// Whether to go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flow {
    /// Go on.
    Continue,
    /// Stop after this row; what is finished is kept.
    Stop,
}

/// Hears how far a study has come.
pub trait Progress {
    /// `done` of `total` rows are finished. Called after every row.
    fn tick(&mut self, done: usize, total: usize) -> Flow;
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
