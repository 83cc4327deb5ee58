//! Newton's method in the coordinates of a spanning tree, on plain numbers or in lanes.

use kempe_linear::{Elimination, Matrix, Plain};
use kempe_number::Number;

use super::plain::{NEWTON_LIMIT, NEWTON_STEP};
use crate::Mechanism;
use crate::branch::Branch;
use crate::constraint::{Input, Situation};
use crate::geometry::Geometry;
use crate::pose::Pose;
use crate::spanning_tree::{ON_STACK, SpanningTree};

/// What Newton's method on a tree works on and with.
pub(super) struct Iteration<'a, P> {
    pub tree: &'a SpanningTree,
    pub mechanism: &'a Mechanism,
    pub geometry: &'a Geometry<P>,
    pub inputs: &'a [Input<P>],
    pub branch: &'a Branch,
    pub poses: &'a mut [Pose<P>],
    /// As many as the tree has.
    pub points: &'a mut [[P; 2]],
    /// As many as the matrix has rows.
    pub rhs: &'a mut [P],
    /// Whether the determinant is wanted.
    pub determinant: bool,
}

/// Steps with a matrix after the first.
const SAME_MATRIX: usize = 2;
/// Largest scaled step after which another with the same matrix is worth it.
const NEAR: f64 = 0.05;
/// What a scaled step may still leave out: half a unit in the last place of one.
const LAST_DIGIT: f64 = 0.5 * f64::EPSILON;

impl<P: Plain> Iteration<'_, P> {
    /// [`Iteration::solve`] with a matrix on the stack, for trees of at most [`ON_STACK`] coordinates and a right-hand side
    /// of as many rows.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn solve_on_stack(&mut self) -> (P, P) {
        match self.tree.size {
            0..=2 if P::UNROLLED > 0 => self.solve_sized::<2>(),
            0..=4 => self.solve_sized::<4>(),
            5 | 6 if P::UNROLLED > 0 => self.solve_sized::<6>(),
            _ => self.solve_sized::<ON_STACK>(),
        }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn solve_sized<const N: usize>(&mut self) -> (P, P) {
        let Iteration {
            tree,
            mechanism,
            geometry,
            inputs,
            branch,
            ref mut poses,
            ref mut points,
            ref mut rhs,
            determinant,
        } = *self;
        let mut sized = Iteration {
            tree,
            mechanism,
            geometry,
            inputs,
            branch,
            poses,
            points,
            rhs: &mut rhs[..N],
            determinant,
        };
        sized.solve(&mut Elimination::<P, N>::storage())
    }

    /// Solves from the branch's guess. Returns the determinant, and a number that is positive where the iteration did not
    /// converge: the poses there are of no use.
    ///
    /// Every matrix serves for [`SAME_MATRIX`] more steps, which near the solution gain about as much each as the first
    /// one did. Every lane takes the steps that it would take alone: one that has converged waits for the others.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn solve(&mut self, matrix: &mut impl Matrix<P>) -> (P, P) {
        let (zero, one) = (P::zero(), P::one());
        self.start();
        let (mut open, mut lost) = (one, zero);
        for _ in 0..NEWTON_LIMIT {
            self.hang();
            self.factor(matrix);
            self.solve_step(matrix);
            let mut size = self.step_size();
            // What is not finite is not below any limit.
            let finite = P::from_f64(f64::MAX) - size;
            lost = P::where_positive(open, P::where_positive(finite, lost, one), lost);
            open = P::where_positive(finite, open, zero);
            self.take_step(open);
            for _ in 0..SAME_MATRIX {
                let near = P::where_positive(P::from_f64(NEAR) - size, open, zero);
                if !near.any_positive() {
                    break;
                }
                self.hang();
                self.solve_step(matrix);
                self.take_step(near);
                let before = size;
                size = P::where_positive(near, self.step_size(), before);
                // Converged: the step before was small, so this one was the one more; or this one is, and by what it gained
                // on the one before the next is beyond the last digit.
                let small = P::from_f64(NEWTON_STEP);
                let next = P::from_f64(LAST_DIGIT) * before - size * size;
                let gained = P::where_positive(small - size, next, zero);
                let done = P::where_positive(small - before, one, gained);
                open = P::where_positive(P::where_positive(near, done, zero), zero, open);
            }
            if !open.any_positive() {
                break;
            }
        }
        let lost = P::where_positive(open, one, lost);
        self.hang();
        if !self.determinant || lost.any_positive() && !P::IN_LANES {
            return (P::from_f64(f64::NAN), lost);
        }
        self.factor(matrix);
        (matrix.determinant() * self.tree.sign, lost)
    }

    /// Puts the tree's coordinates where the branch guesses them.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn start(&mut self) {
        // Rows that only make up a size stay zero.
        self.rhs[self.tree.size..].fill(P::zero());
        for body in &self.tree.angles {
            let (pose, guess) = (
                &mut self.poses[body.index()],
                &self.branch.guess[body.index()],
            );
            (pose.c, pose.s) = (P::from_f64(guess.c), P::from_f64(guess.s));
        }
        for body in &self.tree.places {
            let (pose, guess) = (
                &mut self.poses[body.index()],
                &self.branch.guess[body.index()],
            );
            (pose.x, pose.y) = (P::from_f64(guess.x), P::from_f64(guess.y));
        }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn hang(&mut self) {
        self.tree.hang(self.geometry, self.poses, self.points);
    }

    /// Fills the matrix and factors it, the bodies hanging.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn factor(&mut self, matrix: &mut impl Matrix<P>) {
        matrix.clear(self.tree.size);
        let situation = Situation {
            geometry: self.geometry,
            inputs: self.inputs,
            poses: self.poses,
            near: &self.branch.near,
        };
        (self.tree).linearise(self.mechanism, &situation, self.points, matrix);
        matrix.factor();
    }

    /// Fills the right-hand side, the bodies hanging, and solves for the step.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn solve_step(&mut self, matrix: &impl Matrix<P>) {
        let situation = Situation {
            geometry: self.geometry,
            inputs: self.inputs,
            poses: self.poses,
            near: &self.branch.near,
        };
        (self.tree).residuals(self.mechanism, &situation, self.points, self.rhs);
        matrix.solve(self.rhs);
    }

    /// Largest part of the step: angles in rad, lengths against the largest coordinate.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn step_size(&self) -> P {
        let (angles, lengths) = self.rhs.split_at(self.tree.angles.len());
        let mut size = P::zero();
        for step in angles {
            size = size.max(step.abs());
        }
        if self.tree.places.is_empty() {
            return size;
        }
        let (mut length, mut reach) = (P::zero(), self.geometry.least_reach());
        for (body, step) in self.tree.places.iter().zip(lengths.chunks_exact(2)) {
            let pose = &self.poses[body.index()];
            length = length.max(step[0].abs()).max(step[1].abs());
            reach = reach.max(pose.x.abs()).max(pose.y.abs());
        }
        size.max(length / reach)
    }

    /// Takes the step off the tree's coordinates where `open` is positive.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn take_step(&mut self, open: P) {
        let (angles, lengths) = self.rhs.split_at(self.tree.angles.len());
        for (body, step) in self.tree.angles.iter().zip(angles) {
            let pose = &mut self.poses[body.index()];
            let [c, s] = turned([pose.c, pose.s], *step);
            (pose.c, pose.s) = (
                P::where_positive(open, c, pose.c),
                P::where_positive(open, s, pose.s),
            );
        }
        for (body, step) in self.tree.places.iter().zip(lengths.chunks_exact(2)) {
            let pose = &mut self.poses[body.index()];
            (pose.x, pose.y) = (
                P::where_positive(open, pose.x - step[0], pose.x),
                P::where_positive(open, pose.y - step[1], pose.y),
            );
        }
    }
}

/// A direction turned back by 2 atan(step / 2): the step to third order, never more than half a turn, and without a sine.
#[cfg_attr(not(debug_assertions), inline(always))]
fn turned<P: Number>([c, s]: [P; 2], step: P) -> [P; 2] {
    let half = step * 0.5;
    let square = half * half;
    let scale = P::one() / (square + 1.0);
    let (cosine, sine) = ((P::one() - square) * scale, step * scale);
    let (x, y) = (c * cosine + s * sine, s * cosine - c * sine);
    // Kept a unit vector against rounding: the first step of the root's iteration.
    let keep = (x * x + y * y) * -0.5 + 1.5;
    [x * keep, y * keep]
}
