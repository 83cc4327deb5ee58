//! What homogeneous linear equations leave free.

use kempe_linear::Qr;

/// A row that keeps less than this part of itself when those before it are taken off depends on them.
const DEPENDENT: f64 = 1e-11;

/// Which of the rows depends on those before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DependentRow(pub(crate) usize);

/// An orthonormal basis, `K` vectors, of what `N - K` rows leave free. Every row is made of length 1 first.
///
/// # Errors
/// A row that depends on those before it: more is free than `K`.
pub(crate) fn kernel<const N: usize, const K: usize>(
    rows: &[[f64; N]],
) -> Result<[[f64; N]; K], DependentRow> {
    let count = rows.len();
    let mut qr = Qr::with_capacity(N, count);
    qr.reset(N, count);
    for (k, row) in rows.iter().enumerate() {
        let length = row.iter().map(|x| x * x).sum::<f64>().sqrt();
        if !(length > 0.0 && length.is_finite()) {
            return Err(DependentRow(k));
        }
        for (i, x) in row.iter().enumerate() {
            qr.add(i, k, x / length);
        }
    }
    qr.factor();
    if let Some(k) = (0..count).find(|&k| !(qr.diagonal()[k].abs() > DEPENDENT)) {
        return Err(DependentRow(k));
    }
    Ok(std::array::from_fn(|k| {
        let mut unit = [0.0; N];
        unit[N - K + k] = 1.0;
        qr.rotate(&mut unit);
        unit
    }))
}
