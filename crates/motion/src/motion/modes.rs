//! Where the assembly modes of a motion change, and what it meets there.

use super::Motion;
use super::branch::Patch;
use super::restriction::{MEETING, Unlocated};
use crate::drive_path::DrivePath;
use crate::events::{Event, EventKind, locate_change_point};
use crate::progress::{Done, Progress, Stage};
use crate::trace::{Follower, Node, hermite};

/// Pivot ratio of the bordered Jacobian below which branches are taken to cross.
pub const CROSSING: f64 = 1e-7;

/// Rate of the scaled path parameter along the arc below which a node lies at a limit.
const STATIONARY: f64 = 1e-9;
/// Changes this near each other, as a part of the step between their nodes, are at one pose.
const ONE_POSE: f64 = 1e-7;
/// Half width of the stretch about a change that is interpolated, as a part of the step between its nodes.
const BRIDGE: f64 = 0.15;
/// How well (in path scales) a change point is located.
const SNAP: f64 = 1e-11;
/// Part of its size at a regular neighbour below which a determinant counts as zero at a limit.
const VANISHING: f64 = 1e-3;

/// Where the mode of a step changes between two nodes.
struct Change {
    /// Part of the way from the one to the other.
    s: f64,
    at: Node,
    step: usize,
}

impl Motion {
    /// Finds where modes change between nodes, splits the motion there and records what was met.
    pub(crate) fn find_events(
        &mut self,
        follower: &mut Follower<'_, DrivePath>,
        progress: &mut dyn Progress,
    ) -> Result<(), Unlocated> {
        let modes = self.modes_of_nodes(follower, progress)?;
        let mut nodes: Vec<Node> = Vec::with_capacity(self.nodes.len());
        let mut signs: Vec<Vec<f64>> = Vec::new();
        let old = std::mem::take(&mut self.nodes);
        for (index, node) in old.iter().enumerate() {
            nodes.push(node.clone());
            let at_limit = node.parameter_rate().abs() < STATIONARY;
            // Only a limit that was located has no rate at all.
            if node.parameter_rate() == 0.0 {
                self.places.push(Event {
                    kind: EventKind::Limit,
                    at: follower.parameter(&node.z),
                    steps: vanishing(&modes[index], index.checked_sub(1).map(|i| &modes[i])),
                    bridge: 0.0,
                });
            }
            let Some(next) = old.get(index + 1) else {
                break;
            };
            let next_limit = next.parameter_rate().abs() < STATIONARY;
            // Next to a limit the sign of the regular end counts.
            let here = &modes[if at_limit { index + 1 } else { index }];
            let there = &modes[if next_limit { index } else { index + 1 }];
            let mut current: Vec<f64> = here.iter().map(|d| d.signum()).collect();
            signs.push(current.clone());
            if at_limit || next_limit {
                continue;
            }
            let flipped = (0..here.len()).filter(|&k| here[k] * there[k] < 0.0);
            let spacing = (follower.parameter(&next.z) - follower.parameter(&node.z)).abs();
            let mut last_s = f64::NEG_INFINITY;
            for Change { s, at, step } in self.changes(follower, node, next, flipped)? {
                current[step] = -current[step];
                if s - last_s < ONE_POSE {
                    // Several groups change at one pose.
                    if let (Some(event), Some(now)) = (self.places.last_mut(), signs.last_mut()) {
                        event.steps.push(step);
                        now.clone_from(&current);
                    }
                    continue;
                }
                last_s = s;
                // Where redundant constraints keep the tangent determined nothing crosses.
                let crossing = follower.tangent(&at.z, &at.tangent).is_none()
                    || follower.conditioning() < CROSSING;
                self.places.push(Event {
                    kind: if crossing {
                        EventKind::ChangePoint
                    } else {
                        EventKind::ModeChange
                    },
                    at: follower.parameter(&at.z),
                    steps: vec![step],
                    bridge: BRIDGE * spacing,
                });
                nodes.push(at);
                signs.push(current.clone());
            }
        }
        self.snap();
        self.events = self.met(self.demanded);
        self.parameters = nodes.iter().map(|n| follower.parameter(&n.z)).collect();
        self.nodes = nodes;
        for (from, signs) in signs.into_iter().enumerate() {
            if self.patches.last().is_none_or(|last| last.signs != signs) {
                self.patches.push(Patch { from, signs });
            }
        }
        Ok(())
    }

    /// Puts change points that lie at an end of the demanded range to rounding right there.
    fn snap(&mut self) {
        let margin = SNAP * self.scale;
        for place in self
            .places
            .iter_mut()
            .filter(|e| e.kind != EventKind::Limit)
        {
            let ends = [self.demanded.0, self.demanded.1];
            if let Some(end) = ends
                .into_iter()
                .find(|end| (place.at - end).abs() <= margin)
            {
                place.at = end;
            }
        }
    }

    /// The determinants of all steps at every node.
    fn modes_of_nodes(
        &self,
        follower: &mut Follower<'_, DrivePath>,
        progress: &mut dyn Progress,
    ) -> Result<Vec<Vec<f64>>, Unlocated> {
        let mut modes = Vec::with_capacity(self.nodes.len());
        for (done, node) in self.nodes.iter().enumerate() {
            let part = done as f64 / self.nodes.len() as f64;
            if progress
                .reached(Stage::Locating, Done::Part(part))
                .is_break()
            {
                return Err(Unlocated::Stopped(Stage::Locating));
            }
            modes.push(follower.determinants_at(node));
        }
        Ok(modes)
    }

    /// Where between two nodes the modes of the `flipped` steps change, in the order of travel.
    fn changes(
        &self,
        follower: &mut Follower<'_, DrivePath>,
        node: &Node,
        next: &Node,
        flipped: impl Iterator<Item = usize>,
    ) -> Result<Vec<Change>, Unlocated> {
        let mut found: Vec<Change> = Vec::new();
        for step in flipped {
            let mut locate = |by_plan: bool| {
                let located = locate_change_point(follower, node, next, step, by_plan);
                // Where nothing is located the middle of the step stands for it: a sign does not change without a place.
                let z = match &located {
                    Some((_, at)) => at.z.clone(),
                    None => hermite(node, next, 0.5),
                };
                let residual = follower.residual(&z);
                (located, z, residual)
            };
            let (mut located, mut z, mut residual) = locate(true);
            if located.is_none() || !(residual <= MEETING) {
                (located, z, residual) = locate(false);
            }
            if !(residual <= MEETING) {
                return Err(Unlocated::Missed { z, residual });
            }
            found.extend(located.map(|(s, at)| Change { s, at, step }));
        }
        found.sort_by(|a, b| a.s.total_cmp(&b.s));
        Ok(found)
    }
}

/// Steps whose determinant is all but zero, compared with a regular neighbour.
fn vanishing(at: &[f64], regular: Option<&Vec<f64>>) -> Vec<usize> {
    let Some(regular) = regular else {
        return Vec::new();
    };
    (0..at.len())
        .filter(|&k| !(at[k].abs() > VANISHING * regular[k].abs()))
        .collect()
}
