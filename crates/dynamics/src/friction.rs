//! Friction at pins and sliders: Coulomb's, with Stribeck's falling coefficient and a viscous part.

use kempe_mechanism::Mechanism;
use kempe_mechanism::constraint::{Joint, Rubs};
use kempe_mechanism::structure::Source;
use kempe_model::{self as model, FrictionAt, JointId, PointId};
use kempe_number::{Interval, Number};

use crate::number::{ForceNumber, PlainNumber};
use crate::problem::Problem;
use crate::vector::sign;

/// A friction law: resistance over sliding speed and load.
#[derive(Clone, Copy, Debug)]
pub struct FrictionLaw<T> {
    /// Kinetic coefficient.
    pub kinetic: T,
    /// Coefficient at rest.
    pub at_rest: T,
    /// Speed at which the coefficient has fallen to the e-th part of the way, m/s.
    pub stribeck_speed: Option<T>,
    /// Viscous part, N m s/rad at pins, N s/m at sliders.
    pub viscous: T,
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
        }
    }

    /// The coefficient at a sliding speed: `k + (s - k) exp(-(v / v_s)^2)`.
    pub fn coefficient(&self, speed: T) -> T {
        let Some(scale) = self.stribeck_speed else {
            return self.kinetic;
        };
        let falling = || {
            let part = (-(speed / scale).square()).exp();
            self.kinetic + (self.at_rest - self.kinetic) * part
        };
        (-scale).choose_with(|| self.kinetic, falling)
    }
}

/// Friction at one joint of a mechanism.
#[derive(Clone, Copy, Debug)]
pub struct Friction<T> {
    /// Index of the joint's constraint.
    pub constraint: usize,
    /// Radius of the pin, m; `None` where the joint slides along a guide.
    pub radius: Option<T>,
    /// The law.
    pub law: FrictionLaw<T>,
}

impl<T: ForceNumber> Friction<T> {
    /// Compiles the model's friction: what is said of one joint goes before what is said of all.
    pub(crate) fn all(
        mechanism: &Mechanism,
        parameters: &[T],
        problems: &mut Vec<Problem>,
    ) -> Vec<Self> {
        let given = &mechanism.model.actions.friction;
        for friction in given {
            Self::check(mechanism, friction, parameters, problems);
        }
        let mut list = Vec::new();
        for (index, (constraint, source)) in mechanism.constraints.iter().enumerate() {
            let Some(rubs) = constraint.rubs() else {
                continue;
            };
            let own = match source {
                Source::Pin { point, .. } => FrictionAt::Pin(*point),
                Source::Joint(joint) => FrictionAt::Joint(*joint),
                Source::Drive(_) => continue,
            };
            let of_own = given.iter().rev().find(|f| f.at == own);
            let Some(friction) =
                of_own.or_else(|| given.iter().rev().find(|f| f.at == FrictionAt::All))
            else {
                continue;
            };
            let radius = match (rubs, &friction.radius) {
                (Rubs::AlongGuide, _) => None,
                (Rubs::AboutPin, Some(radius)) => Some(model::value(radius, parameters)),
                (Rubs::AboutPin, None) => Some(T::zero()),
            };
            list.push(Self {
                constraint: index,
                radius,
                law: FrictionLaw::new(friction, parameters),
            });
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
        if [law.kinetic, law.at_rest, law.viscous]
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
                "friction acts at pins, sliders and slots; gears, racks and welds have none here"
                    .into(),
            ),
            _ => {}
        }
    }

    /// Resistance (N m at a pin, N on a line) to a relative speed (rad/s or m/s) under a load (N), with the sign of
    /// `direction`; what it does is the opposite of its sign. Viscous resistance included.
    #[inline]
    pub fn resistance(&self, speed: T, direction: T::Plain, load: T) -> T {
        (self.per_load(speed) * load).times(direction) + self.law.viscous * speed
    }

    /// Resistance over load. The load of a line is its normal force; that of a pin is its whole force, friction included,
    /// which passes the pin's centre on the friction circle: at `r sin(atan(mu))`.
    pub(crate) fn per_load(&self, speed: T) -> T {
        match self.radius {
            None => self.law.coefficient(speed.abs()),
            Some(radius) => {
                let coefficient = self.law.coefficient(speed.abs() * radius);
                coefficient * radius / (coefficient.square() + 1.0).sqrt()
            }
        }
    }

    /// Derivative of the resistance to the load, in a lane.
    #[inline]
    pub(crate) fn slope(&self, speed: T, direction: T::Plain, lane: usize) -> f64 {
        let speed = T::from_f64(speed.value_in(lane));
        self.per_load(speed).value_in(lane) * direction.lane_value(lane)
    }
}

/// The sense in which a joint slides: that of its speed, or at rest that in which it starts; 0 when it stays at rest.
/// Speeds and accelerations that are no larger than those of `still` count as none.
pub fn direction(speed: f64, acceleration: f64, still: [f64; 2]) -> f64 {
    if speed.abs() > still[0] {
        sign(speed)
    } else if acceleration.abs() > still[1] {
        sign(acceleration)
    } else {
        0.0
    }
}

/// The senses in which joints slide whose speeds and accelerations lie in these bounds: all from -1 to 1 where there are
/// several. What counts as none is told by the size of the middle design: that of the others is taken to be half as large at
/// least, and twice as large at most.
pub(crate) fn directions(
    speed: Interval,
    acceleration: Interval,
    still: [Interval; 2],
) -> Interval {
    let sense = |x: Interval, still: Interval| {
        let (least, most) = (still.lo() / 2.0, still.hi() * 2.0);
        if x.lo() > most || x.hi() < -most {
            Some(sign(x.lo()))
        } else {
            (x.mag() <= least).then_some(0.0)
        }
    };
    let of_speed = sense(speed, still[0]);
    let found = match of_speed {
        Some(0.0) => sense(acceleration, still[1]),
        _ => of_speed,
    };
    found.map_or(Interval::new(-1.0, 1.0), Interval::from_f64)
}

fn slides(mechanism: &Mechanism, joint: JointId) -> bool {
    let mut constraints = mechanism.constraints.iter();
    constraints.any(|(c, source)| *source == Source::Joint(joint) && c.rubs().is_some())
}

fn point_name(mechanism: &Mechanism, point: PointId) -> &str {
    (mechanism.model.points.get(point.index())).map_or("?", |p| p.name.as_str())
}
