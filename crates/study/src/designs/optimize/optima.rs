//! Local optima of a study's problem, as a search has found them.

use kempe_optimize::{Ended, Evaluation, Multipliers, Optimum, Scales};

use super::designs::Designs;

/// Local optima that differ, the best first.
pub(super) struct Optima {
    /// The optima, their designs and multipliers SI.
    pub list: Vec<Optimum>,
    /// How many descents led to each.
    pub reached: Vec<usize>,
    /// Whether whoever listened stopped it.
    pub stopped: bool,
}

impl Optima {
    /// What has no bound is no optimum, though its slopes are nothing beside it.
    pub fn tell_poles(&mut self, problem: &Designs<'_, '_>) {
        for optimum in &mut self.list {
            let is_defined = optimum.evaluation.is_defined();
            let (design, goal) = (&optimum.design, (0, optimum.objective()));
            let limited = (optimum.eased.constraints.iter().flatten()).any(|cost| *cost > 0.0);
            let at_edge = optimum.beyond.is_some();
            let has_pole = || problem.is_pole(design, goal, (limited, at_edge));
            if is_defined && (has_pole() || problem.falls_on(design, goal)) {
                optimum.ended = Ended::Unbounded;
                optimum.residual = f64::INFINITY;
                optimum.multipliers = Multipliers::default();
                optimum.eased = Multipliers::default();
            }
        }
    }

    /// Designs and multipliers of bounds of the parameters, not of the variables.
    pub fn in_parameters(&mut self, problem: &Designs<'_, '_>) {
        for optimum in &mut self.list {
            optimum.design = problem.values(&optimum.design);
            optimum.beyond = optimum.beyond.as_deref().map(|it| problem.values(it));
            let growth = problem.growth(&optimum.design);
            for told in [&mut optimum.multipliers, &mut optimum.eased] {
                for (both, growth) in told.bounds.iter_mut().zip(&growth) {
                    both.iter_mut().for_each(|cost| *cost /= growth);
                }
            }
        }
    }
}

/// A single one.
pub(super) fn one(found: Optimum, stopped: bool) -> Optima {
    Optima {
        list: vec![found],
        reached: vec![1],
        stopped,
    }
}

/// A design that was only evaluated.
pub(super) fn plain(design: Vec<f64>, evaluation: Evaluation, violation: f64) -> Optimum {
    Optimum {
        design,
        evaluation,
        multipliers: Multipliers::default(),
        eased: Multipliers::default(),
        residual: f64::NAN,
        violation,
        conflicts: Vec::new(),
        beyond: None,
        scales: Scales::default(),
        iterations: 0,
        evaluations: 0,
        slopes: 0,
        ended: Ended::Converged,
    }
}
