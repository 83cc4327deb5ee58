//! Newton's method on conditions that are linear in products of the unknowns.

use kempe_linear::Lu;

/// Products in which conditions are linear.
pub(crate) const PRODUCTS: usize = 7;
/// A condition: factors of the products.
pub(crate) type Row = [f64; PRODUCTS];

/// `N` unknowns, and the seven products of them that conditions are linear in.
pub(crate) trait Products<const N: usize> {
    /// The products.
    fn products(unknowns: &[f64; N]) -> Row;

    /// The derivatives of what a condition comes to, by the unknowns.
    fn derivatives(row: &Row, unknowns: &[f64; N]) -> [f64; N];
}

/// Steps at most.
const STEPS: usize = 6;

/// What conditions come to at most, beside the size of their products.
pub(crate) fn residual(rows: &[Row], products: &Row) -> f64 {
    let size = products.iter().map(|x| x * x).sum::<f64>().sqrt();
    let worst = (rows.iter())
        .map(|row| {
            row.iter()
                .zip(products)
                .map(|(a, b)| a * b)
                .sum::<f64>()
                .abs()
        })
        .fold(0.0, f64::max);
    worst / size
}

/// Unknowns improved, and what is left of the conditions, beside their products; a first step longer than `most`, beside the unknowns' size,
/// leads elsewhere and is not made. Steps that do not help are not made either.
pub(crate) fn polished<const N: usize, P: Products<N>>(
    rows: &[Row],
    start: [f64; N],
    most: f64,
) -> ([f64; N], f64) {
    let mut lu = Lu::new(N);
    let (mut x, mut products) = (start, P::products(&start));
    let mut left = residual(rows, &products);
    for step in 0..STEPS {
        let mut change: [f64; N] =
            std::array::from_fn(|k| rows[k].iter().zip(&products).map(|(a, b)| a * b).sum());
        let jacobian: [[f64; N]; N] = std::array::from_fn(|k| P::derivatives(&rows[k], &x));
        if !lu.factor(|i, j| jacobian[i][j]) {
            break;
        }
        lu.solve(&mut change);
        let largest = |x: &[f64; N]| x.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        if step == 0 && largest(&change) > most * (1.0 + largest(&x)) {
            break;
        }
        let next: [f64; N] = std::array::from_fn(|k| x[k] - change[k]);
        let there = P::products(&next);
        let now = residual(rows, &there);
        if !(now < left) {
            break;
        }
        (x, products, left) = (next, there, now);
    }
    (x, left)
}
