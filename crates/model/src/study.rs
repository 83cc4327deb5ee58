//! What is asked of a model.

use kempe_units::Dimension;

use crate::ids::{DriveId, LinkId, PointId, Scalar, Span};
use crate::measure::Measure;

/// A measure with the user's name for it.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedMeasure {
    /// Name.
    pub name: String,
    /// What it is.
    pub measure: Measure,
    /// Dimension.
    pub dimension: Dimension,
    /// It asks for forces, itself or by another measure: only a study of forces knows it.
    pub needs_forces: bool,
    /// Where it stands in the file.
    pub span: Span,
}

/// A study of a kind that the language keeps for later versions.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct AnnouncedStudy {
    /// Name.
    pub name: String,
    /// Its kind, as in `kind = "clearance"`.
    pub kind: String,
}

/// A question asked of the model.
#[derive(Clone, Debug, PartialEq)]
pub struct Study {
    /// Name.
    pub name: String,
    /// What is asked.
    pub kind: StudyKind,
    /// Where it stands in the file.
    pub span: Span,
}

/// The kinds of study.
#[derive(Clone, Debug, PartialEq)]
pub enum StudyKind {
    /// The motion along the drives' laws.
    Motion(MotionStudy),
    /// What drives the motion and what the joints carry along it. Rows, columns and plots as for a motion.
    Forces(MotionStudy),
    /// The counterweights that make it run quietly or hang in balance.
    Balance(BalanceStudy),
    /// The spring that leaves a wanted effort to a drive.
    Spring(SpringStudy),
}

/// Which counterweights a mechanism needs.
#[derive(Clone, Debug, PartialEq)]
pub struct BalanceStudy {
    /// Where rows stand.
    pub along: MotionStudy,
    /// What is to vanish.
    pub goal: BalanceGoal,
    /// The links that may carry one, each with its pin on the frame.
    pub on: Vec<(LinkId, PointId)>,
    /// Their distance from these pins, m.
    pub radius: Scalar,
}

/// What counterweights are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BalanceGoal {
    /// The force of the moving links on the frame.
    ShakingForce,
    /// What gravity asks of the drive.
    Statics,
}

/// Which spring leaves a wanted effort to a drive: its stiffness and preload are chosen.
#[derive(Clone, Debug, PartialEq)]
pub struct SpringStudy {
    /// Where rows stand.
    pub along: MotionStudy,
    /// The spring, by its place in the model's actions: its ends and free length count.
    pub spring: usize,
    /// The drive that it helps.
    pub drive: DriveId,
    /// What the drive is to give, N m or N.
    pub wanted: Measure,
    /// Least and largest stiffness, N/m or N m/rad; `None` for no bound.
    pub stiffness: [Option<Scalar>; 2],
    /// Least and largest tension at the free length, N or N m.
    pub preload: [Option<Scalar>; 2],
}

impl StudyKind {
    /// Rows, columns and plots of a study, whatever it asks.
    pub fn along(&self) -> &MotionStudy {
        match self {
            Self::Motion(along) | Self::Forces(along) => along,
            Self::Balance(study) => &study.along,
            Self::Spring(study) => &study.along,
        }
    }
}

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
    pub joint: crate::measure::JointRef,
}
