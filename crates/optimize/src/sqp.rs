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
//! `search.rs`. Where the violation comes to rest, it is minimised alone (`violation.rs`). `descent.rs` goes from step to step, so that several
//! descents can go side by side; what is told at its end stands in `descent/ending.rs`, which constraints contradict each other in
//! `descent/conflicts.rs`. Where it comes to rest, ways that it never took are tried (`unseen.rs`). Designs that cannot be evaluated are no
//! cliffs: their edge is a limit (`edge.rs`), towards which goals may be steep without bound (`steep.rs`).

mod curvature;
mod descent;
mod easing;
mod edge;
mod local;
mod optimum;
mod options;
mod search;
mod steep;
mod unseen;
mod vector;
mod violation;

use std::ops::ControlFlow;

use crate::problem::Problem;
use crate::progress::{Ended, Hears, Progress};
use crate::workers::{Alone, Task, Workers, each};
pub(crate) use descent::Descent;
pub use optimum::{Multipliers, Optimum};
pub use options::SqpOptions;

/// The local minimum that steps from a start lead to, of the largest objective subject to the constraints, within the box.
pub fn sqp(
    problem: &dyn Problem,
    start: &[f64],
    options: &SqpOptions,
    workers: &dyn Workers,
    hears: Hears,
) -> Optimum {
    let mut descent = match Descent::begin(problem, start, options) {
        Ok(descent) => descent,
        Err(undefined) => return *undefined,
    };
    loop {
        if hears(&descent.progress()).is_break() {
            return descent.end(Ended::Stopped);
        }
        if let Some(ended) = descent.step(workers) {
            return descent.end(ended);
        }
    }
}

/// A descent among others.
pub(crate) enum Going<'a> {
    /// It goes on.
    On(Box<Descent<'a>>),
    /// It has ended.
    Over(Box<Optimum>),
}

/// Local minima from several starts, each of its own problem, a step of each at a time, until all of them together have evaluated `budget` designs.
/// Between the steps `told` hears all of them; where it says that it is enough, each ends where it is.
pub(crate) fn side_by_side(
    starts: Vec<(&dyn Problem, Vec<f64>)>,
    (options, budget): (&SqpOptions, usize),
    workers: &dyn Workers,
    told: &mut dyn FnMut(&[Going]) -> ControlFlow<()>,
) -> Vec<Optimum> {
    let begin = |(problem, start): (_, Vec<f64>)| match Descent::begin(problem, &start, options) {
        Ok(descent) => Going::On(Box::new(descent)),
        Err(undefined) => Going::Over(undefined),
    };
    let mut all = each(workers, starts, begin);
    let mut early = Ended::Stopped;
    while all.iter().any(|one| matches!(one, Going::On(_))) {
        if told(&all).is_break() {
            break;
        }
        let spent = all.iter().map(Going::evaluations).sum::<usize>();
        let going = all.iter().filter(|one| matches!(one, Going::On(_)));
        let share = budget.saturating_sub(spent) / going.count();
        if share == 0 {
            early = Ended::Budget;
            break;
        }
        for one in &mut all {
            if let Going::On(descent) = one {
                descent.allow(share);
            }
        }
        let mut ends: Vec<Option<Ended>> = all.iter().map(|_| None).collect();
        let tasks = all.iter_mut().zip(&mut ends);
        let tasks = tasks.filter_map(|(one, end)| match one {
            Going::On(descent) => Some(Box::new(move || *end = descent.step(&Alone)) as Task<'_>),
            Going::Over(_) => None,
        });
        workers.run(tasks.collect());
        let both = all.into_iter().zip(ends);
        all = both
            .map(|(one, end)| match (one, end) {
                (Going::On(descent), Some(end)) => Going::Over(Box::new(descent.end(end))),
                (one, _) => one,
            })
            .collect();
    }
    let over = |one| match one {
        Going::On(descent) => descent.end(early),
        Going::Over(optimum) => *optimum,
    };
    all.into_iter().map(over).collect()
}

/// Local minima from several starts, each of its own problem, side by side; where all of them together have evaluated `budget` designs, each ends where
/// it is. What is told is the sum of their evaluations.
pub fn descents(
    starts: Vec<(&dyn Problem, Vec<f64>)>,
    options: &SqpOptions,
    budget: usize,
    workers: &dyn Workers,
    hears: Hears,
) -> Vec<Optimum> {
    let most = budget.min(starts.len() * options.evaluations);
    side_by_side(starts, (options, budget), workers, &mut |all| {
        hears(&Progress {
            evaluations: all.iter().map(Going::evaluations).sum(),
            budget: most,
            best: None,
            violation: f64::INFINITY,
        })
    })
}

impl Going<'_> {
    /// Designs that it evaluated.
    pub fn evaluations(&self) -> usize {
        match self {
            Self::On(descent) => descent.evaluations(),
            Self::Over(optimum) => optimum.evaluations,
        }
    }

    /// Where it is: the design, its largest objective and violation; none where there is nothing yet.
    pub fn at(&self) -> Option<(&[f64], f64, f64)> {
        match self {
            Self::On(descent) => Some(descent.at()),
            Self::Over(optimum) => (optimum.evaluation.is_defined()).then(|| {
                (
                    optimum.design.as_slice(),
                    optimum.objective(),
                    optimum.violation,
                )
            }),
        }
    }
}
