//! Plots of columns: own axes with round ticks, gaps where a row was not reached, markers at dead and change points.

mod axis;
mod curve;
mod draw;
mod frame;
mod hodograph;
mod limit;

pub use axis::Scale;
pub(crate) use curve::thinned;
pub use hodograph::Hodograph;
pub use limit::{Beyond, Limit, LimitLine};

use crate::scene::Scene;
use crate::tokens::Token;

/// A named axis with its unit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// What is measured, such as `angle of rocker`.
    pub label: String,
    /// Its unit, such as `deg`; empty when it has none.
    pub unit: String,
    /// Logarithmic; values that are not positive are left out.
    pub log: bool,
    /// Shown range; all of the data when `None`.
    pub limits: Option<[f64; 2]>,
}

impl Axis {
    /// A linear axis over all of the data.
    pub fn new(label: impl Into<String>, unit: impl Into<String>) -> Axis {
        Axis {
            label: label.into(),
            unit: unit.into(),
            ..Axis::default()
        }
    }

    /// `label [unit]`, or the label alone.
    pub fn title(&self) -> String {
        match (self.label.is_empty(), self.unit.is_empty()) {
            (_, true) => self.label.clone(),
            (true, false) => format!("[{}]", self.unit),
            (false, false) => format!("{} [{}]", self.label, self.unit),
        }
    }
}

/// A curve through pairs of values. Where one of a pair is not finite, the curve has a gap.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// Name in the legend.
    pub label: String,
    /// Abscissae, in the unit of the x axis.
    pub x: Vec<f64>,
    /// Ordinates, in the unit of the y axis.
    pub y: Vec<f64>,
    /// Dashed.
    pub dashed: bool,
    /// Its values are dots that nothing joins.
    pub dots: bool,
    /// The number of its colour; its place among the curves when `None`.
    pub color: Option<usize>,
    /// Of a curve of another design: what a reader is told of it at the rows of the motion.
    pub told: Option<Told>,
}

impl Curve {
    /// The colour of the curve that stands at a place among others.
    pub(crate) fn token(&self, index: usize) -> Token {
        Token::Series(self.color.unwrap_or(index))
    }
}

/// What a reader is told of a curve that has other rows than the motion beside it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Told {
    /// What it is called.
    pub name: String,
    /// Its abscissa at each row of the motion, in the unit of the x axis; NaN where it has none.
    pub x: Vec<f64>,
    /// Its ordinate there, in the unit of the y axis.
    pub y: Vec<f64>,
}

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

/// A plot laid out: the picture, and how values map to it.
#[derive(Clone, Debug, PartialEq)]
pub struct PlotPicture {
    /// The picture.
    pub scene: Scene,
    /// From values to mm from the left.
    pub x: Scale,
    /// From values to mm from the bottom.
    pub y: Scale,
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

    /// Draws the plot on a sheet of the given width and height, mm.
    pub fn draw(&self, width: f64, height: f64) -> PlotPicture {
        let side = |v: f64| {
            if v.is_finite() {
                v.clamp(40.0, 2000.0)
            } else {
                100.0
            }
        };
        draw::draw(self, side(width), side(height))
    }
}
