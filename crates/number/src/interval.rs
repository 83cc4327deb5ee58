//! Intervals with outward rounding: bounds that hold in spite of rounding errors.

mod arithmetic;
mod functions;

use crate::math;

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

    /// Rounds computed bounds outward by one unit, keeping a sign that is certain.
    #[inline(always)]
    fn outward(lo: f64, hi: f64, nonnegative: bool, nonpositive: bool) -> Self {
        let (lo, hi) = (-above(-lo), above(hi));
        Self {
            lo: if nonnegative { math::max(lo, 0.0) } else { lo },
            hi: if nonpositive { math::min(hi, 0.0) } else { hi },
        }
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

/// The next larger number, as [`f64::next_up`] has it but for NaN's own bits; without branches, which half of an interval's time goes to otherwise.
#[inline(always)]
fn above(x: f64) -> f64 {
    // Of zeros the one without a sign.
    let bits = (x + 0.0).to_bits() as i64;
    let next = f64::from_bits((bits + 1 + 2 * (bits >> 63)) as u64);
    if x < f64::INFINITY { next } else { x }
}

#[cfg(test)]
mod tests {
    use super::above;

    #[test]
    fn above_is_the_next_number() {
        let powers = (-1074..1024).map(|n| crate::powi(2.0, n));
        let more = [
            0.0,
            f64::MAX,
            f64::INFINITY,
            f64::MIN_POSITIVE,
            f64::EPSILON,
            0.1,
            1.0 / 3.0,
        ];
        for x in powers.chain(more) {
            for x in [x, x.next_up(), x.next_down()] {
                for x in [x, -x] {
                    assert_eq!(above(x).to_bits(), x.next_up().to_bits(), "{x:e}");
                }
            }
        }
        assert!(above(f64::NAN).is_nan());
    }
}
