//! Blocks without a closed form: Newton's method on plain numbers or lanes of them, then carried over to richer ones.
//!
//! A block whose pins form a spanning tree (`spanning_tree.rs`) is solved in the tree's coordinates (`loops`, `iterate`); what this
//! does not fit or cannot solve in the poses of all its bodies (`rows`, `plain`).

mod carry_over;
mod interval;
mod iterate;
mod lanes;
mod loops;
mod plain;
mod rows;

#[cfg(test)]
mod tests;

use std::any::Any;

use kempe_number::{Dual, Jet, Lanes, Number};

use self::carry_over::{PlainState, carry_over};
use self::lanes::{lane_by_lane, lanes_together};
use crate::bound_dyad::BoundDyad;
use crate::branch::Branch;
use crate::configuration::Configuration;
use crate::design::Design;
use crate::plan::NewtonBlock;
use crate::plan_number::PlanNumber;

impl PlanNumber for f64 {
    fn solve_newton(
        block: &NewtonBlock,
        design: &Design<f64>,
        branch: &Branch,
        state: &mut Configuration<f64>,
    ) -> f64 {
        let mechanism = &*design.mechanism;
        let scratch = &mut state.scratch;
        let mut given = PlainState {
            mechanism,
            geometry: &design.geometry,
            inputs: &state.inputs,
            branch,
            poses: &mut state.poses,
            points: &mut scratch.points,
            rhs: &mut scratch.rhs,
            qr: &mut scratch.qr,
            determinant: scratch.determinants,
        };
        given.solve(block).0
    }

    #[inline(never)]
    fn solve_plan(design: &Design<f64>, branch: &Branch, state: &mut Configuration<f64>) {
        design.run_plan(branch, state);
    }
}

impl<const W: usize> PlanNumber for Lanes<W> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn solve_newton(
        block: &NewtonBlock,
        design: &Design<Self>,
        branch: &Branch,
        state: &mut Configuration<Self>,
    ) -> Self {
        match block.tree_in_lanes() {
            Some(tree) => lanes_together(tree, block, design, branch, state),
            None => lane_by_lane(block, design, branch, state, 0),
        }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn solve_common(
        dyad: &BoundDyad<'_, Self>,
        states: &mut [Configuration<Self>],
        sign: f64,
    ) -> bool {
        match W {
            8 => dyad.solve_parts::<2>(states, sign),
            16 => dyad.solve_parts::<4>(states, sign),
            _ => false,
        }
    }
}

impl<const N: usize> PlanNumber for Jet<f64, N> {
    // Every pass makes one more coefficient exact.
    fn solve_newton(
        block: &NewtonBlock,
        design: &Design<Self>,
        branch: &Branch,
        state: &mut Configuration<Self>,
    ) -> Self {
        carry_over(block, design, branch, state, N)
    }

    /// Series with one or two derivatives are solved on in many crates: their solution is compiled here, the others' where they
    /// are asked for.
    fn solve_plan(design: &Design<Self>, branch: &Branch, state: &mut Configuration<Self>) {
        if !solve_here::<Self, 3>(design, branch, state)
            && !solve_here::<Self, 2>(design, branch, state)
        {
            design.run_plan(branch, state);
        }
    }
}

/// Solves a plan on series of this length, if the number is one.
#[inline]
fn solve_here<T: Number, const N: usize>(
    design: &Design<T>,
    branch: &Branch,
    state: &mut Configuration<T>,
) -> bool {
    let series = (design as &dyn Any).downcast_ref();
    match (series, (state as &mut dyn Any).downcast_mut()) {
        (Some(design), Some(state)) => {
            solve_series::<N>(design, branch, state);
            true
        }
        _ => false,
    }
}

#[inline(never)]
fn solve_series<const N: usize>(
    design: &Design<Jet<f64, N>>,
    branch: &Branch,
    state: &mut Configuration<Jet<f64, N>>,
) {
    design.run_plan(branch, state);
}

/// Numbers whose block is solved elsewhere: `passes` more after the plain solve, or lane by lane.
macro_rules! plan_number {
    ($([$($generics:tt)*] $type:ty = $solve:ident($($more:expr),*);)*) => {$(
        impl<$($generics)*> PlanNumber for $type {
            fn solve_newton(
                block: &NewtonBlock,
                design: &Design<Self>,
                branch: &Branch,
                state: &mut Configuration<Self>) -> Self {
                $solve(block, design, branch, state, $($more),*)
            }
        }
    )*};
}

// Every pass makes one more coefficient exact.
plan_number! {
    [const K: usize, const N: usize] Jet<Dual<f64, K>, N> = carry_over(N + 1);
    [const K: usize] Dual<f64, K> = carry_over(1);
    [const W: usize, const N: usize] Jet<Lanes<W>, N> = lane_by_lane(N);
}
