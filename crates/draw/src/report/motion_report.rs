//! What a report shows of a motion: its poses, columns and plots, and what happens in it.

use super::evidence::Evidence;
use crate::plot::{MarkerKind, PlotSpec};
use crate::view::{Frame, LoadUnit, MechanismView};

/// A motion with what was asked of it. All lists run by row; they may differ in length, the shortest counts.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionReport {
    /// Name of the study; its table is saved from the page as `NAME.csv`.
    pub name: String,
    /// What it asks, in a sentence; may be empty.
    pub summary: String,
    /// The mechanism.
    pub view: MechanismView,
    /// Its pose at each row; NaN where it was not reached.
    pub frames: Vec<Frame>,
    /// The columns of the table in the order of its CSV file. The first is what runs when the motion is played: time, or the
    /// arc of a circuit.
    pub columns: Vec<Column>,
    /// The column of the drive that is moved by hand.
    pub drive: usize,
    /// What is plotted and is no column of the table.
    pub more: Vec<Column>,
    /// Evidence for each row: the last columns of the CSV file.
    pub tests: Vec<Column>,
    /// What is said about rows.
    pub notes: Vec<Note>,
    /// First line of the saved table; none when empty. It says of a run that was stopped how far it came.
    pub mark: String,
    /// Plots. Curves with one value a row follow the playhead.
    pub plots: Vec<PlotSpec>,
    /// Velocities and accelerations of the points.
    pub vectors: Vec<PointVectors>,
    /// Places worth knowing.
    pub events: Vec<Event>,
    /// What happens in the course of the motion, where its first column is time.
    pub happenings: Vec<Happening>,
    /// How far the result can be trusted.
    pub evidence: Evidence,
    /// Another design, row by row beside this one.
    pub against: Option<Against>,
}

impl MotionReport {
    /// The column of the drive.
    pub(super) fn drive(&self) -> Option<&Column> {
        self.columns.get(self.drive)
    }
}

/// Another design at the rows of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Against {
    /// What it is called.
    pub name: String,
    /// How its rows belong to those of the motion.
    pub matched: String,
    /// Its mechanism.
    pub view: MechanismView,
    /// Its pose at each row; one without points where it has none.
    pub frames: Vec<Frame>,
    /// Its values at each row, for each of [`MotionReport::columns`], [`MotionReport::more`] and [`MotionReport::tests`] in this
    /// order, in their units; `None` where it has no such quantity.
    pub values: Vec<Option<Vec<f64>>>,
}

/// What is said about some rows that follow each other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Note {
    /// First row.
    pub first: usize,
    /// Last row.
    pub last: usize,
    /// What is said.
    pub text: String,
}

/// Which vector of a moving point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VectorKind {
    /// Of its velocity.
    Velocity,
    /// Of its acceleration.
    Acceleration,
}

/// A vector at every point of the mechanism, row after row.
#[derive(Clone, Debug, PartialEq)]
pub struct PointVectors {
    /// Which one.
    pub kind: VectorKind,
    /// To what the derivative is taken, such as `in time` or `derivative to crank`.
    pub per: String,
    /// Unit in which it is told.
    pub unit: LoadUnit,
    /// For each row, x and y at each point in the order of [`MechanismView::points`], SI; NaN where it is not known.
    pub rows: Vec<Vec<[f64; 2]>>,
}

/// A measure over the rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Column {
    /// Name.
    pub name: String,
    /// Unit in which the values are; empty when there is none.
    pub unit: String,
    /// One value a row; NaN where it was not reached.
    pub values: Vec<f64>,
}

impl Column {
    /// A column by name, unit and values.
    pub fn new(name: impl Into<String>, unit: impl Into<String>, values: Vec<f64>) -> Column {
        Column {
            name: name.into(),
            unit: unit.into(),
            values,
        }
    }

    /// `name [unit]`, or the name alone.
    pub(super) fn head(&self) -> String {
        match self.unit.is_empty() {
            true => self.name.clone(),
            false => format!("{} [{}]", self.name, self.unit),
        }
    }
}

/// A place in a motion worth knowing: a dead point, a change point, a limit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Event {
    /// The row nearest to it.
    pub row: usize,
    /// Where it is, such as `motor = 117.512 deg`.
    pub place: String,
    /// What it is.
    pub label: String,
    /// Its kind.
    pub kind: MarkerKind,
}

/// What kind of thing happens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HappeningKind {
    /// Bodies touch for a time: those of a joint with play, or one lies on a stop.
    Contact,
    /// Friction holds something for a time.
    Held,
    /// Bodies strike each other at once.
    Impact,
    /// Something else, at once: a switch, a jump of a speed.
    Event,
}

impl HappeningKind {
    /// All kinds: first those that last, over which the others are marked.
    pub const ALL: [HappeningKind; 4] = [Self::Contact, Self::Held, Self::Impact, Self::Event];

    /// Whether it lasts for a time.
    pub fn lasts(self) -> bool {
        matches!(self, Self::Contact | Self::Held)
    }
}

/// Something that happens in the course of a motion, once or many times.
#[derive(Clone, Debug, PartialEq)]
pub struct Happening {
    /// What it is, in words: `C touches`.
    pub label: String,
    /// Its kind.
    pub kind: HappeningKind,
    /// The point of the mechanism where it is seen; none where it has no place.
    pub point: Option<usize>,
    /// From when until when, each time, in order and in the unit of the first column; what takes no time begins and ends at once.
    pub times: Vec<[f64; 2]>,
}
