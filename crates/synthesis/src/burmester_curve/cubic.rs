//! The centre-point curve's equation.

use kempe_linear::C;

use crate::displacements::with_fixed;
use crate::newton::Row;

/// A cubic in two variables: coefficients by the powers of x and y.
pub(super) struct Cubic(pub(super) [[f64; 4]; 4]);

impl Cubic {
    /// The determinant of the three rows that a fixed pivot x + i y leaves.
    pub(super) fn of(rows: &[Row; 3]) -> Self {
        // Each row is p + x q + y r.
        let parts: [[[f64; 3]; 3]; 3] = std::array::from_fn(|k| {
            let p = with_fixed(&rows[k], C::zero());
            let along = |g: C| {
                let there = with_fixed(&rows[k], g);
                std::array::from_fn(|i| there[i] - p[i])
            };
            [p, along(C::one()), along(C::i())]
        });
        let mut cubic = [[0.0; 4]; 4];
        for (i, a) in parts[0].iter().enumerate() {
            for (j, b) in parts[1].iter().enumerate() {
                let product = [
                    a[1] * b[2] - a[2] * b[1],
                    a[2] * b[0] - a[0] * b[2],
                    a[0] * b[1] - a[1] * b[0],
                ];
                for (k, c) in parts[2].iter().enumerate() {
                    let powers = |of: usize| [i, j, k].iter().filter(|p| **p == of).count();
                    cubic[powers(1)][powers(2)] +=
                        product[0] * c[0] + product[1] * c[1] + product[2] * c[2];
                }
            }
        }
        Self(cubic)
    }

    /// Value and gradient at a point.
    pub(super) fn about(&self, at: C) -> [f64; 3] {
        let (x, y, c) = (at.re, at.im, &self.0);
        let power = |b: f64, n: usize| kempe_number::powi(b, n as i32);
        let mut sum = [0.0; 3];
        for i in 0..4 {
            for j in 0..4 - i {
                sum[0] += c[i][j] * power(x, i) * power(y, j);
                if i > 0 {
                    sum[1] += c[i][j] * i as f64 * power(x, i - 1) * power(y, j);
                }
                if j > 0 {
                    sum[2] += c[i][j] * j as f64 * power(x, i) * power(y, j - 1);
                }
            }
        }
        sum
    }

    /// Its quadratic part about a point: the factors of dx^2, dx dy and dy^2.
    pub(super) fn second_about(&self, at: C) -> [f64; 3] {
        let (x, y, c) = (at.re, at.im, &self.0);
        [
            c[2][0] + 3.0 * c[3][0] * x + c[2][1] * y,
            c[1][1] + 2.0 * (c[2][1] * x + c[1][2] * y),
            c[0][2] + c[1][2] * x + 3.0 * c[0][3] * y,
        ]
    }
}
