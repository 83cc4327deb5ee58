//! What holds a design where constraints leave nothing inside of them.
//!
//! A constraint that is kept only where it is the least that it can be, as that a distance is nothing, has no inside (M. Slater, 1950): it is at its corner
//! there, and no multipliers need meet the conditions of first order with the slopes of one place. What it costs is by how much the objective falls where it is
//! eased a little: the multipliers of the optimum that there is then.

use crate::workers::Alone;

use super::super::violation::View;
use super::super::{Optimum, SqpOptions};
use super::{Descent, RESTORATIONS};

/// By how much constraints are eased, in their scales: so little that what is curved beside them does not show.
const EASED: f64 = 1e-5;

impl<'a> Descent<'a> {
    /// The optimum beside a place that keeps all constraints where those without an inside are eased; `None` where all have one, or no optimum is found.
    pub(super) fn inside(&mut self) -> Option<Optimum> {
        let view = self.eased_view()?;
        let options = SqpOptions {
            evaluations: (self.search.allowed).saturating_sub(self.search.evaluations),
            ..self.options.clone()
        };
        let mut inner = (options.evaluations > 0)
            .then(|| Self::of(view, &self.place.design, &options).ok())
            .flatten()?;
        inner.restorations = RESTORATIONS;
        let ended = loop {
            if let Some(ended) = inner.step(&Alone) {
                break ended;
            }
        };
        let found = inner.end(ended);
        self.search.evaluations += found.evaluations;
        self.search.slopes += found.slopes;
        found.ended.is_optimal().then_some(found)
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
