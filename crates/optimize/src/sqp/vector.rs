//! Sums, sizes and places along a way: plain lists of numbers as vectors.

/// Sum of products.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The largest component of a list, whatever its sign.
pub(super) fn length(step: &[f64]) -> f64 {
    step.iter().fold(0.0, |m, x| m.max(x.abs()))
}

/// The place so far along a way.
pub(super) fn along(from: &[f64], way: &[f64], by: f64) -> Vec<f64> {
    from.iter().zip(way).map(|(x, w)| x + by * w).collect()
}

/// A matrix with this on its diagonal.
pub(super) fn diagonal(n: usize, size: f64) -> Vec<f64> {
    (0..n * n)
        .map(|k| if k / n == k % n { size } else { 0.0 })
        .collect()
}
