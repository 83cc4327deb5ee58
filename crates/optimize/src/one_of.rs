//! A problem with one of its objectives alone.

use std::sync::{Mutex, PoisonError};

use crate::problem::{Candidate, Evaluation, Problem, Scales, Slopes};
use crate::workers::Workers;

/// One objective of a problem and all constraints.
pub(crate) struct OneOf<'p> {
    problem: &'p dyn Problem,
    objective: usize,
    /// What was looked at, with all objectives.
    looked_at: Mutex<Vec<Candidate>>,
}

impl<'p> OneOf<'p> {
    pub fn new(problem: &'p dyn Problem, objective: usize) -> Self {
        Self {
            problem,
            objective,
            looked_at: Mutex::default(),
        }
    }

    /// A design with the one objective alone.
    pub fn of(&self, candidate: &Candidate) -> Candidate {
        Candidate {
            design: candidate.design.clone(),
            evaluation: self.told(candidate.evaluation.clone()),
        }
    }

    /// The designs that were looked at, [nearly](Problem::nearly), with all objectives.
    pub fn looked_at(self) -> Vec<Candidate> {
        let all = self.looked_at.into_inner();
        all.unwrap_or_else(PoisonError::into_inner)
    }

    fn told(&self, mut evaluation: Evaluation) -> Evaluation {
        let own = evaluation.objectives.get(self.objective).copied();
        evaluation.objectives = own.into_iter().collect();
        evaluation
    }
}

impl Problem for OneOf<'_> {
    fn bounds(&self) -> &[[f64; 2]] {
        self.problem.bounds()
    }

    fn constraints(&self) -> usize {
        self.problem.constraints()
    }

    fn scales(&self) -> Option<Scales> {
        let mut scales = self.problem.scales()?;
        scales.objectives = vec![*scales.objectives.get(self.objective)?];
        Some(scales)
    }

    fn least_of(&self, constraint: usize) -> f64 {
        self.problem.least_of(constraint)
    }

    fn evaluate(&self, design: &[f64]) -> Evaluation {
        self.told(self.problem.evaluate(design))
    }

    fn nearly(&self, designs: &[Vec<f64>], workers: &dyn Workers) -> Vec<Evaluation> {
        let all = self.problem.nearly(designs, workers);
        let both = designs.iter().cloned().zip(all.iter().cloned());
        let looked_at = both.map(|(design, evaluation)| Candidate { design, evaluation });
        let known = self.looked_at.lock();
        known
            .unwrap_or_else(PoisonError::into_inner)
            .extend(looked_at);
        all.into_iter().map(|it| self.told(it)).collect()
    }

    fn exactly(&self, design: &[f64]) -> Option<Evaluation> {
        self.problem.exactly(design).map(|it| self.told(it))
    }

    fn slopes(&self, design: &[f64]) -> Option<Slopes> {
        let mut slopes = self.problem.slopes(design)?;
        if self.objective >= slopes.objectives.len() {
            return None;
        }
        slopes.objectives = vec![slopes.objectives.swap_remove(self.objective)];
        Some(slopes)
    }
}
