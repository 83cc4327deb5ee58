//! What a link's table says about its points, before they are placed.

use std::collections::BTreeSet;

use crate::ids::{PointId, Scalar, Span};
use crate::link::{Place, Side};

/// What a link's table says about its points.
#[derive(Default)]
pub(crate) struct Draft {
    /// In order of first appearance.
    pub points: Vec<(PointId, Span)>,
    /// The same as a set.
    pub known: BTreeSet<PointId>,
    pub coordinates: Vec<Coordinates>,
    pub distances: Vec<Distance>,
    pub sides: Vec<SideOf>,
    /// Its first points are listed by name: `[places]` draws them.
    pub listed: bool,
    /// Something of it could not be read: do not complain about what is missing.
    pub broken: bool,
}

/// A point by its coordinates.
pub(crate) struct Coordinates {
    pub point: PointId,
    pub place: Place,
    pub span: Span,
}

/// Two points by their distance.
pub(crate) struct Distance {
    pub a: PointId,
    pub b: PointId,
    pub length: Scalar,
    pub key: Span,
    pub span: Span,
}

/// A point by its side of a line.
pub(crate) struct SideOf {
    pub point: PointId,
    pub side: Side,
    pub from: PointId,
    pub to: PointId,
    pub span: Span,
}
