//! The mechanism as it is drawn: where its points lie in one of its positions.

use std::collections::BTreeMap;

use crate::ids::{DriveId, LinkId, PointId, Scalar, Span};

/// What `[places]` draws. Links, drives and hints already follow from it; it is kept to be told of.
///
/// A model written as a file says what follows and leaves the drawing out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawing {
    /// Where points of links lie in the frame.
    pub places: BTreeMap<PointId, DrawnPlace>,
    /// Links that list their points by name, in file order.
    pub links: Vec<LinkId>,
    /// How many of the model's hints, the last ones, say that the assembly is as drawn.
    pub hints: usize,
    /// Coordinates as drawn of the drives that say themselves where they start. Where one starts elsewhere, the hints of the
    /// drawing are about the drawn coordinates, not about the start.
    pub coordinates: Vec<(DriveId, Scalar)>,
}

/// Where a point is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnPlace {
    /// x and y in the frame, m.
    pub at: [Scalar; 2],
    /// Where it stands in the file.
    pub span: Span,
}
