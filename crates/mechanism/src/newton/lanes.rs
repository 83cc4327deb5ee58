//! Blocks of several designs: solved in lanes, or lane by lane.

use kempe_linear::Plain;
use kempe_number::{Jet, Lanes, Number};

use super::carry_over::{plain_part, sharpen};
use super::iterate::Iteration;
use crate::blocks::Unknown;
use crate::branch::Branch;
use crate::configuration::Configuration;
use crate::design::Design;
use crate::plan::NewtonBlock;
use crate::spanning_tree::SpanningTree;

/// A number whose parts are lanes, so that one lane can be looked at alone.
pub(super) trait Laned<const W: usize>: Number {
    /// The plain value in a lane.
    fn plain(self, lane: usize) -> f64;

    /// The same with a plain constant in one lane.
    fn with_plain(self, lane: usize, value: f64) -> Self;

    /// Zero but for one lane.
    fn only(self, lane: usize) -> Self;
}

impl<const W: usize> Laned<W> for Lanes<W> {
    fn plain(self, lane: usize) -> f64 {
        self.0[lane]
    }

    fn with_plain(mut self, lane: usize, value: f64) -> Self {
        self.0[lane] = value;
        self
    }

    fn only(self, lane: usize) -> Self {
        Self::zero().with_plain(lane, self.0[lane])
    }
}

impl<const W: usize, const N: usize> Laned<W> for Jet<Lanes<W>, N> {
    fn plain(self, lane: usize) -> f64 {
        self.coefficient(0).0[lane]
    }

    fn with_plain(self, lane: usize, value: f64) -> Self {
        let part = |k| if k == 0 { value } else { 0.0 };
        Self::from_coefficients(std::array::from_fn(|k| {
            self.coefficient(k).with_plain(lane, part(k))
        }))
    }

    fn only(self, lane: usize) -> Self {
        Self::from_coefficients(std::array::from_fn(|k| self.coefficient(k).only(lane)))
    }
}

/// Solves all lanes of a block at once in the coordinates of its tree, and those that this cannot solve one by one.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn lanes_together<const W: usize>(
    tree: &SpanningTree,
    block: &NewtonBlock,
    design: &Design<Lanes<W>>,
    branch: &Branch,
    state: &mut Configuration<Lanes<W>>,
) -> Lanes<W> {
    let mechanism = &*design.mechanism;
    let scratch = &mut state.scratch;
    let mut iteration = Iteration {
        tree,
        mechanism,
        geometry: &design.geometry,
        inputs: &state.inputs,
        branch,
        poses: &mut state.poses,
        points: &mut scratch.wide_points[..tree.points()],
        rhs: &mut scratch.wide_rhs,
        determinant: scratch.determinants,
    };
    let (determinant, lost) = iteration.solve_on_stack();
    if lost.any_positive() {
        return solve_lost(block, design, branch, state, (determinant, lost));
    }
    determinant
}

/// Solves the lanes where `lost` is positive; the others have their determinants already.
#[cold]
#[inline(never)]
fn solve_lost<const W: usize>(
    block: &NewtonBlock,
    design: &Design<Lanes<W>>,
    branch: &Branch,
    state: &mut Configuration<Lanes<W>>,
    (mut determinant, lost): (Lanes<W>, Lanes<W>),
) -> Lanes<W> {
    for lane in (0..W).filter(|lane| lost.0[*lane] > 0.0) {
        determinant.0[lane] = solve_lane(block, design, branch, state, lane, 0);
    }
    determinant
}

/// Solves one lane after the other, each with as many passes for its higher parts.
#[inline(never)]
pub(super) fn lane_by_lane<T: Laned<W>, const W: usize>(
    block: &NewtonBlock,
    design: &Design<T>,
    branch: &Branch,
    state: &mut Configuration<T>,
    passes: usize,
) -> T {
    let mut determinant = T::from_f64(f64::NAN);
    for lane in 0..W {
        let found = solve_lane(block, design, branch, state, lane, passes);
        determinant = determinant.with_plain(lane, found);
    }
    determinant
}

/// Solves one lane; returns its determinant.
fn solve_lane<T: Laned<W>, const W: usize>(
    block: &NewtonBlock,
    design: &Design<T>,
    branch: &Branch,
    state: &mut Configuration<T>,
    lane: usize,
    passes: usize,
) -> f64 {
    let mechanism = &*design.mechanism;
    let part = |x: T| x.plain(lane);
    let Some(mut geometry) = state.scratch.geometry.take() else {
        return f64::NAN;
    };
    geometry.assign(&design.geometry, part);
    let (determinant, tree) = plain_part(block, mechanism, &geometry, branch, state, part);
    state.scratch.geometry = Some(geometry);
    let put = |to: &mut T, from: f64| *to = to.with_plain(lane, from);
    for unknown in &block.unknowns {
        let body = unknown.body().index();
        let (wide, plain) = (&mut state.poses[body], &state.scratch.poses[body]);
        match unknown {
            Unknown::Angle(_) => {
                put(&mut wide.c, plain.c);
                put(&mut wide.s, plain.s);
            }
            Unknown::Place(_) => {
                put(&mut wide.x, plain.x);
                put(&mut wide.y, plain.y);
            }
        }
    }
    // With this lane's Jacobian; the other lanes stay where they are.
    let only = |row: T| row.only(lane);
    sharpen((block, tree), design, branch, state, passes, only);
    determinant
}
