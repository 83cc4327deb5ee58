//! Least squares with columns that may explain each other.

/// A column whose part that no earlier column explains is this small, over the column itself, explains nothing more.
const DEPENDENT: f64 = 1e-9;

/// Factors of the columns whose sum is nearest to `target`: Gram and Schmidt with pivoting, each column cleaned twice.
/// Columns that others explain get the factor 0.
pub fn independent_least_squares(columns: &[&[f64]], target: &[f64]) -> Vec<f64> {
    let n = columns.len();
    let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    let mut rest: Vec<Vec<f64>> = columns.iter().map(|c| c.to_vec()).collect();
    let sizes: Vec<f64> = columns.iter().map(|c| sum(c, c).sqrt()).collect();
    let mut order: Vec<usize> = Vec::with_capacity(n);
    let mut basis: Vec<Vec<f64>> = Vec::with_capacity(n);
    loop {
        let open = (0..n).filter(|k| !order.contains(k));
        let part = |k: usize| sum(&rest[k], &rest[k]).sqrt();
        let Some(next) = open.max_by(|a, b| part(*a).total_cmp(&part(*b))) else {
            break;
        };
        let norm = part(next);
        if !(norm > DEPENDENT * sizes[next]) {
            break;
        }
        let q: Vec<f64> = rest[next].iter().map(|x| x / norm).collect();
        order.push(next);
        for k in (0..n).filter(|k| !order.contains(k)) {
            for _ in 0..2 {
                let along = sum(&q, &rest[k]);
                for (x, y) in rest[k].iter_mut().zip(&q) {
                    *x -= along * y;
                }
            }
        }
        basis.push(q);
    }
    // R x = Q^T target, from the last column back.
    let mut factors = vec![0.0; n];
    for (place, column) in order.iter().enumerate().rev() {
        let q = &basis[place];
        let later: f64 = (order[place + 1..].iter())
            .map(|k| factors[*k] * sum(q, columns[*k]))
            .sum();
        factors[*column] = (sum(q, target) - later) / sum(q, columns[*column]);
    }
    factors
}
