//! What constraints are evaluated with, and where their points and lines are then.

use kempe_number::Number;

use crate::geometry::Geometry;
use crate::ids::{BodyId, LineRef, Marker};
use crate::pose::Pose;

/// A drive's coordinate, with the unit vector of that angle for drives that turn.
#[derive(Clone, Copy, Debug)]
pub struct Input<T> {
    /// Cosine (only meaningful for turning drives).
    pub c: T,
    /// Sine.
    pub s: T,
    /// The coordinate, SI.
    pub value: T,
}

impl<T: Number> Input<T> {
    /// A turning drive at `value` rad.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn turn(value: T) -> Self {
        let (s, c) = value.sin_cos();
        Self { value, c, s }
    }

    /// A drive along a length, at `value` m.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn length(value: T) -> Self {
        Self {
            value,
            c: T::one(),
            s: T::zero(),
        }
    }

    /// The plain values.
    #[inline]
    pub fn plain(&self) -> Input<f64> {
        Input {
            value: self.value.value(),
            c: self.c.value(),
            s: self.s.value(),
        }
    }
}

/// Everything a residual needs: dimensions, drives, poses and the turn count of every body.
pub struct Situation<'a, T> {
    /// Dimensions.
    pub geometry: &'a Geometry<T>,
    /// Coordinates of the drives.
    pub inputs: &'a [Input<T>],
    /// Poses of the bodies.
    pub poses: &'a [Pose<T>],
    /// Angles of the bodies to within half a turn, rad: gears count turns.
    pub near: &'a [f64],
}

impl<T: Number> Situation<'_, T> {
    /// A marker in the frame.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn place(&self, marker: Marker) -> [T; 2] {
        self.poses[marker.body.index()].place(self.geometry.marker(marker))
    }

    /// Origin and unit direction of a line in the frame.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn line(&self, line: LineRef) -> ([T; 2], [T; 2]) {
        match T::IN_PLACE {
            true => self.line_in_place(line),
            false => self.line_called(line),
        }
    }

    #[inline(never)]
    fn line_called(&self, line: LineRef) -> ([T; 2], [T; 2]) {
        self.line_in_place(line)
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn line_in_place(&self, line: LineRef) -> ([T; 2], [T; 2]) {
        let local = self.geometry.line(line);
        let pose = &self.poses[line.body.index()];
        (pose.place(local.origin), pose.turn(local.direction))
    }

    /// Unwrapped angle of a body, rad.
    #[inline]
    pub fn angle(&self, body: BodyId) -> T {
        self.poses[body.index()].angle_near(self.near[body.index()])
    }

    /// From a body's origin to one of its own points, along the frame's axes (intervals stay narrow without the detour
    /// over the frame).
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn arm(&self, marker: Marker) -> [T; 2] {
        self.poses[marker.body.index()].turn(self.geometry.marker(marker))
    }

    /// From a body's origin to any place of the frame.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn arm_to(&self, body: BodyId, place: [T; 2]) -> [T; 2] {
        let pose = &self.poses[body.index()];
        [place[0] - pose.x, place[1] - pose.y]
    }
}
