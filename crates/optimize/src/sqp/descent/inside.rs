//! What holds a design where constraints leave nothing inside of them.
//!
//! A constraint that is kept only where it is the least that it can be, as that a distance is nothing, has no inside (M. Slater, 1950): it is at its corner
//! there, and no multipliers need meet the conditions of first order with the slopes of one place. What it costs is by how much the objective falls where it is
//! eased a little: the multipliers of the optimum that there is then.

use crate::progress::Ended;
use crate::workers::Alone;

use super::super::optimum::Optimum;
use super::super::options::SqpOptions;
use super::super::violation::View;
use super::{Descent, RESTORATIONS};

/// By how much constraints are eased, in their scales, one after the other: at last by so little that what is curved beside them does not show. Along what is
/// curved steps are the longer the more there is room.
const EASED: [f64; 5] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5];
/// So often a better place is gone to that the eased optimum shows.
const ROUNDS: usize = 4;
/// An objective that is better by less than this part of its size is as good.
const SAME: f64 = 1e-9;

/// What holds a place.
pub(super) enum Inside {
    /// All constraints have an inside, or nothing is known of what there is where they are eased.
    Unknown,
    /// It is this optimum with the constraints eased.
    Held(Box<Optimum>),
    /// A better place is known, better by this part of the objective's size, and is not reached with all constraints kept.
    Elsewhere(f64),
}

impl<'a> Descent<'a> {
    /// What holds the place, by the optimum beside it where those constraints are eased that have no inside. Where that optimum is better than what it is
    /// eased by explains, the place is none: it is led on from there.
    pub(super) fn inside(&mut self) -> Inside {
        let without = self.without_inside();
        if without.is_empty() {
            return Inside::Unknown;
        }
        let size = self.search.sizes.objective;
        let mut known = Inside::Unknown;
        for _ in 0..ROUNDS {
            let Some((found, paid)) = self.eased_optimum(&without) else {
                break;
            };
            let here = self.place.evaluation.largest();
            let again = self.led(self.search.view.clone(), &found.design);
            if let Some((again, _)) = again {
                self.search.evaluations += again.search.evaluations;
                self.search.slopes += again.search.slopes;
                let kept = again.place.violation <= self.options.feasibility;
                let better = here - again.place.evaluation.largest();
                if kept && better > 0.0 {
                    self.place = again.place;
                }
                // From the better place all is asked again.
                if kept && better > SAME * size {
                    known = Inside::Elsewhere(better / size);
                    continue;
                }
            }
            let better = self.place.evaluation.largest() - found.objective();
            let apart = (better - paid).abs();
            return match apart <= paid + SAME * size {
                true => Inside::Held(Box::new(found)),
                false => Inside::Elsewhere(apart / size),
            };
        }
        known
    }

    /// The optimum where constraints are eased as little as they are, and what that brings by their costs; `None` where none as good as the place is found. Where
    /// much room at first leads away to what has no way back, less of it is tried.
    fn eased_optimum(&mut self, without: &[usize]) -> Option<(Optimum, f64)> {
        let here = self.place.evaluation.largest();
        (0..EASED.len()).step_by(2).find_map(|first| {
            let found = self.eased_from(without, &EASED[first..]);
            found.filter(|(found, _)| found.objective() <= here)
        })
    }

    fn eased_from(&mut self, without: &[usize], parts: &[f64]) -> Option<(Optimum, f64)> {
        let mut design = self.place.design.clone();
        let mut last = None;
        for part in parts {
            let (view, by) = self.eased_view(without, *part);
            let (inner, ended) = self.led(view, &design)?;
            let found = inner.end(ended);
            self.search.evaluations += found.evaluations;
            self.search.slopes += found.slopes;
            design.clone_from(&found.design);
            let costs = by.iter().map(|(k, by)| found.multipliers.cost(*k) * by);
            let paid = costs.sum();
            last = found.ended.is_optimal().then_some((found, paid));
        }
        last
    }

    /// A descent from a design at its end; `None` where nothing is left for it.
    fn led(&self, view: View<'a>, design: &[f64]) -> Option<(Self, Ended)> {
        let left = (self.search.allowed).saturating_sub(self.search.evaluations);
        let options = SqpOptions {
            evaluations: left,
            ..self.options.clone()
        };
        let mut inner = match left {
            0 => None,
            _ => Self::of(view, design, &options).ok(),
        }?;
        inner.restorations = RESTORATIONS;
        loop {
            if let Some(ended) = inner.step(&Alone) {
                return Some((inner, ended));
            }
        }
    }

    /// Constraints that have no inside.
    fn without_inside(&self) -> Vec<usize> {
        let view = &self.search.view;
        let sizes = self.search.sizes.constraints.iter().enumerate();
        // Where the violation alone is minimised there is nothing to cost.
        let without = sizes.filter(|(k, size)| {
            let least = view.problem.least_of(*k);
            least >= -self.options.feasibility * **size && !view.is_eased(*k)
        });
        let without = without.filter(|_| view.violation.is_none());
        without.map(|(k, _)| k).collect()
    }

    /// The problem with constraints eased by a part of their scales, and by how much each is.
    fn eased_view(&self, which: &[usize], part: f64) -> (View<'a>, Vec<(usize, f64)>) {
        let mut view = self.search.view.clone();
        let sizes = &self.search.sizes.constraints;
        let eased: Vec<(usize, f64)> = which.iter().map(|k| (*k, part * sizes[*k])).collect();
        view.eased.resize(sizes.len(), None);
        for (k, by) in &eased {
            view.eased[*k] = Some(*by);
        }
        (view, eased)
    }
}
