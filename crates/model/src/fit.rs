//! Paths and motions that a design is to fit.

use crate::ids::{DriveId, LinkId, PointId, Scalar, Span};

/// What a point or a link is to come near to, in least squares.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// What goes along the given places.
    pub traced: Traced,
    /// The given places, in their order.
    pub to: Vec<GivenPlace>,
    /// Where along the motion each is to be met.
    pub timing: Timing,
    /// Whether the way closes: it may then be begun anywhere, and gone either way.
    pub closed: bool,
    /// Where it stands in the file.
    pub span: Span,
}

/// What goes along given places.
#[derive(Clone, Debug, PartialEq)]
pub enum Traced {
    /// A point.
    Point(PointId),
    /// A link, by one of its points and its angle.
    Link {
        /// The link.
        link: LinkId,
        /// The point whose places are given.
        at: PointId,
        /// The length that an angle counts with: a turn moves what lies so far from the point by as much.
        radius: Scalar,
    },
}

/// A place that is given.
#[derive(Clone, Debug, PartialEq)]
pub struct GivenPlace {
    /// Its coordinates in the frame.
    pub place: [Scalar; 2],
    /// The link's angle there, where a link is traced.
    pub angle: Option<Scalar>,
    /// Where it stands in the file.
    pub span: Span,
}

/// Where along the motion given places are to be met.
#[derive(Clone, Debug, PartialEq)]
pub enum Timing {
    /// Wherever is nearest, in their order.
    Ordered,
    /// Wherever is nearest, each by itself.
    Nearest,
    /// At even times: from the start to the end, or all around.
    Even,
    /// Where the path is passed to the same part of its length as the given curve.
    ArcLength,
    /// At these values of a drive's coordinate, or of time where no drive is named.
    At(Option<DriveId>, Vec<Scalar>),
}

impl Fit {
    /// The point whose places are given.
    pub fn point(&self) -> PointId {
        match &self.traced {
            Traced::Point(point) => *point,
            Traced::Link { at, .. } => *at,
        }
    }

    /// The link whose angles are given, too.
    pub fn link(&self) -> Option<LinkId> {
        match &self.traced {
            Traced::Point(_) => None,
            Traced::Link { link, .. } => Some(*link),
        }
    }

    /// Where its parts stand in the file.
    pub(crate) fn visit_places(&mut self, f: &mut dyn FnMut(&mut Span)) {
        f(&mut self.span);
        self.to.iter_mut().for_each(|it| f(&mut it.span));
    }

    /// Every expression over parameters.
    pub(crate) fn visit_scalars(&mut self, f: &mut dyn FnMut(&mut Scalar)) {
        if let Traced::Link { radius, .. } = &mut self.traced {
            f(radius);
        }
        for given in &mut self.to {
            given.place.iter_mut().for_each(&mut *f);
            given.angle.iter_mut().for_each(&mut *f);
        }
        if let Timing::At(_, values) = &mut self.timing {
            values.iter_mut().for_each(f);
        }
    }
}
