//! Forces that resist sliding in proportion to the normal force.

use kempe_number::Number;

use crate::Unfit;

/// How friction sets in around rest. Coulomb's jumps there; the others are continuous, so that a body that should stick
/// creeps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Onset<T> {
    /// At once: the sign of the speed, nothing at rest (Coulomb).
    Sign,
    /// From one speed (m/s) to another in proportion to it (J. A. C. Ambrósio, 2003).
    Ramp {
        /// Below it there is none.
        from: T,
        /// From it on there is all.
        to: T,
    },
    /// `(1 - exp(-3 |v| / v0)) / (1 - exp(-3))` up to the speed v0 (m/s), where the divisor makes it whole
    /// (A. G. Threlfall, 1978, who rounds it to 0.95).
    Exponential(T),
    /// `tanh(v / v0)`, for this v0 (m/s).
    Tanh(T),
}

/// A friction law: force over sliding speed and normal force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction<T> {
    /// Kinetic coefficient.
    pub kinetic: T,
    /// Coefficient near rest, from which it falls to the kinetic one.
    pub at_rest: T,
    /// Speed at which it has fallen to the e-th part of the way, m/s.
    pub stribeck_speed: Option<T>,
    /// Viscous part, N s/m, whatever the normal force as long as there is one.
    pub viscous: T,
    /// How it sets in.
    pub onset: Onset<T>,
}

impl<T: Number> Friction<T> {
    /// None.
    pub fn none() -> Self {
        Self::coulomb(T::zero())
    }

    /// One coefficient, at once.
    pub fn coulomb(coefficient: T) -> Self {
        Self {
            kinetic: coefficient,
            at_rest: coefficient,
            stribeck_speed: None,
            viscous: T::zero(),
            onset: Onset::Sign,
        }
    }

    /// One coefficient, from a speed to another (m/s).
    pub fn ambrosio(coefficient: T, from: T, to: T) -> Self {
        Self::coulomb(coefficient).with(Onset::Ramp { from, to })
    }

    /// One coefficient, up to a speed (m/s).
    pub fn threlfall(coefficient: T, speed: T) -> Self {
        Self::coulomb(coefficient).with(Onset::Exponential(speed))
    }

    /// One coefficient, around a speed (m/s).
    pub fn tanh(coefficient: T, speed: T) -> Self {
        Self::coulomb(coefficient).with(Onset::Tanh(speed))
    }

    /// A coefficient that falls from that at rest to the kinetic one, at once, and a viscous part (N s/m).
    pub fn stribeck(kinetic: T, at_rest: T, speed: T, viscous: T) -> Self {
        Self {
            at_rest,
            stribeck_speed: Some(speed),
            viscous,
            ..Self::coulomb(kinetic)
        }
    }

    /// The same law with another onset.
    pub fn with(self, onset: Onset<T>) -> Self {
        Self { onset, ..self }
    }

    /// The law, if it is one.
    ///
    /// # Errors
    ///
    /// Where a coefficient, speed or viscous part is negative, or the speeds of its onset do not rise.
    pub fn checked(self) -> Result<Self, Unfit> {
        let not_negative = |what, value: T| crate::unfit::not_negative(what, value.value());
        let positive = |what, value: T| crate::unfit::positive(what, value.value());
        not_negative("coefficient of friction", self.kinetic)?;
        not_negative("coefficient of friction at rest", self.at_rest)?;
        not_negative("viscous friction", self.viscous)?;
        if let Some(speed) = self.stribeck_speed {
            not_negative("speed of the falling friction", speed)?;
        }
        match self.onset {
            Onset::Sign => {}
            Onset::Exponential(speed) | Onset::Tanh(speed) => {
                positive("speed at which friction sets in", speed)?;
            }
            Onset::Ramp { from, to } => {
                not_negative("speed at which friction sets in", from)?;
                if !(to.value() > from.value()) {
                    let (from, to) = (from.value(), to.value());
                    return Err(Unfit::Onset { from, to });
                }
            }
        }
        Ok(self)
    }

    /// The force (N) along the sliding speed (m/s), against it, under a normal force (N). None where nothing presses.
    pub fn force(&self, slip: T, normal: T) -> T {
        let coefficient = match self.stribeck_speed {
            Some(speed) => falling_coefficient(self.kinetic, self.at_rest, speed, slip),
            None => self.kinetic,
        };
        let force = -(coefficient * normal * self.onset.at(slip)) - self.viscous * slip;
        (-normal).choose(T::zero(), force)
    }
}

impl Friction<f64> {
    /// The same law in other numbers.
    pub fn lift<T: Number>(&self) -> Friction<T> {
        Friction {
            kinetic: T::from_f64(self.kinetic),
            at_rest: T::from_f64(self.at_rest),
            stribeck_speed: self.stribeck_speed.map(T::from_f64),
            viscous: T::from_f64(self.viscous),
            onset: match self.onset {
                Onset::Sign => Onset::Sign,
                Onset::Ramp { from, to } => Onset::Ramp {
                    from: T::from_f64(from),
                    to: T::from_f64(to),
                },
                Onset::Exponential(speed) => Onset::Exponential(T::from_f64(speed)),
                Onset::Tanh(speed) => Onset::Tanh(T::from_f64(speed)),
            },
        }
    }
}

impl<T: Number> Onset<T> {
    /// The part of the friction that is there at a speed, with its sign.
    pub fn at(&self, slip: T) -> T {
        let one = T::one();
        let signed = |size: T| slip.choose(size, -size);
        match *self {
            // Nothing at rest, where both are one.
            Self::Sign => (slip.choose(one, -one) - (-slip).choose(one, -one)) * 0.5,
            Self::Ramp { from, to } => {
                let part = (slip.abs() - from) / (to - from);
                signed(part.max(T::zero()).min(one))
            }
            Self::Exponential(speed) => {
                let whole = -(T::from_f64(-3.0).exp()) + 1.0;
                let part = (slip.abs() / speed).min(one);
                signed((-(part * -3.0).exp() + 1.0) / whole)
            }
            Self::Tanh(speed) => {
                let fallen = (slip.abs() / speed * -2.0).exp();
                signed((-fallen + 1.0) / (fallen + 1.0))
            }
        }
    }
}

/// A coefficient of friction that falls with the sliding speed: `k + (s - k) exp(-(v / v_s)^2)`, k where v_s is zero.
pub fn falling_coefficient<T: Number>(kinetic: T, at_rest: T, scale: T, speed: T) -> T {
    let falling = || {
        let part = (-(speed / scale).square()).exp();
        kinetic + (at_rest - kinetic) * part
    };
    (-scale).choose_with(|| kinetic, falling)
}
