//! The steps of a plan: every closed form by what it is made of, as indices.

use kempe_model::DriveId;

use crate::ids::{ArcRef, BodyId, LineRef, Marker};

/// A condition on a body whose other side is already placed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Condition {
    /// A point of the body lies on a placed line.
    OnLine {
        /// The body's point.
        own: Marker,
        /// The placed line.
        line: LineRef,
    },
    /// A line of the body passes through a placed point.
    Through {
        /// The body's line.
        line: LineRef,
        /// The placed point.
        point: Marker,
    },
    /// A point of the body is as far to the left of a placed line as the drive's coordinate.
    BesideLine {
        /// The body's point.
        own: Marker,
        /// The placed line.
        line: LineRef,
        /// The drive.
        input: DriveId,
    },
    /// A placed point is as far to the left of a line of the body as the drive's coordinate.
    LineBeside {
        /// The body's line.
        line: LineRef,
        /// The placed point.
        point: Marker,
        /// The drive.
        input: DriveId,
    },
    /// A point of the body has the drive's coordinate along a placed line.
    TravelOn {
        /// The body's point.
        own: Marker,
        /// The placed line.
        line: LineRef,
        /// The drive.
        input: DriveId,
    },
    /// A placed point has the drive's coordinate along a line of the body.
    TravelThrough {
        /// The body's line.
        line: LineRef,
        /// The placed point.
        point: Marker,
        /// The drive.
        input: DriveId,
    },
    /// A pinion whose centre is placed rolls on the body's pitch line, both angles known.
    Roll {
        /// The body's pitch line.
        line: LineRef,
        /// The pinion's centre.
        center: Marker,
        /// Index into the geometry's gear constants.
        constants: u32,
    },
    /// A point of the body lies on a placed arc.
    OnArc {
        /// The body's point.
        own: Marker,
        /// The placed arc.
        arc: ArcRef,
    },
    /// An arc of the body passes through a placed point.
    ArcThrough {
        /// The body's arc.
        arc: ArcRef,
        /// The placed point.
        point: Marker,
    },
    /// A point of the body is at the drive's distance from a placed point.
    Radius {
        /// The body's point.
        own: Marker,
        /// The placed point.
        center: Marker,
        /// The drive.
        input: DriveId,
    },
}

impl Condition {
    /// Whether it leaves a point on a circle, and so two places on a line.
    fn is_circle(&self) -> bool {
        matches!(
            self,
            Self::Radius { .. } | Self::OnArc { .. } | Self::ArcThrough { .. }
        )
    }
}

/// A translating body that carries the point sought; without a pin the point is the body's origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carrier {
    /// The body, its angle known.
    pub body: BodyId,
    /// The body's point at the point sought.
    pub pin: Option<Marker>,
}

/// One step of a plan: one block solved.
#[derive(Clone, Debug)]
pub enum Step {
    /// The angle of a body from that of another ([`Constraint::Direction`](crate::structure::Constraint::Direction)).
    Turn {
        /// The body.
        body: BodyId,
        /// The other body, already turned.
        from: BodyId,
        /// Index of the angle constant.
        offset: u32,
        /// The drive that is added.
        input: Option<DriveId>,
        /// The constant and the drive count backwards: `angle = angle(from) - offset - drive`.
        reversed: bool,
    },
    /// The angle of a body from angles of others (gears) or from a travel (rack).
    Gear {
        /// The body.
        body: BodyId,
        /// Index of the constraint.
        constraint: usize,
    },
    /// A pinion pinned at its centre to a placed point, its angle from a rack that is placed.
    Roll {
        /// The pinion's centre.
        own: Marker,
        /// The placed point there.
        at: Marker,
        /// Index of the rack's constraint.
        constraint: usize,
    },
    /// An idle angle, kept at zero.
    Hold {
        /// The body.
        body: BodyId,
    },
    /// A body whose angle is known, pinned to a placed point.
    Pin {
        /// The body's point.
        own: Marker,
        /// The placed point.
        at: Marker,
    },
    /// A body pinned at both of its ends to placed points (overconstrained unless the distance fits).
    TwoPins {
        /// The body's first point.
        a: Marker,
        /// Where it is pinned.
        at_a: Marker,
        /// The body's second point.
        b: Marker,
        /// Where it is pinned.
        at_b: Marker,
    },
    /// A point from two conditions on translating bodies (RPP and PRP dyads, two slots, two cylinders).
    Cross {
        /// Who carries the point, for each condition; twice the same body for a single one.
        carriers: [Carrier; 2],
        /// The conditions.
        conditions: [Condition; 2],
    },
    /// A body pinned to a placed point, its angle from a condition on one of its points.
    Swing(Swing),
    /// A body pinned to a placed point, one of its own lines through a placed point.
    SwingLine(SwingLine),
    /// Two bodies pinned to each other and each to a placed point.
    Dyad(Dyad),
    /// One of these whose pins are let go and stand open.
    Apart(Box<Apart>),
    /// Everything else: Newton's method on the block's rows.
    Newton {
        /// Index into [`Plan::newton_blocks`](crate::Plan::newton_blocks).
        block: usize,
    },
}

/// A body pinned to a placed point, its angle from a condition on one of its points: driven bars, RRP dyads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swing {
    /// The body's point at the pin.
    pub own: Marker,
    /// The placed point.
    pub at: Marker,
    /// The body's point on which the condition acts; the one at the pin where it acts on the centre of an arc of the body.
    pub tip: Marker,
    /// The condition, on the body itself or on its partner.
    pub condition: Condition,
    /// RRP: the translating body pinned at the tip.
    pub partner: Option<Carrier>,
}

/// A body pinned to a placed point, one of its own lines through (or along by a travel) a placed point. With a
/// partner this is the RPR dyad: the partner keeps its angle to the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SwingLine {
    /// The body's point at the pin.
    pub own: Marker,
    /// The placed point at the pin.
    pub at: Marker,
    /// The other placed point.
    pub toward: Marker,
    /// What is kept constant.
    pub reach: Reach,
    /// The second body of an RPR dyad.
    pub partner: Option<Sliding>,
}

/// One of the two bodies of an RRR dyad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DyadBody {
    /// Its pin to a placed point.
    pub outer: Marker,
    /// The placed point there.
    pub at: Marker,
    /// Its pin to the other body.
    pub inner: Marker,
    /// Whether somebody looks at its pose.
    pub wanted: bool,
}

/// The RRR dyad: two bodies pinned to each other and each to a placed point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dyad {
    /// The first body; the inner pin lies left of the way from its placed point to the other's for sign +1.
    pub a: DyadBody,
    /// The second body.
    pub b: DyadBody,
    /// Index of its constants in the design.
    pub constants: usize,
}

/// Which projection of the vector between the two placed points, seen from the body, is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reach {
    /// The body's own line passes through the far point.
    Line {
        /// The body's line.
        line: LineRef,
    },
    /// The far point has the drive's coordinate along the body's own line.
    Travel {
        /// The body's line.
        line: LineRef,
        /// The drive.
        input: DriveId,
    },
    /// RPR: a point of the partner stays on the body's line.
    PartnerPoint {
        /// The body's line.
        line: LineRef,
        /// The partner's point.
        point: Marker,
    },
    /// RPR: a point of the body stays on the partner's line.
    PartnerLine {
        /// The body's point.
        point: Marker,
        /// The partner's line.
        line: LineRef,
    },
}

/// The second body of an RPR dyad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sliding {
    /// Its outer pin.
    pub outer: Marker,
    /// Index of the angle constant between the two.
    pub offset: u32,
    /// A drive added to that angle.
    pub input: Option<DriveId>,
    /// The constant gives the first body's angle against the partner's, not the other way round.
    pub reversed: bool,
}

/// How far a point stands off, m along the frame's axes: by coordinates of drives, forwards or backwards.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shift(pub(crate) [Option<Opening>; 2]);

/// How far a pin stands open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Opening {
    /// The drives that open it along the frame's axes.
    pub along: [DriveId; 2],
    /// Forwards or backwards.
    pub sign: f64,
}

/// A group whose pins stand open.
#[derive(Clone, Debug)]
pub struct Apart {
    /// How it is solved where they do not.
    pub closed: Step,
    /// By how much the placed points are off at which it is pinned, in the order in which the step names them.
    pub(crate) at: [Shift; 2],
    /// A body that is off from where the closed group has it, and by how much.
    pub(crate) moved: Option<(BodyId, Shift)>,
}

impl Step {
    /// The step as it would be if its pins held.
    pub fn closed(&self) -> &Self {
        match self {
            Self::Apart(apart) => &apart.closed,
            step => step,
        }
    }

    /// Whether the step has two assembly modes, told apart by a sign.
    pub fn has_modes(&self) -> bool {
        match self.closed() {
            Step::Dyad { .. } | Step::Swing { .. } | Step::SwingLine { .. } => true,
            Step::Cross { conditions, .. } => conditions.iter().any(Condition::is_circle),
            _ => false,
        }
    }

    /// Whether the step looks at the branch's guesses or turn counts, or is as rare as those that do: Newton blocks, gears and
    /// racks, open pins.
    pub fn needs_guess(&self) -> bool {
        let rolls = |condition: &Condition| matches!(condition, Condition::Roll { .. });
        match self {
            Step::Newton { .. } | Step::Gear { .. } | Step::Roll { .. } | Step::Apart(_) => true,
            Step::Cross { conditions, .. } => conditions.iter().any(rolls),
            Step::Swing(swing) => rolls(&swing.condition),
            _ => false,
        }
    }
}
