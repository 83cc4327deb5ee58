//! The mechanism as the user described it: plain data in SI, nothing computed.
//!
//! Every dimension is an expression over the parameters, so that one model serves a whole space of designs: evaluate
//! the parameters on any [`Number`](kempe_number::Number) and everything else follows.

use std::ops::Range;

use kempe_units::{Dimension, Expr};

use crate::bounds::Bound;
use crate::measure::Measure;

/// A place in the model file, in bytes.
pub type Span = Range<usize>;

/// An expression over the model's parameters, in SI.
pub type Scalar = Expr<ParameterId>;

macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub struct $name(pub u32);

        impl $name {
            /// The index into the model's list.
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }
    };
}
id!(
    /// A parameter of the model.
    ParameterId
);
id!(
    /// A link; `LinkId(0)` is the frame.
    LinkId
);
id!(
    /// A named point. A point that several links carry is a pin between them.
    PointId
);
id!(
    /// A joint other than a pin that a shared point name makes.
    JointId
);
id!(
    /// A drive.
    DriveId
);

/// The frame's link.
pub const FRAME: LinkId = LinkId(0);

/// A mechanism with its drives, measures and studies.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// The file's title, or its name.
    pub title: String,
    /// The file's own units, for showing lengths and angles back to the user.
    pub units: FileUnits,
    /// Parameters, each depending only on earlier ones.
    pub parameters: Vec<Parameter>,
    /// Links; the first is the frame.
    pub links: Vec<Link>,
    /// Named points in order of first appearance.
    pub points: Vec<Point>,
    /// Joints that shared names do not say, in file order.
    pub joints: Vec<Joint>,
    /// Drives in file order.
    pub drives: Vec<Drive>,
    /// What acts on it.
    pub actions: crate::load::Actions,
    /// Which assembly is meant.
    pub assembly: Vec<AssemblyHint>,
    /// Named measures in file order; a measure may use earlier and later ones but not itself.
    pub measures: Vec<NamedMeasure>,
    /// Studies in file order.
    pub studies: Vec<Study>,
    /// Studies that are skipped: this version has not got their kind.
    pub announced: Vec<AnnouncedStudy>,
    /// What the file's values must keep to, whatever the parameters are set to.
    pub bounds: Vec<Bound>,
    /// Parameters whose values went into plain numbers when the file was read (the place of an `at`, the period of a table).
    pub settled: Vec<ParameterId>,
}

/// Units in which bare numbers of the file are read and results are shown: m and deg where the file names none.
///
/// Bare numbers of other dimensions are in the unit that results are shown in, made of these two with kg and s:
/// a bare speed in a file in mm is in mm/s, a bare moment of inertia always in kg m^2.
#[derive(Clone, Debug, PartialEq)]
pub struct FileUnits {
    /// Length unit, as written, such as `mm`.
    pub length: UnitName,
    /// Angle unit, as written, such as `deg`.
    pub angle: UnitName,
    /// Units of force, torque, pressure, power and mass, where the file names them.
    pub more: Vec<UnitName>,
}

/// A unit by the name the user wrote, with its size in SI.
#[derive(Clone, Debug, PartialEq)]
pub struct UnitName {
    /// As written.
    pub name: String,
    /// One of it, in SI.
    pub factor: f64,
}

/// A named dimension of the design.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name.
    pub name: String,
    /// Value, from earlier parameters.
    pub value: Scalar,
    /// Dimension.
    pub dimension: Dimension,
    /// Where it stands in the file (the value).
    pub span: Span,
}

/// A rigid body: a set of named points.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// Name; the first link is `frame`.
    pub name: String,
    /// Its points, each placed in the link's own frame from earlier ones of the same link.
    pub points: Vec<LinkPoint>,
    /// Mass properties, when given.
    pub inertia: Option<Inertia>,
    /// Where the link is described.
    pub span: Span,
}

/// A point of a link.
#[derive(Clone, Debug, PartialEq)]
pub struct LinkPoint {
    /// Which named point.
    pub point: PointId,
    /// Where it lies in the link's own frame.
    pub place: Place,
    /// Where it is described.
    pub span: Span,
}

/// Where a point lies in its link's own frame (lengths m, angles rad counter-clockwise).
#[derive(Clone, Debug, PartialEq)]
pub enum Place {
    /// Cartesian coordinates. The origin of a link laid out by distances is `(0, 0)`.
    Cartesian {
        /// x.
        x: Scalar,
        /// y.
        y: Scalar,
    },
    /// Polar coordinates.
    Polar {
        /// Distance from the link's origin.
        radius: Scalar,
        /// Direction from the link's x axis.
        angle: Scalar,
    },
    /// By its distances to two earlier points of the link, on the named side of the directed line between them.
    Triangle {
        /// Index into the link's points of the line's start.
        from: usize,
        /// Index into the link's points of the line's end.
        to: usize,
        /// Distance to the line's start.
        from_distance: Scalar,
        /// Distance to the line's end.
        to_distance: Scalar,
        /// The side on which the point lies.
        side: Side,
    },
}

/// A side of a directed line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// On the left of somebody walking along the line.
    Left,
    /// On the right.
    Right,
}

impl Side {
    /// +1 for left, -1 for right: the sign of the cross product.
    pub fn sign(self) -> f64 {
        match self {
            Side::Left => 1.0,
            Side::Right => -1.0,
        }
    }
}

/// Mass properties of a link.
#[derive(Clone, Debug, PartialEq)]
pub struct Inertia {
    /// Mass, kg.
    pub mass: Option<Scalar>,
    /// Moment of inertia about the centre of mass, kg m^2.
    pub moment: Option<Scalar>,
    /// Where the centre of mass lies.
    pub center: Center,
}

/// Where a centre of mass lies.
#[derive(Clone, Debug, PartialEq)]
pub enum Center {
    /// The mean of the link's points.
    Centroid,
    /// At a named point of the link.
    Point(PointId),
    /// In the link's own frame.
    Place(Place),
}

/// A named point of the mechanism.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Name, starting with a capital letter.
    pub name: String,
    /// The links that carry it, in file order. Two or more make a pin (a multiple joint of k links counts k - 1).
    pub links: Vec<LinkId>,
}

/// A directed line through two points of one link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Line {
    /// The link that carries the line.
    pub link: LinkId,
    /// Start.
    pub from: PointId,
    /// End: gives the direction.
    pub to: PointId,
}

/// A circular arc through two points of one link.
#[derive(Clone, Debug, PartialEq)]
pub struct CircularArc {
    /// The link that carries the arc.
    pub link: LinkId,
    /// Start.
    pub from: PointId,
    /// End.
    pub to: PointId,
    /// Radius.
    pub radius: Scalar,
    /// Side of the way from start to end on which the centre lies.
    pub side: Side,
    /// The whole circle counts, not only its shorter part between start and end.
    pub closed: bool,
}

/// A point as a part of one link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LinkPointRef {
    /// The link.
    pub link: LinkId,
    /// The point on it.
    pub point: PointId,
}

/// A joint that a shared point name does not say.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Name.
    pub name: String,
    /// What it does.
    pub kind: JointKind,
    /// Where it stands in the file.
    pub span: Span,
}

/// The kinds of joint.
#[derive(Clone, Debug, PartialEq)]
pub enum JointKind {
    /// A prismatic pair: `at` stays on the line, and the slider's x axis keeps the angle `angle` to it.
    Slider {
        /// The point of the slider that stays on the line.
        at: LinkPointRef,
        /// The guide, on another link.
        on: Line,
        /// Angle from the guide's direction to the slider's x axis, rad.
        angle: Scalar,
    },
    /// A pin in a straight slot: a point of one link stays on a line of another.
    Slot {
        /// The pin.
        pin: LinkPointRef,
        /// The slot.
        on: Line,
    },
    /// A pin in a curved slot: a point of one link stays on an arc of another.
    ArcSlot {
        /// The pin.
        pin: LinkPointRef,
        /// The slot.
        on: CircularArc,
    },
    /// Two links made one: they share a point and keep an angle.
    Weld {
        /// The first link.
        a: LinkId,
        /// The second link.
        b: LinkId,
        /// The point they share.
        at: PointId,
        /// Angle from the x axis of `a` to that of `b`, rad.
        angle: Scalar,
    },
    /// Two gears in mesh, their axes on the arm.
    /// External: `teeth_a (angle_a - angle_arm) + teeth_b (angle_b - angle_arm) = teeth_a phase`; internal: minus.
    ///
    /// A gear counts turns, so it matters from where. Where the motion starts a driven link's angle is what its drive
    /// says, and that of any other link is the one within half a turn of its `near` hint, or of zero without one. The
    /// equation holds for these angles there, and on from there with all turns counted. Other meshings of the same
    /// wheels, a tooth further, are other phases.
    Gears {
        /// First gear.
        a: LinkId,
        /// Second gear.
        b: LinkId,
        /// The link that carries both axes.
        arm: LinkId,
        /// Teeth (or radii) of the first gear.
        teeth_a: Scalar,
        /// Teeth (or radii) of the second gear.
        teeth_b: Scalar,
        /// One of them is a ring.
        internal: bool,
        /// Angle of the first gear on the arm when that of the second is zero, rad.
        phase: Scalar,
    },
    /// A belt or chain over two wheels whose axes sit on the arm:
    /// `radius_a (angle_a - angle_arm) - radius_b (angle_b - angle_arm) = radius_a phase`; crossed: plus. Angles count as
    /// those of [`JointKind::Gears`] do.
    Belt {
        /// First wheel.
        a: LinkId,
        /// Second wheel.
        b: LinkId,
        /// The link that carries both axes.
        arm: LinkId,
        /// Radius at which the belt runs on the first wheel.
        radius_a: Scalar,
        /// Radius at which it runs on the second wheel.
        radius_b: Scalar,
        /// Its straight runs cross.
        crossed: bool,
        /// It is a chain, its wheels given by teeth and pitch.
        chain: bool,
        /// Angle of the first wheel on the arm when that of the second is zero, rad.
        phase: Scalar,
    },
    /// A pinion rolling on a rack. With `s` the pinion centre's coordinate along the rack's x axis and `side` the
    /// side of the rack on which the pinion lies: `s + side radius (angle_pinion - angle_rack) = offset`. Angles count
    /// as those of [`JointKind::Gears`] do.
    Rack {
        /// The link that carries the rack; its pitch line is parallel to its x axis.
        rack: LinkId,
        /// The pinion.
        pinion: LinkId,
        /// The pinion's centre (a point of the pinion).
        center: PointId,
        /// Pitch radius.
        radius: Scalar,
        /// Side of the rack's x axis on which the pinion lies.
        side: Side,
        /// Travel of the centre along the rack where pinion and rack are parallel.
        offset: Scalar,
    },
}

impl JointKind {
    /// The two links that the joint joins (of gears and belts: without the arm).
    pub fn links(&self) -> (LinkId, LinkId) {
        match *self {
            Self::Slider { at, on, .. } => (at.link, on.link),
            Self::Slot { pin, on } => (pin.link, on.link),
            Self::ArcSlot { pin, ref on } => (pin.link, on.link),
            Self::Weld { a, b, .. } | Self::Gears { a, b, .. } | Self::Belt { a, b, .. } => (a, b),
            Self::Rack { rack, pinion, .. } => (rack, pinion),
        }
    }

    /// The point that slides along a straight guide, and the guide, of a slider or slot.
    pub fn guide(&self) -> Option<(LinkPointRef, Line)> {
        match *self {
            Self::Slider { at, on, .. } | Self::Slot { pin: at, on } => Some((at, on)),
            _ => None,
        }
    }

    /// Whether it ties the angles of its links and its load has a moment about the point where it is counted.
    pub fn holds_angle(&self) -> bool {
        matches!(
            self,
            Self::Slider { .. } | Self::Weld { .. } | Self::Belt { .. }
        )
    }
}

/// What is moved from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// Name.
    pub name: String,
    /// What it moves.
    pub kind: DriveKind,
    /// How it moves.
    pub law: Law,
    /// Dimension of its coordinate: angle or length.
    pub dimension: Dimension,
    /// Where it stands in the file.
    pub span: Span,
}

/// What a drive moves.
#[derive(Clone, Debug, PartialEq)]
pub enum DriveKind {
    /// The angle from the x axis of `relative_to` to that of `link`, rad. Either may float.
    Turn {
        /// The link that turns.
        link: LinkId,
        /// The link it turns against; the frame unless said otherwise.
        relative_to: LinkId,
    },
    /// The distance of two points: a hydraulic cylinder.
    Cylinder {
        /// Foot.
        a: LinkPointRef,
        /// Eye.
        b: LinkPointRef,
    },
    /// The travel of a slider or of a pin in its slot: the coordinate along the guide from its first point.
    Slide {
        /// The slider or slot joint.
        joint: JointId,
    },
}

/// How a drive moves in time.
#[derive(Clone, Debug, PartialEq)]
pub struct Law {
    /// Pieces in order; each starts where the one before ended.
    pub pieces: Vec<LawPiece>,
    /// Coordinate at the start.
    pub from: Scalar,
}

/// A piece of a motion law. `to` is the coordinate at its end.
#[derive(Clone, Debug, PartialEq)]
pub enum LawPiece {
    /// Constant speed. The sign of the speed is the direction of travel; only its size counts.
    ConstantSpeed {
        /// End coordinate.
        to: Scalar,
        /// Speed, per second, positive.
        speed: Scalar,
    },
    /// Constant acceleration from rest.
    ConstantAcceleration {
        /// End coordinate.
        to: Scalar,
        /// Acceleration, per second squared, positive.
        acceleration: Scalar,
    },
    /// Standing still.
    Dwell {
        /// How long, s.
        duration: Scalar,
    },
    /// From rest to rest by a standard law.
    Rise {
        /// End coordinate.
        to: Scalar,
        /// How long, s.
        duration: Scalar,
        /// By which law.
        by: RiseLaw,
    },
    /// Measured points joined by a smooth curve (twice continuously differentiable).
    Table {
        /// Times, s, increasing.
        times: Vec<f64>,
        /// Coordinates, SI.
        values: Vec<f64>,
        /// Second derivatives of the spline through them at these times, SI.
        moments: Vec<f64>,
    },
}

/// Standard laws from rest to rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RiseLaw {
    /// s - sin(2 pi s)/(2 pi).
    Cycloidal,
    /// (1 - cos(pi s))/2.
    Harmonic,
    /// 10 s^3 - 15 s^4 + 6 s^5.
    Polynomial345,
    /// 35 s^4 - 84 s^5 + 70 s^6 - 20 s^7.
    Polynomial4567,
}

/// Something the user says about which assembly is meant, at the start of the drives.
#[derive(Clone, Debug, PartialEq)]
pub struct AssemblyHint {
    /// What is said.
    pub kind: HintKind,
    /// Where it stands in the file.
    pub span: Span,
}

/// The kinds of assembly hint.
#[derive(Clone, Debug, PartialEq)]
pub enum HintKind {
    /// A point lies on a side of the directed line between two points.
    Side {
        /// The point.
        point: PointId,
        /// The side.
        side: Side,
        /// Line start.
        from: PointId,
        /// Line end.
        to: PointId,
    },
    /// A point lies near a place of the frame.
    NearPlace {
        /// The point.
        point: PointId,
        /// x, m.
        x: Scalar,
        /// y, m.
        y: Scalar,
    },
    /// A link's angle is near a value, rad.
    NearAngle {
        /// The link.
        link: LinkId,
        /// The angle.
        angle: Scalar,
    },
}

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
