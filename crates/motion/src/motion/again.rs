//! The motion of a design much like one whose motion is known: step by step over the known nodes, by the plan.
//!
//! Where nothing was met on the known motion, its nodes tell how long steps may be. Each is taken by the plan and held to all that
//! holds the steps of a trace; so is the start. Where one of them does not hold, or the motion meets anything, it is traced as
//! any other.

use std::sync::Arc;

use kempe_mechanism::Design;

use super::drawn::elsewhere;
use super::follow::{STANDING, runs_away};
use super::{Demand, EndReason, Motion, MotionError, Patch};
use crate::assemble::{Assemblies, Earlier, Like, find_assemblies_after};
use crate::drive_path::DrivePath;
use crate::progress::{Done, Progress, Stage};
use crate::trace::{Follower, Node, Path, is_steady};

/// The shortest part of the way to the next known node that is gone in one step.
const SHORTEST_PART: f64 = 0.25;
/// How many times as many nodes as a trace needed a motion may come to have; then it is traced anew.
const MOST_NODES: usize = 2;

/// What says how a design is put together that is much like one whose motion is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PutTogether {
    /// The hints of the file: as by itself.
    ByHints,
    /// The hints; but whole turns of links, which wheels and racks tell apart, are counted from where they are on the known motion.
    WithItsTurns,
    /// The pose in which the known motion starts, in the stead of `near` hints: the same assembly as dimensions change a little.
    LikeIt,
}

impl Motion {
    /// The motion of a design much like this one's, such as the same mechanism after a dimension changed a little. It is the motion
    /// that [`Motion::with_progress`] finds, and it is found sooner: over the nodes of this one where nothing is met; and where blocks
    /// have no closed form their solutions are corrected from those known, which proves them complete as long as each leads to
    /// another.
    ///
    /// # Errors
    /// As [`Motion::with_progress`].
    pub fn again(
        &self,
        design: &Design<f64>,
        progress: &mut dyn Progress,
    ) -> Result<Arc<Self>, MotionError> {
        self.again_as(design, PutTogether::ByHints, progress)
    }

    /// As [`Motion::again`], put together as told; by its hints alone where this motion starts elsewhere than in the pose that was
    /// chosen, or a drawing tells of another place.
    ///
    /// # Errors
    /// As [`Motion::with_progress`].
    pub fn again_as(
        &self,
        design: &Design<f64>,
        put_together: PutTogether,
        progress: &mut dyn Progress,
    ) -> Result<Arc<Self>, MotionError> {
        let mut demand = Self::demand(design);
        let like = self.assemblies.list.first().map(|assembly| Like {
            design: &self.design,
            assembly,
            nearest: put_together == PutTogether::LikeIt,
        });
        let may_be_like = put_together != PutTogether::ByHints
            && Arc::ptr_eq(self.mechanism(), &design.mechanism)
            && self.anchor == self.start
            && elsewhere(design).is_empty();
        let earlier = Earlier {
            paths: &self.assemblies.paths,
            like: like.filter(|_| may_be_like),
        };
        if !self.leads(design, &demand) {
            return Self::along_after(design, demand, earlier, progress).map(Arc::new);
        }
        Self::possible(design)?;
        let mut coordinates = vec![0.0; design.mechanism.model.drives.len()];
        demand.path.coordinates(demand.start, &mut coordinates);
        let assemblies = find_assemblies_after(design, &coordinates, earlier, progress).ok_or(
            MotionError::Stopped {
                stage: Stage::Assembling,
            },
        )?;
        match self.over_nodes(design, demand, assemblies, progress)? {
            Led::Over(motion) => Ok(Arc::new(*motion)),
            Led::Astray(rest, assemblies) => {
                demand = *rest;
                demand.assemblies = Some(assemblies);
                Self::along_after(design, demand, earlier, progress).map(Arc::new)
            }
        }
    }

    /// Whether the nodes of this motion may lead over that of a design: where it covers all that is demanded of it from its start on
    /// and meets nothing there, and the same is demanded.
    fn leads(&self, design: &Design<f64>, demand: &Demand) -> bool {
        let same_path = match (&self.path, &demand.path) {
            (
                DrivePath::Coordinate { drive, held, .. },
                DrivePath::Coordinate {
                    drive: other,
                    held: there,
                    ..
                },
            ) => drive == other && held == there,
            _ => false,
        };
        same_path
            && Arc::ptr_eq(self.mechanism(), &design.mechanism)
            && elsewhere(design).is_empty()
            && self.places.is_empty()
            && self.patches.len() == 1
            && self.nodes.len() <= MOST_NODES * self.traced
            && self.ends == (EndReason::Covered, EndReason::Covered)
            && self.anchor == self.start
            && (self.start, self.demanded) == (demand.start, demand.range)
    }

    /// The motion over this one's nodes.
    fn over_nodes(
        &self,
        design: &Design<f64>,
        demand: Demand,
        assemblies: Assemblies,
        progress: &mut dyn Progress,
    ) -> Result<Led, MotionError> {
        let Some(chosen) = assemblies.list.first() else {
            return Ok(Led::Astray(Box::new(demand), assemblies));
        };
        let design = chosen.count_in(design);
        let mut follower = Follower::new(&design, &demand.path);
        let z = follower.scaled(&chosen.poses, &chosen.branch.near, self.anchor);
        let nodes = self.nodes_of(&mut follower, &z, demand.path.scale(), progress)?;
        let Some(nodes) = nodes else {
            return Ok(Led::Astray(Box::new(demand), assemblies));
        };
        let parameters = nodes.iter().map(|n| follower.parameter(&n.z)).collect();
        let Demand {
            path, range, start, ..
        } = demand;
        let signs = nodes[0].determinants.iter().map(|d| d.signum()).collect();
        let mut motion = Self::of_nodes(design, path, assemblies, nodes);
        motion.parameters = parameters;
        motion.traced = self.traced;
        motion.patches.push(Patch { from: 0, signs });
        (motion.anchor, motion.start, motion.demanded) = (start, start, range);
        Ok(Led::Over(Box::new(motion)))
    }

    /// Nodes at the path parameters of this motion's, and more where these are too far apart, beginning at scaled unknowns at its anchor, as the steps of a trace; `None`
    /// where one of them is not to be had so.
    fn nodes_of(
        &self,
        follower: &mut Follower<'_, DrivePath>,
        z: &[f64],
        scale: f64,
        progress: &mut dyn Progress,
    ) -> Result<Option<Vec<Node>>, MotionError> {
        let at_anchor = |p: &f64| (p - self.anchor).abs() <= self.margin();
        let Some(anchor) = self.parameters.iter().position(at_anchor) else {
            return Ok(None);
        };
        let (Some(start), count) = (follower.begin_by_plan(z, 1.0), self.nodes.len()) else {
            return Ok(None);
        };
        let last = z.len() - 1;
        let mut expected = z.to_vec();
        let mut upper: Vec<Node> = Vec::with_capacity(count - anchor);
        let mut lower: Vec<Node> = Vec::with_capacity(anchor + 1);
        let mut done = 0;
        for (nodes, sign) in [(&mut upper, 1.0), (&mut lower, -1.0)] {
            let first = match sign > 0.0 {
                true => start.clone(),
                false => start.clone().turned(),
            };
            follower.resume_by_plan(&first);
            nodes.push(first);
            let mut known = anchor;
            // Whether the node last reached is at that known one.
            let mut beside = true;
            loop {
                let next = if sign > 0.0 {
                    (known + 1 < count).then_some(known + 1)
                } else {
                    known.checked_sub(1)
                };
                let Some(next) = next else { break };
                let part = Done::Part(done as f64 / count as f64);
                if progress.reached(Stage::Following, part).is_break() {
                    let stage = Stage::Following;
                    return Err(MotionError::Stopped { stage });
                }
                let from = &nodes[nodes.len() - 1];
                let target = self.parameters[next] / scale;
                let [there, here] = [next, known].map(|index| &self.nodes[index].z);
                expected.clear();
                if beside {
                    let ahead = there.iter().zip(here).zip(&from.z);
                    expected.extend(ahead.map(|((there, here), from)| from + (there - here)));
                } else {
                    expected.extend(from.toward(target));
                }
                expected[last] = target;
                let mut reached = follower.step_by_plan_to(from, &expected);
                beside = reached.is_some();
                let mut part = 0.5;
                while reached.is_none() && part >= SHORTEST_PART {
                    let target = from.z[last] + part * (target - from.z[last]);
                    expected.clear();
                    expected.extend(from.toward(target));
                    expected[last] = target;
                    reached = follower.step_by_plan_to(from, &expected);
                    part *= 0.5;
                }
                let Some(to) = reached else { return Ok(None) };
                let standing = to.parameter_rate().abs() < STANDING;
                if standing || runs_away(&to.z, &start.z, standing) {
                    return Ok(None);
                }
                nodes.push(to);
                if beside {
                    (known, done) = (next, done + 1);
                }
            }
        }
        // The trace looks how well the tangent is determined at its start and its ends: about as well as on the known motion.
        let same = |node: &Node, known: usize| {
            let pairs = node
                .determinants
                .iter()
                .zip(&self.nodes[known].determinants);
            pairs.into_iter().all(|(a, b)| is_steady(*a, *b))
        };
        let ends = [&upper[0], &upper[upper.len() - 1], &lower[lower.len() - 1]];
        if !(ends.iter().zip([anchor, count - 1, 0])).all(|(node, known)| same(node, known)) {
            return Ok(None);
        }
        let mut nodes: Vec<Node> = Vec::with_capacity(lower.len() + upper.len());
        nodes.extend(lower.into_iter().skip(1).rev().map(Node::turned));
        nodes.extend(upper);
        Ok(Some(nodes))
    }
}

/// What comes of a motion over known nodes.
enum Led {
    Over(Box<Motion>),
    /// They do not lead over it: what is demanded, and the assemblies at the start.
    Astray(Box<Demand>, Assemblies),
}
