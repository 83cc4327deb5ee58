//! Blocks without a closed form: Newton's method on plain numbers or lanes of them, then carried over to richer ones.
//!
//! A block whose pins form a spanning tree (`tree`) is solved in the tree's coordinates (`loops`, `iterate`); what this
//! does not fit or cannot solve in the poses of all its bodies (`rows`, `plain`).

mod elimination;
mod interval;
mod iterate;
mod lanes;
mod loops;
mod plain;
mod rows;
mod tree;

#[cfg(test)]
mod tests;

pub use self::tree::SpanningTree;

use kempe_number::{Dual, Jet, Lanes, Number};

use self::elimination::{Matrix, Plain};
use self::iterate::Iteration;
use self::lanes::{lane_by_lane, lanes_together};
use self::plain::plain_newton;
use self::rows::{apply_step, fill_residuals};
use crate::Mechanism;
use crate::blocks::Unknown;
use crate::branch::Branch;
use crate::configuration::Configuration;
use crate::constraint::{Input, Situation};
use crate::design::Design;
use crate::geometry::Geometry;
use crate::plan::NewtonBlock;
use crate::pose::Pose;
use crate::qr::Qr;

/// Largest number of tree coordinates for which elimination runs on the stack, and in lanes.
pub(crate) const ON_STACK: usize = 8;

impl NewtonBlock {
    /// Its tree, if all lanes of a number can be solved at once in the coordinates of that.
    pub fn tree_in_lanes(&self) -> Option<&SpanningTree> {
        (self.tree.as_ref()).filter(|tree| tree.size() <= ON_STACK)
    }
}

/// A number a plan can run on: it knows how to solve a block that has no closed form.
pub trait PlanNumber: Number {
    /// Solves a block from the branch's guess; returns its determinant. What cannot be solved becomes NaN.
    fn solve_newton(
        block: &NewtonBlock,
        design: &Design<Self>,
        branch: &Branch,
        state: &mut Configuration<Self>,
    ) -> Self;
}

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
    [const N: usize] Jet<f64, N> = carry_over(N);
    [const K: usize, const N: usize] Jet<Dual<f64, K>, N> = carry_over(N + 1);
    [const K: usize] Dual<f64, K> = carry_over(1);
    [const W: usize, const N: usize] Jet<Lanes<W>, N> = lane_by_lane(N);
}

/// Solves on plain numbers, then makes the higher parts exact.
fn carry_over<T: PlanNumber>(
    block: &NewtonBlock,
    design: &Design<T>,
    branch: &Branch,
    state: &mut Configuration<T>,
    passes: usize,
) -> T {
    let mechanism = &*design.mechanism;
    let plain = &design.plain[0];
    let (determinant, tree) = plain_part(block, mechanism, plain, branch, state, T::value);
    for unknown in &block.unknowns {
        let body = unknown.body().index();
        let (rich, plain) = (&mut state.poses[body], &state.scratch.poses[body]);
        match unknown {
            Unknown::Angle(_) => (rich.c, rich.s) = (T::from_f64(plain.c), T::from_f64(plain.s)),
            Unknown::Place(_) => (rich.x, rich.y) = (T::from_f64(plain.x), T::from_f64(plain.y)),
        }
    }
    sharpen((block, tree), design, branch, state, passes, |row| row);
    T::from_f64(determinant)
}

/// Solves on the plain numbers that `part` takes out, into the plain poses of the scratch, whose matrix is then the plain
/// Jacobian there, factored: to the coordinates of the tree that is returned with the determinant, or to the poses.
fn plain_part<'b, T: Number>(
    block: &'b NewtonBlock,
    mechanism: &Mechanism,
    geometry: &Geometry<f64>,
    branch: &Branch,
    state: &mut Configuration<T>,
    part: impl Fn(T) -> f64,
) -> (f64, Option<&'b SpanningTree>) {
    let Configuration {
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
    let mut given = PlainState {
        mechanism,
        geometry,
        inputs: &scratch.inputs,
        branch,
        poses: &mut scratch.poses,
        points: &mut scratch.points,
        rhs: &mut scratch.rhs,
        qr: &mut scratch.qr,
        determinant: false,
    };
    match given.solve(block) {
        (_, Some(tree)) => (given.factor(tree), Some(tree)),
        solved => solved,
    }
}

/// A plain state and the storage to solve it with.
struct PlainState<'a> {
    mechanism: &'a Mechanism,
    geometry: &'a Geometry<f64>,
    inputs: &'a [Input<f64>],
    branch: &'a Branch,
    poses: &'a mut [Pose<f64>],
    points: &'a mut [[f64; 2]],
    rhs: &'a mut [f64],
    qr: &'a mut Qr,
    /// Whether the determinant is wanted.
    determinant: bool,
}

impl PlainState<'_> {
    /// Solves a block from the branch's guess; returns its determinant, and its tree if it was solved in the tree's
    /// coordinates. What cannot be solved becomes NaN.
    #[inline(never)]
    fn solve<'b>(&mut self, block: &'b NewtonBlock) -> (f64, Option<&'b SpanningTree>) {
        if let Some(tree) = &block.tree {
            let mut iteration = Iteration {
                tree,
                mechanism: self.mechanism,
                geometry: self.geometry,
                inputs: self.inputs,
                branch: self.branch,
                poses: self.poses,
                points: &mut self.points[..tree.points()],
                rhs: self.rhs,
                determinant: self.determinant,
            };
            let (determinant, lost) = if tree.size() <= ON_STACK {
                iteration.solve_on_stack()
            } else {
                iteration.rhs = &mut iteration.rhs[..tree.size()];
                iteration.solve(self.qr)
            };
            if !lost.any_positive() {
                return (determinant, Some(tree));
            }
        }
        let determinant = plain_newton(
            block,
            self.mechanism,
            self.geometry,
            self.inputs,
            self.branch,
            self.poses,
            self.qr,
            self.rhs,
        );
        (determinant, None)
    }

    /// Factors the Jacobian to a tree's coordinates where the bodies are; returns the block's determinant.
    fn factor(&mut self, tree: &SpanningTree) -> f64 {
        let situation = Situation {
            geometry: self.geometry,
            inputs: self.inputs,
            poses: self.poses,
            near: &self.branch.near,
        };
        self.qr.clear(tree.size());
        tree.linearise(self.mechanism, &situation, self.points, self.qr);
        self.qr.factor();
        self.qr.determinant() * tree.sign()
    }
}

/// Makes higher parts exact: with the inverse of the plain Jacobian last factored every pass of the simplified Newton
/// iteration x <- x - J0^-1 F(x) corrects one more order of a nilpotent number. `take` is what counts of a row.
fn sharpen<T: Number>(
    (block, tree): (&NewtonBlock, Option<&SpanningTree>),
    design: &Design<T>,
    branch: &Branch,
    state: &mut Configuration<T>,
    passes: usize,
    take: impl Fn(T) -> T,
) {
    let mechanism = &*design.mechanism;
    let Configuration {
        inputs,
        poses,
        scratch,
        ..
    } = state;
    let size = tree.map_or(block.rows.len(), SpanningTree::size);
    let rhs = &mut scratch.wide_rhs[..size];
    let points = &mut scratch.wide_points[..tree.map_or(0, SpanningTree::points)];
    for _ in 0..passes {
        if let Some(tree) = tree {
            tree.hang(&design.geometry, poses, points);
        }
        let situation = Situation {
            geometry: &design.geometry,
            inputs,
            poses,
            near: &branch.near,
        };
        match tree {
            Some(tree) => tree.residuals(mechanism, &situation, points, rhs),
            None => fill_residuals(block, mechanism, &situation, rhs),
        }
        rhs.iter_mut().for_each(|row| *row = take(*row));
        scratch.qr.solve(rhs);
        match tree {
            Some(tree) => tree.step(poses, rhs),
            None => apply_step(block, poses, &rhs[..block.size]),
        }
    }
    if let (Some(tree), true) = (tree, passes > 0) {
        tree.hang(&design.geometry, poses, points);
    }
}
