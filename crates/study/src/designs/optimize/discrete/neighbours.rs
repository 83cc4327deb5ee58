//! From a combination of values of catalogues to the best beside it, until none beside is better.
//!
//! Rounding looks at the values about a design that has any; where several are rounded the best of all may lie a step away from those. Beside a combination
//! lie those that differ by one step in one value, the rest moved again. Where nothing else is free a design of each is tried, and those that differ in more of
//! them, and by more steps, lie beside it too, as far as these are few.

use std::cmp::Ordering;
use std::ops::ControlFlow;

use kempe_optimize::{
    Ended, Evaluation, FEASIBLE, Hears, Optimum, Problem, Progress, Scales, Workers, descents,
    evaluate_all, worst_first,
};

use super::super::designs::Designs;
use super::super::effort::local;
use super::catalogues::{Catalogues, Held};
use super::tried::TOGETHER;

/// So many combinations at most lie beside one, but for those that differ by one step in one value.
const MOST_BESIDE: usize = 128;
/// So often a better neighbour is gone to.
const WALKS: usize = 200;

/// How the way from neighbour to neighbour ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Walked {
    /// No neighbour is better.
    Best,
    /// The designs that are allowed were used, or it was gone far.
    Unfinished,
    Stopped,
}

impl Walked {
    /// What is said of it after how the combination was found.
    pub fn text(self) -> &'static str {
        match self {
            Self::Best => ", then from neighbour to neighbour until none was better",
            Self::Unfinished => {
                ", then from neighbour to neighbour, not to the end: neighbours of the best were not all tried"
            }
            Self::Stopped => "",
        }
    }
}

impl Catalogues {
    /// Puts the designs to which better and better neighbours of the best of a list lead into it. `left` says how many designs may be tried yet.
    pub(super) fn walk(
        &self,
        problem: &Designs<'_, '_>,
        (list, scales): (&mut Vec<Optimum>, &Scales),
        left: &dyn Fn() -> usize,
        workers: &dyn Workers,
        hears: Hears,
    ) -> Walked {
        let order =
            |a: &Optimum, b: &Optimum| worst_first(&a.evaluation, &b.evaluation, scales, FEASIBLE);
        let defined = list.iter().filter(|it| it.evaluation.is_defined());
        let Some(mut best) = defined.min_by(|a, b| order(a, b)).cloned() else {
            return Walked::Unfinished;
        };
        let is_free = self.values.iter().any(Vec::is_empty);
        // Where something else is free, what a combination leads to hangs on where it starts: those that were left alone are known.
        let mut known: Vec<Vec<f64>> = match is_free {
            true => Vec::new(),
            false => list.iter().map(|it| it.design.clone()).collect(),
        };
        for _ in 0..WALKS {
            let mut beside = self.beside(&best.design, !is_free);
            beside.retain(|it| !known.iter().any(|other| self.is_one(it, other)));
            let all = beside.len();
            beside.truncate(left());
            let cut = beside.len() < all;
            let found = match is_free {
                true => self.led(problem, &beside, left(), workers, hears),
                false => {
                    let better = better(problem, &best, (&beside, scales), workers, hears);
                    let ControlFlow::Continue(better) = better else {
                        return Walked::Stopped;
                    };
                    known.append(&mut beside);
                    self.led(problem, better.as_slice(), usize::MAX, workers, hears)
                }
            };
            let stopped = found.iter().any(|it| it.ended == Ended::Stopped);
            let spent = cut || found.iter().any(|it| it.ended == Ended::Budget);
            let next = found.iter().filter(|it| it.evaluation.is_defined());
            let next = next.min_by(|a, b| order(a, b)).cloned();
            list.extend(found);
            match next.filter(|it| order(it, &best) == Ordering::Less) {
                _ if stopped => return Walked::Stopped,
                Some(next) => known.push(std::mem::replace(&mut best, next).design),
                None if spent => return Walked::Unfinished,
                None => return Walked::Best,
            }
        }
        Walked::Unfinished
    }

    /// Where the combinations of some designs lead to, from these.
    fn led(
        &self,
        problem: &Designs<'_, '_>,
        designs: &[Vec<f64>],
        budget: usize,
        workers: &dyn Workers,
        hears: Hears,
    ) -> Vec<Optimum> {
        let held: Vec<Held> = (designs.iter())
            .map(|design| self.held(problem, design))
            .collect();
        let starts = held.iter().zip(designs);
        let starts = starts.map(|(held, start)| (held as &dyn Problem, start.clone()));
        descents(starts.collect(), &local(), budget, workers, hears)
    }

    /// Designs whose combinations lie beside that of a design: one step away in one value, and if that is asked as far away as there are not too many.
    fn beside(&self, design: &[f64], wide: bool) -> Vec<Vec<f64>> {
        let chosen = self.values.iter().filter(|it| !it.is_empty()).count();
        let within = |reach: usize| (2 * reach + 1).checked_pow(chosen as u32);
        let is_few = |reach: &usize| within(*reach).is_some_and(|all| all <= MOST_BESIDE);
        let reach = (1..MOST_BESIDE).take_while(is_few).last();
        let pairs = 2 * chosen * chosen;
        let [changed, reach] = match reach {
            Some(reach) if wide => [chosen, reach],
            None if wide && pairs <= MOST_BESIDE => [2, 1],
            _ => [1, 1],
        };
        let mut all = vec![(design.to_vec(), 0)];
        for (k, values) in self.values.iter().enumerate() {
            let Some(own) = values.iter().position(|value| *value == design[k]) else {
                continue;
            };
            let near = own.saturating_sub(reach)..(own + reach + 1).min(values.len());
            let others: Vec<f64> = near.filter(|it| *it != own).map(|it| values[it]).collect();
            let moved = all.iter().filter(|(_, count)| *count < changed);
            let moved = moved.flat_map(|(design, count)| {
                others.iter().map(move |value| {
                    let mut moved = design.clone();
                    moved[k] = *value;
                    (moved, count + 1)
                })
            });
            let moved: Vec<_> = moved.collect();
            all.extend(moved);
        }
        // Where not all can be tried, those that differ in the least.
        all.sort_by_key(|(_, count)| *count);
        all.into_iter().skip(1).map(|(design, _)| design).collect()
    }

    /// Whether two designs have the same values of the catalogues.
    fn is_one(&self, a: &[f64], b: &[f64]) -> bool {
        let mut both = a.iter().zip(b).zip(&self.values);
        both.all(|((a, b), values)| values.is_empty() || a == b)
    }
}

/// The best of some designs, where that is better than one; a break where whoever listens stops it.
fn better(
    problem: &Designs<'_, '_>,
    than: &Optimum,
    (designs, scales): (&[Vec<f64>], &Scales),
    workers: &dyn Workers,
    hears: Hears,
) -> ControlFlow<(), Option<Vec<f64>>> {
    let mut evaluations = Vec::with_capacity(designs.len());
    for some in designs.chunks(TOGETHER) {
        evaluations.extend(evaluate_all(problem, some, workers));
        hears(&Progress {
            evaluations: evaluations.len(),
            budget: designs.len(),
            best: None,
            violation: f64::INFINITY,
        })?;
    }
    let order = |a: &Evaluation, b: &Evaluation| worst_first(a, b, scales, FEASIBLE);
    let both = designs.iter().zip(&evaluations);
    let best = both.min_by(|(_, a), (_, b)| order(a, b));
    let best = best.filter(|(_, it)| order(it, &than.evaluation) == Ordering::Less);
    ControlFlow::Continue(best.map(|(design, _)| design.clone()))
}
