//! The least of the largest violation, and which constraints it hangs on.

use std::ops::ControlFlow;

use crate::problem::{Evaluation, Problem, Scales, Slopes};
use crate::progress::{Ended, Hears, Progress};

use super::local::{Local, Sizes};
use super::search::Search;
use super::{SqpOptions, sqp};

/// The violation as an objective: all constraints, each by its scale, are pieces of it.
struct Violation<'a> {
    problem: &'a mut dyn Problem,
    sizes: Sizes,
}

impl Problem for Violation<'_> {
    fn bounds(&self) -> &[[f64; 2]] {
        self.problem.bounds()
    }

    fn scales(&self) -> Option<Scales> {
        Some(Scales::unit(1, 0))
    }

    fn evaluate(&mut self, designs: &[Vec<f64>]) -> Vec<Evaluation> {
        let mut evaluations = self.problem.evaluate(designs);
        for evaluation in &mut evaluations {
            if evaluation.is_defined() {
                let scaled = evaluation.constraints.iter().zip(&self.sizes.constraints);
                // A number that is none must stay so: the largest would hide it.
                let largest = scaled
                    .map(|(c, s)| c / s)
                    .fold(f64::NEG_INFINITY, kempe_number::math::max);
                evaluation.objectives = vec![largest];
                evaluation.constraints.clear();
            }
        }
        evaluations
    }

    fn slopes(&mut self, design: &[f64]) -> Option<Slopes> {
        let mut pieces = Vec::new();
        let slopes = self.problem.slopes(design)?;
        for (own, size) in slopes.constraints.into_iter().zip(&self.sizes.constraints) {
            pieces.extend(own.into_iter().map(|mut piece| {
                piece.value /= size;
                piece.slope.iter_mut().for_each(|g| *g /= size);
                piece
            }));
        }
        Some(Slopes {
            objectives: vec![pieces],
            constraints: Vec::new(),
        })
    }
}

/// Where the violation is least.
pub(super) struct Least {
    pub design: Vec<f64>,
    value: f64,
    pub ended: Ended,
    pub residual: f64,
    /// Constraints with their shares.
    pub conflict: Vec<(usize, f64)>,
}

impl Least {
    /// The largest violation, scaled.
    pub fn violation(&self) -> f64 {
        self.value.max(0.0)
    }
}

/// Minimises the violation from a place on; stops where there is none.
pub(super) fn least(
    search: &mut Search,
    place: &Local,
    options: &SqpOptions,
    hears: Hears,
) -> Least {
    let spent = search.evaluations;
    let mut problem = Violation {
        problem: search.problem,
        sizes: search.sizes.clone(),
    };
    let options = SqpOptions {
        evaluations: options
            .evaluations
            .saturating_sub(spent)
            .max(options.evaluations / 4),
        least: None,
        ..options.clone()
    };
    let mut listen = |progress: &Progress| {
        let kept = progress.best.is_some_and(|(_, value)| value <= 0.0);
        let told = hears(&Progress {
            evaluations: spent + progress.evaluations,
            budget: options.evaluations,
            violation: progress.best.map_or(f64::INFINITY, |(_, value)| value),
            best: None,
        });
        if kept { ControlFlow::Break(()) } else { told }
    };
    let found = sqp(&mut problem, &place.design, &options, &mut listen);
    // Which constraint each piece belongs to: they stand in their order.
    let slopes = problem.problem.slopes(&found.design);
    let counts = slopes.map_or(Vec::new(), |s| s.constraints.iter().map(Vec::len).collect());
    let mut shares = found.multipliers.objectives.iter().flatten();
    let mut conflict = Vec::new();
    for (constraint, count) in counts.into_iter().enumerate() {
        let share: f64 = shares.by_ref().take(count).sum();
        if share > 0.0 {
            conflict.push((constraint, share));
        }
    }
    search.evaluations += found.evaluations;
    search.slopes += found.slopes + 1;
    Least {
        value: found.objective(),
        residual: found.residual,
        design: found.design,
        ended: found.ended,
        conflict,
    }
}
