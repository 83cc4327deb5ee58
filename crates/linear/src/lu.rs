//! Square systems, real or complex, whose factors are kept: many right-hand sides, one after the other.

use std::ops::{Mul, SubAssign};

use crate::C;

/// What a matrix may hold.
pub trait Entry: Copy + Mul<Output = Self> + SubAssign {
    /// Zero.
    const ZERO: Self;

    /// A size that pivots are compared by.
    fn size(self) -> f64;

    /// One over it.
    fn inverse(self) -> Self;
}

impl Entry for f64 {
    const ZERO: Self = 0.0;

    #[inline(always)]
    fn size(self) -> f64 {
        self.abs()
    }

    #[inline(always)]
    fn inverse(self) -> Self {
        1.0 / self
    }
}

impl Entry for C {
    const ZERO: Self = Self { re: 0.0, im: 0.0 };

    #[inline(always)]
    fn size(self) -> f64 {
        self.re.abs() + self.im.abs()
    }

    #[inline(always)]
    fn inverse(self) -> Self {
        self.recip()
    }
}

/// A factored square matrix, with partial pivoting. Its storage is made once.
#[derive(Clone, Debug)]
pub struct Lu<T> {
    size: usize,
    /// Row-major; after factoring U on and above the diagonal (the diagonal inverted), L below.
    a: Vec<T>,
    /// With which row each was exchanged.
    pivots: Vec<usize>,
}

impl<T: Entry> Lu<T> {
    /// Storage for matrices of this size.
    pub fn new(size: usize) -> Self {
        Self {
            size,
            a: vec![T::ZERO; size * size],
            pivots: vec![0; size],
        }
    }

    /// Factors the matrix of these entries (row, column). `false` where a pivot vanishes or is not finite: the matrix is singular, or
    /// what it was made of is no number. Entries that are no pivots are not looked at; they show in the solutions.
    pub fn factor(&mut self, mut entry: impl FnMut(usize, usize) -> T) -> bool {
        let n = self.size;
        for row in 0..n {
            for column in 0..n {
                self.a[row * n + column] = entry(row, column);
            }
        }
        for k in 0..n {
            let (mut pivot, mut largest) = (k, -1.0);
            for row in k..n {
                let size = self.a[row * n + k].size();
                if size > largest {
                    (pivot, largest) = (row, size);
                }
            }
            if !(largest > f64::MIN_POSITIVE && largest.is_finite()) {
                return false;
            }
            self.pivots[k] = pivot;
            if pivot != k {
                for column in 0..n {
                    self.a.swap(pivot * n + column, k * n + column);
                }
            }
            let inverse = self.a[k * n + k].inverse();
            self.a[k * n + k] = inverse;
            let (above, below) = self.a.split_at_mut((k + 1) * n);
            let row = &above[k * n..];
            for other in below.chunks_exact_mut(n) {
                if other[k].size() == 0.0 {
                    continue;
                }
                let factor = other[k] * inverse;
                other[k] = factor;
                for column in k + 1..n {
                    other[column] -= factor * row[column];
                }
            }
        }
        true
    }

    /// Replaces a right-hand side by the solution.
    pub fn solve(&self, b: &mut [T]) {
        let n = self.size;
        for k in 0..n {
            b.swap(k, self.pivots[k]);
        }
        for row in 1..n {
            let mut sum = b[row];
            for column in 0..row {
                sum -= self.a[row * n + column] * b[column];
            }
            b[row] = sum;
        }
        for row in (0..n).rev() {
            let mut sum = b[row];
            for column in row + 1..n {
                sum -= self.a[row * n + column] * b[column];
            }
            b[row] = sum * self.a[row * n + row];
        }
    }
}

#[cfg(test)]
mod tests {
    use kempe_number::Random;

    use super::*;

    /// A matrix times a vector minus a right-hand side, at most.
    fn left<T: Entry>(a: &[T], x: &[T], b: &[T]) -> f64 {
        let n = x.len();
        (0..n).fold(0.0, |worst: f64, row| {
            let mut rest = b[row];
            for column in 0..n {
                rest -= a[row * n + column] * x[column];
            }
            worst.max(rest.size())
        })
    }

    #[test]
    fn real_and_complex_systems_are_solved_again_and_again() {
        let mut random = Random(7);
        let mut next = move || 2.0 * random.uniform() - 1.0;
        for n in [1, 2, 5, 9] {
            let mut lu = Lu::new(n);
            let mut complex = Lu::new(n);
            for _ in 0..20 {
                // Zeros on the diagonal: nothing is solved without pivots.
                let mut a: Vec<f64> = (0..n * n).map(|_| next()).collect();
                if n > 1 {
                    (0..n).for_each(|k| a[k * n + k] = 0.0);
                }
                assert!(lu.factor(|row, column| a[row * n + column]));
                let c: Vec<C> = a.iter().map(|re| C::new(*re, next())).collect();
                assert!(complex.factor(|row, column| c[row * n + column]));
                for _ in 0..2 {
                    let b: Vec<f64> = (0..n).map(|_| next()).collect();
                    let mut x = b.clone();
                    lu.solve(&mut x);
                    let size = x.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
                    assert!(left(&a, &x, &b) < 1e-13 * size, "{n}");
                    let b: Vec<C> = (0..n).map(|_| C::new(next(), next())).collect();
                    let mut x = b.clone();
                    complex.solve(&mut x);
                    let size = x.iter().fold(1.0_f64, |most, x| most.max(x.size()));
                    assert!(left(&c, &x, &b) < 1e-13 * size, "{n}");
                }
            }
        }
    }

    #[test]
    fn what_has_no_inverse_is_refused() {
        let mut lu = Lu::new(2);
        assert!(!lu.factor(|row, column| [[1.0, 2.0], [2.0, 4.0]][row][column]));
        assert!(!lu.factor(|_, _| f64::NAN));
        assert!(lu.factor(|row, column| [[0.0, 2.0], [2.0, 4.0]][row][column]));
    }
}
