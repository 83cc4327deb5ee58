//! Affine functions of complex variables, and linear equations between them.

use crate::complex::C;

/// Coefficients below this part of the largest are what rounding left of a zero.
const ROUNDING: f64 = 1e-14;

/// An affine function of some variables: coefficients, then the constant.
#[derive(Clone, Debug)]
pub struct Affine(pub Vec<C>);

impl Affine {
    /// A function that has one value everywhere.
    pub fn constant(variables: usize, value: C) -> Self {
        let mut row = vec![C::zero(); variables + 1];
        row[variables] = value;
        Self(row)
    }

    /// Adds to its constant.
    pub fn add_constant(&mut self, value: C) {
        if let Some(last) = self.0.last_mut() {
            *last += value;
        }
    }

    /// Adds to the factor of one variable.
    pub fn add(&mut self, variable: usize, factor: C) {
        self.0[variable] += factor;
    }

    /// The difference to another.
    pub fn minus(&self, other: &Self) -> Self {
        Self(self.0.iter().zip(&other.0).map(|(a, b)| *a - *b).collect())
    }

    /// The function without what rounding left of coefficients that cancelled.
    pub fn cleaned(mut self) -> Self {
        let largest = self.0.iter().map(|c| c.norm_sqr()).fold(0.0, f64::max);
        for c in &mut self.0 {
            if c.norm_sqr() <= ROUNDING * ROUNDING * largest {
                *c = C::zero();
            }
        }
        self
    }

    /// The same function of conjugate variables: coefficients conjugated.
    pub fn conj(&self) -> Self {
        Self(self.0.iter().map(|c| c.conj()).collect())
    }

    /// Its value at a point.
    pub fn value(&self, x: &[C]) -> C {
        let n = self.0.len() - 1;
        self.0[..n]
            .iter()
            .zip(x)
            .fold(self.0[n], |sum, (a, x)| sum + *a * *x)
    }

    /// Substitutes affine functions of new variables for the variables.
    pub fn substitute(&self, old: &[Affine]) -> Self {
        let n = self.0.len() - 1;
        let new = old.first().map_or(0, |a| a.0.len() - 1);
        let mut sum = Self::constant(new, self.0[n]);
        for (a, f) in self.0[..n].iter().zip(old) {
            for (s, c) in sum.0.iter_mut().zip(&f.0) {
                *s += *a * *c;
            }
        }
        sum
    }
}

/// Solves linear equations (each affine function = 0) for as many variables as they determine: every variable as an
/// affine function of the free ones. `None` when they contradict each other.
pub fn eliminate(equations: &[Affine], variables: usize) -> Option<Vec<Affine>> {
    let mut rows: Vec<Vec<C>> = equations.iter().map(|e| e.0.clone()).collect();
    let mut pivots: Vec<(usize, usize)> = Vec::new();
    for k in 0..rows.len() {
        // Full pivoting: the largest entry left.
        let mut best = (0.0, k, 0);
        for (i, row) in rows.iter().enumerate().skip(k) {
            for (j, entry) in row[..variables].iter().enumerate() {
                if entry.norm_sqr() > best.0 {
                    best = (entry.norm_sqr(), i, j);
                }
            }
        }
        let (size, i, j) = best;
        if size < 1e-20 {
            if rows[k..]
                .iter()
                .any(|row| row[variables].norm_sqr() > 1e-16)
            {
                return None;
            }
            break;
        }
        rows.swap(k, i);
        let inverse = rows[k][j].recip();
        for entry in &mut rows[k] {
            *entry *= inverse;
        }
        let pivot_row = rows[k].clone();
        for (i, row) in rows.iter_mut().enumerate() {
            if i != k && row[j].norm_sqr() > 0.0 {
                let factor = row[j];
                for (entry, p) in row.iter_mut().zip(&pivot_row) {
                    *entry -= factor * *p;
                }
            }
        }
        pivots.push((k, j));
    }
    let free: Vec<usize> = (0..variables)
        .filter(|j| pivots.iter().all(|(_, p)| p != j))
        .collect();
    let mut solved = vec![Affine::constant(free.len(), C::zero()); variables];
    for (place, &j) in free.iter().enumerate() {
        solved[j].add(place, C::one());
    }
    for &(k, j) in &pivots {
        for (place, &f) in free.iter().enumerate() {
            solved[j].add(place, -rows[k][f]);
        }
        solved[j].add_constant(-rows[k][variables]);
    }
    Some(solved)
}
