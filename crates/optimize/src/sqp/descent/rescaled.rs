//! New scales, where those of the start say nothing any more.
//!
//! Scales are what functions come to where a descent begins. Beside a pole, as a force beside a dead point, that is decades more than anywhere else, and
//! at the end conditions would count as met, and constraints as kept, that are missed by far. So scales are looked at again, at the end and on the way: where
//! they have fallen much, it goes on from there in new ones.

use crate::halton::halton;
use crate::problem::{Scales, evaluate_all};
use crate::progress::Ended;
use crate::workers::Workers;

use super::super::local::{Of, Sizes};
use super::super::vector::length;
use super::{Descent, EDGES, LEAVES, WEIGHT};

/// Scales that are more than so many times what functions come to now have fallen.
const FALLEN: f64 = 100.0;
/// A violation of less than this, in its scale, is rounding.
pub(super) const MISSED: f64 = 1e-12;
/// A constraint that is kept by no more than this, in its scale, seems to hold.
const NEAR: f64 = 1e-6;
/// A function is steep where its value is less than this part of its slope over the box.
const STEEP: f64 = 1e-4;
/// Designs of the box, and their seed, that tell what functions typically come to: a scale is not less than that, as one that vanishes at its optimum would
/// have none.
const SAMPLES: usize = 32;
const SEED: u64 = 0x7363_616c;

impl Descent<'_> {
    /// Takes new scales where those that it counts in have fallen, and goes on; otherwise it ends so, or goes on as it is.
    pub(super) fn rescaled(
        &mut self,
        ended: Option<Ended>,
        workers: &dyn Workers,
    ) -> Option<Ended> {
        if self.rescalings == 0 || self.restoring.is_some() {
            return ended;
        }
        let ended = ended.map(|ended| self.back(ended));
        // What was learnt in other scales may lead nowhere. With constraints eased there is none that keeps them.
        if ended == Some(Ended::Stuck) && self.stale && self.conflicts.is_empty() {
            self.start_anew();
            return None;
        }
        let own = self.here(ended.is_some());
        // Before it is asked what functions come to elsewhere.
        if !self.has_fallen(&own) {
            return ended;
        }
        let known = self.options.typical.take();
        let Some(typical) = known.or_else(|| self.typical(workers)) else {
            self.rescalings = 0;
            return ended;
        };
        let of = |own: &[f64], typical: &[f64], old: &[f64]| -> Vec<f64> {
            let typical = typical.iter().chain(std::iter::repeat(&f64::INFINITY));
            let all = own.iter().zip(typical).zip(old);
            all.map(|((own, typical), old)| own.max(*typical).min(*old))
                .collect()
        };
        let old = &self.scales;
        let mut new = Scales {
            objectives: of(&own.objectives, &typical.objectives, &old.objectives),
            constraints: of(&own.constraints, &typical.constraints, &old.constraints),
        };
        // A slope is a scale wherever it is: what is missed by no more than a part of it is missed by as little in the box.
        let problem = self.search.view.problem;
        if !typical.constraints.is_empty() {
            for (k, new) in new.constraints.iter_mut().enumerate() {
                let steep = self.steep.contains(&Of::Constraint(k));
                // What is kept only where it is the least that it can be has neither value nor slope there.
                let has_inside = problem.least_of(k) < 0.0;
                if own.constraints[k] > 0.0 && has_inside && !steep {
                    *new = new.min(own.constraints[k]);
                }
            }
        }
        self.options.typical = Some(typical);
        let new = match &self.options.least {
            Some(least) => new.at_least(least),
            None => new,
        };
        if !self.has_fallen(&new) {
            return ended;
        }
        let before = (
            std::mem::replace(&mut self.search.sizes, Sizes::new(&new)),
            std::mem::take(&mut self.search.view.eased),
        );
        let Some(place) = self.search.at(self.place.design.clone()) else {
            (self.search.sizes, self.search.view.eased) = before;
            return ended;
        };
        self.rescalings -= 1;
        self.scales = new;
        self.place = place;
        self.steep = self.steep();
        let learnt = self.curvature.clone();
        self.start_anew();
        if ended.is_none() {
            self.curvature = learnt;
            let by = before.0.objective / self.search.sizes.objective;
            self.curvature.grow(by);
            self.stale = true;
        }
        ended.filter(|ended| *ended == Ended::Budget)
    }

    /// Begins again at the place.
    fn start_anew(&mut self) {
        self.stale = false;
        self.search.bare = None;
        (self.weight, self.unheard, self.passed, self.edges) = (WEIGHT, 0, 0, EDGES);
        (self.aims, self.leaves, self.left) = (true, LEAVES, None);
        (self.restorations, self.missed) = (0, 0.0);
        self.conflicts.clear();
        self.renew();
    }

    /// Whether some scales are much less than those at hand.
    fn has_fallen(&self, new: &Scales) -> bool {
        let sizes = Sizes::new(new);
        let fallen = |old: f64, new: f64| old > FALLEN * new;
        let constraints = self.search.sizes.constraints.iter();
        fallen(self.search.sizes.objective, sizes.objective)
            || (constraints.zip(&sizes.constraints)).any(|(old, new)| fallen(*old, *new))
    }

    /// What functions come to at the place: the larger of value and slope over the box. Where it ends, of those whose scales are those of a slope beside a
    /// pole the value alone: of the objective, and of constraints that seem to hold and are missed, or kept, by more than rounding.
    fn here(&self, ends: bool) -> Scales {
        let (sizes, kept) = (&self.search.sizes, self.options.feasibility);
        let mut own = Scales {
            objectives: vec![0.0; self.scales.objectives.len()],
            constraints: vec![0.0; self.scales.constraints.len()],
        };
        for part in &self.place.parts {
            let (of, size, counts) = match part.of {
                Of::Objective(k) => (&mut own.objectives[k], sizes.objective, true),
                Of::Constraint(k) => {
                    let holds = -NEAR <= part.value && part.value <= kept;
                    let counts = holds && part.value.abs() > MISSED;
                    (&mut own.constraints[k], sizes.constraints[k], counts)
                }
                Of::Edge => continue,
            };
            let of_value = ends && counts && self.steep.contains(&part.of);
            let steepest = if of_value { 0.0 } else { length(&part.slope) };
            *of = of.max(size * part.value.abs().max(steepest));
        }
        own
    }

    /// Functions whose scales are their slopes, beside which their values are little.
    pub(super) fn steep(&self) -> Vec<Of> {
        let parts = &self.place.parts;
        let is_little = |of: Of| {
            let mut own = parts.iter().filter(|part| part.of == of);
            own.all(|part| part.value.abs() < STEEP)
        };
        let mut all: Vec<Of> = parts.iter().map(|part| part.of).collect();
        all.dedup();
        all.retain(|of| is_little(*of));
        all
    }

    /// What functions come to in the middle of designs from all over the box; `None` where none of these can be evaluated.
    fn typical(&mut self, workers: &dyn Workers) -> Option<Scales> {
        let (problem, space) = (self.search.view.problem, &self.search.space);
        let designs = halton(SEED, SAMPLES, space.bounds.len());
        let designs: Vec<Vec<f64>> = designs.iter().map(|u| space.design(u)).collect();
        let all = evaluate_all(problem, &designs, workers);
        self.search.evaluations += all.len();
        let known = all.iter().any(|it| it.is_defined());
        known.then(|| Scales::typical(&all, problem.objectives(), problem.constraints()))
    }
}
