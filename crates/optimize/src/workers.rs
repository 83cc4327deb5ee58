//! Who does pieces of work that do not depend on each other.

/// A piece of work, done once.
pub type Task<'a> = Box<dyn FnOnce() + Send + 'a>;

/// Does pieces of work, in any order or at once: what comes out is the same.
pub trait Workers {
    /// Does all of them, and returns when the last is done.
    fn run(&self, tasks: Vec<Task<'_>>) {
        self.run_heard(tasks, &mut || {});
    }

    /// The same; who calls is told now and then when one was done.
    fn run_heard(&self, tasks: Vec<Task<'_>>, between: &mut dyn FnMut());
}

/// Does one after the other.
#[derive(Clone, Copy, Debug, Default)]
pub struct Alone;

impl Workers for Alone {
    fn run_heard(&self, tasks: Vec<Task<'_>>, between: &mut dyn FnMut()) {
        for task in tasks {
            task();
            between();
        }
    }
}

/// What becomes of each item, in their order.
pub fn each<T: Send, R: Send>(
    workers: &dyn Workers,
    items: Vec<T>,
    work: impl Fn(T) -> R + Sync,
) -> Vec<R> {
    each_heard(workers, items, &mut || {}, work)
}

/// The same; who calls is told now and then when one is known.
pub fn each_heard<T: Send, R: Send>(
    workers: &dyn Workers,
    items: Vec<T>,
    between: &mut dyn FnMut(),
    work: impl Fn(T) -> R + Sync,
) -> Vec<R> {
    let mut found: Vec<Option<R>> = items.iter().map(|_| None).collect();
    let work = &work;
    let tasks = found.iter_mut().zip(items);
    let tasks =
        tasks.map(|(slot, item)| -> Task<'_> { Box::new(move || *slot = Some(work(item))) });
    workers.run_heard(tasks.collect(), between);
    found.into_iter().flatten().collect()
}
