//! Numbers with twice the digits of `f64`: an unevaluated sum of two (T. J. Dekker, Numer. Math. 18:224, 1971; D. E. Knuth).
//!
//! For the few paths on which the equations are so badly conditioned that rounding stops Newton's method. Products are split rather than
//! fused, so that results are the same everywhere.

use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use kempe_linear::Plain;
use kempe_number::{Number, math};

/// `high + low`, with `high` the nearest `f64` to the sum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Double {
    pub high: f64,
    pub low: f64,
}

/// 2^27 + 1 splits an `f64` into halves of 26 digits.
const SPLITTER: f64 = 134_217_729.0;

/// A sum and what rounding took from it.
#[inline(always)]
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

/// The same where `a` is the larger.
#[inline(always)]
fn quick_sum(a: f64, b: f64) -> Double {
    let sum = a + b;
    Double {
        high: sum,
        low: b - (sum - a),
    }
}

#[inline(always)]
fn split(a: f64) -> (f64, f64) {
    let shifted = SPLITTER * a;
    let high = shifted - (shifted - a);
    (high, a - high)
}

/// A product and what rounding took from it.
#[inline(always)]
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let ((a1, a2), (b1, b2)) = (split(a), split(b));
    (product, ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2)
}

impl Double {
    const fn plain(high: f64) -> Self {
        Self { high, low: 0.0 }
    }

    fn is_zero(self) -> bool {
        self.high == 0.0
    }

    /// Exponential of a small complex number's parts is made of this: 1, x, x^2 / 2, ... with every fourth, or all, taken.
    fn series(self, mut take: impl FnMut(usize, Self)) {
        let mut term = Self::plain(1.0);
        for k in 0..TERMS {
            take(k, term);
            term = term * self / (k + 1) as f64;
        }
    }
}

/// Terms of a series in numbers below 1 / 64 that reach beyond the last digit.
const TERMS: usize = 16;
/// Halvings before a series, for numbers up to a few units.
const HALVINGS: usize = 9;
const HALVED: f64 = 512.0;

impl Add for Double {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let (high, rest) = two_sum(self.high, other.high);
        let (low, least) = two_sum(self.low, other.low);
        let sum = quick_sum(high, rest + low);
        quick_sum(sum.high, sum.low + least)
    }
}

impl Sub for Double {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + (-other)
    }
}

impl Mul for Double {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let (high, rest) = two_product(self.high, other.high);
        quick_sum(high, rest + (self.high * other.low + self.low * other.high))
    }
}

impl Div for Double {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - other * first;
        let second = rest.high / other.high;
        let rest = rest - other * second;
        quick_sum(first, second) + rest.high / other.high
    }
}

impl Neg for Double {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self {
            high: -self.high,
            low: -self.low,
        }
    }
}

/// Operators with a plain number on the right, and those that assign.
macro_rules! operators {
    ($($trait:ident $method:ident $operator:tt;)* | $($assign:ident $assign_method:ident $by:tt;)*) => {
        $(impl $trait<f64> for Double {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                self $operator Self::plain(other)
            }
        })*
        $(impl $assign for Double {
            #[inline(always)]
            fn $assign_method(&mut self, other: Self) {
                *self = *self $by other;
            }
        })*
    };
}

operators! {
    Add add +;
    Sub sub -;
    Mul mul *;
    Div div /;
    |
    AddAssign add_assign +;
    SubAssign sub_assign -;
    MulAssign mul_assign *;
}

impl Number for Double {
    fn from_f64(x: f64) -> Self {
        Self::plain(x)
    }

    fn value(self) -> f64 {
        self.high
    }

    fn sqrt(self) -> Self {
        if self.is_zero() {
            return self;
        }
        // One step of Newton's method.
        let near = Self::plain(self.high.sqrt());
        (near + self / near) * 0.5
    }

    fn sin_cos(self) -> (Self, Self) {
        let (mut sine, mut less) = (Self::plain(0.0), Self::plain(0.0));
        let small = self / HALVED;
        small.series(|k, term| match k % 4 {
            0 if k > 0 => less += term,
            1 => sine += term,
            2 => less -= term,
            3 => sine -= term,
            _ => {}
        });
        // With c = 1 + less: sin 2x = 2 s + 2 s less, cos 2x - 1 = -2 s^2.
        for _ in 0..HALVINGS {
            (sine, less) = ((sine + sine * less) * 2.0, -(sine * sine) * 2.0);
        }
        (sine, less + 1.0)
    }

    fn atan2(self, x: Self) -> Self {
        Self::plain(math::atan2(self.high, x.high))
    }

    fn exp(self) -> Self {
        let mut less = Self::plain(0.0);
        (self / HALVED).series(|k, term| {
            if k > 0 {
                less += term;
            }
        });
        for _ in 0..HALVINGS {
            less = less * 2.0 + less * less;
        }
        less + 1.0
    }

    fn ln(self) -> Self {
        Self::plain(math::ln(self.high))
    }

    fn abs(self) -> Self {
        if self.high < 0.0 { -self } else { self }
    }

    fn min(self, other: Self) -> Self {
        if (self - other).high < 0.0 {
            self
        } else {
            other
        }
    }

    fn max(self, other: Self) -> Self {
        if (self - other).high > 0.0 {
            self
        } else {
            other
        }
    }

    fn choose(self, nonnegative: Self, negative: Self) -> Self {
        match self.nonnegative() {
            Some(true) => nonnegative,
            Some(false) => negative,
            None => Self::plain(f64::NAN),
        }
    }

    fn nonnegative(self) -> Option<bool> {
        (!self.high.is_nan()).then_some(self.high >= 0.0)
    }

    fn constant_part(self) -> Self {
        self
    }

    fn floor(self) -> Self {
        let whole = self.high.floor();
        if whole == self.high {
            quick_sum(whole, self.low.floor())
        } else {
            Self::plain(whole)
        }
    }

    fn is_finite(self) -> bool {
        self.high.is_finite()
    }
}

impl Plain for Double {
    const UNROLLED: usize = 0;

    #[inline(always)]
    fn where_positive(key: Self, yes: Self, no: Self) -> Self {
        if key.high > 0.0 { yes } else { no }
    }

    #[inline(always)]
    fn swap_where_positive(key: Self, a: &mut Self, b: &mut Self) {
        if key.high > 0.0 {
            std::mem::swap(a, b);
        }
    }

    fn any_positive(self) -> bool {
        self.high > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: Double, b: Double) -> bool {
        (a - b).abs().high < 1e-29
    }

    #[test]
    fn operations_keep_twice_the_digits() {
        let third = Double::plain(1.0) / Double::plain(3.0);
        assert!(near(third * 3.0, Double::plain(1.0)));
        let root = Double::plain(2.0).sqrt();
        assert!(near(root * root, Double::plain(2.0)));
        for angle in [0.3, -2.9, 3.1] {
            let (s, c) = Double::plain(angle).sin_cos();
            assert!(near(s * s + c * c, Double::plain(1.0)), "{angle}");
            assert!((s.high - math::sin(angle)).abs() < 1e-15);
            let (e, f) = (Double::plain(angle).exp(), Double::plain(-angle).exp());
            assert!(near(e * f, Double::plain(1.0)), "{angle}");
            assert!((e.high - math::exp(angle)).abs() < 1e-14);
        }
    }
}
