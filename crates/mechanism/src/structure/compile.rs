//! From a model's joints and drives to constraints.

use kempe_model::{
    DriveId, DriveKind, JointId, JointKind, LinkId, LinkPointRef, PointId, Scalar, StandIn,
};
use kempe_units::Expr;

use super::{Source, Structure};
use crate::constraint::{
    Belt, Coincide, Constraint, Direction, Distance, Gears, Joint, OnArc, OnCurve, OnLine, Pilot,
    Rack, Shoe, Travel,
};
use crate::ids::{BodyId, LineRef};
use crate::sources::{AngleSource, GearSource, LineSource, ZERO};

impl Structure {
    /// Pins made by shared point names.
    pub(super) fn add_pins(&mut self) {
        for index in 0..self.model.points.len() {
            let point = PointId(index as u32);
            // A multiple joint of k links counts k - 1: every other link is pinned to the one that holds the pin.
            let mut links = self.model.points[index].holder_first();
            let holder = links.next();
            let others: Vec<LinkId> = links.collect();
            let mut pinned: Vec<BodyId> = Vec::new();
            let Some(a) = holder.and_then(|link| self.marker(LinkPointRef { link, point })) else {
                continue;
            };
            pinned.push(a.body);
            for link in others {
                let Some(b) = self.marker(LinkPointRef { link, point }) else {
                    continue;
                };
                if !pinned.contains(&b.body) {
                    pinned.push(b.body);
                    self.constraints
                        .push((Coincide { a, b }.into(), Source::Pin { point, link }));
                }
            }
        }
    }

    /// What a joint of the file demands.
    pub(super) fn add_joint(&mut self, id: JointId) {
        let joint = self.model.joints[id.index()].clone();
        let source = Source::Joint(id);
        match joint.kind {
            JointKind::Slider { at, on, angle } => {
                let Some(line) = self.line(on) else { return };
                let offset = self.angle(AngleSource {
                    value: angle,
                    along: Some(line),
                    a: at.link,
                    b: on.link,
                });
                let (a, b) = (self.body_of(at.link), self.body_of(on.link));
                let direction = Direction {
                    a,
                    b,
                    offset,
                    input: None,
                };
                self.constraints.push((direction.into(), source));
                if let Some(point) = self.marker(at) {
                    self.constraints
                        .push((OnLine { point, line }.into(), source));
                }
            }
            JointKind::Slot { pin, on } => {
                if let (Some(point), Some(line)) = (self.marker(pin), self.line(on)) {
                    self.constraints
                        .push((OnLine { point, line }.into(), source));
                }
            }
            JointKind::ArcSlot { pin, on } => {
                if let (Some(point), Some(arc)) = (self.marker(pin), self.arc(on)) {
                    self.constraints.push((OnArc { point, arc }.into(), source));
                }
            }
            JointKind::CurveSlot { pin, on } => {
                let Some(point) = self.marker(pin) else {
                    return;
                };
                if let Some((curve, shoe)) = self.curve(id, pin, &on) {
                    let on_curve = OnCurve {
                        point,
                        curve,
                        shoe: shoe.body,
                    };
                    self.constraints.push((on_curve.into(), source));
                    let with_pin = Shoe {
                        own: shoe,
                        pin: point,
                    };
                    self.constraints.push((with_pin.into(), source));
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
                ..
            } => {
                let wheels = self.wheels([a, b, arm], teeth_a, signed(teeth_b, internal), phase);
                self.constraints.push((wheels.into(), source));
            }
            JointKind::Belt {
                a,
                b,
                arm,
                radius_a,
                radius_b,
                crossed,
                phase,
                ..
            } => {
                let wheels = self.wheels([a, b, arm], radius_a, signed(radius_b, !crossed), phase);
                self.constraints.push((Belt { wheels }.into(), source));
            }
            JointKind::Rack {
                rack,
                pinion,
                center,
                radius,
                side,
                offset,
                ..
            } => {
                let line = LineRef {
                    body: self.body_of(rack),
                    index: self.lines.len() as u32,
                };
                self.lines.push(LineSource::AxisOf(rack));
                let constants = self.gear(GearSource {
                    first: Expr::Const(1.0),
                    second: signed(radius, side.sign() < 0.0),
                    constant: offset,
                    links: [rack, pinion, rack],
                });
                if let Some(center) = self.marker(LinkPointRef {
                    link: pinion,
                    point: center,
                }) {
                    let rack = Rack {
                        line,
                        center,
                        constants,
                    };
                    self.constraints.push((rack.into(), source));
                }
            }
        }
    }

    /// Takes the constraints of joints that drives let go out of the joints'.
    pub(super) fn open_joints(&mut self) -> Vec<(Constraint, Source)> {
        let drives = self.model.drives.iter();
        let released: Vec<Source> = drives
            .map(|drive| match &drive.kind {
                // What is let go and follows is open, too.
                DriveKind::StandIn(StandIn::Follows { of, .. }) => &**of,
                kind => kind,
            })
            .filter_map(|kind| match *kind {
                DriveKind::Release { of, .. } => Some(of.into()),
                _ => None,
            })
            .collect();
        let all = std::mem::take(&mut self.constraints).into_iter();
        let (opened, kept) = all.partition(|(_, source)| released.contains(source));
        self.constraints = kept;
        opened
    }

    /// What a drive demands; `opened` are the constraints of joints that are let go.
    pub(super) fn add_drive(&mut self, id: DriveId, opened: &[(Constraint, Source)]) {
        let drive = self.model.drives[id.index()].clone();
        let held = match &drive.kind {
            // What others tell, and a mere number, hold nothing.
            DriveKind::StandIn(StandIn::Follows { .. } | StandIn::Choice) => None,
            DriveKind::StandIn(StandIn::Pilot {
                own, links, chosen, ..
            }) => {
                let bodies: Vec<BodyId> = links.iter().map(|link| self.body_of(*link)).collect();
                let own = self.driven(own, id);
                own.and_then(|own| Pilot::new(own, &bodies, *chosen))
                    .map(Constraint::from)
            }
            DriveKind::Release { of, row } => {
                let opened = opened.iter().filter(|(_, source)| *source == (*of).into());
                let mut rows = opened.flat_map(|(constraint, source)| {
                    (0..constraint.rows() as u8).map(move |row| (*constraint, row, *source))
                });
                if let Some((constraint, row, source)) = rows.nth(usize::from(*row))
                    && let Some(released) = constraint.releasing(row, id)
                {
                    self.constraints.push((released, source));
                }
                None
            }
            kind => self.driven(kind, id),
        };
        (self.constraints).extend(held.map(|held| (held, Source::Drive(id))));
    }

    /// What holds something at the coordinate of a drive.
    fn driven(&mut self, kind: &DriveKind, id: DriveId) -> Option<Constraint> {
        match *kind {
            DriveKind::Turn { link, relative_to } => {
                let offset = self.angle(AngleSource {
                    value: ZERO,
                    along: None,
                    a: link,
                    b: relative_to,
                });
                let (a, b) = (self.body_of(link), self.body_of(relative_to));
                let direction = Direction {
                    a,
                    b,
                    offset,
                    input: Some(id),
                };
                Some(direction.into())
            }
            DriveKind::Cylinder { a, b } => {
                let (a, b) = (self.marker(a)?, self.marker(b)?);
                Some(Distance { a, b, input: id }.into())
            }
            DriveKind::Slide { joint } => {
                let (at, on) = self.model.joints[joint.index()].kind.guide()?;
                let travel = Travel {
                    point: self.marker(at)?,
                    line: self.line(on)?,
                    input: id,
                };
                Some(travel.into())
            }
            _ => None,
        }
    }

    /// Two wheels on an arm whose angles there are tied: `first angle_a + second angle_b = first phase`.
    fn wheels(
        &mut self,
        links: [LinkId; 3],
        first: Scalar,
        second: Scalar,
        phase: Scalar,
    ) -> Gears {
        let constants = self.gear(GearSource {
            constant: Expr::Mul(Box::new(first.clone()), Box::new(phase)),
            first,
            second,
            links,
        });
        let [a, b, arm] = links.map(|link| self.body_of(link));
        let pins = self.pin(a, arm).zip(self.pin(b, arm));
        Gears {
            a,
            b,
            arm,
            constants,
            pins: pins.map(|(a, b)| [a, b]),
        }
    }
}

/// A length or a count of teeth with its sign.
fn signed(size: Scalar, negative: bool) -> Scalar {
    if negative {
        Expr::Neg(Box::new(size))
    } else {
        size
    }
}
