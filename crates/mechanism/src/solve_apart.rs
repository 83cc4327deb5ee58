//! Closed forms of groups some of whose pins are let go and stand open.
//!
//! A pin that is open by a vector is closed for one of its bodies moved by that vector, with its angle. So a group is solved
//! as if its pins held: seen from there the points at which it is pinned to what is placed are off, and one of its bodies is.

use kempe_number::Number;

use crate::bound_dyad::BoundDyad;
use crate::branch::Branch;
use crate::configuration::Configuration;
use crate::constraint::Input;
use crate::design::Design;
use crate::pinned_group::{pin_twice, swing, swing_line};
use crate::pose::{Pose, add};
use crate::step::{Apart, Shift, Step};

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

/// Solves such a group; returns the determinant of the closed one.
#[inline(never)]
pub(crate) fn solve_apart<T: Number>(
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
