//! Fronts of several goals: designs none of which is better than another in all of them.

use kempe_model::OptimizeStudy;
use kempe_optimize::{
    Candidate, Ended, Hears, Nsga2Options, Problem, Progress, Refined, Scales, Workers,
    evaluate_all, joined, nsga2, refine, undominated, widen,
};

use super::beginning::{Beginning, Missed, beginning};
use super::discrete::{Catalogues, Tried, tried};
use super::problem::Designs;
use super::search::{KEPT, local};

/// Designs that are looked at for each parameter, where the file does not say, and points of a front.
const LOOKED_AT: usize = 600;
const POINTS: usize = 40;
/// Generations at least, where the file allows few designs.
const GENERATIONS: usize = 5;
/// How often the combinations next to those of a front are looked at.
const ROUNDS: usize = 4;
/// Fewer designs for each of few combinations are left to those that the front's neighbours have.
const OF_COMBINATION: usize = 300;
/// Designs that a point's way down tries, about.
const OF_POINT: usize = 10;
/// A goal that is better by less than this part of it is as good.
const BEYOND: f64 = 1e-6;

/// A design of a front.
pub(super) struct FrontPoint {
    /// The values of its parameters, SI.
    pub design: Vec<f64>,
    pub evaluation: kempe_optimize::Evaluation,
    /// How far the first-order conditions are missed; infinite where they were not looked at.
    pub residual: f64,
    /// The largest violation, in the constraints' scales.
    pub violation: f64,
}

/// A front.
pub(super) struct Front {
    /// By the first goal. Where no design keeps all limits, the nearest to it alone.
    pub points: Vec<FrontPoint>,
    /// Where no design keeps all limits.
    pub missed: Option<Missed>,
    /// The goals, by index, that have no bound: the best of them on the front is beside a pole.
    pub endless: Vec<usize>,
    /// Goals in which the file's own design is better than all points.
    pub hidden: Vec<usize>,
    pub stopped: bool,
    /// Whether there are conditions of first order: not where all values are of catalogues.
    pub has_conditions: bool,
}

/// The front of a study, and how it was found; `None` where it was stopped before there was one.
pub(super) fn front(
    problem: &Designs<'_, '_>,
    study: &OptimizeStudy,
    workers: &dyn Workers,
    hears: Hears,
) -> Option<(Front, String)> {
    let all = study.designs.unwrap_or(usize::MAX);
    // Of one work in several pieces: all that was tried so far.
    let hears: Hears = &mut |told: &Progress| {
        let asked = problem.asked().max(told.evaluations);
        let left = told.budget.saturating_sub(told.evaluations);
        hears(&Progress {
            evaluations: asked,
            budget: all.min(asked.saturating_add(left)),
            ..*told
        })
    };
    if let Some(tried) = tried(problem, study, workers, hears) {
        let how = "all combinations of the values were tried".to_owned();
        return Some((best_of(problem, tried), how));
    }
    // Most are left for the ways down, which need more the more points there are.
    let own = problem.variables(&problem.bench.own_values());
    let default = LOOKED_AT * own.len();
    let evaluations = study.designs.map_or(default, |all| all.div_ceil(3));
    let options = Nsga2Options {
        evaluations,
        population: POINTS.min(evaluations.div_ceil(GENERATIONS)),
        start: Some(own.clone()),
        seed: study.seed as u64,
    };
    let again = options.clone();
    let catalogues = Catalogues::of(problem, study);
    let catalogues = catalogues.as_ref();
    let left = || match (catalogues, study.designs) {
        (_, Some(all)) => all.saturating_sub(problem.asked()),
        (None, None) => usize::MAX,
        (Some(_), None) => default,
    };
    let Beginning {
        members: begun,
        missed,
        scales,
        mut how,
        mut stopped,
    } = beginning(problem, catalogues, (options, &left), workers, hears);
    let mut members: Vec<Refined> = begun.iter().map(unrefined).collect();
    if missed.is_none() && !stopped {
        match catalogues {
            None => {
                let down = (left(), study.goals.len());
                (members, stopped) = filled(problem, &begun, down, workers, hears);
            }
            Some(catalogues) => {
                let budget = Budget {
                    left: &left,
                    is_open: study.designs.is_none(),
                    population: &again,
                };
                let about = (catalogues, (&budget, &scales));
                let few;
                (members, stopped, few) =
                    over_combinations(problem, members, about, workers, hears);
                how += match few {
                    true => ", each combination of them by itself, too",
                    false => ", those next to it too",
                };
            }
        }
        how += "; each point moved down until no step betters all goals, and on to the least of each goal";
        if study.goals.len() == 2 {
            how += "; gaps filled";
        }
    }
    let endless = ends_at_poles(problem, &mut members, &scales);
    let hidden = hidden_ends(problem, own, (&mut members, &scales));
    let points = members.into_iter().map(|member| FrontPoint {
        design: problem.values(&member.candidate.design),
        violation: violation(&member.candidate, &scales),
        evaluation: member.candidate.evaluation,
        residual: member.residual,
    });
    let front = Front {
        points: points.collect(),
        missed,
        endless,
        hidden,
        stopped,
        has_conditions: catalogues.is_none_or(Catalogues::leave_some_free),
    };
    (!front.points.is_empty()).then_some((front, how))
}

/// The goals whose end of a front is beside a pole: no place for a design, and no optimum of anything.
fn ends_at_poles(
    problem: &Designs<'_, '_>,
    members: &mut [Refined],
    scales: &Scales,
) -> Vec<usize> {
    let mut endless = Vec::new();
    for goal in 0..problem.objectives() {
        let defined = (members.iter_mut()).filter(|m| m.candidate.evaluation.is_defined());
        let value = |m: &Refined| m.candidate.evaluation.objectives[goal];
        let Some(end) = defined.min_by(|a, b| value(a).total_cmp(&value(b))) else {
            continue;
        };
        let (design, own) = (&end.candidate.design, (goal, value(end)));
        let kept = end.candidate.evaluation.constraints.iter();
        let limited = (kept.zip(&scales.constraints)).any(|(kept, scale)| *kept >= -KEPT * scale);
        if problem.is_pole(design, own, (limited, false)) || problem.falls_on(design, own) {
            end.residual = f64::INFINITY;
            endless.push(goal);
        }
    }
    endless
}

/// The goals in which the file's own design betters all of a front: beside what is so large elsewhere, as at a pole, what is usual is as little, and the end of
/// the front is none.
fn hidden_ends(
    problem: &Designs<'_, '_>,
    own: Vec<f64>,
    (members, scales): (&mut [Refined], &Scales),
) -> Vec<usize> {
    let own = Candidate {
        evaluation: problem.look(&problem.values(&own)).0,
        design: own,
    };
    if violation(&own, scales) > KEPT {
        return Vec::new();
    }
    let mut hidden = Vec::new();
    for (goal, here) in own.evaluation.objectives.iter().enumerate() {
        let defined = (members.iter_mut()).filter(|m| m.candidate.evaluation.is_defined());
        let value = |m: &Refined| m.candidate.evaluation.objectives[goal];
        let Some(end) = defined.min_by(|a, b| value(a).total_cmp(&value(b))) else {
            continue;
        };
        if here + BEYOND * here.abs() < value(end) {
            end.residual = f64::INFINITY;
            hidden.push(goal);
        }
    }
    hidden
}

/// A design that no way led to.
fn unrefined(candidate: &Candidate) -> Refined {
    Refined {
        candidate: candidate.clone(),
        residual: f64::INFINITY,
        shares: Vec::new(),
        ended: Ended::Stopped,
    }
}

fn violation(candidate: &Candidate, scales: &Scales) -> f64 {
    match candidate.evaluation.is_defined() {
        true => candidate.evaluation.violation(scales),
        false => f64::INFINITY,
    }
}

/// What none of the designs that were tried betters in all goals; where none keeps all limits, the nearest to that.
fn best_of(problem: &Designs<'_, '_>, tried: Tried) -> Front {
    let scales = &tried.scales;
    let keeps = |c: &&Candidate| violation(c, scales) <= KEPT;
    let known = tried.best_first.iter().filter(keeps).map(unrefined);
    let mut best: Vec<Candidate> = (undominated(known.collect()).into_iter())
        .map(|it| it.candidate)
        .collect();
    let missed = best.is_empty().then(|| Missed {
        scales: tried.scales.clone(),
        conflicts: tried.contradictions(),
    });
    if missed.is_some() {
        best.extend(tried.best_first.first().cloned());
    }
    let points = best.into_iter().map(|candidate| FrontPoint {
        design: problem.values(&candidate.design),
        evaluation: candidate.evaluation.clone(),
        residual: f64::INFINITY,
        violation: violation(&candidate, scales),
    });
    Front {
        points: points.collect(),
        missed,
        endless: Vec::new(),
        hidden: Vec::new(),
        stopped: tried.stopped,
        has_conditions: false,
    }
}

/// A front moved down, led to its ends and filled, for which so many designs are tried; and whether it was stopped.
fn filled(
    problem: &dyn Problem,
    members: &[Candidate],
    (budget, goals): (usize, usize),
    workers: &dyn Workers,
    hears: Hears,
) -> (Vec<Refined>, bool) {
    // Of two goals gaps are filled afterwards, so that few designs lead as far as many.
    let some = match goals {
        2 => evenly(members, (budget / 2 / OF_POINT).max(goals)),
        _ => members.to_vec(),
    };
    let options = (&local(), budget / 2);
    let refined = refine(problem, &some, options, workers, hears);
    if refined.ended == Ended::Stopped {
        return (refined.members, true);
    }
    let options = (&local(), budget.saturating_sub(refined.evaluations));
    let widened = widen(problem, refined.members, POINTS, options, workers, hears);
    (widened.members, widened.ended == Ended::Stopped)
}

/// So many at most of a list, from its first to its last.
fn evenly<T: Clone>(all: &[T], most: usize) -> Vec<T> {
    if all.len() <= most {
        return all.to_vec();
    }
    let place = |k: usize| k * (all.len() - 1) / most.saturating_sub(1).max(1);
    (0..most).map(|k| all[place(k)].clone()).collect()
}

/// What may be tried for the combinations of catalogues.
struct Budget<'b> {
    /// Designs that are left, all together.
    left: &'b dyn Fn() -> usize,
    /// Whether the file does not say how many there are: few combinations then each have as many as a front without catalogues.
    is_open: bool,
    /// What looks for designs of each of few combinations.
    population: &'b Nsga2Options,
}

/// A front with values of the catalogues moved down: one is sought for every combination, where there are few, else for those on it or next to it, and what
/// nothing else betters is kept; so again where that leads to others, which have neighbours of their own. Whether it was stopped, and whether there are few.
fn over_combinations(
    problem: &Designs<'_, '_>,
    members: Vec<Refined>,
    (catalogues, (budget, scales)): (&Catalogues, (&Budget<'_>, &Scales)),
    workers: &dyn Workers,
    hears: Hears,
) -> (Vec<Refined>, bool, bool) {
    let goals = problem.objectives();
    let mut found = members;
    let mut tried: Vec<Vec<[f64; 2]>> = Vec::new();
    let mut few = false;
    for round in 0..ROUNDS {
        let designs = found.iter().map(|m| m.candidate.design.clone());
        let designs: Vec<Vec<f64>> = designs.collect();
        let single = catalogues.each(problem, &designs).filter(|all| {
            let share = (budget.left)() / all.len().max(1);
            few || budget.is_open || share >= OF_COMBINATION
        });
        few |= single.is_some();
        let mut all = single.unwrap_or_else(|| catalogues.about(problem, &designs));
        all.retain(|(held, _)| !tried.iter().any(|known| known == held.bounds()));
        let each = match few && budget.is_open {
            true => usize::MAX,
            false => (budget.left)() / all.len().max(1),
        };
        if all.is_empty() || round > 0 && each < goals * OF_POINT {
            break;
        }
        let mut better: Vec<Refined> = Vec::new();
        let mut was_stopped = false;
        for (held, starts) in &all {
            tried.push(held.bounds().to_vec());
            let mut left = each;
            let mut known = starts.clone();
            if few {
                let start = starts.first().cloned();
                let options = Nsga2Options {
                    evaluations: budget.population.evaluations.min(each / 3),
                    start: start.or(budget.population.start.clone()),
                    ..budget.population.clone()
                };
                let population = nsga2(held, &options, workers, hears);
                left = left.saturating_sub(options.evaluations);
                was_stopped = population.ended == Ended::Stopped;
                if population.feasible {
                    known.extend(population.members.into_iter().map(|m| m.design));
                }
            }
            // Limits that another value broke may not be kept again.
            let kept = |member: &Refined| violation(&member.candidate, scales) <= KEPT;
            let known = evenly(&known, (left / 2 / OF_POINT).max(goals));
            let told = evaluate_all(held, &known, workers).into_iter();
            let known = known.into_iter().zip(told);
            let known = known.map(|(design, evaluation)| Candidate { design, evaluation });
            let known: Vec<Candidate> = known.filter(|c| c.evaluation.is_defined()).collect();
            let left = left.saturating_sub(known.len());
            let mut own: Vec<Refined> = known.iter().map(unrefined).collect();
            let mut known = known;
            if few && own.iter().any(kept) {
                // As many as of a front without catalogues, of those that others do not better.
                own.retain(kept);
                own = joined(own, POINTS);
                known = own.iter().map(|member| member.candidate.clone()).collect();
            }
            if !was_stopped {
                (own, was_stopped) = filled(held, &known, (left, goals), workers, hears);
            }
            better.extend(own.into_iter().filter(kept));
            if was_stopped {
                break;
            }
        }
        // What was there before is lost to what betters it alone; behind, as of the same goals the first stays. Where all combinations have their own
        // front it was led on there.
        if !few || was_stopped {
            better.extend(found);
        }
        found = joined(better, POINTS);
        if was_stopped {
            return (found, true, few);
        }
    }
    (found, false, few)
}
