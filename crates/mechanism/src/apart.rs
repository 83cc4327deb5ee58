//! Groups some of whose pins are let go and stand open: the closed form that they have if their pins hold, and what stands off.

use kempe_model::DriveId;

use crate::constraint::{Constraint, Joint, Opened};
use crate::ids::{BodyId, Marker};
use crate::step::{Apart, Opening, Shift, Step};

/// A constraint as closed forms see it, or both rows of a pin that is let go as the pin that it is.
#[derive(Clone, Copy)]
pub(crate) struct Tie<'m> {
    pub constraint: &'m Constraint,
    open: Option<([Marker; 2], [DriveId; 2])>,
}

impl<'m> Tie<'m> {
    /// The ties of these constraints; `None` where a pin is let go in one of its rows only.
    pub fn all(constraints: &[&'m Constraint]) -> Option<Vec<Self>> {
        let opened: Vec<Option<Opened>> = constraints.iter().map(|c| c.opened()).collect();
        let other = |one: &Opened| {
            let is_other = |it: &&Opened| it.pin == one.pin && it.row != one.row;
            opened.iter().flatten().find(is_other)
        };
        let mut ties = Vec::new();
        for (constraint, opened) in constraints.iter().copied().zip(&opened) {
            let open = match opened {
                None => None,
                Some(first) => {
                    let second = other(first)?;
                    if first.row != 0 {
                        continue;
                    }
                    Some((first.pin, [first.input, second.input]))
                }
            };
            ties.push(Self { constraint, open });
        }
        Some(ties)
    }

    /// As a pin of a body: its own point and the other.
    pub fn pin(&self, body: BodyId) -> Option<(Marker, Marker)> {
        match self.open {
            None => self.constraint.pin(body),
            Some(([a, b], _)) if a.body == body => Some((a, b)),
            Some(([a, b], _)) if b.body == body => Some((b, a)),
            Some(_) => None,
        }
    }

    /// Whether it ties a body.
    pub fn touches(&self, body: BodyId) -> bool {
        self.constraint.bodies().any(|b| b == body)
    }
}

/// By how much a body's own point stands off another's in this pin; nothing where the pin holds.
fn opening(ties: &[Tie], own: Marker, at: Marker) -> Option<Opening> {
    ties.iter().find_map(|tie| {
        let ([a, b], along) = tie.open?;
        let sign = if (a, b) == (at, own) {
            1.0
        } else if (a, b) == (own, at) {
            -1.0
        } else {
            return None;
        };
        Some(Opening { along, sign })
    })
}

/// The step of a group that is solved by `closed` where its pins hold; `None` where no closed form is known.
pub(crate) fn of(closed: Step, ties: &[Tie]) -> Option<Step> {
    if ties.iter().all(|tie| tie.open.is_none()) {
        return Some(closed);
    }
    let off = |own, at| Shift([opening(ties, own, at), None]);
    let mut it = Apart {
        at: [Shift::default(); 2],
        moved: None,
        closed,
    };
    match &it.closed {
        &Step::Pin { own, at } => it.at[0] = off(own, at),
        &Step::TwoPins { a, at_a, b, at_b } => it.at = [off(a, at_a), off(b, at_b)],
        Step::Swing(swing) => {
            // The partner stays where its condition has it; what is pinned to it is moved there.
            let moved = (swing.partner.and_then(|partner| partner.pin))
                .and_then(|pin| opening(ties, pin, swing.tip));
            it.at[0] = Shift([opening(ties, swing.own, swing.at), moved]);
            it.moved = moved.map(|by| (swing.own.body, Shift([Some(by), None])));
        }
        Step::SwingLine(swing) => {
            it.at[0] = off(swing.own, swing.at);
            if let Some(partner) = swing.partner {
                it.at[1] = off(partner.outer, swing.toward);
            }
        }
        Step::Dyad(dyad) => {
            let moved = opening(ties, dyad.b.inner, dyad.a.inner);
            it.at = [
                Shift([opening(ties, dyad.a.outer, dyad.a.at), moved]),
                off(dyad.b.outer, dyad.b.at),
            ];
            it.moved = moved.map(|by| (dyad.a.inner.body, Shift([Some(by), None])));
        }
        _ => return None,
    }
    Some(Step::Apart(Box::new(it)))
}
