//! What a study returns.

use kempe_draw::report::Happening;
use kempe_dynamics::ForceArrow;
use kempe_measure::PointRates;
use kempe_model::{Diagnostic, Model, ModelFile, PointId, Study};
use kempe_motion::events::EventKind;
use kempe_units::Unit;

use crate::table::{Column, Table};
use crate::unit::shown;

/// The answer of a motion study, with its evidence.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct StudyResult {
    /// Name of the study.
    pub name: String,
    /// The rows.
    pub table: Table,
    /// Tables besides, each with a name of its own.
    pub beside: Vec<Table>,
    /// Measures that are one number over the whole motion, such as `range(angle(rocker))`.
    pub scalars: Vec<Scalar>,
    /// What the study asks to plot.
    pub figures: Vec<Figure>,
    /// What is told besides, in words.
    pub listings: Vec<Listing>,
    /// Contacts of joints with play, in order of time.
    pub contacts: Vec<ContactMet>,
    /// What happened in the course of a simulation, with times, s.
    pub happenings: Vec<Happening>,
    /// The pose at each row.
    pub frames: Vec<Frame>,
    /// Natural vibrations about one pose, one for each row.
    pub shapes: Vec<ModeShape>,
    /// Mechanisms that the study found, as models of their own, the best first.
    pub designs: Vec<FoundDesign>,
    /// Limits and change points met.
    pub events: Vec<Event>,
    /// Index into the columns of the quantity the rows run along: a drive, or time.
    pub along: usize,
    /// How many assemblies agree with the file's hints where one was chosen (at the start, or where the mechanism is drawn), and how
    /// many do not.
    pub assemblies: (usize, usize),
    /// What a careful engineer would want to be told of the mechanism, its motion and these rows; errors where the motion does
    /// not go as far as it should.
    pub diagnostics: Vec<Diagnostic>,
    /// Rows that were asked for; the table has fewer when the study was stopped.
    pub demanded_rows: usize,
    /// How far it came where it was stopped and its rows do not tell that: "230 of 1000 pieces", "0.4 s of 2 s".
    pub stopped_at: Option<String>,
}

/// A contact of the bodies of a joint with play, SI.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ContactMet {
    /// What the joint is called.
    pub joint: String,
    /// Where it touches: the joint, or a corner of its block.
    pub place: String,
    /// When it begins, s.
    pub time: f64,
    /// How fast the bodies come together, m/s.
    pub speed: f64,
    /// How fast they part, m/s; none where they still touch at the end.
    pub speed_after: Option<f64>,
    /// How it goes; none of an impact that takes no time.
    pub touch: Option<TouchMet>,
}

/// How a contact goes that lasts, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct TouchMet {
    /// When it ends, s.
    pub until: f64,
    /// The largest force that presses, N.
    pub force: f64,
    /// The deepest indentation, m.
    pub depth: f64,
}

impl StudyResult {
    /// Whether the study was stopped before its end.
    pub fn interrupted(&self) -> bool {
        self.how_far().is_some()
    }

    /// How far it came where it was stopped before its end: "12 of 37 rows".
    pub fn how_far(&self) -> Option<String> {
        let rows = self.table.rows();
        let of_rows = || format!("{rows} of {} rows", self.demanded_rows);
        let fewer = rows < self.demanded_rows;
        self.stopped_at.clone().or_else(|| fewer.then(of_rows))
    }

    /// The column that the rows run along.
    pub fn abscissa(&self) -> Option<&Column> {
        self.table.columns.get(self.along)
    }
}

/// A study with what became of it.
#[derive(Clone, Debug)]
pub struct StudyOutcome<'a> {
    /// The study.
    pub study: &'a Study,
    /// Its result, or why there is none.
    pub result: Result<StudyResult, Vec<Diagnostic>>,
}

impl StudyOutcome<'_> {
    /// What is told of it.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        match &self.result {
            Ok(result) => &result.diagnostics,
            Err(errors) => errors,
        }
    }
}

/// A mechanism that a study found, as a model of its own.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct FoundDesign {
    /// Its name: `01`.
    pub name: String,
    /// What stands under its picture.
    pub title: String,
    /// Its file, with the tables that it names.
    pub file: ModelFile,
    /// The model that the file says.
    pub model: Model,
    /// How it moves, by the first study of its file; none where nothing of it moves.
    pub motion: Option<Box<StudyResult>>,
}

/// A natural vibration in real poses, as large as is good to look at.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ModeShape {
    /// Its name: `mode-1`.
    pub name: String,
    /// What stands under its picture: `mode 1: 2.31 Hz`.
    pub title: String,
    /// What it is, in words.
    pub about: String,
    /// What runs along its poses: time or a phase, drives, and how far away from the middle they are.
    pub columns: Vec<Column>,
    /// Its poses over some periods; the first is the middle.
    pub frames: Vec<Frame>,
    /// Closure of each pose, see [`Table::closure`].
    pub closure: Vec<f64>,
    /// The poses at both ends of its way.
    pub extremes: [usize; 2],
}

/// One number with a name.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Scalar {
    /// Name.
    pub name: String,
    /// Unit of the value.
    pub unit: Unit,
    /// Value in the unit.
    pub value: f64,
}

/// A small table of words.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Listing {
    /// What it is.
    pub title: String,
    /// Heads of its columns; none for plain lines.
    pub head: Vec<String>,
    /// Its rows.
    pub rows: Vec<Vec<String>>,
}

/// A plot that a study asks for.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Figure {
    /// Quantities of one dimension along the motion, and what they should stay below.
    Curves {
        /// The quantities.
        curves: Vec<Column>,
        /// Their limits.
        limits: Vec<Column>,
    },
    /// A quantity between minus and plus another one.
    Within {
        /// The quantity.
        curve: Column,
        /// What its size should not exceed.
        bound: Column,
    },
    /// The path of a point.
    Path(PointId),
    /// The force of a joint: name, x and y.
    Hodograph(String, [Column; 2]),
    /// Curves of one quantity over another, each with values of its own.
    Graph {
        /// Its name.
        name: String,
        /// What runs to the right, and its unit.
        x: (String, Unit),
        /// What runs up.
        y: (String, Unit),
        /// Its curves, in these units.
        curves: Vec<PlaneCurve>,
    },
    /// Designs in two goals, none of them better than another in all goals of its study.
    Front {
        /// The first goal, one value for each design.
        x: Column,
        /// The other one.
        y: Column,
        /// Both of the file's own design, in their columns' units.
        own: Option<[f64; 2]>,
    },
    /// How often a number has its values.
    Histogram {
        /// Its name.
        number: String,
        /// Its unit.
        unit: Unit,
        /// Ends of the bins, in the unit.
        edges: Vec<f64>,
        /// How often it lies in each.
        counts: Vec<f64>,
        /// Limits of it, with their names.
        limits: Vec<(String, f64)>,
    },
    /// Curves in the plane that belong to no motion.
    Plane {
        /// Its name.
        name: String,
        /// The unit of both axes.
        unit: Unit,
        /// Its curves.
        curves: Vec<PlaneCurve>,
    },
}

/// A curve in the plane.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PlaneCurve {
    /// Name in the legend.
    pub name: String,
    /// Its points in the figure's unit; a gap where they are not finite.
    pub points: Vec<[f64; 2]>,
    /// Whether it is dashed.
    pub dashed: bool,
}

impl PlaneCurve {
    /// Lines through places, m, with the pen lifted between them.
    pub(crate) fn lines<L>(
        name: &str,
        dashed: bool,
        lines: impl IntoIterator<Item = L>,
        unit: &Unit,
    ) -> Self
    where
        L: IntoIterator<Item = [f64; 2]>,
    {
        let mut points = Vec::new();
        for line in lines {
            if !points.is_empty() {
                points.push([f64::NAN; 2]);
            }
            points.extend(line.into_iter().map(|p| p.map(|x| shown(x, unit))));
        }
        Self {
            name: name.to_owned(),
            points,
            dashed,
        }
    }
}

/// Where everything is in one row, SI.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Frame {
    /// x, y (m) and angle (rad) of every link.
    pub links: Vec<[f64; 3]>,
    /// Places of the points, m.
    pub points: Vec<[f64; 2]>,
    /// How the points move: in time, or along a circuit to the drive's coordinate.
    pub rates: Vec<PointRates>,
    /// What acts on the links, where forces were asked for.
    pub arrows: Vec<ForceArrow>,
}

/// A place worth knowing.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Event {
    /// What it is.
    pub kind: EventKind,
    /// Where, SI: the coordinate of the drive, or time.
    pub at: f64,
    /// Where, in words: `lock = 117.512 deg`.
    pub place: String,
    /// What it is, in words.
    pub label: String,
    /// The row nearest to it.
    pub row: usize,
}
