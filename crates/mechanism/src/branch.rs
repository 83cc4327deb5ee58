//! Which of its assemblies a mechanism is in.

use crate::Mechanism;
use crate::pose::Pose;

/// Which of the assemblies: the sign of every closed form and a place to start for every Newton block.
#[derive(Clone, Debug, PartialEq)]
pub struct Branch {
    /// Assembly mode of every step; 0 where there is no choice.
    pub signs: Vec<f64>,
    /// A pose near the one wanted (only bodies of Newton blocks need one).
    pub guess: Vec<Pose<f64>>,
    /// Angle of every body to within half a turn, rad.
    pub near: Vec<f64>,
}

impl Branch {
    /// A branch with every mode at +1 and every guess at the frame's pose.
    pub fn neutral(mechanism: &Mechanism) -> Self {
        let plan = &mechanism.plan;
        Self {
            signs: vec![1.0; plan.steps.len()],
            guess: vec![Pose::identity(); mechanism.bodies],
            near: vec![0.0; mechanism.bodies],
        }
    }
}
