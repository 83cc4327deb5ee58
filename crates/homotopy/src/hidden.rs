//! The solutions of a system in two plain and two conjugate unknowns, guessed by linear algebra: no path leads there.
//!
//! With one plain unknown hidden in the coefficients, the four equations are bilinear in (y, 1) and (a, b, 1), y the other
//! plain unknown and a, b the conjugate ones. Each of them times 1, a and b makes 12 equations in the 12 products of 1 or y
//! with the six monomials of degree two in a, b (a formula of Sylvester's type; Weyman and Zelevinsky, "Determinantal
//! formulas for multigraded resultants", J. Algebraic Geom. 1994). Those with y do not feel the hidden unknown: eliminated, they
//! leave six equations, the eigenvalue problem of a pencil, whose eigenvector holds a and b.
//!
//! Rounding, multiple solutions and those at infinity may spoil what comes out. Nothing relies on it: it is where Newton's method
//! begins, and as many regular solutions as there can be are all.

use kempe_linear::{C, solve_complex};
use kempe_number::{Random, math};

use crate::system::System;

/// Plain unknowns of such a system.
const PLAIN: usize = 2;
/// Monomials of degree two in the conjugate unknowns, and solutions.
const COUNT: usize = 6;
/// Every equation times 1, a and b.
const ROWS: usize = 12;
/// Place of the product of two of (a, b, 1) among the monomials.
const MONOMIAL: [[usize; 3]; 3] = [[0, 1, 2], [1, 3, 4], [2, 4, 5]];
/// Steps towards the roots of the characteristic polynomial; most take ten.
const STEPS: usize = 60;
/// A step, as a part of the root's size, after which the next changes only what rounding does.
const NEAR_ROOT: f64 = 1e-5;
/// By so much, as a part of its size, an eigenvalue is put off its place, so that the matrix is regular there.
const BESIDE: f64 = 1e-9;

type Matrix = [[C; COUNT]; COUNT];

/// Points near the solutions, plain unknowns and then conjugate ones; `None` where they are not to be had so.
pub(crate) fn guess_all(system: &System) -> Option<Vec<Vec<C>>> {
    if system.d != PLAIN {
        return None;
    }
    // In generic directions no two solutions share the hidden unknown, and none has it at infinity.
    let mut random = Random(0x9e6c_63d0_76cc_4311);
    let directions = [(); 3].map(|()| [(); 3].map(|()| random.complex()));
    let forms = bilinear_forms(system).map(|form| turned(&form, &directions));
    let [mut fixed, mut hidden] = pencil(&forms)?;
    if !solve_complex(hidden.as_flattened_mut(), &mut fixed, COUNT) {
        return None;
    }
    let values = roots(&characteristic(&fixed))?;
    let points = values.iter().map(|&value| {
        let [a, b, one] = kernel(&fixed, value)?;
        let (a, b) = (a * one.recip(), b * one.recip());
        // The solved pencil has the eigenvalues turned about.
        let x = -value;
        let y = other_plain(&forms, x, [a, b, C::one()]);
        let [x, y, one] = directions.map(|[p, q, r]| p * x + q * y + r);
        Some(vec![x * one.recip(), y * one.recip(), a, b])
    });
    points.collect()
}

/// The form in the unknowns (x', y', 1) along these directions: (x, y, 1) are each a row of them times these, but for a factor.
fn turned(form: &[[C; 3]; 3], directions: &[[C; 3]; 3]) -> [[C; 3]; 3] {
    let entry =
        |i: usize, j: usize| (0..3).fold(C::zero(), |sum, k| sum + directions[k][i] * form[k][j]);
    std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))
}

/// Every equation as a matrix: the coefficients of the products of (x, y, 1) with (a, b, 1).
fn bilinear_forms(system: &System) -> [[[C; 3]; 3]; 4] {
    let mut forms = [[[C::zero(); 3]; 3]; 4];
    for (form, equation) in forms.iter_mut().zip(&system.target) {
        for (left, right) in &equation.0 {
            for (row, l) in form.iter_mut().zip(&left.0) {
                for (entry, r) in row.iter_mut().zip(&right.0) {
                    *entry += *l * *r;
                }
            }
        }
    }
    forms
}

/// The pencil: its fixed part and what the hidden unknown x is multiplied with.
fn pencil(forms: &[[[C; 3]; 3]; 4]) -> Option<[Matrix; 2]> {
    // Columns: the monomials times y, times 1 and times x.
    let mut rows = [[C::zero(); 3 * COUNT]; ROWS];
    for (k, form) in forms.iter().enumerate() {
        for m in 0..3 {
            for j in 0..3 {
                let at = MONOMIAL[m][j];
                rows[3 * k + m][at] += form[1][j];
                rows[3 * k + m][COUNT + at] += form[2][j];
                rows[3 * k + m][2 * COUNT + at] += form[0][j];
            }
        }
    }
    for k in 0..COUNT {
        let size = |i: &usize| rows[*i][k].norm_sqr();
        let pivot = (k..ROWS).max_by(|i, j| size(i).total_cmp(&size(j)))?;
        if !(rows[pivot][k].norm_sqr() > f64::MIN_POSITIVE) {
            return None;
        }
        rows.swap(k, pivot);
        let row = rows[k];
        let inverse = row[k].recip();
        for other in &mut rows[k + 1..] {
            if other[k].norm_sqr() == 0.0 {
                continue;
            }
            let factor = other[k] * inverse;
            for (entry, known) in other[k + 1..].iter_mut().zip(&row[k + 1..]) {
                *entry -= factor * *known;
            }
        }
    }
    let part = |first: usize| -> Matrix {
        std::array::from_fn(|i| std::array::from_fn(|j| rows[COUNT + i][first + j]))
    };
    Some([part(COUNT), part(2 * COUNT)])
}

/// Coefficients of a matrix's characteristic polynomial, the constant first and without the leading one: by similarity to a matrix with
/// zeros below the first subdiagonal.
fn characteristic(matrix: &Matrix) -> [C; COUNT] {
    let mut h = *matrix;
    for k in 1..COUNT - 1 {
        let (mut pivot, mut largest) = (k, -1.0);
        for (i, row) in h.iter().enumerate().skip(k) {
            let size = row[k - 1].norm_sqr();
            if size > largest {
                (pivot, largest) = (i, size);
            }
        }
        if !(largest > 0.0) {
            continue;
        }
        h.swap(k, pivot);
        h.iter_mut().for_each(|row| row.swap(k, pivot));
        let inverse = h[k][k - 1].recip();
        for i in k + 1..COUNT {
            let factor = h[i][k - 1] * inverse;
            let row = h[k];
            for (entry, known) in h[i].iter_mut().zip(row) {
                *entry -= factor * known;
            }
            for row in &mut h {
                let by = row[i];
                row[k] += factor * by;
            }
        }
    }
    // Determinants of the leading parts of s - h, by their last columns.
    let mut leading = [[C::zero(); COUNT + 1]; COUNT + 1];
    leading[0][0] = C::one();
    for n in 1..=COUNT {
        let mut sum = [C::zero(); COUNT + 1];
        for power in 0..n {
            sum[power + 1] += leading[n - 1][power];
        }
        let mut below = C::one();
        for i in (0..n).rev() {
            let factor = h[i][n - 1] * below;
            for (entry, known) in sum.iter_mut().zip(&leading[i]) {
                *entry -= factor * *known;
            }
            if i > 0 {
                below *= h[i][i - 1];
            }
        }
        leading[n] = sum;
    }
    std::array::from_fn(|k| leading[COUNT][k])
}

/// All roots of a polynomial with leading coefficient one, together (Aberth, "Iteration methods for finding all zeros of a polynomial
/// simultaneously", Math. Comp. 1973).
fn roots(polynomial: &[C; COUNT]) -> Option<[C; COUNT]> {
    let size = math::exp(math::ln(polynomial[0].norm()) / COUNT as f64);
    let mut random = Random(0x2545_f491_4f6c_dd1d);
    let mut z = [(); COUNT].map(|()| random.complex().scale(size));
    for _ in 0..STEPS {
        let mut largest = 0.0_f64;
        for k in 0..COUNT {
            let (mut value, mut slope) = (C::one(), C::zero());
            for c in polynomial.iter().rev() {
                slope = slope * z[k] + value;
                value = value * z[k] + *c;
            }
            let mut others = C::zero();
            for (j, other) in z.iter().enumerate() {
                if j != k {
                    others += (z[k] - *other).recip();
                }
            }
            let step = value * (slope - value * others).recip();
            if !step.is_finite() {
                return None;
            }
            z[k] -= step;
            largest = largest.max(step.norm_sqr() / z[k].norm_sqr());
        }
        if largest < NEAR_ROOT * NEAR_ROOT {
            return Some(z);
        }
    }
    None
}

/// The eigenvector of an eigenvalue, by inverse iteration: its parts at a, b and 1.
fn kernel(matrix: &Matrix, value: C) -> Option<[C; 3]> {
    let mut a = *matrix;
    let beside = value.scale(1.0 + BESIDE);
    for (k, row) in a.iter_mut().enumerate() {
        row[k] -= beside;
    }
    let mut v = [[C::one()]; COUNT];
    solve_complex(a.as_flattened_mut(), &mut v, COUNT).then_some([
        v[MONOMIAL[0][2]][0],
        v[MONOMIAL[1][2]][0],
        v[MONOMIAL[2][2]][0],
    ])
}

/// The plain unknown that is not hidden, by least squares.
fn other_plain(forms: &[[[C; 3]; 3]; 4], x: C, conjugate: [C; 3]) -> C {
    let (mut sum, mut square) = (C::zero(), 0.0);
    for form in forms {
        let [with_x, with_y, rest] =
            [0, 1, 2].map(|i| (0..3).fold(C::zero(), |sum, j| sum + form[i][j] * conjugate[j]));
        sum += with_y.conj() * (with_x * x + rest);
        square += with_y.norm_sqr();
    }
    -sum.scale(1.0 / square)
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use kempe_linear::Affine;

    use super::*;
    use crate::paths::{WORK_LIMIT, correct_all, follow_all};
    use crate::system::Bilinear;

    /// A random system; every equation feels the unknowns of its bits, plain ones and conjugate ones.
    fn system(random: &mut Random, felt: [[u32; 2]; 4]) -> System {
        let mut affine = |bits: u32| {
            let mut f = Affine((0..=PLAIN).map(|_| random.complex()).collect());
            for (j, c) in f.0[..PLAIN].iter_mut().enumerate() {
                if bits >> j & 1 == 0 {
                    *c = C::zero();
                }
            }
            f
        };
        let equations: Vec<Bilinear> = felt
            .iter()
            .map(|[l, r]| Bilinear((0..3).map(|_| (affine(*l), affine(*r))).collect()))
            .collect();
        let same: Vec<Affine> = (0..PLAIN)
            .map(|j| {
                let mut f = Affine::constant(PLAIN, C::zero());
                f.add(j, C::one());
                f
            })
            .collect();
        System::new(&same, &equations, PLAIN)
    }

    /// Guessed and corrected, the solutions are those to which the paths lead.
    #[test]
    fn guesses_lead_to_the_ends_of_all_paths() {
        let mut random = Random(11);
        let all = [3, 3];
        let kinds = [
            ([all; 4], 6),
            // A unit length of each plain unknown, as for a triad with a bar in between.
            ([[1, 1], [2, 2], all, all], 6),
            ([[1, 1], [1, 1], all, all], 4),
            ([[1, 1], [1, 1], [2, 2], all], 4),
        ];
        for (felt, most) in kinds {
            for _ in 0..60 {
                let system = system(&mut random, felt);
                let count = system.paths();
                assert!(count <= most, "{count}");
                let guessed =
                    guess_all(&system).and_then(|near| correct_all(&system, &near, count));
                let mut work = WORK_LIMIT;
                let followed =
                    follow_all(&system, &mut work, &mut |_| ControlFlow::Continue(())).unwrap();
                let Some(guessed) = guessed else {
                    assert!(followed.finite < count, "{felt:?}");
                    continue;
                };
                assert_eq!(guessed.len(), followed.finite);
                for end in &followed.ends {
                    let off = |x: &Vec<C>| {
                        let gaps = x.iter().zip(end).map(|(a, b)| (*a - *b).norm());
                        gaps.fold(0.0, f64::max)
                    };
                    assert!(guessed.iter().any(|x| off(x) < 1e-7));
                }
            }
        }
    }
}
