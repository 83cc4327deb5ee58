//! Which assembly modes a pose is in.

use crate::branch::Branch;
use crate::configuration::Configuration;
use crate::design::Design;
use crate::pose::Pose;
use crate::step::Step;

impl Design<f64> {
    /// The determinant of every step of the plan at a pose, with the sign of its assembly mode: 1 where a step has neither
    /// modes nor a determinant that vanishes, 0 where it has no value.
    ///
    /// `state` holds the pose with its inputs, and again when it is done; `near` are the bodies' angles to within half a
    /// turn, rad.
    pub fn determinants(
        &self,
        state: &mut Configuration<f64>,
        near: &[f64],
        size: f64,
    ) -> Vec<f64> {
        let plan = &self.mechanism.plan;
        let truth = state.poses.clone();
        let branch = Branch {
            guess: truth.clone(),
            near: near.to_vec(),
            ..Branch::neutral(&self.mechanism)
        };
        let off = |found: &Pose<f64>, wanted: &Pose<f64>| {
            ((found.x - wanted.x).abs() + (found.y - wanted.y).abs()) / size
                + (found.c - wanted.c).abs()
                + (found.s - wanted.s).abs()
        };
        let mut list = Vec::with_capacity(plan.steps.len());
        for (index, step) in plan.steps.iter().enumerate() {
            let bodies = || (plan.blocks[index].unknowns.iter()).map(|u| u.body().index());
            let mut best = (f64::INFINITY, 1.0);
            let trials: &[f64] = match step.has_modes() {
                true => &[1.0, -1.0],
                false => &[1.0],
            };
            for &sign in trials {
                plan.solve_step(index, sign, self, &branch, state);
                let gap: f64 = bodies().map(|b| off(&state.poses[b], &truth[b])).sum();
                if gap < best.0 {
                    best = (gap, state.determinants[index]);
                }
            }
            // The next steps build on the true pose.
            for body in bodies() {
                state.poses[body] = truth[body];
            }
            let relevant =
                step.has_modes() || matches!(step, Step::Newton { .. } | Step::Cross { .. });
            list.push(match (relevant, best.0.is_finite()) {
                (true, true) => best.1,
                (true, false) => 0.0,
                (false, _) => 1.0,
            });
        }
        list
    }

    /// The branch through a pose at these coordinates of the drives, SI; `near` are the bodies' angles to within half a
    /// turn, rad.
    pub fn branch_through(&self, poses: &[Pose<f64>], near: &[f64], coordinates: &[f64]) -> Branch {
        let mut state = Configuration::new(&self.mechanism);
        state.poses.copy_from_slice(poses);
        state.set_inputs(&self.mechanism, coordinates);
        let determinants = self.determinants(&mut state, near, self.size());
        Branch {
            signs: determinants.iter().map(|d| d.signum()).collect(),
            guess: poses.to_vec(),
            near: near.to_vec(),
        }
    }
}
