//! Newton blocks on intervals.

use kempe_number::Interval;

use crate::blocks::Unknown;
use crate::branch::Branch;
use crate::configuration::Configuration;
use crate::design::Design;
use crate::plan::NewtonBlock;
use crate::plan_number::PlanNumber;

impl PlanNumber for Interval {
    /// Iterations prove nothing: the block's poses and its determinant become empty. Whoever runs a plan on intervals
    /// encloses its Newton blocks by a proof of their own, as `kempe-proof` does.
    fn solve_newton(
        block: &NewtonBlock,
        _: &Design<Self>,
        _: &Branch,
        state: &mut Configuration<Self>,
    ) -> Self {
        for unknown in &block.unknowns {
            let pose = &mut state.poses[unknown.body().index()];
            match unknown {
                Unknown::Place(_) => (pose.x, pose.y) = (Self::EMPTY, Self::EMPTY),
                Unknown::Angle(_) => (pose.c, pose.s) = (Self::EMPTY, Self::EMPTY),
            }
        }
        Self::EMPTY
    }
}
