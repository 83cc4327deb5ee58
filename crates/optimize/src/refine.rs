//! Every design of a front moved to one that keeps the first-order conditions of Pareto optima.

use crate::front::{RefinedFront, Way, go, ranges};
use crate::problem::Problem;
use crate::progress::Hears;
use crate::sqp::SqpOptions;
use crate::standing::Candidate;
use crate::workers::Workers;

/// Refines a front, all its designs side by side; options hold for every descent of every design, and all together evaluate so many designs at most.
pub fn refine(
    problem: &dyn Problem,
    front: &[Candidate],
    (options, budget): (&SqpOptions, usize),
    workers: &dyn Workers,
    hears: Hears,
) -> RefinedFront {
    let ranges = ranges(front.iter(), problem.objectives());
    let mut ways: Vec<Way> = front.iter().map(Way::of).collect();
    let with = (options, budget, 0);
    let (evaluations, ended) = go(problem, &mut ways, &ranges, with, workers, hears);
    let members = ways.into_iter().filter_map(|way| way.member);
    RefinedFront::of(members.collect(), evaluations, ended)
}
