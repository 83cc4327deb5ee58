//! The numbers on which forces are computed.

use kempe_number::{Dual, Jet, Number};

/// A number on which forces can be computed.
pub trait ForceNumber: Number {
    /// Passes of refinement after which a linear solve with the plain matrix is exact in every part of the number.
    const PASSES: usize;

    /// This number, with parts that are not known (NaN) taken from another.
    fn completed(self, other: Self) -> Self;
}

impl ForceNumber for f64 {
    const PASSES: usize = 1;

    #[inline(always)]
    fn completed(self, other: Self) -> Self {
        if self.is_nan() { other } else { self }
    }
}

impl<const K: usize> ForceNumber for Dual<f64, K> {
    const PASSES: usize = 2;

    #[inline(always)]
    fn completed(self, other: Self) -> Self {
        if self.is_finite() { self } else { other }
    }
}

impl<const N: usize> ForceNumber for Jet<f64, N> {
    const PASSES: usize = N;

    #[inline(always)]
    fn completed(self, other: Self) -> Self {
        Self::from_coefficients(std::array::from_fn(|k| {
            self.coefficient(k).completed(other.coefficient(k))
        }))
    }
}

impl<const K: usize, const N: usize> ForceNumber for Jet<Dual<f64, K>, N> {
    const PASSES: usize = N + 1;

    #[inline(always)]
    fn completed(self, other: Self) -> Self {
        Self::from_coefficients(std::array::from_fn(|k| {
            self.coefficient(k).completed(other.coefficient(k))
        }))
    }
}
