//! Rank of a sparse matrix, by elimination that keeps it sparse.
//!
//! A joint touches two bodies, so a row of the constraint Jacobian has at most six entries however large the mechanism.
//! Pivots are taken where they fill in little (Markowitz 1957) among those that are large in their row and column
//! (threshold rook pivoting); where no such entry is at hand the largest of all is taken, which is full pivoting.

use std::collections::BTreeSet;

/// Pivots below this part of the matrix's largest entry count as zero.
pub const RANK_TOLERANCE: f64 = 1e-9;
/// Smallest part of the largest entry of its row and of its column that a pivot may be: bounds the growth of errors.
const THRESHOLD: f64 = 0.3;
/// Rows with the fewest entries among which a pivot is looked for.
const CANDIDATES: usize = 12;

/// A row: columns, rising, with their entries.
pub type SparseRow = Vec<(usize, f64)>;

struct Elimination {
    rows: Vec<SparseRow>,
    /// Rows that have (or had) an entry in a column.
    in_column: Vec<Vec<usize>>,
    /// Rows not yet used, by their number of entries.
    open: BTreeSet<(usize, usize)>,
}

/// The rank of a matrix given by its rows; pivots below this part of its largest entry count as zero.
pub fn rank(rows: Vec<SparseRow>, columns: usize, tolerance: f64) -> usize {
    let largest = rows
        .iter()
        .flatten()
        .fold(0.0_f64, |m, (_, v)| m.max(v.abs()));
    let zero = tolerance * largest;
    let mut it = Elimination {
        in_column: vec![Vec::new(); columns],
        open: BTreeSet::new(),
        rows,
    };
    for (index, row) in it.rows.iter().enumerate() {
        it.open.insert((row.len(), index));
        for (column, _) in row {
            it.in_column[*column].push(index);
        }
    }
    let mut rank = 0;
    while let Some((row, column)) = it.pivot(zero) {
        it.eliminate(row, column);
        rank += 1;
    }
    rank
}

impl Elimination {
    /// The next pivot; rows that have become zero are put away on the way.
    fn pivot(&mut self, zero: f64) -> Option<(usize, usize)> {
        let mut best: Option<(usize, usize, usize)> = None;
        let candidates: Vec<(usize, usize)> = self.open.iter().take(CANDIDATES).copied().collect();
        for (length, row) in candidates {
            if best.is_some_and(|(cost, ..)| cost <= length.saturating_sub(1)) {
                break;
            }
            let largest = (self.rows[row].iter()).fold(0.0_f64, |m, (_, v)| m.max(v.abs()));
            if !(largest > zero) {
                self.open.remove(&(length, row));
                continue;
            }
            for index in 0..length {
                let (column, value) = self.rows[row][index];
                if value.abs() < THRESHOLD * largest {
                    continue;
                }
                let (count, tallest) = self.column(column);
                let cost = (length - 1) * count.saturating_sub(1);
                if value.abs() >= THRESHOLD * tallest && best.is_none_or(|b| cost < b.0) {
                    best = Some((cost, row, column));
                }
            }
        }
        if let Some((_, row, column)) = best {
            return Some((row, column));
        }
        // Full pivoting.
        let mut found = None;
        let mut largest = zero;
        for &(_, row) in &self.open {
            for (column, value) in &self.rows[row] {
                if value.abs() > largest {
                    (found, largest) = (Some((row, *column)), value.abs());
                }
            }
        }
        found
    }

    fn entry(&self, row: usize, column: usize) -> Option<f64> {
        let place = self.rows[row].binary_search_by_key(&column, |(c, _)| *c);
        place.ok().map(|k| self.rows[row][k].1)
    }

    /// How many open rows have an entry in a column, and the largest of these.
    fn column(&mut self, column: usize) -> (usize, f64) {
        let mut list = std::mem::take(&mut self.in_column[column]);
        list.sort_unstable();
        list.dedup();
        let mut tallest = 0.0_f64;
        list.retain(|row| {
            let entry = self
                .entry(*row, column)
                .filter(|_| self.open.contains(&(self.rows[*row].len(), *row)));
            tallest = tallest.max(entry.map_or(0.0, f64::abs));
            entry.is_some()
        });
        let count = list.len();
        self.in_column[column] = list;
        (count, tallest)
    }

    fn eliminate(&mut self, row: usize, column: usize) {
        self.column(column);
        let pivot_row = std::mem::take(&mut self.rows[row]);
        self.open.remove(&(pivot_row.len(), row));
        let Some(pivot) = pivot_row
            .iter()
            .find(|(c, _)| *c == column)
            .map(|(_, v)| *v)
        else {
            return;
        };
        for other in std::mem::take(&mut self.in_column[column]) {
            if other == row {
                continue;
            }
            let Some(value) = self.entry(other, column) else {
                continue;
            };
            let old = std::mem::take(&mut self.rows[other]);
            self.open.remove(&(old.len(), other));
            let new = combined(&old, &pivot_row, value / pivot, column);
            for (c, _) in &new {
                if old.binary_search_by_key(c, |(c, _)| *c).is_err() {
                    self.in_column[*c].push(other);
                }
            }
            self.open.insert((new.len(), other));
            self.rows[other] = new;
        }
    }
}

/// `row - factor * pivot`, without the pivot's column.
fn combined(row: &SparseRow, pivot: &SparseRow, factor: f64, without: usize) -> SparseRow {
    let mut sum = Vec::with_capacity(row.len() + pivot.len());
    let (mut a, mut b) = (row.iter().peekable(), pivot.iter().peekable());
    loop {
        let entry = match (a.peek(), b.peek()) {
            (Some((i, x)), Some((j, y))) if i == j => {
                let entry = (*i, x - factor * y);
                a.next();
                b.next();
                entry
            }
            (Some((i, x)), Some((j, _))) if i < j => {
                let entry = (*i, *x);
                a.next();
                entry
            }
            (Some((i, x)), None) => {
                let entry = (*i, *x);
                a.next();
                entry
            }
            (_, Some((j, y))) => {
                let entry = (*j, -factor * y);
                b.next();
                entry
            }
            (None, None) => break,
        };
        if entry.0 != without && entry.1 != 0.0 {
            sum.push(entry);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use kempe_number::Random;

    /// Random sparse rows, and combinations of them: the rank is known as long as the rows are few enough.
    #[test]
    fn combinations_of_rows_add_nothing() {
        let mut random = Random(7);
        for round in 0..60 {
            let columns = 20 + round;
            let independent = columns / 2;
            let mut rows: Vec<SparseRow> = (0..independent)
                .map(|k| {
                    // A diagonal keeps them independent.
                    let mut row = vec![(k, 1.0 + random.uniform())];
                    for _ in 0..3 {
                        let column = independent
                            + (random.uniform() * (columns - independent) as f64) as usize;
                        if row.iter().all(|(c, _)| *c != column) {
                            row.push((column, 2.0 * random.uniform() - 1.0));
                        }
                    }
                    row.sort_by_key(|(c, _)| *c);
                    row
                })
                .collect();
            for k in 1..independent / 2 {
                let (a, b) = (rows[k - 1].clone(), rows[2 * k].clone());
                rows.push(combined(&a, &b, -0.7, usize::MAX));
            }
            assert_eq!(
                rank(rows, columns, RANK_TOLERANCE),
                independent,
                "{columns}"
            );
        }
    }

    #[test]
    fn nothing_and_noise_have_no_rank() {
        assert_eq!(rank(Vec::new(), 3, RANK_TOLERANCE), 0);
        assert_eq!(rank(vec![Vec::new(), vec![(1, 0.0)]], 3, RANK_TOLERANCE), 0);
        let noisy = vec![vec![(0, 1.0), (1, 2.0)], vec![(0, 0.5), (1, 1.0 + 1e-12)]];
        assert_eq!(rank(noisy, 2, RANK_TOLERANCE), 1);
    }
}
