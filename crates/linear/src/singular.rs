//! The distance of a matrix from losing rank.
//!
//! By C. Lanczos's method (1950): after k steps an operator, seen from the space of the k vectors met so far, is a tridiagonal
//! matrix whose largest eigenvalue is the best that this space can tell. It settles in a few steps where iterating the
//! inverse takes dozens. The vectors are kept orthogonal to each other, so nothing is found twice.

/// An eigenvalue is settled when its vector is one to this part of the eigenvalue: it errs by the square of that, over its
/// relative distance from the next.
const SETTLED: f64 = 1e-7;
/// Steps after which the method is ended as it stands.
const STEPS: usize = 60;
/// Steps of Newton's method on the tridiagonal matrix at most; it takes about six.
const NEWTON_STEPS: usize = 40;

/// The smallest singular value of a matrix `A` with so many columns, by the largest eigenvalue of `(A^T A)^-1` from a fixed
/// start.
///
/// `apply` takes `x` to `(A^T A)^-1 x` in two solves, with `A^T` and then with `A`, and returns the length of what lies
/// between.
pub fn smallest_singular_value(columns: usize, mut apply: impl FnMut(&mut [f64]) -> f64) -> f64 {
    let most = columns.min(STEPS);
    let mut basis: Vec<f64> = Vec::with_capacity(columns * most.min(8));
    // Uneven entries, so that no singular vector is missed by symmetry.
    let mut next: Vec<f64> = (0..columns)
        .map(|i| 1.0 + 0.37 * ((i * 7) % 11) as f64)
        .collect();
    let mut seen = Projection::default();
    let mut length = dot(&next, &next).sqrt();
    for step in 1..=most {
        basis.extend(next.iter().map(|x| x / length));
        next.copy_from_slice(&basis[columns * (step - 1)..]);
        let between = apply(&mut next);
        if !between.is_finite() {
            return 1.0 / between;
        }
        for vector in basis.chunks_exact(columns) {
            let along = dot(&next, vector);
            for (x, v) in next.iter_mut().zip(vector) {
                *x -= along * v;
            }
        }
        length = dot(&next, &next).sqrt();
        let rest = seen.grow(between * between, length);
        if !(rest > SETTLED * seen.largest) {
            break;
        }
    }
    1.0 / seen.largest.sqrt()
}

/// What is seen of the operator: a symmetric tridiagonal matrix that grows, with its largest eigenvalue.
#[derive(Default)]
struct Projection {
    /// Diagonal entries, each with the one beside it towards the next.
    entries: Vec<[f64; 2]>,
    largest: f64,
}

impl Projection {
    /// Takes up the next diagonal entry and the one beside it that leads out of the matrix. Returns by how much the vector of
    /// the largest eigenvalue is none of the whole operator.
    fn grow(&mut self, diagonal: f64, beside: f64) -> f64 {
        let before = self.entries.last().map_or(0.0, |last| last[1]);
        self.entries.push([diagonal, beside]);
        // From above Newton's method falls to the largest root of the characteristic polynomial without passing it.
        let mut at = self.largest.max(diagonal) + before;
        for _ in 0..NEWTON_STEPS {
            let lower = at - self.step(at);
            if !(lower < at) {
                break;
            }
            at = lower;
        }
        self.largest = at;
        let (mut square, mut last) = (1.0, 1.0);
        let (mut pivot, mut before) = (f64::INFINITY, 0.0);
        for (k, [diagonal, beside]) in self.entries.iter().enumerate() {
            if k > 0 {
                last *= -pivot / before;
                square += last * last;
            }
            pivot = diagonal - at - before * before / pivot;
            before = *beside;
        }
        beside * last / square.sqrt()
    }

    /// Newton's step on the characteristic polynomial, by the pivots of the elimination.
    fn step(&self, at: f64) -> f64 {
        let (mut pivot, mut slope, mut before) = (f64::INFINITY, 0.0, 0.0);
        let mut sum = 0.0;
        for [diagonal, beside] in &self.entries {
            let part = before / pivot;
            slope = part * part * slope - 1.0;
            pivot = diagonal - at - before * part;
            sum += slope / pivot;
            before = *beside;
        }
        1.0 / sum
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of the diagonal matrix with these entries, and the steps taken.
    fn diagonal(entries: &[f64]) -> (f64, usize) {
        let mut steps = 0;
        let smallest = smallest_singular_value(entries.len(), |x| {
            steps += 1;
            x.iter_mut().zip(entries).for_each(|(x, e)| *x /= e);
            let between = dot(x, x).sqrt();
            x.iter_mut().zip(entries).for_each(|(x, e)| *x /= e);
            between
        });
        (smallest, steps)
    }

    #[test]
    fn the_smallest_is_found_in_a_few_steps() {
        let (found, steps) = diagonal(&[3.0, 0.5, 0.3, 0.31, 1.0, 0.7, 9.0, 0.33, 0.6, 0.4]);
        assert!(
            (found - 0.3).abs() < 1e-12 && steps <= 10,
            "{found} {steps}"
        );
        let (found, steps) = diagonal(&[1e-6, 0.5, -0.3, 0.31]);
        assert!(
            (found - 1e-6).abs() < 1e-18 && steps <= 3,
            "{found} {steps}"
        );
        assert_eq!(diagonal(&[0.25]), (0.25, 1));
        assert_eq!(diagonal(&[]), (f64::INFINITY, 0));
        let (found, steps) = diagonal(&[2.0, 2.0, 2.0]);
        assert!((found - 2.0).abs() < 1e-15 && steps == 1, "{found} {steps}");
    }

    #[test]
    fn many_near_each_other_are_told_apart() {
        let entries: Vec<f64> = (0..200).map(|k| (1.0 + f64::from(k)).sqrt()).collect();
        let (found, steps) = diagonal(&entries);
        assert!((found - 1.0).abs() < 1e-12 && steps < 25, "{found} {steps}");
        assert!(diagonal(&[1.0, f64::NAN]).0.is_nan());
        assert_eq!(diagonal(&[1.0, 0.0]).0, 0.0);
    }
}
