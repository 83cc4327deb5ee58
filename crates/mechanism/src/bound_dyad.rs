//! An RRR dyad of a design, bound to its markers once before many configurations are solved.

use kempe_number::Number;

use crate::closed_form::{DYAD_CONSTANTS, dyad};
use crate::configuration::Configuration;
use crate::design::Design;
use crate::ids::Spot;
use crate::local_marker::LocalMarker;
use crate::plan::{Dyad, DyadBody};
use crate::pose::{Pose, add, cross, dot, sub};

/// One body of a dyad in a design.
pub struct DyadArm<'d, T> {
    pub(crate) body: usize,
    pub(crate) outer: LocalMarker<'d, T>,
    pub(crate) at: LocalMarker<'d, T>,
    /// Where on its body the inner pin is.
    pub(crate) inner: Spot,
    /// Both pins lie on the body's x axis.
    on_axis: bool,
    pub(crate) wanted: bool,
}

impl<'d, T: Number> DyadArm<'d, T> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn new(design: &'d Design<T>, body: &DyadBody) -> Self {
        let (outer, inner) = (
            LocalMarker::new(design, body.outer),
            LocalMarker::new(design, body.inner),
        );
        Self {
            body: inner.body,
            outer,
            inner: inner.spot,
            at: LocalMarker::new(design, body.at),
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
pub struct BoundDyad<'d, T> {
    pub(crate) a: DyadArm<'d, T>,
    pub(crate) b: DyadArm<'d, T>,
    pub(crate) constants: &'d [T; DYAD_CONSTANTS],
}

impl<'d, T: Number> BoundDyad<'d, T> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn new(design: &'d Design<T>, step: &Dyad) -> Self {
        Self {
            a: DyadArm::new(design, &step.a),
            b: DyadArm::new(design, &step.b),
            constants: &design.constants[step.constants],
        }
    }

    /// Places those of its bodies that are wanted; returns the determinant. The placed points are `off` from their markers.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn solve(
        &self,
        state: &mut Configuration<T>,
        sign: f64,
        off: Option<[[T; 2]; 2]>,
    ) -> T {
        let Self { a, b, constants: k } = self;
        let poses = &mut state.poses[..];
        let (mut wa, mut wb) = (a.at.place(poses), b.at.place(poses));
        if let Some([a, b]) = off {
            (wa, wb) = (add(wa, a), add(wb, b));
        }
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
