//! Which unknowns are solved together, and in what order.
//!
//! Every body has an angle (one unknown) and a place (two). Constraint rows are matched to unknowns (maximum bipartite
//! matching); the strongly connected components of the resulting dependencies, in topological order, are the smallest
//! sets that must be solved at once (Dulmage and Mendelsohn 1958). For lower pairs with one drive these are the Assur
//! groups, split further where an angle is known before a place.

use std::collections::VecDeque;

use kempe_model::{LinkId, Point, PointId};

use crate::constraint::{Constraint, Joint, Touch};
use crate::ids::{BodyId, Marker};
use crate::structure::{Source, Structure};

/// One unknown quantity of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Unknown {
    /// The angle of a body.
    Angle(BodyId),
    /// The place of a body: two numbers.
    Place(BodyId),
}

impl Unknown {
    /// How many numbers it is.
    pub fn size(self) -> usize {
        match self {
            Unknown::Angle(_) => 1,
            Unknown::Place(_) => 2,
        }
    }

    /// The body.
    pub fn body(self) -> BodyId {
        match self {
            Unknown::Angle(body) | Unknown::Place(body) => body,
        }
    }

    fn node(self) -> usize {
        match self {
            Unknown::Angle(body) => 2 * (body.index() - 1),
            Unknown::Place(body) => 2 * (body.index() - 1) + 1,
        }
    }

    fn from_node(node: usize) -> Self {
        let body = BodyId((node / 2 + 1) as u32);
        if node.is_multiple_of(2) {
            Unknown::Angle(body)
        } else {
            Unknown::Place(body)
        }
    }
}

/// One residual row: which constraint, and which of its rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Row {
    /// Index into the mechanism's constraints.
    pub constraint: usize,
    /// Row of that constraint.
    pub row: usize,
}

/// A smallest set of unknowns that is solved at once.
#[derive(Clone, Debug)]
pub struct Block {
    /// The unknowns.
    pub unknowns: Vec<Unknown>,
    /// As many rows as there are numbers to find.
    pub rows: Vec<Row>,
    /// Further rows that must hold as well: the block is overconstrained.
    pub surplus: Vec<Row>,
}

/// The whole mechanism taken apart.
#[derive(Clone, Debug, Default)]
pub struct Decomposition {
    /// Blocks in the order in which they can be solved.
    pub blocks: Vec<Block>,
    /// Rows that found no unknown of their own: overconstraint.
    pub surplus: Vec<Row>,
    /// Angles that no constraint feels: idle freedoms.
    pub idle: Vec<BodyId>,
    /// Unknowns that nothing determines: freedoms without a drive.
    pub undetermined: Vec<Unknown>,
    /// The bodies that these freedoms may move.
    pub loose: Vec<BodyId>,
    /// One of several bodies that hold each other and turn as one about a point, and the point: nothing determines their angle, though
    /// there are rows enough.
    pub as_one: Vec<(BodyId, PointId)>,
}

/// The unknowns that a constraint feels. `idle[body]` tells that nothing feels the body's angle.
fn felt(constraint: &Constraint, idle: &[bool]) -> Vec<Unknown> {
    let mut list = Vec::with_capacity(6);
    for touch in constraint.touched() {
        let body = touch.body();
        let (place, angle) = match touch {
            Touch::Point(_) => (true, !idle[body.index()]),
            Touch::Whole(_) => (true, true),
            Touch::Angle(_) => (false, true),
        };
        list.extend(angle.then_some(Unknown::Angle(body)));
        list.extend(place.then_some(Unknown::Place(body)));
    }
    list.retain(|u| u.body() != BodyId::GROUND);
    list.sort_unstable();
    list.dedup();
    list
}

/// The bodies whose angle no constraint needs: everything that holds them acts at one place, about which they may turn.
fn idle_bodies(structure: &Structure) -> Vec<bool> {
    let origins = structure.origins();
    let mut held: Vec<Option<PointId>> = vec![None; structure.bodies];
    let mut idle = vec![true; structure.bodies];
    let constraints = structure.constraints.iter();
    for touch in constraints.flat_map(|(c, _)| c.touched()) {
        let body = touch.body().index();
        let at = match touch {
            // Of several points in the origin one stands for all.
            Touch::Point(marker) if structure.at_origin(marker) && origins[body].is_some() => {
                origins[body]
            }
            Touch::Point(marker) => Some(structure.markers[marker.index as usize].point),
            Touch::Whole(_) | Touch::Angle(_) => None,
        };
        idle[body] &= at.is_some() && held[body].is_none_or(|known| Some(known) == at);
        held[body] = at;
    }
    idle
}

/// Whether a constraint is the pin of a link at a second point that it shares with an earlier one. Of links that lie upon
/// each other one repeats the other, and the pin that repeats is surplus: both as a dyad would have no place of their own.
fn joins_once_more(structure: &Structure, index: usize) -> bool {
    let Source::Pin { point, link } = structure.constraints[index].1 else {
        return false;
    };
    let points = &structure.model.points;
    let on_both = |p: &Point, other: LinkId| p.links.contains(&link) && p.links.contains(&other);
    let earlier = points[point.index()].holder_first();
    earlier
        .take_while(|other| *other != link)
        .filter(|other| structure.body_of(*other) != structure.body_of(link))
        .any(|other| points[..point.index()].iter().any(|p| on_both(p, other)))
}

/// Takes a mechanism apart. `with_drives` tells whether the drives' constraints count.
pub fn decompose(structure: &Structure, with_drives: bool) -> Decomposition {
    let nodes = 2 * (structure.bodies - 1);
    // Drives first: where the count says too much, it is a joint's row that is surplus.
    let joints = 0..structure.joint_constraints;
    let (once_more, joints): (Vec<usize>, Vec<usize>) =
        joints.partition(|index| joins_once_more(structure, *index));
    let drives = structure.joint_constraints..structure.constraints.len();
    let order = drives
        .filter(|_| with_drives)
        .chain(joints)
        .chain(once_more);

    let idle_angle = idle_bodies(structure);
    let mut rows: Vec<(Row, Vec<usize>)> = Vec::new();
    let mut surplus = Vec::new();
    for index in order {
        let constraint = &structure.constraints[index].0;
        let list: Vec<usize> = felt(constraint, &idle_angle)
            .into_iter()
            .map(Unknown::node)
            .collect();
        // Links that share two points can turn no more against each other: of the second pin one row is left.
        let independent = if joins_once_more(structure, index) {
            1
        } else {
            constraint.rows()
        };
        for row in 0..constraint.rows() {
            let row = Row {
                constraint: index,
                row,
            };
            if row.row < independent {
                rows.push((row, list.clone()));
            } else {
                surplus.push(row);
            }
        }
    }

    let owner = match_rows(&rows, nodes);
    let mut owned: Vec<Vec<usize>> = vec![Vec::new(); nodes];
    for (row, node) in owner.iter().enumerate() {
        match node {
            Some(node) => owned[*node].push(row),
            None => surplus.push(rows[row].0),
        }
    }

    let mut idle = Vec::new();
    let mut undetermined = Vec::new();
    for node in 0..nodes {
        let unknown = Unknown::from_node(node);
        if owned[node].len() < unknown.size() {
            match unknown {
                Unknown::Angle(body) if idle_angle[body.index()] => idle.push(body),
                _ => undetermined.push(unknown),
            }
        }
    }

    // A node depends on the nodes that its own rows feel.
    let depends: Vec<Vec<usize>> = (0..nodes)
        .map(|node| {
            let mut list: Vec<usize> = owned[node]
                .iter()
                .flat_map(|&row| rows[row].1.iter().copied())
                .filter(|&n| n != node)
                .collect();
            list.sort_unstable();
            list.dedup();
            list
        })
        .collect();

    let mut blocks = Vec::new();
    let mut block_of = vec![usize::MAX; nodes];
    for component in components(&depends) {
        let mut component = component;
        component.sort_unstable();
        let mut block_rows: Vec<usize> = component
            .iter()
            .flat_map(|&n| owned[n].iter().copied())
            .collect();
        block_rows.sort_unstable();
        for &node in &component {
            block_of[node] = blocks.len();
        }
        // Angles before places, each in the order of the bodies.
        let mut unknowns: Vec<Unknown> = component.into_iter().map(Unknown::from_node).collect();
        unknowns.sort_unstable();
        blocks.push(Block {
            unknowns,
            rows: block_rows.into_iter().map(|row| rows[row].0).collect(),
            surplus: Vec::new(),
        });
    }
    // A surplus row joins the block that solves the other row of its constraint.
    for &row in &surplus {
        let home = blocks
            .iter()
            .position(|b: &Block| b.rows.iter().any(|r| r.constraint == row.constraint));
        if let Some(home) = home {
            blocks[home].surplus.push(row);
        }
    }
    let as_one = blocks.iter();
    let as_one: Vec<(BodyId, PointId)> = as_one
        .filter_map(|block| turns_as_one(structure, &idle_angle, block))
        .collect();
    undetermined.extend(as_one.iter().map(|(body, _)| Unknown::Angle(*body)));
    let loose = loose(&rows, &owner, &undetermined);
    Decomposition {
        blocks,
        surplus,
        idle,
        undetermined,
        loose,
        as_one,
    }
}

/// A body of a block that holds on to all else at a single point, and the point.
fn turns_as_one(structure: &Structure, idle: &[bool], block: &Block) -> Option<(BodyId, PointId)> {
    let inside = |unknown: Unknown| block.unknowns.contains(&unknown);
    let angles = block.unknowns.iter().filter(|u| u.size() == 1);
    let body = angles.clone().next()?.body();
    if angles.count() < 2 {
        return None;
    }
    let mut held: Vec<PointId> = Vec::new();
    for row in &block.rows {
        let constraint = &structure.constraints[row.constraint].0;
        for touch in constraint.touched() {
            let body = touch.body();
            let angle = inside(Unknown::Angle(body));
            let place = inside(Unknown::Place(body));
            let at = |marker: Marker| structure.markers[marker.index as usize].point;
            held.push(match touch {
                _ if angle && place => continue,
                Touch::Angle(_) if angle || idle[body.index()] => continue,
                Touch::Point(marker) if !angle && !place => at(marker),
                // Its origin is in place.
                Touch::Point(marker) if angle && structure.at_origin(marker) => at(marker),
                Touch::Point(_) | Touch::Whole(_) if angle => structure.origin(body)?,
                _ => return None,
            });
        }
    }
    let point = *held.first()?;
    held.iter().all(|p| *p == point).then_some((body, point))
}

/// The bodies that nothing determines: those of the unknowns without rows, and those whose rows could as well determine these (the
/// under-determined part of Dulmage and Mendelsohn, 1958).
fn loose(
    rows: &[(Row, Vec<usize>)],
    owner: &[Option<usize>],
    undetermined: &[Unknown],
) -> Vec<BodyId> {
    let mut found: Vec<usize> = undetermined.iter().map(|u| u.node()).collect();
    let mut next = 0;
    while let Some(&node) = found.get(next) {
        for ((_, felt), owner) in rows.iter().zip(owner) {
            if let Some(owner) = owner
                && felt.contains(&node)
                && !found.contains(owner)
            {
                found.push(*owner);
            }
        }
        next += 1;
    }
    let bodies = found.into_iter().map(|n| Unknown::from_node(n).body());
    let mut bodies: Vec<BodyId> = bodies.collect();
    bodies.sort_unstable();
    bodies.dedup();
    bodies
}

/// Maximum matching of rows to unknowns (an angle takes one row, a place two), by shortest augmenting paths.
fn match_rows(rows: &[(Row, Vec<usize>)], nodes: usize) -> Vec<Option<usize>> {
    let capacity = |node: usize| Unknown::from_node(node).size();
    let mut owner: Vec<Option<usize>> = vec![None; rows.len()];
    let mut owned: Vec<Vec<usize>> = vec![Vec::new(); nodes];
    let mut seen = vec![usize::MAX; nodes];
    let mut came_from: Vec<usize> = vec![0; nodes];
    for start in 0..rows.len() {
        let mut queue: VecDeque<usize> = VecDeque::from([start]);
        'search: while let Some(row) = queue.pop_front() {
            for &node in &rows[row].1 {
                if seen[node] == start {
                    continue;
                }
                seen[node] = start;
                came_from[node] = row;
                if owned[node].len() < capacity(node) {
                    // Walk back: every row on the path moves to the node it reached.
                    let mut node = node;
                    loop {
                        let row = came_from[node];
                        let before = owner[row].replace(node);
                        owned[node].push(row);
                        match before {
                            Some(old) => {
                                owned[old].retain(|&r| r != row);
                                node = old;
                            }
                            None => break 'search,
                        }
                    }
                }
                queue.extend(owned[node].iter().copied());
            }
        }
    }
    owner
}

/// Strongly connected components, dependencies first (Tarjan 1972, without recursion).
pub(crate) fn components(depends: &[Vec<usize>]) -> Vec<Vec<usize>> {
    const UNSEEN: usize = usize::MAX;
    let n = depends.len();
    let (mut index, mut low) = (vec![UNSEEN; n], vec![0; n]);
    let mut on_stack = vec![false; n];
    let (mut stack, mut found) = (Vec::new(), Vec::new());
    let mut counter = 0;
    for root in 0..n {
        if index[root] != UNSEEN {
            continue;
        }
        let mut calls: Vec<(usize, usize)> = vec![(root, 0)];
        while let Some((node, next)) = calls.pop() {
            if next == 0 {
                index[node] = counter;
                low[node] = counter;
                counter += 1;
                stack.push(node);
                on_stack[node] = true;
            }
            if let Some(&child) = depends[node].get(next) {
                calls.push((node, next + 1));
                if index[child] == UNSEEN {
                    calls.push((child, 0));
                } else if on_stack[child] {
                    low[node] = low[node].min(index[child]);
                }
                continue;
            }
            if low[node] == index[node] {
                let mut component = Vec::new();
                while let Some(top) = stack.pop() {
                    on_stack[top] = false;
                    component.push(top);
                    if top == node {
                        break;
                    }
                }
                found.push(component);
            }
            if let Some(&(parent, _)) = calls.last() {
                low[parent] = low[parent].min(low[node]);
            }
        }
    }
    found
}
