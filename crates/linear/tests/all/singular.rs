//! The smallest singular value against a method of another kind: one-sided Jacobi rotations (Hestenes 1958).

use kempe_linear::Qr;
use kempe_number::Random;

/// All singular values of a matrix given by its columns: rotated until they are orthogonal, these are their lengths.
fn by_jacobi(mut columns: Vec<Vec<f64>>) -> Vec<f64> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    for _ in 0..60 {
        let mut off = 0.0_f64;
        for i in 0..columns.len() {
            for j in i + 1..columns.len() {
                let (a, b) = (dot(&columns[i], &columns[i]), dot(&columns[j], &columns[j]));
                let c = dot(&columns[i], &columns[j]);
                off = off.max(c.abs() / (a * b).sqrt());
                if c == 0.0 {
                    continue;
                }
                let cot = (b - a) / (2.0 * c);
                let t = cot.signum() / (cot.abs() + (1.0 + cot * cot).sqrt());
                let cos = 1.0 / (1.0 + t * t).sqrt();
                for k in 0..columns[i].len() {
                    let (x, y) = (columns[i][k], columns[j][k]);
                    (columns[i][k], columns[j][k]) = (cos * (x - t * y), cos * (t * x + y));
                }
            }
        }
        if off < 1e-15 {
            break;
        }
    }
    columns.iter().map(|c| dot(c, c).sqrt()).collect()
}

#[test]
fn the_smallest_singular_value_is_that_of_jacobi() {
    let mut random = Random(3);
    let mut near = 0;
    for round in 0..400 {
        let columns = 1 + round % 14;
        let rows = columns + round % 3;
        let mut matrix: Vec<Vec<f64>> = (0..columns)
            .map(|_| (0..rows).map(|_| 2.0 * random.uniform() - 1.0).collect())
            .collect();
        // Some columns nearly explain each other, some pairs are small alike.
        for k in 1..columns {
            if (round + k) % 5 == 0 {
                let by = 1e-3 * (1.0 + 1e-2 * random.uniform());
                for row in 0..rows {
                    matrix[k][row] = matrix[k - 1][row] + by * matrix[k][row];
                }
            }
        }
        if round % 4 == 0 {
            for column in matrix.iter_mut().take(2) {
                column.iter_mut().for_each(|x| *x *= 1e-3);
            }
        }
        let mut qr = Qr::default();
        qr.reset(rows, columns);
        for (column, entries) in matrix.iter().enumerate() {
            for (row, entry) in entries.iter().enumerate() {
                qr.add(row, column, *entry);
            }
        }
        qr.factor();
        let found = qr.smallest_singular_value();
        let mut all = by_jacobi(matrix);
        all.sort_by(f64::total_cmp);
        near += usize::from(all.get(1).is_some_and(|next| *next < 1.3 * all[0]));
        assert!(
            (found - all[0]).abs() <= 1e-9 * all[0] + 1e-14,
            "{rows} x {columns}: {found:e} {all:?}"
        );
    }
    assert!(near > 10, "{near} with two values near each other");
}
