//! The plain pose anywhere on a motion.

use kempe_mechanism::evidence::is_finite;
use kempe_mechanism::pose::Pose;
use kempe_mechanism::{Branch, Design};

use super::{Demand, Motion, Solver};
use crate::assemble::{Assemblies, Assembly};
use crate::bridge::{SideSeries, across};
use crate::drive_path::DrivePath;

/// Where the bodies are at a place of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Placed {
    /// Poses of the bodies.
    pub poses: Vec<Pose<f64>>,
    /// Angle of every body to within half a turn, rad, the turns counted along the motion.
    pub near: Vec<f64>,
}

impl Demand {
    /// A motion on from a pose at `start`, over a range that holds it: no assembly is searched for, the branch is the pose's.
    pub fn from_pose(
        design: &Design<f64>,
        path: DrivePath,
        range: (f64, f64),
        start: f64,
        placed: &Placed,
    ) -> Self {
        let assembly = Assembly {
            branch: Branch {
                guess: placed.poses.clone(),
                near: placed.near.clone(),
                ..Branch::neutral(&design.mechanism)
            },
            poses: placed.poses.clone(),
            distance: 0.0,
            turns: design.geometry.turns.clone(),
        };
        Self {
            path,
            range,
            start,
            assemblies: Some(Assemblies {
                list: vec![assembly],
                ..Assemblies::default()
            }),
        }
    }
}

impl Motion {
    /// The pose at a path parameter, as rows have it: from the trace at a limit, joined from both sides at a change point, and
    /// solved by itself anywhere else. `None` beyond the motion and where nothing closes. `solver` is storage.
    pub fn placed(&self, p: f64, solver: &mut Solver<f64>) -> Option<Placed> {
        if !self.reaches(p) {
            return None;
        }
        if let Some(index) = self.limit_at(p) {
            let (_, poses, near) = self.node(index);
            return Some(Placed { poses, near });
        }
        let poses: Vec<Pose<f64>> = match self.bridge(p) {
            Some(event) => {
                self.branch_at(p, &mut solver.branch);
                let (design, mut sides) = (self.design_on::<SideSeries>(), self.solver());
                let joined = across::<1>(self, &design, event, p, &mut sides);
                joined.iter().map(Pose::value).collect()
            }
            None => {
                self.solve(&self.design, p, solver);
                solver.state.poses.clone()
            }
        };
        let near = solver.branch.near.clone();
        poses
            .iter()
            .all(is_finite)
            .then_some(Placed { poses, near })
    }
}
