//! Physical dimensions as exponents.

/// A physical dimension: exponents of length, mass, time and angle, in sixths so that square and cube roots stay exact.
///
/// Angle has a dimension of its own: a bare number is not an angle and an angle is not a number. (Inside
/// trigonometric functions and after `* 1 rad` the two meet.)
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

    /// The dimension with these whole exponents.
    pub const fn new(length: i16, mass: i16, time: i16, angle: i16) -> Self {
        Self { length: 6 * length, mass: 6 * mass, time: 6 * time, angle: 6 * angle }
    }
}
