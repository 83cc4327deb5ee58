//! The measures: one table for their reader, their order of derivatives, `kempe measures`, the docs and the hints on misspelt
//! names.

use kempe_units::Dimension as D;
use serde::ser::{Serialize, SerializeStruct, Serializer};

use crate::ids::{DriveId, LinkId, PointId};
use crate::inner::Chamber;
use crate::measure::{ForceMeasure as F, JointRef, PoseMeasure as P, Statistic as S};
use Gives::{ByDrive, Follows, Is};
use Nature::{Derivative, Forces, Geometric, InTime, Inner, WholeMotion};

/// A function that measures something.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct MeasureEntry {
    /// Its name.
    pub name: &'static str,
    /// The ways to call it.
    pub(crate) forms: &'static [Form],
    /// Its dimension.
    pub(crate) gives: Gives,
    /// What it asks for.
    pub nature: Nature,
    /// What it is, in one line.
    pub doc: &'static str,
    /// An example of its use.
    pub example: &'static str,
}

/// What a measure asks for, and how often it differentiates what it sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Nature {
    /// The pose, and so many of its derivatives to the drive; it has derivatives to a drive itself.
    Geometric(u32),
    /// The motion in time, and so many of its derivatives in time.
    InTime(u32),
    /// The forces, which need the accelerations.
    Forces,
    /// A state that only a simulation follows.
    Inner,
    /// The derivatives of another measure.
    Derivative,
    /// Another measure over the whole motion.
    WholeMotion,
}

impl Nature {
    /// How often the motion is differentiated, besides what an inner measure asks for.
    pub fn order(self) -> u32 {
        match self {
            Geometric(order) | InTime(order) => order,
            Forces => 2,
            Inner | Derivative | WholeMotion => 0,
        }
    }
}

/// The dimension of a measure, and that in words.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Gives {
    /// Always this one.
    Is(D, &'static str),
    /// The first for a drive along a line, the second for one that turns.
    ByDrive(D, D, &'static str),
    /// It follows from the arguments.
    Follows(&'static str),
}

impl Gives {
    /// The dimension, of a drive that turns or does not.
    pub fn of(self, turning: bool) -> D {
        match self {
            Is(dimension, _) => dimension,
            ByDrive(along, turns, _) => {
                if turning {
                    turns
                } else {
                    along
                }
            }
            Follows(_) => D::NONE,
        }
    }
}

/// An argument of a measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Argument {
    /// A point, with the letter that stands for it in signatures.
    Point(&'static str),
    /// A link.
    Link,
    /// A second link.
    OtherLink,
    /// A directed line.
    Line,
    /// A link that slides.
    Slider,
    /// A joint of `[joints]`.
    Joint,
    /// A drive.
    Drive,
    /// A spring.
    Spring,
    /// A damper.
    Damper,
    /// A load.
    Load,
    /// A switch.
    Switch,
    /// Another measure.
    Measure,
    /// The order of a derivative.
    Order,
    /// The time.
    Time,
    /// A value of a drive or of the time.
    Value,
}

impl Argument {
    /// As it stands in signatures.
    pub fn label(self) -> &'static str {
        match self {
            Self::Point(letter) => letter,
            Self::Link => "link",
            Self::OtherLink => "other",
            Self::Line => "A -> B",
            Self::Slider => "slider",
            Self::Joint => "joint",
            Self::Drive => "drive",
            Self::Spring => "spring",
            Self::Damper => "damper",
            Self::Load => "load",
            Self::Switch => "switch",
            Self::Measure => "measure",
            Self::Order => "n",
            Self::Time => "time",
            Self::Value => "value",
        }
    }
}

/// A way to call a measure: what its arguments are, and what is made of them.
#[derive(Debug)]
pub(crate) enum Form {
    Point(fn(PointId) -> P),
    PointLink(fn(PointId, LinkId) -> P),
    Link(fn(LinkId) -> P),
    LinkLink(fn(LinkId, LinkId) -> P),
    /// Of a link against another, or the frame.
    LinkOrFrame(fn(LinkId, LinkId) -> P),
    Direction,
    Corner,
    Distance,
    DistanceToLine,
    Travel,
    Cylinder,
    Transmission,
    Advantage,
    /// What a drive must give that turns or does not.
    Effort {
        turning: bool,
    },
    Drive(fn(DriveId) -> F),
    Joint(fn(JointRef) -> F),
    /// The same where the link must be named.
    JointOnLink(fn(JointRef) -> F),
    Moment,
    Spring,
    Damper,
    Load,
    LoadComponent(fn(usize) -> F),
    Pressure,
    /// In a chamber of a cylinder with oil.
    Chamber(Chamber),
    Switch,
    Capacity,
    /// Of the whole mechanism: without arguments and brackets.
    Whole(F),
    Rate,
    Coefficient,
    Over(S),
    Stroke,
    At,
}

impl Form {
    /// Its lists of arguments.
    pub fn arguments(&self) -> &'static [&'static [Argument]] {
        use Argument as A;
        const P: A = A::Point("P");
        const ENDS: [A; 2] = [A::Point("A"), A::Point("B")];
        match self {
            Self::Point(_) => &[&[P]],
            Self::PointLink(_) => &[&[P, A::Link]],
            Self::Link(_) => &[&[A::Link]],
            Self::LinkLink(_) => &[&[A::Link, A::OtherLink]],
            Self::LinkOrFrame(_) => &[&[A::Link], &[A::Link, A::OtherLink]],
            Self::Direction => &[&[A::Line]],
            Self::Corner => &[&[ENDS[0], ENDS[1], A::Point("C")]],
            Self::Distance => &[&ENDS],
            Self::DistanceToLine => &[&[P, A::Line]],
            Self::Travel => &[&[A::Slider], &[A::Joint]],
            Self::Transmission => &[&[P], &[P, ENDS[0], ENDS[1]]],
            Self::Advantage => &[&[A::Measure, A::Drive]],
            Self::Cylinder
            | Self::Effort { .. }
            | Self::Drive(_)
            | Self::Pressure
            | Self::Chamber(_)
            | Self::Capacity => &[&[A::Drive]],
            Self::Joint(_) => &[&[P], &[P, A::Link], &[A::Joint], &[A::Joint, A::Link]],
            Self::JointOnLink(_) => &[&[P, A::Link], &[A::Joint, A::Link]],
            Self::Moment => &[&[A::Joint], &[A::Joint, A::Link]],
            Self::Spring => &[&[A::Spring]],
            Self::Damper => &[&[A::Damper]],
            Self::Load | Self::LoadComponent(_) => &[&[A::Load]],
            Self::Switch => &[&[A::Switch]],
            Self::Whole(_) => &[],
            Self::Rate => &[&[A::Measure], &[A::Measure, A::Order]],
            Self::Coefficient => &[&[A::Measure, A::Drive], &[A::Measure, A::Drive, A::Order]],
            Self::Over(_) => &[&[A::Measure]],
            Self::Stroke => &[&[A::Measure], &[A::Slider], &[A::Drive]],
            Self::At => &[
                &[A::Measure, A::Drive, A::Value],
                &[A::Measure, A::Time, A::Value],
            ],
        }
    }
}

impl MeasureEntry {
    /// The lists of arguments with which it may be called; none where it has none and is written without brackets.
    pub fn arguments(&self) -> impl Iterator<Item = &'static [Argument]> + use<> {
        let forms = self.forms.iter();
        forms.flat_map(|form| form.arguments().iter().copied())
    }

    /// How it is called.
    pub fn signatures(&self) -> Vec<String> {
        let call = |arguments: &[Argument]| {
            let labels: Vec<&str> = arguments.iter().map(|a| a.label()).collect();
            format!("{}({})", self.name, labels.join(", "))
        };
        let calls: Vec<String> = self.arguments().map(call).collect();
        match calls.is_empty() {
            true => vec![self.name.to_owned()],
            false => calls,
        }
    }

    /// What it measures: a dimension, or how it follows from the arguments'.
    pub fn dimension(&self) -> &'static str {
        match self.gives {
            Is(_, words) | ByDrive(_, _, words) | Follows(words) => words,
        }
    }
}

impl P {
    /// The row of the registry that it belongs to.
    pub fn entry(&self) -> Option<&'static MeasureEntry> {
        Registry::find(match self {
            Self::X(_) | Self::XOn(..) => "x",
            Self::Y(_) | Self::YOn(..) => "y",
            Self::Angle(_) | Self::AngleBetween(..) | Self::Direction(..) => "angle",
            Self::TransmissionAngle { folded: false, .. } => "angle",
            Self::Distance(..) | Self::DistanceToLine(..) => "distance",
            Self::Travel(..) => "travel",
            Self::TransmissionAngle { folded: true, .. } => "transmission_angle",
            Self::Speed(_) => "speed",
            Self::Acceleration(_) => "acceleration",
            Self::AngularSpeed(_) => "angular_speed",
            Self::AngularAcceleration(_) => "angular_acceleration",
            Self::InstantCenterX(..) => "instant_center_x",
            Self::InstantCenterY(..) => "instant_center_y",
            Self::Curvature(_) => "curvature",
            Self::CurvatureCenterX(_) => "curvature_center_x",
            Self::CurvatureCenterY(_) => "curvature_center_y",
            Self::PathLength(_) => "path_length",
            Self::MechanicalAdvantage(..) => "mechanical_advantage",
        })
    }

    /// What it asks for.
    pub fn nature(&self) -> Nature {
        self.entry().map_or(Geometric(0), |entry| entry.nature)
    }
}

impl Serialize for MeasureEntry {
    fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        let mut fields = serializer.serialize_struct("MeasureEntry", 5)?;
        fields.serialize_field("name", self.name)?;
        fields.serialize_field("signatures", &self.signatures())?;
        fields.serialize_field("dimension", self.dimension())?;
        fields.serialize_field("doc", self.doc)?;
        fields.serialize_field("example", self.example)?;
        fields.end()
    }
}

/// The registry of measures.
#[derive(Clone, Copy, Debug)]
pub struct Registry;

impl Registry {
    /// All measures, in the order of the reference.
    pub fn all() -> &'static [MeasureEntry] {
        MEASURES
    }

    /// The measure of a name.
    pub fn find(name: &str) -> Option<&'static MeasureEntry> {
        MEASURES.iter().find(|m| m.name == name)
    }
}

const fn row(
    name: &'static str,
    forms: &'static [Form],
    gives: Gives,
    nature: Nature,
    example: &'static str,
    doc: &'static str,
) -> MeasureEntry {
    MeasureEntry {
        name,
        forms,
        gives,
        nature,
        doc,
        example,
    }
}

const LENGTH: Gives = Is(D::LENGTH, "length");
const ANGLE: Gives = Is(D::ANGLE, "angle");
const FORCE: Gives = Is(D::FORCE, "force");
const TORQUE: Gives = Is(D::TORQUE, "torque");
const ENERGY: Gives = Is(D::ENERGY, "energy");

#[rustfmt::skip]
const MEASURES: &[MeasureEntry] = &[
    row("x", &[Form::Point(P::X), Form::PointLink(P::XOn)], LENGTH, Geometric(0), "x(P)",
        "x of a point in the frame, or seen from a link in the link's own coordinates"),
    row("y", &[Form::Point(P::Y), Form::PointLink(P::YOn)], LENGTH, Geometric(0), "y(P, coupler)",
        "y of a point in the frame, or seen from a link in the link's own coordinates"),
    row("angle", &[Form::Link(P::Angle), Form::LinkLink(P::AngleBetween), Form::Direction, Form::Corner], ANGLE, Geometric(0), "angle(rocker)",
        "from the frame's x axis (or another link's) to the link's, counter-clockwise and unwrapped; of a directed line; or at B between A and C, 0 to 180 deg"),
    row("distance", &[Form::Distance, Form::DistanceToLine], LENGTH, Geometric(0), "distance(B, D)",
        "of two points; or of a point from a line of a link, positive on its left"),
    row("travel", &[Form::Travel], LENGTH, Geometric(0), "travel(piston)",
        "of a slider or a pin along its guide, from the guide's first point"),
    row("length", &[Form::Cylinder], LENGTH, Geometric(0), "length(lift)",
        "of a cylinder"),
    row("transmission_angle", &[Form::Transmission], ANGLE, Geometric(0), "transmission_angle(C)",
        "between the two links pinned at P, 0 to 90 deg; each link's direction goes to its pin on the frame, or else to its first other pin; or name the two ends"),
    row("speed", &[Form::Point(P::Speed)], Is(D::SPEED, "length/time"), InTime(1), "speed(C)",
        "of a point in the frame, its size"),
    row("acceleration", &[Form::Point(P::Acceleration)], Is(D::ACCELERATION, "length/time^2"), InTime(2), "acceleration(C)",
        "of a point in the frame, its size"),
    row("angular_speed", &[Form::Link(P::AngularSpeed)], Is(D::ANGULAR_SPEED, "angle/time"), InTime(1), "angular_speed(rocker)",
        "of a link, positive counter-clockwise"),
    row("angular_acceleration", &[Form::Link(P::AngularAcceleration)], Is(D::ANGULAR_ACCELERATION, "angle/time^2"), InTime(2), "angular_acceleration(rocker)",
        "of a link, positive counter-clockwise"),
    row("instant_center_x", &[Form::LinkOrFrame(P::InstantCenterX)], LENGTH, Geometric(1), "instant_center_x(coupler)",
        "x of the instant centre of a link against the frame or another link; infinite when they translate"),
    row("instant_center_y", &[Form::LinkOrFrame(P::InstantCenterY)], LENGTH, Geometric(1), "instant_center_y(coupler)",
        "y of the instant centre of a link against the frame or another link; infinite when they translate"),
    row("curvature", &[Form::Point(P::Curvature)], Is(D::CURVATURE, "1/length"), Geometric(2), "curvature(P)",
        "of the point's path, positive where it turns left along the motion"),
    row("curvature_center_x", &[Form::Point(P::CurvatureCenterX)], LENGTH, Geometric(2), "curvature_center_x(P)",
        "x of the centre of curvature of the point's path"),
    row("curvature_center_y", &[Form::Point(P::CurvatureCenterY)], LENGTH, Geometric(2), "curvature_center_y(P)",
        "y of the centre of curvature of the point's path"),
    row("path_length", &[Form::Point(P::PathLength)], LENGTH, InTime(0), "path_length(P)",
        "length of path swept since the start of the motion"),
    row("mechanical_advantage", &[Form::Advantage], Follows("drive/measure"), Geometric(1), "mechanical_advantage(y(P), motor)",
        "the drive's speed over that of the measure: force out over force in without friction"),
    row("torque", &[Form::Effort { turning: true }], TORQUE, Forces, "torque(motor)",
        "that a turning drive must give, positive along its angle"),
    row("force", &[Form::Effort { turning: false }], FORCE, Forces, "force(lift)",
        "that a cylinder or a sliding drive must give, positive along its coordinate: a cylinder that pushes"),
    row("power", &[Form::Drive(F::Power)], Is(D::POWER, "power"), Forces, "power(motor)",
        "that a drive gives"),
    row("reaction", &[Form::Joint(F::Reaction)], FORCE, Forces, "reaction(B)",
        "size of the force that a pin or a joint carries"),
    row("reaction_x", &[Form::Joint(F::ReactionX)], FORCE, Forces, "reaction_x(B, crank)",
        "its component along the frame's x axis, on the link named; else on the later-named link of a pin, the slider or the first link of a joint"),
    row("reaction_y", &[Form::Joint(F::ReactionY)], FORCE, Forces, "reaction_y(B, crank)",
        "its component along the frame's y axis, on the link named; else on the later-named link of a pin, the slider or the first link of a joint"),
    row("reaction_angle", &[Form::Joint(F::ReactionAngle)], ANGLE, Forces, "reaction_angle(B, crank)",
        "its direction, from the frame's x axis, between -180 deg and 180 deg, on the link named; else as reaction_x"),
    row("reaction_along", &[Form::JointOnLink(F::ReactionAlong)], FORCE, Forces, "reaction_along(B, coupler)",
        "the component on a link along the link's own x axis"),
    row("reaction_across", &[Form::JointOnLink(F::ReactionAcross)], FORCE, Forces, "reaction_across(B, coupler)",
        "the component on a link along the link's own y axis"),
    row("reaction_moment", &[Form::Moment], TORQUE, Forces, "reaction_moment(bore)",
        "the moment that a slider, a weld or a belt carries"),
    row("spring_force", &[Form::Spring], Follows("force; torque of a torsion spring"), Forces, "spring_force(return)",
        "the tension of a spring"),
    row("damper_force", &[Form::Damper], Follows("force; torque of a torsion damper"), Forces, "damper_force(oil)",
        "the tension of a damper: it resists parting"),
    row("load", &[Form::Load], Follows("force; torque"), Forces, "load(hook)",
        "a load: the size of a force, a torque with its sign"),
    row("load_x", &[Form::LoadComponent(F::LoadX)], FORCE, Forces, "load_x(hook)",
        "the component of a force load along the frame's x axis"),
    row("load_y", &[Form::LoadComponent(F::LoadY)], FORCE, Forces, "load_y(hook)",
        "the component of a force load along the frame's y axis"),
    row("pressure", &[Form::Pressure], Is(D::PRESSURE, "pressure"), Forces, "pressure(lift)",
        "in the chamber of a hydraulic cylinder that drives"),
    row("bore_pressure", &[Form::Chamber(Chamber::Bore)], Is(D::PRESSURE, "pressure"), Inner, "bore_pressure(lift)",
        "of the oil on the bore's side of a cylinder that is let go, in a simulation"),
    row("ring_pressure", &[Form::Chamber(Chamber::Ring)], Is(D::PRESSURE, "pressure"), Inner, "ring_pressure(lift)",
        "of the oil on the rod's side of a cylinder that is let go, in a simulation"),
    row("switch", &[Form::Switch], Is(D::NONE, "number"), Inner, "switch(top)",
        "1 where a limit switch is on, 0 where it is off, in a simulation"),
    row("capacity", &[Form::Capacity], ByDrive(D::FORCE, D::TORQUE, "force; torque of a motor"), Forces, "capacity(lift)",
        "the most that a hydraulic cylinder can give along its coordinate at its supply or relief pressure, or a motor at its speed"),
    row("reduced_mass", &[Form::Drive(F::ReducedMass)], ByDrive(D::MASS, D::INERTIA, "mass; moment of inertia of a turning drive"), Forces, "reduced_mass(lift)",
        "of all links, as the drive feels them: twice the kinetic energy over the drive's speed squared"),
    row("reduced_load", &[Form::Drive(F::ReducedLoad)], ByDrive(D::FORCE, D::TORQUE, "force; torque of a turning drive"), Forces, "reduced_load(lift)",
        "of all loads, gravity and springs, as the drive feels them"),
    row("kinetic_energy", &[Form::Whole(F::KineticEnergy)], ENERGY, Forces, "kinetic_energy",
        "of all links"),
    row("potential_energy", &[Form::Whole(F::PotentialEnergy)], ENERGY, Forces, "potential_energy",
        "of gravity and springs"),
    row("shaking_force", &[Form::Whole(F::ShakingForce)], FORCE, Forces, "shaking_force",
        "size of the force of the moving links on the frame"),
    row("shaking_force_x", &[Form::Whole(F::ShakingForceX)], FORCE, Forces, "shaking_force_x",
        "its component along the frame's x axis"),
    row("shaking_force_y", &[Form::Whole(F::ShakingForceY)], FORCE, Forces, "shaking_force_y",
        "its component along the frame's y axis"),
    row("shaking_moment", &[Form::Whole(F::ShakingMoment)], TORQUE, Forces, "shaking_moment",
        "moment of the moving links on the frame, about its origin"),
    row("rate", &[Form::Rate], Follows("measure/time^n"), Derivative, "rate(y(C), 2)",
        "n-th time derivative (first unless said otherwise)"),
    row("d", &[Form::Coefficient], Follows("measure/drive^n"), Derivative, "d(angle(rocker), motor)",
        "n-th derivative to a drive's coordinate, the other drives at rest: a transfer function"),
    row("min", &[Form::Over(S::Min)], Follows("that of the measure"), WholeMotion, "min(transmission_angle(C))",
        "smallest over the motion (with two or more arguments: the smallest of them)"),
    row("max", &[Form::Over(S::Max)], Follows("that of the measure"), WholeMotion, "max(speed(C))",
        "largest over the motion (with two or more arguments: the largest of them)"),
    row("mean", &[Form::Over(S::Mean)], Follows("that of the measure"), WholeMotion, "mean(rate(x(C)))",
        "mean over the time of the motion"),
    row("range", &[Form::Over(S::Range)], Follows("that of the measure"), WholeMotion, "range(angle(rocker))",
        "largest less smallest over the motion"),
    row("stroke", &[Form::Stroke], Follows("that of the measure; length of a slider"), WholeMotion, "stroke(piston)",
        "range of a measure, of the travel of a slider or of the length of a cylinder"),
    row("at", &[Form::At], Follows("that of the measure"), WholeMotion, "at(y(P), motor, 30 deg)",
        "value where a drive or the time has a value"),
    row("time_ratio", &[Form::Over(S::TimeRatio)], Is(D::NONE, "number"), WholeMotion, "time_ratio(angle(rocker))",
        "duration of the slower stroke of a measure over that of the faster, in one cycle"),
];
