//! Local optima with their multipliers: sequential quadratic programming.
//!
//! The objective is the largest of its pieces, and so is every constraint. Minimised is a level that no piece of the objective may
//! exceed (the epigraph form). The number of pieces changes from iterate to iterate, as peaks of a motion come and
//! go, so a library with a fixed number of constraints does not serve.
//!
//! Each step minimises the linearised pieces with a curvature (`curvature.rs`), the largest violation weighed as a second
//! level (`local.rs`, `quadratic.rs` of the crate). That is the penalty `objective + weight * largest violation` itself, linearised, so a
//! quadratic programme is never infeasible (the elastic mode), and its step always lessens the penalty (R. Fletcher's S-l-infinity-QP,
//! 1985). The weight rises by the steering rules of R. H. Byrd, J. Nocedal and R. A. Waltz (2008). Steps are searched in
//! `search.rs`. Where the violation comes to rest, `violation.rs` minimises it alone.

mod curvature;
mod local;
mod search;
mod violation;

use crate::problem::{self, Evaluation, Problem, Scales};
use crate::progress::{Ended, Hears, Progress};
use crate::quadratic::{Minimum, minimise};
use crate::space::Space;
use curvature::Curvature;
use local::{Local, Sizes};
use search::{Search, Step};

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
/// How often the violation alone is minimised at most.
const RESTORATIONS: usize = 3;

/// Limits and tolerances.
#[derive(Clone, Debug, PartialEq)]
pub struct SqpOptions {
    /// Steps at most.
    pub iterations: usize,
    /// Designs evaluated at most, besides those whose slopes are asked.
    pub evaluations: usize,
    /// The largest residual of the first-order conditions, in the objective's scale for the whole width of the box.
    pub optimality: f64,
    /// The same, where rounding keeps steps from lessening it.
    pub settled: f64,
    /// The largest violation of a constraint, in its scale.
    pub feasibility: f64,
    /// Where the problem names no scales, they are the larger of value and slope (over the box's width) at the start, and not less than
    /// these.
    pub least: Option<Scales>,
}

impl Default for SqpOptions {
    fn default() -> Self {
        Self {
            iterations: 300,
            evaluations: 3000,
            optimality: 1e-8,
            settled: 1e-6,
            feasibility: 1e-9,
            least: None,
        }
    }
}

/// What a local optimum hangs on: by how much the objective would fall if something were eased by one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Multipliers {
    /// The share of every piece of every objective; they sum to one.
    pub objectives: Vec<Vec<f64>>,
    /// Of every piece of every constraint.
    pub constraints: Vec<Vec<f64>>,
    /// Of the least and of the largest value of every variable.
    pub bounds: Vec<[f64; 2]>,
}

impl Multipliers {
    /// By how much the objective would fall for each unit that a constraint is eased: the sum over its pieces.
    pub fn cost(&self, constraint: usize) -> f64 {
        let pieces = self.constraints.get(constraint);
        pieces.map_or(0.0, |pieces| pieces.iter().sum())
    }
}

/// Where local minimisation ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Optimum {
    /// The design.
    pub design: Vec<f64>,
    /// What it is worth.
    pub evaluation: Evaluation,
    /// What it hangs on. Where [`Ended::Infeasible`], all are zero but those of [`conflict`](Self::conflict).
    pub multipliers: Multipliers,
    /// How far the first-order conditions (W. Karush 1939, H. W. Kuhn and A. W. Tucker 1951) are missed: the largest component of the
    /// Lagrangian's slope over the box's width, or the multipliers times what their pieces are below the largest, in the
    /// objective's scale. Where [`Ended::Infeasible`], those of the least violation.
    pub residual: f64,
    /// The largest violation of a constraint, in its scale.
    pub violation: f64,
    /// Where [`Ended::Infeasible`]: constraints that cannot be kept together, with their shares of the multipliers of the least
    /// largest violation. They sum to one; the largest are first.
    pub conflict: Vec<(usize, f64)>,
    /// The scales that residual and violation count in.
    pub scales: Scales,
    /// Steps taken.
    pub iterations: usize,
    /// Designs evaluated.
    pub evaluations: usize,
    /// Designs whose slopes were asked.
    pub slopes: usize,
    /// Why it ended.
    pub ended: Ended,
}

impl Optimum {
    /// The largest objective.
    pub fn objective(&self) -> f64 {
        self.evaluation.largest()
    }

    /// Nothing but a design.
    fn undefined(design: Vec<f64>, evaluation: Evaluation, evaluations: usize) -> Self {
        Self {
            design,
            evaluation,
            multipliers: Multipliers::default(),
            residual: f64::INFINITY,
            violation: f64::INFINITY,
            conflict: Vec::new(),
            scales: Scales::default(),
            iterations: 0,
            evaluations,
            slopes: 0,
            ended: Ended::Undefined,
        }
    }
}

/// The local minimum that steps from a start lead to, of the largest objective subject to the constraints, within the box.
pub fn sqp(
    problem: &mut dyn Problem,
    start: &[f64],
    options: &SqpOptions,
    hears: Hears,
) -> Optimum {
    let space = Space::new(problem.bounds());
    if !space.holds(start.len()) {
        let nothing = Evaluation::lacking(f64::INFINITY);
        return Optimum::undefined(start.to_vec(), nothing, 0);
    }
    let design = space.within(start);
    let evaluation = problem::evaluate(problem, std::slice::from_ref(&design)).swap_remove(0);
    let slopes = (evaluation.is_defined())
        .then(|| problem::slopes(problem, &design))
        .flatten();
    let Some(slopes) = slopes else {
        return Optimum::undefined(design, evaluation, 1);
    };
    let (objectives, constraints) = (problem.objectives(), problem.constraints());
    let fits = |s: &Scales| s.fits(objectives, constraints);
    let scales = problem.scales().filter(fits).unwrap_or_else(|| {
        let own = Sizes::of(&slopes, &space);
        match options.least.as_ref().filter(|s| fits(s)) {
            Some(least) => own.at_least(least),
            None => own,
        }
    });
    let sizes = Sizes::new(&scales);
    let place = Local::new(design, evaluation, &slopes, &sizes, &space);
    let mut run = Run {
        curvature: Curvature::first(&place),
        search: Search {
            problem,
            space,
            sizes,
            evaluations: 1,
            slopes: 1,
        },
        options,
        place,
        weight: WEIGHT,
        radius: f64::INFINITY,
        unheard: 0,
        narrowed: 0,
        iterations: 0,
        restorations: 0,
        conflict: Vec::new(),
        missed: f64::INFINITY,
    };
    let ended = run.steps(hears);
    run.answer(ended, scales)
}

/// A minimisation on its way.
struct Run<'a, 'b> {
    search: Search<'a>,
    options: &'b SqpOptions,
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
    iterations: usize,
    restorations: usize,
    conflict: Vec<(usize, f64)>,
    /// How far the conditions of the least violation are missed, where that is the answer.
    missed: f64,
}

impl Run<'_, '_> {
    /// Goes on until there is a reason to end.
    fn steps(&mut self, hears: Hears) -> Ended {
        loop {
            let spent = self.search.evaluations >= self.options.evaluations;
            if spent || self.iterations >= self.options.iterations {
                return self.kept_or(Ended::Budget, hears);
            }
            if self.tell(hears) {
                return Ended::Stopped;
            }
            self.iterations += 1;
            let Some((minimum, at_rest)) = self.programme() else {
                if self.curvature.is_fresh() {
                    return self.kept_or(Ended::Stuck, hears);
                }
                self.renew();
                continue;
            };
            if at_rest {
                match self.restore(hears) {
                    Some(ended) => return ended,
                    None => continue,
                }
            }
            let kept = self.place.violation <= self.options.feasibility;
            let residual = self.place.residual(
                &minimum,
                &self.curvature.times(&minimum.step),
                &self.search.space,
                self.radius,
            );
            if kept && residual <= self.options.optimality {
                return Ended::Converged;
            }
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
            let mut next = None;
            if self.unheard <= UNHEARD {
                next = self.search.whole(&self.place, step);
            }
            if worth && next.is_none() {
                if self.place.parts.len() > 1 && self.narrowed < NARROWED {
                    self.narrowed += 1;
                    self.radius = NARROWER * length(&minimum.step);
                    continue;
                }
                next = self.search.shorter(&self.place, step);
            }
            match next {
                Some(next) => {
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
                None => return self.kept_or(Ended::Stuck, hears),
            }
        }
    }

    /// Forgets what was learnt on the way.
    fn renew(&mut self) {
        self.curvature = Curvature::first(&self.place);
        self.radius = f64::INFINITY;
        self.narrowed = 0;
    }

    /// Whether whoever listens says that it is enough.
    fn tell(&self, hears: Hears) -> bool {
        let progress = Progress {
            evaluations: self.search.evaluations,
            budget: self.options.evaluations,
            best: Some((&self.place.design, self.place.evaluation.largest())),
            violation: self.place.violation,
        };
        hears(&progress).is_break()
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

    /// Goes to where the largest violation is least, and on from there if that is nothing; otherwise why it ends.
    fn restore(&mut self, hears: Hears) -> Option<Ended> {
        if self.restorations >= RESTORATIONS {
            return Some(Ended::Stuck);
        }
        self.restorations += 1;
        let found = violation::least(&mut self.search, &self.place, self.options, hears);
        let better = found.violation() < self.place.violation;
        if better && let Some(place) = self.search.at(found.design.clone()) {
            self.place = place;
        }
        self.renew();
        match found.ended {
            Ended::Stopped if self.place.violation > self.options.feasibility => {
                Some(Ended::Stopped)
            }
            _ if self.place.violation <= self.options.feasibility => None,
            ended if ended.is_optimal() => {
                self.conflict = found.conflict;
                self.missed = found.residual;
                Some(Ended::Infeasible)
            }
            Ended::Budget => Some(Ended::Budget),
            _ => Some(Ended::Stuck),
        }
    }

    /// This end where the constraints are kept; otherwise first the least violation is looked for.
    fn kept_or(&mut self, ended: Ended, hears: Hears) -> Ended {
        match self.place.violation > self.options.feasibility {
            true if self.restorations < RESTORATIONS => match self.restore(hears) {
                Some(other) => other,
                None if ended == Ended::Budget => ended,
                None => self.steps(hears),
            },
            _ => ended,
        }
    }

    /// What was found.
    fn answer(mut self, ended: Ended, scales: Scales) -> Optimum {
        // Once with the curvature, once without: the multipliers that miss the conditions by less.
        let unit = Curvature::unit(self.place.design.len());
        let mut best: Option<(f64, Minimum)> = None;
        for curvature in [&self.curvature, &unit] {
            let programme = self.place.programme(
                curvature.matrix(),
                self.weight,
                &self.search.space,
                f64::INFINITY,
            );
            if let Ok(minimum) = minimise(&programme) {
                let residual = self.place.residual(
                    &minimum,
                    &curvature.times(&minimum.step),
                    &self.search.space,
                    f64::INFINITY,
                );
                if best.as_ref().is_none_or(|(other, _)| residual < *other) {
                    best = Some((residual, minimum));
                }
            }
        }
        let residual = best
            .as_ref()
            .map_or(f64::INFINITY, |(residual, _)| *residual);
        let kept = self.place.violation <= self.options.feasibility;
        let ended = match ended {
            Ended::Stuck if kept && residual <= self.options.optimality => Ended::Converged,
            Ended::Stuck if kept && residual <= self.options.settled => Ended::Settled,
            ended => ended,
        };
        let residual = match ended {
            Ended::Infeasible => self.missed,
            _ => residual,
        };
        let shares = best.filter(|_| ended != Ended::Infeasible);
        let shares = shares.map(|(_, minimum)| minimum.multipliers);
        let multipliers =
            self.place
                .multipliers(shares.as_deref(), &self.search.sizes, &self.search.space);
        self.conflict
            .sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        Optimum {
            design: self.place.design,
            evaluation: self.place.evaluation,
            multipliers,
            residual,
            violation: self.place.violation,
            conflict: self.conflict,
            scales,
            iterations: self.iterations,
            evaluations: self.search.evaluations,
            slopes: self.search.slopes,
            ended,
        }
    }
}

/// The largest component.
fn length(step: &[f64]) -> f64 {
    step.iter().fold(0.0, |m, x| m.max(x.abs()))
}
