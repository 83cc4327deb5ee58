//! Eigenvalues and eigenvectors of symmetric matrices, alone or against a mass matrix.
//!
//! By C. G. J. Jacobi's rotations (1846): slower than reduction to tridiagonal form on large matrices, and on the small ones of
//! mechanisms the simplest method and the most accurate one.

use crate::positive::cholesky;

/// Sweeps over all pairs at most; about six are usual, and convergence is quadratic.
const SWEEPS: usize = 60;
/// An entry that is this part of its diagonal entries' geometric mean is rounding.
const ROUNDING: f64 = 1e-17;

/// A component of this part of the largest is as large: those that symmetry makes equal differ by rounding.
const AS_LARGE: f64 = 1.0 - 1e-9;

/// An eigenvalue with its vector.
#[derive(Clone, Debug, PartialEq)]
pub struct EigenPair {
    /// The eigenvalue.
    pub value: f64,
    /// The vector; its first component of the largest size is positive.
    pub vector: Vec<f64>,
}

/// The eigenvalues of a symmetric matrix (by rows, `n` by `n`; only its symmetric part counts), rising, with vectors of
/// length 1 that are orthogonal to each other.
pub fn symmetric_eigen(matrix: &[f64], n: usize) -> Vec<EigenPair> {
    let mut a: Vec<f64> = (0..n * n)
        .map(|k| (matrix[k] + matrix[(k % n) * n + k / n]) / 2.0)
        .collect();
    // Rows are the vectors.
    let mut v: Vec<f64> = (0..n * n)
        .map(|k| if k / n == k % n { 1.0 } else { 0.0 })
        .collect();
    for _ in 0..SWEEPS {
        let mut rotated = false;
        for p in 0..n {
            for q in p + 1..n {
                let off = a[p * n + q];
                let (low, high) = (a[p * n + p], a[q * n + q]);
                if !(off.abs() > ROUNDING * (low.abs() * high.abs()).sqrt()) {
                    continue;
                }
                rotated = true;
                let cot = (high - low) / (2.0 * off);
                let t = cot.signum() / (cot.abs() + (1.0 + cot * cot).sqrt());
                let c = 1.0 / (1.0 + t * t).sqrt();
                let s = t * c;
                for k in 0..n {
                    let (x, y) = (a[k * n + p], a[k * n + q]);
                    (a[k * n + p], a[k * n + q]) = (c * x - s * y, s * x + c * y);
                }
                for k in 0..n {
                    let (x, y) = (a[p * n + k], a[q * n + k]);
                    (a[p * n + k], a[q * n + k]) = (c * x - s * y, s * x + c * y);
                    let (x, y) = (v[p * n + k], v[q * n + k]);
                    (v[p * n + k], v[q * n + k]) = (c * x - s * y, s * x + c * y);
                }
                (a[p * n + q], a[q * n + p]) = (0.0, 0.0);
            }
        }
        if !rotated {
            break;
        }
    }
    let mut pairs: Vec<EigenPair> = (0..n)
        .map(|k| EigenPair {
            value: a[k * n + k],
            vector: facing_up(v[k * n..(k + 1) * n].to_vec()),
        })
        .collect();
    pairs.sort_by(|x, y| x.value.total_cmp(&y.value));
    pairs
}

/// The values `w` and vectors `x` of `k x = w m x`, rising in `w`, of symmetric matrices by rows; `m` is positive. The vectors
/// are of unit mass, `x m x = 1`, and orthogonal in `m` and `k`.
///
/// # Errors
/// The first row of `m` that has no pivot ([`is_pivot`](crate::is_pivot)): it is not positive.
pub fn generalised_eigen(k: &[f64], m: &[f64], n: usize) -> Result<Vec<EigenPair>, usize> {
    let l = cholesky(m, n)?;
    // A = L^-1 K L^-T, columns first.
    let mut a = k.to_vec();
    for column in 0..n {
        forward(&l, n, |row| row * n + column, &mut a);
    }
    for row in 0..n {
        forward(&l, n, |column| row * n + column, &mut a);
    }
    let mut pairs = symmetric_eigen(&a, n);
    for pair in &mut pairs {
        let x = &mut pair.vector;
        for i in (0..n).rev() {
            for j in i + 1..n {
                x[i] -= l[j * n + i] * x[j];
            }
            x[i] /= l[i * n + i];
        }
        pair.vector = facing_up(std::mem::take(x));
    }
    Ok(pairs)
}

/// Solves `L x = b` in place; `at` says where the entries of `b` stand.
fn forward(l: &[f64], n: usize, at: impl Fn(usize) -> usize, b: &mut [f64]) {
    for i in 0..n {
        for j in 0..i {
            b[at(i)] -= l[i * n + j] * b[at(j)];
        }
        b[at(i)] /= l[i * n + i];
    }
}

/// The vector or its opposite, so that its first component of the largest size is positive.
fn facing_up(mut vector: Vec<f64>) -> Vec<f64> {
    let largest = vector.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let first = vector.iter().find(|x| x.abs() >= largest * AS_LARGE);
    if first.is_some_and(|x| *x < 0.0) {
        vector.iter_mut().for_each(|x| *x = -*x);
    }
    vector
}
