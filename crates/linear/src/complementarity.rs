//! Linear complementarity problems: pairs of unknowns that are not negative and one of which is zero.
//!
//! `w = M z + q`, `w >= 0`, `z >= 0`, `w z = 0` in every pair, by C. E. Lemke's method (1965): a further unknown makes all `w` positive
//! at first and is driven out by exchanging one unknown after the other. Ties are broken by order (lexicographically), so that no
//! exchange comes twice.

/// An entry of the table this small is none: columns are of unit size in what is solved here.
const NONE: f64 = 1e-11;
/// Ratios that differ by less than this are the same, where the largest number on the right is 1.
const SAME: f64 = 4e-15;
/// Exchanges for every pair, at most: far more than are ever needed.
const EXCHANGES: usize = 50;

/// The unknowns `z` of a problem whose matrix has these entries (row, column), of about the size 1. Nothing where the method ends on a
/// ray: for matrices of contacts that says that there is no solution, or that it is not found by going on from where all is open.
pub fn complementary(entry: impl Fn(usize, usize) -> f64, q: &[f64]) -> Option<Vec<f64>> {
    let n = q.len();
    if !q.iter().all(|x| x.is_finite()) {
        return None;
    }
    let largest = q.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    if q.iter().all(|x| *x >= 0.0) {
        return Some(vec![0.0; n]);
    }
    let mut table = Table::new(n, entry, q, largest);
    // The most negative row lets the further unknown in; the last of several, which is the least in that order.
    let mut row = (0..n).reduce(|best, k| {
        let [own, known] = [k, best].map(|k| table.rows[k][table.right()]);
        if own <= known + SAME { k } else { best }
    })?;
    let mut enters = table.further();
    for _ in 0..EXCHANGES * (n + 1) {
        let leaves = table.exchange(row, enters);
        if leaves == table.further() {
            return Some(table.found(largest));
        }
        // Its partner comes in.
        enters = if leaves < n { leaves + n } else { leaves - n };
        row = table.first_to_zero(enters)?;
    }
    None
}

/// The equations, solved for the unknowns of the basis. Columns: `w`, `z`, the further unknown, and what is on the right.
struct Table {
    n: usize,
    rows: Vec<Vec<f64>>,
    /// Which unknown each row tells.
    basis: Vec<usize>,
}

impl Table {
    fn new(n: usize, entry: impl Fn(usize, usize) -> f64, q: &[f64], largest: f64) -> Self {
        let row = |i: usize| {
            let w = (0..n).map(|j| if i == j { 1.0 } else { 0.0 });
            let z = (0..n).map(|j| -entry(i, j));
            w.chain(z).chain([-1.0, q[i] / largest]).collect()
        };
        Self {
            n,
            rows: (0..n).map(row).collect(),
            basis: (0..n).collect(),
        }
    }

    fn further(&self) -> usize {
        2 * self.n
    }

    fn right(&self) -> usize {
        2 * self.n + 1
    }

    /// Brings an unknown into the basis in the place of that of a row, which is told.
    fn exchange(&mut self, row: usize, enters: usize) -> usize {
        let pivot = self.rows[row][enters];
        for x in &mut self.rows[row] {
            *x /= pivot;
        }
        let own = self.rows[row].clone();
        for (k, other) in self.rows.iter_mut().enumerate() {
            let factor = other[enters];
            if k == row || factor == 0.0 {
                continue;
            }
            for (x, own) in other.iter_mut().zip(&own) {
                *x -= factor * own;
            }
            other[enters] = 0.0;
        }
        std::mem::replace(&mut self.basis[row], enters)
    }

    /// The row whose unknown comes to zero first while another one grows; that of the further unknown before others.
    fn first_to_zero(&self, grows: usize) -> Option<usize> {
        let falls = (0..self.n).filter(|k| self.rows[*k][grows] > NONE);
        let mut left: Vec<usize> = falls.collect();
        // The right-hand side, then the columns of `w`: one after the other until no two are the same.
        for column in std::iter::once(self.right()).chain(0..self.n) {
            let ratio = |k: &usize| {
                let ratio = self.rows[*k][column] / self.rows[*k][grows];
                // What is just below zero on the right is none.
                if column == self.right() {
                    ratio.max(0.0)
                } else {
                    ratio
                }
            };
            let least = left.iter().map(ratio).fold(f64::INFINITY, f64::min);
            let slack = SAME * (1.0 + least.abs());
            left.retain(|k| ratio(k) <= least + slack);
            if column == self.right()
                && let Some(row) = left.iter().find(|k| self.basis[**k] == self.further())
            {
                return Some(*row);
            }
            if left.len() <= 1 {
                break;
            }
        }
        left.first().copied()
    }

    fn found(&self, largest: f64) -> Vec<f64> {
        let mut z = vec![0.0; self.n];
        for (row, unknown) in self.rows.iter().zip(&self.basis) {
            if (self.n..self.further()).contains(unknown) {
                z[unknown - self.n] = row[self.right()].max(0.0) * largest;
            }
        }
        z
    }
}
