//! The `Number` trait: what a formula may do with a number without knowing which kind it is.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// A number a formula can run on: a plain `f64`, or a richer one that carries derivatives, several
/// designs at once, or guaranteed bounds.
///
/// A formula written once over `Number` gives positions with `f64`, time derivatives with
/// [`Jet`](crate::Jet), derivatives to dimensions with [`Dual`](crate::Dual), many designs with
/// [`Lanes`](crate::Lanes) and certified enclosures with [`Interval`](crate::Interval).
///
/// Formulas must not branch on the value of a number (lanes and intervals have no single one); what has to
/// branch is decided beforehand on plain `f64` and passed in as a sign or an index.
pub trait Number:
    Copy
    + Debug
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
{
    /// How many lanes it holds; 0 of numbers without lanes.
    const LANE_COUNT: usize = 0;

    /// Whether it holds lanes, so that its operations have to be compiled into their caller for the caller's vector
    /// instructions.
    const IN_LANES: bool = Self::LANE_COUNT > 0;

    /// Whether formulas of it are compiled into their caller: always for numbers in lanes, and for short ones, whose operations
    /// take no more instructions than a call. Formulas of others are called, which keeps programs small.
    const IN_PLACE: bool = Self::IN_LANES || size_of::<Self>() <= size_of::<[f64; 3]>();

    /// The constant `x`: no derivatives, the same in every lane, a degenerate interval.
    fn from_f64(x: f64) -> Self;

    /// The plain value: the zeroth coefficient, the primal, the first lane, the midpoint.
    fn value(self) -> f64;

    /// Square root. Negative arguments give NaN (an interval is cut to its non-negative part and marked
    /// empty when nothing is left).
    fn sqrt(self) -> Self;

    /// Sine and cosine together, argument in rad.
    fn sin_cos(self) -> (Self, Self);

    /// Angle of the vector (`x`, `self`) in rad, in [-pi, pi].
    fn atan2(self, x: Self) -> Self;

    /// Exponential.
    fn exp(self) -> Self;

    /// Natural logarithm.
    fn ln(self) -> Self;

    /// Absolute value.
    fn abs(self) -> Self;

    /// The smaller of two numbers (lane by lane; derivatives of the smaller one), NaN if either is.
    fn min(self, other: Self) -> Self;

    /// The larger of two numbers, as [`min`](Number::min).
    fn max(self, other: Self) -> Self;

    /// `nonnegative` where the value of `self` is at least zero, `negative` where it is below; undefined (NaN) where
    /// it is NaN. Decides lane by lane; an interval that straddles zero gives the hull of both.
    ///
    /// The branch for formulas that may not branch. Only the value of `self` is looked at, not its derivatives.
    fn choose(self, nonnegative: Self, negative: Self) -> Self;

    /// Whether the value is at least zero in every part (lane, bound), or below zero in every part; `None` where parts
    /// differ or have no sign (NaN).
    fn nonnegative(self) -> Option<bool>;

    /// The value as a constant: derivatives are gone, lanes and bounds stay.
    fn constant_part(self) -> Self;

    /// The largest whole number that is not above the value, a constant.
    fn floor(self) -> Self;

    /// [`choose`](Number::choose) that works out a side only where it is chosen.
    #[inline(always)]
    fn choose_with(
        self,
        nonnegative: impl FnOnce() -> Self,
        negative: impl FnOnce() -> Self,
    ) -> Self {
        match self.nonnegative() {
            Some(true) => nonnegative(),
            Some(false) => negative(),
            None => self.choose(nonnegative(), negative()),
        }
    }

    /// Whether every part of the number (coefficients, lanes, bounds) is finite.
    fn is_finite(self) -> bool;

    /// Zero.
    #[inline(always)]
    fn zero() -> Self {
        Self::from_f64(0.0)
    }

    /// One.
    #[inline(always)]
    fn one() -> Self {
        Self::from_f64(1.0)
    }

    /// The square, at least as tight as `self * self` for intervals.
    #[inline(always)]
    fn square(self) -> Self {
        self * self
    }
}

impl Number for f64 {
    #[inline(always)]
    fn from_f64(x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn value(self) -> f64 {
        self
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        crate::math::sin_cos(self)
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        crate::math::atan2(self, x)
    }
    #[inline(always)]
    fn exp(self) -> Self {
        crate::math::exp(self)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        crate::math::ln(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        crate::math::min(self, other)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        crate::math::max(self, other)
    }
    #[inline(always)]
    fn choose(self, nonnegative: Self, negative: Self) -> Self {
        if self >= 0.0 {
            nonnegative
        } else if self < 0.0 {
            negative
        } else {
            f64::NAN
        }
    }
    #[inline(always)]
    fn nonnegative(self) -> Option<bool> {
        (!self.is_nan()).then_some(self >= 0.0)
    }

    #[inline(always)]
    fn constant_part(self) -> Self {
        self
    }

    #[inline(always)]
    fn floor(self) -> Self {
        f64::floor(self)
    }

    #[inline(always)]
    fn is_finite(self) -> bool {
        f64::is_finite(self)
    }
}
