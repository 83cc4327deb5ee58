//! Functions given piece by piece.

use crate::Number;

/// Functions given by so many pieces, that go on as their outer pieces beyond them. `past(k)` is how far the number lies past
/// the start of piece `k`, rising from piece to piece; `piece(k)` is what the functions are there. A number whose parts lie
/// in several pieces (lanes, the bounds of an interval) takes each from its own.
pub fn piecewise<T: Number, const N: usize>(
    pieces: usize,
    past: &impl Fn(usize) -> T,
    piece: &impl Fn(usize) -> [T; N],
) -> [T; N] {
    between((0, pieces.max(1)), past, piece)
}

/// The pieces from `first` until before `end`.
fn between<T: Number, const N: usize>(
    (first, end): (usize, usize),
    past: &impl Fn(usize) -> T,
    piece: &impl Fn(usize) -> [T; N],
) -> [T; N] {
    if end - first <= 1 {
        return piece(first);
    }
    let middle = first.midpoint(end);
    let from = past(middle);
    let upper = || between((middle, end), past, piece);
    let lower = || between((first, middle), past, piece);
    match from.nonnegative() {
        Some(true) => upper(),
        Some(false) => lower(),
        None => {
            let (upper, lower) = (upper(), lower());
            std::array::from_fn(|k| from.choose(upper[k], lower[k]))
        }
    }
}
