//! Where joints carry their loads and where they rub, as data for whoever computes forces.

use crate::ids::{BodyId, Marker};

/// Where a joint's load on a body is counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LoadPoint {
    /// At a point.
    At(Marker),
    /// At the origin of the body, for want of a better place.
    Origin(BodyId),
}

/// What rubs in a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rubs {
    /// A pin in its hole: two rows, whose resultant is the load.
    AboutPin,
    /// A point along a guide: one row, the normal force.
    AlongGuide,
    /// Teeth: one row, the force along the common tangent of the pitch circles.
    Teeth {
        /// Index into the geometry's gear constants, whose factors are the wheels' sizes.
        constants: u32,
        /// The first of the two is a rack, and the second factor its pinion's size.
        rack: bool,
    },
}

/// How two bodies slide on each other in a joint that rubs.
#[derive(Clone, Copy, Debug)]
pub enum Sliding<T> {
    /// `b` turns against `a` about a pin: friction is a moment, at the pin's radius.
    Turning {
        /// The earlier body.
        a: BodyId,
        /// The later body.
        b: BodyId,
    },
    /// A point slides along a guide: friction is a force along the tangent.
    Along {
        /// The point that slides.
        point: Marker,
        /// The body with the guide.
        on: BodyId,
        /// Unit tangent of the guide at the point, in the frame.
        tangent: [T; 2],
    },
    /// Teeth of `a` and `b` roll on each other at the pitch point and slide everywhere else along their path of contact.
    Rolling {
        /// The one body.
        a: BodyId,
        /// The other.
        b: BodyId,
        /// The pitch point in the frame, m.
        point: [T; 2],
        /// Unit vector in the frame along which the teeth push `a` off.
        off: [T; 2],
        /// Length of what a factor of the constants counts, m: half the module where it counts teeth, 1 where it is m.
        unit: T,
    },
}
