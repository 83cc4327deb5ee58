//! What is no joint with play, and why.

use std::fmt;

/// Why a law or a joint cannot be made of the values it was given. Lengths in m, speeds in m/s, moduli in Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Unfit {
    /// A coefficient of restitution outside (0, 1].
    Restitution(f64),
    /// A journal that is larger than its bearing, or a block higher than its guide.
    NoRoom {
        /// Radius of the bearing, or half the width of the guide.
        around: f64,
        /// Radius of the journal, or half the height of the block.
        inside: f64,
    },
    /// A journal as large as its bearing where stiffness is to follow from both: the law of Hertz knows no such contact.
    NoClearance(f64),
    /// Something that must be positive and finite and is not.
    NotPositive {
        /// What it is.
        what: &'static str,
        /// Its value, SI.
        value: f64,
    },
    /// Something that must be finite and not negative and is not.
    Negative {
        /// What it is.
        what: &'static str,
        /// Its value, SI.
        value: f64,
    },
    /// Poisson's ratio of no elastic material.
    Poisson(f64),
    /// Speeds of a friction law that do not rise.
    Onset {
        /// Below it there is no friction.
        from: f64,
        /// From it on there is all of it.
        to: f64,
    },
}

impl fmt::Display for Unfit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Restitution(e) => write!(
                f,
                "the coefficient of restitution is {e}; it is the part of the speed that an impact gives back: above 0, at most 1"
            ),
            Self::NoRoom { around, inside } => write!(
                f,
                "{inside} m do not fit into {around} m; the clearance between them must not be negative: make the inner part \
                 smaller or the outer one larger"
            ),
            Self::NoClearance(radius) => write!(
                f,
                "journal and bearing both have a radius of {radius} m; the stiffness of their contact follows from a clearance \
                 above 0: give one, or give the stiffness itself"
            ),
            Self::NotPositive { what, value } => {
                write!(f, "the {what} is {value}; it must be finite and above 0")
            }
            Self::Negative { what, value } => {
                write!(
                    f,
                    "the {what} is {value}; it must be finite and not negative"
                )
            }
            Self::Poisson(ratio) => write!(
                f,
                "Poisson's ratio is {ratio}; that of an elastic material is above -1 and at most 0.5, of steel 0.3"
            ),
            Self::Onset { from, to } => write!(
                f,
                "friction begins at {from} m/s and is whole at {to} m/s; the second speed must be above the first"
            ),
        }
    }
}

impl std::error::Error for Unfit {}

/// The value, if it is positive and finite.
pub(crate) fn positive(what: &'static str, value: f64) -> Result<f64, Unfit> {
    match value > 0.0 && value.is_finite() {
        true => Ok(value),
        false => Err(Unfit::NotPositive { what, value }),
    }
}

/// The value, if it is finite and not negative.
pub(crate) fn not_negative(what: &'static str, value: f64) -> Result<f64, Unfit> {
    match value >= 0.0 && value.is_finite() {
        true => Ok(value),
        false => Err(Unfit::Negative { what, value }),
    }
}
