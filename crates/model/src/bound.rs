//! What a value of the file must keep to.

use kempe_units::Dimension;

use crate::ids::{Scalar, Span};

/// A value of the file that depends on parameters, and what it must keep to.
#[derive(Clone, Debug, PartialEq)]
pub struct Bound {
    /// The value.
    pub value: Scalar,
    /// What it must keep to.
    pub keeps: Keeps,
    /// What it is, in words.
    pub what: String,
    /// Its dimension.
    pub dimension: Dimension,
    /// Where it stands in the file.
    pub span: Span,
}

/// What a value must keep to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keeps {
    /// It is a number.
    Finite,
    /// It is above zero.
    Positive,
    /// It is not below zero.
    NotNegative,
    /// It is not zero.
    NotZero,
    /// It is not above one.
    AtMostOne,
    /// It is below 45 degrees.
    PressureAngle,
    /// It is less than a whole turn either way.
    WithinATurn,
}

/// Pressure angles are smaller, rad: the base circles of steeper teeth leave no room for them.
pub(crate) const STEEPEST: f64 = std::f64::consts::FRAC_PI_4;

/// Values in SI are at most so large: products of a few and their squares are still numbers.
const LARGEST: f64 = 1e30;

/// Lengths and times, m and s, are at least so large: quotients by them are still numbers.
const SHORTEST: f64 = 1e-30;

/// Other values in SI are at least so large, for their squares; moments of inertia go with the fifth power of a length.
const SMALLEST: f64 = 1e-60;

/// How a value in SI lies beyond what can be computed with; `None` for one that does not, and for zero.
pub(crate) fn beyond(x: f64, dimension: Dimension) -> Option<&'static str> {
    let least = match dimension {
        Dimension::LENGTH | Dimension::TIME => SHORTEST,
        _ => SMALLEST,
    };
    match x.abs() {
        size if size > LARGEST => Some("too large"),
        size if size > 0.0 && size < least => Some("too small"),
        _ => None,
    }
}

/// What to do about a value that lies beyond.
pub(crate) fn remedy(dimension: Dimension) -> String {
    let least = match dimension {
        Dimension::LENGTH | Dimension::TIME => SHORTEST,
        _ => SMALLEST,
    };
    format!(
        "in SI units a value is 0, or from {least:e} to {LARGEST:e}: is the exponent right, and the unit?"
    )
}
