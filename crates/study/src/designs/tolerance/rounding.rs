//! What of a number is nothing but rounding.

use kempe_units::Dimension;

/// What is less than this part of a number, or of the lengths and angles that it is the difference of, is rounding.
pub(super) const ROUNDING: f64 = 1e-12;

/// What a number is made of as far as that is known: the mechanism's size of a length, one of an angle.
pub(super) fn scale_of(dimension: Dimension, size: f64) -> f64 {
    match dimension {
        Dimension::LENGTH => size,
        Dimension::ANGLE => 1.0,
        _ => 0.0,
    }
}
