//! How far a local optimum is sought, and how well it is to be met.

use crate::problem::Scales;

/// Limits and tolerances.
#[derive(Clone, Debug, PartialEq)]
pub struct SqpOptions {
    /// Steps at most.
    pub iterations: usize,
    /// Designs evaluated at most, besides those whose slopes are asked.
    pub evaluations: usize,
    /// The largest residual of the first-order conditions, in the objective's scale for the whole width of the box.
    pub optimality: f64,
    /// The same, where rounding keeps steps from lessening it.
    pub settled: f64,
    /// The largest violation of a constraint, in its scale.
    pub feasibility: f64,
    /// Where the problem names no scales, they are the larger of value and slope (over the box's width) at the start, and not less than
    /// these.
    pub least: Option<Scales>,
    /// The scales themselves, where the problem names none.
    pub scales: Option<Scales>,
    /// What functions typically come to in the box, if it is known: where those of the start are far above that, as beside a pole, others are taken on the
    /// way, not less than this. What it does not know keeps its scale.
    pub typical: Option<Scales>,
}

impl Default for SqpOptions {
    fn default() -> Self {
        Self {
            iterations: 300,
            evaluations: 3000,
            optimality: 1e-8,
            settled: 1e-6,
            feasibility: 1e-9,
            least: None,
            scales: None,
            typical: None,
        }
    }
}
