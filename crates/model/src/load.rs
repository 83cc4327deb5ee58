//! What acts on a mechanism: gravity, loads, springs, dampers, friction, actuators. Plain data, SI.
//!
//! Values that may vary are measures: a number, an expression over parameters, or a function of any drive, of time or
//! of any other measure of the mechanism.

use crate::amount::Amount;
use crate::contact::Contact;
use crate::drive::{Law, Released};
use crate::ids::{DriveId, JointId, LinkId, LinkPointRef, PointId, Scalar, Span};
use crate::measure::Measure;

/// Everything that acts on the mechanism.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Actions {
    /// Acceleration of gravity in the frame, m/s^2. `None`: 9.81 m/s^2 downwards (-y) wherever a mass is given.
    pub gravity: Option<[Scalar; 2]>,
    /// Forces and torques.
    pub loads: Vec<Load>,
    /// Point masses fixed to links: counterweights.
    pub masses: Vec<PointMass>,
    /// Springs.
    pub springs: Vec<Spring>,
    /// Dampers.
    pub dampers: Vec<Damper>,
    /// Friction at pins, sliders and teeth.
    pub friction: Vec<Friction>,
    /// Hydraulic cylinders behind cylinder drives.
    pub cylinders: Vec<HydraulicCylinder>,
    /// Motors behind turning drives.
    pub motors: Vec<Motor>,
    /// Joints with play whose bodies touch and part; no file says so, studies do.
    pub contacts: Vec<Contact>,
    /// Joints at which `friction` counts for nothing, as play lets what rubs there be the contact's own; no file says so, studies do.
    pub smooth: Vec<Released>,
    /// Limit switches, which loads, valves and motors may go by.
    pub switches: Vec<crate::switch::Switch>,
    /// In how many places friction is followed: which part of it acts there. No file says so, simulations do.
    pub followed_friction: usize,
    /// What stops push on bodies. No file says so, simulations do.
    pub pressed: Vec<Pressed>,
}

/// What a stop pushes in time.
#[derive(Clone, Debug, PartialEq)]
pub struct Pressed {
    /// How far it is open, m or rad: it pushes the way that this grows.
    pub gap: Measure,
    /// With what force, N or N m.
    pub push: Law,
}

/// A force or a torque.
#[derive(Clone, Debug, PartialEq)]
pub struct Load {
    /// Name.
    pub name: String,
    /// What it is.
    pub kind: LoadKind,
    /// Where it stands in the file.
    pub span: Span,
}

/// The kinds of load.
#[derive(Clone, Debug, PartialEq)]
pub enum LoadKind {
    /// A force on a link at one of its points.
    Force {
        /// Where it acts.
        at: LinkPointRef,
        /// Its components, N.
        components: [Amount; 2],
        /// The link in whose axes the components are; the frame unless said otherwise.
        axes: LinkId,
    },
    /// A torque on a link, N m, counter-clockwise; its reaction acts on `against` (the frame unless said otherwise).
    Torque {
        /// The link.
        on: LinkId,
        /// The link that takes the reaction.
        against: LinkId,
        /// The torque.
        amount: Amount,
    },
}

impl LoadKind {
    /// Its components, or its torque.
    pub fn amounts(&self) -> impl Iterator<Item = &Amount> {
        let (force, torque) = match self {
            Self::Force { components, .. } => (components.as_slice(), None),
            Self::Torque { amount, .. } => (&[][..], Some(amount)),
        };
        force.iter().chain(torque)
    }
}

/// A mass at a point of a link, besides the link's own mass.
#[derive(Clone, Debug, PartialEq)]
pub struct PointMass {
    /// Name.
    pub name: String,
    /// The link.
    pub on: LinkId,
    /// Where on the link, in its own frame.
    pub place: crate::link::Place,
    /// Mass, kg.
    pub mass: Scalar,
    /// Where it stands in the file.
    pub span: Span,
}

/// A spring.
#[derive(Clone, Debug, PartialEq)]
pub struct Spring {
    /// Name.
    pub name: String,
    /// Between what.
    pub between: Between,
    /// Stiffness, N/m or N m/rad.
    pub stiffness: Scalar,
    /// Length or angle without force, m or rad.
    pub free: Scalar,
    /// Force or torque at the free length (tension positive), N or N m.
    pub preload: Scalar,
    /// Length or angle below and above which a stop of this extra stiffness acts.
    pub stops: [Option<Scalar>; 2],
    /// Stiffness of the stops, N/m or N m/rad.
    pub stop_stiffness: Option<Scalar>,
    /// Acts only in tension (a rope) or only in compression (a push spring), or both.
    pub acts: Acts,
    /// Where it stands in the file.
    pub span: Span,
}

/// In which sense a spring acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Acts {
    /// Both ways.
    #[default]
    Both,
    /// Pulls only.
    Tension,
    /// Pushes only.
    Compression,
}

/// The two ends of a spring or damper.
#[derive(Clone, Debug, PartialEq)]
pub enum Between {
    /// Two points.
    Points(LinkPointRef, LinkPointRef),
    /// Two links: a torsion spring; its angle is that of the second link against the first.
    Links(LinkId, LinkId),
}

/// A damper.
#[derive(Clone, Debug, PartialEq)]
pub struct Damper {
    /// Name.
    pub name: String,
    /// Between what.
    pub between: Between,
    /// Damping when the ends part (the angle grows), N s/m or N m s/rad.
    pub damping: Scalar,
    /// Damping the other way; the same unless said otherwise.
    pub closing: Option<Scalar>,
    /// Where it stands in the file.
    pub span: Span,
}

/// Friction at a joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Friction {
    /// Where.
    pub at: FrictionAt,
    /// Coulomb's coefficient, kinetic.
    pub coefficient: Scalar,
    /// Coefficient at rest (Stribeck), when it differs.
    pub static_coefficient: Option<Scalar>,
    /// Speed at which the coefficient falls from static to kinetic, m/s.
    pub stribeck_speed: Option<Scalar>,
    /// Viscous part, N m s/rad at pins, N s/m at sliders and teeth.
    pub viscous: Option<Scalar>,
    /// What it resists with whatever the load, N m at pins, N at sliders and teeth.
    pub drag: Option<Scalar>,
    /// Radius of the pin, m; friction of a pin needs one.
    pub radius: Option<Scalar>,
    /// Where it stands in the file.
    pub span: Span,
}

/// Where friction acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrictionAt {
    /// At a pin (at every pair of a multiple joint).
    Pin(PointId),
    /// At a slider or slot, or at the teeth of gears or a rack.
    Joint(JointId),
    /// At every pin and slider that has none of its own.
    All,
}

/// A hydraulic cylinder behind a cylinder drive.
#[derive(Clone, Debug, PartialEq)]
pub struct HydraulicCylinder {
    /// The drive.
    pub drive: DriveId,
    /// Bore, m.
    pub bore: Scalar,
    /// Rod diameter, m.
    pub rod: Scalar,
    /// Supply pressure, Pa.
    pub supply: Option<Scalar>,
    /// Relief pressure, Pa.
    pub relief: Option<Scalar>,
    /// Return pressure on the side that drains, Pa.
    pub back: Scalar,
    /// Flow the pump gives, m^3/s.
    pub flow: Option<Scalar>,
    /// Seal friction, N.
    pub friction: Scalar,
    /// How many cylinders act side by side.
    pub count: Scalar,
    /// Its oil, by which it moves where its drive is let go.
    pub oil: Option<crate::oil::Oil>,
    /// Where it stands in the file.
    pub span: Span,
}

/// A motor behind a turning drive.
#[derive(Clone, Debug, PartialEq)]
pub struct Motor {
    /// The drive.
    pub drive: DriveId,
    /// Torque over speed at the drive, as pairs (rad/s, N m) with rising speed, linear between them.
    pub curve: Vec<(Scalar, Scalar)>,
    /// The part of its curve that it gives in a simulation; the whole where it is not said.
    pub throttle: Option<Amount>,
    /// Where it stands in the file.
    pub span: Span,
}
