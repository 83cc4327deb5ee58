//! What a plot shows: its axes, curves, markers and limits.

use super::axis::Axis;
use super::curve::Curve;
use super::limit::Limit;

/// What a marker stands for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MarkerKind {
    /// A dead point of the drive.
    DeadPoint,
    /// A change point, where branches meet.
    ChangePoint,
    /// A limit of the motion.
    Limit,
    /// Anything else.
    #[default]
    Event,
}

/// A vertical line at a place on the x axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Marker {
    /// Where, in the unit of the x axis.
    pub at: f64,
    /// What it says.
    pub label: String,
    /// What it stands for.
    pub kind: MarkerKind,
}

/// A plot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlotSpec {
    /// Title; may be empty.
    pub title: String,
    /// Abscissa.
    pub x: Axis,
    /// Ordinate.
    pub y: Axis,
    /// Curves, coloured in order.
    pub curves: Vec<Curve>,
    /// Vertical lines.
    pub markers: Vec<Marker>,
    /// One unit is as long on both axes, for paths in the plane.
    pub equal_aspect: bool,
    /// Lines that the curves should not cross.
    pub limits: Vec<Limit>,
    /// The curves are the tips of vectors from the origin; the aspect is equal then.
    pub hodograph: Option<Hodograph>,
}

/// Makes a plot's curves the tips of vectors from the origin.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Hodograph {
    /// The drive's coordinate at each value of the curves.
    pub drive: Vec<f64>,
    /// Its unit.
    pub unit: String,
}

impl PlotSpec {
    /// The same with a line that the curves should not cross.
    pub fn with_limit(mut self, limit: Limit) -> PlotSpec {
        self.limits.push(limit);
        self
    }

    /// The same as vectors from the origin over a drive's coordinate in its unit.
    pub fn as_hodograph(mut self, drive: Vec<f64>, unit: impl Into<String>) -> PlotSpec {
        let unit = unit.into();
        self.hodograph = Some(Hodograph { drive, unit });
        self
    }

    /// Whether it shows a plane rather than curves over an abscissa.
    pub(crate) fn is_plane(&self) -> bool {
        self.equal_aspect || self.hodograph.is_some()
    }
}
