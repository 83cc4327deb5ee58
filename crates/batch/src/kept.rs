//! Storage that a batch keeps from call to call, of whatever kind.

use std::any::Any;
use std::sync::Mutex;

/// What nobody works in at the moment. A copy begins with nothing.
#[derive(Debug, Default)]
pub(super) struct Kept(Mutex<Vec<Box<dyn Any + Send>>>);

impl Clone for Kept {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Kept {
    /// Takes one of this kind; others are given up.
    pub(super) fn take<T: Any + Send>(&self) -> Option<Box<T>> {
        self.0.lock().ok()?.pop()?.downcast().ok()
    }

    /// Keeps one for later.
    pub(super) fn give<T: Any + Send>(&self, it: Box<T>) {
        if let Ok(mut kept) = self.0.lock() {
            kept.push(it);
        }
    }
}
