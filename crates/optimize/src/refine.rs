//! Every design of a front moved to one that keeps the first-order conditions of Pareto optima.
//!
//! From a design on, the largest of all objectives' changes, each by the front's range, is minimised (A. Pascoletti and P. Serafini, 1984; of
//! pieces, it is one objective of [`sqp`]). Objectives whose multipliers are zero there might fall further while the others stay: these are minimised next, with
//! the others kept, so that no merely weak optimum is left.

use crate::dominance::dominates;
use crate::problem::{self, Evaluation, Piece, Problem, Scales, Slopes, sound_scale};
use crate::progress::{Ended, Hears, Progress};
use crate::sqp::{Going, Optimum, SqpOptions, side_by_side};
use crate::standing::Candidate;
use crate::workers::Workers;

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
    problem: &'a dyn Problem,
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

    fn evaluate(&self, design: &[f64]) -> Evaluation {
        let mut evaluation = problem::evaluate(self.problem, design);
        if !evaluation.is_defined() {
            return evaluation;
        }
        let mut largest = f64::NEG_INFINITY;
        for (k, value) in evaluation.objectives.iter().enumerate() {
            let change = (value - self.target[k]) / self.ranges[k];
            match self.minimised[k] {
                true => largest = largest.max(change),
                false => evaluation.constraints.push(change),
            }
        }
        evaluation.objectives = vec![largest];
        evaluation
    }

    fn slopes(&self, design: &[f64]) -> Option<Slopes> {
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

/// Refines a front, all its designs side by side; options hold for every descent of every design, and all together evaluate so many designs at most.
pub fn refine(
    problem: &dyn Problem,
    front: &[Candidate],
    (options, budget): (&SqpOptions, usize),
    workers: &dyn Workers,
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
    let mut all: Vec<Point> = front.iter().map(|c| Point::new(c, objectives)).collect();
    let mut evaluations = 0;
    let mut ended = Ended::Converged;
    for _ in 0..objectives {
        let asked: Vec<usize> = (0..all.len()).filter(|k| all[*k].goes_on).collect();
        if asked.is_empty() || ended == Ended::Stopped {
            break;
        }
        let scalarised: Vec<Scalarised> = (asked.iter())
            .map(|k| Scalarised {
                target: all[*k].member.candidate.evaluation.objectives.clone(),
                ranges: ranges.clone(),
                minimised: all[*k].minimised.clone(),
                problem,
            })
            .collect();
        let starts = asked.iter().zip(&scalarised).map(|(k, own)| {
            let own: &dyn Problem = own;
            (own, all[*k].member.candidate.design.clone())
        });
        let left = budget.saturating_sub(evaluations);
        let found = side_by_side(starts.collect(), (options, left), workers, &mut |going| {
            let told = hears(&Progress {
                evaluations: evaluations + going.iter().map(Going::evaluations).sum::<usize>(),
                budget: budget.min(front.len() * options.evaluations),
                best: None,
                violation: 0.0,
            });
            if told.is_break() {
                ended = Ended::Stopped;
            }
            told
        });
        for (k, optimum) in asked.into_iter().zip(found) {
            evaluations += optimum.evaluations + 1;
            all[k].take(problem, optimum, options);
        }
    }
    let mut members: Vec<Refined> = all.into_iter().map(|point| point.member).collect();
    keep_undominated(&mut members);
    let residuals = members.iter().map(|m| m.residual);
    RefinedFront {
        residual: residuals.filter(|r| r.is_finite()).fold(0.0, f64::max),
        members,
        evaluations,
        ended,
    }
}

/// A design on its way.
struct Point {
    member: Refined,
    /// Objectives whose largest change is minimised.
    minimised: Vec<bool>,
    goes_on: bool,
}

impl Point {
    /// A design as it was.
    fn new(candidate: &Candidate, objectives: usize) -> Self {
        Self {
            member: Refined {
                candidate: candidate.clone(),
                residual: f64::INFINITY,
                shares: vec![0.0; objectives],
                ended: Ended::Stopped,
            },
            minimised: vec![true; objectives],
            goes_on: true,
        }
    }

    /// Takes over where steps led to, and says which objectives are minimised next.
    fn take(&mut self, problem: &dyn Problem, found: Optimum, options: &SqpOptions) {
        self.goes_on = false;
        // The problem's own values there, and whose pieces the multipliers are.
        let evaluation = problem::evaluate(problem, &found.design);
        let slopes = problem::slopes(problem, &found.design);
        let first = self.minimised.iter().all(|m| *m);
        let usable = found.violation <= options.feasibility && evaluation.is_defined();
        let (true, Some(slopes)) = (usable, slopes) else {
            if first {
                self.member.ended = found.ended;
            }
            return;
        };
        let mut pieces = found.multipliers.objectives.iter().flatten();
        let mut shares = vec![0.0; self.minimised.len()];
        for (k, own) in slopes.objectives.iter().enumerate() {
            if self.minimised[k] {
                shares[k] = pieces.by_ref().take(own.len()).sum();
            }
        }
        if first {
            self.member.shares = shares.clone();
        }
        self.member.candidate = Candidate {
            design: found.design,
            evaluation,
        };
        (self.member.residual, self.member.ended) = (found.residual, found.ended);
        let before = self.minimised.iter().filter(|m| **m).count();
        for (m, share) in self.minimised.iter_mut().zip(&shares) {
            *m = *m && *share <= NOTHING;
        }
        let left = self.minimised.iter().filter(|m| **m).count();
        self.goes_on = left > 0 && left < before && found.ended != Ended::Stopped;
    }
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
