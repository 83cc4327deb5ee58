//! Every design of a front moved to one that keeps the first-order conditions of Pareto optima.
//!
//! From a design on, the largest of all objectives' changes, each by the front's range, is minimised (A. Pascoletti and P. Serafini, 1984; of
//! pieces, it is one objective of [`sqp`]). Objectives whose multipliers are zero there might fall further while the others stay: these are minimised next, with
//! the others kept, so that no merely weak optimum is left.

use std::ops::ControlFlow;

use crate::dominance::dominates;
use crate::problem::{Evaluation, Piece, Problem, Scales, Slopes, sound_scale};
use crate::progress::{Ended, Hears, Progress};
use crate::sqp::{SqpOptions, sqp};
use crate::standing::Candidate;

/// A share of the multipliers that is nothing.
const NOTHING: f64 = 1e-9;

/// A design of a refined front.
#[derive(Clone, Debug, PartialEq)]
pub struct Refined {
    /// The design and what it is worth.
    pub candidate: Candidate,
    /// How far the first-order conditions are missed, in the front's ranges over the box's width; infinite where steps could not begin.
    pub residual: f64,
    /// The multipliers of the objectives, each by its range, summing to one. Divided by the ranges their ratios are what one objective costs
    /// in units of another.
    pub shares: Vec<f64>,
    /// Why the steps ended.
    pub ended: Ended,
}

/// A refined front.
#[derive(Clone, Debug, PartialEq)]
pub struct RefinedFront {
    /// The designs, by their first objective; none dominates another.
    pub members: Vec<Refined>,
    /// Designs evaluated.
    pub evaluations: usize,
    /// The largest residual of those whose steps began.
    pub residual: f64,
    /// [`Ended::Converged`] where all were refined.
    pub ended: Ended,
}

/// Objectives by their ranges from a target: the largest of some is minimised, the others may not rise.
struct Scalarised<'a> {
    problem: &'a mut dyn Problem,
    target: Vec<f64>,
    ranges: Vec<f64>,
    minimised: Vec<bool>,
}

impl Scalarised<'_> {
    fn kept(&self) -> usize {
        self.minimised.iter().filter(|m| !**m).count()
    }
}

impl Problem for Scalarised<'_> {
    fn bounds(&self) -> &[[f64; 2]] {
        self.problem.bounds()
    }

    fn constraints(&self) -> usize {
        self.problem.constraints() + self.kept()
    }

    fn scales(&self) -> Option<Scales> {
        let mut scales = self.problem.scales()?;
        scales.objectives = vec![1.0];
        scales.constraints.extend(vec![1.0; self.kept()]);
        Some(scales)
    }

    fn evaluate(&mut self, designs: &[Vec<f64>]) -> Vec<Evaluation> {
        let mut evaluations = self.problem.evaluate(designs);
        for evaluation in &mut evaluations {
            if !evaluation.is_defined() {
                continue;
            }
            let mut largest = f64::NEG_INFINITY;
            for (k, value) in evaluation.objectives.iter().enumerate() {
                let change = (value - self.target[k]) / self.ranges[k];
                match self.minimised[k] {
                    true => largest = kempe_number::math::max(largest, change),
                    false => evaluation.constraints.push(change),
                }
            }
            evaluation.objectives = vec![largest];
        }
        evaluations
    }

    fn slopes(&mut self, design: &[f64]) -> Option<Slopes> {
        let mut slopes = self.problem.slopes(design)?;
        let mut pieces = Vec::new();
        for (k, own) in slopes.objectives.drain(..).enumerate() {
            let (target, range) = (self.target[k], self.ranges[k]);
            let changed = own.into_iter().map(|p| Piece {
                value: (p.value - target) / range,
                slope: p.slope.into_iter().map(|g| g / range).collect(),
            });
            match self.minimised[k] {
                true => pieces.extend(changed),
                false => slopes.constraints.push(changed.collect()),
            }
        }
        slopes.objectives = vec![pieces];
        Some(slopes)
    }
}

/// Refines a front; options hold for every step of every design.
pub fn refine(
    problem: &mut dyn Problem,
    front: &[Candidate],
    options: &SqpOptions,
    hears: Hears,
) -> RefinedFront {
    let objectives = problem.objectives();
    let ranges: Vec<f64> = (0..objectives)
        .map(|k| {
            let values = front.iter().filter_map(|c| c.evaluation.objectives.get(k));
            let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
                (l.min(*v), h.max(*v))
            });
            sound_scale(high - low)
        })
        .collect();
    let mut refined = RefinedFront {
        members: Vec::new(),
        evaluations: 0,
        residual: 0.0,
        ended: Ended::Converged,
    };
    for (place, candidate) in front.iter().enumerate() {
        let mut told = |progress: &Progress| {
            let told = hears(&Progress {
                evaluations: refined.evaluations + progress.evaluations,
                budget: front.len() * options.evaluations,
                ..*progress
            });
            if told.is_break() {
                refined.ended = Ended::Stopped;
            }
            told
        };
        let (member, evaluations) = one(problem, candidate, &ranges, options, &mut told);
        refined.evaluations += evaluations;
        refined.members.push(member);
        if refined.ended == Ended::Stopped {
            // The rest stays as it is.
            refined
                .members
                .extend(front[place + 1..].iter().map(|c| unrefined(c, objectives)));
            break;
        }
    }
    keep_undominated(&mut refined.members);
    let residuals = refined
        .members
        .iter()
        .map(|m| m.residual)
        .filter(|r| r.is_finite());
    refined.residual = residuals.fold(0.0, f64::max);
    refined
}

/// A design as it was.
fn unrefined(candidate: &Candidate, objectives: usize) -> Refined {
    Refined {
        candidate: candidate.clone(),
        residual: f64::INFINITY,
        shares: vec![0.0; objectives],
        ended: Ended::Stopped,
    }
}

/// One design refined, and how many were evaluated for it.
fn one(
    problem: &mut dyn Problem,
    candidate: &Candidate,
    ranges: &[f64],
    options: &SqpOptions,
    hears: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> (Refined, usize) {
    let mut member = unrefined(candidate, ranges.len());
    let mut evaluations = 0;
    let mut minimised = vec![true; ranges.len()];
    for _ in 0..ranges.len() {
        let mut scalarised = Scalarised {
            target: member.candidate.evaluation.objectives.clone(),
            ranges: ranges.to_vec(),
            minimised: minimised.clone(),
            problem,
        };
        let found = sqp(&mut scalarised, &member.candidate.design, options, hears);
        evaluations += found.evaluations + 1;
        // The problem's own values there, and whose pieces the multipliers are.
        let evaluation =
            crate::problem::evaluate(problem, std::slice::from_ref(&found.design)).swap_remove(0);
        let slopes = problem.slopes(&found.design);
        let first = minimised.iter().all(|m| *m);
        let usable = found.violation <= options.feasibility && evaluation.is_defined();
        let (true, Some(slopes)) = (usable, slopes) else {
            if first {
                member.ended = found.ended;
            }
            break;
        };
        let mut pieces = found.multipliers.objectives.iter().flatten();
        let mut shares = vec![0.0; ranges.len()];
        for (k, own) in slopes.objectives.iter().enumerate() {
            if minimised[k] {
                shares[k] = pieces.by_ref().take(own.len()).sum();
            }
        }
        if first {
            member.shares = shares.clone();
        }
        member.candidate = Candidate {
            design: found.design,
            evaluation,
        };
        (member.residual, member.ended) = (found.residual, found.ended);
        let before = minimised.iter().filter(|m| **m).count();
        for (m, share) in minimised.iter_mut().zip(&shares) {
            *m = *m && *share <= NOTHING;
        }
        let left = minimised.iter().filter(|m| **m).count();
        if left == 0 || left == before || found.ended == Ended::Stopped {
            break;
        }
    }
    (member, evaluations)
}

/// Leaves out what others dominate, and what they repeat.
fn keep_undominated(members: &mut Vec<Refined>) {
    let objectives: Vec<Vec<f64>> = members
        .iter()
        .map(|m| m.candidate.evaluation.objectives.clone())
        .collect();
    let mut place = 0;
    members.retain(|_| {
        let own = &objectives[place];
        let dominated = objectives.iter().any(|other| dominates(other, own));
        let repeated = objectives[..place].contains(own);
        place += 1;
        !dominated && !repeated
    });
    members.sort_by(|a, b| {
        let values = a
            .candidate
            .evaluation
            .objectives
            .iter()
            .zip(&b.candidate.evaluation.objectives);
        values
            .map(|(x, y)| x.total_cmp(y))
            .fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then)
    });
}
