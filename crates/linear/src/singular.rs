//! The distance of a matrix from losing rank.

/// Steps after which the iteration is ended as it stands.
const STEPS: usize = 60;
/// Relative change of the value at which it has settled.
const SETTLED: f64 = 1e-9;

/// The smallest singular value of a matrix `A` with so many columns, by inverse iteration on `A^T A` from a fixed start.
///
/// `apply` takes `x` to `(A^T A)^-1 x` in two solves, with `A^T` and then with `A`, and returns the length of what lies
/// between: `|A^-T x|` grows to one over the value sought.
pub fn smallest_singular_value(columns: usize, mut apply: impl FnMut(&mut [f64]) -> f64) -> f64 {
    // Uneven entries, so that no singular vector is missed by symmetry.
    let mut x: Vec<f64> = (0..columns)
        .map(|i| 1.0 + 0.37 * ((i * 7) % 11) as f64)
        .collect();
    let mut value = f64::INFINITY;
    for _ in 0..STEPS {
        let length = x.iter().map(|v| v * v).sum::<f64>().sqrt();
        x.iter_mut().for_each(|v| *v /= length);
        let next = 1.0 / apply(&mut x);
        let settled = (next - value).abs() <= SETTLED * next;
        value = next;
        if settled || !value.is_finite() {
            break;
        }
    }
    value
}
