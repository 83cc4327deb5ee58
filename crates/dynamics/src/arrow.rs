//! Everything that acts on the links of one instant as arrows to be drawn.

use kempe_mechanism::structure::Marker;
use kempe_model::{DriveKind, FRAME, Joint, LinkId, LinkPointRef, StandIn};

use crate::ends::Ends;
use crate::forces::Forces;
use crate::instant::Instant;
use crate::load::Load;
use crate::number::ForceNumber;
use crate::reaction::Carrier;
use crate::vector::{length, sub};

/// Where a force comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Origin {
    /// A joint.
    Joint,
    /// A drive.
    Drive,
    /// A load of the file.
    Load,
    /// Gravity.
    Weight,
    /// A spring.
    Spring,
    /// A damper.
    Damper,
}

/// A force or a moment on a link, in plain numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct ForceArrow {
    /// Where it comes from.
    pub origin: Origin,
    /// Name of the joint, drive, load, spring or damper; of a weight, that of its link.
    pub name: String,
    /// The link that feels it.
    pub link: LinkId,
    /// Where it acts in the frame, m.
    pub place: [f64; 2],
    /// Force along the frame's axes, N.
    pub force: [f64; 2],
    /// Moment about that place, N m.
    pub moment: f64,
}

impl<T: ForceNumber<Plain = f64>> Forces<T> {
    /// What acts on the links at the instant last solved: joints and drives as in [`Forces::joint_loads`], then loads,
    /// weights, springs and dampers on everything but the frame.
    pub fn arrows(&self, at: &Instant<T>) -> Vec<ForceArrow> {
        let model = &self.design.mechanism.model;
        let mut arrows: Vec<ForceArrow> = (self.joint_loads(at).into_iter())
            .map(|load| ForceArrow {
                origin: match load.carrier {
                    Carrier::Drive(_) => Origin::Drive,
                    _ => Origin::Joint,
                },
                name: load.carrier.name(&self.design.mechanism),
                link: load.link,
                place: load.place,
                force: match load.carrier {
                    Carrier::Drive(id) if is_turn(model.drives.get(id.index())) => [0.0; 2],
                    _ => load.force,
                },
                // Pins, slots and cylinders carry none: what is there is rounding.
                moment: match load.carrier {
                    Carrier::Drive(id) if !is_turn(model.drives.get(id.index())) => 0.0,
                    Carrier::Pin(_) => 0.0,
                    Carrier::Joint(id) if !holds_angle(model.joints.get(id.index())) => 0.0,
                    _ => load.moment,
                },
            })
            .collect();
        for (load, named) in self.acting.loads.iter().zip(&model.actions.loads) {
            arrows.extend(self.load_arrow(at, load, &named.name));
        }
        for mass in self.acting.masses.iter().filter(|m| m.mass.value() > 0.0) {
            let weight = self.acting.gravity.map(|g| (g * mass.mass).value());
            if weight == [0.0; 2] {
                continue;
            }
            arrows.push(ForceArrow {
                origin: Origin::Weight,
                name: (model.links.get(mass.link.index()))
                    .map_or_else(String::new, |l| l.name.clone()),
                link: mass.link,
                place: at.place(mass.body, mass.arm(at)).map(|x| x.value()),
                force: weight,
                moment: 0.0,
            });
        }
        for (spring, named) in self.acting.springs.iter().zip(&model.actions.springs) {
            let tension = spring.tension(&self.design.geometry, at).value();
            self.pull_arrows(
                at,
                &spring.ends,
                tension,
                Origin::Spring,
                &named.name,
                &mut arrows,
            );
        }
        for (damper, named) in self.acting.dampers.iter().zip(&model.actions.dampers) {
            let tension = damper.tension_at(&self.design.geometry, at).value();
            self.pull_arrows(
                at,
                &damper.ends,
                tension,
                Origin::Damper,
                &named.name,
                &mut arrows,
            );
        }
        arrows
    }

    fn load_arrow(&self, at: &Instant<T>, load: &Load, name: &str) -> Option<ForceArrow> {
        let (link, marker) = match *load {
            Load::Force { link, at, .. } => (link, at),
            Load::Torque { on, against, .. } => (on, self.pivot_marker(on, against)?),
        };
        let (force, moment) = match *load {
            Load::Force { .. } => (
                load.force(&self.design.mechanism, &self.design.geometry, at)?,
                T::zero(),
            ),
            Load::Torque { amount, .. } => ([T::zero(); 2], at.amounts[amount]),
        };
        (link != FRAME).then(|| ForceArrow {
            origin: Origin::Load,
            name: name.to_owned(),
            link,
            place: self.place_of(at, marker),
            force: force.map(|f| f.value()),
            moment: moment.value(),
        })
    }

    /// What a tension does at its ends: it pulls them together, or resists growth of the angle.
    fn pull_arrows(
        &self,
        at: &Instant<T>,
        ends: &Ends,
        tension: f64,
        origin: Origin,
        name: &str,
        arrows: &mut Vec<ForceArrow>,
    ) {
        let mut add = |link: LinkId, place: [f64; 2], force: [f64; 2], moment: f64| {
            if link != FRAME {
                arrows.push(ForceArrow {
                    origin,
                    name: name.to_owned(),
                    link,
                    place,
                    force,
                    moment,
                });
            }
        };
        match ends {
            Ends::Points([(link_a, a), (link_b, b)]) => {
                let (a, b) = (self.place_of(at, *a), self.place_of(at, *b));
                let span = sub(b, a);
                let length = length(span);
                if length > 0.0 {
                    let pull = span.map(|x| x / length * tension);
                    add(*link_a, a, pull, 0.0);
                    add(*link_b, b, pull.map(|x| -x), 0.0);
                }
            }
            Ends::Links([(link_a, _), (link_b, _)]) => {
                let turned = [(*link_a, *link_b, tension), (*link_b, *link_a, -tension)];
                for (link, other, moment) in turned {
                    if let Some(marker) = self.pivot_marker(link, other) {
                        add(link, self.place_of(at, marker), [0.0; 2], moment);
                    }
                }
            }
        }
    }

    pub(crate) fn place_of(&self, at: &Instant<T>, marker: Marker) -> [f64; 2] {
        let arm = at.arm(marker.body, self.design.geometry.marker(marker));
        at.place(marker.body, arm).map(|x| x.value())
    }

    /// The point at which a moment between two links is drawn: their pin, or else the first point of the first.
    pub(crate) fn pivot_marker(&self, link: LinkId, other: LinkId) -> Option<Marker> {
        let model = &self.design.mechanism.model;
        let own = &model.links.get(link.index())?.points;
        let shared = own.iter().find(|p| {
            (model.points.get(p.point.index())).is_some_and(|point| point.links.contains(&other))
        });
        self.design.mechanism.marker(LinkPointRef {
            link,
            point: shared.or(own.first())?.point,
        })
    }
}

/// Whether a joint carries a moment.
fn holds_angle(joint: Option<&Joint>) -> bool {
    joint.is_some_and(|j| j.kind.holds_angle())
}

fn is_turn(drive: Option<&kempe_model::Drive>) -> bool {
    drive.is_some_and(|d| match &d.kind {
        DriveKind::StandIn(StandIn::Follows { of, .. }) => matches!(**of, DriveKind::Turn { .. }),
        kind => matches!(kind, DriveKind::Turn { .. }),
    })
}
