//! All combinations of values of catalogues, where they are few: tried one by one.

use kempe_model::OptimizeStudy;
use kempe_optimize::{
    Candidate, Ended, FEASIBLE, Hears, Optimum, Problem, Progress, Scales, Workers, evaluate_all,
    worst_first,
};

use super::super::designs::Designs;
use super::super::optima::{Optima, plain};
use super::catalogues::{Catalogues, few, values_of};

/// So many combinations are tried between two questions whether to go on.
pub(super) const TOGETHER: usize = 32;
/// So many of the best are kept.
pub(super) const KEPT: usize = 10;

/// Designs that were all tried.
pub(in super::super) struct Tried {
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
pub(in super::super) fn tried(
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
pub(in super::super) fn all_of(
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
