//! A whole motion, proved stretch by stretch.

use std::ops::ControlFlow;
use std::sync::Arc;

use kempe_motion::motion::Motion;
use kempe_motion::trace::Path;

use super::{CertifiedMotion, Certifier};
use crate::krawczyk::Tube;
use crate::not_proved::NotProved;

/// How finely a motion is cut up for its proof.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Subdivision {
    /// Stretches to begin with, between events.
    pub start: usize,
    /// A stretch that is not wider than this (in path scales: rad for an angle) and not proved becomes a gap.
    pub narrowest: f64,
}

impl Default for Subdivision {
    fn default() -> Self {
        Self {
            start: 8,
            narrowest: 1e-6,
        }
    }
}

/// Proofs tried in each of the stretches to begin with, before what is left of it becomes gaps as it is. A limit or a change
/// point takes about a hundred.
const TRIES: usize = 1000;

/// Proves a whole motion, stretch by stretch: see [`Certifier::motion`].
pub fn certify_motion(
    motion: &Arc<Motion>,
    subdivision: Subdivision,
    progress: impl FnMut(f64) -> ControlFlow<()>,
) -> CertifiedMotion {
    Certifier::new(motion).motion(subdivision, progress)
}

impl Certifier {
    /// Covers the motion with proved stretches, cutting in two what can not be proved until it is narrow.
    ///
    /// `progress` is told the finished part after every stretch and may stop the work.
    pub fn motion(
        &mut self,
        subdivision: Subdivision,
        mut progress: impl FnMut(f64) -> ControlFlow<()>,
    ) -> CertifiedMotion {
        let range = self.motion.reached();
        let scale = self.motion.path.scale();
        let mut it = CertifiedMotion {
            range,
            cells: Vec::new(),
            gaps: Vec::new(),
            runs: Vec::new(),
            fraction: 0.0,
            redundant: self.surplus.len(),
            finished: true,
        };
        let mut stack = self.stretches(range, subdivision.start.max(1));
        stack.reverse();
        let mut others = stack.len();
        let mut last: Option<Tube> = None;
        let mut tries = 0;
        while let Some((from, to)) = stack.pop() {
            let middle = 0.5 * (from + to);
            // With the last piece of a stretch to begin with, what follows is another.
            if stack.len() < others {
                (others, tries) = (stack.len(), 0);
            }
            tries += 1;
            match self.cell(from, to) {
                Ok((mut cell, tube)) => {
                    cell.joined = last.as_ref().is_some_and(|before| {
                        before.range.hi() == from && self.joins(&[before, &tube], from)
                    });
                    it.take_cell(cell);
                    last = Some(tube);
                }
                Err(_)
                    if to - from > subdivision.narrowest * scale
                        && from < middle
                        && middle < to =>
                {
                    if tries < TRIES {
                        stack.extend([(middle, to), (from, middle)]);
                        continue;
                    }
                    it.take_gap(from, to, NotProved::Spent);
                }
                Err(reason) => it.take_gap(from, to, reason),
            }
            let part = (to - range.0) / (range.1 - range.0);
            if progress(if part.is_nan() { 1.0 } else { part }).is_break() {
                it.finished = stack.is_empty();
                break;
            }
        }
        for gap in &mut it.gaps {
            let events = &self.motion.places;
            let met = events.iter().find(|e| gap.from <= e.at && e.at <= gap.to);
            gap.event = met.map(|e| e.kind);
        }
        let proved = it.cells.iter().fold(0.0, |sum, c| sum + (c.to - c.from));
        it.fraction = match it.gaps.is_empty() && it.finished {
            true if !it.cells.is_empty() => 1.0,
            _ if range.0 == range.1 => 0.0,
            _ => proved / (range.1 - range.0),
        };
        it
    }

    /// Stretches to begin with: `parts` between any two places where something is not smooth.
    fn stretches(&self, range: (f64, f64), parts: usize) -> Vec<(f64, f64)> {
        let mut ends = vec![range.0, range.1];
        ends.extend(self.motion.places.iter().map(|e| e.at));
        ends.extend(&self.knots);
        ends.retain(|p| range.0 <= *p && *p <= range.1);
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        // What stands still has one pose.
        let mut stretches = match ends.len() {
            1 => vec![(ends[0], ends[0])],
            _ => Vec::new(),
        };
        for pair in ends.windows(2) {
            let at = |k: usize| match k {
                0 => pair[0],
                _ if k == parts => pair[1],
                _ => pair[0] + (pair[1] - pair[0]) * (k as f64 / parts as f64),
            };
            stretches.extend((0..parts).map(|k| (at(k), at(k + 1))));
        }
        stretches
    }
}
