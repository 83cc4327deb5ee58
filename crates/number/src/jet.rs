//! Truncated Taylor series: time (or drive) derivatives of any order from the position formula alone.
#![allow(
    clippy::needless_range_loop,
    reason = "the recurrences are sums over indices"
)]

use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::Number;
use crate::operators::assigning_operators;

/// A power series cut off after `N` coefficients: f(t0 + h) = c0 + c1 h + ... + c(N-1) h^(N-1) + O(h^N).
///
/// Coefficient k is the k-th derivative over k!, so `N = 4` carries position, velocity, acceleration and jerk.
/// Products and functions follow the usual recurrences (Griewank and Walther, *Evaluating Derivatives*, 2008,
/// table 13.2); every one costs O(N^2) operations of `T` and no allocation. `N` must be at least 1.
///
/// # Example
/// ```
/// use kempe_number::{Jet, Number};
/// let t = Jet::<f64, 4>::variable(0.0);
/// let x = (t * 2.0).sin_cos().0; // sin 2t
/// assert_eq!([x.derivative(0), x.derivative(1), x.derivative(3)], [0.0, 2.0, -8.0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet<T, const N: usize>([T; N]);

impl<T: Number, const N: usize> Jet<T, N> {
    /// The series of the independent variable at `x0`: c0 = `x0`, c1 = 1.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn variable(x0: T) -> Self {
        let mut c = Self::constant(x0).0;
        if N > 1 {
            c[1] = T::one();
        }
        Self(c)
    }

    /// A constant: every derivative zero.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn constant(x: T) -> Self {
        let mut c = [T::zero(); N];
        c[0] = x;
        Self(c)
    }

    /// The series with these coefficients (derivative k over k!).
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub const fn from_coefficients(coefficients: [T; N]) -> Self {
        Self(coefficients)
    }

    /// The series whose k-th derivative is `derivatives[k]`, e.g. `[q, qd, qdd]` of a drive.
    #[inline]
    pub fn from_derivatives(derivatives: [T; N]) -> Self {
        let mut c = derivatives;
        let mut factorial = 1.0;
        for k in 1..N {
            factorial *= k as f64;
            c[k] = c[k] / factorial;
        }
        Self(c)
    }

    /// All coefficients, constant term first.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub const fn coefficients(&self) -> &[T; N] {
        &self.0
    }

    /// Coefficient of the k-th power.
    ///
    /// # Panics
    /// When `k >= N`.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn coefficient(&self, k: usize) -> T {
        self.0[k]
    }

    /// The k-th derivative, k! times the coefficient.
    ///
    /// # Panics
    /// When `k >= N`.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn derivative(&self, k: usize) -> T {
        let factorial: f64 = (1..=k).map(|i| i as f64).product();
        self.0[k] * factorial
    }

    /// The series of the derivative. Its last coefficient is not known from this series and set to zero.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn differentiate(&self) -> Self {
        let mut c = [T::zero(); N];
        for k in 1..N {
            c[k - 1] = self.0[k] * k as f64;
        }
        Self(c)
    }

    /// The series of the antiderivative with this value at the expansion point; the last coefficient is lost.
    #[inline]
    pub fn integrate(&self, value: T) -> Self {
        let mut c = [T::zero(); N];
        c[0] = value;
        for k in 1..N {
            c[k] = self.0[k - 1] / k as f64;
        }
        Self(c)
    }

    /// Substitutes a series into this one: `self` is a series in q - q0, `inner` is q(t), the result is in t.
    ///
    /// The constant term of `inner` must be q0; it is not looked at.
    #[inline]
    pub fn compose(&self, inner: &Self) -> Self {
        self.compose_to(inner)
    }

    /// The first `M` coefficients of [`Jet::compose`]: to them only as many of `inner` contribute.
    ///
    /// # Panics
    /// When `M > N`.
    #[inline]
    pub fn compose_to<const M: usize>(&self, inner: &Self) -> Jet<T, M> {
        let mut step = Jet([T::zero(); M]);
        step.0[1..].copy_from_slice(&inner.0[1..M]);
        let mut sum = Jet::constant(self.0[N - 1]);
        for k in (0..N - 1).rev() {
            // The product starts with zero, whatever higher coefficients are not known.
            sum *= step;
            sum.0[0] = self.0[k];
        }
        sum
    }

    /// The value of the truncated polynomial a step `h` away from the expansion point.
    #[inline]
    pub fn evaluate(&self, h: T) -> T {
        let mut sum = self.0[N - 1];
        for k in (0..N - 1).rev() {
            sum = sum * h + self.0[k];
        }
        sum
    }

    /// Whether sums are compiled into their caller. Those of series of plain numbers are, whatever their length: they take few
    /// instructions.
    const SUMS_IN_PLACE: bool = T::IN_LANES || size_of::<T>() == size_of::<f64>();

    // The recurrences' inner loops all run to `N`: the compiler unrolls loops of known length.

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn product(self, other: Self) -> Self {
        let mut c = self.0;
        for k in 0..N {
            c[k] = self.0[0] * other.0[k];
            for i in 1..N {
                if i <= k {
                    c[k] += self.0[i] * other.0[k - i];
                }
            }
        }
        Self(c)
    }

    #[inline(never)]
    fn product_called(self, other: Self) -> Self {
        self.product(other)
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn quotient(self, other: Self) -> Self {
        let mut q = self.0;
        for k in 0..N {
            for i in 0..N {
                if i < k {
                    q[k] -= q[i] * other.0[k - i];
                }
            }
            q[k] = q[k] / other.0[0];
        }
        Self(q)
    }

    #[inline(never)]
    fn quotient_called(self, other: Self) -> Self {
        self.quotient(other)
    }

    /// s s = a gives s_k = (a_k - sum of s_i s_(k-i), 0 < i < k) / (2 s_0). Derivatives at zero are not finite.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn root(self) -> Self {
        let mut s = self.0;
        s[0] = self.0[0].sqrt();
        let twice = s[0] * 2.0;
        for k in 1..N {
            for i in 1..N {
                if i < k {
                    s[k] -= s[i] * s[k - i];
                }
            }
            s[k] = s[k] / twice;
        }
        Self(s)
    }

    #[inline(never)]
    fn root_called(self) -> Self {
        self.root()
    }

    /// s' = c a' and c' = -s a'.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn sine_cosine(self) -> (Self, Self) {
        let (sin, cos) = self.0[0].sin_cos();
        let (mut s, mut c) = (Self::constant(sin).0, Self::constant(cos).0);
        let slope = self.differentiate().0;
        for k in 1..N {
            let (mut sum_s, mut sum_c) = (T::zero(), T::zero());
            for i in 0..N {
                if i < k {
                    sum_s += slope[i] * c[k - 1 - i];
                    sum_c += slope[i] * s[k - 1 - i];
                }
            }
            s[k] = sum_s / k as f64;
            c[k] = -(sum_c / k as f64);
        }
        (Self(s), Self(c))
    }

    #[inline(never)]
    fn sine_cosine_called(self) -> (Self, Self) {
        self.sine_cosine()
    }

    /// Symmetric products are formed once, and the constant term uses the tighter square of `T`.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn own_product(self) -> Self {
        let mut c = self.0;
        for k in 0..N {
            let mut sum = T::zero();
            for i in 0..N {
                if 2 * i < k {
                    sum += self.0[i] * self.0[k - i];
                }
            }
            c[k] = sum * 2.0;
            if k % 2 == 0 {
                c[k] += self.0[k / 2].square();
            }
        }
        Self(c)
    }

    #[inline(never)]
    fn own_product_called(self) -> Self {
        self.own_product()
    }

    /// Applies `f` to every coefficient.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn each(self, f: impl Fn(T) -> T) -> Self {
        match Self::SUMS_IN_PLACE {
            true => self.each_in_place(f),
            false => self.each_called(f),
        }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn each_in_place(mut self, f: impl Fn(T) -> T) -> Self {
        for k in 0..N {
            self.0[k] = f(self.0[k]);
        }
        self
    }

    #[inline(never)]
    fn each_called(self, f: impl Fn(T) -> T) -> Self {
        self.each_in_place(f)
    }

    /// Applies `f` to the coefficients of both series in pairs.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn pairwise(self, other: Self, f: impl Fn(T, T) -> T) -> Self {
        match Self::SUMS_IN_PLACE {
            true => self.pairwise_in_place(other, f),
            false => self.pairwise_called(other, f),
        }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn pairwise_in_place(mut self, other: Self, f: impl Fn(T, T) -> T) -> Self {
        for k in 0..N {
            self.0[k] = f(self.0[k], other.0[k]);
        }
        self
    }

    #[inline(never)]
    fn pairwise_called(self, other: Self, f: impl Fn(T, T) -> T) -> Self {
        self.pairwise_in_place(other, f)
    }
}

impl<T: Number, const N: usize> Add for Jet<T, N> {
    type Output = Self;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn add(self, other: Self) -> Self {
        self.pairwise(other, |a, b| a + b)
    }
}

impl<T: Number, const N: usize> Sub for Jet<T, N> {
    type Output = Self;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn sub(self, other: Self) -> Self {
        self.pairwise(other, |a, b| a - b)
    }
}

impl<T: Number, const N: usize> Mul for Jet<T, N> {
    type Output = Self;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn mul(self, other: Self) -> Self {
        match Self::IN_PLACE {
            true => self.product(other),
            false => self.product_called(other),
        }
    }
}

impl<T: Number, const N: usize> Div for Jet<T, N> {
    type Output = Self;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn div(self, other: Self) -> Self {
        match Self::IN_PLACE {
            true => self.quotient(other),
            false => self.quotient_called(other),
        }
    }
}

impl<T: Number, const N: usize> Neg for Jet<T, N> {
    type Output = Self;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn neg(self) -> Self {
        self.each(|a| -a)
    }
}

impl<T: Number, const N: usize> Add<f64> for Jet<T, N> {
    type Output = Self;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn add(mut self, other: f64) -> Self {
        self.0[0] = self.0[0] + other;
        self
    }
}

impl<T: Number, const N: usize> Mul<f64> for Jet<T, N> {
    type Output = Self;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn mul(self, other: f64) -> Self {
        self.each(|a| a * other)
    }
}

impl<T: Number, const N: usize> Div<f64> for Jet<T, N> {
    type Output = Self;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn div(self, other: f64) -> Self {
        self.each(|a| a / other)
    }
}

assigning_operators!([T: Number, const N: usize] Jet<T, N>);

impl<T: Number, const N: usize> Number for Jet<T, N> {
    const LANE_COUNT: usize = T::LANE_COUNT;

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn from_f64(x: f64) -> Self {
        Self::constant(T::from_f64(x))
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn value(self) -> f64 {
        self.0[0].value()
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn sqrt(self) -> Self {
        match Self::IN_PLACE {
            true => self.root(),
            false => self.root_called(),
        }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn sin_cos(self) -> (Self, Self) {
        match Self::IN_PLACE {
            true => self.sine_cosine(),
            false => self.sine_cosine_called(),
        }
    }

    /// theta' = (x y' - y x') / (x^2 + y^2), integrated from the angle of the constant terms.
    #[inline]
    fn atan2(self, x: Self) -> Self {
        let angle = self.0[0].atan2(x.0[0]);
        if N == 1 {
            return Self::constant(angle);
        }
        let turning = x * self.differentiate() - self * x.differentiate();
        let slope = turning / (x.square() + self.square());
        slope.integrate(angle)
    }

    /// e' = e a'.
    #[inline]
    fn exp(self) -> Self {
        let mut e = Self::constant(self.0[0].exp()).0;
        let slope = self.differentiate().0;
        for k in 1..N {
            let mut sum = T::zero();
            for i in 0..k {
                sum += slope[i] * e[k - 1 - i];
            }
            e[k] = sum / k as f64;
        }
        Self(e)
    }

    /// l' = a' / a, integrated from the logarithm of the constant term.
    #[inline]
    fn ln(self) -> Self {
        (self.differentiate() / self).integrate(self.0[0].ln())
    }

    #[inline]
    fn abs(self) -> Self {
        let mut r = self.choose(self, -self);
        r.0[0] = self.0[0].abs();
        r
    }

    #[inline]
    fn min(self, other: Self) -> Self {
        let mut r = (other - self).choose(self, other);
        r.0[0] = self.0[0].min(other.0[0]);
        r
    }

    #[inline]
    fn max(self, other: Self) -> Self {
        let mut r = (self - other).choose(self, other);
        r.0[0] = self.0[0].max(other.0[0]);
        r
    }

    #[inline]
    fn choose(self, nonnegative: Self, negative: Self) -> Self {
        nonnegative.pairwise(negative, |a, b| self.0[0].choose(a, b))
    }

    #[inline(always)]
    fn nonnegative(self) -> Option<bool> {
        self.0[0].nonnegative()
    }

    #[inline(always)]
    fn constant_part(self) -> Self {
        Self::constant(self.0[0].constant_part())
    }

    #[inline(always)]
    fn floor(self) -> Self {
        Self::constant(self.0[0].floor())
    }

    #[inline]
    fn is_finite(self) -> bool {
        self.0.iter().all(|c| c.is_finite())
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn square(self) -> Self {
        match Self::IN_PLACE {
            true => self.own_product(),
            false => self.own_product_called(),
        }
    }
}
