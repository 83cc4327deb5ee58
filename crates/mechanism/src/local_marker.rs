//! A marker with its coordinates in its body, looked up in a design once.

use kempe_number::Number;

use crate::design::Design;
use crate::ids::{Marker, Spot};
use crate::pose::Pose;

/// A marker with its coordinates in its body.
#[derive(Clone, Copy)]
pub(crate) struct LocalMarker<'d, T> {
    pub(crate) body: usize,
    pub(crate) spot: Spot,
    pub(crate) p: &'d [T; 2],
}

impl<'d, T: Number> LocalMarker<'d, T> {
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
            Spot::Axis => pose.place_on_axis(p[0]),
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

    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn on_axis(&self) -> bool {
        matches!(self.spot, Spot::Origin | Spot::Axis)
    }
}
