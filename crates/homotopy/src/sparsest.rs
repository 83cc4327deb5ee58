//! The choice of free variables that needs the fewest paths.

use crate::system::{Bilinear, System};
use kempe_linear::{Affine, C};

/// Most swaps of dependent and free unknowns.
const SWAPS: usize = 8;
/// Smallest coefficient (lengths in mechanism sizes) by which a dependent unknown is swapped for a free one.
const SWAP_PIVOT: f64 = 0.02;

/// The system in the free variables that need the fewest paths, with their number. Which variables are eliminated is
/// a matter of choice: a link's unit length feels only the free links of its own loops, so a good choice leaves most
/// equations with few variables. Dependent and free variables are swapped while that saves paths.
pub(crate) fn sparsest(
    solved: Vec<Affine>,
    bilinear: &[Bilinear],
    d: usize,
) -> (Vec<Affine>, System, usize) {
    let mut best_solved = solved;
    let mut best = System::new(&best_solved, bilinear, d);
    let mut fewest = best.paths();
    for _ in 0..SWAPS {
        let mut better: Option<(Vec<Affine>, System, usize)> = None;
        for dependent in 0..best_solved.len() {
            for free in 0..d {
                let Some(swapped) = swap(&best_solved, dependent, free) else {
                    continue;
                };
                let system = System::new(&swapped, bilinear, d);
                let now = better.as_ref().map_or(fewest, |b| b.2);
                // Cheap to see: fewer entries are a precondition in practice.
                if system.entries() > best.entries() {
                    continue;
                }
                let count = system.paths();
                if count < now {
                    better = Some((swapped, system, count));
                }
            }
        }
        match better {
            Some((solved, system, count)) => (best_solved, best, fewest) = (solved, system, count),
            None => break,
        }
    }
    (best_solved, best, fewest)
}

/// Makes variable `dependent` the free variable number `free`; `None` where it is free already or hardly depends on it.
fn swap(solved: &[Affine], dependent: usize, free: usize) -> Option<Vec<Affine>> {
    let d = solved[dependent].0.len() - 1;
    let row = &solved[dependent].0;
    let is_free =
        row[d] == C::zero() && row[..d].iter().filter(|c| c.norm_sqr() > 0.0).count() == 1;
    let pivot = row[free];
    if is_free || pivot.norm_sqr() < SWAP_PIVOT * SWAP_PIVOT {
        return None;
    }
    // dependent = sum a_j y_j + c  =>  y_free = (dependent - sum of the others - c) / a_free.
    let inverse = pivot.recip();
    let mut y: Vec<Affine> = (0..d)
        .map(|j| {
            let mut f = Affine::constant(d, C::zero());
            f.add(j, C::one());
            f
        })
        .collect();
    y[free] = Affine(
        (row.iter().enumerate())
            .map(|(j, c)| if j == free { inverse } else { -(*c * inverse) })
            .collect(),
    );
    Some(solved.iter().map(|f| f.substitute(&y).cleaned()).collect())
}
