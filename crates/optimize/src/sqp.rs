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
mod search;
mod steep;
mod unseen;
mod vector;
mod violation;

use std::ops::ControlFlow;

use crate::problem::{Evaluation, Problem, Scales};
use crate::progress::{Ended, Hears, Progress};
use crate::workers::{Alone, Task, Workers, each};
pub(crate) use descent::Descent;

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
    /// The scales themselves, where the problem names none.
    pub scales: Option<Scales>,
    /// What functions typically come to in the box, if it is known: where those of the start are far above that, as beside a pole, others are taken on the
    /// way, not less than this. What it does not know keeps its scale.
    pub typical: Option<Scales>,
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
            scales: None,
            typical: None,
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
    /// What it hangs on. Where [`Ended::Infeasible`], if what cannot be kept is eased by as much as it is missed.
    pub multipliers: Multipliers,
    /// By how much the objective falls for each unit by which one of these is eased alone: the multipliers, but where others would meet
    /// the conditions as well. What several hold, easing one of them brings nothing.
    pub eased: Multipliers,
    /// How far the first-order conditions (W. Karush 1939, H. W. Kuhn and A. W. Tucker 1951) are missed: the largest component of the
    /// Lagrangian's slope over the box's width, or the multipliers times what their pieces are below the largest, in the
    /// objective's scale. Where [`Ended::Infeasible`], those of the least violations.
    pub residual: f64,
    /// The largest violation of a constraint, in its scale.
    pub violation: f64,
    /// Where [`Ended::Infeasible`]: groups of constraints that cannot be kept together, each as small as it can be, with their shares of the multipliers of
    /// the least largest violation of the group, the largest first; those of the first group sum to one. What contradicts each other even where what is
    /// missed is eased so far follows, and so on: the others are kept, and the objective is the least that it then can be.
    pub conflicts: Vec<Vec<(usize, f64)>>,
    /// Where the edge of what can be evaluated holds the design: one just beyond it.
    pub beyond: Option<Vec<f64>>,
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

    /// Nothing but a design, and what it is worth in these scales.
    fn undefined(
        design: Vec<f64>,
        (evaluation, scales): (Evaluation, Scales),
        evaluations: usize,
    ) -> Self {
        let (violation, ended) = match evaluation.is_defined() {
            true => (evaluation.violation(&scales), Ended::Slopeless),
            false => (f64::INFINITY, Ended::Undefined),
        };
        Self {
            design,
            evaluation,
            multipliers: Multipliers::default(),
            eased: Multipliers::default(),
            residual: f64::INFINITY,
            violation,
            conflicts: Vec::new(),
            beyond: None,
            scales,
            iterations: 0,
            evaluations,
            slopes: 0,
            ended,
        }
    }
}

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
