//! Where the objective is nearly all that it can be by what it is, as a distance near nothing.
//!
//! There a norm is a cone, and what curvature was learnt says less the nearer its tip is. Its slope says how far that is: the step on which the largest
//! piece would come to the least is the way of B. T. Polyak (1969) where the least is known.

use super::super::local::{Local, Of};
use super::super::vector::dot;
use super::Descent;

/// It is nearly there within this part of its size, and there within the other.
const NEAR: f64 = 1e-2;
const THERE: f64 = 1e-12;
/// What such a step must leave of the way at most.
const LEFT: f64 = 0.5;

impl Descent<'_> {
    /// By how much a place is above the least, in the objective's size; infinite where no least is known.
    fn above(&self, place: &Local) -> f64 {
        let least = self.search.view.least() / self.search.sizes.objective;
        place.objective - least
    }

    /// Whether the objective is all that it can be.
    pub(super) fn is_least(&self) -> bool {
        self.above(&self.place) <= THERE
    }

    /// The place to which the slope of the largest piece leads down to the least, where it is near and that is most of the way; asked no more where it
    /// was not once.
    pub(super) fn towards_least(&mut self) -> Option<Local> {
        let above = self.above(&self.place);
        if !(self.aims && above < NEAR) {
            return None;
        }
        let pieces = self.place.parts.iter();
        let pieces = pieces.filter(|part| matches!(part.of, Of::Objective(_)));
        let largest = pieces.max_by(|a, b| a.value.total_cmp(&b.value))?;
        let steep = dot(&largest.slope, &largest.slope);
        if !(steep > 0.0) {
            return None;
        }
        let step: Vec<f64> = largest.slope.iter().map(|d| -d * above / steep).collect();
        self.aims = false;
        let design = self.search.space.moved(&self.place.design, &step, 1.0);
        let there = self.search.at(design)?;
        let kept = there.violation <= self.options.feasibility;
        self.aims = kept && self.above(&there) < LEFT * above;
        self.aims.then_some(there)
    }
}
