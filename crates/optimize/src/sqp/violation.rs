//! What a descent minimises: a problem, or the largest violation of its constraints alone.

use crate::problem::{self, Evaluation, Piece, Problem, Scales, Slopes, largest};

use super::local::Sizes;

/// A problem as a descent sees it.
#[derive(Clone)]
pub(super) struct View<'a> {
    pub problem: &'a dyn Problem,
    /// Where the violation alone is minimised, what the constraints count in: all of them, each by its scale, are pieces of one objective.
    pub violation: Option<Sizes>,
}

impl View<'_> {
    /// How many objectives and constraints there are.
    pub fn functions(&self) -> [usize; 2] {
        match self.violation {
            Some(_) => [1, 0],
            None => [self.problem.objectives(), self.problem.constraints()],
        }
    }

    pub fn scales(&self) -> Option<Scales> {
        match self.violation {
            Some(_) => Some(Scales::unit(1, 0)),
            None => self.problem.scales(),
        }
    }

    /// What the objective is never below.
    pub fn least(&self) -> f64 {
        match self.violation {
            Some(_) => f64::NEG_INFINITY,
            None => self.problem.least(),
        }
    }

    pub fn evaluate(&self, design: &[f64]) -> Evaluation {
        let mut evaluation = problem::evaluate(self.problem, design);
        if let (Some(sizes), true) = (&self.violation, evaluation.is_defined()) {
            let scaled = evaluation.constraints.iter().zip(&sizes.constraints);
            evaluation.objectives = vec![largest(scaled.map(|(c, s)| c / s))];
            evaluation.constraints.clear();
        }
        evaluation
    }

    pub fn slopes(&self, design: &[f64]) -> Option<Slopes> {
        let slopes = problem::slopes(self.problem, design)?;
        let Some(sizes) = &self.violation else {
            return Some(slopes);
        };
        let own = slopes.constraints.into_iter().zip(&sizes.constraints);
        let pieces = own.flat_map(|(own, size)| {
            own.into_iter().map(move |piece| Piece {
                value: piece.value / size,
                slope: piece.slope.iter().map(|g| g / size).collect(),
            })
        });
        Some(Slopes {
            objectives: vec![pieces.collect()],
            constraints: Vec::new(),
        })
    }

    /// Constraints with their shares of the multipliers of the least violation at a design, which are those of its pieces in their order.
    pub fn conflict(&self, design: &[f64], shares: &[f64]) -> Vec<(usize, f64)> {
        let slopes = self.problem.slopes(design);
        let counts = slopes.map_or(Vec::new(), |s| s.constraints.iter().map(Vec::len).collect());
        let mut shares = shares.iter();
        let mut conflict = Vec::new();
        for (constraint, count) in counts.into_iter().enumerate() {
            let share: f64 = shares.by_ref().take(count).sum();
            if share > 0.0 {
                conflict.push((constraint, share));
            }
        }
        conflict
    }
}
