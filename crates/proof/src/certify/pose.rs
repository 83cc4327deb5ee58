//! One pose, proved: by the plan run on intervals, or next to a given one.

use kempe_mechanism::plan::Step;
use kempe_mechanism::pose::Pose;
use kempe_mechanism::structure::BodyId;
use kempe_number::{Interval, Number, math};

use super::{Certificate, Certifier, same_but};
use crate::krawczyk::{Given, enclose_block, middle_of};
use crate::not_proved::NotProved;

impl Certifier {
    /// The pose on the motion's branch for every path parameter in `p`, by the plan run on intervals.
    ///
    /// Its boxes grow with the width of `p`; for wide stretches [`Certifier::motion`] is made.
    pub fn pose(&mut self, p: Interval) -> Certificate {
        let outcome = self.run_plan(p);
        self.conclude(p, outcome)
    }

    /// The pose next to `poses` at the path parameter `p`, all bodies at once. What is proved to be unique is the pose
    /// in a box about it, not the branch; a pose that is not one is not proved.
    pub fn near(&mut self, p: f64, poses: &[Pose<f64>]) -> Certificate {
        let at = Interval::from_f64(p);
        self.wide.state.determinants.fill(Interval::EMPTY);
        let outcome = self.prepare(at).and_then(|()| {
            let near: Vec<f64> = poses.iter().map(|q| math::atan2(q.s, q.c)).collect();
            let turns = near.iter().zip(&self.plain.branch.near);
            let near: Vec<f64> = turns
                .map(|(a, b)| a + ((b - a) / std::f64::consts::TAU).round() * std::f64::consts::TAU)
                .collect();
            self.plain.branch.near = near;
            let before = middle_of(poses, &self.plain.branch.near);
            let mut middle = before.clone();
            let size = self.motion.size();
            let (inputs, near) = (&self.wide.state.inputs, &self.plain.branch.near);
            let given = Given::new(&self.design, inputs, near, size);
            self.system
                .enclose(&given, &mut middle, &mut self.wide.state.poses)?;
            if same_but(&[], &before, &middle, size) {
                Ok(())
            } else {
                Err(NotProved::NoPose)
            }
        });
        self.conclude(at, outcome)
    }

    fn run_plan(&mut self, p: Interval) -> Result<(), NotProved> {
        self.wide.state.determinants.fill(Interval::EMPTY);
        self.prepare(p)?;
        let motion = self.motion.clone();
        let mechanism = motion.mechanism();
        let plan = &mechanism.plan;
        let (branch, state) = (&self.plain.branch, &mut self.wide.state);
        for (index, step) in plan.steps.iter().enumerate() {
            if let Step::Newton { block } = step {
                let block = &plan.newton_blocks[*block];
                state.determinants[index] = enclose_block(block, &self.design, branch, state)?;
                continue;
            }
            plan.solve_step(index, branch.signs[index], &self.design, branch, state);
            let determinant = state.determinants[index];
            let mut bodies: Vec<BodyId> = plan.blocks[index]
                .unknowns
                .iter()
                .map(|u| u.body())
                .collect();
            bodies.dedup();
            let bounded = bodies.iter().all(|b| is_bounded(&state.poses[b.index()]));
            if determinant.is_empty() || determinant.contains_zero() || !bounded {
                return Err(NotProved::Modes {
                    step: index,
                    bodies,
                });
            }
        }
        Ok(())
    }

    /// Puts a certificate together.
    fn conclude(&self, at: Interval, outcome: Result<(), NotProved>) -> Certificate {
        let bodies = self.motion.mechanism().bodies;
        let nothing = Pose {
            x: Interval::EMPTY,
            y: Interval::EMPTY,
            c: Interval::EMPTY,
            s: Interval::EMPTY,
        };
        let unique = outcome.is_ok();
        let redundant = outcome.and_then(|()| self.check_redundant());
        let size = self.motion.size();
        let poses = if unique {
            self.wide.state.poses.clone()
        } else {
            vec![nothing; bodies]
        };
        let widest = poses.iter().map(|q| widest(q, size)).fold(0.0, math::max);
        Certificate {
            at,
            exists: redundant.is_ok(),
            unique,
            poses,
            determinants: self.wide.state.determinants.clone(),
            widest,
            reason: redundant.err(),
        }
    }
}

fn is_bounded(pose: &Pose<Interval>) -> bool {
    [pose.x, pose.y, pose.c, pose.s]
        .iter()
        .all(|v| v.is_finite() && v.mag() < f64::MAX)
}

fn widest(pose: &Pose<Interval>, size: f64) -> f64 {
    let length = math::max(pose.x.width(), pose.y.width()) / size;
    math::max(length, math::max(pose.c.width(), pose.s.width()))
}
