//! What holds a design where constraints leave nothing inside of them.
//!
//! A constraint that is kept only where it is the least that it can be, as that a distance is nothing, has no inside (M. Slater, 1950): it is at its corner
//! there, and no multipliers need meet the conditions of first order with the slopes of one place. What it costs is by how much the objective falls where it is
//! eased a little: the multipliers of the optimum that there is then.

use crate::workers::Alone;

use super::super::local::Local;
use super::super::violation::View;
use super::super::{Optimum, SqpOptions};
use super::{Descent, RESTORATIONS};

/// By how much constraints are eased, in their scales: so little that what is curved beside them does not show.
const EASED: f64 = 1e-5;

/// So often a better place is gone to that the eased optimum shows, and what an objective is no better by than this part of its size is rounding.
const ROUNDS: usize = 4;
const SAME: f64 = 1e-7;

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
        let Some(view) = self.eased_view() else {
            return Inside::Unknown;
        };
        let mut apart = 0.0;
        for _ in 0..ROUNDS {
            let design = self.place.design.clone();
            let Some(found) = self.led(view.clone(), &design) else {
                break;
            };
            let (found, _) = found;
            if !found.ended.is_optimal() {
                break;
            }
            let sizes = &self.search.sizes;
            let eased = (0..sizes.constraints.len()).filter(|k| !self.search.view.is_eased(*k));
            let paid: f64 = eased
                .filter(|k| view.is_eased(*k))
                .map(|k| found.multipliers.cost(k) * EASED * sizes.constraints[k])
                .sum();
            let size = sizes.objective;
            let here = self.place.evaluation.largest();
            let better = here - found.objective();
            if better <= 2.0 * paid + SAME * size {
                return Inside::Held(Box::new(found));
            }
            apart = better / size;
            let Some((_, place)) = self.led(self.search.view.clone(), &found.design) else {
                break;
            };
            let kept = place.violation <= self.options.feasibility;
            if !(kept && place.evaluation.largest() < here) {
                break;
            }
            self.place = place;
        }
        match apart > 0.0 {
            true => Inside::Elsewhere(apart),
            false => Inside::Unknown,
        }
    }

    /// Where a descent leads to from a design, and what is told of it; `None` where nothing is left for it.
    fn led(&mut self, view: View<'a>, design: &[f64]) -> Option<(Optimum, Local)> {
        let options = SqpOptions {
            evaluations: (self.search.allowed).saturating_sub(self.search.evaluations),
            ..self.options.clone()
        };
        let is_eased = view.eased.iter().any(Option::is_some);
        let mut inner = (options.evaluations > 0)
            .then(|| Self::of(view, design, &options).ok())
            .flatten()?;
        inner.restorations = RESTORATIONS;
        let ended = loop {
            if let Some(ended) = inner.step(&Alone) {
                break ended;
            }
        };
        let place = inner.place.clone();
        let found = match is_eased {
            true => inner.end(ended),
            false => Optimum {
                slopes: inner.search.slopes,
                ..Optimum::undefined(
                    place.design.clone(),
                    (place.evaluation.clone(), inner.scales.clone()),
                    inner.search.evaluations,
                )
            },
        };
        self.search.evaluations += found.evaluations;
        self.search.slopes += found.slopes;
        Some((found, place))
    }

    /// The problem with the constraints eased that have no inside; `None` where all have one.
    fn eased_view(&self) -> Option<View<'a>> {
        let mut view = self.search.view.clone();
        if view.violation.is_some() {
            return None;
        }
        let sizes = &self.search.sizes.constraints;
        view.eased.resize(sizes.len(), None);
        let mut any = false;
        for (k, size) in sizes.iter().enumerate() {
            let has_none = view.problem.least_of(k) >= -self.options.feasibility * size;
            if has_none && !view.is_eased(k) {
                view.eased[k] = Some(EASED * size);
                any = true;
            }
        }
        any.then_some(view)
    }
}
