//! How much of the demanded motion is proved, in the words of the file.

use std::fmt::Write as _;

use kempe_draw::report::{Block, Section};
use kempe_model::{Diagnostic, Model};
use kempe_motion::Stage;
use kempe_motion::drive_path::DrivePath;
use kempe_motion::events::EventKind;
use kempe_proof::{Subdivision, certify_motion};
use kempe_units::Dimension;
use serde::Serialize;

use crate::prepared::{design, motion};
use crate::proved_numbers::{ProvedNumber, prove_numbers};
use crate::unit::Units;
use kempe_motion::progress::{Done, Progress};

/// What is proved of a motion by interval arithmetic.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct Proof {
    /// What runs: the drive's name, or `time`.
    pub along: String,
    /// The range that the drives' laws demand, with units.
    pub range: String,
    /// Proved part of the range, 0 to 1.
    pub fraction: f64,
    /// Longest stretches proved to be one smooth branch, with units.
    pub runs: Vec<String>,
    /// What is not proved.
    pub gaps: Vec<Unproved>,
    /// Redundant constraint rows that are left out of the proof.
    pub redundant: usize,
    /// False when it was stopped on the way: what comes after is in neither list.
    pub finished: bool,
    /// The model's numbers over the motion.
    pub numbers: Vec<ProvedNumber>,
}

/// A stretch that is not proved.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct Unproved {
    /// Where, with units.
    pub place: String,
    /// Why.
    pub reason: String,
    /// It holds a limit or a change point, where nothing can be proved by these means.
    pub expected: bool,
}

/// Proves the demanded motion of a model, stretch by stretch: that for every place of the drive there is exactly one
/// pose near the one followed, and that it moves smoothly. See [`kempe_proof::certify`] for what that says.
///
/// # Errors
///
/// What keeps the motion from starting; see [`run`](crate::run).
pub fn prove(model: &Model, progress: &mut dyn Progress) -> Result<Proof, Vec<Diagnostic>> {
    let design = design(model);
    let motion = motion(&design, progress)?;
    let found = certify_motion(&motion, Subdivision::default(), |part| {
        progress.reached(Stage::Proving, Done::Part(part))
    });
    let units = Units::of(model);
    let drive = match motion.path {
        DrivePath::Coordinate { drive, .. } => model.drives.get(drive),
        DrivePath::Time { .. } => None,
    };
    let (along, dimension) = drive.map_or(("time", Dimension::TIME), |d| {
        (d.name.as_str(), d.dimension)
    });
    let range = |from: f64, to: f64| units.range_text((from, to), dimension);
    let gaps = found.gaps.iter().map(|gap| {
        let event = gap.event.map_or("", |kind| match kind {
            EventKind::Limit => ", at a limit of the drive",
            EventKind::ChangePoint => ", at a change point",
            EventKind::ModeChange => ", where an assembly mode changes",
        });
        Unproved {
            place: range(gap.from, gap.to),
            reason: format!("{}{event}", gap.reason.describe(&design.mechanism)),
            expected: gap.event.is_some(),
        }
    });
    let (low, high) = motion.demanded;
    let reached = match high > low {
        true => (found.range.1 - found.range.0) / (high - low),
        false => 1.0,
    };
    let beyond = [(low, found.range.0), (found.range.1, high)].into_iter();
    let beyond =
        beyond.filter(|(from, to)| from < to && !(motion.reaches(*from) && motion.reaches(*to)));
    let beyond = beyond.map(|(from, to)| Unproved {
        place: range(from, to),
        reason: "the motion does not come there".to_owned(),
        expected: false,
    });
    Ok(Proof {
        along: along.to_owned(),
        range: range(low, high),
        // Nothing proved is a plain 0, however it was summed up.
        fraction: (found.fraction * reached).clamp(0.0, 1.0) + 0.0,
        runs: found.runs.iter().map(|(a, b)| range(*a, *b)).collect(),
        gaps: gaps.chain(beyond).collect(),
        redundant: found.redundant,
        finished: found.finished,
        numbers: prove_numbers(&motion, &found, progress),
    })
}

impl Proof {
    /// Whether all of the range is proved, without a gap, and no number is outside of its bounds.
    pub fn is_whole(&self) -> bool {
        let contradicted = self.numbers.iter().any(|n| n.contradicted);
        self.finished && self.redundant == 0 && self.gaps.is_empty() && !contradicted
    }

    /// What is proved and what is not, as labels with what they say.
    fn facts(&self) -> Vec<(&'static str, String)> {
        // Rounded down: 100 % is said of all of it only.
        let percent = (self.fraction * 1e6).floor() / 1e4;
        let along = &self.along;
        let mut facts = vec![(
            "Proved",
            format!(
                "{percent} % of {along} {}: one pose near the one followed, moving smoothly",
                self.range
            ),
        )];
        facts.extend(
            self.runs
                .iter()
                .map(|run| ("One run", format!("{along} {run}"))),
        );
        let gaps = self.gaps.iter();
        facts
            .extend(gaps.map(|gap| ("Left out", format!("{along} {}: {}", gap.place, gap.reason))));
        if self.redundant > 0 {
            let text = match self.redundant {
                1 => "1 redundant constraint row: that it agrees cannot be proved".to_owned(),
                rows => {
                    format!("{rows} redundant constraint rows: that they agree cannot be proved")
                }
            };
            facts.push(("Without", text));
        }
        if !self.finished {
            facts.push(("Stopped", "what comes after is not known".to_owned()));
        }
        facts
    }

    /// The proof as a section of a report.
    pub fn section(&self) -> Section {
        let facts = self.facts().into_iter();
        let mut blocks = vec![Block::Facts(
            facts
                .map(|(label, text)| (label.to_owned(), text))
                .collect(),
        )];
        if !self.numbers.is_empty() {
            let rows = self.numbers.iter();
            blocks.push(Block::Table {
                head: vec!["Number over the motion".to_owned(), "Proved".to_owned()],
                rows: rows.map(|n| vec![n.name.clone(), n.told.clone()]).collect(),
            });
        }
        Section {
            title: "Proof".to_owned(),
            blocks,
        }
    }

    /// The proof as plain text.
    pub fn to_text(&self) -> String {
        let mut out = String::from("\nProof\n");
        for (label, text) in self.facts() {
            let _ = writeln!(out, "  {label:8}  {text}");
        }
        let wide = self.numbers.iter().map(|n| n.name.len()).max();
        for number in &self.numbers {
            let (name, wide) = (&number.name, wide.unwrap_or(0));
            let _ = writeln!(out, "  Number    {name:wide$}  {}", number.told);
        }
        out
    }
}
