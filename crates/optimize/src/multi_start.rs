//! All local optima that steps from many places lead to.
//!
//! The box is sampled evenly, cheaply and in batches; steps start from the best places that are not near to each other, as in A. H. G.
//! Rinnooy Kan and G. T. Timmer's multi-start methods (1987).

use crate::halton::halton;
use crate::problem::{Problem, Scales, evaluate};
use crate::progress::{Ended, Hears, Progress};
use crate::space::Space;
use crate::sqp::{Optimum, SqpOptions, sqp};
use crate::standing::{Candidate, Standing, ranked};

/// Samples for each variable, if nothing else is asked.
const SAMPLES: usize = 100;
/// Samples evaluated at once.
const BATCH: usize = 256;
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
            sqp: SqpOptions::default(),
            seed: 1,
        }
    }
}

/// Local optima.
#[derive(Clone, Debug, PartialEq)]
pub struct Optima {
    /// Every distinct one with how many starts led to it, the best first. Where there is none, the best that was reached.
    pub optima: Vec<(Optimum, usize)>,
    /// The best sample, should no start have become an optimum.
    pub best_sample: Option<Candidate>,
    /// Designs evaluated, all together.
    pub evaluations: usize,
    /// Starts that were followed.
    pub starts: usize,
    /// Why it ended: [`Ended::Converged`] where all starts were followed.
    pub ended: Ended,
}

/// Local optima from all over the box.
pub fn multi_start(problem: &mut dyn Problem, options: &MultiStartOptions, hears: Hears) -> Optima {
    let space = Space::new(problem.bounds());
    let n = space.bounds.len();
    let samples = options
        .samples
        .unwrap_or(SAMPLES * n)
        .max(options.starts)
        .max(1);
    let budget = samples + options.starts * options.sqp.evaluations;
    let designs = halton(options.seed, samples, n);
    let mut candidates: Vec<Candidate> = Vec::with_capacity(samples);
    let mut found = Optima {
        optima: Vec::new(),
        best_sample: None,
        evaluations: 0,
        starts: 0,
        ended: Ended::Converged,
    };
    for batch in designs.chunks(BATCH) {
        let batch: Vec<Vec<f64>> = batch.iter().map(|u| space.design(u)).collect();
        let evaluations = evaluate(problem, &batch);
        found.evaluations += batch.len();
        let both = batch.into_iter().zip(evaluations);
        candidates.extend(both.map(|(design, evaluation)| Candidate { design, evaluation }));
        let progress = Progress {
            evaluations: found.evaluations,
            budget,
            best: None,
            violation: f64::INFINITY,
        };
        if hears(&progress).is_break() {
            found.ended = Ended::Stopped;
            break;
        }
    }
    let scales = scales_of(problem, &candidates);
    let order = ranked(&candidates, &scales, options.sqp.feasibility);
    found.best_sample = order.first().map(|k| candidates[*k].clone());
    let starts = match found.ended {
        Ended::Stopped => Vec::new(),
        _ => choose(&candidates, &order, options.starts, &space),
    };
    let mut reached: Vec<(Optimum, usize)> = Vec::new();
    for start in starts {
        let before = found.evaluations;
        // The best is told, not what the start at hand has.
        let best = reached
            .iter()
            .map(|(o, _)| (o.objective(), o.violation, o.design.clone()));
        let best = best.min_by(|a, b| {
            (a.1 > options.sqp.feasibility)
                .cmp(&(b.1 > options.sqp.feasibility))
                .then(a.0.total_cmp(&b.0))
        });
        let mut listen = |progress: &Progress| {
            let own = (progress.best, progress.violation);
            let (best, violation) = best.as_ref().map_or(own, |(value, violation, design)| {
                (Some((design.as_slice(), *value)), *violation)
            });
            hears(&Progress {
                evaluations: before + progress.evaluations,
                budget,
                best,
                violation,
            })
        };
        let optimum = sqp(problem, &start, &options.sqp, &mut listen);
        found.evaluations += optimum.evaluations;
        found.starts += 1;
        let stopped = optimum.ended == Ended::Stopped;
        add(&mut reached, optimum, &space);
        if stopped {
            found.ended = Ended::Stopped;
            break;
        }
    }
    found.optima = sorted(reached, &scales, options.sqp.feasibility);
    found
}

/// The problem's scales, or what is typical of the samples.
fn scales_of(problem: &dyn Problem, candidates: &[Candidate]) -> Scales {
    let (objectives, constraints) = (problem.objectives(), problem.constraints());
    let given = problem.scales().filter(|s| s.fits(objectives, constraints));
    given.unwrap_or_else(|| {
        let evaluations: Vec<_> = candidates.iter().map(|c| c.evaluation.clone()).collect();
        Scales::typical(&evaluations, objectives, constraints)
    })
}

/// The best samples that are not near to each other and can be evaluated.
fn choose(
    candidates: &[Candidate],
    order: &[usize],
    wanted: usize,
    space: &Space,
) -> Vec<Vec<f64>> {
    let usable: Vec<&Vec<f64>> = (order.iter().map(|k| &candidates[*k]))
        .filter(|c| c.evaluation.is_defined())
        .map(|c| &c.design)
        .collect();
    let mut chosen: Vec<Vec<f64>> = Vec::new();
    let mut apart = APART;
    while chosen.len() < wanted.min(usable.len()) && apart > NEAR {
        for design in &usable {
            let far = chosen
                .iter()
                .all(|other| space.distance(design, other) > apart);
            if far && chosen.len() < wanted {
                chosen.push((*design).clone());
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
            && (a - b).abs() <= AGREE * a.abs().max(b.abs()).max(f64::MIN_POSITIVE)
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

/// The optima, the best first; without any, the best of the rest.
fn sorted(
    mut reached: Vec<(Optimum, usize)>,
    scales: &Scales,
    tolerance: f64,
) -> Vec<(Optimum, usize)> {
    let stand = |o: &Optimum| match o.violation <= tolerance {
        true => Standing::Feasible(o.objective()),
        false => Standing::of(&o.evaluation, scales, 0.0),
    };
    let optimal = |o: &Optimum| u8::from(!o.ended.is_optimal());
    reached.sort_by(|(a, _), (b, _)| optimal(a).cmp(&optimal(b)).then(stand(a).order(&stand(b))));
    let optima = reached.iter().filter(|(o, _)| o.ended.is_optimal()).count();
    reached.truncate(optima.max(1));
    reached
}
