//! Measures: what a study reports. An expression whose leaves ask the mechanism something.

use kempe_units::{Dimension, Expr};

use crate::ids::{DriveId, Line, LinkId, LinkPointRef, ParameterId, PointId, Scalar, Span};
use crate::inner::InnerState;

/// An expression over parameters, names and questions to the mechanism, in SI.
pub type Measure = Expr<Leaf>;

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

/// A leaf of a measure.
#[derive(Clone, Debug, PartialEq)]
pub enum Leaf {
    /// A parameter of the model.
    Parameter(ParameterId),
    /// Another named measure of the model, by index into `Model::measures`.
    Named(usize),
    /// The coordinate of a drive.
    Drive(DriveId),
    /// Time since the start of the motion.
    Time,
    /// A state that only a simulation follows: a pressure, Pa, or a switch, 1 where it is on and 0 where it is off.
    Inner(InnerState),
    /// A question to the mechanism at one pose.
    Pose(PoseMeasure),
    /// The n-th time derivative of a measure.
    Rate(Box<Measure>, u32),
    /// The n-th derivative of a measure to a drive's coordinate, the other drives at rest: a kinematic coefficient.
    Coefficient(Box<Measure>, DriveId, u32),
    /// A question to the forces at one instant.
    Force(ForceMeasure),
    /// One number over a whole motion.
    Over(Statistic, Box<Measure>),
}

/// What may be asked of one pose.
#[derive(Clone, Debug, PartialEq)]
pub enum PoseMeasure {
    /// `x(P)`, `y(P)`: a coordinate of a point in the frame, m.
    X(PointId),
    /// See [`PoseMeasure::X`].
    Y(PointId),
    /// `x(P, link)`, `y(P, link)`: a coordinate of a point seen from a link, in the link's own frame, m.
    XOn(PointId, LinkId),
    /// See [`PoseMeasure::XOn`].
    YOn(PointId, LinkId),
    /// `angle(link)`: from the frame's x axis to the link's, unwrapped along the motion, rad.
    Angle(LinkId),
    /// `angle(link, other)`: from the other link's x axis to the link's, rad.
    AngleBetween(LinkId, LinkId),
    /// `angle(A -> B)`: direction of a line between two points, unwrapped along the motion, rad.
    Direction(PointId, PointId),
    /// `distance(A, B)`, m.
    Distance(PointId, PointId),
    /// `distance(P, A -> B)`: signed distance of a point from a line, positive on its left, m.
    DistanceToLine(PointId, Line),
    /// `travel(joint)`: coordinate of a slider or of a pin along its guide, from the guide's first point, m.
    Travel(LinkPointRef, Line),
    /// `transmission_angle(P)`: the angle between the two links pinned at P that pass the motion on, folded into
    /// [0, pi/2]: measured at P between the directions to each link's other pin.
    TransmissionAngle {
        /// The pin.
        at: PointId,
        /// The other end on the first link.
        a: PointId,
        /// The other end on the second link.
        b: PointId,
        /// Fold into [0, pi/2], or leave the angle in [0, pi].
        folded: bool,
    },
    /// `speed(P)`: m/s.
    Speed(PointId),
    /// `acceleration(P)`: size of the acceleration of a point, m/s^2.
    Acceleration(PointId),
    /// `angular_speed(link)`: rad/s, signed.
    AngularSpeed(LinkId),
    /// `angular_acceleration(link)`: rad/s^2, signed.
    AngularAcceleration(LinkId),
    /// `instant_center_x(a, b)`: x of the instant centre of two links, m (infinite when they translate).
    InstantCenterX(LinkId, LinkId),
    /// `instant_center_y(a, b)`: y of it.
    InstantCenterY(LinkId, LinkId),
    /// `curvature(P)`: signed curvature of the point's path, positive turning left along the motion, 1/m.
    Curvature(PointId),
    /// `curvature_center_x(P)`: x of the centre of curvature, m.
    CurvatureCenterX(PointId),
    /// `curvature_center_y(P)`: y of it.
    CurvatureCenterY(PointId),
    /// `path_length(P)`: length of path swept since the start of the motion, m.
    PathLength(PointId),
    /// `mechanical_advantage(out, drive)`: the drive's speed over that of the output measure, as a ratio of
    /// virtual displacements: 1 / d(out, drive).
    MechanicalAdvantage(Box<Measure>, DriveId),
}

/// What may be asked of the forces at one instant of a motion.
#[derive(Clone, Debug, PartialEq)]
pub enum ForceMeasure {
    /// `torque(drive)`, `force(drive)`: what the drive must give, positive along its coordinate, N m or N.
    Drive(DriveId),
    /// `reaction(P)`, `reaction(P, link)`, `reaction(joint)`: size of the force a joint carries, N.
    Reaction(JointRef),
    /// `reaction_x(...)`: its component along the frame's x axis, N, on the later-named link of the joint, or on the
    /// link given.
    ReactionX(JointRef),
    /// `reaction_y(...)`: along y.
    ReactionY(JointRef),
    /// `reaction_angle(...)`: its direction on that link, from the frame's x axis, rad in (-pi, pi].
    ReactionAngle(JointRef),
    /// `reaction_along(P, link)`: component along the x axis of that link, N.
    ReactionAlong(JointRef),
    /// `reaction_across(P, link)`: component along the y axis of that link, N.
    ReactionAcross(JointRef),
    /// `reaction_moment(joint)`: moment a slider, weld or belt carries, N m.
    ReactionMoment(JointRef),
    /// `power(drive)`: W.
    Power(DriveId),
    /// `kinetic_energy`: J.
    KineticEnergy,
    /// `potential_energy`: of gravity and springs, J.
    PotentialEnergy,
    /// `shaking_force_x`: force of the moving links on the frame, N.
    ShakingForceX,
    /// `shaking_force_y`.
    ShakingForceY,
    /// `shaking_force`: its size.
    ShakingForce,
    /// `shaking_moment`: moment of the moving links on the frame about the origin, N m.
    ShakingMoment,
    /// `reduced_mass(drive)`: equivalent mass or inertia at a drive, kg or kg m^2.
    ReducedMass(DriveId),
    /// `reduced_load(drive)`: all loads, gravity and springs reduced to a drive, N or N m.
    ReducedLoad(DriveId),
    /// `pressure(drive)`: in the pushing chamber of a hydraulic cylinder, Pa.
    Pressure(DriveId),
    /// `capacity(drive)`: what a hydraulic cylinder can give at its supply or relief pressure along its coordinate, N; what
    /// a motor can give at its speed, N m.
    Capacity(DriveId),
    /// `spring_force(spring)`: tension, N or N m.
    Spring(usize),
    /// `damper_force(damper)`: tension, N or N m.
    Damper(usize),
    /// `load(load)`: size of a force, N; a torque with its sign, N m.
    Load(usize),
    /// `load_x(load)`: its component along the frame's x axis, N.
    LoadX(usize),
    /// `load_y(load)`: along y.
    LoadY(usize),
}

impl ForceMeasure {
    /// Whether it is a direction, known but for whole turns.
    pub fn is_direction(&self) -> bool {
        matches!(self, Self::ReactionAngle(_))
    }
}

/// A joint whose reaction is asked for, and the body on which it acts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointRef {
    /// A pin; on the later-named of its links unless a link is given.
    Pin(PointId, Option<LinkId>),
    /// A joint of the file; on its first-named link (the slider, the pin's link) unless a link is given.
    Joint(crate::ids::JointId, Option<LinkId>),
}

/// A number over a whole motion.
#[derive(Clone, Debug, PartialEq)]
pub enum Statistic {
    /// Smallest, located between rows.
    Min,
    /// Largest, located between rows.
    Max,
    /// Mean over time.
    Mean,
    /// Largest minus smallest.
    Range,
    /// Value at a drive coordinate or time (SI).
    At {
        /// The drive, or time when none.
        drive: Option<DriveId>,
        /// Where; it may hang on parameters.
        value: Scalar,
    },
    /// Duration ratio of the slower to the faster of the two strokes of a measure over a cycle.
    TimeRatio,
}
