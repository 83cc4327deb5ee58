//! Every design of a front moved to one that keeps the first-order conditions of Pareto optima.

use crate::front::{RefinedFront, Way, go, ranges};
use crate::problem::{Candidate, Problem};
use crate::progress::{Ended, Hears};
use crate::sqp::SqpOptions;
use crate::workers::Workers;

/// Where there are no more designs than so many for each way, a few are gone first, and tell how many one takes: so many at least.
pub(crate) const GENEROUS: usize = 100;
pub(crate) const FIRST: usize = 6;
pub(crate) const LEAST: usize = 4;
/// ... and of the others so many: what lies between them is found as gaps are filled, evenly.
const OTHERS: usize = 14;

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

/// Refines a front. Of two objectives only as many of its designs as can come to their end, where few may be evaluated: gaps may be filled afterwards.
pub fn refine_some(
    problem: &dyn Problem,
    front: &[Candidate],
    (options, budget): (&SqpOptions, usize),
    workers: &dyn Workers,
    hears: Hears,
) -> RefinedFront {
    if problem.objectives() != 2 || budget / GENEROUS >= front.len() {
        return refine(problem, front, (options, budget), workers, hears);
    }
    let first = evenly(front, FIRST);
    let led = refine(problem, &first, (options, budget), workers, hears);
    let of_way = (led.evaluations / first.len().max(1)).max(LEAST);
    let left = budget.saturating_sub(led.evaluations);
    if led.ended != Ended::Converged || left < of_way {
        return led;
    }
    let others = front.iter().filter(|it| !first.contains(it));
    let others: Vec<Candidate> = others.cloned().collect();
    let others = evenly(&others, (left / of_way).min(OTHERS));
    let others = refine(problem, &others, (options, left), workers, hears);
    let members = [led.members, others.members].concat();
    RefinedFront::of(members, led.evaluations + others.evaluations, others.ended)
}

/// So many at most of a list, from its first to its last.
pub fn evenly<T: Clone>(all: &[T], most: usize) -> Vec<T> {
    if all.len() <= most {
        return all.to_vec();
    }
    let place = |k: usize| k * (all.len() - 1) / most.saturating_sub(1).max(1);
    (0..most).map(|k| all[place(k)].clone()).collect()
}
