//! What every study asks along a motion: rows, columns, plots.

use kempe_units::Dimension;

use crate::ids::{PointId, Scalar};
use crate::measure::{JointRef, Measure};

/// A motion study: rows along the drive or along time.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionStudy {
    /// Where rows stand.
    pub rows: Rows,
    /// Columns; empty means all named measures of the model (of a motion: those that need no forces).
    pub columns: Vec<Column>,
    /// Plots: each entry is one picture.
    pub plots: Vec<Plot>,
    /// Trace the whole circuit past dead points, by arc length, instead of the demanded range.
    pub circuit: bool,
}

/// Where the rows of a motion table stand.
#[derive(Clone, Debug, PartialEq)]
pub enum Rows {
    /// Every `step` of the (single) drive's coordinate, from its start, and at its end; along a circuit at its dead points
    /// too.
    DriveStep(Scalar),
    /// Every `step` seconds.
    TimeStep(Scalar),
    /// So many rows, evenly in time over the whole motion (along a circuit: in arc length), both ends included.
    Count(usize),
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Heading: the measure's name or its text as written.
    pub name: String,
    /// What it is.
    pub measure: Measure,
    /// Dimension.
    pub dimension: Dimension,
}

/// A plot asked for.
#[derive(Clone, Debug, PartialEq)]
pub enum Plot {
    /// Measures of one dimension along the motion, in one picture.
    Curves(Vec<Column>),
    /// The path of a point in the plane.
    Path(PointId),
    /// The force of a joint as an arrow from one origin, all along the motion.
    Hodograph(Hodograph),
}

/// A joint's force over a motion, as the curve of its arrow's tip.
#[derive(Clone, Debug, PartialEq)]
pub struct Hodograph {
    /// As written: `hodograph(B, coupler)`.
    pub name: String,
    /// The joint, and the link that feels the force.
    pub joint: JointRef,
}
