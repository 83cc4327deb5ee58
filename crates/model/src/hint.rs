//! What the user says about which assembly is meant.

use crate::ids::{LinkId, PointId, Scalar, Span};
use crate::link::Side;

/// Something the user says about which assembly is meant, at the start of the drives.
#[derive(Clone, Debug, PartialEq)]
pub struct AssemblyHint {
    /// What is said.
    pub kind: HintKind,
    /// Where it stands in the file.
    pub span: Span,
}

/// The kinds of assembly hint.
#[derive(Clone, Debug, PartialEq)]
pub enum HintKind {
    /// A point lies on a side of the directed line between two points.
    Side {
        /// The point.
        point: PointId,
        /// The side.
        side: Side,
        /// Line start.
        from: PointId,
        /// Line end.
        to: PointId,
    },
    /// A point lies near a place of the frame.
    NearPlace {
        /// The point.
        point: PointId,
        /// x, m.
        x: Scalar,
        /// y, m.
        y: Scalar,
    },
    /// A link's angle is near a value, rad.
    NearAngle {
        /// The link.
        link: LinkId,
        /// The angle.
        angle: Scalar,
    },
}
