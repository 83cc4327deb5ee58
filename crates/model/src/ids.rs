//! What a model counts by index, and places in its file.

use std::ops::Range;

use kempe_units::Expr;

/// A place in the model file, in bytes.
pub type Span = Range<usize>;

/// An expression over the model's parameters, in SI.
pub type Scalar = Expr<ParameterId>;

macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub struct $name(pub u32);

        impl $name {
            /// The index into the model's list.
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }
    };
}

id!(
    /// A parameter of the model.
    ParameterId
);

id!(
    /// A link; `LinkId(0)` is the frame.
    LinkId
);

id!(
    /// A named point. A point that several links carry is a pin between them.
    PointId
);

id!(
    /// A joint other than a pin that a shared point name makes.
    JointId
);

id!(
    /// A drive.
    DriveId
);

/// The frame's link.
pub const FRAME: LinkId = LinkId(0);

/// A directed line through two points of one link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Line {
    /// The link that carries the line.
    pub link: LinkId,
    /// Start.
    pub from: PointId,
    /// End: gives the direction.
    pub to: PointId,
}

/// A point as a part of one link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LinkPointRef {
    /// The link.
    pub link: LinkId,
    /// The point on it.
    pub point: PointId,
}
