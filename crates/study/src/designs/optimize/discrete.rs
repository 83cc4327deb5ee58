//! Parameters that take some values alone, as of a catalogue.
//!
//! Where all do and there are few combinations, all are tried (`tried.rs`). Else the best design without regard to them is taken, each such parameter is put on the value
//! below or above, and the rest is moved again (rounding with repair). From the best of these it goes on from neighbour to neighbour (`neighbours.rs`): a good
//! design, and not shown to be the best of all combinations.

mod catalogues;
mod neighbours;
mod tried;

use kempe_model::{OptimizeMethod, OptimizeStudy};
use kempe_optimize::{
    Ended, Evaluation, FEASIBLE, Hears, MultiStartOptions, Optimum, Problem, Progress, Workers,
    descents, multi_start, worst_first,
};

use super::designs::Designs;
use super::effort::{LOOKED_AT, local};
use super::optima::{Optima, plain};
use catalogues::{ANEW, EACH, combinations};
pub(super) use catalogues::{Catalogues, Held, Rounded, are_some_chosen, is_rounded};
use neighbours::Walked;
use tried::KEPT;
pub(super) use tried::{Tried, all_of, tried};

/// Optima whose free parameters differ by less than this part of their bounds are one.
const NEAR: f64 = 1e-6;
/// Where no neighbour keeps all limits, each combination is searched from so many starts.
const ANEW_STARTS: usize = 4;

impl Catalogues {
    /// What designs from all over the box lead to with each combination of values, where there are few; else with these.
    fn anew(
        &self,
        problem: &Designs<'_, '_>,
        (near, budget): (Vec<(Held<'_, '_, '_>, Vec<f64>)>, usize),
        workers: &dyn Workers,
        hears: Hears,
    ) -> Vec<Optimum> {
        let combinations: Vec<Held> = match combinations(&self.values) <= ANEW {
            true => self.all_held(problem),
            false => near.into_iter().map(|(held, _)| held).take(ANEW).collect(),
        };
        let free = self.values.iter().filter(|it| it.is_empty()).count();
        // Where nothing is free there is one design of each, which was tried; a third looks for starts, as in any search.
        let each = budget / combinations.len().max(1);
        let samples = (LOOKED_AT * free).min(each / 3);
        let mut found = Vec::new();
        let (before, count) = (problem.asked(), combinations.len());
        for (done, held) in combinations.iter().enumerate().filter(|_| samples > 0) {
            // What is left takes as many as what was done, as far as that is known.
            let there = problem.asked();
            let hears: Hears = &mut |told| {
                let of_one = match done {
                    0 => told.budget,
                    _ => (there - before) / done,
                };
                hears(&Progress {
                    budget: of_one.saturating_mul(count - done),
                    ..*told
                })
            };
            let options = MultiStartOptions {
                samples: Some(samples),
                starts: ANEW_STARTS.min(samples),
                start: None,
                evaluations: each,
                sqp: local(),
                ..MultiStartOptions::default()
            };
            let led = multi_start(held, &options, workers, hears);
            found.extend(led.optima.into_iter().map(|(optimum, _)| optimum));
            if led.ended == Ended::Stopped {
                break;
            }
        }
        found
    }

    /// What a search that was stopped has found, with the nearest values: [`Sought::look`](super::search::Sought::look) says what these are worth.
    fn nearest(&self, problem: &Designs<'_, '_>, found: &Optima) -> Optima {
        let scales = found.list.first().map(|it| it.scales.clone());
        let defined = found.list.iter().filter(|it| it.evaluation.is_defined());
        let known = defined.map(|it| (self.rounded(&it.design), it.scales.clone()));
        let own = (self.own(problem), scales.unwrap_or_default());
        let list = known.chain([own]).map(|(design, scales)| Optimum {
            scales,
            ended: Ended::Stopped,
            ..plain(design, Evaluation::lacking(f64::INFINITY), f64::INFINITY)
        });
        let list = self.different(problem, list.collect());
        Optima {
            reached: vec![1; list.len()],
            list,
            stopped: true,
        }
    }

    /// The first of those that are different designs, so many as are told: several starts may lead to one.
    fn different(&self, problem: &Designs<'_, '_>, all: Vec<Optimum>) -> Vec<Optimum> {
        let is_one = |a: &Optimum, b: &Optimum| {
            let both = a.design.iter().zip(&b.design).zip(problem.bounds());
            let near = both
                .zip(&self.values)
                .all(|(((a, b), [low, high]), values)| match values.is_empty() {
                    true => (a - b).abs() <= NEAR * (high - low),
                    false => a == b,
                });
            near && a.ended.is_optimal() == b.ended.is_optimal()
        };
        let mut list: Vec<Optimum> = Vec::new();
        for optimum in all {
            if list.len() < KEPT && !list.iter().any(|known| is_one(known, &optimum)) {
                list.push(optimum);
            }
        }
        list
    }
}

/// Designs with values of the catalogues near to those that were found, for which so many designs are tried at most, and what is said of them; `None` where no
/// parameter is discrete.
pub(super) fn with_choices(
    problem: &Designs<'_, '_>,
    study: &OptimizeStudy,
    found: &Optima,
    budget: usize,
    workers: &dyn Workers,
    hears: Hears,
) -> Option<(Optima, String)> {
    let catalogues = Catalogues::of(problem, study)?;
    let nearest = || {
        let optima = catalogues.nearest(problem, found);
        (optima, "; values of a catalogue the nearest".to_owned())
    };
    if found.stopped {
        return Some(nearest());
    }
    let most = problem.asked().saturating_add(budget);
    let left = || most.saturating_sub(problem.asked());
    let defined = found.list.iter().filter(|it| it.evaluation.is_defined());
    let held = defined.take(3);
    let mut held: Vec<(Held, Vec<f64>)> = held
        .flat_map(|optimum| catalogues.near(problem, &optimum.design))
        .collect();
    // The way without regard to catalogues may have left a good combination.
    let own = catalogues.own(problem);
    held.push((catalogues.held(problem, &own), own));
    let starts = held.iter().map(|(held, start)| {
        let held: &dyn Problem = held;
        (held, start.clone())
    });
    let mut list = descents(starts.collect(), &local(), budget, workers, hears);
    let mut stopped = list.iter().any(|it| it.ended == Ended::Stopped);
    if stopped && !list.iter().any(|it| it.evaluation.is_defined()) {
        return Some(nearest());
    }
    let keeps = |it: &Optimum| it.evaluation.is_defined() && it.violation <= FEASIBLE;
    let is_local = study.method == Some(OptimizeMethod::Local);
    let are_few = !is_local && combinations(&catalogues.values) <= EACH;
    if !stopped && (are_few || !list.iter().any(keeps)) {
        let more = catalogues.anew(problem, (held, left()), workers, hears);
        stopped = more.iter().any(|it| it.ended == Ended::Stopped);
        list.extend(more);
    }
    // Where nothing goes down the scales are of nothing.
    let mut known = list.iter().filter(|it| it.slopes > 0);
    let scales = known.next().or(list.first()).map(|it| it.scales.clone());
    let scales = scales.unwrap_or_default();
    let walked = match stopped {
        true => Walked::Stopped,
        false => catalogues.walk(problem, (&mut list, &scales), &left, workers, hears),
    };
    list.sort_by(|a, b| worst_first(&a.evaluation, &b.evaluation, &scales, FEASIBLE));
    let list = catalogues.different(problem, list);
    let optima = Optima {
        reached: vec![1; list.len()],
        list,
        stopped: walked == Walked::Stopped,
    };
    let anew = match are_few {
        true => "; each combination of them searched from all over, too",
        false => "",
    };
    let walked = walked.text();
    let how = format!(
        "; values of a catalogue by rounding to their neighbours, the rest moved again{anew}{walked}"
    );
    Some((optima, how))
}
