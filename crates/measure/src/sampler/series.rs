//! The pose of a row as series: anywhere, at a limit, and across a change point.

use kempe_mechanism::evidence::is_finite;
use kempe_mechanism::pose::Pose;
use kempe_motion::bridge::across;
use kempe_motion::events::Event;
use kempe_motion::motion::Solver;

use super::Sampler;
use crate::force_source::ForceSource;
use crate::measure::{Series, only_value};

impl<F: ForceSource> Sampler<F> {
    /// Solves the series along the path at `p` and along the drives that measures ask for. False without a pose.
    pub(super) fn solve(&mut self, p: f64) -> bool {
        let motion = &*self.motion.clone();
        if let Some(index) = motion.limit_at(p) {
            self.solve_at_limit(p, index);
            return true;
        }
        match motion.bridge(p) {
            Some(event) => self.solve_across(p, event),
            None => motion.solve(&self.series_design, Series::variable(p), &mut self.series),
        }
        if !self
            .series
            .state
            .poses
            .iter()
            .all(|pose| is_finite(&pose.value()))
        {
            return false;
        }
        for index in 0..self.drives.len() {
            if self.drives[index].is_none() {
                continue;
            }
            let mut solver: Solver<Series<f64>> = motion.solver();
            motion.branch_at(p, &mut solver.branch);
            motion
                .path
                .coordinates(Series::constant(p), &mut solver.coordinates);
            solver.coordinates[index] = Series::variable(solver.coordinates[index].coefficient(0));
            solver.run(motion, &self.series_design);
            self.drives[index] = Some(solver.state.poses);
        }
        true
    }

    /// Takes the pose of the trace at a limit of the drive; rates are infinite there, or not defined.
    fn solve_at_limit(&mut self, p: f64, index: usize) {
        let motion = &*self.motion.clone();
        let (_, poses, near) = motion.node(index);
        motion
            .path
            .coordinates(Series::variable(p), &mut self.series.coordinates);
        for (series, pose) in self.series.state.poses.iter_mut().zip(&poses).skip(1) {
            *series = Pose {
                x: only_value(pose.x),
                y: only_value(pose.y),
                c: only_value(pose.c),
                s: only_value(pose.s),
            };
        }
        self.series.branch.near = near;
        for drive in self.drives.iter_mut().flatten() {
            drive.clone_from(&self.series.state.poses);
        }
    }

    /// Joins the series on both sides of a change point.
    fn solve_across(&mut self, p: f64, event: &Event) {
        let motion = &*self.motion.clone();
        motion.branch_at(p, &mut self.series.branch);
        motion
            .path
            .coordinates(Series::variable(p), &mut self.series.coordinates);
        self.series.state.poses = across(motion, &self.side_design, event, p, &mut self.side);
    }
}
