//! Who runs the pieces of a batch.

/// A piece of a batch, to be run once; pieces do not depend on each other.
pub type Task<'a> = Box<dyn FnOnce() + Send + 'a>;

/// Runs the pieces of a batch. Results do not depend on the order or the number of threads.
pub trait Executor {
    /// Runs all tasks and returns when the last has ended.
    fn run(&self, tasks: Vec<Task<'_>>) {
        self.run_heard(tasks, &mut || {});
    }

    /// The same; on the thread that calls, `between` is called now and then when a task has ended.
    fn run_heard(&self, tasks: Vec<Task<'_>>, between: &mut dyn FnMut());
}

/// Runs one piece after the other.
#[derive(Clone, Copy, Debug, Default)]
pub struct Serial;

impl Executor for Serial {
    fn run_heard(&self, tasks: Vec<Task<'_>>, between: &mut dyn FnMut()) {
        for task in tasks {
            task();
            between();
        }
    }
}

/// Runs pieces on this many threads of its own.
#[cfg(not(target_family = "wasm"))]
#[derive(Clone, Copy, Debug)]
pub struct Threads(pub usize);

#[cfg(not(target_family = "wasm"))]
impl Executor for Threads {
    fn run_heard(&self, tasks: Vec<Task<'_>>, between: &mut dyn FnMut()) {
        let helpers = self.0.clamp(1, tasks.len().max(1)) - 1;
        let queue = std::sync::Mutex::new(tasks.into_iter());
        let next = || {
            let mut queue = queue.lock().unwrap_or_else(|held| held.into_inner());
            queue.next()
        };
        let help = || {
            while let Some(task) = next() {
                task();
            }
        };
        std::thread::scope(|scope| {
            for _ in 0..helpers {
                scope.spawn(help);
            }
            while let Some(task) = next() {
                task();
                between();
            }
        });
    }
}
