//! What it brings to ease one limit alone, where the multipliers of a place are not the only ones.
//!
//! Where more things hold a place than it has freedoms, as where a limit and the corner of a goal do the same, several sets of multipliers
//! meet the conditions of first order. By how much the goal falls when one limit is eased is the least that any of them tells (J. Gauvin
//! 1979): that of the linear programme in which it is eased.

use crate::quadratic::{Minimum, Quadratic, minimise};
use crate::space::Space;

use super::local::{Local, Of};

/// By how much a limit is eased, in its scale, or a bound, in parts of the box.
const EASED: f64 = 1e-5;
/// What holds the place holds it to so much, in its scale: a violation of rounding size would be eased away, too, and the penalty's weight is large.
const MET: f64 = 1e-8;
/// What counts as no multiplier.
const NOTHING: f64 = 1e-9;
/// Multipliers that promise no more than this much above what easing brings are right.
const RIGHT: f64 = 1e-2;

/// Lessens the multipliers of rows of a place's programme to what easing each limit and each bound brings by itself.
pub(super) fn lessen(local: &Local, weight: f64, space: &Space, shares: &mut [f64]) {
    let mut programme = local.flat(weight, space);
    let rows = programme.rows.iter_mut();
    rows.filter(|row| row.limit.abs() <= MET)
        .for_each(|row| row.limit = 0.0);
    let told = shares.to_vec();
    for rows in limits(local, shares.len()) {
        let share: f64 = rows.iter().map(|row| told[*row]).sum();
        if !(share > NOTHING) {
            continue;
        }
        // Between two steps: the first may be taken up by what the place is off by.
        let [Some(once), Some(twice)] = [1.0, 2.0].map(|steps| {
            let mut eased = programme.clone();
            let rows = rows.iter();
            rows.for_each(|row| eased.rows[*row].limit += steps * EASED);
            minimise(&eased).ok().map(|it| value(&eased, &it))
        }) else {
            continue;
        };
        let brings = ((once - twice) / EASED).max(0.0);
        if brings < (1.0 - RIGHT) * share {
            let part = brings / share;
            let part = if brings > NOTHING { part } else { 0.0 };
            rows.iter().for_each(|row| shares[*row] *= part);
        }
    }
}

/// The rows of every constraint, and of every bound.
fn limits(local: &Local, rows: usize) -> Vec<Vec<usize>> {
    let mut all: Vec<(usize, Vec<usize>)> = Vec::new();
    for (row, part) in local.parts.iter().enumerate() {
        let Of::Constraint(k) = part.of else { continue };
        match all.iter_mut().find(|(known, _)| *known == k) {
            Some((_, rows)) => rows.push(row),
            None => all.push((k, vec![row])),
        }
    }
    let bounds = local.parts.len()..rows - usize::from(local.has_constraints());
    all.into_iter()
        .map(|(_, rows)| rows)
        .chain(bounds.map(|row| vec![row]))
        .collect()
}

fn value(programme: &Quadratic, minimum: &Minimum) -> f64 {
    let levels = programme.weights.iter().zip(&minimum.levels);
    let n = minimum.step.len();
    let bent: f64 = (0..n)
        .map(|k| programme.hessian[k * n + k] * minimum.step[k] * minimum.step[k])
        .sum();
    levels.map(|(weight, level)| weight * level).sum::<f64>() + 0.5 * bent
}
