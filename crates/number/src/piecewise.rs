//! Functions given piece by piece.

use crate::Number;

/// A function that is `piece(k)` between the knots `k` and `k + 1` (rising), and goes on as its outer pieces beyond them. A
/// number whose parts lie in several pieces (lanes, the bounds of an interval) takes each from its own.
///
/// With fewer than two knots there is one piece, `piece(0)`.
pub fn piecewise<T: Number>(knots: &[f64], x: T, piece: &impl Fn(usize) -> T) -> T {
    between(knots, (0, knots.len().saturating_sub(1).max(1)), x, piece)
}

/// The pieces from `first` until before `end`.
fn between<T: Number>(
    knots: &[f64],
    (first, end): (usize, usize),
    x: T,
    piece: &impl Fn(usize) -> T,
) -> T {
    if end - first <= 1 {
        return piece(first);
    }
    let middle = first.midpoint(end);
    (x - knots[middle]).choose_with(
        || between(knots, (middle, end), x, piece),
        || between(knots, (first, middle), x, piece),
    )
}
