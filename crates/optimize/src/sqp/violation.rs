//! What a descent minimises: a problem, or the largest violation of its constraints alone.

use crate::problem::{self, Evaluation, Piece, Problem, Scales, Slopes, largest};

use super::local::Sizes;
use super::optimum::Multipliers;

/// A constraint with less than this share in what keeps the violation from being less has none.
const SHARE: f64 = 1e-6;

/// A problem as a descent sees it.
#[derive(Clone)]
pub(super) struct View<'a> {
    pub problem: &'a dyn Problem,
    /// Where the violation alone is minimised, what the constraints count in: all of them that are not eased, each by its scale, are pieces of one
    /// objective.
    pub violation: Option<Sizes>,
    /// By how much constraints are eased that cannot be kept.
    pub eased: Vec<Option<f64>>,
    /// Constraints that are not looked at where the violation alone is minimised.
    pub left_out: Vec<usize>,
}

impl View<'_> {
    /// How many objectives and constraints there are.
    pub fn functions(&self) -> [usize; 2] {
        match self.violation {
            Some(_) => [1, self.parted(0..self.problem.constraints()).1.len()],
            None => [self.problem.objectives(), self.problem.constraints()],
        }
    }

    pub fn scales(&self) -> Option<Scales> {
        match &self.violation {
            Some(Sizes { constraints, .. }) => Some(Scales {
                objectives: vec![1.0],
                constraints: self.parted(constraints.iter().copied()).1,
            }),
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
        if !evaluation.is_defined() {
            return evaluation;
        }
        for (constraint, eased) in evaluation.constraints.iter_mut().zip(&self.eased) {
            *constraint -= eased.unwrap_or(0.0);
        }
        if let Some(sizes) = &self.violation {
            let scaled = evaluation.constraints.iter().zip(&sizes.constraints);
            let (own, _) = self.parted(scaled.map(|(c, s)| c / s));
            evaluation.objectives = vec![largest(own.into_iter())];
            evaluation.constraints = self.parted(evaluation.constraints.into_iter()).1;
        }
        evaluation
    }

    pub fn slopes(&self, design: &[f64]) -> Option<Slopes> {
        let mut slopes = problem::slopes(self.problem, design)?;
        for (pieces, eased) in slopes.constraints.iter_mut().zip(&self.eased) {
            let eased = eased.unwrap_or(0.0);
            pieces.iter_mut().for_each(|piece| piece.value -= eased);
        }
        let Some(sizes) = &self.violation else {
            return Some(slopes);
        };
        let both = slopes.constraints.into_iter().zip(&sizes.constraints);
        let (own, eased) = self.parted(both);
        let pieces = own.into_iter().flat_map(|(own, size)| {
            own.into_iter().map(move |piece| Piece {
                value: piece.value / size,
                slope: piece.slope.iter().map(|g| g / size).collect(),
            })
        });
        Some(Slopes {
            objectives: vec![pieces.collect()],
            constraints: eased.into_iter().map(|(eased, _)| eased).collect(),
        })
    }

    /// What the constraints are where none is eased.
    pub fn not_eased(&self, mut evaluation: Evaluation) -> Evaluation {
        for (constraint, eased) in evaluation.constraints.iter_mut().zip(&self.eased) {
            *constraint += eased.unwrap_or(0.0);
        }
        evaluation
    }

    /// What belongs to the constraints that are not eased, and to those that are; nothing of those that are left out.
    fn parted<T>(&self, all: impl Iterator<Item = T>) -> (Vec<T>, Vec<T>) {
        let (mut own, mut eased) = (Vec::new(), Vec::new());
        for (k, one) in all.enumerate() {
            match self.is_eased(k) {
                _ if self.left_out.contains(&k) => {}
                true => eased.push(one),
                false => own.push(one),
            }
        }
        (own, eased)
    }

    pub fn is_eased(&self, constraint: usize) -> bool {
        self.eased.get(constraint).is_some_and(Option::is_some)
    }

    /// Constraints with their shares of the multipliers of the least violation at a design, the largest first: those of its pieces in their order, and of what is
    /// eased.
    pub fn conflict(&self, design: &[f64], multipliers: &Multipliers) -> Vec<(usize, f64)> {
        let Some(sizes) = &self.violation else {
            return Vec::new();
        };
        let slopes = self.problem.slopes(design);
        let counts = slopes.map_or(Vec::new(), |s| s.constraints.iter().map(Vec::len).collect());
        let mut shares = multipliers.objectives.iter().flatten();
        let mut eased = 0..;
        let mut conflict: Vec<(usize, f64)> = (counts.into_iter().enumerate())
            .filter(|(constraint, _)| !self.left_out.contains(constraint))
            .map(|(constraint, count)| {
                let share = match self.is_eased(constraint) {
                    true => {
                        let own = eased.next().map_or(0.0, |k| multipliers.cost(k));
                        own * sizes.constraints[constraint]
                    }
                    false => shares.by_ref().take(count).sum(),
                };
                (constraint, share)
            })
            .filter(|(_, share)| *share > SHARE)
            .collect();
        conflict.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        conflict
    }
}
