//! Rows of numbers along the coordinates that are let go: products and sums.

/// The sum of the products.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Adds so many times a vector to another.
pub(crate) fn add(sum: &mut [f64], times: f64, row: &[f64]) {
    for (sum, x) in sum.iter_mut().zip(row) {
        *sum += times * x;
    }
}

/// What forces along rows come to.
pub(crate) fn sum(rows: &[Vec<f64>], forces: &[f64]) -> Vec<f64> {
    let mut whole = vec![0.0; rows.first().map_or(0, Vec::len)];
    for (row, force) in rows.iter().zip(forces) {
        add(&mut whole, *force, row);
    }
    whole
}
