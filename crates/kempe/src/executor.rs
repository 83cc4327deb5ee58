//! On what many designs are worked at: threads, or none.

use kempe_batch::Serial;
#[cfg(not(target_family = "wasm"))]
use kempe_batch::{Executor, Task};

/// Runs work on as many threads as there may be.
#[cfg(not(target_family = "wasm"))]
pub(crate) fn run<R>(threads: usize, work: impl FnOnce(&AnyExecutor) -> R) -> R {
    work(&AnyExecutor(threads))
}

#[cfg(target_family = "wasm")]
pub(crate) fn run<R>(_: usize, work: impl FnOnce(&Serial) -> R) -> R {
    work(&Serial)
}

/// Threads, or none.
#[cfg(not(target_family = "wasm"))]
pub(crate) struct AnyExecutor(usize);

#[cfg(not(target_family = "wasm"))]
impl Executor for AnyExecutor {
    fn run_heard(&self, tasks: Vec<Task<'_>>, between: &mut dyn FnMut()) {
        match self.0 {
            1 => Serial.run_heard(tasks, between),
            threads => kempe_batch::Threads(threads).run_heard(tasks, between),
        }
    }
}
