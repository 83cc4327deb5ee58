//! A local optimum, what it hangs on, and how it was met.

use crate::problem::{Evaluation, Scales};
use crate::progress::Ended;

/// What a local optimum hangs on: by how much the objective would fall if something were eased by one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Multipliers {
    /// The share of every piece of every objective; they sum to one.
    pub objectives: Vec<Vec<f64>>,
    /// Of every piece of every constraint.
    pub constraints: Vec<Vec<f64>>,
    /// Of the least and of the largest value of every variable.
    pub bounds: Vec<[f64; 2]>,
}

impl Multipliers {
    /// By how much the objective would fall for each unit that a constraint is eased: the sum over its pieces.
    pub fn cost(&self, constraint: usize) -> f64 {
        let pieces = self.constraints.get(constraint);
        pieces.map_or(0.0, |pieces| pieces.iter().sum())
    }
}

/// Where local minimisation ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Optimum {
    /// The design.
    pub design: Vec<f64>,
    /// What it is worth.
    pub evaluation: Evaluation,
    /// What it hangs on. Where [`Ended::Infeasible`], if what cannot be kept is eased by as much as it is missed.
    pub multipliers: Multipliers,
    /// By how much the objective falls for each unit by which one of these is eased alone: the multipliers, but where others would meet
    /// the conditions as well. What several hold, easing one of them brings nothing.
    pub eased: Multipliers,
    /// How far the first-order conditions (W. Karush 1939, H. W. Kuhn and A. W. Tucker 1951) are missed: the largest component of the
    /// Lagrangian's slope over the box's width, or the multipliers times what their pieces are below the largest, in the
    /// objective's scale. Where [`Ended::Infeasible`], those of the least violations.
    pub residual: f64,
    /// The largest violation of a constraint, in its scale.
    pub violation: f64,
    /// Where [`Ended::Infeasible`]: groups of constraints that cannot be kept together, each as small as it can be, with their shares of the multipliers of
    /// the least largest violation of the group, the largest first; those of the first group sum to one. What contradicts each other even where what is
    /// missed is eased so far follows, and so on: the others are kept, and the objective is the least that it then can be.
    pub conflicts: Vec<Vec<(usize, f64)>>,
    /// Where the edge of what can be evaluated holds the design: one just beyond it.
    pub beyond: Option<Vec<f64>>,
    /// The scales that residual and violation count in.
    pub scales: Scales,
    /// Steps taken.
    pub iterations: usize,
    /// Designs evaluated.
    pub evaluations: usize,
    /// Designs whose slopes were asked.
    pub slopes: usize,
    /// Why it ended.
    pub ended: Ended,
}

impl Optimum {
    /// The largest objective.
    pub fn objective(&self) -> f64 {
        self.evaluation.largest()
    }

    /// Nothing but a design, and what it is worth in these scales.
    pub(super) fn undefined(
        design: Vec<f64>,
        (evaluation, scales): (Evaluation, Scales),
        evaluations: usize,
    ) -> Self {
        let (violation, ended) = match evaluation.is_defined() {
            true => (evaluation.violation(&scales), Ended::Slopeless),
            false => (f64::INFINITY, Ended::Undefined),
        };
        Self {
            design,
            evaluation,
            multipliers: Multipliers::default(),
            eased: Multipliers::default(),
            residual: f64::INFINITY,
            violation,
            conflicts: Vec::new(),
            beyond: None,
            scales,
            iterations: 0,
            evaluations,
            slopes: 0,
            ended,
        }
    }
}
