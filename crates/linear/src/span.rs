//! Rows that may repeat each other: the shortest vectors along them, and all that is across.

/// A row of which the rows before it leave this part of the longest row, or less, says nothing of its own.
const REPEATS: f64 = 1e-9;

/// The span of some rows that are comparable: Gram and Schmidt, the row next of which most is left, each cleaned twice.
#[derive(Clone, Debug, Default)]
pub struct Span {
    columns: usize,
    /// Rows that say something of their own, in the order in which they were taken.
    order: Vec<usize>,
    /// Unit vectors across each other, as many.
    basis: Vec<Vec<f64>>,
    /// The least that is left of such a row, over the longest of all.
    least: f64,
    /// What of each of these rows lies along each of the basis up to its own.
    factors: Vec<Vec<f64>>,
}

impl Span {
    /// The span of rows of so many columns.
    pub fn of(rows: &[Vec<f64>], columns: usize) -> Self {
        let mut it = Self {
            columns,
            least: 1.0,
            ..Self::default()
        };
        let sizes = rows.iter().map(|row| dot(row, row).sqrt());
        let longest = sizes.fold(0.0, f64::max);
        let mut rest = rows.to_vec();
        let mut factors: Vec<Vec<f64>> = vec![Vec::new(); rows.len()];
        let mut open: Vec<usize> = (0..rows.len()).collect();
        while it.order.len() < columns {
            let part = |k: &usize| dot(&rest[*k], &rest[*k]).sqrt() / longest;
            let parts = open.iter().enumerate().map(|(at, k)| (at, part(k)));
            let Some((at, most)) = parts.max_by(|a, b| a.1.total_cmp(&b.1)) else {
                break;
            };
            if !(most > REPEATS) {
                break;
            }
            it.least = it.least.min(most);
            let row = open.swap_remove(at);
            let norm = dot(&rest[row], &rest[row]).sqrt();
            let unit: Vec<f64> = rest[row].iter().map(|x| x / norm).collect();
            factors[row].push(norm);
            it.factors.push(std::mem::take(&mut factors[row]));
            it.order.push(row);
            for k in &open {
                let along = take_off(&unit, &mut rest[*k]);
                factors[*k].push(along);
            }
            it.basis.push(unit);
        }
        it
    }

    /// How many rows say something of their own.
    pub fn rank(&self) -> usize {
        self.order.len()
    }

    /// The rows that say something of their own.
    pub fn own_rows(&self) -> &[usize] {
        &self.order
    }

    /// The least that a row says of its own, over the longest row: how near they are to repeating each other.
    pub fn least_part(&self) -> f64 {
        self.least
    }

    /// The shortest vector whose products with the rows are these. Of rows that others repeat nothing is asked.
    pub fn shortest(&self, products: &[f64]) -> Vec<f64> {
        let mut parts: Vec<f64> = Vec::with_capacity(self.rank());
        let mut sum = vec![0.0; self.columns];
        for ((row, factors), unit) in self.order.iter().zip(&self.factors).zip(&self.basis) {
            let known = dot(factors, &parts);
            let part = (products[*row] - known) / factors[parts.len()];
            parts.push(part);
            for (sum, x) in sum.iter_mut().zip(unit) {
                *sum += part * x;
            }
        }
        sum
    }

    /// Takes what lies along the rows off a vector.
    pub fn take_off(&self, vector: &mut [f64]) {
        for _ in 0..2 {
            for unit in &self.basis {
                take_off(unit, vector);
            }
        }
    }

    /// Unit vectors across the rows and each other, as many as there are.
    pub fn across(&self) -> Vec<Vec<f64>> {
        let mut found: Vec<Vec<f64>> = Vec::new();
        // What is left of the unit vectors of the columns.
        let mut left: Vec<f64> = (0..self.columns)
            .map(|k| 1.0 - self.basis.iter().map(|unit| unit[k] * unit[k]).sum::<f64>())
            .collect();
        while self.rank() + found.len() < self.columns {
            let longest = (0..self.columns).max_by(|a, b| left[*a].total_cmp(&left[*b]));
            let Some(column) = longest else { break };
            let mut vector = vec![0.0; self.columns];
            vector[column] = 1.0;
            // Twice: rounding leaves something along them.
            self.take_off(&mut vector);
            for unit in self.basis.iter().chain(&found) {
                take_off(unit, &mut vector);
            }
            let norm = dot(&vector, &vector).sqrt();
            vector.iter_mut().for_each(|x| *x /= norm);
            for (left, x) in left.iter_mut().zip(&vector) {
                *left -= x * x;
            }
            left[column] = f64::NEG_INFINITY;
            found.push(vector);
        }
        found
    }
}

/// Takes what lies along a unit vector off a vector, twice: how much that was.
fn take_off(unit: &[f64], vector: &mut [f64]) -> f64 {
    let mut whole = 0.0;
    for _ in 0..2 {
        let along = dot(unit, vector);
        whole += along;
        for (x, u) in vector.iter_mut().zip(unit) {
            *x -= along * u;
        }
    }
    whole
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_that_repeat_each_other_ask_once() {
        let rows = vec![
            vec![1.0, 2.0, 0.0, 1.0],
            vec![0.0, 1.0, -1.0, 0.5],
            vec![2.0, 5.0, -1.0, 2.5],
            vec![0.0; 4],
        ];
        let span = Span::of(&rows, 4);
        assert_eq!(span.rank(), 2);
        let x = span.shortest(&[1.0, -2.0, 0.0, 0.0]);
        for (row, wanted) in rows.iter().zip([1.0, -2.0, 0.0, 0.0]) {
            assert!((dot(row, &x) - wanted).abs() < 1e-14);
        }
        let across = span.across();
        assert_eq!(across.len(), 2);
        for (k, one) in across.iter().enumerate() {
            assert!(dot(one, &x).abs() < 1e-14);
            for row in &rows {
                assert!(dot(one, row).abs() < 1e-14);
            }
            for (j, other) in across.iter().enumerate() {
                let wanted = if j == k { 1.0 } else { 0.0 };
                assert!((dot(one, other) - wanted).abs() < 1e-14);
            }
        }
    }
}
