//! The mechanism as bodies and constraints: a model compiled to indices, its dimensions still free.

use kempe_model::{
    DriveId, DriveKind, JointId, JointKind, LinkId, LinkPointRef, Model, ParameterId, Place,
    PointId, Scalar,
};
use kempe_units::Expr;

/// A body: one link, or several welded into one. `BodyId(0)` is the frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BodyId(pub u32);

impl BodyId {
    /// The frame.
    pub const GROUND: Self = Self(0);

    /// The index into the list of bodies.
    #[inline(always)]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A point of a body: an index into [`Mechanism::markers`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Marker {
    /// The body that carries the point.
    pub body: BodyId,
    /// Index of its local coordinates in the geometry.
    pub index: u32,
    /// What is known of its place whatever the dimensions: saves work in every pose.
    pub spot: Spot,
}

/// What is known of a marker's place in its body whatever the dimensions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spot {
    /// On the frame: its place in the body is its place in the frame.
    Frame,
    /// At the body's origin.
    Origin,
    /// On the body's x axis.
    Axis,
    /// Anywhere.
    Anywhere,
}

/// A directed line of a body: an index into the geometry's lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LineRef {
    /// The body that carries the line.
    pub body: BodyId,
    /// Index into the geometry's lines.
    pub index: u32,
}

/// What a constraint comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// A pin made by a shared point name; `link` is the later of the two links.
    Pin {
        /// The point.
        point: PointId,
        /// The later link.
        link: LinkId,
    },
    /// A joint of the file.
    Joint(JointId),
    /// A drive.
    Drive(DriveId),
}

/// One condition between bodies. The residuals are in `constraint.rs`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Constraint {
    /// Two points coincide: two rows.
    Coincide {
        /// Point of the earlier body.
        a: Marker,
        /// Point of the later body.
        b: Marker,
    },
    /// A point lies on a line.
    OnLine {
        /// The point.
        point: Marker,
        /// The line.
        line: LineRef,
    },
    /// `angle(a) - angle(b) = offset (+ the drive's coordinate)`.
    Direction {
        /// Body whose angle is set.
        a: BodyId,
        /// Body against which.
        b: BodyId,
        /// Index into the geometry's angles.
        offset: u32,
        /// The drive whose coordinate is added.
        input: Option<DriveId>,
    },
    /// The distance of two points is the drive's coordinate.
    Distance {
        /// Foot.
        a: Marker,
        /// Eye.
        b: Marker,
        /// The drive.
        input: DriveId,
    },
    /// A point's coordinate along a line is the drive's coordinate.
    Travel {
        /// The point.
        point: Marker,
        /// The line.
        line: LineRef,
        /// The drive.
        input: DriveId,
    },
    /// `ratio_a (angle_a - angle_arm) + ratio_b (angle_b - angle_arm) = phase`.
    Gears {
        /// First gear.
        a: BodyId,
        /// Second gear.
        b: BodyId,
        /// Arm.
        arm: BodyId,
        /// Index into the geometry's gear constants.
        constants: u32,
    },
    /// `s + radius (angle_pinion - angle_rack) = offset`, `s` along the rack's line.
    Rack {
        /// Pitch line on the rack.
        line: LineRef,
        /// The pinion's centre.
        center: Marker,
        /// Index into the geometry's gear constants.
        constants: u32,
    },
}

impl Constraint {
    /// How many rows it has.
    pub fn rows(&self) -> usize {
        match self {
            Constraint::Coincide { .. } => 2,
            _ => 1,
        }
    }

    /// The drive whose coordinate it holds.
    pub fn drive(&self) -> Option<DriveId> {
        match self {
            Constraint::Direction { input, .. } => *input,
            Constraint::Distance { input, .. } | Constraint::Travel { input, .. } => Some(*input),
            _ => None,
        }
    }

    /// The bodies it ties.
    pub fn bodies(&self) -> impl Iterator<Item = BodyId> {
        let list = match *self {
            Constraint::Coincide { a, b } | Constraint::Distance { a, b, .. } => {
                [Some(a.body), Some(b.body), None]
            }
            Constraint::OnLine { point, line } | Constraint::Travel { point, line, .. } => {
                [Some(point.body), Some(line.body), None]
            }
            Constraint::Direction { a, b, .. } => [Some(a), Some(b), None],
            Constraint::Gears { a, b, arm, .. } => [Some(a), Some(b), Some(arm)],
            Constraint::Rack { line, center, .. } => [Some(line.body), Some(center.body), None],
        };
        list.into_iter().flatten()
    }
}

/// How a link sits in its body.
#[derive(Clone, Debug)]
pub struct LinkSeat {
    /// The body.
    pub body: BodyId,
    /// For a welded link: the link it is welded to, the shared point and the angle; `None` for the body's own link.
    pub weld: Option<(LinkId, PointId, Scalar)>,
}

/// A line by two markers of the same body, or by a marker and the link's x axis.
#[derive(Clone, Copy, Debug)]
pub enum LineSource {
    /// Through two points.
    Points(Marker, Marker),
    /// Through the link's origin along its x axis.
    AxisOf(LinkId),
}

/// An angle constant between two bodies: `value + direction of the line + seat(b) - seat(a)`.
#[derive(Clone, Debug)]
pub struct AngleSource {
    /// Explicit angle, rad.
    pub value: Scalar,
    /// A line of the second link's body whose direction is added; then `b`'s seat is not.
    pub along: Option<LineRef>,
    /// Link whose seat angle is subtracted.
    pub a: LinkId,
    /// Link whose seat angle is added.
    pub b: LinkId,
}

impl AngleSource {
    /// Whether it is zero whatever the dimensions.
    pub(crate) fn is_zero(&self, mechanism: &Mechanism) -> bool {
        let is_free = |link: LinkId| mechanism.seats[link.index()].weld.is_none();
        self.value == ZERO && self.along.is_none() && is_free(self.a) && is_free(self.b)
    }
}

/// Constants of a gear pair or of a rack.
#[derive(Clone, Debug)]
pub struct GearSource {
    /// Factor of the first angle (teeth; 1 for a rack).
    pub first: Scalar,
    /// Factor of the second angle (signed teeth; signed radius for a rack).
    pub second: Scalar,
    /// Right-hand side.
    pub constant: Scalar,
    /// Links a, b, arm whose seat angles matter.
    pub links: [LinkId; 3],
}

/// A model compiled to bodies, markers and constraints.
#[derive(Clone, Debug)]
pub struct Mechanism {
    /// The model.
    pub model: Model,
    /// How many bodies, the frame included.
    pub bodies: usize,
    /// Seat of every link.
    pub seats: Vec<LinkSeat>,
    /// Every point of every link, in link order.
    pub markers: Vec<LinkPointRef>,
    /// Index of a link's first marker.
    first_marker: Vec<u32>,
    /// Lines used by constraints.
    pub lines: Vec<LineSource>,
    /// Angle constants used by constraints.
    pub angles: Vec<AngleSource>,
    /// Gear constants used by constraints.
    pub gears: Vec<GearSource>,
    /// Joints' constraints first, then the drives'.
    pub constraints: Vec<(Constraint, Source)>,
    /// How many constraints come from joints.
    pub joint_constraints: usize,
}

const ZERO: Expr<ParameterId> = Expr::Const(0.0);

impl Mechanism {
    /// Compiles a model.
    pub fn new(model: &Model) -> Self {
        let mut it = Self {
            bodies: 0,
            seats: seats(model),
            markers: Vec::new(),
            first_marker: Vec::new(),
            lines: Vec::new(),
            angles: Vec::new(),
            gears: Vec::new(),
            constraints: Vec::new(),
            joint_constraints: 0,
            model: model.clone(),
        };
        it.bodies = it
            .seats
            .iter()
            .map(|seat| seat.body.index() + 1)
            .max()
            .unwrap_or(1);
        for (index, link) in model.links.iter().enumerate() {
            it.first_marker.push(it.markers.len() as u32);
            for point in &link.points {
                it.markers.push(LinkPointRef {
                    link: LinkId(index as u32),
                    point: point.point,
                });
            }
        }
        it.add_pins();
        for index in 0..model.joints.len() {
            it.add_joint(JointId(index as u32));
        }
        it.joint_constraints = it.constraints.len();
        for index in 0..model.drives.len() {
            it.add_drive(DriveId(index as u32));
        }
        it
    }

    /// The body a link belongs to.
    pub fn body_of(&self, link: LinkId) -> BodyId {
        self.seats[link.index()].body
    }

    /// Markers of a link: one for each of its points, in order.
    pub(crate) fn markers_of(&self, link: usize) -> std::ops::Range<usize> {
        let first = self.first_marker[link] as usize;
        first..first + self.model.links[link].points.len()
    }

    /// The marker of a point on a link.
    pub fn marker(&self, at: LinkPointRef) -> Option<Marker> {
        let link = self.model.links.get(at.link.index())?;
        let place = link.points.iter().position(|p| p.point == at.point)?;
        let body = self.body_of(at.link);
        let spot = match &link.points[place].place {
            _ if body == BodyId::GROUND => Spot::Frame,
            _ if self.seats[at.link.index()].weld.is_some() => Spot::Anywhere,
            Place::Cartesian { x, y } if *x == ZERO && *y == ZERO => Spot::Origin,
            Place::Cartesian { y, .. } if *y == ZERO => Spot::Axis,
            _ => Spot::Anywhere,
        };
        Some(Marker {
            body,
            index: self.first_marker[at.link.index()] + place as u32,
            spot,
        })
    }

    /// A marker of a point: on the first link that carries it.
    pub fn any_marker(&self, point: PointId) -> Option<Marker> {
        let link = *self.model.points.get(point.index())?.links.first()?;
        self.marker(LinkPointRef { link, point })
    }

    /// Whether the marker lies at its body's origin whatever the dimensions, so that turning the body cannot move it.
    pub fn at_origin(&self, marker: Marker) -> bool {
        let at = self.markers[marker.index as usize];
        let link = &self.model.links[at.link.index()];
        self.seats[at.link.index()].weld.is_none()
            && link.points.iter().any(|p| {
                p.point == at.point
                    && matches!(&p.place, Place::Cartesian { x, y } if *x == ZERO && *y == ZERO)
            })
    }

    /// The name of a body: its links' names joined.
    pub fn body_name(&self, body: BodyId) -> String {
        let names: Vec<&str> = (self.seats.iter().zip(&self.model.links))
            .filter(|(seat, _)| seat.body == body)
            .map(|(_, link)| link.name.as_str())
            .collect();
        names.join("+")
    }

    fn add_pins(&mut self) {
        for index in 0..self.model.points.len() {
            let point = PointId(index as u32);
            let links = self.model.points[index].links.clone();
            // A multiple joint of k links counts k - 1: every later link is pinned to the first one.
            let mut pinned: Vec<BodyId> = Vec::new();
            let Some(a) = links
                .first()
                .and_then(|&link| self.marker(LinkPointRef { link, point }))
            else {
                continue;
            };
            pinned.push(a.body);
            for &link in &links[1..] {
                let Some(b) = self.marker(LinkPointRef { link, point }) else {
                    continue;
                };
                if !pinned.contains(&b.body) {
                    pinned.push(b.body);
                    self.constraints
                        .push((Constraint::Coincide { a, b }, Source::Pin { point, link }));
                }
            }
        }
    }

    fn add_joint(&mut self, id: JointId) {
        let joint = self.model.joints[id.index()].clone();
        let source = Source::Joint(id);
        match joint.kind {
            JointKind::Slider { at, on, angle } => {
                let Some(line) = self.line(on) else { return };
                let offset = self.angles.len() as u32;
                self.angles.push(AngleSource {
                    value: angle,
                    along: Some(line),
                    a: at.link,
                    b: on.link,
                });
                let (a, b) = (self.body_of(at.link), self.body_of(on.link));
                self.constraints.push((
                    Constraint::Direction {
                        a,
                        b,
                        offset,
                        input: None,
                    },
                    source,
                ));
                if let Some(point) = self.marker(at) {
                    self.constraints
                        .push((Constraint::OnLine { point, line }, source));
                }
            }
            JointKind::Slot { pin, on } => {
                if let (Some(point), Some(line)) = (self.marker(pin), self.line(on)) {
                    self.constraints
                        .push((Constraint::OnLine { point, line }, source));
                }
            }
            // Welded links are one body: nothing is left to constrain.
            JointKind::Weld { .. } => {}
            JointKind::Gears {
                a,
                b,
                arm,
                teeth_a,
                teeth_b,
                internal,
                phase,
            } => {
                let second = if internal {
                    Expr::Neg(Box::new(teeth_b))
                } else {
                    teeth_b
                };
                let constant = Expr::Mul(Box::new(teeth_a.clone()), Box::new(phase));
                let constants = self.gears.len() as u32;
                self.gears.push(GearSource {
                    first: teeth_a,
                    second,
                    constant,
                    links: [a, b, arm],
                });
                let (a, b, arm) = (self.body_of(a), self.body_of(b), self.body_of(arm));
                self.constraints.push((
                    Constraint::Gears {
                        a,
                        b,
                        arm,
                        constants,
                    },
                    source,
                ));
            }
            JointKind::Rack {
                rack,
                pinion,
                center,
                radius,
                side,
                offset,
            } => {
                let line = LineRef {
                    body: self.body_of(rack),
                    index: self.lines.len() as u32,
                };
                self.lines.push(LineSource::AxisOf(rack));
                let second = if side.sign() < 0.0 {
                    Expr::Neg(Box::new(radius))
                } else {
                    radius
                };
                let constants = self.gears.len() as u32;
                self.gears.push(GearSource {
                    first: Expr::Const(1.0),
                    second,
                    constant: offset,
                    links: [rack, pinion, rack],
                });
                if let Some(center) = self.marker(LinkPointRef {
                    link: pinion,
                    point: center,
                }) {
                    self.constraints.push((
                        Constraint::Rack {
                            line,
                            center,
                            constants,
                        },
                        source,
                    ));
                }
            }
        }
    }

    fn add_drive(&mut self, id: DriveId) {
        let drive = self.model.drives[id.index()].clone();
        let source = Source::Drive(id);
        match drive.kind {
            DriveKind::Turn { link, relative_to } => {
                let offset = self.angles.len() as u32;
                self.angles.push(AngleSource {
                    value: ZERO,
                    along: None,
                    a: link,
                    b: relative_to,
                });
                let (a, b) = (self.body_of(link), self.body_of(relative_to));
                self.constraints.push((
                    Constraint::Direction {
                        a,
                        b,
                        offset,
                        input: Some(id),
                    },
                    source,
                ));
            }
            DriveKind::Cylinder { a, b } => {
                if let (Some(a), Some(b)) = (self.marker(a), self.marker(b)) {
                    self.constraints
                        .push((Constraint::Distance { a, b, input: id }, source));
                }
            }
            DriveKind::Slide { joint } => {
                let (at, on) = match &self.model.joints[joint.index()].kind {
                    JointKind::Slider { at, on, .. } | JointKind::Slot { pin: at, on } => {
                        (*at, *on)
                    }
                    _ => return,
                };
                if let (Some(point), Some(line)) = (self.marker(at), self.line(on)) {
                    self.constraints.push((
                        Constraint::Travel {
                            point,
                            line,
                            input: id,
                        },
                        source,
                    ));
                }
            }
        }
    }

    fn line(&mut self, line: kempe_model::Line) -> Option<LineRef> {
        let from = self.marker(LinkPointRef {
            link: line.link,
            point: line.from,
        })?;
        let to = self.marker(LinkPointRef {
            link: line.link,
            point: line.to,
        })?;
        let index = self.lines.len() as u32;
        self.lines.push(LineSource::Points(from, to));
        Some(LineRef {
            body: from.body,
            index,
        })
    }
}

/// Welded links become one body; the others are bodies of their own.
fn seats(model: &Model) -> Vec<LinkSeat> {
    let mut seats: Vec<Option<LinkSeat>> = vec![None; model.links.len()];
    let mut next = 0;
    for start in 0..model.links.len() {
        if seats[start].is_some() {
            continue;
        }
        let body = BodyId(next);
        next += 1;
        seats[start] = Some(LinkSeat { body, weld: None });
        let mut stack = vec![LinkId(start as u32)];
        while let Some(at) = stack.pop() {
            for joint in &model.joints {
                let JointKind::Weld {
                    a,
                    b,
                    at: point,
                    angle,
                } = &joint.kind
                else {
                    continue;
                };
                let (other, angle) = if *a == at {
                    (*b, angle.clone())
                } else if *b == at {
                    (*a, Expr::Neg(Box::new(angle.clone())))
                } else {
                    continue;
                };
                if seats[other.index()].is_none() {
                    seats[other.index()] = Some(LinkSeat {
                        body,
                        weld: Some((at, *point, angle)),
                    });
                    stack.push(other);
                }
            }
        }
    }
    seats
        .into_iter()
        .map(|seat| {
            seat.unwrap_or(LinkSeat {
                body: BodyId::GROUND,
                weld: None,
            })
        })
        .collect()
}
