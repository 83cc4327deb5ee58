//! Work that shows what was found already: whoever stops it before its first row sees its rows all the same.

use std::ops::ControlFlow;

use kempe_motion::progress::{Done, Progress, Stage};

/// Hears progress of such work. Between rows it may be stopped; where it is stopped before, it goes on without asking again, because
/// nothing of it would be left.
pub(crate) struct Shows<'p> {
    progress: &'p mut dyn Progress,
    was_stopped: bool,
}

impl<'p> Shows<'p> {
    /// `was_stopped` says whether what was found ends there because it was stopped.
    pub fn new(progress: &'p mut dyn Progress, was_stopped: bool) -> Self {
        Self {
            progress,
            was_stopped,
        }
    }
}

impl Progress for Shows<'_> {
    fn reached(&mut self, stage: Stage, done: Done) -> ControlFlow<()> {
        if self.was_stopped {
            return ControlFlow::Continue(());
        }
        match (self.progress.reached(stage, done), stage) {
            (ControlFlow::Break(()), Stage::Rows) => ControlFlow::Break(()),
            (ControlFlow::Break(()), _) => {
                self.was_stopped = true;
                ControlFlow::Continue(())
            }
            (ControlFlow::Continue(()), _) => ControlFlow::Continue(()),
        }
    }
}
