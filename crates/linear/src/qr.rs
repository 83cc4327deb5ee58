//! Least squares by Householder reflections, with storage that is reused from solve to solve.
//!
//! Zeros below the last entry of a column are left out of its reflection and of all that it acts on, so a matrix whose
//! rows and columns are in the order of its blocks costs little more than its blocks. Nor are zeros above the first entry of
//! a column of R looked at where columns are gone through.

use kempe_number::Number;

use crate::smallest_singular_value;

/// A factored matrix of `rows >= columns`. Square systems are solved, taller ones in the least-squares sense.
#[derive(Clone, Debug, Default)]
pub struct Qr {
    rows: usize,
    columns: usize,
    /// Column-major: R above the diagonal, reflectors on and below it.
    a: Vec<f64>,
    /// Diagonal of R.
    diagonal: Vec<f64>,
    /// Reflector scale, 2 / v.v.
    scale: Vec<f64>,
    /// Row behind the last entry of every column: of its reflector.
    end: Vec<usize>,
    /// Row of the first entry of every column of R.
    begin: Vec<usize>,
}

impl Qr {
    /// Storage for matrices up to this size; no later call allocates while it suffices.
    pub fn with_capacity(rows: usize, columns: usize) -> Self {
        Self {
            rows: 0,
            columns: 0,
            a: Vec::with_capacity(rows * columns),
            diagonal: Vec::with_capacity(columns),
            scale: Vec::with_capacity(columns),
            end: Vec::with_capacity(columns),
            begin: Vec::with_capacity(columns),
        }
    }

    /// Starts a new matrix of zeros.
    pub fn reset(&mut self, rows: usize, columns: usize) {
        self.rows = rows;
        self.columns = columns;
        self.a.clear();
        self.a.resize(rows * columns, 0.0);
    }

    /// Adds to an entry of the matrix, before [`Qr::factor`].
    #[inline(always)]
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        self.a[column * self.rows + row] += value;
    }

    /// The lengths of the matrix's columns, before [`Qr::factor`].
    pub fn column_lengths(&self) -> Vec<f64> {
        let columns = self.a.chunks_exact(self.rows.max(1));
        columns.map(|c| dot(c, c).sqrt()).collect()
    }

    /// Sums of the columns' first entries with as many factors, before [`Qr::factor`].
    pub fn transposed_times(&self, factors: &[f64]) -> Vec<f64> {
        let columns = self.a.chunks_exact(self.rows.max(1));
        let columns = columns.map(|c| dot(&c[..factors.len().min(c.len())], factors));
        columns.collect()
    }

    /// Makes of a column a unit vector with its one at a row, before [`Qr::factor`]: what it is the factor of becomes what stands there.
    pub fn hold(&mut self, column: usize, row: usize) {
        let rows = self.rows;
        self.a[column * rows..(column + 1) * rows].fill(0.0);
        self.a[column * rows + row] = 1.0;
    }

    /// Factors the matrix in place.
    pub fn factor(&mut self) {
        let m = self.rows;
        self.diagonal.clear();
        self.scale.clear();
        self.end.clear();
        for k in 0..self.columns {
            let column = &self.a[k * m..(k + 1) * m];
            let last = column.iter().rposition(|x| *x != 0.0);
            self.end.push(last.map_or(0, |row| row + 1).max(k + 1));
        }
        for k in 0..self.columns {
            let end = self.end[k];
            let (head, tail) = self.a.split_at_mut((k + 1) * m);
            let v = &mut head[k * m + k..k * m + end];
            let norm = dot(v, v).sqrt();
            let alpha = if v[0] > 0.0 { -norm } else { norm };
            // Half of v.v after the next line.
            let half = norm * (norm + v[0].abs());
            v[0] -= alpha;
            let scale = if half > 0.0 { 1.0 / half } else { 0.0 };
            self.diagonal.push(alpha);
            self.scale.push(scale);
            for (column, below) in tail.chunks_exact_mut(m).zip(&mut self.end[k + 1..]) {
                let shared = end.min(*below).max(k);
                let sum = dot(&v[..shared - k], &column[k..shared]) * scale;
                if sum != 0.0 {
                    for (x, y) in v.iter().zip(&mut column[k..end]) {
                        *y -= sum * x;
                    }
                    *below = end.max(*below);
                }
            }
        }
        self.begin.clear();
        for k in 0..self.columns {
            let above = &self.a[k * m..k * m + k];
            self.begin
                .push(above.iter().position(|x| *x != 0.0).unwrap_or(k));
        }
    }

    /// Solves in place: on return the first `columns` entries of `rhs` are the solution.
    pub fn solve<T: Number>(&self, rhs: &mut [T]) {
        let m = self.rows;
        (0..self.columns).for_each(|k| self.reflect(k, rhs));
        for k in (0..self.columns).rev() {
            let mut sum = rhs[k];
            for j in k + 1..self.columns {
                sum -= rhs[j] * self.a[j * m + k];
            }
            rhs[k] = sum / self.diagonal[k];
        }
    }

    /// Solves the transposed system `A^T x = rhs` in place, for `A` of full column rank: `rhs` holds `columns` numbers on
    /// entry and `x`, `rows` numbers, on return; it must have room for both. Of many solutions the shortest is given.
    pub fn solve_transposed<T: Number>(&self, rhs: &mut [T]) {
        let m = self.rows;
        // R^T w = rhs, then x = Q w.
        for i in 0..self.columns {
            let begin = self.begin[i];
            let column = &self.a[i * m + begin..i * m + i];
            let mut sum = rhs[i];
            for (r, w) in column.iter().zip(&rhs[begin..]) {
                sum -= *w * *r;
            }
            rhs[i] = sum / self.diagonal[i];
        }
        rhs[self.columns..m].fill(T::zero());
        self.rotate(&mut rhs[..m]);
    }

    /// Multiplies a vector of `rows` numbers by Q.
    pub fn rotate<T: Number>(&self, x: &mut [T]) {
        (0..self.columns).rev().for_each(|k| self.reflect(k, x));
    }

    /// The reflection that made one column.
    #[inline]
    fn reflect<T: Number>(&self, k: usize, x: &mut [T]) {
        let at = k * self.rows;
        let v = &self.a[at + k..at + self.end[k]];
        let mut sum = T::zero();
        for (a, b) in v.iter().zip(&x[k..]) {
            sum += *b * *a;
        }
        sum = sum * self.scale[k];
        for (a, b) in v.iter().zip(&mut x[k..]) {
            *b -= sum * *a;
        }
    }

    /// Rows of the matrix.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Columns of the matrix.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Determinant of a square matrix (of R with the sign of the reflections).
    pub fn determinant(&self) -> f64 {
        // Every reflection that was made turns the sign.
        self.diagonal
            .iter()
            .zip(&self.scale)
            .map(|(r, s)| if *s > 0.0 { -r } else { *r })
            .product()
    }

    /// The Frobenius norm: at least the largest singular value, at most that times the root of the rank.
    pub fn norm(&self) -> f64 {
        let m = self.rows;
        let above = |k: usize| self.a[k * m..k * m + k].iter();
        let sum: f64 = (0..self.columns)
            .map(|k| kempe_number::powi(self.diagonal[k], 2) + above(k).map(|x| x * x).sum::<f64>())
            .sum();
        sum.sqrt()
    }

    /// The smallest singular value, with those of R.
    pub fn smallest_singular_value(&self) -> f64 {
        let (m, n) = (self.rows, self.columns);
        if n == 0 {
            return f64::INFINITY;
        }
        if self.diagonal.contains(&0.0) {
            return 0.0;
        }
        smallest_singular_value(n, |x| {
            for i in 0..n {
                let begin = self.begin[i];
                let column = &self.a[i * m + begin..i * m + i];
                let sum: f64 = column.iter().zip(&x[begin..]).map(|(r, x)| r * x).sum();
                x[i] = (x[i] - sum) / self.diagonal[i];
            }
            let between = x.iter().map(|v| v * v).sum::<f64>().sqrt();
            for i in (0..n).rev() {
                let begin = self.begin[i];
                let found = x[i] / self.diagonal[i];
                let column = &self.a[i * m + begin..i * m + i];
                for (r, x) in column.iter().zip(&mut x[begin..]) {
                    *x -= r * found;
                }
                x[i] = found;
            }
            between
        })
    }

    /// The diagonal of R: of each column what the columns before it do not explain, with a sign.
    pub fn diagonal(&self) -> &[f64] {
        &self.diagonal
    }

    /// Smallest over largest diagonal entry of R: a cheap measure of how near the matrix is to losing rank.
    pub fn smallest_pivot_ratio(&self) -> f64 {
        let (low, high) = self
            .diagonal
            .iter()
            .fold((f64::INFINITY, 0.0_f64), |(low, high), r| {
                (low.min(r.abs()), high.max(r.abs()))
            });
        if high > 0.0 { low / high } else { 0.0 }
    }
}

/// Dot product in four partial sums, which the compiler can keep side by side.
#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<4>(), b.as_chunks::<4>());
    let mut sums = [0.0; 4];
    for (a, b) in a.iter().zip(b) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_a_square_and_a_tall_system() {
        let mut qr = Qr::with_capacity(3, 2);
        qr.reset(2, 2);
        for (r, c, v) in [(0, 0, 1.0), (0, 1, 2.0), (1, 0, 3.0), (1, 1, -1.0)] {
            qr.add(r, c, v);
        }
        qr.factor();
        assert!((qr.determinant() + 7.0).abs() < 1e-14);
        let mut rhs = [5.0, 1.0];
        qr.solve(&mut rhs);
        assert!((rhs[0] - 1.0).abs() < 1e-14 && (rhs[1] - 2.0).abs() < 1e-14);

        qr.reset(3, 2);
        for (r, c, v) in [
            (0, 0, 1.0),
            (1, 0, 1.0),
            (2, 0, 1.0),
            (1, 1, 1.0),
            (2, 1, 2.0),
        ] {
            qr.add(r, c, v);
        }
        qr.factor();
        let mut rhs = [1.0, 3.0, 5.0];
        qr.solve(&mut rhs);
        assert!((rhs[0] - 1.0).abs() < 1e-14 && (rhs[1] - 2.0).abs() < 1e-14);

        // x + y + z = 3, y + 2 z = 3: the shortest solution is (1, 1, 1).
        let mut rhs = [3.0, 3.0, f64::NAN];
        qr.solve_transposed(&mut rhs);
        assert!(rhs.iter().all(|x| (x - 1.0).abs() < 1e-14), "{rhs:?}");
    }
}
