//! What is optimised, as the methods see it: what a design is worth and its derivatives, looked up where that was asked before.

use std::sync::atomic::Ordering;

use kempe_optimize::{Evaluation, Piece, Problem, Slopes, Workers, each};

use super::designs::Designs;
use super::fit::{Pairing, sum};
use super::journal::SUMS;
use super::pieces::{Wanted, pieces};
use crate::quantity::Quantity;

impl Designs<'_, '_> {
    /// What parameters are worth, SI, as far as it was not asked before.
    fn evaluate_values(&self, values: &[f64]) -> Evaluation {
        let told = (self.journal).evaluation(SUMS, values, || self.look(values));
        self.heard(values, told)
    }

    /// Takes up what parameters are worth.
    fn heard(&self, values: &[f64], (evaluation, why): (Evaluation, Option<String>)) -> Evaluation {
        if self.bench.watch().stops() {
            return Evaluation::lacking(f64::INFINITY);
        }
        match (why, evaluation.objectives.as_slice()) {
            (Some(why), _) => self.refuse(values, evaluation.lack, &why),
            (None, goals) => self.take_up(goals),
        }
        evaluation
    }

    /// Pieces of some of what is wanted at a design, with derivatives to the parameters: exact where there are such.
    fn pieces(&self, wanted: &[Wanted], values: &[f64]) -> Option<Vec<Vec<Piece>>> {
        let differences = |quantities: &[&Quantity]| self.differences(values, quantities);
        pieces(self.bench, wanted, values, &differences).ok()
    }

    /// Pieces of what must be kept beside a fit, with derivatives to the parameters.
    pub fn limits(&self, values: &[f64]) -> Option<Vec<Vec<Piece>>> {
        match self.aims.wanted.get(self.aims.goals..) {
            Some(limits) if !limits.is_empty() => self.pieces(limits, values),
            _ => Some(Vec::new()),
        }
    }

    /// Pieces with derivatives to the variables, exact where there are such.
    fn exact(&self, values: &[f64]) -> Option<Vec<Vec<Piece>>> {
        let mut all = match &self.fit {
            None => self.pieces(&self.aims.wanted, values)?,
            Some(_) => {
                let residuals = self.residuals(values, Pairing::Asked)?;
                [vec![vec![sum(&residuals)]], self.limits(values)?].concat()
            }
        };
        let growth = self.growth(values);
        for piece in all.iter_mut().flatten() {
            let slope = piece.slope.iter_mut().zip(&growth);
            slope.for_each(|(d, growth)| *d *= growth);
        }
        Some(all)
    }
}

impl Problem for Designs<'_, '_> {
    fn bounds(&self) -> &[[f64; 2]] {
        &self.bounds
    }

    fn objectives(&self) -> usize {
        self.aims.goals
    }

    fn constraints(&self) -> usize {
        self.aims.wanted.len() - self.aims.goals
    }

    fn least(&self) -> f64 {
        self.least
    }

    fn least_of(&self, constraint: usize) -> f64 {
        self.leasts[constraint]
    }

    fn evaluate(&self, design: &[f64]) -> Evaluation {
        self.asked.fetch_add(1, Ordering::Relaxed);
        self.evaluate_values(&self.values(design))
    }

    fn exactly(&self, design: &[f64]) -> Option<Evaluation> {
        let several = self.several.is_some();
        several.then(|| self.evaluate_values(&self.values(design)))
    }

    fn nearly(&self, designs: &[Vec<f64>], workers: &dyn Workers) -> Vec<Evaluation> {
        self.asked.fetch_add(designs.len(), Ordering::Relaxed);
        let values: Vec<Vec<f64>> = designs.iter().map(|design| self.values(design)).collect();
        let told = match &self.several {
            Some(several) => several.numbers((self.bench, &self.aims), &values, workers),
            None => vec![None; values.len()],
        };
        let all = values.iter().zip(&told).collect();
        each(
            workers,
            all,
            |(values, told): (&Vec<f64>, &Option<_>)| match told {
                Some(numbers) => self.heard(values, self.aims.worth(numbers)),
                None => self.evaluate_values(values),
            },
        )
    }

    fn slopes(&self, design: &[f64]) -> Option<Slopes> {
        self.sloped.fetch_add(1, Ordering::Relaxed);
        let values = self.values(design);
        if self.differences {
            let moved = self.bounds.iter().filter(|[low, high]| high > low);
            self.asked.fetch_add(2 * moved.count(), Ordering::Relaxed);
        }
        self.journal.slopes(SUMS, &values, || {
            let mut objectives = match self.differences {
                true => self.by_differences(design)?,
                false => self.exact(&values)?,
            };
            let constraints = objectives.split_off(self.aims.goals);
            Some(Slopes {
                objectives,
                constraints,
            })
        })
    }
}
