//! What the symbols need to know of a mechanism over all its poses: rigid shapes, ranges of travel, who carries what.

use kempe_number::math::{atan2, sin_cos};

use crate::fit::{Fit, drawable};
use crate::roles::Roles;
use crate::scene::{Placement, Point, distance};
use crate::view::{Frame, Guide, MechanismView};

/// To what a part of the drawing is fixed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Anchor {
    /// Moves with a point without turning.
    Point(usize),
    /// Moves with a point and turns with a link, from a constant angle (rad).
    On(usize, usize, f64),
    /// Starts at the first point and looks at the second.
    Toward(usize, usize),
    /// The same, stretched so that the second point is at x = 1.
    Between(usize, usize),
}

/// A mechanism with its poses and paper.
pub struct Context<'a> {
    /// The mechanism.
    pub view: &'a MechanismView,
    /// Its poses.
    pub frames: &'a [Frame],
    /// The paper.
    pub fit: Fit,
    /// What its points and links take part in.
    pub roles: Roles,
    /// The pose from which rigid shapes are taken.
    pub reference: Option<&'a Frame>,
}

/// A point of a pose, when it can be drawn.
#[inline]
pub fn point(frame: &Frame, index: usize) -> Option<Point> {
    frame.points.get(index).copied().filter(|&p| drawable(p))
}

/// Direction of a link in a pose.
pub fn link_angle(frame: &Frame, link: usize) -> Option<f64> {
    frame
        .links
        .get(link)
        .map(|l| l[2])
        .filter(|a| a.abs() < 1e9)
}

/// Whether every point and link of the mechanism can be drawn in a pose.
pub fn complete(view: &MechanismView, frame: &Frame) -> bool {
    (0..view.points.len()).all(|p| point(frame, p).is_some())
        && (0..view.links.len()).all(|l| link_angle(frame, l).is_some())
}

/// The first complete pose, or the first of all.
pub fn reference_frame<'a>(view: &MechanismView, frames: &'a [Frame]) -> Option<&'a Frame> {
    frames
        .iter()
        .find(|f| complete(view, f))
        .or_else(|| frames.first())
}

impl Context<'_> {
    /// Where a point lies on paper in a pose.
    #[inline]
    pub fn paper(&self, frame: &Frame, index: usize) -> Option<Point> {
        point(frame, index).and_then(|p| self.fit.paper(p))
    }

    /// Where a part with this anchor lies in a pose.
    pub fn place(&self, frame: &Frame, anchor: Anchor) -> Option<Placement> {
        let place = |p, angle, stretch| {
            self.paper(frame, p)
                .map(|at| Placement { at, angle, stretch })
        };
        match anchor {
            Anchor::Point(p) => place(p, 0.0, 1.0),
            Anchor::On(p, link, offset) => place(p, link_angle(frame, link)? + offset, 1.0),
            Anchor::Toward(p, q) | Anchor::Between(p, q) => {
                let (a, b) = (self.paper(frame, p)?, self.paper(frame, q)?);
                let stretch = if matches!(anchor, Anchor::Between(..)) {
                    distance(a, b)
                } else {
                    1.0
                };
                place(p, atan2(b[1] - a[1], b[0] - a[0]), stretch)
            }
        }
    }

    /// A point in the axes of a link, its origin at another point of the link, mm.
    pub fn local(&self, link: usize, origin: usize, index: usize) -> Option<Point> {
        let frame = self.reference?;
        let (a, b) = (self.paper(frame, origin)?, self.paper(frame, index)?);
        let (s, c) = sin_cos(link_angle(frame, link)?);
        let (x, y) = (b[0] - a[0], b[1] - a[1]);
        Some([c * x + s * y, c * y - s * x])
    }

    /// For scripts that move the drawing: the paper position of a link's first point and the link's angle in a pose.
    pub fn link_pose(&self, frame: &Frame, link: usize) -> Option<[f64; 3]> {
        let first = *self.view.links.get(link)?.points.first()?;
        let at = self.paper(frame, first)?;
        Some([at[0], at[1], link_angle(frame, link)?])
    }

    /// For scripts that move the drawing: a point as the link that carries it and its place there from the link's first
    /// point, mm.
    pub fn point_on_link(&self, index: usize) -> Option<(usize, Point)> {
        let link = *self.roles.point(index).carriers.first()?;
        let first = *self.view.links[link].points.first()?;
        Some((link, self.local(link, first, index)?))
    }

    /// Angle of a guide in the axes of its link.
    pub fn guide_angle(&self, guide: Guide) -> Option<f64> {
        let to = self.local(guide.link, guide.from, guide.to)?;
        (to != [0.0, 0.0]).then(|| atan2(to[1], to[0]))
    }

    /// Smallest and largest coordinate of a point along a guide over all poses, mm from the guide's first point.
    pub fn travel(&self, guide: Guide, index: usize) -> Option<(f64, f64)> {
        let along = |frame: &Frame| {
            let (a, b) = (self.paper(frame, guide.from)?, self.paper(frame, guide.to)?);
            let (p, length) = (self.paper(frame, index)?, distance(a, b));
            (length > 0.0)
                .then(|| ((p[0] - a[0]) * (b[0] - a[0]) + (p[1] - a[1]) * (b[1] - a[1])) / length)
        };
        range(self.frames.iter().filter_map(along))
    }

    /// Smallest and largest distance of two points over all poses, mm.
    pub fn span(&self, a: usize, b: usize) -> Option<(f64, f64)> {
        range(
            self.frames
                .iter()
                .filter_map(|f| Some(distance(self.paper(f, a)?, self.paper(f, b)?))),
        )
    }
}

fn range(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.fold(None, |seen, v| match seen {
        None => Some((v, v)),
        Some((low, high)) => Some((low.min(v), high.max(v))),
    })
}
