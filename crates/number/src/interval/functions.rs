//! Functions of intervals, rounded outward by two units in the last place (roots and squares by one).

use std::f64::consts::{FRAC_2_PI, PI};

use super::Interval;
use crate::{Number, math};

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

/// Whether some x in the interval, counted in quarter turns from `lo` to `hi`, is `residue` mod 4.
#[inline(always)]
fn meets_quarter(lo: f64, hi: f64, residue: f64) -> bool {
    residue + 4.0 * ((lo - residue) * 0.25).ceil() <= hi
}

impl Number for Interval {
    /// An operation is a call.
    const IN_PLACE: bool = false;

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
            lo: if meets_quarter(lo, hi, bottom) {
                -1.0
            } else {
                down2(a.min(b)).max(-1.0)
            },
            hi: if meets_quarter(lo, hi, top) {
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

    /// [-pi, pi] when the box lies on both sides of the branch cut (the negative x axis and the origin); above it, which `y` from
    /// a positive zero on says, no angle is negative.
    ///
    /// Elsewhere the angle is monotonic along every edge and two corners give the bounds.
    fn atan2(self, x: Self) -> Self {
        let y = self;
        if y.is_empty() || x.is_empty() {
            return Self::EMPTY;
        }
        let pi = PI.next_up();
        // A negative zero may stand for what lies below.
        let above = y.lo >= 0.0 && y.lo.is_sign_positive() && y.hi > 0.0;
        if y.contains_zero() && x.lo <= 0.0 {
            let lo = match above {
                false => -pi,
                true if x.hi >= 0.0 => 0.0,
                true => down2(math::atan2(y.hi, x.hi)).max(0.0),
            };
            return Self { lo, hi: pi };
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
            lo: down2(lo).max(if above { 0.0 } else { -pi }),
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
    fn nonnegative(self) -> Option<bool> {
        (self.lo >= 0.0 || self.hi < 0.0).then_some(self.lo >= 0.0)
    }

    #[inline(always)]
    fn constant_part(self) -> Self {
        self
    }

    #[inline(always)]
    fn floor(self) -> Self {
        Self {
            lo: self.lo.floor(),
            hi: self.hi.floor(),
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
