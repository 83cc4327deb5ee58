//! The parts of a sweep, and the work from part to part.

use std::ops::Range;

use kempe_batch::Executor;
use kempe_motion::{Done, Progress, Stage};

use super::part::{Part, designs_in_part};
use super::question::Question;
use super::whole::is_of_designs;
use crate::designs::together::together;

/// Numbers in a file with rows of designs; what is more goes into further ones.
pub(super) const FILE_NUMBERS: f64 = (1_u64 << 29) as f64;
/// Files with rows at most; more rows are in no file.
const MOST_FILES: f64 = 16.0;

/// The parts of a sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Layout {
    designs: usize,
    in_part: usize,
    /// Numbers in the rows of a design, at most; none where rows are not kept.
    numbers: Option<f64>,
}

impl Layout {
    pub fn of(question: &Question<'_>) -> Self {
        let designs = question.designs.count();
        if is_of_designs(&question.bench.over.kind) {
            return Self::of_long(designs);
        }
        let columns = question.row_table().with_evidence().len();
        let numbers = question.most_rows() * columns as f64;
        Self {
            designs,
            in_part: designs_in_part(designs, numbers, false),
            numbers: Some(numbers),
        }
    }

    /// That of so many designs that each take long.
    pub fn of_long(designs: usize) -> Self {
        Self {
            designs,
            in_part: designs_in_part(designs, 0.0, true),
            numbers: None,
        }
    }

    /// Whether the rows of all designs are kept, and have room in files.
    pub fn row_room(&self) -> bool {
        let room = |numbers| numbers * self.designs as f64 <= MOST_FILES * FILE_NUMBERS;
        self.numbers.is_some_and(room)
    }

    /// Whether rows would be kept if they had room.
    pub fn has_rows(&self) -> bool {
        self.numbers.is_some()
    }

    /// The parts of each file with rows, none of which holds more than so many numbers, or more than one part.
    #[cfg(feature = "parquet")]
    pub fn row_files(&self, most: f64) -> Vec<Range<usize>> {
        let numbers = self.numbers.unwrap_or_default();
        let in_file = most / (numbers * self.in_part as f64).max(1.0);
        let in_file = (in_file as usize).max(1);
        let firsts = (0..self.count()).step_by(in_file);
        firsts
            .map(|first| first..(first + in_file).min(self.count()))
            .collect()
    }

    /// How many parts there are.
    pub fn count(&self) -> usize {
        self.designs.div_ceil(self.in_part)
    }

    /// The designs of a part.
    pub fn designs(&self, part: usize) -> Range<usize> {
        let first = part.saturating_mul(self.in_part).min(self.designs);
        first..first.saturating_add(self.in_part).min(self.designs)
    }
}

/// Designs that are handed to the executor together.
const TOGETHER: usize = 16;

/// A part as far as it was computed, and whether to go on.
pub(super) fn computed(
    question: &Question<'_>,
    designs: Range<usize>,
    rows: bool,
    executor: &dyn Executor,
    progress: &mut dyn Progress,
) -> (Part, bool) {
    let all = question.designs.count();
    let mut part = Part::new(question, rows);
    if is_of_designs(&question.bench.over.kind) {
        // One after the other: each has the whole machine.
        let reached = |progress: &mut dyn Progress, done| {
            progress
                .reached(Stage::Rows, Done::Of(done, all))
                .is_continue()
        };
        let goes_on = designs.into_iter().all(|index| {
            let answer = question.ask_long(index, executor, progress);
            // What was asked while the work was to stop may be cut short.
            let goes_on = reached(progress, index);
            if goes_on {
                part.push(question, index, answer);
            }
            goes_on && reached(progress, index + 1)
        });
        return (part, goes_on);
    }
    let goes_on = question.bench.watched(progress.watch(), || {
        let mut reached = |done| progress.reached(Stage::Rows, Done::Of(done, all));
        designs.clone().step_by(TOGETHER).all(|first| {
            let own = first..(first + TOGETHER).min(designs.end);
            let mut heard = |finished| reached(first + finished);
            let ask = |k| question.ask(first + k, rows);
            let watch = question.bench.watch();
            let (found, goes_on) = together(own.len(), executor, &watch, &mut heard, ask);
            for (answer, index) in found.into_iter().zip(own.clone()) {
                part.push(question, index, answer);
            }
            goes_on && reached(own.end).is_continue()
        })
    });
    (part, goes_on)
}
