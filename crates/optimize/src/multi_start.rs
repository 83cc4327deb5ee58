//! All local optima that steps from many places lead to.
//!
//! The box is sampled evenly, cheaply and in batches; steps start, side by side, from the best places that are not near to each other, as in A. H. G.
//! Rinnooy Kan and G. T. Timmer's multi-start methods (1987). How this goes in rounds stands in `rounds.rs`.

use crate::problem::{self, Candidate, Problem, Scales};
use crate::progress::{Ended, Hears, Progress};
use crate::reached::{Reached, distinct};
use crate::rounds::{Begun, Followed, MultiStartOptions, followed};
use crate::space::Space;
use crate::sqp::{Optimum, SqpOptions, sqp};
use crate::standing::{Standing, worst_first};
use crate::workers::Workers;

/// Where no start leads to a design that keeps all constraints: samples for each variable, and starts.
const KEEPING: usize = 400;
const KEEPING_STARTS: usize = 12;

/// Local optima.
#[derive(Clone, Debug, PartialEq)]
pub struct Optima {
    /// Every distinct place that steps led to, with how many starts did, the best first; one that is no optimum says so by its end.
    pub optima: Vec<(Optimum, usize)>,
    /// The best sample and how it stands, should no start have become an optimum.
    pub best_sample: Option<(Candidate, Standing)>,
    /// Designs evaluated, all together.
    pub evaluations: usize,
    /// Of these so many to find one that keeps all constraints, where no start led to any.
    pub for_constraints: usize,
    /// Starts that were followed, but for these.
    pub starts: usize,
    /// Designs of them that were evaluated to find starts.
    pub samples: usize,
    /// What these led to.
    pub reached: Reached,
    /// Why it ended: [`Ended::Converged`] where all starts were followed.
    pub ended: Ended,
}

/// Local optima from all over the box.
///
/// Where no start leads to a design that keeps all constraints there may be some all the same: the box is sampled again, more densely, and more starts are
/// followed.
pub fn multi_start(
    problem: &dyn Problem,
    options: &MultiStartOptions,
    workers: &dyn Workers,
    hears: Hears,
) -> Optima {
    let space = Space::new(problem.bounds());
    let tolerance = options.sqp.feasibility;
    let begun = Begun::default();
    let mut first = followed(problem, options, begun, workers, hears);
    let scales = first.scales.clone();
    let mut all = first.evaluations;
    let mut for_constraints = 0;
    let left = |all: usize| options.evaluations.saturating_sub(all);
    let keeps = |it: &Optimum| it.violation <= tolerance;
    let goes_on = first.ended != Ended::Stopped && options.starts > 0;
    if goes_on && left(all) > 0 && !first.found.iter().any(keeps) {
        let more = keeping(
            problem,
            (options, left(all)),
            (all, &scales),
            workers,
            hears,
        );
        for_constraints = more.evaluations;
        all += more.evaluations;
        first.ended = more.ended;
        first.found.extend(more.found);
    }
    if first.ended != Ended::Stopped && left(all) > 0 && !first.found.iter().any(keeps) {
        let tried = first
            .best_sample
            .iter()
            .map(|(best, _)| best.design.clone());
        let tried = tried.chain(options.start.as_ref().map(|start| space.within(start)));
        if let Some(from) = less_violating(problem, (&first.found, &scales), tried.collect()) {
            let options = SqpOptions {
                evaluations: options.sqp.evaluations.min(left(all)),
                scales: Some(scales.clone()),
                ..options.sqp.clone()
            };
            let again = sqp(problem, &from, &options, workers, &mut |told| {
                hears(&Progress {
                    evaluations: all + told.evaluations,
                    budget: all + told.budget,
                    ..*told
                })
            });
            if again.ended == Ended::Stopped {
                first.ended = Ended::Stopped;
            }
            all += again.evaluations;
            first.found.push(again);
        }
    }
    Optima {
        optima: distinct(first.found, (&scales, tolerance), &space),
        best_sample: first.best_sample,
        evaluations: all,
        for_constraints,
        starts: first.starts,
        samples: first.samples,
        reached: first.reached,
        ended: first.ended,
    }
}

/// Looks for designs that keep all constraints, where starts or a population led to none, after so many designs and with so many at most.
pub(crate) fn keeping(
    problem: &dyn Problem,
    (options, left): (&MultiStartOptions, usize),
    (evaluations, scales): (usize, &Scales),
    workers: &dyn Workers,
    hears: Hears,
) -> Followed {
    let free = problem.bounds().iter().filter(|[low, high]| low < high);
    let samples = (KEEPING * free.count()).min(left / 2);
    let options = MultiStartOptions {
        samples: Some(samples),
        starts: KEEPING_STARTS.min(samples),
        further: None,
        start: None,
        evaluations: left,
        seed: options.seed.wrapping_add(1),
        ..options.clone()
    };
    let begun = Begun {
        evaluations,
        scales: Some(scales.clone()),
        ..Begun::default()
    };
    followed(problem, &options, begun, workers, hears)
}

/// A design that was tried and violates every constraint less than the best of what steps led to: each of these lessened the violation in scales of its own.
fn less_violating(
    problem: &dyn Problem,
    (found, scales): (&[Optimum], &Scales),
    tried: Vec<Vec<f64>>,
) -> Option<Vec<f64>> {
    let defined = found.iter().filter(|it| it.evaluation.is_defined());
    let best = defined.min_by(|a, b| worst_first(&a.evaluation, &b.evaluation, scales, 0.0))?;
    tried.into_iter().find(|design| {
        let own = problem::evaluate(problem, design);
        let mut both = own.constraints.iter().zip(&best.evaluation.constraints);
        own.is_defined() && both.all(|(own, best)| *own <= 0.0 || own < best)
    })
}
