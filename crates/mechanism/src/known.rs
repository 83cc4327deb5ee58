//! What a step looks up in a design once, before it solves many states.

use kempe_number::Number;

use crate::closed_form::{DYAD_CONSTANTS, dyad};
use crate::plan::{Dyad, DyadBody};
use crate::pose::{Pose, cross, dot, sub};
use crate::state::{Design, State};
use crate::structure::{Marker, Spot};

/// A marker with its coordinates in its body.
#[derive(Clone, Copy)]
pub(crate) struct Known<'d, T> {
    body: usize,
    spot: Spot,
    p: &'d [T; 2],
}

impl<'d, T: Number> Known<'d, T> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn new(design: &'d Design<T>, marker: Marker) -> Self {
        Self {
            body: marker.body.index(),
            spot: marker.spot,
            p: &design.geometry.markers[marker.index as usize],
        }
    }

    /// Its place in the frame.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn place(&self, poses: &[Pose<T>]) -> [T; 2] {
        if self.spot == Spot::Frame {
            return *self.p;
        }
        let (pose, p) = (&poses[self.body], self.p);
        match self.spot {
            Spot::Origin => [pose.x, pose.y],
            Spot::Axis => [pose.x + pose.c * p[0], pose.y + pose.s * p[0]],
            Spot::Frame | Spot::Anywhere => pose.place(*p),
        }
    }

    /// Where the origin of its body is with this direction, when it lies at `world`.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn origin(&self, [c, s]: [T; 2], world: [T; 2]) -> [T; 2] {
        let p = self.p;
        match self.spot {
            Spot::Origin => world,
            Spot::Axis => [world[0] - c * p[0], world[1] - s * p[0]],
            Spot::Frame | Spot::Anywhere => {
                let pose = Pose::pinned(c, s, *p, world);
                [pose.x, pose.y]
            }
        }
    }

    fn on_axis(&self) -> bool {
        matches!(self.spot, Spot::Origin | Spot::Axis)
    }
}

/// One body of a dyad in a design.
struct Side<'d, T> {
    body: usize,
    outer: Known<'d, T>,
    at: Known<'d, T>,
    /// Both pins lie on the body's x axis.
    on_axis: bool,
    wanted: bool,
}

impl<'d, T: Number> Side<'d, T> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn new(design: &'d Design<T>, body: &DyadBody) -> Self {
        let (outer, inner) = (
            Known::new(design, body.outer),
            Known::new(design, body.inner),
        );
        Self {
            body: inner.body,
            outer,
            at: Known::new(design, body.at),
            on_axis: outer.on_axis() && inner.on_axis(),
            wanted: body.wanted,
        }
    }

    /// The pose when the vector between the pins is seen as `seen` and the outer pin is at `world`; `own` is the
    /// vector in the body over its square.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn pose(&self, own: [T; 2], seen: [T; 2], world: [T; 2]) -> Pose<T> {
        let direction = match self.on_axis {
            true => [own[0] * seen[0], own[0] * seen[1]],
            false => [dot(own, seen), cross(own, seen)],
        };
        let [x, y] = self.outer.origin(direction, world);
        let [c, s] = direction;
        Pose { x, y, c, s }
    }
}

/// An RRR dyad in a design.
pub(crate) struct DyadOf<'d, T> {
    a: Side<'d, T>,
    b: Side<'d, T>,
    constants: &'d [T; DYAD_CONSTANTS],
}

impl<'d, T: Number> DyadOf<'d, T> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn new(design: &'d Design<T>, step: &Dyad) -> Self {
        Self {
            a: Side::new(design, &step.a),
            b: Side::new(design, &step.b),
            constants: &design.constants[step.constants],
        }
    }

    /// Places those of its bodies that are wanted; returns the determinant.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn solve(&self, state: &mut State<T>, sign: f64) -> T {
        let Self { a, b, constants: k } = self;
        let poses = &mut state.poses[..];
        let (wa, wb) = (a.at.place(poses), b.at.place(poses));
        let (da, db, h) = dyad(k, sub(wb, wa), sign);
        if a.wanted {
            poses[a.body] = a.pose([k[0], k[1]], da, wa);
        }
        if b.wanted {
            poses[b.body] = b.pose([k[2], k[3]], db, wb);
        }
        h
    }
}
