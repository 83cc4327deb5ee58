//! What joints carry, as vectors on a named link.

use kempe_mechanism::Mechanism;
use kempe_mechanism::constraint::{Joint as _, LoadPoint};
use kempe_mechanism::structure::Source;
use kempe_model::{
    DriveId, DriveKind, JointId, JointKind, JointRef, LinkId, LinkPointRef, PointId,
};
use kempe_number::Number;

use crate::forces::Forces;
use crate::instant::Instant;
use crate::number::ForceNumber;
use crate::vector::{dot, length, sub};
use crate::wrench::{self, Wrench};

/// A joint's load on one link.
#[derive(Clone, Copy, Debug)]
pub struct Reaction<T> {
    /// The link that feels it.
    pub link: LinkId,
    /// Where it acts in the frame, m.
    pub place: [T; 2],
    /// Force along the frame's axes, N.
    pub force: [T; 2],
    /// Moment about that place, N m.
    pub moment: T,
}

impl<T: Number> Reaction<T> {
    /// Size of the force, N.
    pub fn size(&self) -> T {
        length(self.force)
    }
}

/// Which joint or drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carrier {
    /// A pin between links.
    Pin(PointId),
    /// A joint of the file.
    Joint(JointId),
    /// A drive.
    Drive(DriveId),
}

impl Carrier {
    /// Whose constraint it is.
    pub(crate) fn of(source: &Source) -> Self {
        match *source {
            Source::Pin { point, .. } => Self::Pin(point),
            Source::Joint(id) => Self::Joint(id),
            Source::Drive(id) => Self::Drive(id),
        }
    }

    /// The joint's or drive's name in the file.
    pub fn name(&self, mechanism: &Mechanism) -> String {
        let model = &mechanism.model;
        let name = match self {
            Self::Pin(p) => model.points.get(p.index()).map(|p| &p.name),
            Self::Joint(j) => model.joints.get(j.index()).map(|j| &j.name),
            Self::Drive(d) => model.drives.get(d.index()).map(|d| &d.name),
        };
        name.cloned().unwrap_or_default()
    }
}

/// A joint's load in plain numbers, for arrows and reports.
#[derive(Clone, Debug)]
pub struct JointLoad {
    /// Which joint or drive.
    pub carrier: Carrier,
    /// The link that feels it; the joint's other link feels the opposite.
    pub link: LinkId,
    /// Where it acts in the frame, m.
    pub place: [f64; 2],
    /// Force along the frame's axes, N.
    pub force: [f64; 2],
    /// Moment about that place, N m.
    pub moment: f64,
    /// Whether equilibrium determines it.
    pub unique: bool,
}

impl<T: ForceNumber> Forces<T> {
    /// The load of a joint on the link asked for, or on the one that the sign convention names. `None` when the joint
    /// has no load on that link.
    pub fn reaction(&self, at: &Instant<T>, joint: JointRef) -> Option<Reaction<T>> {
        match joint {
            JointRef::Pin(point, link) => {
                let model = &self.design.mechanism.model;
                let link =
                    link.or_else(|| model.points.get(point.index())?.links.last().copied())?;
                let is_pin =
                    |source: &Source| matches!(source, Source::Pin { point: p, .. } if *p == point);
                let w = self.on_body_of(at, link, is_pin)?;
                let marker = (self.design.mechanism.marker(LinkPointRef { link, point }))
                    .or_else(|| self.design.mechanism.any_marker(point))?;
                let place = at.place(
                    marker.body,
                    at.arm(marker.body, self.design.geometry.marker(marker)),
                );
                Some(self.about(at, link, place, w))
            }
            JointRef::Joint(id, link) => self.joint_reaction(at, id, link),
        }
    }

    fn joint_reaction(
        &self,
        at: &Instant<T>,
        id: JointId,
        link: Option<LinkId>,
    ) -> Option<Reaction<T>> {
        let joint = self.design.mechanism.model.joints.get(id.index())?;
        let link = link.unwrap_or(joint.kind.links().0);
        if let JointKind::Weld { .. } = joint.kind {
            let weld = self.welds.iter().find(|w| w.joint == id)?;
            let on_child = self.weld_on_child(weld);
            let arm = at.arm(weld.at.body, self.design.geometry.marker(weld.at));
            let place = at.place(weld.at.body, arm);
            let w = if link == weld.child {
                on_child
            } else if link == weld.parent {
                wrench::opposite(on_child)
            } else {
                return None;
            };
            return Some(self.about(at, link, place, w));
        }
        let w = self.on_body_of(at, link, |source| *source == Source::Joint(id))?;
        Some(self.about(at, link, self.joint_place(at, id, link)?, w))
    }

    /// Where a joint's load on a link is counted.
    fn joint_place(&self, at: &Instant<T>, id: JointId, link: LinkId) -> Option<[T; 2]> {
        let mechanism = &self.design.mechanism;
        let body = mechanism.body_of(link);
        let own = || (mechanism.constraints.iter()).filter(|c| c.1 == Source::Joint(id));
        let situation = at.situation(&self.design.geometry);
        if let Some(place) = own().find_map(|(c, _)| c.load_place(&situation)) {
            return Some(place);
        }
        let point = own().find_map(|(c, _)| c.load_point(body))?;
        Some(match point {
            LoadPoint::At(marker) => at.place(
                marker.body,
                at.arm(marker.body, self.design.geometry.marker(marker)),
            ),
            LoadPoint::Origin(body) => {
                let pose = &at.poses[body.index()];
                [pose.x, pose.y]
            }
        })
    }

    /// Everything that constraints from one source, and contacts there, do to a link's body.
    fn on_body_of(
        &self,
        at: &Instant<T>,
        link: LinkId,
        from: impl Fn(&Source) -> bool,
    ) -> Option<Wrench<T>> {
        let body = self.design.mechanism.body_of(link);
        let mut sum: Option<Wrench<T>> = None;
        for ((_, source), sides) in self.design.mechanism.constraints.iter().zip(&self.sides) {
            if !from(source) {
                continue;
            }
            for side in sides.iter().filter(|s| s.body == body) {
                wrench::add(sum.get_or_insert([T::zero(); 3]), side.wrench);
            }
        }
        for contact in self.acting.contacts.iter().filter(|c| from(&c.joint)) {
            contact.act(at, |on, w| {
                if on == body {
                    wrench::add(sum.get_or_insert([T::zero(); 3]), w);
                }
            });
        }
        sum
    }

    fn about(&self, at: &Instant<T>, link: LinkId, place: [T; 2], w: Wrench<T>) -> Reaction<T> {
        let pose = &at.poses[self.design.mechanism.body_of(link).index()];
        Reaction {
            link,
            place,
            force: [w[0], w[1]],
            moment: wrench::moment_at(w, sub(place, [pose.x, pose.y])),
        }
    }

    /// Force along a link's x axis and along its y axis, N.
    pub fn in_axes_of(&self, at: &Instant<T>, link: LinkId, force: [T; 2]) -> [T; 2] {
        let seat = &self.design.geometry.seats[link.index()];
        let body = &at.poses[self.design.mechanism.body_of(link).index()];
        let x = body.turn([seat.c, seat.s]);
        [dot(x, force), dot([-x[1], x[0]], force)]
    }
}

impl<T: ForceNumber<Plain = f64>> Forces<T> {
    /// The loads of all joints and drives in plain numbers: pins on every later link, joints on their first-named link,
    /// drives on the link they move (the eye of a cylinder).
    pub fn joint_loads(&self, at: &Instant<T>) -> Vec<JointLoad> {
        let loose = self.equilibrium.not_unique();
        let mut list: Vec<JointLoad> = Vec::new();
        let model = &self.design.mechanism.model;
        for (index, (_, source)) in self.design.mechanism.constraints.iter().enumerate() {
            let (carrier, reaction) = match *source {
                Source::Pin { point, link } => (
                    Carrier::Pin(point),
                    self.reaction(at, JointRef::Pin(point, Some(link))),
                ),
                Source::Joint(id) => (Carrier::Joint(id), self.joint_reaction(at, id, None)),
                Source::Drive(id) => (Carrier::Drive(id), self.drive_reaction(at, index, id)),
            };
            // A slider has two constraints and one load.
            if let Carrier::Joint(_) = carrier
                && let Some(known) = list.iter_mut().find(|l| l.carrier == carrier)
            {
                known.unique &= !loose.contains(&index);
                continue;
            }
            list.extend(reaction.map(|r| plain(carrier, &r, !loose.contains(&index))));
        }
        for turning in &self.acting.turning {
            let [link, other] = turning.links();
            let torque = self.acting.turns(turning.drive, at).value();
            list.extend(self.pivot_marker(link, other).map(|marker| JointLoad {
                carrier: Carrier::Drive(turning.drive),
                link,
                place: self.place_of(at, marker),
                force: [0.0; 2],
                moment: torque,
                unique: true,
            }));
        }
        for (index, joint) in model.joints.iter().enumerate() {
            let id = JointId(index as u32);
            if let JointKind::Weld { .. } = joint.kind {
                let reaction = self.joint_reaction(at, id, None);
                list.extend(reaction.map(|r| plain(Carrier::Joint(id), &r, true)));
            }
        }
        list
    }

    fn drive_reaction(
        &self,
        at: &Instant<T>,
        constraint: usize,
        id: DriveId,
    ) -> Option<Reaction<T>> {
        let side = self.sides.get(constraint)?.first()?;
        let marker = match &self.design.mechanism.model.drives.get(id.index())?.kind {
            DriveKind::Cylinder { b, .. } => self.design.mechanism.marker(*b),
            DriveKind::Slide { joint } => {
                let kind = &self.design.mechanism.model.joints[joint.index()].kind;
                kind.guide()
                    .and_then(|(at, _)| self.design.mechanism.marker(at))
            }
            DriveKind::Turn { link, relative_to } => self.pivot_marker(*link, *relative_to),
            // Its constraints are the joint's, and so is its load.
            DriveKind::Release { .. } => None,
            // What tells the place carries nothing; what follows has no constraint.
            DriveKind::StandIn(_) => None,
        }?;
        let place = at.place(
            marker.body,
            at.arm(marker.body, self.design.geometry.marker(marker)),
        );
        Some(self.about(at, side.link, place, side.wrench))
    }
}

fn plain<T: Number>(carrier: Carrier, r: &Reaction<T>, unique: bool) -> JointLoad {
    JointLoad {
        carrier,
        link: r.link,
        place: r.place.map(Number::value),
        force: r.force.map(Number::value),
        moment: r.moment.value(),
        unique,
    }
}
