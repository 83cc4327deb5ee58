//! One descent, from step to step.

mod conflicts;
mod ending;
mod inside;
mod least;
mod rescaled;
mod slack;

use crate::problem::{Evaluation, Problem, Scales};
use crate::progress::{Ended, Progress};
use crate::quadratic::{Minimum, minimise};
use crate::space::Space;
use crate::workers::Workers;

use super::curvature::Curvature;
use super::local::{Local, Of, Sizes, scaled};
use super::optimum::Optimum;
use super::options::SqpOptions;
use super::search::{Search, Step};
use super::unseen::Seen;
use super::vector::length;
use super::violation::View;

/// The weight of the largest violation, when the work starts; it rises by the factor as long as needed.
const WEIGHT: f64 = 10.0;
const WEIGHT_FACTOR: f64 = 10.0;
const MOST_WEIGHT: f64 = 1e10;
/// What part of the best lessening of the violation a step must reach.
const STEERED: f64 = 0.5;
/// A violation that no step lessens by this part is at rest.
const AT_REST: f64 = 1e-6;
/// A step that promises less than this part of the penalty is rounding.
const PROMISE: f64 = 1e-15;
/// A step that is too long although it was corrected is asked again, each component at most this part of it, so often before
/// shorter ones are tried along it; a radius that sufficed grows by the factor.
const NARROWER: f64 = 0.3;
const NARROWED: usize = 4;
const WIDER: f64 = 4.0;
/// So many steps one after the other may lessen the residual without any that shows in the penalty.
const UNHEARD: usize = 4;
/// While the violation alone is minimised, what is eased is so by this much more, in its scale, so that it holds nothing that bounds hold already.
const EASED: f64 = 1e-8;
/// How often the violation alone is minimised at most.
const RESTORATIONS: usize = 3;
/// How often a place of rest is left by a way that was not taken.
const LEAVES: usize = 4;
/// Where so many steps one after the other lead to where nothing can be evaluated, and are cut there, the edge is sought, so often in a descent.
const PASSED: usize = 4;
const EDGES: usize = 6;
/// The normal of an edge is known by differences: what it holds by no better than by this part.
const EDGE_KNOWN: f64 = 1e-6;
/// How often scales are taken anew at most.
const RESCALINGS: usize = 8;
/// A multiplier larger than this holds a design, in the objective's size for the box.
const HOLDS: f64 = 1e-9;

/// A place that keeps the constraints, as far as these are not eased, and where a descent came to rest.
struct Rest {
    place: Local,
    curvature: Curvature,
    ended: Ended,
    /// How many groups of constraints were known then to contradict each other: they are eased there.
    conflicts: usize,
}

/// A minimisation on its way.
pub(crate) struct Descent<'a> {
    search: Search<'a>,
    options: SqpOptions,
    place: Local,
    curvature: Curvature,
    /// Of the largest violation in the penalty.
    weight: f64,
    /// Steps' components are at most this.
    radius: f64,
    /// How many steps one after the other promised less than rounding shows.
    unheard: usize,
    /// How often the radius was made smaller here.
    narrowed: usize,
    /// How many steps one after the other led beyond the edge of what can be evaluated.
    passed: usize,
    /// How often that may still be sought.
    edges: usize,
    /// Directions that it went.
    seen: Seen,
    /// Whether steps to where the objective is all it can be have led there so far.
    aims: bool,
    /// How often it may leave a place of rest.
    leaves: usize,
    /// The best place of rest that it left.
    left: Option<Rest>,
    iterations: usize,
    restorations: usize,
    /// The violation alone is minimised first, and how to end if it then is nothing.
    restoring: Option<(Box<Descent<'a>>, Option<Ended>)>,
    /// Constraints that contradict each other, with their shares, and others that do where these are eased.
    conflicts: Vec<Vec<(usize, f64)>>,
    /// How far the conditions of the least violations are missed.
    missed: f64,
    scales: Scales,
    /// How often it may still take new ones.
    rescalings: usize,
    /// Functions that were steep where it took those at hand.
    steep: Vec<Of>,
    /// Whether what was learnt of the curvature is partly that of other scales.
    stale: bool,
}

impl<'a> Descent<'a> {
    /// At a start.
    ///
    /// # Errors
    ///
    /// What there is of a start that cannot be evaluated or has no derivatives.
    pub fn begin(
        problem: &'a dyn Problem,
        start: &[f64],
        options: &SqpOptions,
    ) -> Result<Self, Box<Optimum>> {
        let view = View {
            problem,
            violation: None,
            eased: Vec::new(),
            left_out: Vec::new(),
        };
        let named = view.scales().or_else(|| options.scales.clone()).is_some();
        let mut descent = Self::of(view, start, options)?;
        descent.rescalings = if named { 0 } else { RESCALINGS };
        descent.steep = descent.steep();
        Ok(descent)
    }

    fn of(view: View<'a>, start: &[f64], options: &SqpOptions) -> Result<Self, Box<Optimum>> {
        let [objectives, constraints] = view.functions();
        let fits = |s: &Scales| s.fits(objectives, constraints);
        let given = view.scales().or_else(|| options.scales.clone());
        let given = given.filter(fits);
        let least = options.least.as_ref().filter(|s| fits(s));
        let undefined = |design: Vec<f64>, evaluation: Evaluation, count: usize| {
            let scales = given.as_ref().or(least).cloned();
            let scales = scales.unwrap_or_else(|| Scales::unit(objectives, constraints));
            let told = (evaluation, scales);
            Box::new(Optimum::undefined(design, told, count))
        };
        let space = Space::new(view.problem.bounds());
        if !space.holds(start.len()) {
            let nothing = Evaluation::lacking(f64::INFINITY);
            return Err(undefined(start.to_vec(), nothing, 0));
        }
        let design = space.within(start);
        let evaluation = view.evaluate(&design);
        let slopes = (evaluation.is_defined())
            .then(|| view.slopes(&design))
            .flatten();
        let Some(slopes) = slopes else {
            return Err(undefined(design, evaluation, 1));
        };
        let scales = given.unwrap_or_else(|| {
            let own = Sizes::of(&slopes, &space);
            match least {
                Some(least) => own.at_least(least),
                None => own,
            }
        });
        let sizes = Sizes::new(&scales);
        let place = Local::new(design, evaluation, &slopes, &sizes, &space);
        Ok(Self {
            curvature: Curvature::first(&place),
            search: Search {
                view,
                space,
                sizes,
                evaluations: 1,
                allowed: options.evaluations,
                slopes: 1,
                feasibility: options.feasibility,
                bare: None,
                passed: false,
            },
            options: options.clone(),
            place,
            weight: WEIGHT,
            radius: f64::INFINITY,
            unheard: 0,
            narrowed: 0,
            passed: 0,
            edges: EDGES,
            seen: Seen::default(),
            aims: true,
            leaves: LEAVES,
            left: None,
            iterations: 0,
            restorations: 0,
            restoring: None,
            conflicts: Vec::new(),
            missed: 0.0,
            scales,
            rescalings: 0,
            steep: Vec::new(),
            stale: false,
        })
    }

    /// Designs evaluated.
    pub fn evaluations(&self) -> usize {
        let inner = self
            .restoring
            .as_ref()
            .map_or(0, |(it, _)| it.evaluations());
        self.search.evaluations + inner
    }

    /// Allows so many more evaluations for what a step looks for beside it; a step that is begun is finished.
    pub fn allow(&mut self, more: usize) {
        let spent = self.search.evaluations;
        self.search.allowed = (self.options.evaluations).min(spent.saturating_add(more));
        if let Some((inner, _)) = &mut self.restoring {
            inner.allow(more);
        }
    }

    /// The design, its largest objective and violation.
    pub fn at(&self) -> (&[f64], f64, f64) {
        let place = &self.place;
        (
            &place.design,
            place.evaluation.largest(),
            self.violation(place.evaluation.clone()),
        )
    }

    /// The largest violation of what is not eased.
    fn violation(&self, evaluation: Evaluation) -> f64 {
        let own = self.search.view.not_eased(evaluation);
        scaled(&own, &self.search.sizes).1.max(0.0)
    }

    /// How far it has come.
    pub fn progress(&self) -> Progress<'_> {
        let (design, value, violation) = self.at();
        Progress {
            evaluations: self.evaluations(),
            budget: self.options.evaluations,
            best: Some((design, value)),
            violation,
        }
    }

    /// One step; why it ends, where there is a reason.
    pub fn step(&mut self, workers: &dyn Workers) -> Option<Ended> {
        let ended = self.in_scales(workers);
        self.rescaled(ended, workers)
    }

    /// The same, as it is in the scales at hand.
    fn in_scales(&mut self, workers: &dyn Workers) -> Option<Ended> {
        if let Some((inner, _)) = &mut self.restoring {
            // What is kept is enough.
            let ended = match inner.meets_all() {
                true => Some(Ended::Stopped),
                false => inner.step(workers),
            };
            return ended.and_then(|ended| self.restored(ended));
        }
        let spent = self.search.evaluations >= self.options.evaluations;
        if spent || self.iterations >= self.options.iterations {
            return self.kept_or(Ended::Budget);
        }
        self.iterations += 1;
        let Some((minimum, at_rest)) = self.programme() else {
            if self.curvature.is_fresh() {
                return self.kept_or(Ended::Stuck);
            }
            self.renew();
            return None;
        };
        if at_rest {
            return self.restore(None);
        }
        let kept = self.place.violation <= self.options.feasibility;
        if kept && self.is_least() {
            return Some(Ended::Stuck);
        }
        let residual = self.place.residual(
            &minimum,
            &self.curvature.times(&minimum.step),
            &self.search.space,
            self.radius,
        );
        let held_by_edge = self.place.held_by_edge(&minimum.multipliers);
        let is_held = held_by_edge > HOLDS;
        if kept && residual <= self.options.optimality + EDGE_KNOWN * held_by_edge {
            return self.rest(&minimum, Ended::Converged, workers);
        }
        let aimed = match kept && !is_held {
            true => self.towards_least(),
            false => None,
        };
        let penalty = self.place.penalty(self.weight);
        let promise = penalty - self.place.promised(&minimum, self.weight);
        let worth = promise > PROMISE * penalty.abs().max(self.place.size());
        let step = Step {
            minimum: &minimum,
            curvature: &self.curvature,
            weight: self.weight,
            radius: self.radius,
            promise,
        };
        self.unheard = if worth { 0 } else { self.unheard + 1 };
        let mut next = aimed;
        if next.is_some() {
            self.unheard = 0;
        } else if is_held {
            if worth {
                next = self.search.along_edge(&self.place, step);
            }
        } else if self.unheard <= UNHEARD {
            next = self.search.whole(&self.place, step);
        }
        if worth && next.is_none() && !is_held {
            if self.place.parts.len() > 1 && self.narrowed < NARROWED {
                self.narrowed += 1;
                self.radius = NARROWER * length(&minimum.step);
                return None;
            }
            self.passed = if self.search.passed {
                self.passed + 1
            } else {
                0
            };
            if self.passed >= PASSED {
                self.meet_edge(&minimum);
                return None;
            }
            next = self.search.shorter(&self.place, step, workers);
        }
        match next {
            Some(next) => {
                let step = self.search.space.step(&self.place.design, &next.design);
                self.seen.learn(&step);
                self.curvature
                    .update(&self.place, &next, &minimum, &self.search.space);
                self.radius = match self.narrowed {
                    0 => self.radius * WIDER,
                    _ => self.radius.max(length(&minimum.step)),
                };
                self.narrowed = 0;
                self.place = next;
            }
            None if !self.curvature.is_fresh() => self.renew(),
            None if !is_held && self.meet_edge(&minimum) => {}
            None if kept => return self.rest(&minimum, Ended::Stuck, workers),
            None => return self.kept_or(Ended::Stuck),
        }
        None
    }

    /// This end, unless a way that it never took leads down from here: then it goes on there.
    fn rest(&mut self, minimum: &Minimum, ended: Ended, workers: &dyn Workers) -> Option<Ended> {
        if self.leaves == 0 {
            return Some(ended);
        }
        if let Some(place) = self.past_slack(minimum, workers) {
            self.leaves -= 1;
            self.place = place;
            self.renew();
            return None;
        }
        let allowed = (self.options.evaluations).saturating_sub(self.search.evaluations);
        let n = self.place.design.len();
        let held = self.place.held(minimum, HOLDS, &self.search.space);
        let mut ways = self.seen.ways(&held, n);
        ways.truncate(allowed);
        let Some((way, place)) = self.search.below(&self.place, &ways, self.weight, workers) else {
            return Some(ended);
        };
        self.leaves -= 1;
        self.seen.learn(&ways[way]);
        let rest = Rest {
            place: std::mem::replace(&mut self.place, place),
            curvature: self.curvature.clone(),
            ended,
            conflicts: self.conflicts.len(),
        };
        let value = |rest: &Rest| rest.place.evaluation.largest();
        if self
            .left
            .as_ref()
            .is_none_or(|best| value(&rest) < value(best))
        {
            self.left = Some(rest);
        }
        self.renew();
        None
    }

    /// Whether there is an edge of what can be evaluated on the way of a step, beside which it then goes on.
    fn meet_edge(&mut self, minimum: &Minimum) -> bool {
        self.passed = 0;
        if self.edges == 0 {
            return false;
        }
        self.edges -= 1;
        let Some(edge) = self.search.edge_ahead(&self.place, &minimum.step) else {
            return false;
        };
        let place = self.place.clone();
        self.place = place.beside(Some(edge), &self.search.space);
        self.renew();
        true
    }

    /// Forgets what was learnt on the way.
    fn renew(&mut self) {
        self.curvature = Curvature::first(&self.place);
        self.radius = f64::INFINITY;
        self.narrowed = 0;
    }

    /// The next step, with the weight raised as far as the violation asks for it, and whether no step lessens the violation.
    fn programme(&mut self) -> Option<(Minimum, bool)> {
        let tolerance = self.options.feasibility;
        let solve = |weight: f64| {
            minimise(&self.place.programme(
                self.curvature.matrix(),
                weight,
                &self.search.space,
                self.radius,
            ))
            .ok()
        };
        let mut minimum = solve(self.weight)?;
        let left = |m: &Minimum| m.levels.get(1).copied().unwrap_or(0.0);
        let now = self.place.violation;
        if now <= tolerance || left(&minimum) <= tolerance {
            return Some((minimum, false));
        }
        let least = minimise(&self.place.feasibility(&self.search.space, self.radius)).ok()?;
        let least = least.levels.first().copied().unwrap_or(0.0).max(0.0);
        if now - least <= AT_REST * now {
            return Some((minimum, true));
        }
        let enough = match least <= tolerance {
            true => tolerance,
            false => now - STEERED * (now - least),
        };
        while left(&minimum) > enough && self.weight < MOST_WEIGHT {
            self.weight *= WEIGHT_FACTOR;
            minimum = solve(self.weight)?;
        }
        Some((minimum, false))
    }

    /// Begins to go to where the largest violation is least. Where that is nothing, it goes on from there, or ends so.
    fn restore(&mut self, then: Option<Ended>) -> Option<Ended> {
        let view = &self.search.view;
        let all_eased = (0..view.problem.constraints()).all(|k| view.is_eased(k));
        if self.restorations >= RESTORATIONS || all_eased {
            return Some(Ended::Stuck);
        }
        self.restorations += 1;
        let options = SqpOptions {
            evaluations: (self.options.evaluations)
                .saturating_sub(self.search.evaluations)
                .max(self.options.evaluations / 4),
            least: None,
            ..self.options.clone()
        };
        let sizes = self.search.sizes.clone();
        let eased = view.eased.iter().zip(&sizes.constraints);
        let view = View {
            problem: view.problem,
            eased: eased
                .map(|(eased, size)| eased.map(|by| by + EASED * size))
                .collect(),
            violation: Some(sizes),
            left_out: Vec::new(),
        };
        match Self::of(view, &self.place.design, &options) {
            Ok(mut inner) => {
                inner.restorations = RESTORATIONS;
                self.restoring = Some((Box::new(inner), then));
                None
            }
            Err(_) => Some(Ended::Stuck),
        }
    }

    /// Takes over where the violation is least, now that looking for it has ended; why all ends, where it does.
    fn restored(&mut self, ended: Ended) -> Option<Ended> {
        let (inner, then) = self.restoring.take()?;
        let view = inner.search.view.clone();
        let found = inner.end(ended);
        self.search.evaluations += found.evaluations;
        self.search.slopes += found.slopes + 1;
        // What is eased is missed by no more: the worst comes first. Where there is hardly any room left, the rest may be as little only nearly.
        let nearly =
            !self.conflicts.is_empty() && found.ended == Ended::Stuck && found.violation <= EASED;
        if let Some(place) = self.search.at(found.design.clone())
            && (nearly || place.violation < self.place.violation)
        {
            self.place = place;
        }
        self.renew();
        match found.ended {
            _ if self.place.violation <= self.options.feasibility => then,
            ended if ended.is_optimal() || nearly => {
                let all = view.conflict(&found.design, &found.multipliers);
                let groups = self.groups(&view, &found.design, &all);
                self.conflicts.extend(groups);
                self.missed = self.missed.max(found.residual);
                match self.ease(found.objective(), &all) {
                    true => then,
                    false => Some(Ended::Infeasible),
                }
            }
            Ended::Budget => Some(Ended::Budget),
            // It met all with what is eased by a little more, which rounding takes away here: nobody stopped it.
            _ => Some(Ended::Stuck),
        }
    }

    /// Whether, where the violation alone is minimised, there is none.
    fn meets_all(&self) -> bool {
        let kept = self.place.violation <= self.options.feasibility;
        kept && self.place.evaluation.largest() <= 0.0
    }

    /// Eases the constraints that contradict each other by this much, in their scales, so that the others are kept as far as they can be, and the objective
    /// is not forgotten. `false` where there is nothing to ease, or a place that keeps all is known.
    fn ease(&mut self, by: f64, conflict: &[(usize, f64)]) -> bool {
        let view = &mut self.search.view;
        if self.left.is_some() || view.violation.is_some() {
            return false;
        }
        view.eased.resize(view.problem.constraints(), None);
        let new: Vec<usize> = (conflict.iter())
            .map(|(constraint, _)| *constraint)
            .filter(|constraint| !view.is_eased(*constraint))
            .collect();
        if new.is_empty() {
            return false;
        }
        for (constraint, _) in conflict {
            let size = self.search.sizes.constraints[*constraint];
            let eased = &mut view.eased[*constraint];
            *eased = Some(match *eased {
                // So much more was it eased where this was found.
                Some(before) => before + EASED * size,
                None => by * size,
            });
        }
        // What it was worth where less was eased.
        self.search.bare = None;
        let Some(place) = self.search.at(self.place.design.clone()) else {
            // The place at hand is worth what it was before.
            for constraint in &new {
                self.search.view.eased[*constraint] = None;
            }
            return false;
        };
        self.place = place;
        self.restorations = 0;
        self.weight = WEIGHT;
        self.renew();
        true
    }

    /// This end where the constraints are kept; otherwise first the least violation is looked for.
    fn kept_or(&mut self, ended: Ended) -> Option<Ended> {
        let missed = self.place.violation > self.options.feasibility;
        match missed && self.restorations < RESTORATIONS {
            true => self.restore((ended == Ended::Budget).then_some(ended)),
            false => Some(ended),
        }
    }
}
