//! Being asked to stop, by Ctrl-C or by the system (SIGTERM, SIGHUP): the first asks to stop at the next row (before the first
//! row: soon), the second ends the program at once.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::exit::Exit;
use crate::say::complain;

static STOP: AtomicBool = AtomicBool::new(false);

/// Listens from now on. Where that is not possible, signals end the program as usual.
pub fn listen() {
    if let Err(error) = listen_with(heard) {
        complain(&format!("Ctrl-C will end the program at once: {error}\n"));
    }
}

fn heard() {
    if STOP.swap(true, Ordering::SeqCst) {
        std::process::exit(i32::from(Exit::Interrupted.number()));
    }
    complain("stopping: what is finished is kept; Ctrl-C again to end at once\n");
}

/// Whether to stop.
pub fn stopped() -> bool {
    STOP.load(Ordering::SeqCst)
}

#[cfg(unix)]
fn listen_with(heard: fn()) -> std::io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    let mut wanted = vec![SIGINT, SIGTERM];
    if !is_ignored(SIGHUP) {
        wanted.push(SIGHUP);
    }
    let mut signals = signal_hook::iterator::Signals::new(wanted)?;
    std::thread::Builder::new().spawn(move || signals.forever().for_each(|_| heard()))?;
    Ok(())
}

/// Whether whoever started the program told it to ignore a signal, as `nohup` does. Where the system does not tell, it is not.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = line.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

#[cfg(not(unix))]
fn listen_with(heard: fn()) -> Result<(), ctrlc::Error> {
    ctrlc::set_handler(heard)
}
