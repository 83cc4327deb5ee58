//! Intervals with outward rounding: bounds that hold in spite of rounding errors.

use std::f64::consts::{FRAC_2_PI, PI};
use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::operators::assigning_operators;
use crate::{Number, math};

/// All real numbers from `lo` to `hi`, both included; infinite bounds mean unbounded.
///
/// Whatever real numbers are taken from the arguments of an operation, the exact result lies in the interval it
/// returns. `+ - * /` and the square root are rounded outward by one unit in the last place, elementary functions
/// by two. An operation that is defined on only part of its argument (square root, logarithm) is cut to that part.
///
/// An empty or undefined interval has NaN bounds. It spreads through every operation, and contains nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    lo: f64,
    hi: f64,
}

/// Beyond this |x| in rad the position of `x` within its turn is not worth knowing: sine and cosine of a wide or
/// narrow interval are then [-1, 1]. At 2^40 a unit in the last place is 2^-12 of a quarter turn.
const TURN_LIMIT: f64 = 1_099_511_627_776.0;

/// Two units in the last place down.
#[inline(always)]
fn down2(x: f64) -> f64 {
    x.next_down().next_down()
}

/// Two units in the last place up.
#[inline(always)]
fn up2(x: f64) -> f64 {
    x.next_up().next_up()
}

/// The smaller of two numbers that are not NaN: one instruction.
#[inline(always)]
fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The larger of two numbers that are not NaN.
#[inline(always)]
fn greater(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The product of two bounds; zero times an unbounded bound is zero, because the bound is never reached.
#[inline(always)]
fn corner_product(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

/// The quotient of two bounds; anything over an unbounded bound is zero.
#[inline(always)]
fn corner_quotient(a: f64, b: f64) -> f64 {
    if b.is_infinite() { 0.0 } else { a / b }
}

impl Interval {
    /// The empty or undefined interval.
    pub const EMPTY: Self = Self {
        lo: f64::NAN,
        hi: f64::NAN,
    };

    /// The whole real line.
    pub const WHOLE: Self = Self {
        lo: f64::NEG_INFINITY,
        hi: f64::INFINITY,
    };

    /// From `lo` to `hi`; empty when `lo > hi` or either is NaN.
    ///
    /// A lower bound of +inf becomes the largest finite number, and likewise below: infinity is not in an interval.
    #[inline]
    pub fn new(lo: f64, hi: f64) -> Self {
        if lo <= hi {
            Self {
                lo: lo.min(f64::MAX),
                hi: hi.max(f64::MIN),
            }
        } else {
            Self::EMPTY
        }
    }

    /// The numbers within `radius` of `centre`, bounds rounded outward.
    #[inline]
    pub fn around(centre: f64, radius: f64) -> Self {
        Self::new((centre - radius).next_down(), (centre + radius).next_up())
    }

    /// Lower bound, NaN when empty.
    #[inline(always)]
    pub const fn lo(self) -> f64 {
        self.lo
    }

    /// Upper bound, NaN when empty.
    #[inline(always)]
    pub const fn hi(self) -> f64 {
        self.hi
    }

    /// Whether the interval is empty or undefined.
    #[inline(always)]
    pub const fn is_empty(self) -> bool {
        self.lo.is_nan() || self.hi.is_nan()
    }

    /// Whether `x` lies in the interval.
    #[inline(always)]
    pub fn contains(self, x: f64) -> bool {
        self.lo <= x && x <= self.hi
    }

    /// Whether zero lies in the interval.
    #[inline(always)]
    pub fn contains_zero(self) -> bool {
        self.contains(0.0)
    }

    /// Whether this interval lies in `outer`, common bounds allowed; false when either is empty.
    #[inline(always)]
    pub fn is_inside(self, outer: Self) -> bool {
        outer.lo <= self.lo && self.hi <= outer.hi
    }

    /// Whether this interval lies in the interior of `outer`: strictly between its bounds; false when either is
    /// empty. The condition of the interval Newton and Krawczyk tests.
    #[inline(always)]
    pub fn is_inside_interior(self, outer: Self) -> bool {
        outer.lo < self.lo && self.hi < outer.hi
    }

    /// The common part, empty when there is none.
    #[inline]
    pub fn intersect(self, other: Self) -> Self {
        let (lo, hi) = (math::max(self.lo, other.lo), math::min(self.hi, other.hi));
        if lo <= hi {
            Self { lo, hi }
        } else {
            Self::EMPTY
        }
    }

    /// The smallest interval that holds both. Undefined when either is: undefined must not disappear.
    #[inline]
    pub fn hull(self, other: Self) -> Self {
        Self {
            lo: math::min(self.lo, other.lo),
            hi: math::max(self.hi, other.hi),
        }
    }

    /// `hi - lo`, rounded up; NaN when empty.
    #[inline]
    pub fn width(self) -> f64 {
        if self.lo == self.hi {
            0.0
        } else {
            (self.hi - self.lo).next_up()
        }
    }

    /// A number near the middle, always in the interval and finite; NaN when empty.
    #[inline]
    pub fn midpoint(self) -> f64 {
        if self == Self::WHOLE {
            return 0.0;
        }
        let middle = 0.5 * self.lo + 0.5 * self.hi;
        math::min(
            math::max(middle, math::max(self.lo, f64::MIN)),
            math::min(self.hi, f64::MAX),
        )
    }

    /// Magnitude: the largest |x| in the interval.
    #[inline(always)]
    pub fn mag(self) -> f64 {
        math::max(self.lo.abs(), self.hi.abs())
    }

    /// Mignitude: the smallest |x| in the interval.
    #[inline(always)]
    pub fn mig(self) -> f64 {
        if self.contains_zero() {
            0.0
        } else {
            math::min(self.lo.abs(), self.hi.abs())
        }
    }

    /// The two halves at the midpoint, which both contain.
    #[inline]
    pub fn bisect(self) -> (Self, Self) {
        let middle = self.midpoint();
        (Self { hi: middle, ..self }, Self { lo: middle, ..self })
    }

    /// Whether some x in the interval, counted in quarter turns from `lo` to `hi`, is `residue` mod 4.
    #[inline(always)]
    fn meets_quarter(lo: f64, hi: f64, residue: f64) -> bool {
        residue + 4.0 * ((lo - residue) * 0.25).ceil() <= hi
    }

    /// Rounds computed bounds outward by one unit, keeping a sign that is certain.
    #[inline(always)]
    fn outward(lo: f64, hi: f64, nonnegative: bool, nonpositive: bool) -> Self {
        let (lo, hi) = (lo.next_down(), hi.next_up());
        Self {
            lo: if nonnegative { math::max(lo, 0.0) } else { lo },
            hi: if nonpositive { math::min(hi, 0.0) } else { hi },
        }
    }

    /// Bounds of a product or quotient from its four corner values.
    #[inline(always)]
    fn from_corners(left: Self, right: Self, [a, b, c, d]: [f64; 4]) -> Self {
        let lo = lesser(lesser(a, b), lesser(c, d));
        let hi = greater(greater(a, b), greater(c, d));
        let (rise, fall) = (left.nonnegative(), left.nonpositive());
        let same = rise && right.nonnegative() || fall && right.nonpositive();
        let opposite = rise && right.nonpositive() || fall && right.nonnegative();
        Self::outward(lo, hi, same, opposite)
    }

    /// Whether all numbers are >= 0.
    #[inline(always)]
    fn nonnegative(self) -> bool {
        self.lo >= 0.0
    }

    /// Whether all numbers are <= 0.
    #[inline(always)]
    fn nonpositive(self) -> bool {
        self.hi <= 0.0
    }
}

impl Add for Interval {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let nonnegative = self.nonnegative() && other.nonnegative();
        let nonpositive = self.nonpositive() && other.nonpositive();
        Self::outward(
            self.lo + other.lo,
            self.hi + other.hi,
            nonnegative,
            nonpositive,
        )
    }
}

impl Sub for Interval {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + (-other)
    }
}

impl Mul for Interval {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        if self.is_empty() || other.is_empty() {
            return Self::EMPTY;
        }
        let (a, b) = (
            corner_product(self.lo, other.lo),
            corner_product(self.lo, other.hi),
        );
        let (c, d) = (
            corner_product(self.hi, other.lo),
            corner_product(self.hi, other.hi),
        );
        Self::from_corners(self, other, [a, b, c, d])
    }
}

impl Div for Interval {
    type Output = Self;
    /// The whole line when `other` contains zero.
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        if self.is_empty() || other.is_empty() {
            return Self::EMPTY;
        }
        if other.contains_zero() {
            return Self::WHOLE;
        }
        let (a, b) = (
            corner_quotient(self.lo, other.lo),
            corner_quotient(self.lo, other.hi),
        );
        let (c, d) = (
            corner_quotient(self.hi, other.lo),
            corner_quotient(self.hi, other.hi),
        );
        Self::from_corners(self, other, [a, b, c, d])
    }
}

impl Neg for Interval {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self {
            lo: -self.hi,
            hi: -self.lo,
        }
    }
}

impl Add<f64> for Interval {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: f64) -> Self {
        self + Self::from_f64(other)
    }
}

impl Mul<f64> for Interval {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        self * Self::from_f64(other)
    }
}

impl Div<f64> for Interval {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: f64) -> Self {
        self / Self::from_f64(other)
    }
}

assigning_operators!([] Interval);

impl Number for Interval {
    /// The degenerate interval [x, x]; empty for NaN, beyond the largest finite number for an infinity.
    #[inline(always)]
    fn from_f64(x: f64) -> Self {
        Self::new(x, x)
    }

    /// The midpoint.
    #[inline(always)]
    fn value(self) -> f64 {
        self.midpoint()
    }

    #[inline]
    fn sqrt(self) -> Self {
        if self.hi >= 0.0 {
            Self::outward(math::max(self.lo, 0.0).sqrt(), self.hi.sqrt(), true, false)
        } else {
            Self::EMPTY
        }
    }

    /// Counts the bounds in quarter turns, outward, to see which extrema the interval meets; the rest is monotonic.
    fn sin_cos(self) -> (Self, Self) {
        let full = Self { lo: -1.0, hi: 1.0 };
        if self.is_empty() {
            return (Self::EMPTY, Self::EMPTY);
        }
        if self.mag() > TURN_LIMIT {
            return (full, full);
        }
        // 2/pi and the product are each rounded once: together within two units, three for safety.
        let lo = down2(self.lo * FRAC_2_PI).next_down();
        let hi = up2(self.hi * FRAC_2_PI).next_up();
        let ((sin_a, cos_a), (sin_b, cos_b)) = (math::sin_cos(self.lo), math::sin_cos(self.hi));
        let bounded = |a: f64, b: f64, top: f64, bottom: f64| Self {
            lo: if Self::meets_quarter(lo, hi, bottom) {
                -1.0
            } else {
                down2(a.min(b)).max(-1.0)
            },
            hi: if Self::meets_quarter(lo, hi, top) {
                1.0
            } else {
                up2(a.max(b)).min(1.0)
            },
        };
        (
            bounded(sin_a, sin_b, 1.0, 3.0),
            bounded(cos_a, cos_b, 0.0, 2.0),
        )
    }

    /// [-pi, pi] when the box meets the branch cut (the negative x axis and the origin).
    ///
    /// Elsewhere the angle is monotonic along every edge and two corners give the bounds.
    fn atan2(self, x: Self) -> Self {
        let y = self;
        if y.is_empty() || x.is_empty() {
            return Self::EMPTY;
        }
        let pi = PI.next_up();
        if y.contains_zero() && x.lo <= 0.0 {
            return Self { lo: -pi, hi: pi };
        }
        let (lo, hi) = if y.lo >= 0.0 {
            let right = math::atan2(if x.hi > 0.0 { y.lo } else { y.hi }, x.hi);
            let left = math::atan2(if x.lo > 0.0 { y.hi } else { y.lo }, x.lo);
            (right, left)
        } else if y.hi <= 0.0 {
            let left = math::atan2(if x.lo > 0.0 { y.lo } else { y.hi }, x.lo);
            let right = math::atan2(if x.hi > 0.0 { y.hi } else { y.lo }, x.hi);
            (left, right)
        } else {
            (math::atan2(y.lo, x.lo), math::atan2(y.hi, x.lo))
        };
        Self {
            lo: down2(lo).max(-pi),
            hi: up2(hi).min(pi),
        }
    }

    #[inline]
    fn exp(self) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        Self {
            lo: down2(math::exp(self.lo)).max(0.0),
            hi: up2(math::exp(self.hi)),
        }
    }

    #[inline]
    fn ln(self) -> Self {
        if self.hi > 0.0 {
            Self {
                lo: down2(math::ln(math::max(self.lo, 0.0))),
                hi: up2(math::ln(self.hi)),
            }
        } else {
            Self::EMPTY
        }
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self {
            lo: self.mig(),
            hi: self.mag(),
        }
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self {
            lo: math::min(self.lo, other.lo),
            hi: math::min(self.hi, other.hi),
        }
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self {
            lo: math::max(self.lo, other.lo),
            hi: math::max(self.hi, other.hi),
        }
    }

    #[inline(always)]
    fn choose(self, nonnegative: Self, negative: Self) -> Self {
        if self.lo >= 0.0 {
            nonnegative
        } else if self.hi < 0.0 {
            negative
        } else if self.is_empty() {
            Self::EMPTY
        } else {
            nonnegative.hull(negative)
        }
    }

    #[inline(always)]
    fn is_finite(self) -> bool {
        self.lo.is_finite() && self.hi.is_finite()
    }

    /// Never negative, unlike the product of two unrelated intervals.
    #[inline(always)]
    fn square(self) -> Self {
        let (small, large) = (self.mig(), self.mag());
        Self::outward(small * small, large * large, true, false)
    }
}
