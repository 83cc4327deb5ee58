//! Positive symmetric matrices: which pivot is none, and their factors. The rows of mass matrices fail where a coordinate moves no
//! mass that the ones before it do not move.

use kempe_number::Number;

/// A pivot below this part of its entry is rounding: so few digits are left of it that nothing is to be built on them.
const ROUNDING: f64 = 1e-12;

/// Whether what elimination leaves of a diagonal entry is more than rounding: the row is not made of those before it.
#[inline]
pub fn is_pivot(rest: f64, entry: f64) -> bool {
    rest > ROUNDING * entry
}

/// The factors L D L' of a symmetric matrix of `n` rows in its place: D on the diagonal, L below. `pivot` is handed what is left of a
/// diagonal entry and the entry, and tells the pivot, as [`is_pivot`] says for every plain number in it.
///
/// # Errors
/// The first row that has no pivot.
pub fn factor_positive<T: Number>(
    n: usize,
    l: &mut [T],
    pivot: impl Fn(T, T) -> Option<T>,
) -> Result<(), usize> {
    for i in 0..n {
        for j in 0..=i {
            let known: T = (0..j).fold(T::zero(), |sum, k| {
                sum + l[i * n + k] * l[j * n + k] * l[k * n + k]
            });
            let entry = l[i * n + j];
            let rest = entry - known;
            l[i * n + j] = match i == j {
                true => pivot(rest, entry).ok_or(i)?,
                false => rest / l[j * n + j],
            };
        }
    }
    Ok(())
}

/// Solves with these factors, in place.
pub fn solve_positive<T: Number>(n: usize, l: &[T], right: &mut [T]) {
    for i in 0..n {
        for k in 0..i {
            let known = l[i * n + k] * right[k];
            right[i] -= known;
        }
    }
    for i in 0..n {
        right[i] = right[i] / l[i * n + i];
    }
    for i in (0..n).rev() {
        for k in i + 1..n {
            let known = l[k * n + i] * right[k];
            right[i] -= known;
        }
    }
}

/// `L` of `m = L L'`, by rows (A.-L. Cholesky, 1924; only the symmetric part counts): what makes a matrix beside it symmetric again, which
/// L D L' does not.
///
/// # Errors
/// The first row that has no pivot ([`is_pivot`]).
pub fn cholesky(m: &[f64], n: usize) -> Result<Vec<f64>, usize> {
    let mut l = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..=i {
            let known: f64 = (0..j).map(|k| l[i * n + k] * l[j * n + k]).sum();
            let rest = (m[i * n + j] + m[j * n + i]) / 2.0 - known;
            if i == j {
                if !is_pivot(rest, m[i * n + i]) {
                    return Err(i);
                }
                l[i * n + i] = rest.sqrt();
            } else {
                l[i * n + j] = rest / l[j * n + j];
            }
        }
    }
    Ok(l)
}

#[cfg(test)]
mod tests {
    use kempe_number::Random;

    use super::*;

    fn pivot(rest: f64, entry: f64) -> Option<f64> {
        is_pivot(rest, entry).then_some(rest)
    }

    #[test]
    fn positive_systems_are_solved() {
        let mut random = Random(5);
        for n in 1..8 {
            let half: Vec<f64> = (0..n * n).map(|_| random.uniform() - 0.5).collect();
            let entry = |k: usize| -> f64 {
                let own = if k / n == k % n { 0.1 } else { 0.0 };
                let terms = (0..n).map(|j| half[k / n * n + j] * half[k % n * n + j]);
                terms.sum::<f64>() + own
            };
            let matrix: Vec<f64> = (0..n * n).map(entry).collect();
            let wanted: Vec<f64> = (0..n).map(|_| random.uniform() - 0.5).collect();
            let mut x: Vec<f64> = (matrix.chunks_exact(n))
                .map(|row| row.iter().zip(&wanted).map(|(a, x)| a * x).sum())
                .collect();
            let mut factors = matrix.clone();
            assert_eq!(factor_positive(n, &mut factors, pivot), Ok(()));
            solve_positive(n, &factors, &mut x);
            for (found, wanted) in x.iter().zip(&wanted) {
                assert!((found - wanted).abs() < 1e-12, "{n}");
            }
        }
    }

    #[test]
    fn both_kinds_of_factors_fail_in_the_same_row() {
        // The third coordinate moves what the first two move, and so much of its own.
        for (own, row) in [(0.0, Err(2)), (1e-13, Err(2)), (1e-11, Ok(()))] {
            let mass = [2.0, 1.0, 3.0, 1.0, 2.0, 3.0, 3.0, 3.0, 6.0 * (1.0 + own)];
            let mut factors = mass;
            assert_eq!(factor_positive(3, &mut factors, pivot), row, "{own}");
            assert_eq!(cholesky(&mass, 3).map(|_| ()), row, "{own}");
        }
    }
}
