//! Local optima from many starts.

use std::ops::ControlFlow;

use crate::problem::{self, Evaluation, Problem, Scales};
use crate::progress::{Ended, Hears, Progress};
use crate::rank::compare;
use crate::sequence::Even;
use crate::space::Space;
use crate::sqp::{Optimum, SqpOptions, sqp};

/// Two optima nearer to each other than this part of the box are one.
const SAME: f64 = 1e-4;
/// Starts lie at least this part of the box apart from each other, for one variable.
const APART: f64 = 0.05;

/// How many starts, and which.
#[derive(Clone, Debug, PartialEq)]
pub struct MultiStartOptions {
    /// Designs that are looked at, evenly in the box, to choose starts from.
    pub looked_at: usize,
    /// Starts, the given one besides.
    pub starts: usize,
    /// Which even points.
    pub seed: u64,
    /// Of each descent.
    pub local: SqpOptions,
}

impl Default for MultiStartOptions {
    fn default() -> Self {
        Self {
            looked_at: 200,
            starts: 12,
            seed: 1,
            local: SqpOptions::default(),
        }
    }
}

/// Local optima that differ, the best first.
#[derive(Clone, Debug, PartialEq)]
pub struct Optima {
    /// The optima: those that keep all constraints first.
    pub list: Vec<Optimum>,
    /// How many descents led to each.
    pub reached: Vec<usize>,
    /// Whether whoever listened stopped it.
    pub stopped: bool,
}

/// Descends from a design and from the best of many that lie evenly in the box.
pub fn multi_start(
    problem: &mut dyn Problem,
    start: &[f64],
    options: &MultiStartOptions,
    hears: Hears,
) -> Optima {
    let space = Space::new(problem.bounds());
    let mut optima = Optima {
        list: Vec::new(),
        reached: Vec::new(),
        stopped: false,
    };
    let budget = options.looked_at + (options.starts + 1) * options.local.evaluations;
    let mut best: Option<(Vec<f64>, f64, f64)> = None;
    let mut done = 0;
    let tell = |hears: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
                done: usize,
                best: &Option<(Vec<f64>, f64, f64)>| {
        hears(&Progress {
            evaluations: done,
            budget,
            best: best
                .as_ref()
                .map(|(design, objective, _)| (design.as_slice(), *objective)),
            violation: best
                .as_ref()
                .map_or(f64::INFINITY, |(_, _, violation)| *violation),
        })
        .is_break()
    };
    let mut starts = vec![space.within(start)];
    if options.starts > 0 && options.looked_at > 0 {
        let mut even = Even::new(start.len(), options.seed);
        let designs: Vec<Vec<f64>> = (0..options.looked_at)
            .map(|_| space.design(&even.point()))
            .collect();
        let evaluations = problem::evaluate(problem, &designs);
        done += designs.len();
        let scales = scales_of(problem, &evaluations);
        starts.extend(chosen(
            &space,
            &designs,
            &evaluations,
            &scales,
            options.starts,
        ));
    }
    for from in starts {
        let found = sqp(problem, &from, &options.local, &mut |progress| match tell(
            &mut *hears,
            done + progress.evaluations,
            &best,
        ) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        });
        done += found.evaluations;
        let stopped = found.ended == Ended::Stopped;
        if found.evaluation.is_defined() {
            let better = best.as_ref().is_none_or(|(_, objective, violation)| {
                (
                    found.violation > options.local.feasibility,
                    found.violation,
                    found.objective(),
                ) < (
                    *violation > options.local.feasibility,
                    *violation,
                    *objective,
                )
            });
            if better {
                best = Some((found.design.clone(), found.objective(), found.violation));
            }
            optima.add(found, &space);
        }
        if stopped {
            optima.stopped = true;
            break;
        }
    }
    optima.sort(options.local.feasibility);
    optima
}

impl Optima {
    fn add(&mut self, found: Optimum, space: &Space) {
        let mut known = self.list.iter();
        let same = known.position(|other| space.distance(&other.design, &found.design) <= SAME);
        match same {
            Some(k) => {
                self.reached[k] += 1;
                let other = &self.list[k];
                if found.violation <= other.violation.max(1e-12)
                    && found.objective() < other.objective()
                {
                    self.list[k] = found;
                }
            }
            None => {
                self.list.push(found);
                self.reached.push(1);
            }
        }
    }

    fn sort(&mut self, feasibility: f64) {
        let mut order: Vec<usize> = (0..self.list.len()).collect();
        let key = |k: &usize| {
            let it = &self.list[*k];
            let missed = if it.violation <= feasibility {
                0.0
            } else {
                it.violation
            };
            (missed, it.objective())
        };
        order.sort_by(|a, b| {
            let (a, b) = (key(a), key(b));
            a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
        });
        self.list = order.iter().map(|k| self.list[*k].clone()).collect();
        self.reached = order.iter().map(|k| self.reached[*k]).collect();
    }
}

/// Sizes of objectives and constraints: the problem's own, or typical ones.
pub(crate) fn scales_of(problem: &dyn Problem, evaluations: &[Evaluation]) -> Scales {
    let (objectives, constraints) = (problem.objectives(), problem.constraints());
    let own = problem.scales().filter(|s| s.fits(objectives, constraints));
    own.unwrap_or_else(|| Scales::typical(evaluations, objectives, constraints))
}

/// The best designs that lie apart from each other.
fn chosen(
    space: &Space,
    designs: &[Vec<f64>],
    evaluations: &[Evaluation],
    scales: &Scales,
    count: usize,
) -> Vec<Vec<f64>> {
    let mut order: Vec<usize> = (0..designs.len())
        .filter(|k| evaluations[*k].is_defined())
        .collect();
    order.sort_by(|a, b| compare(&evaluations[*a], &evaluations[*b], scales).then(a.cmp(b)));
    let mut list: Vec<Vec<f64>> = Vec::new();
    for k in order {
        if list.len() >= count {
            break;
        }
        let near = |other: &Vec<f64>| space.distance(other, &designs[k]) < APART;
        if !list.iter().any(near) {
            list.push(designs[k].clone());
        }
    }
    list
}
