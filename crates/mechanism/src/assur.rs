//! Assur groups: what the plan's blocks mean in the language of the field.

use crate::Mechanism;
use crate::constraint::Constraint;
use crate::ids::BodyId;
use crate::plan::{Condition, Step, Swing};

/// A group of bodies that are determined together.
#[derive(Clone, Debug, PartialEq)]
pub struct AssurGroup {
    /// The bodies.
    pub bodies: Vec<BodyId>,
    /// The class after Artobolevsky: 1 for a driven link, 2 for a dyad, 3 when a body of three pairs joins the others,
    /// higher for closed contours with that many sides.
    pub class: u32,
    /// The kind in words, such as `RRR dyad`.
    pub kind: String,
    /// Solved in closed form.
    pub closed_form: bool,
    /// Indices of its steps in the plan.
    pub steps: Vec<usize>,
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
        let (class, kind) = describe(mechanism, &bodies, &steps);
        let closed_form = steps
            .iter()
            .all(|&s| !matches!(plan.steps[s], Step::Newton { .. }));
        groups.push(AssurGroup {
            bodies,
            class,
            kind,
            closed_form,
            steps,
        });
    }
    groups
}

fn describe(mechanism: &Mechanism, bodies: &[BodyId], steps: &[usize]) -> (u32, String) {
    let plan = &mechanism.plan;
    let drives: Vec<&str> = (steps.iter().flat_map(|&s| &plan.blocks[s].rows))
        .filter_map(|row| match mechanism.constraints[row.constraint].1 {
            crate::structure::Source::Drive(d) => {
                Some(mechanism.model.drives[d.index()].name.as_str())
            }
            _ => None,
        })
        .collect();
    let driven = |what: &str| match drives.as_slice() {
        [] => what.to_owned(),
        names => format!("{what} with drive {}", names.join(", ")),
    };
    let kinds: Vec<&Step> = steps.iter().map(|&s| &plan.steps[s]).collect();
    let links: Vec<BodyId> = (bodies.iter().copied())
        .filter(|body| !mechanism.is_shoe(*body))
        .collect();
    match links.len() {
        0 => (1, "pin in curved slot".into()),
        1 if links != bodies => (2, driven("link and curved slot")),
        1 if kinds.iter().any(|s| matches!(s, Step::Hold { .. })) => {
            (1, "body with an idle turn".into())
        }
        1 => match kinds
            .iter()
            .find(|s| !matches!(s, Step::Turn { .. } | Step::Pin { .. }))
        {
            None if drives.is_empty() => (1, "link turned with another".into()),
            None => (1, driven("link")),
            Some(Step::Gear { .. }) => (1, "gear".into()),
            Some(Step::TwoPins { .. }) => (2, "bar between two placed pins (redundant)".into()),
            Some(Step::Swing(Swing {
                condition: Condition::Radius { .. },
                ..
            })) => (2, driven("RRR dyad of link and cylinder")),
            Some(Step::Swing(Swing {
                condition: Condition::OnArc { .. } | Condition::ArcThrough { .. },
                ..
            })) => (2, "RRR dyad of link and curved slot".into()),
            Some(Step::Swing(Swing {
                condition: Condition::OnLine { .. },
                ..
            })) => (2, "RRP dyad of link and slot".into()),
            Some(Step::SwingLine { .. }) => (2, driven("RPR dyad of link and slot")),
            Some(Step::Swing { .. }) => (2, driven("link")),
            Some(Step::Cross { .. }) => (1, driven("slider")),
            Some(_) => (2, driven("link")),
        },
        2 => {
            let kind = if kinds.iter().any(|s| matches!(s, Step::Dyad { .. })) {
                "RRR dyad"
            } else if (kinds.iter()).any(|s| matches!(s, Step::Swing(s) if s.partner.is_some())) {
                "RRP dyad"
            } else if (kinds.iter()).any(|s| matches!(s, Step::SwingLine(s) if s.partner.is_some()))
            {
                "RPR dyad"
            } else if kinds
                .iter()
                .any(|s| matches!(s, Step::Cross { carriers: [a, b], .. } if a.body != b.body))
            {
                "PRP dyad"
            } else if kinds.iter().any(|s| matches!(s, Step::Newton { .. })) {
                "pair of links"
            } else {
                "RPP dyad"
            };
            (2, driven(kind))
        }
        n => {
            let class = contour_class(mechanism, &links);
            let roman = ["I", "II", "III", "IV", "V", "VI", "VII", "VIII"]
                .get(class as usize - 1)
                .unwrap_or(&"higher");
            (
                class,
                driven(&format!("Assur group of class {roman} with {n} links")),
            )
        }
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
