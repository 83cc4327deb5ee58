//! Designs asked side by side.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use kempe_batch::{Executor, Task};
use kempe_motion::Watch;

/// Asks so many things side by side: their answers up to the first that was not finished, and whether to go on. `heard` is told how
/// many were finished by the way and says whether more is wanted.
pub(crate) fn together<A: Send>(
    count: usize,
    executor: &dyn Executor,
    watch: &Watch,
    heard: &mut dyn FnMut(usize) -> ControlFlow<()>,
    ask: impl Fn(usize) -> A + Sync,
) -> (Vec<A>, bool) {
    let (finished, enough) = (AtomicUsize::new(0), AtomicBool::new(false));
    let stops = || enough.load(Ordering::Relaxed) || watch.stops();
    let (ask, counted, wanted) = (&ask, &finished, || !stops());
    let mut found: Vec<Option<A>> = (0..count).map(|_| None).collect();
    let tasks = found.iter_mut().enumerate().map(|(k, slot)| -> Task<'_> {
        Box::new(move || {
            if !wanted() {
                return;
            }
            let answer = ask(k);
            // What was asked while the work was to stop may be cut short.
            if !watch.stops() {
                *slot = Some(answer);
                counted.fetch_add(1, Ordering::Relaxed);
            }
        })
    });
    executor.run_heard(tasks.collect(), &mut || {
        if heard(finished.load(Ordering::Relaxed)).is_break() {
            enough.store(true, Ordering::Relaxed);
        }
    });
    let goes_on = !stops();
    (found.into_iter().map_while(|it| it).collect(), goes_on)
}
