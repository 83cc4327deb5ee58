//! Where the assembly modes of a motion change, and what it meets there.

use super::restriction::{MEETING, Unlocated};
use super::{Motion, Patch};
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
        self.note_determinants(follower, progress)?;
        let old = std::mem::take(&mut self.nodes);
        // What is found between two nodes, with the index of the first.
        let mut between: Vec<(usize, Node)> = Vec::new();
        let mut count = 0;
        let mut current: Vec<f64> = Vec::new();
        for (index, node) in old.iter().enumerate() {
            let at_limit = node.parameter_rate().abs() < STATIONARY;
            // Only a limit that was located has no rate at all.
            if node.parameter_rate() == 0.0 {
                let beside = index.checked_sub(1).unwrap_or(index + 1);
                let regular = old.get(beside).map(|node| &node.determinants);
                self.places.push(Event {
                    kind: EventKind::Limit,
                    at: follower.parameter(&node.z),
                    steps: vanishing(&node.determinants, regular),
                    bridge: 0.0,
                });
            }
            let Some(next) = old.get(index + 1) else {
                break;
            };
            let next_limit = next.parameter_rate().abs() < STATIONARY;
            // Next to a limit the sign of the regular end counts.
            let here = &(if at_limit { next } else { node }).determinants;
            let there = &(if next_limit { node } else { next }).determinants;
            current.clear();
            current.extend(here.iter().map(|d| d.signum()));
            self.begin_patch(count, &current);
            count += 1;
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
                    if let (Some(event), Some(patch)) =
                        (self.places.last_mut(), self.patches.last_mut())
                    {
                        event.steps.push(step);
                        patch.signs.clone_from(&current);
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
                between.push((index, at));
                self.begin_patch(count, &current);
                count += 1;
            }
        }
        self.snap();
        self.events = self.met(self.demanded);
        self.nodes = insert(old, between);
        let parameters = self.nodes.iter().map(|n| follower.parameter(&n.z));
        self.parameters = parameters.collect();
        Ok(())
    }

    /// From this node on the modes are these.
    fn begin_patch(&mut self, from: usize, signs: &[f64]) {
        if self.patches.last().is_none_or(|last| last.signs != signs) {
            let signs = signs.to_vec();
            self.patches.push(Patch { from, signs });
        }
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

    /// Notes at every node the determinants of all steps.
    fn note_determinants(
        &mut self,
        follower: &mut Follower<'_, DrivePath>,
        progress: &mut dyn Progress,
    ) -> Result<(), Unlocated> {
        let count = self.nodes.len();
        for (done, node) in self.nodes.iter_mut().enumerate() {
            let part = done as f64 / count as f64;
            if progress
                .reached(Stage::Locating, Done::Part(part))
                .is_break()
            {
                return Err(Unlocated::Stopped(Stage::Locating));
            }
            if node.determinants.is_empty() {
                node.determinants = follower.determinants(&node.z).to_vec();
            }
        }
        Ok(())
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
        let mut open: Vec<usize> = flipped.collect();
        while !open.is_empty() {
            let step = open.remove(0);
            let mut locate = |by_plan: bool| {
                let located = locate_change_point(follower, node, next, (step, &open), by_plan);
                // Where nothing is located the middle of the step stands for it: a sign does not change without a place.
                let z = match &located {
                    Some(located) => located.at.z.clone(),
                    None => hermite(node, next, 0.5),
                };
                let residual = follower.residual(&z);
                (located, z, residual)
            };
            let (mut located, mut z, mut residual) = locate(true);
            if located.is_none() || !(residual <= MEETING) {
                (located, z, residual) = locate(false);
            }
            // What redundant constraints leave over on the branch itself keeps no branches apart.
            let mut left_over = || {
                let [here, there] = [node, next].map(|node| follower.residual(&node.z));
                here.max(there)
            };
            if !(residual <= MEETING || residual <= MEETING + left_over()) {
                return Err(Unlocated::Missed { z, residual });
            }
            if let Some(located) = located {
                open.retain(|other| !located.as_well.contains(other));
                for step in std::iter::once(step).chain(located.as_well) {
                    let (s, at) = (located.s, located.at.clone());
                    found.push(Change { s, at, step });
                }
            }
        }
        found.sort_by(|a, b| a.s.total_cmp(&b.s));
        Ok(found)
    }
}

/// Nodes with others behind those of these indices, rising.
fn insert(nodes: Vec<Node>, between: Vec<(usize, Node)>) -> Vec<Node> {
    if between.is_empty() {
        return nodes;
    }
    let mut all = Vec::with_capacity(nodes.len() + between.len());
    let mut between = between.into_iter().peekable();
    for (index, node) in nodes.into_iter().enumerate() {
        all.push(node);
        while let Some((_, more)) = between.next_if(|(before, _)| *before == index) {
            all.push(more);
        }
    }
    all
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
