//! What a front begins with: designs that a population finds, and where it finds none that keeps all limits, those that ways down lead to.

use kempe_optimize::{
    Candidate, Ended, FEASIBLE, Hears, Nsga2Options, Optimum, Problem, Scales, SqpOptions, Workers,
    descents, nsga2, worst_first,
};

use super::designs::Designs;
use super::discrete::{Catalogues, Rounded};
use super::effort::{KEPT, local};

/// Designs from which a front is led on.
pub(super) struct Beginning {
    /// Where none keeps all limits, the nearest to that alone.
    pub members: Vec<Candidate>,
    /// Where none keeps all limits.
    pub missed: Option<Missed>,
    /// Sizes of objectives and constraints.
    pub scales: Scales,
    /// What every goal is at most: more is too large to choose among what is usual.
    pub most: Vec<f64>,
    /// Designs that were tried, first from all over the box, where there are no catalogues.
    pub known: Vec<Candidate>,
    pub how: String,
    pub stopped: bool,
}

/// How the limits contradict each other at the design that comes nearest to keeping them.
pub(super) struct Missed {
    /// Sizes of objectives and constraints.
    pub scales: Scales,
    /// Which limits keep the violation from being less, and their shares; none where that is not known.
    pub conflicts: Vec<Vec<(usize, f64)>>,
}

/// Finds them, where there are catalogues with their values. `left` says how many designs may be tried yet.
pub(super) fn beginning(
    problem: &Designs<'_, '_>,
    catalogues: Option<&Catalogues>,
    (options, left): (Nsga2Options, &dyn Fn() -> usize),
    workers: &dyn Workers,
    hears: Hears,
) -> Beginning {
    let mut how = "NSGA-II".to_owned();
    if catalogues.is_some() {
        how += " over values of the catalogue";
    }
    let mut found = population(problem, catalogues, &options, workers, hears);
    let mut stopped = found.ended == Ended::Stopped;
    let known = match catalogues {
        Some(_) => Vec::new(),
        None => std::mem::take(&mut found.seen),
    };
    let mut missed = None;
    if !found.feasible {
        let mut led = Vec::new();
        if !stopped {
            let nearest = found.members.iter().map(|m| m.design.clone());
            let about = (catalogues, (left(), &found.scales));
            led = towards_limits(problem, nearest.collect(), about, workers, hears);
            stopped = led.iter().any(|it| it.ended == Ended::Stopped);
            how += ", downhill from the nearest to all limits";
        }
        let (kept, nearest): (Vec<Optimum>, Vec<Optimum>) =
            led.into_iter().partition(|it| it.violation <= KEPT);
        if let Some(first) = kept.first() {
            let evaluations = options.evaluations.min(left());
            if !stopped && evaluations > 0 {
                let again = Nsga2Options {
                    start: Some(first.design.clone()),
                    population: options.population.min(evaluations),
                    evaluations,
                    ..options
                };
                found = population(problem, catalogues, &again, workers, hears);
                stopped = found.ended == Ended::Stopped;
                how += ", NSGA-II again from there";
            }
            if !found.feasible {
                found.members.clear();
            }
            found.members.extend(kept.into_iter().map(candidate));
        } else {
            how += "; no design keeps all limits, this one comes nearest";
            let mut conflicts = Vec::new();
            if let Some(nearest) = nearest.into_iter().next() {
                (found.scales, conflicts) = (nearest.scales.clone(), nearest.conflicts.clone());
                found.members = vec![candidate(nearest)];
            }
            missed = Some(Missed {
                scales: found.scales.clone(),
                conflicts,
            });
        }
    }
    Beginning {
        members: found.members,
        missed,
        scales: found.scales,
        most: found.most,
        known,
        how,
        stopped,
    }
}

/// The front that NSGA-II finds, where there are catalogues of designs with their values.
fn population(
    problem: &Designs<'_, '_>,
    catalogues: Option<&Catalogues>,
    options: &Nsga2Options,
    workers: &dyn Workers,
    hears: Hears,
) -> kempe_optimize::Front {
    let Some(to) = catalogues else {
        return nsga2(problem, options, workers, hears);
    };
    let inner = problem;
    let mut found = nsga2(&Rounded { inner, to }, options, workers, hears);
    for member in &mut found.members {
        member.design = to.rounded(&member.design);
    }
    found
}

/// Where ways down lead from designs that miss some limit, and from the file's own, first those that keep all or miss them least: what a population does not
/// hit they may reach. Where there are catalogues, with their values at these designs and next to them.
fn towards_limits(
    problem: &Designs<'_, '_>,
    mut designs: Vec<Vec<f64>>,
    (catalogues, (budget, scales)): (Option<&Catalogues>, (usize, &Scales)),
    workers: &dyn Workers,
    hears: Hears,
) -> Vec<Optimum> {
    designs.push(problem.variables(&problem.bench.own_values()));
    let combinations = catalogues.map(|all| {
        let rounded = designs.iter().map(|design| all.rounded(design));
        all.about(problem, &rounded.collect::<Vec<_>>())
    });
    let starts: Vec<(&dyn Problem, Vec<f64>)> = match &combinations {
        Some(all) => (all.iter())
            .flat_map(|(held, starts)| {
                let held: &dyn Problem = held;
                starts.iter().map(move |start| (held, start.clone()))
            })
            .collect(),
        None => (designs.into_iter())
            .map(|design| (problem as &dyn Problem, design))
            .collect(),
    };
    let options = SqpOptions {
        least: Some(scales.clone()),
        ..local()
    };
    let mut led = descents(starts, &options, budget, workers, hears);
    led.retain(|it| it.evaluation.is_defined());
    led.sort_by(|a, b| worst_first(&a.evaluation, &b.evaluation, scales, FEASIBLE));
    led
}

fn candidate(found: Optimum) -> Candidate {
    Candidate {
        design: found.design,
        evaluation: found.evaluation,
    }
}
