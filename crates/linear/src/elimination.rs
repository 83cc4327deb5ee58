//! Elimination with partial pivoting for matrices of one fixed size, on the stack: plain numbers, or one matrix per lane.

use kempe_number::{Lanes, Number};

use crate::Qr;

/// A plain number, or several: each lane decides for itself.
pub trait Plain: Number {
    /// Largest matrix whose elimination is compiled for its very size. In lanes the work of an entry outweighs a loop's, and
    /// the code for every size, lane and instruction set would be large.
    const UNROLLED: usize;

    /// `yes` where `key` is positive, else `no` (also where it is NaN).
    fn where_positive(key: Self, yes: Self, no: Self) -> Self;

    /// Swaps two numbers where `key` is positive.
    fn swap_where_positive(key: Self, a: &mut Self, b: &mut Self);

    /// Whether it is positive anywhere.
    fn any_positive(self) -> bool;
}

impl Plain for f64 {
    const UNROLLED: usize = 6;

    #[inline(always)]
    fn where_positive(key: Self, yes: Self, no: Self) -> Self {
        if key > 0.0 { yes } else { no }
    }

    #[inline(always)]
    fn swap_where_positive(key: Self, a: &mut Self, b: &mut Self) {
        if key > 0.0 {
            std::mem::swap(a, b);
        }
    }

    #[inline(always)]
    fn any_positive(self) -> bool {
        self > 0.0
    }
}

impl<const W: usize> Plain for Lanes<W> {
    const UNROLLED: usize = 0;

    #[inline(always)]
    fn where_positive(key: Self, yes: Self, mut no: Self) -> Self {
        for k in 0..W {
            no.0[k] = if key.0[k] > 0.0 { yes.0[k] } else { no.0[k] };
        }
        no
    }

    #[inline(always)]
    fn swap_where_positive(key: Self, a: &mut Self, b: &mut Self) {
        (*a, *b) = (
            Self::where_positive(key, *b, *a),
            Self::where_positive(key, *a, *b),
        );
    }

    #[inline(always)]
    fn any_positive(self) -> bool {
        let mut any = false;
        for k in 0..W {
            any |= self.0[k] > 0.0;
        }
        any
    }
}

/// A square matrix that is filled, factored and solved with, again and again.
pub trait Matrix<P> {
    /// Begins a matrix of zeros.
    fn clear(&mut self, size: usize);

    /// Adds to an entry.
    fn add(&mut self, row: usize, column: usize, value: P);

    /// Factors it.
    fn factor(&mut self);

    /// Solves in place.
    fn solve(&self, rhs: &mut [P]);

    /// Its determinant.
    fn determinant(&self) -> P;
}

impl Matrix<f64> for Qr {
    fn clear(&mut self, size: usize) {
        self.reset(size, size);
    }

    fn add(&mut self, row: usize, column: usize, value: f64) {
        Qr::add(self, row, column, value);
    }

    fn factor(&mut self) {
        Qr::factor(self);
    }

    fn solve(&self, rhs: &mut [f64]) {
        Qr::solve(self, rhs);
    }

    fn determinant(&self) -> f64 {
        Qr::determinant(self)
    }
}

/// A matrix of at most `N` rows; where its elimination is compiled for `N`, made up to that with ones on its diagonal.
pub struct Elimination<P, const N: usize> {
    /// How many rows are worked on.
    rows: usize,
    /// L below the diagonal, U on and above it.
    a: [[P; N]; N],
    /// Over the pivots.
    reciprocals: [P; N],
    /// Where positive, row `r` was swapped with row `k` before column `k` was eliminated: `swaps[k][r]`.
    swaps: [[P; N]; N],
    determinant: P,
}

impl<P: Plain, const N: usize> Elimination<P, N> {
    /// Storage.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn storage() -> Self {
        let zeros = [[P::zero(); N]; N];
        Self {
            rows: N,
            a: zeros,
            reciprocals: [P::zero(); N],
            swaps: zeros,
            determinant: P::one(),
        }
    }

    /// How many rows are worked on: in unrolled code always `N`.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn rows(&self) -> usize {
        if N <= P::UNROLLED {
            N
        } else {
            self.rows.min(N)
        }
    }
}

impl<P: Plain, const N: usize> Matrix<P> for Elimination<P, N> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn clear(&mut self, size: usize) {
        self.rows = size;
        let n = self.rows();
        for row in &mut self.a[..n] {
            row[..n].fill(P::zero());
        }
        for k in size..n {
            self.a[k][k] = P::one();
        }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn add(&mut self, row: usize, column: usize, value: P) {
        self.a[row][column] += value;
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn factor(&mut self) {
        let n = self.rows();
        let a = &mut self.a[..n];
        let mut determinant = P::one();
        for k in 0..n {
            let (above, below) = a.split_at_mut(k + 1);
            let pivot_row = &mut above[k];
            // The largest entry of the column comes up row by row, so that every lane can have its own.
            for (row, swap) in below.iter_mut().zip(&mut self.swaps[k][k + 1..n]) {
                let key = row[k].abs() - pivot_row[k].abs();
                for (a, b) in pivot_row[..n].iter_mut().zip(&mut row[..n]) {
                    P::swap_where_positive(key, a, b);
                }
                determinant = P::where_positive(key, -determinant, determinant);
                *swap = key;
            }
            determinant *= pivot_row[k];
            let reciprocal = P::one() / pivot_row[k];
            self.reciprocals[k] = reciprocal;
            for row in below {
                let factor = row[k] * reciprocal;
                row[k] = factor;
                for (x, above) in row[k + 1..n].iter_mut().zip(&pivot_row[k + 1..n]) {
                    *x -= factor * *above;
                }
            }
        }
        self.determinant = determinant;
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn solve(&self, rhs: &mut [P]) {
        let n = self.rows();
        let rhs = &mut rhs[..n];
        // Rows are swapped whole, L with them, so all swaps come first.
        for k in 0..n {
            let (above, below) = rhs.split_at_mut(k + 1);
            for (x, key) in below.iter_mut().zip(&self.swaps[k][k + 1..n]) {
                P::swap_where_positive(*key, &mut above[k], x);
            }
        }
        for r in 1..n {
            let mut sum = rhs[r];
            for (x, l) in rhs[..r].iter().zip(&self.a[r]) {
                sum -= *l * *x;
            }
            rhs[r] = sum;
        }
        for r in (0..n).rev() {
            let mut sum = rhs[r];
            for (x, u) in rhs[r + 1..].iter().zip(&self.a[r][r + 1..n]) {
                sum -= *u * *x;
            }
            rhs[r] = sum * self.reciprocals[r];
        }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn determinant(&self) -> P {
        self.determinant
    }
}
