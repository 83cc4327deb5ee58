//! Assur groups: what the plan's blocks mean in the language of the field.

use kempe_model::DriveId;

use crate::Mechanism;
use crate::constraint::Constraint;
use crate::ids::BodyId;
use crate::plan::{Condition, Step, Swing};
use crate::structure::Source;

/// A group of bodies that are determined together.
#[derive(Clone, Debug, PartialEq)]
pub struct AssurGroup {
    /// The bodies.
    pub bodies: Vec<BodyId>,
    /// The class after Artobolevsky: 1 for a driven link, 2 for a dyad, 3 when a body of three pairs joins the others,
    /// higher for closed contours with that many sides.
    pub class: u32,
    /// What it is.
    pub kind: GroupKind,
    /// The drives among its rows.
    pub drives: Vec<DriveId>,
    /// Solved in closed form.
    pub closed_form: bool,
    /// Indices of its steps in the plan.
    pub steps: Vec<usize>,
}

/// What a group is. R stands for a pin, P for a slider, in the order of the joints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum GroupKind {
    /// A pin that runs in a slot along a smooth curve, its link placed before.
    PinInSlot,
    /// A link with a pin in such a slot.
    LinkInSlot,
    /// A body whose turn nothing determines.
    Idle,
    /// A link turned by a drive or, without one, with another link.
    Turned,
    /// A gear.
    Gear,
    /// A wheel of a belt or chain.
    BeltWheel,
    /// A pinion turned by its rack, or a rack's other side.
    Pinion,
    /// A bar between two pins that are placed already.
    RedundantBar,
    /// A link and a cylinder.
    RrrOfCylinder,
    /// A link and a slot along an arc.
    RrrOfSlot,
    /// A link and a straight slot of another.
    RrpOfSlot,
    /// A link with a straight slot.
    RprOfSlot,
    /// A link held otherwise.
    Link,
    /// A slider.
    Slider,
    /// A dyad of two links.
    Rrr,
    /// A dyad of two links.
    Rrp,
    /// A dyad of two links.
    Rpr,
    /// A dyad of two links.
    Prp,
    /// A dyad of two links.
    Rpp,
    /// Two links that are solved together.
    Pair,
    /// So many links, more than two.
    Larger(usize),
}

/// The groups of a plan, in the order in which they are solved.
pub fn assur_groups(mechanism: &Mechanism) -> Vec<AssurGroup> {
    let plan = &mechanism.plan;
    // Bodies depend on the bodies that their steps' rows feel; what depends on each other is one group.
    let n = mechanism.bodies;
    let mut depends: Vec<Vec<usize>> = vec![Vec::new(); n];
    for block in &plan.blocks {
        for unknown in &block.unknowns {
            let list = &mut depends[unknown.body().index()];
            list.extend(block.unknowns.iter().map(|u| u.body().index()));
            for row in &block.rows {
                list.extend(
                    mechanism.constraints[row.constraint]
                        .0
                        .bodies()
                        .map(BodyId::index),
                );
            }
        }
    }
    for (body, list) in depends.iter_mut().enumerate() {
        list.retain(|&b| b != body && b != 0);
        list.sort_unstable();
        list.dedup();
    }
    let mut groups = Vec::new();
    for component in crate::blocks::components(&depends) {
        let mut bodies: Vec<BodyId> = component
            .iter()
            .filter(|&&b| b != 0)
            .map(|&b| BodyId(b as u32))
            .collect();
        bodies.sort_unstable();
        if bodies.is_empty() {
            continue;
        }
        let steps: Vec<usize> = (0..plan.steps.len())
            .filter(|&s| {
                plan.blocks[s]
                    .unknowns
                    .iter()
                    .any(|u| bodies.contains(&u.body()))
            })
            .collect();
        let (class, kind) = classify(mechanism, &bodies, &steps);
        let rows = steps.iter().flat_map(|&s| &plan.blocks[s].rows);
        let drives = rows.filter_map(|row| match mechanism.constraints[row.constraint].1 {
            Source::Drive(drive) => Some(drive),
            _ => None,
        });
        let closed_form = steps
            .iter()
            .all(|&s| !matches!(plan.steps[s], Step::Newton { .. }));
        groups.push(AssurGroup {
            bodies,
            class,
            kind,
            drives: drives.collect(),
            closed_form,
            steps,
        });
    }
    groups
}

/// Class and kind of a group with these bodies, solved in these steps.
fn classify(mechanism: &Mechanism, bodies: &[BodyId], steps: &[usize]) -> (u32, GroupKind) {
    let links: Vec<BodyId> = (bodies.iter().copied())
        .filter(|body| !mechanism.is_shoe(*body))
        .collect();
    let steps = steps.iter().map(|&s| mechanism.plan.steps[s].closed());
    let steps: Vec<&Step> = steps.collect();
    match links.len() {
        0 => (1, GroupKind::PinInSlot),
        1 if links != bodies => (2, GroupKind::LinkInSlot),
        1 => of_one_link(mechanism, &steps),
        2 => (2, of_two_links(&steps)),
        n => (contour_class(mechanism, &links), GroupKind::Larger(n)),
    }
}

fn of_one_link(mechanism: &Mechanism, steps: &[&Step]) -> (u32, GroupKind) {
    if steps.iter().any(|s| matches!(s, Step::Hold { .. })) {
        return (1, GroupKind::Idle);
    }
    let mut telling = steps
        .iter()
        .filter(|s| !matches!(s, Step::Turn { .. } | Step::Pin { .. }));
    match telling.next() {
        None => (1, GroupKind::Turned),
        Some(Step::Gear { constraint, .. }) => match mechanism.constraints[*constraint].0 {
            Constraint::Belt(_) => (1, GroupKind::BeltWheel),
            Constraint::Rack(_) => (1, GroupKind::Pinion),
            _ => (1, GroupKind::Gear),
        },
        Some(Step::TwoPins { .. }) => (2, GroupKind::RedundantBar),
        Some(Step::Swing(Swing { condition, .. })) => match condition {
            Condition::Radius { .. } => (2, GroupKind::RrrOfCylinder),
            Condition::OnArc { .. } | Condition::ArcThrough { .. } => (2, GroupKind::RrrOfSlot),
            Condition::OnLine { .. } => (2, GroupKind::RrpOfSlot),
            _ => (2, GroupKind::Link),
        },
        Some(Step::SwingLine { .. }) => (2, GroupKind::RprOfSlot),
        Some(Step::Cross { .. }) => (1, GroupKind::Slider),
        Some(_) => (2, GroupKind::Link),
    }
}

fn of_two_links(steps: &[&Step]) -> GroupKind {
    let any = |is: &dyn Fn(&Step) -> bool| steps.iter().any(|step| is(step));
    if any(&|s| matches!(s, Step::Dyad { .. })) {
        GroupKind::Rrr
    } else if any(&|s| matches!(s, Step::Swing(s) if s.partner.is_some())) {
        GroupKind::Rrp
    } else if any(&|s| matches!(s, Step::SwingLine(s) if s.partner.is_some())) {
        GroupKind::Rpr
    } else if any(&|s| matches!(s, Step::Cross { carriers: [a, b], .. } if a.body != b.body)) {
        GroupKind::Prp
    } else if any(&|s| matches!(s, Step::Newton { .. })) {
        GroupKind::Pair
    } else {
        GroupKind::Rpp
    }
}

/// Class of a larger group: the number of sides of its largest smallest closed contour of moving bodies, or 3 when it
/// has none but a body of three pairs.
fn contour_class(mechanism: &Mechanism, bodies: &[BodyId]) -> u32 {
    let inside = |c: &Constraint| {
        let mut list: Vec<usize> = c
            .bodies()
            .filter_map(|b| bodies.iter().position(|x| *x == b))
            .collect();
        list.dedup();
        list
    };
    let mut neighbours: Vec<Vec<usize>> = vec![Vec::new(); bodies.len()];
    for (constraint, _) in &mechanism.constraints[..mechanism.joint_constraints] {
        if let [a, b] = inside(constraint)[..]
            && a != b
            && !neighbours[a].contains(&b)
        {
            neighbours[a].push(b);
            neighbours[b].push(a);
        }
    }
    // The shortest cycle through each edge (breadth first without that edge); the longest of them counts.
    let mut class = 3;
    for a in 0..bodies.len() {
        for &b in neighbours[a].iter().filter(|&&b| b > a) {
            let mut distance = vec![usize::MAX; bodies.len()];
            let mut queue = std::collections::VecDeque::from([a]);
            distance[a] = 0;
            while let Some(at) = queue.pop_front() {
                for &next in &neighbours[at] {
                    if (at == a && next == b) || distance[next] != usize::MAX {
                        continue;
                    }
                    distance[next] = distance[at] + 1;
                    queue.push_back(next);
                }
            }
            if distance[b] != usize::MAX {
                class = class.max(distance[b] as u32 + 1);
            }
        }
    }
    class
}
