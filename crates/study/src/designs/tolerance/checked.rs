//! Whether lanes are right: some pieces are moved by themselves, too.

use kempe_measure::side_by_side::TOGETHER;

use super::linear::Linear;
use super::rounding::{ROUNDING, scale_of};
use super::sampled::{CHECKED, Question};
use super::summary::Summary;
use crate::designs::lanes::{InLanes, PIECES};

/// What lanes miss by more than this part of a number's deviation, they do not tell.
const LANES_AGREE: f64 = 0.05;
/// Of so many pieces lanes tell how much numbers differ.
const SPREAD: usize = 512;

/// What lanes tell of a piece.
struct ByLanes {
    numbers: Vec<f64>,
    /// Whether it is to be moved by itself all the same.
    doubtful: bool,
}

/// What lanes tell of pieces with these values.
fn by_lanes(lanes: &InLanes, values: &[Vec<f64>]) -> Vec<ByLanes> {
    let mut scratch = lanes.scratch();
    let mut all = Vec::with_capacity(values.len());
    for some in values.chunks(PIECES) {
        let drawn = |piece: usize, k: usize| some[piece][k];
        lanes.pieces(some.len(), drawn, &mut scratch, |from, found, _| {
            let lanes = 0..TOGETHER.min(some.len() - from);
            all.extend(lanes.map(|lane| ByLanes {
                numbers: found.numbers.iter().map(|n| n.0[lane]).collect(),
                doubtful: found.doubtful[lane],
            }));
        });
    }
    all
}

/// By number: by how much lanes miss what the first pieces tell that are moved by themselves; none where lanes do not tell it. What they
/// miss by too much they tell no more. Of few pieces a number may happen to be nearly the same, and a shift of all is no deviation: how much it
/// differs many tell, in lanes.
pub(super) fn check(
    question: &mut Question<'_, '_>,
    linear: &[Linear],
    size: f64,
) -> Vec<Option<f64>> {
    let mut missed = vec![None; linear.len()];
    let Some(mut lanes) = question.lanes.take() else {
        return missed;
    };
    // What lanes miss of the file's own design they miss of all pieces nearly alike.
    let own = by_lanes(&lanes, std::slice::from_ref(&question.own));
    for (number, (tells, linear)) in lanes.numbers.iter_mut().zip(linear).enumerate() {
        if let Some((_, more)) = tells {
            *more = linear.own - own[0].numbers[number];
        }
    }
    let values: Vec<Vec<f64>> = (0..SPREAD).map(|piece| question.values(piece)).collect();
    let found = by_lanes(&lanes, &values);
    let numbers: Vec<usize> = (0..linear.len()).collect();
    let told = || values.iter().zip(&found).filter(|(_, it)| !it.doubtful);
    let checked = told().take(CHECKED.min(question.samples));
    let exact = checked.filter_map(|(v, it)| Some((question.piece(v, &numbers, &[]).ok()?.0, it)));
    let exact: Vec<(Vec<f64>, &ByLanes)> = exact.collect();
    for (number, tells) in lanes.numbers.iter_mut().enumerate() {
        if tells.is_none() {
            continue;
        }
        let (own, quantity) = (linear[number].own, &question.bench.numbers[number]);
        let misses = exact.iter().map(|(exact, it)| {
            let (exact, found) = (exact[number], it.numbers[number]);
            match (exact.is_nan(), found.is_nan()) {
                // Neither knows it.
                (true, true) => 0.0,
                (false, false) => (exact - found).abs(),
                _ => f64::INFINITY,
            }
        });
        let largest = misses.fold(0.0, f64::max);
        let all: Vec<f64> = told().map(|(_, it)| it.numbers[number]).collect();
        let spread = Summary::new(&all).map_or(0.0, |it| it.deviation);
        let rounding = ROUNDING * own.abs().max(scale_of(quantity.dimension, size));
        match largest <= (LANES_AGREE * spread).max(rounding) && own.is_finite() {
            true => missed[number] = Some(largest),
            false => *tells = None,
        }
    }
    question.lanes = Some(lanes);
    missed
}
