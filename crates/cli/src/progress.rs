//! A progress bar on the error stream, where that is a terminal and the work is long.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use kempe_study::{Flow, Progress};

use crate::interrupt;

/// Work shorter than this shows no bar.
const PATIENCE: Duration = Duration::from_millis(400);

/// Shows how far a study has come, and stops it on Ctrl-C.
pub struct Bar {
    name: String,
    since: Instant,
    bar: Option<ProgressBar>,
    wanted: bool,
}

impl Bar {
    /// A bar for a study; silent when quiet or piped.
    pub fn new(name: &str, quiet: bool) -> Self {
        Self {
            name: name.to_owned(),
            since: Instant::now(),
            bar: None,
            wanted: !quiet && std::io::stderr().is_terminal(),
        }
    }
}

impl Progress for Bar {
    fn tick(&mut self, done: usize, total: usize) -> Flow {
        if self.wanted && self.bar.is_none() && self.since.elapsed() > PATIENCE {
            let style = ProgressStyle::with_template("{msg} {bar:40} {pos}/{len} rows, {eta} left");
            let bar = ProgressBar::new(total as u64);
            if let Ok(style) = style {
                bar.set_style(style);
            }
            bar.set_message(self.name.clone());
            self.bar = Some(bar);
        }
        if let Some(bar) = &self.bar {
            bar.set_position(done as u64);
            if done == total {
                bar.finish_and_clear();
            }
        }
        if interrupt::stopped() {
            Flow::Stop
        } else {
            Flow::Continue
        }
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
