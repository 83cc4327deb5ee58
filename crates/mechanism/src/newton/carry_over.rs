//! Newton blocks on plain numbers, and from there on richer ones.

use kempe_linear::{Matrix, Plain, Qr};
use kempe_number::Number;

use super::iterate::Iteration;
use super::plain::plain_newton;
use super::rows::{apply_step, fill_residuals};
use crate::Mechanism;
use crate::blocks::Unknown;
use crate::branch::Branch;
use crate::configuration::Configuration;
use crate::constraint::{Input, Situation};
use crate::design::Design;
use crate::geometry::Geometry;
use crate::plan::NewtonBlock;
use crate::plan_number::PlanNumber;
use crate::pose::Pose;
use crate::spanning_tree::{ON_STACK, SpanningTree};

/// Solves on plain numbers, then makes the higher parts exact.
pub(super) fn carry_over<T: PlanNumber>(
    block: &NewtonBlock,
    design: &Design<T>,
    branch: &Branch,
    state: &mut Configuration<T>,
    passes: usize,
) -> T {
    let mechanism = &*design.mechanism;
    let plain = &design.plain[0];
    let (determinant, tree) = plain_part(block, mechanism, plain, branch, state, T::value);
    put_plain(block, state, |rich, plain| *rich = T::from_f64(plain));
    sharpen(
        (block, tree),
        design,
        branch,
        state,
        passes,
        |qr, _, rhs| {
            qr.solve(rhs);
        },
    );
    T::from_f64(determinant)
}

/// Puts the plain poses of the scratch in the places of a block's unknowns.
pub(super) fn put_plain<T: Number>(
    block: &NewtonBlock,
    state: &mut Configuration<T>,
    put: impl Fn(&mut T, f64),
) {
    for unknown in &block.unknowns {
        let body = unknown.body().index();
        let (rich, plain) = (&mut state.poses[body], &state.scratch.poses[body]);
        match unknown {
            Unknown::Angle(_) => {
                put(&mut rich.c, plain.c);
                put(&mut rich.s, plain.s);
            }
            Unknown::Place(_) => {
                put(&mut rich.x, plain.x);
                put(&mut rich.y, plain.y);
            }
        }
    }
}

/// Solves on the plain numbers that `part` takes out, into the plain poses of the scratch, whose matrix is then the plain
/// Jacobian there, factored: to the coordinates of the tree that is returned with the determinant, or to the poses.
pub(super) fn plain_part<'b, T: Number>(
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
pub(super) struct PlainState<'a> {
    pub mechanism: &'a Mechanism,
    pub geometry: &'a Geometry<f64>,
    pub inputs: &'a [Input<f64>],
    pub branch: &'a Branch,
    pub poses: &'a mut [Pose<f64>],
    pub points: &'a mut [[f64; 2]],
    pub rhs: &'a mut [f64],
    pub qr: &'a mut Qr,
    /// Whether the determinant is wanted.
    pub determinant: bool,
}

impl PlainState<'_> {
    /// Solves a block from the branch's guess; returns its determinant, and its tree if it was solved in the tree's
    /// coordinates. What cannot be solved becomes NaN.
    #[inline(never)]
    pub(super) fn solve<'b>(&mut self, block: &'b NewtonBlock) -> (f64, Option<&'b SpanningTree>) {
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

/// Factored Jacobians of the lanes, with room for a solution and for what is solved of one lane.
pub(super) struct LaneSystems<'a, T> {
    pub qrs: &'a [Qr],
    pub room: &'a mut [T],
}

/// Makes higher parts exact: with the inverse of the plain Jacobian J0 every pass of the simplified Newton iteration x <- x - J0^-1 F(x) corrects one more
/// order of a nilpotent number. `correct` multiplies what it is given by that inverse: of the Jacobian last factored, or of those of lanes.
pub(super) fn sharpen<T: Number>(
    (block, tree): (&NewtonBlock, Option<&SpanningTree>),
    design: &Design<T>,
    branch: &Branch,
    state: &mut Configuration<T>,
    passes: usize,
    correct: impl Fn(&Qr, LaneSystems<'_, T>, &mut [T]),
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
        let lanes = LaneSystems {
            qrs: &scratch.lane_qrs,
            room: &mut scratch.lane_rhs,
        };
        correct(&scratch.qr, lanes, rhs);
        match tree {
            Some(tree) => tree.step(poses, rhs),
            None => apply_step(block, poses, &rhs[..block.size]),
        }
    }
    if let (Some(tree), true) = (tree, passes > 0) {
        tree.hang(&design.geometry, poses, points);
    }
}
