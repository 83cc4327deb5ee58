//! Blocks without a closed form: Newton's method on plain numbers, then carried over to richer ones.

mod interval;
mod lanes;
mod plain;
mod rows;

use kempe_number::{Dual, Jet, Lanes, Number};

use self::lanes::lane_by_lane;
use self::plain::plain_newton;
use self::rows::{apply_step, fill_residuals};
use crate::Mechanism;
use crate::blocks::Unknown;
use crate::constraint::Situation;
use crate::geometry::Geometry;
use crate::plan::NewtonBlock;
use crate::pose::Pose;
use crate::state::{Branch, Design, State};

/// A number a plan can run on: it knows how to solve a block that has no closed form.
pub trait PlanNumber: Number {
    /// Solves a block from the branch's guess; returns its determinant. What cannot be solved becomes NaN.
    fn solve_newton(
        block: &NewtonBlock,
        design: &Design<Self>,
        branch: &Branch,
        state: &mut State<Self>,
    ) -> Self;
}

impl PlanNumber for f64 {
    fn solve_newton(
        block: &NewtonBlock,
        design: &Design<f64>,
        branch: &Branch,
        state: &mut State<f64>,
    ) -> f64 {
        let mechanism = &*design.mechanism;
        let scratch = &mut state.scratch;
        plain_newton(
            block,
            mechanism,
            &design.geometry,
            &state.inputs,
            branch,
            &mut state.poses,
            &mut scratch.qr,
            &mut scratch.rhs,
        )
    }
}

/// Numbers whose block is solved elsewhere: `passes` more after the plain solve, or lane by lane.
macro_rules! plan_number {
    ($([$($generics:tt)*] $type:ty = $solve:ident($($more:expr),*);)*) => {$(
        impl<$($generics)*> PlanNumber for $type {
            fn solve_newton(
                block: &NewtonBlock,
                design: &Design<Self>,
                branch: &Branch,
                state: &mut State<Self>) -> Self {
                $solve(block, design, branch, state, $($more),*)
            }
        }
    )*};
}

// Every pass makes one more coefficient exact.
plan_number! {
    [const N: usize] Jet<f64, N> = carry_over(N);
    [const K: usize, const N: usize] Jet<Dual<f64, K>, N> = carry_over(N + 1);
    [const K: usize] Dual<f64, K> = carry_over(1);
    [const W: usize] Lanes<W> = lane_by_lane(0);
    [const W: usize, const N: usize] Jet<Lanes<W>, N> = lane_by_lane(N);
}

/// Solves on plain numbers, then makes the higher parts exact.
fn carry_over<T: PlanNumber>(
    block: &NewtonBlock,
    design: &Design<T>,
    branch: &Branch,
    state: &mut State<T>,
    passes: usize,
) -> T {
    let mechanism = &*design.mechanism;
    let plain = &design.plain[0];
    let determinant = plain_part(block, mechanism, plain, branch, state, T::value);
    for unknown in &block.unknowns {
        let body = unknown.body().index();
        let (rich, plain) = (&mut state.poses[body], &state.scratch.poses[body]);
        match unknown {
            Unknown::Angle(_) => (rich.c, rich.s) = (T::from_f64(plain.c), T::from_f64(plain.s)),
            Unknown::Place(_) => (rich.x, rich.y) = (T::from_f64(plain.x), T::from_f64(plain.y)),
        }
    }
    sharpen(block, design, branch, state, passes, |row| row);
    T::from_f64(determinant)
}

/// Solves on the plain numbers that `part` takes out, into the plain poses of the scratch; returns the determinant.
fn plain_part<T: Number>(
    block: &NewtonBlock,
    mechanism: &Mechanism,
    geometry: &Geometry<f64>,
    branch: &Branch,
    state: &mut State<T>,
    part: impl Fn(T) -> f64,
) -> f64 {
    let State {
        inputs,
        poses,
        scratch,
        ..
    } = state;
    for (plain, rich) in scratch.poses.iter_mut().zip(poses.iter()) {
        *plain = Pose {
            x: part(rich.x),
            y: part(rich.y),
            c: part(rich.c),
            s: part(rich.s),
        };
    }
    for (plain, rich) in scratch.inputs.iter_mut().zip(inputs.iter()) {
        (plain.value, plain.c, plain.s) = (part(rich.value), part(rich.c), part(rich.s));
    }
    plain_newton(
        block,
        mechanism,
        geometry,
        &scratch.inputs,
        branch,
        &mut scratch.poses,
        &mut scratch.qr,
        &mut scratch.rhs,
    )
}

/// Makes higher parts exact: with the inverse of the plain Jacobian last factored every pass of the simplified Newton
/// iteration x <- x - J0^-1 F(x) corrects one more order of a nilpotent number. `take` is what counts of a row.
fn sharpen<T: Number>(
    block: &NewtonBlock,
    design: &Design<T>,
    branch: &Branch,
    state: &mut State<T>,
    passes: usize,
    take: impl Fn(T) -> T,
) {
    let mechanism = &*design.mechanism;
    let State {
        inputs,
        poses,
        scratch,
        ..
    } = state;
    let rhs = &mut scratch.wide_rhs[..block.rows.len()];
    for _ in 0..passes {
        let situation = Situation {
            geometry: &design.geometry,
            inputs,
            poses,
            near: &branch.near,
        };
        fill_residuals(block, mechanism, &situation, rhs);
        rhs.iter_mut().for_each(|row| *row = take(*row));
        scratch.qr.solve(rhs);
        apply_step(block, poses, &rhs[..block.size]);
    }
}
