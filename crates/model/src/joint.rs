//! Joints that a shared point name does not say.

use crate::ids::{Line, LinkId, LinkPointRef, PointId, Scalar, Span};
use crate::link::{CircularArc, Side, SmoothCurve};

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
    /// A pin in a curved slot: a point of one link stays on a smooth curve of another.
    CurveSlot {
        /// The pin.
        pin: LinkPointRef,
        /// The slot.
        on: SmoothCurve,
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
        /// What is known of its teeth.
        teeth: Teeth,
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
        /// What is known of its teeth.
        teeth: Teeth,
    },
}

/// What is known of the teeth of gears, or of a rack and its pinion: their forces go by it, never the motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Teeth {
    /// Pressure angle, rad, between the tooth force and the tangent of the pitch circles; without it the tooth force is
    /// along that tangent.
    pub pressure_angle: Option<Scalar>,
    /// How large a tooth is.
    pub size: ToothSize,
}

/// How large a tooth is.
#[derive(Clone, Debug, PartialEq)]
pub enum ToothSize {
    /// The wheels are told by their numbers of teeth, which share the distance of their axes.
    Counted,
    /// The wheels are told by their radii: the module, m, where it is given, tells how many teeth they have.
    Module(Option<Scalar>),
}

impl Teeth {
    /// Every expression in it.
    pub(crate) fn scalars_mut(&mut self) -> impl Iterator<Item = &mut Scalar> {
        let module = match &mut self.size {
            ToothSize::Counted => None,
            ToothSize::Module(module) => module.as_mut(),
        };
        self.pressure_angle.iter_mut().chain(module)
    }
}

impl JointKind {
    /// The teeth of gears, or of a rack and its pinion.
    pub fn teeth(&self) -> Option<&Teeth> {
        match self {
            Self::Gears { teeth, .. } | Self::Rack { teeth, .. } => Some(teeth),
            _ => None,
        }
    }

    /// The two links that the joint joins (of gears and belts: without the arm).
    pub fn links(&self) -> (LinkId, LinkId) {
        match *self {
            Self::Slider { at, on, .. } => (at.link, on.link),
            Self::Slot { pin, on } => (pin.link, on.link),
            Self::ArcSlot { pin, ref on } => (pin.link, on.link),
            Self::CurveSlot { pin, ref on } => (pin.link, on.link),
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

    /// The points that it is made of.
    pub fn points(&self) -> Vec<PointId> {
        match self {
            Self::Slider { at, on, .. } | Self::Slot { pin: at, on } => {
                vec![at.point, on.from, on.to]
            }
            Self::ArcSlot { pin, on } => vec![pin.point, on.from, on.to],
            Self::CurveSlot { pin, on } => {
                let through = on.through.iter().copied();
                [pin.point].into_iter().chain(through).collect()
            }
            Self::Weld { at, .. } => vec![*at],
            Self::Gears { .. } | Self::Belt { .. } => Vec::new(),
            Self::Rack { center, .. } => vec![*center],
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
