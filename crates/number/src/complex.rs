//! Complex numbers for polynomial systems and isotropic coordinates.

use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use crate::Number;

/// A complex number `re` + i `im` over any [`Number`].
///
/// Not a `Number` itself: it has no order, and its roots and angles have branches that a formula must choose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Complex<T> {
    /// Real part.
    pub re: T,
    /// Imaginary part.
    pub im: T,
}

impl<T: Number> Complex<T> {
    /// `re` + i `im`.
    #[inline(always)]
    pub const fn new(re: T, im: T) -> Self {
        Self { re, im }
    }

    /// The number of this length and angle (rad) in the complex plane.
    #[inline(always)]
    pub fn from_polar(length: T, angle: T) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self {
            re: length * cos,
            im: length * sin,
        }
    }

    /// Zero.
    #[inline(always)]
    pub fn zero() -> Self {
        Self {
            re: T::zero(),
            im: T::zero(),
        }
    }

    /// One.
    #[inline(always)]
    pub fn one() -> Self {
        Self {
            re: T::one(),
            im: T::zero(),
        }
    }

    /// The imaginary unit.
    #[inline(always)]
    pub fn i() -> Self {
        Self {
            re: T::zero(),
            im: T::one(),
        }
    }

    /// `re` - i `im`.
    #[inline(always)]
    pub fn conj(self) -> Self {
        Self {
            re: self.re,
            im: -self.im,
        }
    }

    /// The square of the length, `re`^2 + `im`^2.
    #[inline(always)]
    pub fn norm_sqr(self) -> T {
        self.re.square() + self.im.square()
    }

    /// The length. Over- and underflows beyond 1e±154, as its square does.
    #[inline(always)]
    pub fn norm(self) -> T {
        self.norm_sqr().sqrt()
    }

    /// The angle in rad, in [-pi, pi].
    #[inline(always)]
    pub fn arg(self) -> T {
        self.im.atan2(self.re)
    }

    /// The number times a real factor.
    #[inline(always)]
    pub fn scale(self, factor: T) -> Self {
        Self {
            re: self.re * factor,
            im: self.im * factor,
        }
    }

    /// 1 / self.
    #[inline(always)]
    pub fn recip(self) -> Self {
        let norm = self.norm_sqr();
        Self {
            re: self.re / norm,
            im: -self.im / norm,
        }
    }

    /// self^`power` by repeated squaring; one for power 0.
    #[inline]
    pub fn powi(self, power: u32) -> Self {
        let (mut result, mut base, mut left) = (Self::one(), self, power);
        while left > 0 {
            if left & 1 == 1 {
                result *= base;
            }
            left >>= 1;
            if left > 0 {
                base = base * base;
            }
        }
        result
    }

    /// Whether both parts are finite.
    #[inline(always)]
    pub fn is_finite(self) -> bool {
        self.re.is_finite() && self.im.is_finite()
    }
}

impl Complex<f64> {
    /// The square root with non-negative real part (on the negative axis: the sign of `im` decides).
    pub fn sqrt(self) -> Self {
        let length = crate::math::hypot(self.re, self.im);
        if length == 0.0 {
            return Self {
                re: 0.0,
                im: self.im,
            };
        }
        // The half-sum without cancellation; the other part from 2 re im.
        let half = ((self.re.abs() + length) * 0.5).sqrt();
        let other = self.im.abs() / (2.0 * half);
        let (re, im) = if self.re >= 0.0 {
            (half, other)
        } else {
            (other, half)
        };
        Self {
            re,
            im: im.copysign(self.im),
        }
    }
}

impl<T: Number> From<T> for Complex<T> {
    #[inline(always)]
    fn from(re: T) -> Self {
        Self { re, im: T::zero() }
    }
}

impl<T: Number> Add for Complex<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self {
            re: self.re + other.re,
            im: self.im + other.im,
        }
    }
}

impl<T: Number> Sub for Complex<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self {
            re: self.re - other.re,
            im: self.im - other.im,
        }
    }
}

impl<T: Number> Mul for Complex<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self {
            re: self.re * other.re - self.im * other.im,
            im: self.re * other.im + self.im * other.re,
        }
    }
}

impl<T: Number> Div for Complex<T> {
    type Output = Self;
    /// Multiplies by the conjugate; over- and underflows when the divisor is beyond 1e±154.
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let norm = other.norm_sqr();
        let product = self * other.conj();
        Self {
            re: product.re / norm,
            im: product.im / norm,
        }
    }
}

impl<T: Number> Neg for Complex<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self {
            re: -self.re,
            im: -self.im,
        }
    }
}

impl<T: Number> Mul<f64> for Complex<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self {
            re: self.re * factor,
            im: self.im * factor,
        }
    }
}

impl<T: Number> AddAssign for Complex<T> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<T: Number> SubAssign for Complex<T> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<T: Number> MulAssign for Complex<T> {
    #[inline(always)]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}
