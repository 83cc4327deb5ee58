//! Tridiagonal systems.

use kempe_number::Number;

/// A row of a tridiagonal system.
#[derive(Clone, Copy, Debug)]
pub struct Tridiagonal<T> {
    /// Left of the diagonal; not looked at in the first row.
    pub lower: T,
    /// On the diagonal.
    pub diagonal: T,
    /// Right of it; not looked at in the last row.
    pub upper: T,
    /// Right-hand side.
    pub right: T,
}

/// Solves a tridiagonal system by elimination, for rows that are dominated by their diagonals.
pub fn solve_tridiagonal<T: Number>(mut rows: Vec<Tridiagonal<T>>) -> Vec<T> {
    for i in 1..rows.len() {
        let above = rows[i - 1];
        let row = &mut rows[i];
        let factor = row.lower / above.diagonal;
        row.diagonal -= factor * above.upper;
        row.right -= factor * above.right;
    }
    let mut below: Option<T> = None;
    let mut found: Vec<T> = rows
        .iter()
        .rev()
        .map(|row| {
            let right = match below {
                None => row.right,
                Some(next) => row.right - row.upper * next,
            };
            *below.insert(right / row.diagonal)
        })
        .collect();
    found.reverse();
    found
}
