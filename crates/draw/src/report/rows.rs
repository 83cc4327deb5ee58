//! The rows of a motion that the page carries.

use super::motion_report::MotionReport;

/// Most poses and rows that a report carries of one motion; more are thinned out evenly.
pub const MOST_ROWS: usize = 2000;

/// The rows of a motion that the page carries.
pub(super) struct Rows {
    /// How many the motion has.
    pub all: usize,
    /// Those that are kept.
    pub kept: Vec<usize>,
}

impl Rows {
    pub fn of(motion: &MotionReport) -> Rows {
        let columns = motion.columns.iter().map(|c| c.values.len());
        let all = columns.fold(motion.frames.len(), usize::min);
        let stride = all.div_ceil(MOST_ROWS).max(1);
        let mut kept: Vec<usize> = (0..all).step_by(stride).collect();
        if kept.last().is_some_and(|last| last + 1 < all) {
            kept.push(all - 1);
        }
        Rows { all, kept }
    }

    /// The kept row nearest to a row.
    pub fn nearest(&self, row: usize) -> usize {
        let after = self
            .kept
            .partition_point(|k| *k < row)
            .min(self.kept.len().saturating_sub(1));
        let before = after.saturating_sub(1);
        let gap = |k: usize| self.kept.get(k).map_or(usize::MAX, |r| r.abs_diff(row));
        if gap(before) < gap(after) {
            before
        } else {
            after
        }
    }
}
