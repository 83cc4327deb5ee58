//! Dual numbers: exact first derivatives to `K` parameters at once.
#![allow(
    clippy::suspicious_arithmetic_impl,
    reason = "product and quotient rule"
)]

use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::Number;
use crate::operators::assigning_operators;

/// A value with its derivatives to `K` parameters (forward mode).
///
/// Nested (`Dual<Dual<f64, 1>, K>`) it gives second derivatives; inside a series (`Jet<Dual<f64, K>, N>`) the
/// derivatives of velocities and accelerations to dimensions.
///
/// # Example
/// ```
/// use kempe_number::{Dual, Number};
/// let (x, y) = (Dual::<f64, 2>::variable(3.0, 0), Dual::variable(4.0, 1));
/// let length = (x.square() + y.square()).sqrt();
/// assert_eq!(length.re, 5.0);
/// assert!((length.eps[0] - 0.6).abs() < 1e-15 && (length.eps[1] - 0.8).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<T, const K: usize> {
    /// The value.
    pub re: T,
    /// The derivative of the value to each parameter.
    pub eps: [T; K],
}

impl<T: Number, const K: usize> Dual<T, K> {
    /// Parameter number `i`, with value `x` and unit derivative to itself.
    ///
    /// # Panics
    /// When `i >= K`.
    #[inline]
    pub fn variable(x: T, i: usize) -> Self {
        let mut d = Self::constant(x);
        d.eps[i] = T::one();
        d
    }

    /// A constant: no derivative to any parameter.
    #[inline]
    pub fn constant(x: T) -> Self {
        Self {
            re: x,
            eps: [T::zero(); K],
        }
    }

    /// The chain rule for f(self): value `re`, slope f'(self.re).
    #[inline]
    fn chain(self, re: T, slope: T) -> Self {
        self.each(re, |e| e * slope)
    }

    /// The value `re` with every derivative through `f`.
    #[inline]
    fn each(mut self, re: T, f: impl Fn(T) -> T) -> Self {
        self.re = re;
        for k in 0..K {
            self.eps[k] = f(self.eps[k]);
        }
        self
    }

    /// Combines both derivatives direction by direction.
    #[inline]
    fn combine(mut self, other: Self, re: T, f: impl Fn(T, T) -> T) -> Self {
        self.re = re;
        for k in 0..K {
            self.eps[k] = f(self.eps[k], other.eps[k]);
        }
        self
    }
}

impl<T: Number, const K: usize> Add for Dual<T, K> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        self.combine(other, self.re + other.re, |a, b| a + b)
    }
}

impl<T: Number, const K: usize> Sub for Dual<T, K> {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self.combine(other, self.re - other.re, |a, b| a - b)
    }
}

impl<T: Number, const K: usize> Mul for Dual<T, K> {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        self.combine(other, self.re * other.re, |a, b| a * other.re + self.re * b)
    }
}

impl<T: Number, const K: usize> Div for Dual<T, K> {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        let quotient = self.re / other.re;
        self.combine(other, quotient, |a, b| (a - quotient * b) / other.re)
    }
}

impl<T: Number, const K: usize> Neg for Dual<T, K> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        self.each(-self.re, |e| -e)
    }
}

impl<T: Number, const K: usize> Add<f64> for Dual<T, K> {
    type Output = Self;
    #[inline]
    fn add(self, other: f64) -> Self {
        Self {
            re: self.re + other,
            eps: self.eps,
        }
    }
}

impl<T: Number, const K: usize> Mul<f64> for Dual<T, K> {
    type Output = Self;
    #[inline]
    fn mul(self, other: f64) -> Self {
        self.each(self.re * other, |e| e * other)
    }
}

impl<T: Number, const K: usize> Div<f64> for Dual<T, K> {
    type Output = Self;
    #[inline]
    fn div(self, other: f64) -> Self {
        self.each(self.re / other, |e| e / other)
    }
}

assigning_operators!([T: Number, const K: usize] Dual<T, K>);

impl<T: Number, const K: usize> Number for Dual<T, K> {
    #[inline]
    fn from_f64(x: f64) -> Self {
        Self::constant(T::from_f64(x))
    }

    #[inline]
    fn value(self) -> f64 {
        self.re.value()
    }

    /// The derivatives at zero are not finite.
    #[inline]
    fn sqrt(self) -> Self {
        let root = self.re.sqrt();
        let twice = root * 2.0;
        self.each(root, |e| e / twice)
    }

    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.re.sin_cos();
        (self.chain(sin, cos), self.chain(cos, -sin))
    }

    /// d theta = (x dy - y dx) / (x^2 + y^2).
    #[inline]
    fn atan2(self, x: Self) -> Self {
        let norm = x.re.square() + self.re.square();
        let angle = self.re.atan2(x.re);
        self.combine(x, angle, |dy, dx| (x.re * dy - self.re * dx) / norm)
    }

    #[inline]
    fn exp(self) -> Self {
        let value = self.re.exp();
        self.chain(value, value)
    }

    #[inline]
    fn ln(self) -> Self {
        self.each(self.re.ln(), |e| e / self.re)
    }

    #[inline]
    fn abs(self) -> Self {
        Self {
            re: self.re.abs(),
            ..self.choose(self, -self)
        }
    }

    #[inline]
    fn min(self, other: Self) -> Self {
        Self {
            re: self.re.min(other.re),
            ..(other - self).choose(self, other)
        }
    }

    #[inline]
    fn max(self, other: Self) -> Self {
        Self {
            re: self.re.max(other.re),
            ..(self - other).choose(self, other)
        }
    }

    #[inline]
    fn choose(self, nonnegative: Self, negative: Self) -> Self {
        let re = self.re.choose(nonnegative.re, negative.re);
        nonnegative.combine(negative, re, |a, b| self.re.choose(a, b))
    }

    #[inline(always)]
    fn nonnegative(self) -> Option<bool> {
        self.re.nonnegative()
    }

    #[inline(always)]
    fn constant_part(self) -> Self {
        Self {
            re: self.re.constant_part(),
            eps: [T::zero(); K],
        }
    }

    #[inline(always)]
    fn floor(self) -> Self {
        Self {
            re: self.re.floor(),
            eps: [T::zero(); K],
        }
    }

    #[inline]
    fn is_finite(self) -> bool {
        self.re.is_finite() && self.eps.iter().all(|e| e.is_finite())
    }

    #[inline]
    fn square(self) -> Self {
        self.chain(self.re.square(), self.re * 2.0)
    }
}
