//! Studies of what moves by itself.

use kempe_units::Expr;

use crate::condition::Condition;
use crate::ids::{DriveId, JointId, PointId, Scalar, Span};
use crate::measure::{Leaf, Measure};
use crate::motion_study::MotionStudy;

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
