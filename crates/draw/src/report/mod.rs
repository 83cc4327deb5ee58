//! The report: one HTML file that needs nothing else. The mechanism moves in the page, its plots follow, and the check's
//! findings and the evidence stand beside them.

mod base64;
mod columns;
mod data;
mod front;
mod happenings;
mod html;
mod json;
mod loads;
mod motion;
mod plots;
mod sections;
mod vectors;

use std::ops::ControlFlow;

use crate::plot::{MarkerKind, PlotSpec};
use crate::scene::Scene;
use crate::view::{Frame, LoadUnit, MechanismView};

/// Most poses and rows that a report carries of one motion; more are thinned out evenly.
pub const MOST_ROWS: usize = 2000;

/// Everything a report shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// Title of the mechanism.
    pub title: String,
    /// The model file it comes from.
    pub file_name: String,
    /// Fronts of designs, above the motions.
    pub fronts: Vec<FrontReport>,
    /// Studies with a motion, in the order of the tabs.
    pub motions: Vec<MotionReport>,
    /// What stands above the motions: warnings.
    pub first: Vec<Section>,
    /// Findings, in order: mobility, groups, assemblies.
    pub sections: Vec<Section>,
    /// The text of the model file; none is shown when it is empty.
    pub source: String,
    /// Name and text of the other design's file, where that is another one.
    pub other_source: Option<(String, String)>,
    /// The program that wrote it, with its version, for the last line.
    pub generator: String,
    /// When it was written; not told when empty, so that the same run gives the same bytes.
    pub date: String,
}

/// Designs none of which is better than another in all goals, to choose among.
#[derive(Clone, Debug, PartialEq)]
pub struct FrontReport {
    /// Name of the study.
    pub name: String,
    /// What it is, in a sentence; may be empty.
    pub about: String,
    /// Number, parameters, goals and further numbers: the columns of the table, a value for each design.
    pub columns: Vec<Column>,
    /// Which of the columns are goals, two at least.
    pub goals: Vec<usize>,
    /// The goals of the file's own design, in their columns' units, where it has them.
    pub own: Option<Vec<f64>>,
    /// The picture before a script draws it: the second goal over the first.
    pub plot: PlotSpec,
    /// The designs, in the order of the columns' values.
    pub designs: Vec<FrontDesign>,
}

/// A design of a front.
#[derive(Clone, Debug, PartialEq)]
pub struct FrontDesign {
    /// Its name: `07`.
    pub name: String,
    /// Its file beside the report: `front/07.toml`; empty where it has none.
    pub file: String,
    /// What is said about it; may be empty.
    pub note: String,
    /// The mechanism and its poses; none where nothing of it moves.
    pub moving: Option<(MechanismView, Vec<Frame>)>,
    /// The name of the motion that shows it with plots, where the report has it.
    pub motion: String,
}

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
    fn head(&self) -> String {
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

/// Rows that were not reached.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NotReached {
    /// First row.
    pub first: usize,
    /// Last row.
    pub last: usize,
    /// Why.
    pub reason: String,
}

/// How far a result can be trusted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Evidence {
    /// Largest closure residual over all rows, and the limit it is held to, both relative to the mechanism's size.
    pub residual: Option<(f64, f64)>,
    /// Smallest singular value of the constraint Jacobian over all rows.
    pub singular_value: Option<f64>,
    /// How the Jacobian was scaled for that.
    pub scaling: String,
    /// Rows that were not reached.
    pub not_reached: Vec<NotReached>,
    /// Other checks, each with its worst value over the rows.
    pub checks: Vec<Check>,
    /// Anything else, as name and value.
    pub facts: Vec<(String, String)>,
}

/// A check that ran over all rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Check {
    /// What was checked, such as `Two routes to the reactions`.
    pub name: String,
    /// The worst value, with its limit where it has one: `3e-13 ≤ 1e-9`.
    pub worst: String,
    /// Where it was found, such as `crank = 117.5 deg`; may be empty.
    pub place: String,
    /// What it says about the result.
    pub meaning: String,
}

impl Check {
    /// A check by name, worst value, place and meaning.
    pub fn new(
        name: impl Into<String>,
        worst: impl Into<String>,
        place: impl Into<String>,
        meaning: impl Into<String>,
    ) -> Check {
        Check {
            name: name.into(),
            worst: worst.into(),
            place: place.into(),
            meaning: meaning.into(),
        }
    }
}

/// A chapter of findings.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// Heading.
    pub title: String,
    /// What it holds, in order.
    pub blocks: Vec<Block>,
}

/// How serious a finding is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Level {
    /// Good to know.
    #[default]
    Note,
    /// A careful engineer would want to be told.
    Warning,
    /// Something failed.
    Error,
}

/// A piece of a section.
#[derive(Clone, Debug, PartialEq)]
pub enum Block {
    /// A paragraph.
    Paragraph(String),
    /// A list.
    List(Vec<String>),
    /// Names with values.
    Facts(Vec<(String, String)>),
    /// A table.
    Table {
        /// Heads of the columns.
        head: Vec<String>,
        /// Rows of cells.
        rows: Vec<Vec<String>>,
    },
    /// Pictures side by side, each with what stands under it.
    Pictures(Vec<(String, Scene)>),
    /// A picture of its own, as wide as is good to read.
    Picture(Scene),
    /// A warning or an error.
    Finding {
        /// How serious.
        level: Level,
        /// Stable code.
        code: String,
        /// What was found.
        message: String,
        /// What to do about it; may be empty.
        help: String,
    },
}

impl MotionReport {
    /// The column of the drive.
    fn drive(&self) -> Option<&Column> {
        self.columns.get(self.drive)
    }
}

impl Report {
    /// The whole report as HTML text. All texts are escaped; the same report gives the same bytes.
    pub fn to_html(&self) -> String {
        html::page(self, &mut |_| ControlFlow::Continue(())).unwrap_or_default()
    }

    /// As [`to_html`](Self::to_html); `drawn` hears how many of its [`parts`](Self::parts) are drawn, and may stop it: then there is
    /// no page.
    pub fn to_html_with(&self, drawn: &mut dyn FnMut(usize) -> ControlFlow<()>) -> Option<String> {
        html::page(self, drawn)
    }

    /// How many parts are drawn one after the other: motions and fronts.
    pub fn parts(&self) -> usize {
        self.motions.len() + self.fronts.len()
    }
}
