//! One way to draw a dimension: where its text, lines and arrowheads are, and the measures that all kinds share.

use crate::labels::Room;
use crate::scene::{Path, Point, distance};

/// Length and half width of an arrowhead, mm.
pub(super) const HEAD: Point = [2.2, 0.45];
/// From a line to the text above it, mm.
pub(super) const ABOVE: f64 = 0.6;

/// One way to draw a dimension.
pub(super) struct Way {
    pub dislike: f64,
    pub room: Room,
    /// All its straight lines.
    pub lines: Vec<[Point; 2]>,
    /// An arc, for an angle.
    pub arc: Option<Path>,
    /// Tips of its arrowheads with their directions.
    pub heads: Vec<(Point, Point)>,
}

/// The direction from a point to another, of length 1.
pub(super) fn direction(from: Point, to: Point) -> Option<Point> {
    let long = distance(from, to);
    (long > 1e-6).then(|| [(to[0] - from[0]) / long, (to[1] - from[1]) / long])
}

/// The direction of text along a line, so that it is read from below or from the right.
pub(super) fn readable(along: Point) -> Point {
    let upward = along[0].abs() < 1e-9 && along[1] > 0.0;
    match along[0] > 1e-9 || upward {
        true => along,
        false => [-along[0], -along[1]],
    }
}
