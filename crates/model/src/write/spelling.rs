//! Values and measures as they are written.

use kempe_units::{Dimension, Expr, Kind, Natural, Node, Spelling, Unit};

use crate::ids::{DriveId, JointId, Line, LinkId, LinkPointRef, ParameterId, PointId, Scalar};
use crate::inner::{Chamber, InnerState};
use crate::item::Item;
use crate::joint::JointKind;
use crate::measure::{ForceMeasure, JointRef, Leaf, Measure, PoseMeasure, Statistic};
use crate::model::Model;
use crate::read::laws::rate;
use crate::tables::Tables;

/// A model while it is written.
pub(super) struct Writer<'m> {
    pub model: &'m Model,
    pub tables: Tables,
    /// The file's units.
    preferred: Vec<Unit>,
}

impl<'m> Writer<'m> {
    pub fn new(model: &'m Model) -> Self {
        let units = &model.units;
        let named = [&units.length, &units.angle].into_iter().chain(&units.more);
        Self {
            model,
            tables: Tables::new(),
            preferred: named.filter_map(|u| Unit::parse(&u.name).ok()).collect(),
        }
    }

    /// A dimension of the design where one of `dimension` is read: lengths and angles as bare numbers in the file's unit.
    pub fn scalar(&self, scalar: &Scalar, dimension: Dimension) -> Item {
        let Expr::Const(si) = scalar else {
            return self.expression(scalar, dimension);
        };
        let bare = [Dimension::NONE, Dimension::LENGTH, Dimension::ANGLE].contains(&dimension);
        let unit = Unit::for_display(dimension, &self.preferred);
        match Unit::exact(*si, dimension, &self.preferred) {
            _ if si.to_bits() == 0 => Item::Number(0.0),
            Some((x, exact)) if bare && exact == unit => Item::Number(x),
            _ => self.expression(scalar, dimension),
        }
    }

    /// An expression over parameters as a string.
    pub fn expression(&self, scalar: &Scalar, dimension: Dimension) -> Item {
        Item::text(scalar.to_node(dimension, self).to_string())
    }

    /// A measure as a string.
    pub fn measure(&self, measure: &Measure, dimension: Dimension) -> Item {
        Item::text(measure.to_node(dimension, self).to_string())
    }

    /// What an expression over parameters measures by itself.
    pub fn measures(&self, scalar: &Scalar) -> Natural {
        scalar.natural(self)
    }

    pub fn point(&self, id: PointId) -> &'m str {
        let point = self.model.points.get(id.index());
        point.map_or("?", |p| p.name.as_str())
    }

    pub fn link(&self, id: LinkId) -> &'m str {
        let link = self.model.links.get(id.index());
        link.map_or("?", |l| l.name.as_str())
    }

    pub fn joint(&self, id: JointId) -> &'m str {
        let joint = self.model.joints.get(id.index());
        joint.map_or("?", |j| j.name.as_str())
    }

    pub fn drive(&self, id: DriveId) -> &'m str {
        let drive = self.model.drives.get(id.index());
        drive.map_or("?", |d| d.name.as_str())
    }

    /// `A -> B`.
    pub fn line(&self, line: Line) -> String {
        format!("{} -> {}", self.point(line.from), self.point(line.to))
    }

    /// What a drive's coordinate measures.
    fn coordinate(&self, id: DriveId) -> Dimension {
        let drive = self.model.drives.get(id.index());
        drive.map_or(Dimension::NONE, |d| d.dimension)
    }

    fn turns(&self, id: DriveId) -> bool {
        self.coordinate(id) == Dimension::ANGLE
    }

    fn pose(&self, pose: &PoseMeasure) -> Natural {
        use PoseMeasure as P;
        Natural::fixed(match pose {
            P::Angle(_) | P::AngleBetween(..) | P::Direction(..) | P::TransmissionAngle { .. } => {
                Dimension::ANGLE
            }
            P::Speed(_) => Dimension::SPEED,
            P::Acceleration(_) => Dimension::ACCELERATION,
            P::AngularSpeed(_) => Dimension::ANGULAR_SPEED,
            P::AngularAcceleration(_) => Dimension::ANGULAR_ACCELERATION,
            P::Curvature(_) => Dimension::CURVATURE,
            P::MechanicalAdvantage(of, drive) => {
                let of = of.natural(self);
                return Natural {
                    dimension: self.coordinate(*drive) / of.dimension,
                    ..of
                };
            }
            P::X(_)
            | P::Y(_)
            | P::XOn(..)
            | P::YOn(..)
            | P::Distance(..)
            | P::DistanceToLine(..)
            | P::Travel(..)
            | P::InstantCenterX(..)
            | P::InstantCenterY(..)
            | P::CurvatureCenterX(_)
            | P::CurvatureCenterY(_)
            | P::PathLength(_) => Dimension::LENGTH,
        })
    }

    fn force(&self, force: &ForceMeasure) -> Dimension {
        use ForceMeasure as F;
        let effort = |turns: bool| match turns {
            true => Dimension::TORQUE,
            false => Dimension::FORCE,
        };
        let acting = &self.model.actions;
        match force {
            F::Drive(id) | F::ReducedLoad(id) | F::Capacity(id) => effort(self.turns(*id)),
            F::ReducedMass(id) if self.turns(*id) => Dimension::INERTIA,
            F::ReducedMass(_) => Dimension::MASS,
            F::ReactionAngle(_) => Dimension::ANGLE,
            F::ReactionMoment(_) | F::ShakingMoment => Dimension::TORQUE,
            F::Power(_) => Dimension::POWER,
            F::KineticEnergy | F::PotentialEnergy => Dimension::ENERGY,
            F::Pressure(_) => Dimension::PRESSURE,
            F::Spring(i) => acting.springs.get(*i).map_or(Dimension::FORCE, |s| {
                crate::read::springs::tension(&s.between)
            }),
            F::Damper(i) => acting.dampers.get(*i).map_or(Dimension::FORCE, |d| {
                crate::read::springs::tension(&d.between)
            }),
            F::Load(i) => effort(matches!(
                acting.loads.get(*i).map(|l| &l.kind),
                Some(crate::load::LoadKind::Torque { .. })
            )),
            F::Reaction(_)
            | F::ReactionX(_)
            | F::ReactionY(_)
            | F::ReactionAlong(_)
            | F::ReactionAcross(_)
            | F::ShakingForce
            | F::ShakingForceX
            | F::ShakingForceY
            | F::LoadX(_)
            | F::LoadY(_) => Dimension::FORCE,
        }
    }

    /// The joint that guides a point along a line.
    fn guide(&self, at: LinkPointRef, on: Line) -> &'m str {
        let guides = |kind: &JointKind| match *kind {
            JointKind::Slider { at: a, on: o, .. } => (a, o) == (at, on),
            JointKind::Slot { pin, on: o } => (pin, o) == (at, on),
            _ => false,
        };
        let joint = self.model.joints.iter().find(|j| guides(&j.kind));
        joint.map_or("?", |j| j.name.as_str())
    }

    fn pose_node(&self, pose: &PoseMeasure, dimension: Dimension) -> Node {
        use PoseMeasure as P;
        let p = |id: &PointId| point(self.point(*id));
        let l = |id: &LinkId| name(self.link(*id));
        match pose {
            P::X(a) => call("x", vec![p(a)]),
            P::Y(a) => call("y", vec![p(a)]),
            P::XOn(a, on) => call("x", vec![p(a), l(on)]),
            P::YOn(a, on) => call("y", vec![p(a), l(on)]),
            P::Angle(a) => call("angle", vec![l(a)]),
            P::AngleBetween(a, b) => call("angle", vec![l(a), l(b)]),
            P::Direction(a, b) => call("angle", vec![arrow(p(a), p(b))]),
            P::Distance(a, b) => call("distance", vec![p(a), p(b)]),
            P::DistanceToLine(a, on) => call("distance", vec![p(a), arrow(p(&on.from), p(&on.to))]),
            P::Travel(at, on) => call("travel", vec![name(self.guide(*at, *on))]),
            P::TransmissionAngle {
                at,
                a,
                b,
                folded: true,
            } => call("transmission_angle", vec![p(at), p(a), p(b)]),
            P::TransmissionAngle { at, a, b, .. } => call("angle", vec![p(a), p(at), p(b)]),
            P::Speed(a) => call("speed", vec![p(a)]),
            P::Acceleration(a) => call("acceleration", vec![p(a)]),
            P::AngularSpeed(a) => call("angular_speed", vec![l(a)]),
            P::AngularAcceleration(a) => call("angular_acceleration", vec![l(a)]),
            P::InstantCenterX(a, b) => call("instant_center_x", vec![l(a), l(b)]),
            P::InstantCenterY(a, b) => call("instant_center_y", vec![l(a), l(b)]),
            P::Curvature(a) => call("curvature", vec![p(a)]),
            P::CurvatureCenterX(a) => call("curvature_center_x", vec![p(a)]),
            P::CurvatureCenterY(a) => call("curvature_center_y", vec![p(a)]),
            P::PathLength(a) => call("path_length", vec![p(a)]),
            P::MechanicalAdvantage(of, drive) => {
                let inner = of.to_node(self.coordinate(*drive) / dimension, self);
                call(
                    "mechanical_advantage",
                    vec![inner, name(self.drive(*drive))],
                )
            }
        }
    }

    fn force_node(&self, force: &ForceMeasure) -> Node {
        use ForceMeasure as F;
        let drive = |function: &str, id: &DriveId| call(function, vec![name(self.drive(*id))]);
        let joint = |function: &str, joint: &JointRef| {
            let (at, on) = match joint {
                JointRef::Pin(id, on) => (point(self.point(*id)), on),
                JointRef::Joint(id, on) => (name(self.joint(*id)), on),
            };
            let on = on.map(|link| name(self.link(link)));
            call(function, [at].into_iter().chain(on).collect())
        };
        let acting = &self.model.actions;
        let named = |function: &str, known: Option<&String>| {
            call(function, vec![name(known.map_or("?", |n| n.as_str()))])
        };
        let load = |i: &usize| acting.loads.get(*i).map(|l| &l.name);
        match force {
            F::Drive(id) if self.turns(*id) => drive("torque", id),
            F::Drive(id) => drive("force", id),
            F::Reaction(at) => joint("reaction", at),
            F::ReactionX(at) => joint("reaction_x", at),
            F::ReactionY(at) => joint("reaction_y", at),
            F::ReactionAngle(at) => joint("reaction_angle", at),
            F::ReactionAlong(at) => joint("reaction_along", at),
            F::ReactionAcross(at) => joint("reaction_across", at),
            F::ReactionMoment(at) => joint("reaction_moment", at),
            F::Power(id) => drive("power", id),
            F::KineticEnergy => name("kinetic_energy"),
            F::PotentialEnergy => name("potential_energy"),
            F::ShakingForceX => name("shaking_force_x"),
            F::ShakingForceY => name("shaking_force_y"),
            F::ShakingForce => name("shaking_force"),
            F::ShakingMoment => name("shaking_moment"),
            F::ReducedMass(id) => drive("reduced_mass", id),
            F::ReducedLoad(id) => drive("reduced_load", id),
            F::Pressure(id) => drive("pressure", id),
            F::Capacity(id) => drive("capacity", id),
            F::Spring(i) => named("spring_force", acting.springs.get(*i).map(|s| &s.name)),
            F::Damper(i) => named("damper_force", acting.dampers.get(*i).map(|d| &d.name)),
            F::Load(i) => named("load", load(i)),
            F::LoadX(i) => named("load_x", load(i)),
            F::LoadY(i) => named("load_y", load(i)),
        }
    }

    fn over_node(&self, statistic: &Statistic, of: &Measure, dimension: Dimension) -> Node {
        let inner = match statistic {
            Statistic::TimeRatio => of.natural(self).dimension,
            _ => dimension,
        };
        let inner = of.to_node(inner, self);
        match statistic {
            Statistic::Min => call("min", vec![inner]),
            Statistic::Max => call("max", vec![inner]),
            Statistic::Mean => call("mean", vec![inner]),
            Statistic::Range => call("range", vec![inner]),
            Statistic::TimeRatio => call("time_ratio", vec![inner]),
            Statistic::At { drive, value } => {
                let (by, is) = match drive {
                    Some(id) => (self.drive(*id), self.coordinate(*id)),
                    None => ("time", Dimension::TIME),
                };
                let value = value.to_node(is, self);
                call("at", vec![inner, name(by), value])
            }
        }
    }
}

impl Spelling<ParameterId> for Writer<'_> {
    fn natural(&self, id: &ParameterId) -> Natural {
        let parameter = self.model.parameters.get(id.index());
        Natural::fixed(parameter.map_or(Dimension::NONE, |p| p.dimension))
    }

    fn leaf(&self, id: &ParameterId, _: Dimension) -> Node {
        let parameter = self.model.parameters.get(id.index());
        name(parameter.map_or("?", |p| p.name.as_str()))
    }

    fn preferred(&self) -> &[Unit] {
        &self.preferred
    }
}

impl Spelling<Leaf> for Writer<'_> {
    fn natural(&self, leaf: &Leaf) -> Natural {
        let of = |inner: &Measure, change: &dyn Fn(Dimension) -> Dimension| {
            let inner = inner.natural(self);
            Natural {
                dimension: change(inner.dimension),
                ..inner
            }
        };
        match leaf {
            Leaf::Parameter(id) => Spelling::<ParameterId>::natural(self, id),
            Leaf::Named(i) => {
                let named = self.model.measures.get(*i);
                Natural::fixed(named.map_or(Dimension::NONE, |m| m.dimension))
            }
            Leaf::Drive(id) => Natural::fixed(self.coordinate(*id)),
            Leaf::Time => Natural::fixed(Dimension::TIME),
            Leaf::Inner(InnerState::Pressure(..)) => Natural::fixed(Dimension::PRESSURE),
            Leaf::Inner(InnerState::Friction(_) | InnerState::Switch(_)) => {
                Natural::fixed(Dimension::NONE)
            }
            Leaf::Pose(pose) => self.pose(pose),
            Leaf::Rate(inner, n) => of(inner, &|d| rate(d, *n as i32)),
            Leaf::Coefficient(inner, drive, n) => of(inner, &|d| d / self.per(*drive, *n)),
            Leaf::Force(force) => Natural::fixed(self.force(force)),
            Leaf::Over(Statistic::TimeRatio, _) => Natural::fixed(Dimension::NONE),
            Leaf::Over(_, inner) => inner.natural(self),
        }
    }

    fn leaf(&self, leaf: &Leaf, dimension: Dimension) -> Node {
        // the first derivative is meant where no order is named
        let order = |n: u32| (n != 1).then(|| Node::new(Kind::Number(f64::from(n)), 0..0));
        match leaf {
            Leaf::Parameter(id) => Spelling::<ParameterId>::leaf(self, id, dimension),
            Leaf::Named(i) => {
                let named = self.model.measures.get(*i);
                name(named.map_or("?", |m| m.name.as_str()))
            }
            Leaf::Drive(id) => name(self.drive(*id)),
            Leaf::Time => name("time"),
            Leaf::Inner(InnerState::Pressure(drive, side)) => {
                let function = match side {
                    Chamber::Bore => "bore_pressure",
                    Chamber::Ring => "ring_pressure",
                };
                call(function, vec![name(self.drive(*drive))])
            }
            // No file can ask for it.
            Leaf::Inner(InnerState::Friction(_)) => name("?"),
            Leaf::Inner(InnerState::Switch(i)) => {
                let switch = self.model.actions.switches.get(*i);
                call(
                    "switch",
                    vec![name(switch.map_or("?", |s| s.name.as_str()))],
                )
            }
            Leaf::Pose(pose) => self.pose_node(pose, dimension),
            Leaf::Rate(inner, n) => {
                let per = Dimension::NONE / rate(Dimension::NONE, *n as i32);
                let inner = inner.to_node(dimension * per, self);
                call("rate", [inner].into_iter().chain(order(*n)).collect())
            }
            Leaf::Coefficient(inner, drive, n) => {
                let inner = inner.to_node(dimension * self.per(*drive, *n), self);
                let of = [inner, name(self.drive(*drive))];
                call("d", of.into_iter().chain(order(*n)).collect())
            }
            Leaf::Force(force) => self.force_node(force),
            Leaf::Over(statistic, inner) => self.over_node(statistic, inner, dimension),
        }
    }

    fn preferred(&self) -> &[Unit] {
        &self.preferred
    }
}

impl Writer<'_> {
    /// What an `n`-th derivative to a drive is divided by.
    fn per(&self, drive: DriveId, n: u32) -> Dimension {
        let per = self.coordinate(drive);
        per.powi(n as i32).unwrap_or(per)
    }
}

fn name(name: &str) -> Node {
    Node::new(Kind::Name(name.to_owned()), 0..0)
}

fn point(name: &str) -> Node {
    Node::new(Kind::Point(name.to_owned()), 0..0)
}

fn arrow(from: Node, to: Node) -> Node {
    let kind = Kind::Line {
        from: Box::new(from),
        to: Box::new(to),
    };
    Node::new(kind, 0..0)
}

fn call(function: &str, arguments: Vec<Node>) -> Node {
    let kind = Kind::Call {
        function: function.to_owned(),
        function_span: 0..0,
        arguments,
    };
    Node::new(kind, 0..0)
}
