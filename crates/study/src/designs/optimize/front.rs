//! Fronts of several goals: designs none of which is better than another in all of them.

use std::collections::BTreeSet;

use kempe_model::OptimizeStudy;
use kempe_optimize::{
    Candidate, Ended, EndsFrom, Hears, Nsga2Options, Problem, Refined, RefinedFront, Scales,
    Widening, Within, Workers, evaluate_all, evenly, joined, nsga2, refine_some, undominated,
    widen,
};

use super::beginning::{Beginning, Missed, beginning};
use super::designs::Designs;
use super::discrete::{Catalogues, Tried, tried};
use super::effort::{KEPT, LOOKED_AT as LOOKED_AT_ALONE, STARTS, further, local};

/// Designs that are looked at for each parameter, where the file does not say, and points of a front.
const LOOKED_AT: usize = 600;
const POINTS: usize = 40;
/// Designs of a front for each parameter at most, where the file does not say: along an edge of what can be asked each step takes many.
const MOST: usize = 4000;
/// Generations at least, where the file allows few designs.
const GENERATIONS: usize = 5;
/// How often the combinations next to those of a front are looked at.
const ROUNDS: usize = 4;
/// Fewer designs for each of few combinations are left to those that the front's neighbours have.
const OF_COMBINATION: usize = 300;
/// Designs that a point's way down tries, about.
const OF_POINT: usize = 10;
/// A goal that is to be small and is more than this many times as large as it usually is, of designs anywhere between the bounds, is beside a pole.
pub(super) const WITHIN: f64 = 100.0;
/// Where designs come to this part of that it is held below it from the start, and the front is cut off where some are at this part.
const TOWARDS: f64 = 0.1;
const AT_MOST: f64 = 0.99;
/// Differences that differ by less than this part of what they are of are the same.
const ROUNDING: f64 = 1e-12;
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

/// From where a front was sought.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sought {
    /// Its ends so.
    Ends(EndsFrom),
    /// Of many combinations of catalogues those that were found, and those next to them.
    NextTo,
    /// All that there is was tried, or nothing sought.
    All,
}

/// A front.
pub(super) struct Front {
    /// By the first goal. Where no design keeps all limits, the nearest to it alone.
    pub points: Vec<FrontPoint>,
    /// Where no design keeps all limits.
    pub missed: Option<Missed>,
    /// The goals, by index, that have no bound: the best of them on the front is beside a pole.
    pub endless: Vec<usize>,
    /// Goals that are smaller the larger another one is allowed to be, as beside a pole, and the most that was allowed.
    pub cut: Vec<(usize, f64)>,
    /// Goals in which the file's own design is better than all points.
    pub hidden: Vec<usize>,
    /// Whether designs did not do for its ends, or for gaps in it.
    pub short: bool,
    /// From where it was sought.
    pub sought: Sought,
    pub stopped: bool,
    /// Whether there are conditions of first order: not where all values are of catalogues.
    pub has_conditions: bool,
}

/// The front of a study from where it begins, and how it was found; `None` where it was stopped before there was one.
pub(super) fn front(
    problem: &Designs<'_, '_>,
    (study, own): (&OptimizeStudy, Vec<f64>),
    workers: &dyn Workers,
    hears: Hears,
) -> Option<(Front, String)> {
    if let Some(tried) = tried(problem, study, workers, hears) {
        let how = "all combinations of the values were tried".to_owned();
        return Some((best_of(problem, tried), how));
    }
    // Most are left for the ways down, which need more the more points there are.
    let default = LOOKED_AT * own.len();
    let evaluations = study.designs.map_or(default, |all| all.div_ceil(3));
    let options = Nsga2Options {
        evaluations,
        population: POINTS.min(evaluations.div_ceil(GENERATIONS)),
        start: Some(own.clone()),
        within: WITHIN,
        seed: study.seed as u64,
    };
    let again = options.clone();
    let catalogues = Catalogues::of(problem, study);
    let catalogues = catalogues.as_ref();
    let left = || match (catalogues, study.designs) {
        (_, Some(all)) => all.saturating_sub(problem.asked()),
        (None, None) => (MOST * own.len()).saturating_sub(problem.asked()),
        (Some(_), None) => default,
    };
    let Beginning {
        members: begun,
        missed,
        scales,
        mut most,
        known,
        mut how,
        mut stopped,
    } = beginning(problem, catalogues, (options, &left), workers, hears);
    // Its ends are sought from where each goal alone would be.
    let widening = Widening {
        points: POINTS,
        samples: LOOKED_AT_ALONE,
        starts: STARTS,
        further: Some(further(study, own.len())),
        seed: study.seed as u64,
        known,
        even: again.population,
        start: Some(own.clone()),
    };
    let mut members: Vec<Refined> = begun.iter().map(unrefined).collect();
    for (goal, most) in most.iter_mut().enumerate() {
        if is_limited(goal, &begun) {
            *most = f64::INFINITY;
        }
    }
    let (mut cut, mut short, mut sought) = (BTreeSet::new(), false, Sought::All);
    if missed.is_none() && !stopped {
        let found = match catalogues {
            None => {
                let found = filled(problem, &begun, (left(), &most, &widening), workers, hears);
                sought = Sought::Ends(found.ends_from);
                found
            }
            Some(catalogues) => {
                let budget = Budget {
                    left: &left,
                    is_open: study.designs.is_none(),
                    population: &again,
                    widening: &widening,
                };
                let about = (catalogues, (&budget, &scales, &most[..]));
                let (found, few) = over_combinations(problem, members, about, workers, hears);
                how += match few {
                    true => ", each combination of them by itself, too",
                    false => ", those next to it too",
                };
                sought = match few {
                    true => Sought::Ends(found.ends_from),
                    false => Sought::NextTo,
                };
                found
            }
        };
        (members, stopped, cut, short) = (found.members, found.stopped, found.cut, found.short);
        how += "; each point moved down until no step betters all goals, and on to the least of each goal";
        if study.goals.len() == 2 {
            how += "; gaps filled";
        }
    }
    let cut = cut.into_iter().map(|goal| (goal, most[goal])).collect();
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
        cut,
        hidden,
        short,
        sought,
        stopped,
        has_conditions: catalogues.is_none_or(Catalogues::leave_some_free),
    };
    (!front.points.is_empty()).then_some((front, how))
}

/// Whether some limit says how large a goal may be: it differs from that by as much at all designs.
fn is_limited(goal: usize, designs: &[Candidate]) -> bool {
    let limits = designs
        .first()
        .map_or(0, |it| it.evaluation.constraints.len());
    let is_same = |limit: usize| {
        let mut differences = designs.iter().map(|it| {
            let of = &it.evaluation;
            (
                of.objectives[goal] - of.constraints[limit],
                of.objectives[goal].abs(),
            )
        });
        let first = differences.next();
        first.is_some_and(|(first, _)| {
            differences
                .all(|(other, size)| (other - first).abs() <= ROUNDING * size.max(first.abs()))
        })
    };
    designs.len() > 1 && (0..limits).any(is_same)
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
        cut: Vec::new(),
        hidden: Vec::new(),
        short: false,
        sought: Sought::All,
        stopped: tried.stopped,
        has_conditions: false,
    }
}

/// A front moved down, led to its ends and filled.
struct Filled {
    members: Vec<Refined>,
    stopped: bool,
    /// The goals that would have been larger than they may.
    cut: BTreeSet<usize>,
    /// Whether designs did not do for its ends, or for gaps in it.
    short: bool,
    ends_from: EndsFrom,
}

/// A front moved down, led to its ends and filled, for which so many designs are tried. Goals that come near to the most that they may be are held below it;
/// where others become more than that, as beside a pole, once more with these held: what is usual is lost beside what is so large.
fn filled(
    problem: &dyn Problem,
    members: &[Candidate],
    (mut budget, most, widening): (usize, &[f64], &Widening),
    workers: &dyn Workers,
    hears: Hears,
) -> Filled {
    let is_over =
        |goal: usize, part: f64, it: &Candidate| it.evaluation.objectives[goal] > part * most[goal];
    let usual = |it: &Candidate| (0..most.len()).all(|goal| !is_over(goal, 1.0, it));
    let near = |goal: &usize| members.iter().any(|it| is_over(*goal, TOWARDS, it));
    let mut held: BTreeSet<usize> = (0..most.len()).filter(near).collect();
    let mut cut = BTreeSet::new();
    let mut all: Vec<Refined> = Vec::new();
    let mut ends_from = EndsFrom::Own;
    loop {
        let limits = (0..most.len()).map(|goal| match held.contains(&goal) {
            true => most[goal],
            false => f64::INFINITY,
        });
        let within = Within::new(problem, &limits.collect::<Vec<_>>());
        let known = all.iter().map(|it| &it.candidate);
        let begun = members.iter().chain(known);
        let begun = begun.filter(|it| held.is_empty() || usual(it));
        let begun: Vec<Candidate> = begun.cloned().collect();
        let known = widening.known.iter().map(|it| Candidate {
            design: it.design.clone(),
            evaluation: within.with(it.evaluation.clone()),
        });
        let widening = Widening {
            known: known.collect(),
            ..widening.clone()
        };
        let found = led(&within, &begun, (budget, &widening), workers, hears);
        budget = budget.saturating_sub(found.evaluations);
        let [stopped, short] = [Ended::Stopped, Ended::Budget].map(|it| found.ended == it);
        ends_from = ends_from.max(found.ends_from);
        let is_first = all.is_empty();
        all.extend(found.members.into_iter().map(|mut member| {
            let evaluation = std::mem::take(&mut member.candidate.evaluation);
            member.candidate.evaluation = within.without(evaluation);
            member
        }));
        let reach =
            |goal: &usize, part: f64| all.iter().any(|it| is_over(*goal, part, &it.candidate));
        cut.extend(held.iter().copied().filter(|goal| reach(goal, AT_MOST)));
        let over: Vec<usize> = (0..most.len())
            .filter(|goal| !held.contains(goal) && reach(goal, 1.0))
            .collect();
        if !over.is_empty() {
            all.retain(|it| usual(&it.candidate));
        }
        cut.extend(&over);
        if over.is_empty() || stopped {
            return Filled {
                members: if is_first { all } else { joined(all, POINTS) },
                stopped,
                cut,
                short,
                ends_from,
            };
        }
        held.extend(over);
    }
}

/// A front moved down, led to its ends and filled, for which so many designs are tried at most.
fn led(
    problem: &dyn Problem,
    members: &[Candidate],
    (budget, widening): (usize, &Widening),
    workers: &dyn Workers,
    hears: Hears,
) -> RefinedFront {
    // Of more than two goals there are no gaps to fill.
    let most = match problem.objectives() {
        2 => budget / 2,
        _ => budget - budget / 4,
    };
    let refined = refine_some(problem, members, (&local(), most), workers, hears);
    if refined.ended == Ended::Stopped {
        return refined;
    }
    let options = (&local(), budget.saturating_sub(refined.evaluations));
    let widening = widening.clone();
    let widened = widen(problem, refined.members, widening, options, workers, hears);
    RefinedFront {
        evaluations: refined.evaluations.saturating_add(widened.evaluations),
        ..widened
    }
}

/// What may be tried for the combinations of catalogues.
struct Budget<'b> {
    /// Designs that are left, all together.
    left: &'b dyn Fn() -> usize,
    /// Whether the file does not say how many there are: few combinations then each have as many as a front without catalogues.
    is_open: bool,
    /// What looks for designs of each of few combinations.
    population: &'b Nsga2Options,
    /// How far the front of each is led.
    widening: &'b Widening,
}

/// A front with values of the catalogues moved down: one is sought for every combination, where there are few, else for those on it or next to it, and what
/// nothing else betters is kept; so again where that leads to others, which have neighbours of their own. Whether there are few of them is told besides.
fn over_combinations(
    problem: &Designs<'_, '_>,
    members: Vec<Refined>,
    (catalogues, (budget, scales, most)): (&Catalogues, (&Budget<'_>, &Scales, &[f64])),
    workers: &dyn Workers,
    hears: Hears,
) -> (Filled, bool) {
    let goals = problem.objectives();
    let (mut found, mut stopped) = (members, false);
    let mut tried: Vec<Vec<[f64; 2]>> = Vec::new();
    let mut few = false;
    let (mut cut, mut short, mut ends_from) = (BTreeSet::new(), false, EndsFrom::Samples);
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
            let mut widening = budget.widening.clone();
            let mut known = starts.clone();
            if few {
                let start = starts.first().cloned();
                let options = Nsga2Options {
                    evaluations: budget.population.evaluations.min(each / 3),
                    start: start.or(budget.population.start.clone()),
                    ..budget.population.clone()
                };
                let mut population = nsga2(held, &options, workers, hears);
                left = left.saturating_sub(options.evaluations);
                was_stopped = population.ended == Ended::Stopped;
                widening.known = std::mem::take(&mut population.seen);
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
                let there = filled(held, &known, (left, most, &widening), workers, hears);
                (own, was_stopped) = (there.members, there.stopped);
                cut.extend(there.cut);
                short |= there.short;
                ends_from = ends_from.min(there.ends_from);
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
        stopped = was_stopped;
        if stopped {
            break;
        }
    }
    let found = Filled {
        members: found,
        stopped,
        cut,
        short,
        ends_from,
    };
    (found, few)
}
