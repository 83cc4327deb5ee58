//! What is asked of a model.

use kempe_units::{Dimension, Expr};

use crate::adjust::AdjustStudy;
use crate::clearance::ClearanceStudy;
use crate::contact::ContactStudy;
use crate::designs::{OptimizeStudy, OverStudy, SweepStudy, ToleranceStudy};
use crate::ids::{DriveId, JointId, LinkId, PointId, Scalar, Span};
use crate::measure::{Leaf, Measure};
use crate::synthesis::SynthesizeStudy;

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
    /// How it moves in time where drives are let go.
    Simulate(SimulateStudy),
    /// What play at the joints does. Rows, columns and plots as for forces.
    Clearance(ClearanceStudy),
    /// What play at the joints does where contact is lost. Rows, columns and plots as of a simulation.
    Contact(ContactStudy),
    /// The natural vibrations about a pose, or about the poses of a motion.
    Vibrations(VibrationStudy),
    /// Values of parameters with which it does what was measured.
    Adjust(Box<AdjustStudy>),
    /// Another study for given values of parameters.
    Sweep(Box<SweepStudy>),
    /// What tolerances do to another study's numbers.
    Tolerance(Box<ToleranceStudy>),
    /// The design that does something best.
    Optimize(Box<OptimizeStudy>),
    /// The linkages that do something: it needs no mechanism.
    Synthesize(Box<SynthesizeStudy>),
}

/// How a mechanism moves in time under what acts on it.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulateStudy {
    /// Where rows stand, in time; columns and plots.
    pub along: MotionStudy,
    /// Drives that are let go; the others keep their laws.
    pub released: Vec<DriveId>,
    /// Where drives that are let go start, and how fast; elsewhere where their laws do, and at rest.
    pub start: Vec<DriveStart>,
    /// Where the bodies of joints with play start in them, and how fast; elsewhere in the middle, and moving as without play. Of studies of
    /// clearance alone.
    pub plays: Vec<PlayStart>,
    /// How long, s.
    pub until: Scalar,
    /// What stops it.
    pub stops: Vec<Stop>,
    /// It ends when one of these comes to hold.
    pub end_when: Vec<Condition>,
    /// Error of a step, in parts of what moves.
    pub tolerance: Option<Scalar>,
    /// How steps are made; as suits where it is not said.
    pub method: Option<StepMethod>,
    /// Which coordinates tell the place on the way; minimal ones where it is not said.
    pub coordinates: Option<CoordinateKind>,
}

/// How a simulation makes its steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepMethod {
    /// Explicit ones, of high order.
    Explicit,
    /// Implicit ones, which stiff springs do not hold back.
    Implicit,
}

/// Which coordinates tell the place of a mechanism in a simulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoordinateKind {
    /// As many as it has freedoms.
    Minimal,
    /// Those of a spanning tree, whose loops are closed by forces.
    SpanningTree,
}

/// How a drive that is let go starts.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveStart {
    /// The drive.
    pub drive: DriveId,
    /// Where, rad or m.
    pub at: Option<Scalar>,
    /// How fast, rad/s or m/s.
    pub rate: Option<Scalar>,
}

/// How the bodies of a joint with play start.
#[derive(Clone, Debug, PartialEq)]
pub struct PlayStart {
    /// The joint.
    pub at: PlayAt,
    /// Where: of a pin the later link's point seen from the first one's, along the frame's axes, m; of a slider how far it is off its line, m,
    /// and by which angle it is turned, rad.
    pub place: Option<[Scalar; 2]>,
    /// The rates of these.
    pub rate: Option<[Scalar; 2]>,
    /// Where it stands in the file.
    pub span: Span,
}

/// A joint as a study names it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlayAt {
    /// The pin of a point, which has play on one link.
    Pin(PointId),
    /// A slider.
    Joint(JointId),
}

/// Bounds that an angle or a length cannot pass.
#[derive(Clone, Debug, PartialEq)]
pub struct Stop {
    /// The link, drive or named measure, as written.
    pub name: String,
    /// What is bounded.
    pub what: Measure,
    /// Whether it is an angle; otherwise it is a length.
    pub is_angle: bool,
    /// Least and largest; `None` for no bound.
    pub between: [Option<Scalar>; 2],
    /// How the stop resists.
    pub resistance: StopResistance,
}

impl Stop {
    /// What is not negative as long as the stop is not passed, at either end; whether that is the least value.
    pub fn gaps(&self) -> impl Iterator<Item = (bool, Measure)> + '_ {
        let ends = self.between.iter().zip([true, false]);
        ends.filter_map(|(bound, least)| {
            let bound = bound.clone()?.map_leaves(&mut |id| Leaf::Parameter(*id));
            let (large, small) = match least {
                true => (self.what.clone(), bound),
                false => (bound, self.what.clone()),
            };
            Some((least, Expr::Sub(Box::new(large), Box::new(small))))
        })
    }
}

/// How a stop resists.
#[derive(Clone, Debug, PartialEq)]
pub enum StopResistance {
    /// At once.
    Rigid {
        /// Speed after an impact over that before, from 0 to 1; 0 where none is given.
        restitution: Option<Scalar>,
    },
    /// As a spring and a damper that never pull.
    Soft {
        /// N/m or N m/rad.
        stiffness: Scalar,
        /// N s/m or N m s/rad; 0 where none is given.
        damping: Option<Scalar>,
    },
}

/// Something that holds or does not at every instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    /// As written: `angle(rocker) <= 0 deg`.
    pub text: String,
    /// It holds where this is not negative.
    pub above: Measure,
    /// Dimension of what it compares.
    pub dimension: Dimension,
}

/// How a mechanism vibrates when some of its drives are let go.
#[derive(Clone, Debug, PartialEq)]
pub struct VibrationStudy {
    /// Where rows stand along the motion of the drives that are held; of one pose alone, one row.
    pub along: MotionStudy,
    /// The drives that are let go.
    pub release: Vec<DriveId>,
    /// Where drives stand; others at their start.
    pub at: Vec<(DriveId, Scalar)>,
    /// Whether what is let go first sinks to static equilibrium.
    pub settles: bool,
    /// Whether the other drives move by their laws in every row, or stand still.
    pub moving: bool,
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
    /// What a study of many designs runs for each of them.
    pub fn over(&self) -> Option<&OverStudy> {
        match self {
            Self::Sweep(study) => Some(&study.over),
            Self::Tolerance(study) => Some(&study.over),
            Self::Optimize(study) => Some(&study.over),
            _ => None,
        }
    }

    /// Rows, columns and plots of a study, whatever it asks.
    pub fn along(&self) -> &MotionStudy {
        match self {
            Self::Motion(along) | Self::Forces(along) => along,
            Self::Balance(study) => &study.along,
            Self::Spring(study) => &study.along,
            Self::Simulate(study) => &study.along,
            Self::Clearance(study) => &study.along,
            Self::Contact(study) => &study.motion.along,
            Self::Vibrations(study) => &study.along,
            Self::Adjust(study) => &study.along,
            Self::Sweep(study) => &study.over.asked,
            Self::Tolerance(study) => &study.over.asked,
            Self::Optimize(study) => &study.over.asked,
            Self::Synthesize(study) => &study.along,
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
