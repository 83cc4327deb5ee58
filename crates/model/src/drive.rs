//! Drives and their motion laws.

use kempe_units::Dimension;

use crate::ids::{DriveId, JointId, LinkId, LinkPointRef, PointId, Scalar, Span};
use crate::polynomials::Stretches;

/// What is moved from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// Name.
    pub name: String,
    /// What it moves.
    pub kind: DriveKind,
    /// How it moves.
    pub law: Law,
    /// Dimension of its coordinate: angle or length.
    pub dimension: Dimension,
    /// Where it stands in the file.
    pub span: Span,
}

/// What a drive moves.
#[derive(Clone, Debug, PartialEq)]
pub enum DriveKind {
    /// The angle from the x axis of `relative_to` to that of `link`, rad. Either may float.
    Turn {
        /// The link that turns.
        link: LinkId,
        /// The link it turns against; the frame unless said otherwise.
        relative_to: LinkId,
    },
    /// The distance of two points: a hydraulic cylinder.
    Cylinder {
        /// Foot.
        a: LinkPointRef,
        /// Eye.
        b: LinkPointRef,
    },
    /// The travel of a slider or of a pin in its slot: the coordinate along the guide from its first point.
    Slide {
        /// The slider or slot joint.
        joint: JointId,
    },
    /// A joint that is let go, by one of its rows: how far it stands open there. Files cannot say it, and a model written as a
    /// file leaves it out.
    Release {
        /// The joint.
        of: Released,
        /// Which of its rows.
        row: u8,
    },
    /// What stands in where a drive that is let go tells nothing of the place. Files cannot say it, and a model written as a file
    /// leaves it out.
    StandIn(StandIn),
}

/// What stands in for drives that are let go.
#[derive(Clone, Debug, PartialEq)]
pub enum StandIn {
    /// Such a drive, holding nothing: its coordinate goes with the mechanism, whose place others tell.
    Follows {
        /// What it moved.
        of: Box<DriveKind>,
        /// The sense in which its motor turns it, 1 or -1.
        sense: f64,
    },
    /// What tells the place in its stead: its own coordinate, or the angle of one of some links against the frame, counted as that of
    /// the link's body.
    Pilot {
        /// The drive.
        of: DriveId,
        /// Its own.
        own: Box<DriveKind>,
        /// The links.
        links: Vec<LinkId>,
        /// The drive whose coordinate says which: 0 for the own, from 1 on the links.
        chosen: DriveId,
    },
    /// A number that holds nothing: which coordinate of a [`StandIn::Pilot`] counts.
    Choice,
}

/// A joint that can be let go.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Released {
    /// The pin between a point's first link and a later one.
    Pin {
        /// The point.
        point: PointId,
        /// The later link.
        link: LinkId,
    },
    /// A joint of the file.
    Joint(JointId),
}

/// How a drive moves in time.
#[derive(Clone, Debug, PartialEq)]
pub struct Law {
    /// Pieces in order; each starts where the one before ended.
    pub pieces: Vec<LawPiece>,
    /// Coordinate at the start.
    pub from: Scalar,
}

/// A piece of a motion law. `to` is the coordinate at its end.
#[derive(Clone, Debug, PartialEq)]
pub enum LawPiece {
    /// Constant speed. The sign of the speed is the direction of travel; only its size counts.
    ConstantSpeed {
        /// End coordinate.
        to: Scalar,
        /// Speed, per second, positive.
        speed: Scalar,
    },
    /// Constant acceleration from rest.
    ConstantAcceleration {
        /// End coordinate.
        to: Scalar,
        /// Acceleration, per second squared, positive.
        acceleration: Scalar,
    },
    /// Standing still.
    Dwell {
        /// How long, s.
        duration: Scalar,
    },
    /// From rest to rest by a standard law.
    Rise {
        /// End coordinate.
        to: Scalar,
        /// How long, s.
        duration: Scalar,
        /// By which law.
        by: RiseLaw,
    },
    /// Measured points joined by a smooth curve (twice continuously differentiable).
    Table {
        /// Times, s, increasing.
        times: Vec<f64>,
        /// Coordinates, SI.
        values: Vec<f64>,
        /// Second derivatives of the spline through them at these times, SI.
        moments: Vec<f64>,
    },
    /// Polynomials in time, as a simulation finds them. Files cannot say it; written as a file they are measured points.
    Polynomials(Stretches),
}

impl LawPiece {
    /// The times, s from its start, between which a piece of several parts is smooth; none of any other.
    pub fn knots(&self) -> &[f64] {
        match self {
            Self::Table { times, .. } => times,
            Self::Polynomials(found) => found.knots(),
            _ => &[],
        }
    }
}

/// Standard laws from rest to rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RiseLaw {
    /// s - sin(2 pi s)/(2 pi).
    Cycloidal,
    /// (1 - cos(pi s))/2.
    Harmonic,
    /// 10 s^3 - 15 s^4 + 6 s^5.
    Polynomial345,
    /// 35 s^4 - 84 s^5 + 70 s^6 - 20 s^7.
    Polynomial4567,
}
