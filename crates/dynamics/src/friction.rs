//! What a joint adds to its load in proportion to it: friction at pins, sliders and teeth, Coulomb's with Stribeck's falling
//! coefficient and a viscous part, and the force with which teeth part their wheels.

use kempe_contact::falling_coefficient;
use kempe_mechanism::constraint::{Joint, Rubs};
use kempe_mechanism::structure::Source;
use kempe_mechanism::{Geometry, Mechanism};
use kempe_model::{self as model, FrictionAt, JointId, PointId, ToothSize};
use kempe_number::Number;

use crate::number::ForceNumber;
use crate::problem::Problem;
use crate::teeth::Teeth;

pub use crate::sliding_sense::direction;

/// A friction law: resistance over sliding speed and load.
#[derive(Clone, Copy, Debug)]
pub struct FrictionLaw<T> {
    /// Kinetic coefficient.
    pub kinetic: T,
    /// Coefficient at rest.
    pub at_rest: T,
    /// Speed at which the coefficient has fallen to the e-th part of the way, m/s.
    pub stribeck_speed: Option<T>,
    /// Viscous part, N m s/rad at pins, N s/m at sliders and teeth.
    pub viscous: T,
    /// What it resists with whatever the load, N m at pins, N at sliders and teeth.
    pub drag: T,
}

impl<T: Number> FrictionLaw<T> {
    fn new(friction: &model::Friction, parameters: &[T]) -> Self {
        let of = |scalar: &model::Scalar| model::value(scalar, parameters);
        let kinetic = of(&friction.coefficient);
        Self {
            kinetic,
            at_rest: friction.static_coefficient.as_ref().map_or(kinetic, of),
            stribeck_speed: friction.stribeck_speed.as_ref().map(of),
            viscous: friction.viscous.as_ref().map_or(T::zero(), of),
            drag: friction.drag.as_ref().map_or(T::zero(), of),
        }
    }

    /// That of what does not rub.
    fn none() -> Self {
        let zero = T::zero();
        Self {
            kinetic: zero,
            at_rest: zero,
            stribeck_speed: None,
            viscous: zero,
            drag: zero,
        }
    }

    /// The coefficient at a sliding speed: `k + (s - k) exp(-(v / v_s)^2)`.
    pub fn coefficient(&self, speed: T) -> T {
        match self.stribeck_speed {
            Some(scale) => falling_coefficient(self.kinetic, self.at_rest, scale, speed),
            None => self.kinetic,
        }
    }
}

/// What bears a joint's load.
#[derive(Clone, Copy, Debug)]
pub enum Bearing<T> {
    /// A guide: its load is the normal force.
    Guide,
    /// A pin of this radius, m, in its hole: its load is the resultant of two rows.
    Pin(T),
    /// Teeth that slide on each other; their load is the force along the common tangent of the pitch circles, and their path
    /// counts what the joint tells the length of.
    Teeth(Teeth<T>),
    /// The flanks of teeth, which push their wheels apart by this part of that force whether they slide or not.
    Flanks(T),
}

/// What tells in which sense friction acts, and how much of it.
#[derive(Clone, Copy, Debug)]
pub enum Sense<T> {
    /// The way that its joint slides, or is about to.
    BySpeed,
    /// The amount in this place: the part of the greatest friction that acts, positive where it resists sliding forwards.
    Amount(usize),
    /// It resists with so much, N m at a pin, N on a line, whatever the load.
    Resists(T),
}

/// Friction at one joint of a mechanism, or the force that parts its wheels.
#[derive(Clone, Copy, Debug)]
pub struct Friction<T> {
    /// Index of the joint's constraint.
    pub constraint: usize,
    /// Where it acts.
    pub bearing: Bearing<T>,
    /// The law; flanks need none.
    pub law: FrictionLaw<T>,
    /// What tells its sense.
    pub sense: Sense<T>,
}

impl<T: ForceNumber> Friction<T> {
    /// Compiles the model's friction: what is said of one joint goes before what is said of all.
    pub(crate) fn all(
        mechanism: &Mechanism,
        geometry: &Geometry<T>,
        parameters: &[T],
        problems: &mut Vec<Problem>,
    ) -> Vec<Self> {
        for friction in &mechanism.model.actions.friction {
            Self::check(mechanism, friction, parameters, problems);
        }
        let mut list = Vec::new();
        for (constraint, (joint, source)) in mechanism.constraints.iter().enumerate() {
            if matches!(source, Source::Drive(_)) {
                continue;
            }
            let Some(rubs) = joint.rubs() else {
                problems.extend(no_axes(mechanism, source, joint.drive().is_some()));
                continue;
            };
            let (of_own, of_all) = told(&mechanism.model, *source);
            let mut add = |bearing, law| {
                list.push(Self {
                    constraint,
                    bearing,
                    law,
                    sense: Sense::BySpeed,
                });
            };
            let law = |friction| FrictionLaw::new(friction, parameters);
            match rubs {
                Rubs::AlongGuide => {
                    if let Some(friction) = of_own.or(of_all) {
                        add(Bearing::Guide, law(friction));
                    }
                }
                Rubs::AboutPin => {
                    if let Some(friction) = of_own.or(of_all) {
                        let radius = (friction.radius.as_ref())
                            .map_or(T::zero(), |radius| model::value(radius, parameters));
                        add(Bearing::Pin(radius), law(friction));
                    }
                }
                Rubs::Teeth { constants, rack } => {
                    let Some(form) = teeth_of(mechanism, source) else {
                        continue;
                    };
                    let Some(angle) = &form.pressure_angle else {
                        continue;
                    };
                    let angle: T = model::value(angle, parameters);
                    let tooth = match &form.size {
                        ToothSize::Counted => Some(T::one()),
                        ToothSize::Module(module) => (module.as_ref())
                            .map(|module| model::value::<T>(module, parameters) * 0.5),
                    };
                    let (s, c) = angle.sin_cos();
                    add(Bearing::Flanks(s / c), FrictionLaw::none());
                    if let (Some(friction), Some(tooth)) = (of_own, tooth) {
                        let k = &geometry.gears[constants as usize];
                        let numbers = match rack {
                            true => [None, Some(k.second.abs() / tooth)],
                            false => Teeth::numbers(k.first, k.second, tooth),
                        };
                        let teeth = Teeth::new(angle, numbers);
                        let path = teeth.path * tooth;
                        add(Bearing::Teeth(Teeth { path, ..teeth }), law(friction));
                    }
                }
            }
        }
        list
    }

    fn check(
        mechanism: &Mechanism,
        friction: &model::Friction,
        parameters: &[T],
        problems: &mut Vec<Problem>,
    ) {
        let mut add = |code, message: String| {
            problems.push(Problem::new(code, &friction.span, message));
        };
        let law = FrictionLaw::new(friction, parameters);
        if [law.kinetic, law.at_rest, law.viscous, law.drag]
            .iter()
            .any(|x| x.any_lane(|x| x < 0.0))
        {
            add(
                "negative-friction",
                "friction is never negative: it would add energy".into(),
            );
        }
        let radius = (friction.radius.as_ref()).map(|scalar| model::value(scalar, parameters));
        if radius.is_some_and(|r| r.any_lane(|r| r < 0.0)) {
            add("negative-radius", "the radius of a pin is negative".into());
        }
        match friction.at {
            FrictionAt::Pin(point) if radius.is_none() && law.kinetic.any_lane(|x| x > 0.0) => {
                let name = point_name(mechanism, point);
                add(
                    "friction-radius",
                    format!("friction at the pin {name} needs the pin's radius"),
                );
            }
            FrictionAt::Joint(joint) if !slides(mechanism, joint) => add(
                "friction-place",
                "friction acts at pins, sliders, slots and teeth; belts and welds have none here"
                    .into(),
            ),
            FrictionAt::Joint(joint) => {
                let teeth = teeth_of(mechanism, &Source::Joint(joint));
                if teeth.is_some_and(|teeth| {
                    teeth.pressure_angle.is_none() || teeth.size == ToothSize::Module(None)
                }) {
                    add(
                        "friction-teeth",
                        "friction at teeth needs their pressure angle, and the module where wheels are told by radii"
                            .into(),
                    );
                }
            }
            _ => {}
        }
    }

    /// Resistance (N m at a pin, N on a line) to a relative speed (rad/s or m/s) under a load (N), with the sign of
    /// `direction`; what it does is the opposite of its sign. Viscous resistance and drag included.
    #[inline]
    pub fn resistance(&self, speed: T, direction: T, load: T) -> T {
        self.per_load(speed) * load * direction + self.apart_from_load(speed, direction)
    }

    /// The part of the resistance that does not depend on the load.
    #[inline]
    pub(crate) fn apart_from_load(&self, speed: T, direction: T) -> T {
        self.law.drag * direction + self.law.viscous * speed
    }

    /// Resistance over load. The load of a line is its normal force; that of a pin is its whole force, friction included,
    /// which passes the pin's centre on the friction circle: at `r sin(atan(mu))`.
    pub(crate) fn per_load(&self, speed: T) -> T {
        match self.bearing {
            Bearing::Guide => self.law.coefficient(speed.abs()),
            Bearing::Pin(radius) => {
                let coefficient = self.law.coefficient(speed.abs() * radius);
                coefficient * radius / (coefficient.square() + 1.0).sqrt()
            }
            Bearing::Teeth(teeth) => self.law.coefficient(speed.abs()) * teeth.secant,
            Bearing::Flanks(tangent) => tangent,
        }
    }

    /// How many rows, from its joint's first on, make up its load.
    pub(crate) fn rows(&self) -> usize {
        match self.bearing {
            Bearing::Pin(_) => 2,
            Bearing::Guide | Bearing::Teeth(_) | Bearing::Flanks(_) => 1,
        }
    }

    /// Whether anything of it resists at rest: what is viscous alone does not, nor a pin without a radius.
    pub fn is_dry(&self) -> bool {
        let law = &self.law;
        let positive = |x: T| x.any_lane(|x| x > 0.0);
        let pressed = match self.bearing {
            Bearing::Pin(radius) => positive(radius),
            Bearing::Guide | Bearing::Teeth(_) => true,
            Bearing::Flanks(_) => false,
        };
        pressed && (positive(law.kinetic) || positive(law.at_rest)) || positive(law.drag)
    }

    /// Whether it is friction, and no force that parts wheels.
    pub(crate) fn rubs(&self) -> bool {
        !matches!(self.bearing, Bearing::Flanks(_))
    }

    /// Whether its speed is that of an angle, rad/s: a length's otherwise, m/s.
    pub fn turns(&self) -> bool {
        matches!(self.bearing, Bearing::Pin(_))
    }

    /// How much of it acts where this share of the friction does: what parts wheels acts all the time.
    pub(crate) fn share(&self, of_friction: f64) -> f64 {
        if self.rubs() { of_friction } else { 1.0 }
    }

    /// Derivative of the resistance to the load, in a lane.
    #[inline]
    pub(crate) fn slope(&self, speed: T, direction: T, lane: usize) -> f64 {
        let speed = T::from_f64(speed.value_in(lane));
        self.per_load(speed).value_in(lane) * direction.value_in(lane)
    }
}

/// What the file says of friction at a joint, and what it says there of all pins, sliders and slots.
fn told(
    model: &model::Model,
    joint: Source,
) -> (Option<&model::Friction>, Option<&model::Friction>) {
    let own = match joint {
        Source::Pin { point, .. } => FrictionAt::Pin(point),
        Source::Joint(joint) => FrictionAt::Joint(joint),
        Source::Drive(_) => return (None, None),
    };
    let smooth = model.actions.smooth.iter();
    if smooth.copied().any(|smooth| joint == smooth.into()) {
        return (None, None);
    }
    let at = |at| model.actions.friction.iter().rev().find(|f| f.at == at);
    (at(own), at(FrictionAt::All))
}

/// What the file says of friction at a pin, slider or slot.
pub fn told_of(model: &model::Model, joint: Source) -> Option<&model::Friction> {
    let (own, all) = told(model, joint);
    own.or(all)
}

fn slides(mechanism: &Mechanism, joint: JointId) -> bool {
    let mut constraints = mechanism.constraints.iter();
    constraints.any(|(c, source)| *source == Source::Joint(joint) && c.rubs().is_some())
}

/// What a gear pair or rack tells of its teeth.
fn teeth_of<'m>(mechanism: &'m Mechanism, source: &Source) -> Option<&'m model::Teeth> {
    let Source::Joint(joint) = source else {
        return None;
    };
    (mechanism.model.joints.get(joint.index()))?.kind.teeth()
}

/// What is wrong with teeth of which a pressure angle is told, but not where their wheels meet.
fn no_axes(mechanism: &Mechanism, source: &Source, released: bool) -> Option<Problem> {
    let asked = teeth_of(mechanism, source)?.pressure_angle.is_some() && !released;
    let Source::Joint(joint) = source else {
        return None;
    };
    let joint = mechanism.model.joints.get(joint.index())?;
    asked.then(|| {
        let message = format!(
            "joint `{}` has a pressure angle, but its gears have no axes on their arm: where their teeth meet is not known",
            joint.name
        );
        Problem::new("teeth-without-axes", &joint.span, message).remedy(
            "name the centre of each gear on the arm too, say which link the arm is, or leave the pressure angle out",
        )
    })
}

fn point_name(mechanism: &Mechanism, point: PointId) -> &str {
    (mechanism.model.points.get(point.index())).map_or("?", |p| p.name.as_str())
}
