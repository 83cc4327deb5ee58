//! The bilinear system of a block, and the product system from which its paths start.

use kempe_linear::{Affine, C, solve_complex};

/// Most plain unknowns of a system for which paths are counted.
pub(crate) const LARGEST: usize = 8;

/// A bilinear equation: the sum of products of a plain and a conjugate affine function.
#[derive(Clone, Debug)]
pub struct Bilinear(pub Vec<(Affine, Affine)>);

/// 2 d bilinear equations in d plain and d conjugate unknowns.
pub(crate) struct System {
    pub(crate) d: usize,
    pub(crate) target: Vec<Bilinear>,
    /// Bits of the unknowns that the plain and the conjugate factors of every equation feel.
    pub(crate) supports: Vec<[u32; 2]>,
}

/// The product start system, one pair of linear factors per equation, each in the unknowns that the equation feels.
pub(crate) struct Start {
    pub(crate) gamma: C,
    pub(crate) plain: Vec<Affine>,
    pub(crate) conjugate: Vec<Affine>,
}

impl System {
    pub(crate) fn new(solved: &[Affine], bilinear: &[Bilinear], d: usize) -> Self {
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

    pub(crate) fn entries(&self) -> u32 {
        self.supports
            .iter()
            .map(|[l, r]| l.count_ones() + r.count_ones())
            .sum()
    }

    /// How many start points there are.
    pub(crate) fn paths(&self) -> usize {
        subsets(2 * self.d, self.d)
            .iter()
            .filter(|s| self.is_start(s))
            .count()
    }

    /// Whether the factors chosen by a subset of the equations have a common zero: with random coefficients, if the
    /// unknowns can be matched to them.
    pub(crate) fn is_start(&self, subset: &[bool]) -> bool {
        [(0, true), (1, false)].into_iter().all(|(group, wanted)| {
            let chosen = self
                .supports
                .iter()
                .zip(subset)
                .filter(|(_, s)| **s == wanted);
            matches_all(chosen.map(|(support, _)| support[group]), self.d)
        })
    }

    pub(crate) fn start_point(&self, start: &Start, subset: &[bool]) -> Option<Vec<C>> {
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
                b.push([-row.0[d]]);
            }
            if !solve_complex(&mut a, &mut b, d) {
                return None;
            }
            x.extend(b.as_flattened());
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

/// All ways to mark `d` of `n`.
pub(crate) fn subsets(n: usize, d: usize) -> Vec<Vec<bool>> {
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
