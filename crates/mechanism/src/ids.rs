//! Bodies, their points and their lines, as indices.

/// A body: one link, or several welded into one. `BodyId(0)` is the frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BodyId(pub u32);

impl BodyId {
    /// The frame.
    pub const GROUND: Self = Self(0);

    /// The index into the list of bodies.
    #[inline(always)]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A point of a body: an index into [`Parts::markers`](crate::structure::Parts::markers).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Marker {
    /// The body that carries the point.
    pub body: BodyId,
    /// Index of its local coordinates in the geometry.
    pub index: u32,
    /// What is known of its place whatever the dimensions: saves work in every pose.
    pub spot: Spot,
}

/// What is known of a marker's place in its body whatever the dimensions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spot {
    /// On the frame: its place in the body is its place in the frame.
    Frame,
    /// At the body's origin.
    Origin,
    /// On the body's x axis.
    Axis,
    /// Anywhere.
    Anywhere,
}

/// A circular arc of a body: an index into the geometry's arcs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ArcRef {
    /// The body that carries the arc.
    pub body: BodyId,
    /// Index into the geometry's arcs.
    pub index: u32,
}

/// A smooth curve of a body: an index into the geometry's curves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CurveRef {
    /// The body that carries the curve.
    pub body: BodyId,
    /// Index into the geometry's curves.
    pub index: u32,
}

/// A directed line of a body: an index into the geometry's lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LineRef {
    /// The body that carries the line.
    pub body: BodyId,
    /// Index into the geometry's lines.
    pub index: u32,
}
