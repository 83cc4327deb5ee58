//! Forces with which bodies press on each other.

use kempe_number::Number;

use crate::unfit::{not_negative, positive};
use crate::{Dissipation, Unfit, factor};

/// The exponent of the law of Hertz.
const HERTZ: f64 = 1.5;

/// What a normal force depends on besides the indentation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Damping<T> {
    /// Nothing: the law of Hertz.
    None,
    /// The speed over that of the approach: `F = K d^n (1 + chi d' / v0)`, with this factor chi.
    Factor(T),
    /// The speed: `F = K d^n + D d'`, with this D (N s/m). The force jumps at the first touch (Kelvin and Voigt).
    Viscous(T),
}

/// A law of the force over indentation d (m) and its rate d' (m/s). It never pulls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Normal<T> {
    /// K, N/m^n.
    pub stiffness: T,
    /// n.
    pub exponent: f64,
    /// What dissipates.
    pub damping: Damping<T>,
}

impl Normal<f64> {
    /// The law of Hertz, which loses nothing.
    ///
    /// # Errors
    ///
    /// Where the stiffness (N/m^1.5) is not positive.
    pub fn hertz(stiffness: f64) -> Result<Self, Unfit> {
        Ok(Self {
            stiffness: positive("stiffness of the contact", stiffness)?,
            exponent: HERTZ,
            damping: Damping::None,
        })
    }

    /// A law on that of Hertz that shall deliver a restitution.
    ///
    /// # Errors
    ///
    /// Where the stiffness (N/m^1.5) is not positive or the restitution not above 0 and at most 1.
    pub fn dissipating(
        stiffness: f64,
        restitution: f64,
        dissipation: Dissipation,
    ) -> Result<Self, Unfit> {
        Ok(Self {
            damping: Damping::Factor(factor(dissipation, restitution)?),
            ..Self::hertz(stiffness)?
        })
    }

    /// A spring (N/m) and a damper (N s/m).
    ///
    /// # Errors
    ///
    /// Where the stiffness is not positive or the damping negative.
    pub fn kelvin_voigt(stiffness: f64, damping: f64) -> Result<Self, Unfit> {
        Ok(Self {
            stiffness: positive("stiffness of the contact", stiffness)?,
            exponent: 1.0,
            damping: Damping::Viscous(not_negative("damping of the contact", damping)?),
        })
    }

    /// The same law in other numbers.
    pub fn lift<T: Number>(&self) -> Normal<T> {
        Normal {
            stiffness: T::from_f64(self.stiffness),
            exponent: self.exponent,
            damping: match self.damping {
                Damping::None => Damping::None,
                Damping::Factor(chi) => Damping::Factor(T::from_f64(chi)),
                Damping::Viscous(damping) => Damping::Viscous(T::from_f64(damping)),
            },
        }
    }
}

impl<T: Number> Normal<T> {
    /// The force (N) at an indentation (m), its rate (m/s) and the speed with which this contact began (m/s). Zero where nothing is
    /// indented and where it would pull. What began without speed loses none: a law that divides by it says nothing there.
    pub fn force(&self, indentation: T, rate: T, approach: T) -> T {
        let pressed = || {
            let elastic = self.elastic(indentation);
            let force = match self.damping {
                Damping::None => elastic,
                Damping::Factor(chi) => {
                    let losing = || elastic * (chi * rate / approach + 1.0);
                    (-approach).choose_with(|| elastic, losing)
                }
                Damping::Viscous(damping) => elastic + damping * rate,
            };
            force.max(T::zero())
        };
        (-indentation).choose_with(T::zero, pressed)
    }

    /// K d^n of a positive indentation.
    fn elastic(&self, indentation: T) -> T {
        let power = if self.exponent == HERTZ {
            indentation * indentation.sqrt()
        } else if self.exponent == 1.0 {
            indentation
        } else {
            (indentation.ln() * self.exponent).exp()
        };
        self.stiffness * power
    }
}
