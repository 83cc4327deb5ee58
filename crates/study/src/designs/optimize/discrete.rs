//! Parameters that take some values alone, as of a catalogue.
//!
//! Where all do and there are few combinations, all are tried. Else the best design without regard to them is taken, each such parameter is put on the value
//! below or above, and the rest is moved again (rounding with repair). From the best of these it goes on from neighbour to neighbour (`neighbours.rs`): a good
//! design, and not shown to be the best of all combinations.

mod neighbours;

use kempe_model::{Model, OptimizeMethod, OptimizeStudy, StudyKind};
use kempe_optimize::{
    Candidate, Ended, Evaluation, FEASIBLE, Hears, MultiStartOptions, Optimum, Problem, Progress,
    Scales, Slopes, Workers, descents, evaluate_all, multi_start, worst_first,
};

use super::problem::{Designs, choices};
use super::search::{LOOKED_AT, Optima, local, plain};
use crate::designs::over::study_of;
use neighbours::Walked;

/// So many combinations are tried one by one; of simulations, which take longer, so many.
const MOST_TRIED: usize = 50_000;
const MOST_SIMULATED: usize = 2000;
/// Optima whose free parameters differ by less than this part of their bounds are one.
const NEAR: f64 = 1e-6;
/// So many combinations of neighbours are tried about one design.
const MOST_NEIGHBOURS: usize = 64;
/// So many combinations are tried between two questions whether to go on.
const TOGETHER: usize = 32;
/// So few combinations are all searched from all over the box, whatever their neighbours are.
const EACH: usize = 8;
/// Where no neighbour keeps all limits, so many combinations at most are searched from all over the box, each from so many starts.
const ANEW: usize = 16;
const ANEW_STARTS: usize = 4;
/// So many of the best are kept.
const KEPT: usize = 10;

/// Designs that were all tried.
pub(super) struct Tried {
    /// The best first.
    pub best_first: Vec<Candidate>,
    /// Sizes of objectives and constraints.
    pub scales: Scales,
    pub stopped: bool,
}

impl Tried {
    /// Limits that the best misses and that contradict each other, group by group, each as small as it can be: none of the designs keeps all of a group. Their
    /// shares are all alike. Where all of these are kept by some design, one that the best keeps contradicts them.
    pub fn contradictions(&self) -> Vec<Vec<(usize, f64)>> {
        let Some(best) = self.best_first.first().filter(|_| !self.stopped) else {
            return Vec::new();
        };
        let by = |k: usize| best.evaluation.constraints[k] / self.scales.constraints[k];
        let mut all: Vec<usize> = (0..best.evaluation.constraints.len()).collect();
        all.sort_by(|a, b| by(*b).total_cmp(&by(*a)));
        let missed = |k: &usize| by(*k) > FEASIBLE;
        let mut left: Vec<usize> = all.iter().copied().filter(missed).collect();
        if left.is_empty() {
            return Vec::new();
        }
        let mut groups = Vec::new();
        let mut next = self.smallest(&left).or_else(|| self.smallest(&all));
        while let Some(group) = next {
            left.retain(|k| !group.contains(k));
            groups.push(group.into_iter().map(|k| (k, 1.0)).collect());
            next = self.smallest(&left);
        }
        groups
    }

    /// Those of some limits of which no design keeps all, and every smaller set is kept by one (J. W. Chinneck and E. W. Dravnieks, 1991); `None` where a design
    /// keeps all.
    fn smallest(&self, some: &[usize]) -> Option<Vec<usize>> {
        if self.is_kept(some) {
            return None;
        }
        let mut group = some.to_vec();
        for limit in some.iter().rev() {
            let others = group.iter().copied().filter(|k| k != limit);
            let others: Vec<usize> = others.collect();
            if !self.is_kept(&others) {
                group = others;
            }
        }
        Some(group)
    }

    /// Whether a design keeps all of some limits.
    fn is_kept(&self, limits: &[usize]) -> bool {
        let designs = self.best_first.iter().map(|it| &it.evaluation);
        let mut designs = designs.filter(|it| it.is_defined());
        designs.any(|it| {
            let keeps = |k: &usize| it.constraints[*k] <= FEASIBLE * self.scales.constraints[*k];
            limits.iter().all(keeps)
        })
    }
}

/// All combinations of values, where every parameter is discrete and there are few.
pub(super) fn tried(
    problem: &Designs<'_, '_>,
    study: &OptimizeStudy,
    workers: &dyn Workers,
    hears: Hears,
) -> Option<Tried> {
    let values = values_of(problem.bench.model, study);
    let count = few(&values, problem.bench.model, study)?;
    let designs = Catalogues { values }.everywhere(&vec![0.0; study.vary.len()]);
    let mut evaluations = Vec::with_capacity(count);
    let mut stopped = false;
    for some in designs.chunks(TOGETHER) {
        evaluations.extend(evaluate_all(problem, some, workers));
        let told = hears(&Progress {
            evaluations: evaluations.len(),
            budget: count,
            best: None,
            violation: f64::INFINITY,
        });
        if told.is_break() && evaluations.len() < count {
            stopped = true;
            break;
        }
    }
    let scales = Scales::typical(&evaluations, problem.objectives(), problem.constraints());
    let both = designs.into_iter().zip(evaluations);
    let mut best_first: Vec<Candidate> = both
        .map(|(design, evaluation)| Candidate { design, evaluation })
        .collect();
    best_first.sort_by(|a, b| worst_first(&a.evaluation, &b.evaluation, &scales, FEASIBLE));
    Some(Tried {
        best_first,
        scales,
        stopped,
    })
}

/// The best of all combinations, where every parameter is discrete and there are few.
pub(super) fn all_of(
    problem: &Designs<'_, '_>,
    study: &OptimizeStudy,
    workers: &dyn Workers,
    hears: Hears,
) -> Option<Optima> {
    let tried = tried(problem, study, workers, hears)?;
    let conflicts = tried.contradictions();
    let best = tried.best_first.into_iter().take(KEPT);
    let list: Vec<Optimum> = best
        .map(|Candidate { design, evaluation }| {
            let violation = match evaluation.is_defined() {
                true => evaluation.violation(&tried.scales),
                false => f64::INFINITY,
            };
            let ended = if tried.stopped {
                Ended::Stopped
            } else {
                Ended::Converged
            };
            Optimum {
                ended,
                conflicts: conflicts.clone(),
                scales: tried.scales.clone(),
                ..plain(design, evaluation, violation)
            }
        })
        .collect();
    Some(Optima {
        reached: vec![1; list.len()],
        list,
        stopped: tried.stopped,
    })
}

/// How many combinations there are, where every parameter is discrete and there are few.
fn few(values: &[Vec<f64>], model: &Model, study: &OptimizeStudy) -> Option<usize> {
    let mut lengths = values.iter().map(Vec::len);
    let count = lengths.try_fold(1_usize, usize::checked_mul)?;
    let over = study_of(model, &study.over).ok();
    let most = match over.map(|over| &over.kind) {
        Some(StudyKind::Simulate(_)) => MOST_SIMULATED,
        _ => MOST_TRIED,
    };
    let most = most.min(study.designs.unwrap_or(usize::MAX));
    (count > 0 && count <= most).then_some(count)
}

/// Whether values of a catalogue are found by rounding and are too many for all of their combinations to be tried where none of those keeps all limits.
pub(super) fn is_rounded(model: &Model, study: &OptimizeStudy) -> bool {
    let values = values_of(model, study);
    are_some_chosen(model, study) && combinations(&values) > ANEW
}

/// Whether there are catalogues, and not all of their combinations are tried one by one.
pub(super) fn are_some_chosen(model: &Model, study: &OptimizeStudy) -> bool {
    let values = values_of(model, study);
    values.iter().any(|list| !list.is_empty()) && few(&values, model, study).is_none()
}

/// The values of every parameter that is discrete; of the others none.
fn values_of(model: &Model, study: &OptimizeStudy) -> Vec<Vec<f64>> {
    let all = study.vary.iter();
    all.map(|chosen| choices(model, &chosen.among)).collect()
}

/// A problem some of whose variables stand still.
pub(super) struct Held<'p, 'b, 'm> {
    inner: &'p Designs<'b, 'm>,
    pub bounds: Vec<[f64; 2]>,
}

impl Problem for Held<'_, '_, '_> {
    fn bounds(&self) -> &[[f64; 2]] {
        &self.bounds
    }

    fn objectives(&self) -> usize {
        self.inner.objectives()
    }

    fn constraints(&self) -> usize {
        self.inner.constraints()
    }

    fn least(&self) -> f64 {
        self.inner.least()
    }

    fn least_of(&self, constraint: usize) -> f64 {
        self.inner.least_of(constraint)
    }

    fn evaluate(&self, design: &[f64]) -> Evaluation {
        self.inner.evaluate(design)
    }

    fn slopes(&self, design: &[f64]) -> Option<Slopes> {
        self.inner.slopes(design)
    }
}

/// Values of catalogues.
pub(super) struct Catalogues {
    /// By parameter; of those that may have any value none.
    values: Vec<Vec<f64>>,
}

/// A combination of values of the catalogues: the problem with them held, and designs with them from which others are found.
pub(super) type Combination<'p, 'b, 'm> = (Held<'p, 'b, 'm>, Vec<Vec<f64>>);

impl Catalogues {
    /// Of a study; `None` where no parameter is discrete.
    pub fn of(problem: &Designs<'_, '_>, study: &OptimizeStudy) -> Option<Self> {
        let values = values_of(problem.bench.model, study);
        (!values.iter().all(Vec::is_empty)).then_some(Self { values })
    }

    /// The file's own design, between the bounds and with the nearest values.
    fn own(&self, problem: &Designs<'_, '_>) -> Vec<f64> {
        let own = problem.variables(&problem.bench.own_values());
        let own = own.iter().zip(problem.bounds());
        let own: Vec<f64> = own.map(|(x, [low, high])| x.clamp(*low, *high)).collect();
        self.rounded(&own)
    }

    /// A design with the nearest values.
    pub fn rounded(&self, design: &[f64]) -> Vec<f64> {
        let nearest = |x: f64, all: &[f64]| {
            let near = neighbours(x, all).into_iter();
            near.min_by(|a, b| (a - x).abs().total_cmp(&(b - x).abs()))
        };
        let both = design.iter().zip(&self.values);
        both.map(|(x, all)| nearest(*x, all).unwrap_or(*x))
            .collect()
    }

    /// The combinations of values next to those of a design, with the design at each.
    fn near<'p, 'b, 'm>(
        &self,
        problem: &'p Designs<'b, 'm>,
        design: &[f64],
    ) -> Vec<(Held<'p, 'b, 'm>, Vec<f64>)> {
        let near = design.iter().zip(&self.values);
        let near: Vec<Vec<f64>> = near.map(|(x, all)| neighbours(*x, all)).collect();
        let counts = near.iter().map(|n| n.len().max(1));
        let count = counts.product::<usize>().min(MOST_NEIGHBOURS);
        let one = |combination: usize| {
            let mut left = combination;
            let mut start = design.to_vec();
            for (k, near) in near.iter().enumerate().filter(|(_, near)| !near.is_empty()) {
                start[k] = near[left % near.len()];
                left /= near.len();
            }
            (self.held(problem, &start), start)
        };
        (0..count).map(one).collect()
    }

    /// Whether some parameters may have any value.
    pub fn leave_some_free(&self) -> bool {
        self.values.iter().any(Vec::is_empty)
    }

    /// All combinations, where there are so few that each is searched by itself; with each those of some designs that have its values.
    pub fn each<'p, 'b, 'm>(
        &self,
        problem: &'p Designs<'b, 'm>,
        designs: &[Vec<f64>],
    ) -> Option<Vec<Combination<'p, 'b, 'm>>> {
        if combinations(&self.values) > EACH {
            return None;
        }
        let all = self.all_held(problem).into_iter().map(|held| {
            let is_of = |other: &&Vec<f64>| self.held(problem, other).bounds == held.bounds;
            let own = designs.iter().filter(is_of).cloned().collect();
            (held, own)
        });
        Some(all.collect())
    }

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

    /// The problem with every combination of values held.
    fn all_held<'p, 'b, 'm>(&self, problem: &'p Designs<'b, 'm>) -> Vec<Held<'p, 'b, 'm>> {
        let lows: Vec<f64> = problem.bounds().iter().map(|[low, _]| *low).collect();
        let all = self.everywhere(&lows);
        all.iter().map(|it| self.held(problem, it)).collect()
    }

    /// A design with every combination of values in its place.
    fn everywhere(&self, design: &[f64]) -> Vec<Vec<f64>> {
        let one = |mut left: usize| {
            let mut design = design.to_vec();
            for (x, values) in design.iter_mut().zip(&self.values) {
                if !values.is_empty() {
                    *x = values[left % values.len()];
                    left /= values.len();
                }
            }
            design
        };
        (0..combinations(&self.values)).map(one).collect()
    }

    /// The combinations of designs that have values of the catalogues, in the order of the designs, and then those that differ from one of
    /// these by one step in one value.
    pub fn about<'p, 'b, 'm>(
        &self,
        problem: &'p Designs<'b, 'm>,
        designs: &[Vec<f64>],
    ) -> Vec<Combination<'p, 'b, 'm>> {
        let mut all: Vec<Combination> = Vec::new();
        let mut put = |start: Vec<f64>| {
            let held = self.held(problem, &start);
            match all
                .iter()
                .position(|(known, _)| known.bounds == held.bounds)
            {
                Some(place) => all[place].1.push(start),
                None if all.len() < MOST_NEIGHBOURS => all.push((held, vec![start])),
                None => {}
            }
        };
        designs.iter().cloned().for_each(&mut put);
        for design in designs {
            for (k, values) in self.values.iter().enumerate() {
                let Some(own) = values.iter().position(|value| *value == design[k]) else {
                    continue;
                };
                let steps = [own.checked_sub(1), Some(own + 1)].into_iter().flatten();
                for value in steps.filter_map(|k| values.get(k)) {
                    let mut start = design.clone();
                    start[k] = *value;
                    put(start);
                }
            }
        }
        all
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

    /// The problem with a design's values of the catalogues held.
    fn held<'p, 'b, 'm>(&self, problem: &'p Designs<'b, 'm>, design: &[f64]) -> Held<'p, 'b, 'm> {
        let bounds = problem.bounds().iter().zip(design).zip(&self.values);
        let bounds = bounds.map(|((bounds, x), values)| match values.is_empty() {
            true => *bounds,
            false => [*x, *x],
        });
        Held {
            inner: problem,
            bounds: bounds.collect(),
        }
    }
}

/// A problem whose designs all have the nearest values of the catalogues.
pub(super) struct Rounded<'p, 'b, 'm> {
    pub inner: &'p Designs<'b, 'm>,
    pub to: &'p Catalogues,
}

impl Problem for Rounded<'_, '_, '_> {
    fn bounds(&self) -> &[[f64; 2]] {
        self.inner.bounds()
    }

    fn objectives(&self) -> usize {
        self.inner.objectives()
    }

    fn constraints(&self) -> usize {
        self.inner.constraints()
    }

    fn least(&self) -> f64 {
        self.inner.least()
    }

    fn least_of(&self, constraint: usize) -> f64 {
        self.inner.least_of(constraint)
    }

    fn evaluate(&self, design: &[f64]) -> Evaluation {
        self.inner.evaluate(&self.to.rounded(design))
    }

    fn exactly(&self, design: &[f64]) -> Option<Evaluation> {
        self.inner.exactly(&self.to.rounded(design))
    }

    fn nearly(&self, designs: &[Vec<f64>], workers: &dyn Workers) -> Vec<Evaluation> {
        let rounded: Vec<Vec<f64>> = designs.iter().map(|it| self.to.rounded(it)).collect();
        self.inner.nearly(&rounded, workers)
    }

    fn slopes(&self, design: &[f64]) -> Option<Slopes> {
        self.inner.slopes(&self.to.rounded(design))
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

/// How many combinations of values there are.
fn combinations(values: &[Vec<f64>]) -> usize {
    let lengths = values.iter().map(|values| values.len().max(1));
    lengths.fold(1, usize::saturating_mul)
}

/// The values next below and above; none where any may be taken.
fn neighbours(x: f64, all: &[f64]) -> Vec<f64> {
    let above = all.partition_point(|value| *value < x);
    let mut near: Vec<f64> = [above.checked_sub(1), Some(above)]
        .into_iter()
        .flatten()
        .filter_map(|k| all.get(k).copied())
        .collect();
    near.dedup();
    near
}
