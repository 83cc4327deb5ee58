//! The equations of a spanning tree: where its bodies hang, how far its loops stand open, and the derivatives to its
//! coordinates.

use kempe_linear::Matrix;
use kempe_number::Number;

use crate::Mechanism;
use crate::constraint::Situation;
use crate::geometry::Geometry;
use crate::pose::{Pose, cross, left, sub};
use crate::spanning_tree::{OtherRow, SpanningTree};

impl SpanningTree {
    /// Places all bodies that hang by pins, and fills the points of the tree: its pins, the origins of its roots, and the
    /// tips of its loops.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn hang<T: Number>(
        &self,
        geometry: &Geometry<T>,
        poses: &mut [Pose<T>],
        points: &mut [[T; 2]],
    ) {
        let (pins, rest) = points.split_at_mut(self.hung.len());
        let (origins, tips) = rest.split_at_mut(self.roots.len());
        for (hung, pin) in self.hung.iter().zip(pins) {
            *pin = poses[hung.at.body.index()].place(geometry.marker(hung.at));
            let pose = &mut poses[hung.own.body.index()];
            *pose = Pose::pinned(pose.c, pose.s, geometry.marker(hung.own), *pin);
        }
        for (root, origin) in self.roots.iter().zip(origins) {
            let pose = &poses[root.index()];
            *origin = [pose.x, pose.y];
        }
        for (marker, tip) in self.tips.iter().zip(tips) {
            *tip = poses[marker.body.index()].place(geometry.marker(*marker));
        }
    }

    /// Fills the rows of the tree; `points` are those of [`SpanningTree::hang`].
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn residuals<T: Number>(
        &self,
        mechanism: &Mechanism,
        situation: &Situation<'_, T>,
        points: &[[T; 2]],
        rhs: &mut [T],
    ) {
        for closure in &self.closures {
            let [a, b] = closure.points;
            [rhs[closure.row], rhs[closure.row + 1]] = sub(points[b], points[a]);
        }
        for other in &self.others {
            let constraint = &mechanism.constraints[other.constraint].0;
            rhs[other.row] = situation.residual(constraint)[other.part];
        }
    }

    /// Adds the Jacobian of the rows to the coordinates of the tree to a matrix of zeros.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn linearise<T: Number>(
        &self,
        mechanism: &Mechanism,
        situation: &Situation<'_, T>,
        points: &[[T; 2]],
        matrix: &mut impl Matrix<T>,
    ) {
        for closure in &self.closures {
            for lever in &closure.levers {
                let [x, y] = left(sub(points[lever.to], points[lever.from]));
                matrix.add(closure.row, lever.column, x);
                matrix.add(closure.row + 1, lever.column, y);
            }
            for &(sign, column) in &closure.roots {
                matrix.add(closure.row, column, T::from_f64(sign));
                matrix.add(closure.row + 1, column + 1, T::from_f64(sign));
            }
        }
        if !self.others.is_empty() {
            self.linearise_others(mechanism, situation, points, matrix);
        }
    }

    /// [`SpanningTree::linearise`] for all other rows: the gradients to the poses, led on along the tree.
    fn linearise_others<T: Number>(
        &self,
        mechanism: &Mechanism,
        situation: &Situation<'_, T>,
        points: &[[T; 2]],
        matrix: &mut impl Matrix<T>,
    ) {
        for &OtherRow {
            constraint,
            part,
            row,
        } in &self.others
        {
            let constraint = &mechanism.constraints[constraint].0;
            situation.gradients(constraint, |gradient| {
                let reached = &self.reached[gradient.body.index()];
                let (Some(reached), true) = (reached, gradient.row == part) else {
                    return;
                };
                let [x, y, turn] = gradient.to;
                let along = |way: [T; 2]| cross(way, [x, y]);
                if let Some(column) = reached.angle {
                    // A body that hangs swings its origin about its pin.
                    matrix.add(
                        row,
                        column,
                        match reached.pin {
                            Some(pin) => {
                                let pose = &situation.poses[gradient.body.index()];
                                turn + along(sub([pose.x, pose.y], points[pin]))
                            }
                            None => turn,
                        },
                    );
                }
                for lever in &reached.levers {
                    matrix.add(
                        row,
                        lever.column,
                        along(sub(points[lever.to], points[lever.from])),
                    );
                }
                if let Some(column) = reached.root {
                    matrix.add(row, column, x);
                    matrix.add(row, column + 1, y);
                }
            });
        }
    }

    /// Takes a step off the coordinates of the tree; the bodies that hang stay where they were.
    pub(super) fn step<T: Number>(&self, poses: &mut [Pose<T>], step: &[T]) {
        for (body, step) in self.angles.iter().zip(step) {
            let pose = &mut poses[body.index()];
            *pose = pose.moved(T::zero(), T::zero(), -*step);
        }
        for (body, step) in self
            .places
            .iter()
            .zip(step[self.angles.len()..].chunks_exact(2))
        {
            let pose = &mut poses[body.index()];
            (pose.x, pose.y) = (pose.x - step[0], pose.y - step[1]);
        }
    }
}
