//! Closed forms of groups some of whose pins are let go and stand open.
//!
//! A pin that is open by a vector is closed for one of its bodies moved by that vector, with its angle. So a group is solved
//! as if its pins held: seen from there the points at which it is pinned to what is placed are off, and one of its bodies is.

use kempe_model::DriveId;
use kempe_number::Number;

use crate::bound_dyad::BoundDyad;
use crate::branch::Branch;
use crate::configuration::Configuration;
use crate::constraint::{Constraint, Input, Joint, Opened};
use crate::design::Design;
use crate::ids::{BodyId, Marker};
use crate::pinned_group::{swing, swing_line};
use crate::plan::Step;
use crate::pose::{Pose, add};
use crate::solve::pin_twice;

/// How far a point stands off, m along the frame's axes: by coordinates of drives, forwards or backwards.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shift([Option<Opening>; 2]);

/// How far a pin stands open.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Opening {
    along: [DriveId; 2],
    sign: f64,
}

impl Shift {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn value<T: Number>(&self, inputs: &[Input<T>]) -> [T; 2] {
        let mut sum = [T::zero(); 2];
        for opening in self.0.iter().flatten() {
            let open = opening.along.map(|drive| inputs[drive.index()].value);
            sum = add(sum, open.map(|q| q * opening.sign));
        }
        sum
    }
}

/// A group whose pins stand open.
#[derive(Clone, Debug)]
pub struct Apart {
    /// How it is solved where they do not.
    pub closed: Step,
    /// By how much the placed points are off at which it is pinned, in the order in which the step names them.
    at: [Shift; 2],
    /// A body that is off from where the closed group has it, and by how much.
    moved: Option<(BodyId, Shift)>,
}

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

/// Solves such a group; returns the determinant of the closed one.
#[inline(never)]
pub(crate) fn solve<T: Number>(
    design: &Design<T>,
    branch: &Branch,
    state: &mut Configuration<T>,
    step: &Apart,
    sign: f64,
) -> T {
    let off = step.at.map(|shift| shift.value(&state.inputs));
    let determinant = match &step.closed {
        &Step::Pin { own, at } => {
            let world = add(state.place(design, at), off[0]);
            let pose = &mut state.poses[own.body.index()];
            *pose = Pose::pinned(pose.c, pose.s, design.geometry.marker(own), world);
            T::one()
        }
        &Step::TwoPins { a, at_a, b, at_b } => {
            pin_twice(design, state, [(a, at_a), (b, at_b)], Some(off))
        }
        Step::Swing(it) => swing::<T, true>(design, branch, state, it, sign, Some(off[0])),
        Step::SwingLine(it) => swing_line::<T, true>(design, state, it, sign, Some(off)),
        Step::Dyad(it) => BoundDyad::new(design, it).solve(state, sign, Some(off)),
        _ => T::from_f64(f64::NAN),
    };
    if let Some((body, shift)) = &step.moved {
        let [x, y] = shift.value(&state.inputs);
        let pose = &mut state.poses[body.index()];
        (pose.x, pose.y) = (pose.x - x, pose.y - y);
    }
    determinant
}
