//! The four operations on intervals, rounded outward by one unit in the last place. They are called: each is a few dozen
//! instructions long.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::Interval;
use crate::Number;
use crate::operators::assigning_operators;

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
    let product = a * b;
    if product.is_nan() { 0.0 } else { product }
}

/// The quotient of two bounds; anything over an unbounded bound is zero.
#[inline(always)]
fn corner_quotient(a: f64, b: f64) -> f64 {
    if b.is_infinite() { 0.0 } else { a / b }
}

impl Interval {
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
}

impl Add for Interval {
    type Output = Self;
    #[inline(never)]
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
    #[inline(never)]
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
    #[inline(never)]
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
