//! Blocks of several designs: solved in lanes, or lane by lane.

use kempe_linear::Plain;
use kempe_number::{Jet, Lanes, Number};

use super::carry_over::{plain_part, put_plain, sharpen};
use super::iterate::Iteration;
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

    /// The same with one lane of another.
    fn with(self, lane: usize, other: Self) -> Self;

    /// Zero but for one lane.
    fn only(self, lane: usize) -> Self {
        Self::zero().with(lane, self)
    }
}

impl<const W: usize> Laned<W> for Lanes<W> {
    fn plain(self, lane: usize) -> f64 {
        self.0[lane]
    }

    fn with_plain(mut self, lane: usize, value: f64) -> Self {
        self.0[lane] = value;
        self
    }

    fn with(self, lane: usize, other: Self) -> Self {
        self.with_plain(lane, other.0[lane])
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

    fn with(self, lane: usize, other: Self) -> Self {
        Self::from_coefficients(std::array::from_fn(|k| {
            self.coefficient(k).with(lane, other.coefficient(k))
        }))
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
        determinant.0[lane] = plain_lane(block, design, branch, state, lane).0;
    }
    determinant
}

/// Solves one lane after the other on plain numbers, then makes the higher parts of all exact in as many passes.
#[inline(never)]
pub(super) fn lane_by_lane<T: Laned<W>, const W: usize>(
    block: &NewtonBlock,
    design: &Design<T>,
    branch: &Branch,
    state: &mut Configuration<T>,
    passes: usize,
) -> T {
    let mut determinant = T::from_f64(f64::NAN);
    let mut by_tree = [false; W];
    for (lane, by_tree) in by_tree.iter_mut().enumerate() {
        let (found, tree) = plain_lane(block, design, branch, state, lane);
        determinant = determinant.with_plain(lane, found);
        *by_tree = tree.is_some();
        if let Some(own) = state.scratch.lane_qrs.get_mut(lane) {
            std::mem::swap(own, &mut state.scratch.qr);
        }
    }
    if passes == 0 {
        return determinant;
    }
    for tree in [block.tree.as_ref(), None] {
        // Those that were solved this way, each with its own Jacobian; the others stay where they are.
        let lanes = || (0..W).filter(|lane| by_tree[*lane] == tree.is_some());
        if lanes().next().is_none() {
            continue;
        }
        sharpen(
            (block, tree),
            design,
            branch,
            state,
            passes,
            |_, all, rhs| {
                let (solved, own) = all.room.split_at_mut(rhs.len());
                let own = &mut own[..rhs.len()];
                solved.fill(T::zero());
                for lane in lanes() {
                    for (own, row) in own.iter_mut().zip(rhs.iter()) {
                        *own = row.only(lane);
                    }
                    all.qrs[lane].solve(own);
                    for (solved, own) in solved.iter_mut().zip(own.iter()) {
                        *solved = solved.with(lane, *own);
                    }
                }
                rhs.copy_from_slice(solved);
            },
        );
    }
    determinant
}

/// Solves one lane on plain numbers; returns its determinant, and its tree if it was solved in the tree's coordinates.
fn plain_lane<'b, T: Laned<W>, const W: usize>(
    block: &'b NewtonBlock,
    design: &Design<T>,
    branch: &Branch,
    state: &mut Configuration<T>,
    lane: usize,
) -> (f64, Option<&'b SpanningTree>) {
    let mechanism = &*design.mechanism;
    let part = |x: T| x.plain(lane);
    let Some(mut geometry) = state.scratch.geometry.take() else {
        return (f64::NAN, None);
    };
    geometry.assign(&design.geometry, part);
    let found = plain_part(block, mechanism, &geometry, branch, state, part);
    state.scratch.geometry = Some(geometry);
    put_plain(block, state, |to, from| *to = to.with_plain(lane, from));
    found
}
