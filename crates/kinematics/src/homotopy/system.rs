//! The bilinear system of a block, its start system, and all its paths.

use std::ops::ControlFlow;

use super::equations::Bilinear;
use super::random::Random;
use super::tracker::{CARES, Care, End, Tracker};
use super::{LARGEST, PathReport};
use crate::complex_linear::{Affine, C, solve};

/// Most swaps of dependent and free unknowns.
const SWAPS: usize = 8;
/// Smallest coefficient (lengths in mechanism sizes) by which a dependent unknown is swapped for a free one.
const SWAP_PIVOT: f64 = 0.02;

/// The system in the free variables that need the fewest paths, with their number. Which variables are eliminated is
/// a matter of choice: a link's unit length feels only the free links of its own loops, so a good choice leaves most
/// equations with few variables. Dependent and free variables are swapped while that saves paths.
pub(super) fn sparsest(
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

/// 2 d bilinear equations in d plain and d conjugate unknowns.
pub(super) struct System {
    pub(super) d: usize,
    pub(super) target: Vec<Bilinear>,
    /// Bits of the unknowns that the plain and the conjugate factors of every equation feel.
    pub(super) supports: Vec<[u32; 2]>,
}

/// The product start system, one pair of linear factors per equation, each in the unknowns that the equation feels.
pub(super) struct Start {
    pub(super) gamma: C,
    pub(super) plain: Vec<Affine>,
    pub(super) conjugate: Vec<Affine>,
}

impl System {
    pub(super) fn new(solved: &[Affine], bilinear: &[Bilinear], d: usize) -> Self {
        let conjugate: Vec<Affine> = solved.iter().map(Affine::conj).collect();
        let target: Vec<Bilinear> = bilinear
            .iter()
            .map(|e| {
                let terms = e.0.iter().map(|(l, r)| {
                    (
                        l.substitute(solved).cleaned(),
                        r.substitute(&conjugate).cleaned(),
                    )
                });
                Bilinear(terms.collect())
            })
            .collect();
        let bits = |f: &Affine| {
            let felt = f.0[..d]
                .iter()
                .enumerate()
                .filter(|(_, c)| c.norm_sqr() > 0.0);
            felt.fold(0_u32, |bits, (j, _)| bits | 1 << j)
        };
        let supports = target
            .iter()
            .map(|e| {
                (e.0.iter()).fold([0, 0], |[l, r], (left, right)| {
                    [l | bits(left), r | bits(right)]
                })
            })
            .collect();
        Self {
            d,
            target,
            supports,
        }
    }

    fn entries(&self) -> u32 {
        self.supports
            .iter()
            .map(|[l, r]| l.count_ones() + r.count_ones())
            .sum()
    }

    /// How many start points there are.
    fn paths(&self) -> usize {
        subsets(2 * self.d, self.d)
            .iter()
            .filter(|s| self.is_start(s))
            .count()
    }

    /// Whether the factors chosen by a subset of the equations have a common zero: with random coefficients, if the
    /// unknowns can be matched to them.
    fn is_start(&self, subset: &[bool]) -> bool {
        [(0, true), (1, false)].into_iter().all(|(group, wanted)| {
            let chosen = self
                .supports
                .iter()
                .zip(subset)
                .filter(|(_, s)| **s == wanted);
            matches_all(chosen.map(|(support, _)| support[group]), self.d)
        })
    }

    /// Follows every path and returns the distinct regular end points with what the paths did; `None` when stopped.
    pub(super) fn follow_all(
        &self,
        work: &mut f64,
        told: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Option<(Vec<Vec<C>>, PathReport)> {
        let d = self.d;
        let n = 2 * d;
        let mut random = Random(0xd134_2543_de82_ef95);
        let mut factor = |support: u32| {
            let mut f = Affine((0..=d).map(|_| random.unit()).collect());
            for (j, c) in f.0[..d].iter_mut().enumerate() {
                if support >> j & 1 == 0 {
                    *c = C::zero();
                }
            }
            f
        };
        let start = Start {
            plain: self.supports.iter().map(|s| factor(s[0])).collect(),
            conjugate: self.supports.iter().map(|s| factor(s[1])).collect(),
            gamma: random.unit(),
        };
        let subsets: Vec<Vec<bool>> = subsets(n, d)
            .into_iter()
            .filter(|s| self.is_start(s))
            .collect();
        let mut tracker = Tracker::new(self, &start);
        let mut ends: Vec<End> = Vec::with_capacity(subsets.len());
        let follow = |tracker: &mut Tracker, subset: &[bool], care: Care, work: &mut f64| {
            match self.start_point(&start, subset) {
                Some(x) if *work > 0.0 => {
                    let before = tracker.solves;
                    let end = tracker.follow(x, care);
                    // A solve costs about n^3 / 3 products.
                    *work -= (tracker.solves - before) as f64 * (n * n * n) as f64 / 3.0;
                    end
                }
                _ => End::Lost,
            }
        };
        for (done, subset) in subsets.iter().enumerate() {
            told(done as f64 / subsets.len() as f64).continue_value()?;
            ends.push(follow(&mut tracker, subset, CARES[0], work));
        }
        // Paths that were lost, and all that ended at one point, are followed again with more care.
        let again: Vec<usize> = (0..ends.len())
            .filter(|&i| match &ends[i] {
                End::Lost => true,
                End::Infinite => false,
                End::Finite(x) => (0..ends.len())
                    .any(|j| j != i && matches!(&ends[j], End::Finite(y) if is_same(x, y))),
            })
            .collect();
        for i in again {
            told(1.0).continue_value()?;
            ends[i] = follow(&mut tracker, &subsets[i], CARES[1], work);
        }
        let mut report = PathReport {
            paths: subsets.len(),
            exhausted: *work <= 0.0,
            ..PathReport::default()
        };
        let mut found: Vec<Vec<C>> = Vec::new();
        for end in ends {
            match end {
                End::Infinite => report.infinite += 1,
                End::Lost => report.lost += 1,
                // Two paths at one point: a multiple solution, or a path that jumped.
                End::Finite(x) if found.iter().any(|y| is_same(&x, y)) => report.lost += 1,
                End::Finite(x) => found.push(x),
            }
        }
        report.finite = found.len();
        Some((found, report))
    }

    fn start_point(&self, start: &Start, subset: &[bool]) -> Option<Vec<C>> {
        let d = self.d;
        let mut x = Vec::with_capacity(2 * d);
        for (factors, wanted) in [(&start.plain, true), (&start.conjugate, false)] {
            let rows = factors
                .iter()
                .zip(subset)
                .filter(|(_, s)| **s == wanted)
                .map(|(f, _)| f);
            let mut a = Vec::with_capacity(d * d);
            let mut b = Vec::with_capacity(d);
            for row in rows {
                a.extend_from_slice(&row.0[..d]);
                b.push(-row.0[d]);
            }
            if !solve(&mut a, &mut b, d) {
                return None;
            }
            x.extend(b);
        }
        Some(x)
    }
}

/// Whether `d` unknowns can be matched one to one to functions that feel the unknowns of their bits.
fn matches_all(supports: impl Iterator<Item = u32>, d: usize) -> bool {
    fn place(
        row: usize,
        rows: &[u32; LARGEST],
        owner: &mut [usize; LARGEST],
        seen: &mut u32,
    ) -> bool {
        let mut open = rows[row] & !*seen;
        while open != 0 {
            let column = open.trailing_zeros() as usize;
            *seen |= 1 << column;
            if owner[column] == usize::MAX || place(owner[column], rows, owner, seen) {
                owner[column] = row;
                return true;
            }
            open = rows[row] & !*seen;
        }
        false
    }
    let mut rows = [0; LARGEST];
    let mut count = 0;
    for support in supports {
        rows[count] = support;
        count += 1;
    }
    let mut owner = [usize::MAX; LARGEST];
    count == d && (0..count).all(|row| place(row, &rows, &mut owner, &mut 0))
}

fn is_same(x: &[C], y: &[C]) -> bool {
    (x.iter().zip(y)).all(|(a, b)| (*a - *b).norm() < 1e-6 * (1.0 + a.norm()))
}

/// All ways to mark `d` of `n`.
fn subsets(n: usize, d: usize) -> Vec<Vec<bool>> {
    let mut all = Vec::new();
    let mut chosen: Vec<usize> = (0..d).collect();
    loop {
        let mut marks = vec![false; n];
        for &i in &chosen {
            marks[i] = true;
        }
        all.push(marks);
        let Some(place) = (0..d).rev().find(|&i| chosen[i] < n - d + i) else {
            return all;
        };
        chosen[place] += 1;
        for later in place + 1..d {
            chosen[later] = chosen[later - 1] + 1;
        }
    }
}
