//! What a trace stores of the plan that leads it: the node last reached, and the pose that is tried.

use kempe_mechanism::blocks::Unknown;
use kempe_mechanism::plan::{Plan, Step};
use kempe_mechanism::pose::Pose;
use kempe_mechanism::{Branch, Configuration, Design};
use kempe_number::Jet;

use super::cubic::Cubic;
use super::node::dot;

/// Series in the scaled path parameter, of which two coefficients count; of a length that is compiled already.
pub(super) type Series = Jet<f64, 3>;

/// Storage for what a trace asks of the plan.
pub(super) struct PlanSteps {
    /// Whether the plan solves for all that is asked of the poses: not with redundant constraints.
    pub whole: bool,
    /// Whether a step looks at the branch's guesses.
    pub guided: bool,
    pub branch: Branch,
    pub plain: Configuration<f64>,
    pub rich: Option<(Design<Series>, Configuration<Series>)>,
    pub inputs: Vec<Series>,
    /// The node last reached, with the modes and determinants there.
    pub at: Vec<f64>,
    pub signs: Vec<f64>,
    pub determinants: Vec<f64>,
    /// Those of a pose that is tried.
    pub tried: Vec<f64>,
    /// The largest that every determinant was at a node.
    pub largest: Vec<f64>,
    /// Modes at the end of the step that is tried.
    pub landed: Vec<f64>,
    /// How far the plan's pose lies from that node.
    pub apart: f64,
    /// Scaled unknowns expected, and how far the plan's are from them.
    pub near: Vec<f64>,
    pub gap: Vec<f64>,
}

impl PlanSteps {
    /// Storage for a design.
    pub fn new(design: &Design<f64>) -> Self {
        let mechanism = &*design.mechanism;
        let plan = &mechanism.plan;
        Self {
            whole: plan.decomposition.surplus.is_empty(),
            guided: plan.steps.iter().any(Step::needs_guess),
            branch: Branch::neutral(mechanism),
            plain: Configuration::new(mechanism),
            rich: None,
            inputs: Vec::new(),
            at: Vec::new(),
            signs: Vec::new(),
            determinants: Vec::new(),
            tried: Vec::new(),
            largest: vec![0.0; plan.steps.len()],
            landed: Vec::new(),
            apart: 0.0,
            near: Vec::new(),
            gap: Vec::new(),
        }
    }

    /// Length of the gap across a unit vector.
    pub fn gap_across(&self, direction: &[f64]) -> f64 {
        let along = dot(&self.gap, direction);
        (dot(&self.gap, &self.gap) - along * along).max(0.0).sqrt()
    }

    /// Length of the gap across the chord of a step.
    pub fn gap_beside(&self, step: &Cubic<'_>) -> f64 {
        let along: f64 = (self.gap.iter().zip(step.chord()))
            .map(|(x, y)| x * y)
            .sum();
        (dot(&self.gap, &self.gap) - along * along).max(0.0).sqrt()
    }

    /// Takes bodies' poses, in mechanisms of this size, for the unknowns of the plan, as scaled unknowns in place of those expected,
    /// and notes how far they lie from these.
    pub fn take(&mut self, plan: &Plan, size: f64, pose: impl Fn(&Self, usize) -> Pose<f64>) {
        self.gap.clear();
        self.gap.resize(self.near.len(), 0.0);
        for unknown in plan.blocks.iter().flat_map(|block| &block.unknowns) {
            let body = unknown.body().index();
            let (pose, first) = (pose(self, body), 3 * (body - 1));
            match unknown {
                Unknown::Angle(_) => {
                    let near = self.near[first + 2];
                    self.put(first + 2, pose.angle_near(near));
                }
                Unknown::Place(_) => {
                    self.put(first, pose.x / size);
                    self.put(first + 1, pose.y / size);
                }
            }
        }
    }

    /// Takes the determinants into account of the node last reached.
    pub fn note_largest(&mut self) {
        for (largest, now) in self.largest.iter_mut().zip(&self.determinants) {
            *largest = largest.max(now.abs());
        }
    }

    pub fn put(&mut self, index: usize, value: f64) {
        self.gap[index] = value - self.near[index];
        self.near[index] = value;
    }
}
