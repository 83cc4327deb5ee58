//! What is asked of a model.

use crate::adjust::AdjustStudy;
use crate::clearance::ClearanceStudy;
use crate::contact::ContactStudy;
use crate::designs::{OptimizeStudy, OverStudy, SweepStudy, ToleranceStudy};
use crate::ids::{DriveId, LinkId, PointId, Scalar, Span};
use crate::measure::Measure;
use crate::motion_study::MotionStudy;
use crate::simulate_study::SimulateStudy;
use crate::synthesis::SynthesizeStudy;

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
