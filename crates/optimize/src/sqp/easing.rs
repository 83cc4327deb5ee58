//! What it brings to ease one limit alone, where the multipliers of a place are not the only ones.
//!
//! Where more things hold a place than it has freedoms, as where a limit and the corner of a goal do the same, several sets of multipliers
//! meet the conditions of first order. By how much the goal falls when one limit is eased is the least that any of them tells (J. Gauvin
//! 1979). All of them are the given ones and a sum of those that meet the conditions of nothing (`kempe_linear::Span`): the least is
//! looked for among these, so that none misses the conditions by more than the given ones do.

use kempe_linear::Span;

use crate::quadratic::{Quadratic, Row, minimise};
use crate::space::Space;

use super::local::{Local, Of};
use super::vector::diagonal;

/// What holds the place holds it to so much, in its scale.
const MET: f64 = 1e-8;
/// What counts as no multiplier.
const NOTHING: f64 = 1e-9;
/// How much more the multipliers of one limit weigh than how far all of them are from the given ones.
const ALONE: f64 = 1e4;
/// Multipliers that promise no more than this much above what easing brings are right.
const RIGHT: f64 = 1e-6;

/// Lessens the multipliers of rows of a place's programme to what easing each limit and each bound brings by itself.
pub(super) fn lessen(local: &Local, weight: f64, space: &Space, shares: &mut [f64]) {
    let programme = local.flat(weight, space);
    let told = shares.to_vec();
    // The row that the violation is not negative by holds nothing.
    let rows = programme.rows.len() - usize::from(local.has_constraints());
    let held: Vec<usize> = (0..rows)
        .filter(|row| told[*row] > NOTHING || programme.rows[*row].limit.abs() <= MET)
        .collect();
    let largest = held.iter().map(|row| told[*row]).fold(0.0, f64::max);
    let change = |conditions: usize| {
        let row = |row: &usize| {
            let row = &programme.rows[*row];
            match row.normal.get(conditions) {
                Some(slope) => *slope,
                // The shares of the objective's pieces sum to one.
                None => f64::from(u8::from(row.level == Some(0))),
            }
        };
        held.iter().map(row).collect::<Vec<f64>>()
    };
    let conditions: Vec<Vec<f64>> = (0..=space.bounds.len()).map(change).collect();
    let free = Span::of(&conditions, held.len()).across();
    if free.is_empty() || !(largest > 0.0) {
        return;
    }
    for rows in limits(local, shares.len()) {
        let share: f64 = rows.iter().map(|row| told[*row]).sum();
        if !(share > NOTHING) {
            continue;
        }
        let along = |of: &dyn Fn(usize) -> f64| -> Vec<f64> {
            let sums = free.iter().map(|way| {
                let parts = way.iter().zip(&held);
                parts.map(|(x, row)| x * of(*row)).sum()
            });
            sums.collect()
        };
        let least = Quadratic {
            hessian: diagonal(free.len(), 1.0),
            slope: along(&|row| if rows.contains(&row) { ALONE } else { 0.0 }),
            weights: Vec::new(),
            rows: (held.iter())
                .map(|one| Row {
                    normal: along(&|row| if row == *one { -1.0 } else { 0.0 }),
                    limit: told[*one] / largest,
                    level: None,
                })
                .collect(),
        };
        let Ok(found) = minimise(&least) else {
            continue;
        };
        let less = |row: &usize| {
            let at = held.iter().position(|it| it == row)?;
            let moved = free.iter().zip(&found.step).map(|(way, x)| way[at] * x);
            Some((told[*row] + largest * moved.sum::<f64>()).max(0.0))
        };
        let own: Vec<f64> = rows.iter().map(|row| less(row).unwrap_or(0.0)).collect();
        let brings: f64 = own.iter().sum();
        if brings < (1.0 - RIGHT) * share {
            let part = if brings > NOTHING * largest.max(1.0) {
                1.0
            } else {
                0.0
            };
            let both = rows.iter().zip(&own);
            both.for_each(|(row, own)| shares[*row] = part * own);
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
