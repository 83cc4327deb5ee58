//! Proved bounds of the largest and smallest value that something takes along a proved motion.

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::ops::ControlFlow;

use kempe_number::Interval;

use super::{Cell, CertifiedMotion, Certifier};
use crate::krawczyk::Tube;

/// Stretches that are cut in two before what is known by then is told.
const CUTS: usize = 4000;

/// A proved stretch with the most that is there.
struct Piece {
    cell: Cell,
    tube: Tube,
    most: f64,
}

impl PartialEq for Piece {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Piece {}

impl PartialOrd for Piece {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Piece {
    fn cmp(&self, other: &Self) -> Ordering {
        self.most.total_cmp(&other.most)
    }
}

impl Certifier {
    /// Bounds of the largest value of something over a motion that is proved without a gap: cuts in two where most is possible,
    /// until the bounds are no wider than the part `narrow` of what they bound, or as near as that can be had. `bound` encloses
    /// its values over a proved stretch: all of them. `None` where it has none, where a stretch is not proved, and where it was
    /// stopped; `progress` hears of every cut.
    ///
    /// Branch and bound: every part of a proved stretch is proved anew, with a pose in common with the stretch, so that it holds the
    /// same branch.
    pub fn largest(
        &mut self,
        motion: &CertifiedMotion,
        narrow: f64,
        bound: &mut dyn FnMut(&Cell) -> Interval,
        progress: &mut dyn FnMut() -> ControlFlow<()>,
    ) -> Option<Interval> {
        if !motion.is_whole() {
            return None;
        }
        let mut least = f64::NEG_INFINITY;
        let mut heap = BinaryHeap::new();
        let mut push = |(cell, tube): (Cell, Tube), heap: &mut BinaryHeap<Piece>| {
            let values = bound(&cell);
            if !values.is_empty() {
                least = least.max(values.lo());
            }
            // Without bounds it may be anything.
            let most = if values.is_empty() {
                f64::INFINITY
            } else {
                values.hi()
            };
            heap.push(Piece { cell, tube, most });
            least
        };
        let mut known = f64::NEG_INFINITY;
        for cell in &motion.cells {
            known = push(self.cell(cell.from, cell.to).ok()?, &mut heap);
        }
        for _ in 0..CUTS {
            progress().is_continue().then_some(())?;
            let piece = heap.pop()?;
            if piece.most - known <= narrow * piece.most.abs().max(known.abs()) {
                heap.push(piece);
                break;
            }
            let (from, to) = (piece.cell.from, piece.cell.to);
            let middle = 0.5 * (from + to);
            let halves = [self.cell(from, middle).ok(), self.cell(middle, to).ok()];
            let [Some(low), Some(high)] = halves else {
                heap.push(piece);
                break;
            };
            let tubes = [&piece.tube, &low.1, &high.1];
            if middle <= from || to <= middle || !self.joins(&tubes, middle) {
                heap.push(piece);
                break;
            }
            push(low, &mut heap);
            known = push(high, &mut heap);
        }
        let most = heap.peek()?.most;
        (known.is_finite() && most.is_finite()).then(|| Interval::new(known, most.max(known)))
    }
}
