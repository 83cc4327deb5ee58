//! All local optima that steps from many places lead to.
//!
//! The box is sampled evenly, cheaply and in batches; steps start, side by side, from the best places that are not near to each other, as in A. H. G.
//! Rinnooy Kan and G. T. Timmer's multi-start methods (1987).

use crate::halton::halton;
use crate::problem::{self, Problem, Scales, exactly, nearly};
use crate::progress::{Ended, Hears, Progress};
use crate::space::Space;
use crate::sqp::{Going, Optimum, SqpOptions, side_by_side, sqp};
use crate::standing::{Candidate, Standing, ranked, worst_first};
use crate::workers::Workers;

/// Samples for each variable, if nothing else is asked.
const SAMPLES: usize = 100;
/// Where no start leads to a design that keeps all constraints: samples for each variable, and starts.
const KEEPING: usize = 400;
const KEEPING_STARTS: usize = 12;
/// Samples evaluated at once.
const BATCH: usize = 32;
/// Starts are at least this part of the box apart at first; half of it, and so on, where there are not enough.
const APART: f64 = 0.25;
/// Optima nearer than this part of the box whose objectives agree to the other part are one.
const NEAR: f64 = 1e-3;
const AGREE: f64 = 1e-6;

/// Limits.
#[derive(Clone, Debug, PartialEq)]
pub struct MultiStartOptions {
    /// Designs that are evaluated to find starts; `None`: a hundred for each variable.
    pub samples: Option<usize>,
    /// From how many of them steps start.
    pub starts: usize,
    /// A design from which steps start besides, wherever it is.
    pub start: Option<Vec<f64>>,
    /// Designs evaluated at most, all together; what is begun then is finished.
    pub evaluations: usize,
    /// Of each start.
    pub sqp: SqpOptions,
    /// What all chance comes from.
    pub seed: u64,
}

impl Default for MultiStartOptions {
    fn default() -> Self {
        Self {
            samples: None,
            starts: 12,
            start: None,
            evaluations: usize::MAX,
            sqp: SqpOptions::default(),
            seed: 1,
        }
    }
}

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
    let mut first = followed(problem, options, (0, None), workers, hears);
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
            (all, Some(&scales)),
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
    let mut reached: Vec<(Optimum, usize)> = Vec::new();
    for optimum in first.found {
        add(&mut reached, optimum, &space);
    }
    Optima {
        optima: sorted(reached, &scales, tolerance),
        best_sample: first.best_sample,
        evaluations: all,
        for_constraints,
        starts: first.starts,
        ended: first.ended,
    }
}

/// Starts that were followed.
pub(crate) struct Followed {
    /// Where each led to.
    pub found: Vec<Optimum>,
    /// Designs evaluated.
    pub evaluations: usize,
    /// [`Ended::Stopped`] or [`Ended::Converged`].
    pub ended: Ended,
    best_sample: Option<(Candidate, Standing)>,
    scales: Scales,
    starts: usize,
}

/// Looks for designs that keep all constraints, where starts or a population led to none, after so many designs and with so many at most.
pub(crate) fn keeping(
    problem: &dyn Problem,
    (options, left): (&MultiStartOptions, usize),
    before: (usize, Option<&Scales>),
    workers: &dyn Workers,
    hears: Hears,
) -> Followed {
    let free = problem.bounds().iter().filter(|[low, high]| low < high);
    let samples = (KEEPING * free.count()).min(left / 2);
    let options = MultiStartOptions {
        samples: Some(samples),
        starts: KEEPING_STARTS.min(samples),
        start: None,
        evaluations: left,
        seed: options.seed.wrapping_add(1),
        ..options.clone()
    };
    followed(problem, &options, before, workers, hears)
}

/// Samples of the box, and where steps from the best of them lead to, after so many designs and in these scales, if they are known.
fn followed(
    problem: &dyn Problem,
    options: &MultiStartOptions,
    (before, scales): (usize, Option<&Scales>),
    workers: &dyn Workers,
    hears: Hears,
) -> Followed {
    let space = Space::new(problem.bounds());
    let n = space.bounds.len();
    let samples = match options.starts {
        0 => 0,
        starts => options.samples.unwrap_or(SAMPLES * n).max(starts),
    };
    let given = usize::from(options.start.is_some());
    let budget = samples + (options.starts + given) * options.sqp.evaluations;
    let budget = budget.min(options.evaluations);
    let mut hears = |told: &Progress| {
        hears(&Progress {
            evaluations: before + told.evaluations,
            budget: before + told.budget,
            ..*told
        })
    };
    let (candidates, mut ended) = sample(
        problem,
        (options.seed, samples),
        budget,
        workers,
        &mut hears,
    );
    let sampled = candidates.len();
    let defined = scales.is_some() || candidates.iter().any(|it| it.evaluation.is_defined());
    let scales = scales.cloned();
    let scales = scales.unwrap_or_else(|| scales_of(problem, &candidates));
    let tolerance = options.sqp.feasibility;
    let order = ranked(&candidates, &scales, tolerance);
    let best_sample = order.first().map(|k| {
        let mut best = candidates[*k].clone();
        exactly(problem, &mut best);
        let standing = Standing::of(&best.evaluation, &scales, tolerance);
        (best, standing)
    });
    let mut starts: Vec<Vec<f64>> = Vec::new();
    if ended != Ended::Stopped {
        starts.extend(options.start.as_ref().map(|start| space.within(start)));
        let chosen = choose(&candidates, &order, options.starts, &space);
        starts.extend(chosen.into_iter().map(|k| candidates[k].design.clone()));
    }
    let count = starts.len();
    let starts = starts.into_iter().map(|start| (problem, start)).collect();
    let left = options.evaluations.saturating_sub(sampled);
    let sqp = SqpOptions {
        typical: defined.then(|| scales.clone()),
        ..options.sqp.clone()
    };
    let found = side_by_side(starts, (&sqp, left), workers, &mut |all| {
        let places = all.iter().filter_map(Going::at);
        // The best is told, of all that go.
        let best = places.min_by(|a, b| {
            (a.2 > tolerance).cmp(&(b.2 > tolerance)).then(
                match a.2 > tolerance && b.2 > tolerance {
                    true => a.2.total_cmp(&b.2),
                    false => a.1.total_cmp(&b.1),
                },
            )
        });
        let told = hears(&Progress {
            evaluations: sampled + all.iter().map(Going::evaluations).sum::<usize>(),
            budget,
            best: best.map(|(design, value, _)| (design, value)),
            violation: best.map_or(f64::INFINITY, |(_, _, violation)| violation),
        });
        if told.is_break() {
            ended = Ended::Stopped;
        }
        told
    });
    Followed {
        evaluations: sampled + found.iter().map(|it| it.evaluations).sum::<usize>(),
        found,
        ended,
        best_sample,
        scales,
        starts: count,
    }
}

/// Designs from all over the box with what they are worth, nearly, of a work that tries so many at most; and whether it was stopped, or converged.
pub(crate) fn sample(
    problem: &dyn Problem,
    (seed, samples): (u64, usize),
    budget: usize,
    workers: &dyn Workers,
    hears: Hears,
) -> (Vec<Candidate>, Ended) {
    let space = Space::new(problem.bounds());
    let designs = halton(seed, samples, space.bounds.len());
    let mut candidates: Vec<Candidate> = Vec::with_capacity(samples);
    for batch in designs.chunks(BATCH) {
        let batch: Vec<Vec<f64>> = batch.iter().map(|u| space.design(u)).collect();
        let evaluations = nearly(problem, &batch, workers);
        let both = batch.into_iter().zip(evaluations);
        candidates.extend(both.map(|(design, evaluation)| Candidate { design, evaluation }));
        let progress = Progress {
            evaluations: candidates.len(),
            budget,
            best: None,
            violation: f64::INFINITY,
        };
        if hears(&progress).is_break() {
            return (candidates, Ended::Stopped);
        }
    }
    (candidates, Ended::Converged)
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

/// The problem's scales, or what is typical of the samples.
pub(crate) fn scales_of(problem: &dyn Problem, candidates: &[Candidate]) -> Scales {
    let (objectives, constraints) = (problem.objectives(), problem.constraints());
    problem::scales(problem).unwrap_or_else(|| {
        let evaluations: Vec<_> = candidates.iter().map(|c| c.evaluation.clone()).collect();
        Scales::typical(&evaluations, objectives, constraints)
    })
}

/// The best samples that are not near to each other and can be evaluated.
pub(crate) fn choose(
    candidates: &[Candidate],
    order: &[usize],
    wanted: usize,
    space: &Space,
) -> Vec<usize> {
    let usable = order.iter().copied();
    let usable = usable.filter(|k| candidates[*k].evaluation.is_defined());
    let usable: Vec<usize> = usable.collect();
    let mut chosen: Vec<usize> = Vec::new();
    let mut apart = APART;
    while chosen.len() < wanted.min(usable.len()) && apart > NEAR {
        for one in &usable {
            let away = |other: &usize| {
                space.distance(&candidates[*one].design, &candidates[*other].design)
            };
            let far = chosen.iter().all(|other| away(other) > apart);
            if far && chosen.len() < wanted {
                chosen.push(*one);
            }
        }
        apart /= 2.0;
    }
    chosen
}

/// Puts an optimum beside those that were reached before, or counts it to the one that it is.
fn add(reached: &mut Vec<(Optimum, usize)>, optimum: Optimum, space: &Space) {
    let same = |other: &Optimum| {
        let (a, b) = (other.objective(), optimum.objective());
        other.ended.is_optimal() == optimum.ended.is_optimal()
            && ((a - b).abs() <= AGREE * a.abs().max(b.abs()).max(f64::MIN_POSITIVE)
                || [other, &optimum].map(|o| o.ended) == [Ended::Least; 2])
            && space.distance(&other.design, &optimum.design) <= NEAR
    };
    match reached.iter_mut().find(|(other, _)| same(other)) {
        Some((other, times)) => {
            *times += 1;
            if optimum.objective() < other.objective() && optimum.violation <= other.violation {
                *other = optimum;
            }
        }
        None => reached.push((optimum, 1)),
    }
}

/// The best first; of equals an optimum.
fn sorted(
    mut reached: Vec<(Optimum, usize)>,
    scales: &Scales,
    tolerance: f64,
) -> Vec<(Optimum, usize)> {
    let optimal = |o: &Optimum| u8::from(!o.ended.is_optimal());
    let keeps = |o: &Optimum| o.violation <= tolerance;
    reached.sort_by(|(a, _), (b, _)| {
        let by_worst = match (keeps(a), keeps(b)) {
            (false, false) => worst_first(&a.evaluation, &b.evaluation, scales, 0.0),
            (a, b) => b.cmp(&a),
        };
        let by_objective = || a.objective().total_cmp(&b.objective());
        (by_worst.then_with(by_objective)).then(optimal(a).cmp(&optimal(b)))
    });
    reached
}
