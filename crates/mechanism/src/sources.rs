//! What a mechanism's dimensions are made of: expressions over the parameters, still free.

use kempe_model::{JointId, LinkId, ParameterId, PointId, Scalar};
use kempe_units::Expr;

use crate::ids::{BodyId, LineRef, Marker};

pub(crate) const ZERO: Expr<ParameterId> = Expr::Const(0.0);

/// How a link sits in its body.
#[derive(Clone, Debug)]
pub struct LinkSeat {
    /// The body.
    pub body: BodyId,
    /// For a welded link: the link it is welded to, the shared point and the angle; `None` for the body's own link.
    pub weld: Option<(LinkId, PointId, Scalar)>,
}

/// A line by two markers of the same body, or by a marker and the link's x axis.
#[derive(Clone, Copy, Debug)]
pub enum LineSource {
    /// Through two points.
    Points(Marker, Marker),
    /// Through the link's origin along its x axis.
    AxisOf(LinkId),
}

/// A circular arc by its ends, two markers of one body.
#[derive(Clone, Debug)]
pub struct ArcSource {
    /// Where it starts.
    pub from: Marker,
    /// Where it ends.
    pub to: Marker,
    /// Radius, m.
    pub radius: Scalar,
    /// +1 with its centre on the left of the way from start to end, -1 on the right.
    pub side: f64,
}

/// A smooth curve by its points, markers of one body, with the shoe of the pin on it.
#[derive(Clone, Debug)]
pub struct CurveSource {
    /// Its points in their order.
    pub through: Vec<Marker>,
    /// It goes on from the last point to the first.
    pub closed: bool,
    /// The pin on it, of another body.
    pub pin: Marker,
    /// The body without a link that goes with the pin: its angle tells the place on the curve.
    pub shoe: BodyId,
    /// The joint.
    pub joint: JointId,
}

/// An angle constant between two bodies: `value + direction of the line + seat(b) - seat(a)`.
#[derive(Clone, Debug)]
pub struct AngleSource {
    /// Explicit angle, rad.
    pub value: Scalar,
    /// A line of the second link's body whose direction is added; then `b`'s seat is not.
    pub along: Option<LineRef>,
    /// Link whose seat angle is subtracted.
    pub a: LinkId,
    /// Link whose seat angle is added.
    pub b: LinkId,
}

/// Constants of a gear pair or of a rack.
#[derive(Clone, Debug)]
pub struct GearSource {
    /// Factor of the first angle (teeth; 1 for a rack).
    pub first: Scalar,
    /// Factor of the second angle (signed teeth; signed radius for a rack).
    pub second: Scalar,
    /// Right-hand side.
    pub constant: Scalar,
    /// Links a, b, arm whose seat angles matter.
    pub links: [LinkId; 3],
}
