//! The branch of a motion anywhere on it: assembly modes, guesses and turn counts from the trace.

use kempe_mechanism::Branch;
use kempe_mechanism::plan::Step;
use kempe_mechanism::pose::Pose;

use super::Motion;
use crate::trace::{Cubic, interval};

impl Motion {
    /// Fills the modes of the branch for a path parameter; the node before it.
    fn modes_at(&self, p: f64, branch: &mut Branch) -> usize {
        let node = interval(&self.parameters, p);
        let patch = self
            .patches
            .partition_point(|patch| patch.from <= node)
            .max(1)
            - 1;
        if let Some(patch) = self.patches.get(patch) {
            branch.signs.clone_from(&patch.signs);
        }
        node
    }

    /// Fills modes and turn counts of the branch for a path parameter, its guesses only where a plan [goes by
    /// them](kempe_mechanism::plan::Step::needs_guess): all that a solution takes, for less.
    pub fn branch_to_solve_at(&self, p: f64, branch: &mut Branch) {
        if (self.mechanism().plan.steps.iter()).any(Step::needs_guess) {
            return self.branch_at(p, branch);
        }
        let node = self.modes_at(p, branch);
        let (Some(from), Some(to)) = (self.nodes.get(node), self.nodes.get(node + 1)) else {
            return;
        };
        let (begin, end) = (self.parameters[node], self.parameters[node + 1]);
        let part = match end > begin {
            true => (p - begin) / (end - begin),
            false => 0.0,
        };
        for body in 1..self.mechanism().bodies {
            let [from, to] = [from, to].map(|node| node.z[3 * (body - 1) + 2]);
            branch.near[body] = from + part * (to - from);
        }
    }

    /// Fills the branch for a path parameter: modes, guesses and turn counts.
    pub fn branch_at(&self, p: f64, branch: &mut Branch) {
        let node = self.modes_at(p, branch);
        let (Some(from), Some(to)) = (self.nodes.get(node), self.nodes.get(node + 1)) else {
            return;
        };
        let cubic = Cubic::new(from, to);
        let place = cubic.at(cubic.part_where(from.z.len() - 1, p / self.scale));
        for body in 1..self.mechanism().bodies {
            let [x, y, angle] = [0, 1, 2].map(|k| place.part(3 * (body - 1) + k));
            branch.guess[body] = Pose::from_angle(x * self.size, y * self.size, angle);
            branch.near[body] = angle;
        }
    }

    /// The stretches on which every assembly mode stays the same: where each begins, and the modes; rising.
    pub fn stretches(&self) -> impl Iterator<Item = (f64, &[f64])> {
        (self.patches.iter()).map(|patch| (self.parameters[patch.from], &patch.signs[..]))
    }
}
