//! Links: rigid bodies by their points.

use crate::ids::{LinkId, PointId, Scalar, Span};

/// A rigid body: a set of named points.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// Name; the first link is `frame`.
    pub name: String,
    /// Its points, each placed in the link's own frame from earlier ones of the same link.
    pub points: Vec<LinkPoint>,
    /// Mass properties, when given.
    pub inertia: Option<Inertia>,
    /// Where the link is described.
    pub span: Span,
}

/// A point of a link.
#[derive(Clone, Debug, PartialEq)]
pub struct LinkPoint {
    /// Which named point.
    pub point: PointId,
    /// Where it lies in the link's own frame.
    pub place: Place,
    /// Where it is described.
    pub span: Span,
}

/// Where a point lies in its link's own frame (lengths m, angles rad counter-clockwise).
#[derive(Clone, Debug, PartialEq)]
pub enum Place {
    /// Cartesian coordinates. The origin of a link laid out by distances is `(0, 0)`.
    Cartesian {
        /// x.
        x: Scalar,
        /// y.
        y: Scalar,
    },
    /// Polar coordinates.
    Polar {
        /// Distance from the link's origin.
        radius: Scalar,
        /// Direction from the link's x axis.
        angle: Scalar,
    },
    /// By its distances to two earlier points of the link, on the named side of the directed line between them.
    Triangle {
        /// Index into the link's points of the line's start.
        from: usize,
        /// Index into the link's points of the line's end.
        to: usize,
        /// Distance to the line's start.
        from_distance: Scalar,
        /// Distance to the line's end.
        to_distance: Scalar,
        /// The side on which the point lies.
        side: Side,
    },
}

/// A side of a directed line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// On the left of somebody walking along the line.
    Left,
    /// On the right.
    Right,
}

impl Side {
    /// +1 for left, -1 for right: the sign of the cross product.
    pub fn sign(self) -> f64 {
        match self {
            Side::Left => 1.0,
            Side::Right => -1.0,
        }
    }
}

/// Mass properties of a link.
#[derive(Clone, Debug, PartialEq)]
pub struct Inertia {
    /// Mass, kg.
    pub mass: Option<Scalar>,
    /// Moment of inertia about the centre of mass, kg m^2.
    pub moment: Option<Scalar>,
    /// Where the centre of mass lies.
    pub center: Center,
}

/// Where a centre of mass lies.
#[derive(Clone, Debug, PartialEq)]
pub enum Center {
    /// The mean of the link's points.
    Centroid,
    /// At a named point of the link.
    Point(PointId),
    /// In the link's own frame.
    Place(Place),
}

/// A named point of the mechanism.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Name, starting with a capital letter.
    pub name: String,
    /// The links that carry it, in file order. Two or more make a pin (a multiple joint of k links counts k - 1).
    pub links: Vec<LinkId>,
    /// The link that the pin sits fast in, on which the others turn, where the file names it.
    pub holder: Option<LinkId>,
}

impl Point {
    /// The links that carry it: the one that the pin sits fast in, the first of the file where none is named, and then the others in file order.
    pub fn holder_first(&self) -> impl Iterator<Item = LinkId> + Clone {
        let holder = self.holder.or(self.links.first().copied());
        let others = self.links.iter().copied();
        holder
            .into_iter()
            .chain(others.filter(move |link| Some(*link) != holder))
    }
}

/// A circular arc through two points of one link.
#[derive(Clone, Debug, PartialEq)]
pub struct CircularArc {
    /// The link that carries the arc.
    pub link: LinkId,
    /// Start.
    pub from: PointId,
    /// End.
    pub to: PointId,
    /// Radius.
    pub radius: Scalar,
    /// Side of the way from start to end on which the centre lies.
    pub side: Side,
    /// The whole circle counts, not only its shorter part between start and end.
    pub closed: bool,
}

/// A smooth curve through points of one link: the cubic spline over the length of their chords (see [`spline`]).
///
/// [`spline`]: crate::spline
#[derive(Clone, Debug, PartialEq)]
pub struct SmoothCurve {
    /// The link that carries the curve.
    pub link: LinkId,
    /// Its points in their order along the curve, at least three.
    pub through: Vec<PointId>,
    /// It goes on from the last point to the first.
    pub closed: bool,
}
