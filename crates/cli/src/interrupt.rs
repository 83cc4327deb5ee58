//! Ctrl-C: the first asks to stop at the next row (before the first row: soon), the second ends the program at once.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::say::complain;

static STOP: AtomicBool = AtomicBool::new(false);

/// Listens for Ctrl-C from now on. Where that is not possible, Ctrl-C ends the program as usual.
pub fn listen() {
    let heard = || {
        if STOP.swap(true, Ordering::SeqCst) {
            std::process::exit(130);
        }
        complain("stopping: what is finished is kept; Ctrl-C again to end at once\n");
    };
    if let Err(error) = ctrlc::set_handler(heard) {
        complain(&format!("Ctrl-C will end the program at once: {error}\n"));
    }
}

/// Whether to stop.
pub fn stopped() -> bool {
    STOP.load(Ordering::SeqCst)
}
