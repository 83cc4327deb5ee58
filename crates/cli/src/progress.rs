//! A progress bar on the error stream, where that is a terminal and the work is long.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use kempe_study::{Flow, Progress, Stage};

use crate::interrupt;

/// Work shorter than this shows no bar.
const PATIENCE: Duration = Duration::from_millis(400);

/// Steps of the bar for what is done before the first row.
const STEPS: u64 = 1000;

/// Shows how far a study has come, and stops it on Ctrl-C.
pub struct Bar {
    name: String,
    since: Instant,
    bar: Option<ProgressBar>,
    stage: Option<Stage>,
    wanted: bool,
}

impl Bar {
    /// A bar for a study; silent when quiet or piped.
    pub fn new(name: &str, quiet: bool) -> Self {
        Self {
            name: name.to_owned(),
            since: Instant::now(),
            bar: None,
            stage: None,
            wanted: !quiet && std::io::stderr().is_terminal(),
        }
    }

    /// The bar, once the work is long; a new one for every stage.
    fn bar(&mut self, stage: Option<Stage>, length: u64, template: &str) -> Option<&ProgressBar> {
        if !self.wanted || self.since.elapsed() <= PATIENCE {
            return None;
        }
        if self.stage != stage || self.bar.is_none() {
            if let Some(old) = self.bar.take() {
                old.finish_and_clear();
            }
            let bar = ProgressBar::new(length);
            if let Ok(style) = ProgressStyle::with_template(template) {
                bar.set_style(style);
            }
            bar.set_message(match stage {
                Some(stage) => format!("{}: {}", self.name, stage.text()),
                None => self.name.clone(),
            });
            (self.bar, self.stage) = (Some(bar), stage);
        }
        self.bar.as_ref()
    }
}

/// Stops on Ctrl-C.
fn flow() -> Flow {
    if interrupt::stopped() {
        Flow::Stop
    } else {
        Flow::Continue
    }
}

impl Progress for Bar {
    fn tick(&mut self, done: usize, total: usize) -> Flow {
        let rows = "{msg} {bar:40} {pos}/{len} rows, {eta} left";
        if let Some(bar) = self.bar(None, total as u64, rows) {
            bar.set_position(done as u64);
            if done == total {
                bar.finish_and_clear();
            }
        }
        flow()
    }

    fn stage(&mut self, stage: Stage, part: Option<f64>) -> Flow {
        let template = match part {
            Some(_) => "{msg} {bar:40} {percent} %",
            None => "{msg}, {elapsed}",
        };
        if let Some(bar) = self.bar(Some(stage), STEPS, template) {
            match part {
                Some(part) => bar.set_position((part.clamp(0.0, 1.0) * STEPS as f64) as u64),
                None => bar.tick(),
            }
        }
        flow()
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
