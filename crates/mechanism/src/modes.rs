//! Which assembly modes a pose is in.

use crate::branch::Branch;
use crate::configuration::Configuration;
use crate::design::Design;
use crate::pose::Pose;
use crate::step::Step;

/// A step that does not come this near (in mechanism sizes and rad) to a pose does not have it: where a limit makes Newton's method
/// go astray, it finds another.
const SAME_POSE: f64 = 1e-3;

impl Step {
    /// Whether the determinant tells where assemblies meet: other steps have none, or none that vanishes.
    pub fn tells_modes(&self) -> bool {
        self.has_modes() || matches!(self.closed(), Step::Newton { .. } | Step::Cross { .. })
    }
}

impl Design<f64> {
    /// Gives a branch the modes in which every step of the plan comes nearest to the branch's guess, the steps before it being as
    /// guessed; `state` holds the inputs, and the guess when it is done. Fills the determinants there, with the signs of the modes:
    /// 1 where a step has neither modes nor a determinant that vanishes, 0 where it has no value. Returns how far a step is from
    /// the guess, the farthest one (in mechanism sizes and rad).
    pub fn find_modes(
        &self,
        state: &mut Configuration<f64>,
        branch: &mut Branch,
        size: f64,
        determinants: &mut Vec<f64>,
    ) -> f64 {
        let plan = &self.mechanism.plan;
        state.poses.copy_from_slice(&branch.guess);
        determinants.clear();
        let mut farthest = 0.0_f64;
        for (index, step) in plan.steps.iter().enumerate() {
            let bodies = || (plan.blocks[index].unknowns.iter()).map(|u| u.body().index());
            let mut best = (f64::INFINITY, 1.0, 1.0);
            let trials: &[f64] = match step.has_modes() {
                true => &[1.0, -1.0],
                false => &[1.0],
            };
            for &sign in trials {
                plan.solve_step(index, sign, self, branch, state);
                let gap: f64 = bodies()
                    .map(|b| state.poses[b].apart(&branch.guess[b], size))
                    .sum();
                if gap < best.0 {
                    best = (gap, state.determinants[index], sign);
                }
            }
            // The next steps build on the guess.
            for body in bodies() {
                state.poses[body] = branch.guess[body];
            }
            let (gap, determinant, sign) = best;
            branch.signs[index] = sign;
            farthest = farthest.max(gap);
            determinants.push(match (step.tells_modes(), gap <= SAME_POSE) {
                (true, true) => determinant,
                (true, false) => 0.0,
                (false, _) => 1.0,
            });
        }
        farthest
    }

    /// The branch through a pose at these coordinates of the drives, SI; `near` are the bodies' angles to within half a
    /// turn, rad.
    pub fn branch_through(&self, poses: &[Pose<f64>], near: &[f64], coordinates: &[f64]) -> Branch {
        let mut state = Configuration::new(&self.mechanism);
        state.set_inputs(&self.mechanism, coordinates);
        let mut branch = Branch {
            guess: poses.to_vec(),
            near: near.to_vec(),
            ..Branch::neutral(&self.mechanism)
        };
        self.find_modes(&mut state, &mut branch, self.size(), &mut Vec::new());
        branch
    }
}
