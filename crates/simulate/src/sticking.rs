//! Friction in several places that are at rest at once: what holds each of them, and which give way.
//!
//! A place is told by a row: how fast it slides by the coordinates that are let go, seen so that the product of two rows is what masses
//! yield in one place to a unit of force in the other. Forces act along their rows and are limited.

use kempe_linear::Lu;

use crate::vector::dot;

/// A row that is this part of its length off what others span lies in it.
const DEPENDENT: f64 = 1e-9;
/// Passes over the places, at most, and when they are settled.
const PASSES: usize = 20_000;
const SETTLED: f64 = 1e-15;
/// A limit that is none is this part of the largest: shares stay numbers.
const NO_LIMIT: f64 = 1e-30;

/// Takes from a vector what lies in the span of orthonormal ones: twice, as the first time leaves rounding.
pub(crate) fn leave_out(span: &[Vec<f64>], from: &mut [f64]) {
    for _ in 0..2 {
        for e in span {
            let part = dot(e, from);
            for (x, e) in from.iter_mut().zip(e) {
                *x -= part * e;
            }
        }
    }
}

/// Orthonormal vectors that span some of the rows besides those of `span`, which they follow, and which of the rows are independent: the
/// longest first.
pub(crate) fn spanned(
    rows: &[Vec<f64>],
    among: &[usize],
    mut span: Vec<Vec<f64>>,
) -> (Vec<Vec<f64>>, Vec<usize>) {
    let mut left: Vec<(usize, Vec<f64>, f64)> = (among.iter())
        .map(|k| (*k, rows[*k].clone(), dot(&rows[*k], &rows[*k])))
        .collect();
    let mut independent = Vec::new();
    for (_, row, _) in &mut left {
        leave_out(&span, row);
    }
    loop {
        left.retain(|(_, row, whole)| dot(row, row) > DEPENDENT * DEPENDENT * whole);
        let share = |(_, row, whole): &(usize, Vec<f64>, f64)| dot(row, row) / whole;
        let next = (0..left.len()).max_by(|a, b| share(&left[*a]).total_cmp(&share(&left[*b])));
        let Some(next) = next else { break };
        let (k, row, _) = left.swap_remove(next);
        let long = dot(&row, &row).sqrt();
        span.push(row.iter().map(|x| x / long).collect());
        independent.push(k);
        let last = &span[span.len() - 1..];
        for (_, row, _) in &mut left {
            leave_out(last, row);
        }
    }
    (span, independent)
}

/// The forces along independent rows that together are a vector, which lies in their span.
pub(crate) fn together(
    rows: &[Vec<f64>],
    independent: &[usize],
    target: &[f64],
) -> Option<Vec<f64>> {
    let products: Vec<f64> = independent.iter().map(|k| dot(&rows[*k], target)).collect();
    yielding(rows, independent, products)
}

/// The forces along independent rows by which these accelerate so.
pub(crate) fn yielding(
    rows: &[Vec<f64>],
    independent: &[usize],
    accelerations: Vec<f64>,
) -> Option<Vec<f64>> {
    // Rows of unit length: places that turn and such as slide have nothing to do with each other's units.
    let long = |k: usize| dot(&rows[k], &rows[k]).sqrt();
    let long: Vec<f64> = independent.iter().map(|k| long(*k)).collect();
    let mut factors = Lu::new(independent.len());
    let entry = |i: usize, j: usize| {
        dot(&rows[independent[i]], &rows[independent[j]]) / (long[i] * long[j])
    };
    if !factors.factor(entry) {
        return None;
    }
    let mut forces = accelerations;
    for (force, long) in forces.iter_mut().zip(&long) {
        *force /= long;
    }
    factors.solve(&mut forces);
    for (force, long) in forces.iter_mut().zip(&long) {
        *force /= long;
    }
    Some(forces)
}

/// Shares a force that is needed among places that hold together: so that the largest part of its limit that any bears is least; then the
/// largest of the others, and so on. That is the only way where the rows are independent. When the largest part is one, they give way.
///
/// The largest part is `max(target v / sum(limit |row v|))` over all ways `v` to move (linear programming), and best where as many rows as
/// possible stand still.
pub(crate) fn shared(rows: &[Vec<f64>], limits: &[f64], target: &[f64]) -> Option<Vec<f64>> {
    let least = NO_LIMIT * limits.iter().copied().fold(1.0, f64::max);
    let limit = |k: usize| limits[k].max(least);
    let mut forces = vec![0.0; rows.len()];
    let mut target = target.to_vec();
    let mut left: Vec<usize> = (0..rows.len())
        .filter(|k| rows[*k].iter().any(|x| *x != 0.0))
        .collect();
    loop {
        let (span, independent) = spanned(rows, &left, Vec::new());
        if independent.len() == left.len() {
            for (k, force) in independent
                .iter()
                .zip(together(rows, &independent, &target)?)
            {
                forces[*k] = force;
            }
            return Some(forces);
        }
        let mut best: Option<(f64, Vec<f64>, Vec<f64>)> = None;
        subsets(&left, span.len() - 1, &mut |still| {
            let Some(way) = way(rows, still, &span) else {
                return;
            };
            let slides: Vec<f64> = (left.iter())
                .map(|k| {
                    let (along, long) = (dot(&rows[*k], &way), dot(&rows[*k], &rows[*k]).sqrt());
                    if along.abs() <= DEPENDENT * long {
                        0.0
                    } else {
                        along
                    }
                })
                .collect();
            let most: f64 = (left.iter().zip(&slides))
                .map(|(k, slides)| limit(*k) * slides.abs())
                .sum();
            let part = dot(&target, &way) / most;
            if best.as_ref().is_none_or(|(p, ..)| part.abs() > p.abs()) {
                best = Some((part, way, slides));
            }
        });
        let (part, _, slides) = best?;
        let mut still = Vec::new();
        for (k, slides) in left.iter().zip(slides) {
            if slides == 0.0 {
                still.push(*k);
                continue;
            }
            forces[*k] = part * limit(*k) * slides.signum();
            for (t, x) in target.iter_mut().zip(&rows[*k]) {
                *t -= forces[*k] * x;
            }
        }
        left = still;
    }
}

/// The direction in a span in which these rows stand still, if there is one alone.
fn way(rows: &[Vec<f64>], still: &[usize], span: &[Vec<f64>]) -> Option<Vec<f64>> {
    let (held, independent) = spanned(rows, still, Vec::new());
    if independent.len() != still.len() {
        return None;
    }
    let off = |e: &Vec<f64>| {
        let mut e = e.clone();
        leave_out(&held, &mut e);
        e
    };
    let free = span.iter().map(off);
    let mut longest = free.max_by(|a, b| dot(a, a).total_cmp(&dot(b, b)))?;
    let long = dot(&longest, &longest).sqrt();
    for x in &mut longest {
        *x /= long;
    }
    leave_out(&held, &mut longest);
    Some(longest)
}

/// Calls `take` with all subsets of a size.
fn subsets(of: &[usize], size: usize, take: &mut impl FnMut(&[usize])) {
    fn go(of: &[usize], size: usize, chosen: &mut Vec<usize>, take: &mut impl FnMut(&[usize])) {
        if size == 0 {
            return take(chosen);
        }
        for (k, one) in of.iter().enumerate() {
            if of.len() - k < size {
                break;
            }
            chosen.push(*one);
            go(&of[k + 1..], size - 1, chosen, take);
            chosen.pop();
        }
    }
    go(of, size, &mut Vec::new(), take);
}

/// Forces within limits that hold what they can: `free` are the accelerations along the rows without them. In every place the acceleration
/// is zero, or the force is at its limit against it. The accelerations are unique, whatever holds what (they make a convex function
/// least); found by passes over the places, one after the other, and then exactly for those that hold.
pub(crate) fn limited(rows: &[Vec<f64>], free: &[f64], limits: &[f64]) -> Vec<f64> {
    let n = rows.len();
    let matrix: Vec<Vec<f64>> = (rows.iter())
        .map(|a| rows.iter().map(|b| dot(a, b)).collect())
        .collect();
    let mut forces = vec![0.0_f64; n];
    let at_rest = |k: usize, forces: &[f64]| free[k] + dot(&matrix[k], forces);
    for _ in 0..PASSES {
        let mut settled = true;
        for k in 0..n {
            let left = at_rest(k, &forces);
            let new = match matrix[k][k] > 0.0 {
                true => (forces[k] - left / matrix[k][k]).clamp(-limits[k], limits[k]),
                false if left == 0.0 => 0.0,
                false => -limits[k] * left.signum(),
            };
            settled &= (new - forces[k]).abs() <= SETTLED * new.abs();
            forces[k] = new;
        }
        if settled {
            break;
        }
    }
    let inside: Vec<usize> = (0..n).filter(|k| forces[*k].abs() < limits[*k]).collect();
    let (_, independent) = spanned(rows, &inside, Vec::new());
    let left: Vec<f64> = (independent.iter())
        .map(|k| -at_rest(*k, &forces))
        .collect();
    if let Some(more) = yielding(rows, &independent, left) {
        let exact: Vec<f64> = (independent.iter().zip(&more))
            .map(|(k, more)| forces[*k] + more)
            .collect();
        let fits = |(k, exact): (&usize, &f64)| exact.abs() <= limits[*k];
        if independent.iter().zip(&exact).all(fits) {
            for (k, exact) in independent.iter().zip(exact) {
                forces[*k] = exact;
            }
        }
    }
    forces
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers from -1 to 1.
    fn numbers(seed: &mut u64) -> f64 {
        *seed = seed
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (*seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    #[test]
    fn what_moves_as_one_is_held_by_equal_parts() {
        let rows = vec![vec![2.0], vec![-1.0], vec![0.5]];
        let forces = shared(&rows, &[1.0, 3.0, 2.0], &[3.0]).unwrap();
        // 2 + 3 + 1 at most: each bears the half.
        for (force, wanted) in forces.iter().zip([0.5, -1.5, 1.0]) {
            assert!((force - wanted).abs() < 1e-15, "{forces:?}");
        }
    }

    #[test]
    fn shares_bear_what_is_needed_and_none_can_bear_less() {
        let mut seed = 7;
        for (dimension, count) in [(1, 4), (2, 3), (2, 6), (3, 5), (3, 3), (4, 7)] {
            for _ in 0..50 {
                let rows: Vec<Vec<f64>> = (0..count)
                    .map(|_| (0..dimension).map(|_| numbers(&mut seed)).collect())
                    .collect();
                let limits: Vec<f64> = (0..count).map(|_| 1.1 + numbers(&mut seed)).collect();
                let target: Vec<f64> = (0..dimension).map(|_| numbers(&mut seed)).collect();
                let forces = shared(&rows, &limits, &target).unwrap();
                for (d, target) in target.iter().enumerate() {
                    let sum: f64 = rows.iter().zip(&forces).map(|(r, f)| r[d] * f).sum();
                    assert!((sum - target).abs() < 1e-10, "{sum} {target}");
                }
                let part = |f: &[f64]| {
                    let parts = f.iter().zip(&limits).map(|(f, l)| f.abs() / l);
                    parts.fold(0.0, f64::max)
                };
                let most = part(&forces);
                // Held with a little less they would give way, with a little more they do not: by the other function.
                for (scale, holds) in [(most * 0.999, false), (most * 1.001, true)] {
                    let limits: Vec<f64> = limits.iter().map(|l| l * scale).collect();
                    let free: Vec<f64> = rows.iter().map(|r| dot(r, &target)).collect();
                    let found = limited(&rows, &free, &limits);
                    let left: f64 = (0..dimension)
                        .map(|d| {
                            let sum: f64 = rows.iter().zip(&found).map(|(r, f)| r[d] * f).sum();
                            (target[d] + sum).abs()
                        })
                        .sum();
                    assert_eq!(left < 1e-9, holds, "{dimension} {count} {left:e}");
                }
            }
        }
    }

    #[test]
    fn limited_forces_oppose_what_slides() {
        let mut seed = 3;
        for _ in 0..200 {
            let rows: Vec<Vec<f64>> = (0..5)
                .map(|_| (0..3).map(|_| numbers(&mut seed)).collect())
                .collect();
            let free: Vec<f64> = {
                let by: Vec<f64> = (0..3).map(|_| numbers(&mut seed)).collect();
                rows.iter().map(|row| dot(row, &by)).collect()
            };
            let limits: Vec<f64> = (0..5).map(|_| 0.2 + 0.2 * numbers(&mut seed)).collect();
            let forces = limited(&rows, &free, &limits);
            for k in 0..5 {
                let left: f64 = free[k]
                    + (0..5)
                        .map(|j| dot(&rows[k], &rows[j]) * forces[j])
                        .sum::<f64>();
                assert!(forces[k].abs() <= limits[k]);
                let slides = left.abs() > 1e-9;
                assert!(
                    !slides || forces[k] == -limits[k] * left.signum(),
                    "{left} {forces:?}"
                );
            }
        }
    }
}
