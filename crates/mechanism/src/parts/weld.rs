//! Welded links are one body.

use kempe_model::{JointKind, LinkId, Model};
use kempe_units::Expr;

use crate::ids::BodyId;
use crate::sources::LinkSeat;

/// Welded links become one body; the others are bodies of their own.
pub(super) fn seats(model: &Model) -> Vec<LinkSeat> {
    let mut seats: Vec<Option<LinkSeat>> = vec![None; model.links.len()];
    let mut next = 0;
    for start in 0..model.links.len() {
        if seats[start].is_some() {
            continue;
        }
        let body = BodyId(next);
        next += 1;
        seats[start] = Some(LinkSeat { body, weld: None });
        let mut stack = vec![LinkId(start as u32)];
        while let Some(at) = stack.pop() {
            for joint in &model.joints {
                let JointKind::Weld {
                    a,
                    b,
                    at: point,
                    angle,
                } = &joint.kind
                else {
                    continue;
                };
                let (other, angle) = if *a == at {
                    (*b, angle.clone())
                } else if *b == at {
                    (*a, Expr::Neg(Box::new(angle.clone())))
                } else {
                    continue;
                };
                if seats[other.index()].is_none() {
                    seats[other.index()] = Some(LinkSeat {
                        body,
                        weld: Some((at, *point, angle)),
                    });
                    stack.push(other);
                }
            }
        }
    }
    seats
        .into_iter()
        .map(|seat| {
            seat.unwrap_or(LinkSeat {
                body: BodyId::GROUND,
                weld: None,
            })
        })
        .collect()
}
