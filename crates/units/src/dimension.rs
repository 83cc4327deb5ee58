//! Physical dimensions as exponents.

use std::fmt;
use std::ops::{Div, Mul};

/// A physical dimension: exponents of length, mass, time and angle, in sixths so that square and cube roots stay exact.
///
/// Angle has a dimension of its own: a bare number is not an angle and an angle is not a number. (Inside
/// trigonometric functions and after `* 1 rad` the two meet.)
///
/// # Which dimensions fit together
///
/// Mechanics takes the radian for one in some places (`omega^2 * r` is an acceleration) and not in others (an angle
/// is not a number). The rule here, in [`compatible`](Self::compatible), is exact:
///
/// * Where the exponents of **length or mass** are not all zero, the exponent of angle does not count: `rad^2 m/s^2`
///   fits `m/s^2`, `N m/rad` fits `N m`, `N m rad/s` fits `W`.
/// * Elsewhere (numbers, angles, times and their rates) it counts: `rad` does not fit `1`, `rad/s` does not fit `1/s`.
///
/// Products and powers keep every exponent, so `omega * r / r` is an angular speed again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct Dimension {
    /// Exponent of length, in sixths.
    pub length: i16,
    /// Exponent of mass, in sixths.
    pub mass: i16,
    /// Exponent of time, in sixths.
    pub time: i16,
    /// Exponent of angle, in sixths.
    pub angle: i16,
}

impl Dimension {
    /// A plain number.
    pub const NONE: Self = Self::new(0, 0, 0, 0);
    /// Length.
    pub const LENGTH: Self = Self::new(1, 0, 0, 0);
    /// Mass.
    pub const MASS: Self = Self::new(0, 1, 0, 0);
    /// Time.
    pub const TIME: Self = Self::new(0, 0, 1, 0);
    /// Plane angle.
    pub const ANGLE: Self = Self::new(0, 0, 0, 1);
    /// Area.
    pub const AREA: Self = Self::new(2, 0, 0, 0);
    /// Volume.
    pub const VOLUME: Self = Self::new(3, 0, 0, 0);
    /// Curvature, 1/length.
    pub const CURVATURE: Self = Self::new(-1, 0, 0, 0);
    /// Speed.
    pub const SPEED: Self = Self::new(1, 0, -1, 0);
    /// Acceleration.
    pub const ACCELERATION: Self = Self::new(1, 0, -2, 0);
    /// Jerk.
    pub const JERK: Self = Self::new(1, 0, -3, 0);
    /// Angular speed, angle/time.
    pub const ANGULAR_SPEED: Self = Self::new(0, 0, -1, 1);
    /// Angular acceleration.
    pub const ANGULAR_ACCELERATION: Self = Self::new(0, 0, -2, 1);
    /// Angular jerk.
    pub const ANGULAR_JERK: Self = Self::new(0, 0, -3, 1);
    /// Frequency, 1/time.
    pub const FREQUENCY: Self = Self::new(0, 0, -1, 0);
    /// Force.
    pub const FORCE: Self = Self::new(1, 1, -2, 0);
    /// Torque; energy and work have the same exponents.
    pub const TORQUE: Self = Self::new(2, 1, -2, 0);
    /// Energy: the same dimension as [`TORQUE`](Self::TORQUE).
    pub const ENERGY: Self = Self::TORQUE;
    /// Power.
    pub const POWER: Self = Self::new(2, 1, -3, 0);
    /// Pressure.
    pub const PRESSURE: Self = Self::new(-1, 1, -2, 0);
    /// Moment of inertia.
    pub const INERTIA: Self = Self::new(2, 1, 0, 0);
    /// Stiffness of a spring, force/length.
    pub const STIFFNESS: Self = Self::new(0, 1, -2, 0);
    /// Stiffness of a torsion spring, torque/angle.
    pub const TORSIONAL_STIFFNESS: Self = Self::new(2, 1, -2, -1);
    /// Coefficient of a damper, force/speed.
    pub const DAMPING: Self = Self::new(0, 1, -1, 0);
    /// Coefficient of a torsion damper, torque/angular speed.
    pub const TORSIONAL_DAMPING: Self = Self::new(2, 1, -1, -1);
    /// Momentum.
    pub const MOMENTUM: Self = Self::new(1, 1, -1, 0);
    /// Angular momentum; a coefficient of a torsion damper where radians count for nothing.
    pub const ANGULAR_MOMENTUM: Self = Self::new(2, 1, -1, 0);
    /// Flow, volume/time.
    pub const FLOW: Self = Self::new(3, 0, -1, 0);
    /// Mass per length.
    pub const LINEAR_DENSITY: Self = Self::new(-1, 1, 0, 0);
    /// Density.
    pub const DENSITY: Self = Self::new(-3, 1, 0, 0);

    /// The dimension with these whole exponents.
    pub const fn new(length: i16, mass: i16, time: i16, angle: i16) -> Self {
        Self {
            length: 6 * length,
            mass: 6 * mass,
            time: 6 * time,
            angle: 6 * angle,
        }
    }

    /// Whether this is a plain number.
    pub const fn is_number(self) -> bool {
        self.length == 0 && self.mass == 0 && self.time == 0 && self.angle == 0
    }

    /// Whether two quantities may be added or compared: the rule is told at [`Dimension`].
    pub fn compatible(self, other: Self) -> bool {
        self.without_idle_angle() == other.without_idle_angle()
    }

    /// The dimension with the exponent of angle dropped where it does not count: compatible dimensions, and only
    /// those, become equal.
    #[must_use]
    pub fn without_idle_angle(self) -> Self {
        if self.length != 0 || self.mass != 0 {
            Self { angle: 0, ..self }
        } else {
            self
        }
    }

    /// The dimension of a sum of compatible quantities: theirs where they agree, else without the angle.
    pub(crate) fn common(self, other: Self) -> Self {
        if self == other {
            self
        } else {
            self.without_idle_angle()
        }
    }

    /// The dimension of the `n`th power; `None` where an exponent grows out of range.
    pub fn powi(self, n: i32) -> Option<Self> {
        self.pow(n, 1)
    }

    /// The dimension of the power `numerator/denominator`; `None` where an exponent is not a multiple of one sixth,
    /// grows out of range, or the denominator is zero.
    pub fn pow(self, numerator: i32, denominator: i32) -> Option<Self> {
        let one = |exponent: i16| {
            let product = i64::from(exponent) * i64::from(numerator);
            let exact = product.checked_rem(i64::from(denominator))? == 0;
            exact
                .then(|| i16::try_from(product / i64::from(denominator)).ok())
                .flatten()
        };
        Some(Self {
            length: one(self.length)?,
            mass: one(self.mass)?,
            time: one(self.time)?,
            angle: one(self.angle)?,
        })
    }

    /// The dimension of the square root; `None` where an exponent is not a multiple of one sixth.
    pub fn sqrt(self) -> Option<Self> {
        self.pow(1, 2)
    }

    /// The name with its article, for a sentence: "a length", "an angle", "a quantity of length^2/time^2".
    pub fn with_article(self) -> String {
        match self.name() {
            Some(name) if name.starts_with(['a', 'e', 'i', 'o', 'u']) => format!("an {name}"),
            Some(name) => format!("a {name}"),
            None => format!("a quantity of {self}"),
        }
    }

    /// The word people use for the dimension, if there is one.
    fn name(self) -> Option<&'static str> {
        let exact = |d: Self| {
            NAMES
                .iter()
                .find(|(named, _)| *named == d)
                .map(|(_, name)| *name)
        };
        exact(self).or_else(|| exact(self.without_idle_angle()))
    }
}

/// Dimensions with a word of their own.
const NAMES: &[(Dimension, &str)] = &[
    (Dimension::NONE, "number"),
    (Dimension::LENGTH, "length"),
    (Dimension::MASS, "mass"),
    (Dimension::TIME, "time"),
    (Dimension::ANGLE, "angle"),
    (Dimension::AREA, "area"),
    (Dimension::VOLUME, "volume"),
    (Dimension::CURVATURE, "curvature"),
    (Dimension::SPEED, "speed"),
    (Dimension::ACCELERATION, "acceleration"),
    (Dimension::JERK, "jerk"),
    (Dimension::ANGULAR_SPEED, "angular speed"),
    (Dimension::ANGULAR_ACCELERATION, "angular acceleration"),
    (Dimension::ANGULAR_JERK, "angular jerk"),
    (Dimension::FREQUENCY, "frequency"),
    (Dimension::FORCE, "force"),
    (Dimension::TORQUE, "torque"),
    (Dimension::POWER, "power"),
    (Dimension::PRESSURE, "pressure"),
    (Dimension::INERTIA, "moment of inertia"),
    (Dimension::STIFFNESS, "stiffness"),
    (Dimension::TORSIONAL_STIFFNESS, "torsional stiffness"),
    (Dimension::DAMPING, "damping coefficient"),
    (
        Dimension::TORSIONAL_DAMPING,
        "torsional damping coefficient",
    ),
    (Dimension::MOMENTUM, "momentum"),
    (Dimension::FLOW, "flow"),
    (Dimension::DENSITY, "density"),
];

/// Exponents add, and stop at the ends of their range (about ±5400), where no physical quantity comes.
impl Mul for Dimension {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self {
            length: self.length.saturating_add(other.length),
            mass: self.mass.saturating_add(other.mass),
            time: self.time.saturating_add(other.time),
            angle: self.angle.saturating_add(other.angle),
        }
    }
}

/// Exponents subtract, and stop at the ends of their range.
impl Div for Dimension {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        Self {
            length: self.length.saturating_sub(other.length),
            mass: self.mass.saturating_sub(other.mass),
            time: self.time.saturating_sub(other.time),
            angle: self.angle.saturating_sub(other.angle),
        }
    }
}

/// The word people use ("angular speed"), else the product ("length^2/time^2").
impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(name) = self.name() {
            return f.pad(name);
        }
        let parts = [
            ("mass", self.mass),
            ("length", self.length),
            ("angle", self.angle),
            ("time", self.time),
        ];
        let mut out = String::new();
        for (base, exponent) in parts.into_iter().filter(|(_, e)| *e > 0) {
            if !out.is_empty() {
                out.push('*');
            }
            push_power(&mut out, base, exponent.unsigned_abs());
        }
        if out.is_empty() {
            out.push('1');
        }
        for (base, exponent) in parts.into_iter().filter(|(_, e)| *e < 0) {
            out.push('/');
            push_power(&mut out, base, exponent.unsigned_abs());
        }
        f.pad(&out)
    }
}

/// Writes `base^exponent`, the exponent given in sixths.
fn push_power(out: &mut String, base: &str, sixths: u16) {
    out.push_str(base);
    match (
        sixths,
        [6, 3, 2, 1]
            .into_iter()
            .find(|d| sixths.is_multiple_of(*d))
            .unwrap_or(1),
    ) {
        (6, _) => {}
        (_, 6) => out.push_str(&format!("^{}", sixths / 6)),
        (_, divisor) => out.push_str(&format!("^({}/{})", sixths / divisor, 6 / divisor)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words() {
        for (dimension, word) in [
            (Dimension::NONE, "number"),
            (Dimension::LENGTH, "length"),
            (Dimension::ANGLE, "angle"),
            (Dimension::SPEED, "speed"),
            (Dimension::FORCE, "force"),
            (Dimension::TORQUE, "torque"),
            (Dimension::ACCELERATION, "acceleration"),
            (Dimension::ANGULAR_SPEED, "angular speed"),
            (
                Dimension::ACCELERATION * Dimension::ANGLE * Dimension::ANGLE,
                "acceleration",
            ),
            (Dimension::new(2, 0, -2, 0), "length^2/time^2"),
            (Dimension::new(0, 0, -4, 0), "1/time^4"),
            (Dimension::new(2, 1, 1, 0), "mass*length^2*time"),
            (
                Dimension {
                    length: 3,
                    ..Dimension::NONE
                },
                "length^(1/2)",
            ),
            (
                Dimension {
                    length: 4,
                    ..Dimension::NONE
                },
                "length^(2/3)",
            ),
            (
                Dimension {
                    length: -1,
                    ..Dimension::NONE
                },
                "1/length^(1/6)",
            ),
        ] {
            assert_eq!(dimension.to_string(), word);
        }
        assert_eq!(Dimension::ANGLE.with_article(), "an angle");
        assert_eq!(Dimension::LENGTH.with_article(), "a length");
        assert_eq!(
            Dimension::new(2, 0, -2, 0).with_article(),
            "a quantity of length^2/time^2"
        );
    }

    #[test]
    fn the_radian_counts_as_one_beside_length_or_mass_only() {
        let omega = Dimension::ANGULAR_SPEED;
        assert!((omega * omega * Dimension::LENGTH).compatible(Dimension::ACCELERATION));
        assert!((Dimension::TORQUE * omega).compatible(Dimension::POWER));
        assert!((Dimension::TORSIONAL_STIFFNESS * Dimension::ANGLE).compatible(Dimension::TORQUE));
        assert!(
            (Dimension::INERTIA * Dimension::ANGULAR_ACCELERATION).compatible(Dimension::TORQUE)
        );
        assert!((Dimension::MASS * omega).compatible(Dimension::DAMPING));
        assert!(!Dimension::ANGLE.compatible(Dimension::NONE));
        assert!(!Dimension::ANGLE.compatible(Dimension::LENGTH));
        assert!(!omega.compatible(Dimension::FREQUENCY));
        assert!(!(omega * omega).compatible(Dimension::ANGULAR_ACCELERATION));
        assert_eq!(omega * Dimension::LENGTH / Dimension::LENGTH, omega);
    }

    #[test]
    fn powers() {
        assert_eq!(Dimension::LENGTH.powi(2), Some(Dimension::AREA));
        assert_eq!(Dimension::AREA.sqrt(), Some(Dimension::LENGTH));
        assert_eq!(Dimension::VOLUME.pow(1, 3), Some(Dimension::LENGTH));
        assert_eq!(Dimension::LENGTH.pow(1, 4), None);
        assert_eq!(Dimension::LENGTH.pow(1, 0), None);
        assert_eq!(Dimension::LENGTH.powi(i32::MAX), None);
        assert_eq!(Dimension::NONE.powi(i32::MAX), Some(Dimension::NONE));
        let huge = Dimension::new(5000, 0, 0, 0);
        assert_eq!((huge * huge).length, i16::MAX);
    }
}
