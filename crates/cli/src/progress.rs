//! A progress bar on the error stream, where that is a terminal and the work is long.

use std::io::IsTerminal;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use kempe_study::{Done, Progress, Stage, Watch};

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
    /// The best so far, in words.
    best: String,
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
            best: String::new(),
            wanted: !quiet && std::io::stderr().is_terminal(),
        }
    }

    /// The bar, once the work is long; a new one for every stage.
    fn bar(&mut self, stage: Stage, length: u64, template: &str) -> Option<&ProgressBar> {
        if !self.wanted || self.since.elapsed() <= PATIENCE {
            return None;
        }
        if self.stage != Some(stage) || self.bar.is_none() {
            if let Some(old) = self.bar.take() {
                old.finish_and_clear();
            }
            let bar = ProgressBar::new(length);
            if let Ok(style) = ProgressStyle::with_template(template) {
                bar.set_style(style);
            }
            (self.bar, self.stage) = (Some(bar), Some(stage));
            self.say();
        }
        self.bar.as_ref()
    }
}

impl Bar {
    /// What is done and, where there is any, the best so far.
    fn say(&self) {
        if let (Some(bar), Some(stage)) = (&self.bar, self.stage) {
            bar.set_message(message(&self.name, stage, &self.best));
        }
    }
}

/// What stands before a bar.
fn message(name: &str, stage: Stage, best: &str) -> String {
    match (stage, best) {
        (Stage::Searching, best) if !best.is_empty() => format!("{name}: best so far {best}"),
        _ => format!("{name}: {}", stage.text()),
    }
}

impl Progress for Bar {
    fn found(&mut self, best: &str) {
        best.clone_into(&mut self.best);
        self.say();
    }

    fn watch(&self) -> Watch {
        Watch::new(interrupt::stopped)
    }

    /// Stops on Ctrl-C.
    fn reached(&mut self, stage: Stage, done: Done) -> ControlFlow<()> {
        let (length, template) = match done {
            Done::Of(_, all) => (all as u64, "{msg} {bar:40} {pos}/{len}, {eta} left"),
            Done::Part(_) => (STEPS, "{msg} {bar:40} {percent} %"),
            Done::Unknown => (STEPS, "{msg}, {elapsed}"),
        };
        if let Some(bar) = self.bar(stage, length, template) {
            match (done, done.part()) {
                (Done::Of(done, all), _) => {
                    bar.set_position(done as u64);
                    if done == all {
                        bar.finish_and_clear();
                    }
                }
                (_, Some(part)) => bar.set_position((part * STEPS as f64) as u64),
                (_, None) => bar.tick(),
            }
        }
        match interrupt::stopped() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_so_far_stands_where_it_is_looked_for() {
        let of = |stage, best| message("lift", stage, best);
        assert_eq!(
            of(Stage::Searching, ""),
            "lift: looking for the best design"
        );
        assert_eq!(
            of(Stage::Searching, "peak = 3 N, limits kept"),
            "lift: best so far peak = 3 N, limits kept"
        );
        assert_eq!(
            of(Stage::Measuring, "peak = 3 N"),
            format!("lift: {}", Stage::Measuring.text())
        );
    }
}
