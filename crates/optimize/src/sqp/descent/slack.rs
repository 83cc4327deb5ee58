//! Constraints that are slack and seem to hold a place all the same.
//!
//! Beside its pole a constraint is kept by far, and its slope is decades more than anywhere else: it leaves no step that shows, and the first-order conditions
//! count as met. Whether it holds anything is seen without it.

use crate::quadratic::{Minimum, minimise};
use crate::workers::Workers;

use super::super::local::{Local, Of};
use super::super::vector::length;
use super::rescaled::MISSED;
use super::{Descent, HOLDS};

/// What is tried of a step without them.
const PARTS: [f64; 4] = [1.0, 0.3, 0.1, 0.03];

impl Descent<'_> {
    /// A place that is better by more than rounding, a step away that constraints which are slack by more than rounding would not allow.
    pub(super) fn past_slack(&mut self, minimum: &Minimum, workers: &dyn Workers) -> Option<Local> {
        let mut multipliers = minimum.multipliers.iter();
        let here = &self.place.evaluation.constraints;
        let typical = self.options.typical.as_ref();
        let may_be_pole = |k: usize| match typical.map(|it| it.constraints.get(k)) {
            Some(Some(typical)) => here[k].abs() > *typical,
            Some(None) => false,
            None => true,
        };
        let (mut open, mut slack) = (self.place.clone(), Vec::new());
        open.parts.retain(|part| {
            let steepest = length(&part.slope);
            let holds = multipliers.next().is_some_and(|m| m * steepest > HOLDS);
            match part.of {
                Of::Constraint(k) if holds && part.value < -MISSED && may_be_pole(k) => {
                    slack.push(k)
                }
                _ => return true,
            }
            false
        });
        if slack.is_empty() {
            return None;
        }
        let hessian = self.curvature.matrix();
        let programme = open.programme(hessian, self.weight, &self.search.space, f64::INFINITY);
        let step = minimise(&programme).ok()?.step;
        let ways = PARTS.map(|part| step.iter().map(|d| part * d).collect());
        let past = self.search.below(&self.place, &ways, self.weight, workers);
        let past = past.map(|(_, place)| place)?;
        // No other constraint comes to less where its slope says that it is missed by far.
        let (here, there) = (&self.place.evaluation, &past.evaluation);
        let [here, there] = [here, there].map(|it| &it.constraints);
        let is_pole = |k: &usize| there[*k].abs() < here[*k].abs();
        slack.iter().all(is_pole).then_some(past)
    }
}
