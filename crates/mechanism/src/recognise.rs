//! Which closed form solves a block: the Assur groups of class II, driven links and gears.

use crate::apart::{self, Tie};
use crate::blocks::{Block, Row, Unknown};
use crate::constraint::{Constraint, Joint, Unit};
use crate::ids::{BodyId, Marker};
use crate::step::{Carrier, Condition, Dyad, DyadBody, Reach, Sliding, Step, Swing, SwingLine};
use crate::structure::Structure;

/// The constraints of a block, each once, with whether all of its rows are there.
fn constraints_of<'m>(structure: &'m Structure, rows: &[Row]) -> Option<Vec<&'m Constraint>> {
    let mut list: Vec<(usize, usize)> = Vec::new();
    for row in rows {
        match list.iter_mut().find(|(c, _)| *c == row.constraint) {
            Some((_, count)) => *count += 1,
            None => list.push((row.constraint, 1)),
        }
    }
    list.into_iter()
        .map(|(index, count)| {
            let constraint = &structure.constraints[index].0;
            (constraint.rows() == count).then_some(constraint)
        })
        .collect()
}

/// Finds the closed form of a block, if there is one; `dyads` are known already.
pub(crate) fn recognise(structure: &Structure, block: &Block, dyads: usize) -> Option<Step> {
    let rows: Vec<Row> = block.rows.iter().chain(&block.surplus).copied().collect();
    let constraints = Tie::all(&constraints_of(structure, &rows)?)?;
    let closed = closed_form(structure, block, &constraints, dyads)?;
    apart::of(closed, &constraints)
}

/// The closed form of a block where its pins hold.
fn closed_form(
    structure: &Structure,
    block: &Block,
    constraints: &[Tie],
    dyads: usize,
) -> Option<Step> {
    match (block.unknowns.as_slice(), block.surplus.len()) {
        ([Unknown::Angle(body)], 0) => constraints
            .first()?
            .constraint
            .turn(*body, block.rows[0].constraint),
        ([Unknown::Place(body)], 0) => place_alone(*body, constraints),
        ([Unknown::Angle(body), Unknown::Place(_)], 0) if body.index() > 0 && one_body(block) => {
            swing(*body, constraints).or_else(|| pinion(*body, block, structure))
        }
        ([Unknown::Angle(body), Unknown::Place(_)], 1) if one_body(block) => {
            two_pins(*body, constraints)
        }
        ([Unknown::Place(i), Unknown::Place(j)], 0) => prp(*i, *j, constraints),
        ([_, _, _], 0) => rrp(block, constraints),
        ([_, _, _, _], 0) => two_bodies(block)
            .and_then(|(i, j)| rrr(i, j, constraints, dyads).or_else(|| rpr(i, j, constraints))),
        _ => None,
    }
}

fn one_body(block: &Block) -> bool {
    block
        .unknowns
        .iter()
        .all(|u| u.body() == block.unknowns[0].body())
}

/// The two bodies of a block that seeks angle and place of both.
fn two_bodies(block: &Block) -> Option<(BodyId, BodyId)> {
    match block.unknowns.as_slice() {
        &[
            Unknown::Angle(i),
            Unknown::Angle(j),
            Unknown::Place(k),
            Unknown::Place(l),
        ] if i == k && j == l => Some((i, j)),
        _ => None,
    }
}

fn place_alone(body: BodyId, constraints: &[Tie]) -> Option<Step> {
    match constraints {
        [pin] => pin.pin(body).map(|(own, at)| Step::Pin { own, at }),
        [first, second] => {
            let carrier = Carrier { body, pin: None };
            let conditions = [
                first.constraint.condition(body)?,
                second.constraint.condition(body)?,
            ];
            Some(Step::Cross {
                carriers: [carrier; 2],
                conditions,
            })
        }
        _ => None,
    }
}

/// One pin to something placed and one more condition.
fn swing(body: BodyId, constraints: &[Tie]) -> Option<Step> {
    let [first, second] = constraints else {
        return None;
    };
    let (pin, other) = if first.pin(body).is_some() {
        (first, second)
    } else {
        (second, first)
    };
    let (own, at) = pin.pin(body)?;
    match other.constraint.condition(body)? {
        Condition::Through { line, point } => Some(Step::SwingLine(SwingLine {
            own,
            at,
            toward: point,
            reach: Reach::Line { line },
            partner: None,
        })),
        Condition::TravelThrough { line, point, input } => Some(Step::SwingLine(SwingLine {
            own,
            at,
            toward: point,
            reach: Reach::Travel { line, input },
            partner: None,
        })),
        // The travel depends on the angle sought; of a line that is let go no closed form is known.
        Condition::Roll { .. } | Condition::LineBeside { .. } => None,
        condition @ Condition::ArcThrough { .. } => Some(Step::Swing(Swing {
            own,
            at,
            tip: own,
            condition,
            partner: None,
        })),
        condition @ (Condition::OnLine { own: tip, .. }
        | Condition::BesideLine { own: tip, .. }
        | Condition::TravelOn { own: tip, .. }
        | Condition::OnArc { own: tip, .. }
        | Condition::Radius { own: tip, .. }) => Some(Step::Swing(Swing {
            own,
            at,
            tip,
            condition,
            partner: None,
        })),
    }
}

/// A pinion pinned at its centre: the rack's travel is known before its angle.
fn pinion(body: BodyId, block: &Block, structure: &Structure) -> Option<Step> {
    let constraint = |row: &Row| structure.constraints[row.constraint].0;
    let (own, at) = block
        .rows
        .iter()
        .find_map(|row| constraint(row).pin(body))?;
    block
        .rows
        .iter()
        .find_map(|row| constraint(row).roll((own, at), row.constraint))
}

fn two_pins(body: BodyId, constraints: &[Tie]) -> Option<Step> {
    let [first, second] = constraints else {
        return None;
    };
    let ((a, at_a), (b, at_b)) = (first.pin(body)?, second.pin(body)?);
    Some(Step::TwoPins { a, at_a, b, at_b })
}

/// The pin between two bodies, as `(on i, on j)`.
fn pin_between(i: BodyId, j: BodyId, constraint: &Tie) -> Option<(Marker, Marker)> {
    constraint.pin(i).filter(|(_, other)| other.body == j)
}

fn prp(i: BodyId, j: BodyId, constraints: &[Tie]) -> Option<Step> {
    let inner = constraints.iter().find_map(|c| pin_between(i, j, c))?;
    let outer: Vec<&Tie> = constraints
        .iter()
        .filter(|c| pin_between(i, j, c).is_none())
        .collect();
    let [first, second] = outer.as_slice() else {
        return None;
    };
    let (first, second) = if first.constraint.condition(i).is_some() {
        (first, second)
    } else {
        (second, first)
    };
    let conditions = [
        first.constraint.condition(i)?,
        second.constraint.condition(j)?,
    ];
    if first.touches(j) || second.touches(i) {
        return None;
    }
    let carriers = [
        Carrier {
            body: i,
            pin: Some(inner.0),
        },
        Carrier {
            body: j,
            pin: Some(inner.1),
        },
    ];
    Some(Step::Cross {
        carriers,
        conditions,
    })
}

/// The pin of a body to anything but its partner, as `(own, other)`.
fn outer_pin(body: BodyId, partner: BodyId, constraints: &[Tie]) -> Option<(Marker, Marker)> {
    (constraints.iter())
        .filter(|c| !c.touches(partner))
        .find_map(|c| c.pin(body))
}

/// Angle and place of one body, place of a second whose angle is known.
fn rrp(block: &Block, constraints: &[Tie]) -> Option<Step> {
    let swinging = block
        .unknowns
        .iter()
        .find_map(|u| matches!(u, Unknown::Angle(_)).then(|| u.body()))?;
    let mut places = block
        .unknowns
        .iter()
        .filter(|u| matches!(u, Unknown::Place(_)))
        .map(|u| u.body());
    let (first, second) = (places.next()?, places.next()?);
    let sliding = match (first == swinging, second == swinging) {
        (true, false) => second,
        (false, true) => first,
        _ => return None,
    };
    let inner = constraints
        .iter()
        .find_map(|c| pin_between(swinging, sliding, c))?;
    let outer = outer_pin(swinging, sliding, constraints)?;
    let condition = constraints
        .iter()
        .filter(|c| !c.touches(swinging))
        .find_map(|c| c.constraint.condition(sliding))?;
    (constraints.len() == 3).then_some(Step::Swing(Swing {
        own: outer.0,
        at: outer.1,
        tip: inner.0,
        condition,
        partner: Some(Carrier {
            body: sliding,
            pin: Some(inner.1),
        }),
    }))
}

fn rrr(i: BodyId, j: BodyId, constraints: &[Tie], constants: usize) -> Option<Step> {
    if constraints.len() != 3 {
        return None;
    }
    let inner = constraints.iter().find_map(|c| pin_between(i, j, c))?;
    let (outer_i, outer_j) = (outer_pin(i, j, constraints)?, outer_pin(j, i, constraints)?);
    let body = |(outer, at), inner| DyadBody {
        outer,
        at,
        inner,
        wanted: true,
    };
    Some(Step::Dyad(Dyad {
        a: body(outer_i, inner.0),
        b: body(outer_j, inner.1),
        constants,
    }))
}

fn rpr(i: BodyId, j: BodyId, constraints: &[Tie]) -> Option<Step> {
    if constraints.len() != 4 {
        return None;
    }
    let (outer_i, outer_j) = (outer_pin(i, j, constraints)?, outer_pin(j, i, constraints)?);
    // How the second turns with the first.
    let tied = (constraints.iter())
        .find(|c| c.constraint.unit() == Unit::Angle && c.touches(i) && c.touches(j));
    let Step::Turn {
        offset,
        input,
        reversed,
        ..
    } = tied?.constraint.turn(j, 0)?
    else {
        return None;
    };
    let reach = constraints
        .iter()
        .find_map(|c| match c.constraint.condition(i)? {
            Condition::Through { line, point } if point.body == j => {
                Some(Reach::PartnerPoint { line, point })
            }
            Condition::OnLine { own, line } if line.body == j => {
                Some(Reach::PartnerLine { point: own, line })
            }
            _ => None,
        })?;
    let partner = Some(Sliding {
        outer: outer_j.0,
        offset,
        input,
        reversed,
    });
    Some(Step::SwingLine(SwingLine {
        own: outer_i.0,
        at: outer_i.1,
        toward: outer_j.1,
        reach,
        partner,
    }))
}
