//! Whoever stops work on many designs in the middle of one.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use kempe_study::{Done, Progress, Stage, Watch};

/// Stops once it was asked so often, on whatever thread.
pub struct Impatient(Arc<AtomicUsize>);

impl Impatient {
    pub fn after(asks: usize) -> Self {
        Self(Arc::new(AtomicUsize::new(asks)))
    }

    /// Whether it stopped.
    pub fn is_out(&self) -> bool {
        self.0.load(Ordering::Relaxed) == 0
    }
}

impl Progress for Impatient {
    fn reached(&mut self, _: Stage, _: Done) -> ControlFlow<()> {
        match self.is_out() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }

    fn watch(&self) -> Watch {
        let left = self.0.clone();
        let less = |n: usize| Some(n.saturating_sub(1));
        Watch::new(move || {
            let before = left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, less);
            before.is_ok_and(|n| n <= 1)
        })
    }
}
