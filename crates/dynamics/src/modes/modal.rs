//! Equations of motion in the coordinates of the undamped modes: how each of them goes with damping.

use kempe_linear::{C, Lu, eigenvalues};

use super::mode::Mode;
use crate::linearised::Linearised;

/// Parts of matrices that are not symmetric count from this part of the terms they are the sum of.
const SYMMETRIC: f64 = 1e-9;
/// Damping between modes below this part of the terms it is the sum of is none: each vibrates by itself.
const UNCOUPLED: f64 = 1e-12;
/// A real part below this part of the largest entry of the matrix whose eigenvalue it is of is rounding.
const NO_GROWTH: f64 = 1e-13;
/// A value of `s` below this part of that entry is that of what stands still.
const STANDS: f64 = 1e-11;
/// A matrix is made singular only up to this part of an eigenvalue, so that it can be solved with.
const BESIDE: f64 = 1e-9;
/// Rounds of inverse iteration: each takes what other motions have in the vector down by nine powers of ten or to rounding.
const INVERSE_ITERATIONS: usize = 3;
/// Speeds of modes that are slower than this part of the fastest are counted as theirs.
const SLOWEST: f64 = 1e-6;

/// The equations in the coordinates of the undamped modes.
#[derive(Clone, Debug)]
pub(super) struct Modal {
    n: usize,
    mass: Vec<f64>,
    damping: Vec<f64>,
    stiffness: Vec<f64>,
    /// The modes' shapes, of the symmetric part.
    basis: Vec<Vec<f64>>,
    /// Angular frequencies by which speeds are counted, 1/s.
    scale: Vec<f64>,
    /// Squares of angular frequencies that are rounding, 1/s^2.
    rounding: Vec<f64>,
    /// Whether mass and stiffness are.
    pub symmetric: bool,
}

impl Modal {
    pub fn new(it: &Linearised, modes: &[Mode], rounding: Vec<f64>) -> Self {
        let n = it.size;
        let basis: Vec<Vec<f64>> = modes.iter().map(|m| m.shape.clone()).collect();
        let shapes: Vec<&[f64]> = basis.iter().map(Vec::as_slice).collect();
        let of_shapes = |matrix: &[f64]| between(matrix, &shapes);
        let sizes = |list: &[f64]| -> Vec<f64> { list.iter().map(|x| x.abs()).collect() };
        let farthest: Vec<Vec<f64>> = basis.iter().map(|shape| sizes(shape)).collect();
        let farthest: Vec<&[f64]> = farthest.iter().map(Vec::as_slice).collect();
        // Entry by entry: stiff modes hide nothing of slow ones.
        let terms_of = |matrix: &[f64]| between(&sizes(matrix), &farthest);
        let is_symmetric = |m: &[f64], terms: &[f64]| {
            (0..n * n).all(|k| {
                let other = k % n * n + k / n;
                (m[k] - m[other]).abs() <= SYMMETRIC * terms[k].max(terms[other])
            })
        };
        let (mut mass, mut stiffness) = (of_shapes(&it.mass), of_shapes(&it.stiffness));
        let symmetric = is_symmetric(&mass, &terms_of(&it.mass))
            && is_symmetric(&stiffness, &terms_of(&it.stiffness_terms));
        if symmetric {
            for k in 0..n * n {
                let own = k / n == k % n;
                mass[k] = if own { 1.0 } else { 0.0 };
                stiffness[k] = if own { modes[k / n].square } else { 0.0 };
            }
        }
        let mut damping = of_shapes(&it.damping);
        let terms = terms_of(&it.damping);
        for k in 0..n * n {
            if k / n != k % n && damping[k].abs() <= UNCOUPLED * terms[k] {
                damping[k] = 0.0;
            }
        }
        let fastest = modes
            .iter()
            .fold(0.0_f64, |m, mode| m.max(mode.square.abs().sqrt()));
        let least = match fastest > 0.0 {
            true => SLOWEST * fastest,
            false => 1.0,
        };
        Self {
            n,
            mass,
            damping,
            stiffness,
            scale: modes
                .iter()
                .map(|m| m.square.abs().sqrt().max(least))
                .collect(),
            basis,
            rounding,
            symmetric,
        }
    }

    /// The same without damping.
    pub fn undamped(&self) -> Self {
        Self {
            damping: vec![0.0; self.n * self.n],
            ..self.clone()
        }
    }

    /// Both values of `s` of every mode.
    pub fn rates(&self, modes: &[Mode]) -> Option<Vec<[[f64; 2]; 2]>> {
        let n = self.n;
        let coupled = (0..n * n).any(|k| k / n != k % n && self.damping[k] != 0.0);
        if self.symmetric && !coupled {
            let one = |k: usize| alone(modes[k].square, self.damping[k * n + k]);
            return Some((0..n).map(one).collect());
        }
        self.general()
    }

    /// The same where the modes act on each other.
    pub fn general(&self) -> Option<Vec<[[f64; 2]; 2]>> {
        let n = self.n;
        // In the coordinates (scale y, y').
        let mut mass = Lu::new(n);
        if !mass.factor(|row, column| self.mass[row * n + column]) {
            return None;
        }
        let (by_stiffness, by_damping) = (
            by_mass(&mass, &self.stiffness, n)?,
            by_mass(&mass, &self.damping, n)?,
        );
        let mut matrix = vec![0.0; 4 * n * n];
        for i in 0..n {
            matrix[i * 2 * n + n + i] = self.scale[i];
            for j in 0..n {
                matrix[(n + i) * 2 * n + j] = -by_stiffness[i * n + j] / self.scale[j];
                matrix[(n + i) * 2 * n + n + j] = -by_damping[i * n + j];
            }
        }
        let mut found = eigenvalues(&matrix, 2 * n)?;
        // What rounding leaves of no growth is none: else it would be told as unstable.
        let largest = matrix.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        for [re, _] in &mut found {
            if re.abs() <= NO_GROWTH * largest {
                *re = 0.0;
            }
        }
        let (pairs, single): (Vec<[f64; 2]>, Vec<[f64; 2]>) =
            (found.into_iter().filter(|s| s[1] >= 0.0)).partition(|s| s[1] > 0.0);
        let mut given: Vec<Vec<[f64; 2]>> = vec![Vec::new(); n];
        // What does not move at all belongs to what nothing brings back, however damping ties it to others.
        let (standing, mut single): (Vec<[f64; 2]>, Vec<[f64; 2]>) =
            (single.into_iter()).partition(|s| s[0].abs() <= STANDS * largest);
        let mut free: Vec<usize> = (0..n).filter(|k| self.is_free(*k)).collect();
        for s in standing {
            let parts = self.parts(s);
            let by_part = |a: &usize, b: &usize| parts[free[*a]].total_cmp(&parts[free[*b]]);
            match (0..free.len()).max_by(by_part) {
                Some(best) => given[free.swap_remove(best)].push(s),
                None => single.push(s),
            }
        }
        for (list, each) in [(pairs, 2), (single, 1)] {
            let mut left: Vec<([f64; 2], Vec<f64>)> =
                list.into_iter().map(|s| (s, self.parts(s))).collect();
            // The clearest first, so that no mode is taken by what belongs to another.
            while !left.is_empty() {
                let open = |mode: usize| given[mode].len() + each <= 2;
                let choices = left.iter().enumerate().flat_map(|(at, (_, parts))| {
                    (0..n)
                        .filter(|mode| open(*mode))
                        .map(move |mode| (at, mode, parts[mode]))
                });
                let (at, mode, _) = choices.reduce(|a, b| if b.2 > a.2 { b } else { a })?;
                let ([re, im], _) = left.remove(at);
                given[mode].push([re, im]);
                if each == 2 {
                    given[mode].push([re, -im]);
                }
            }
        }
        let both = given.into_iter().zip(&self.rounding);
        both.map(|(both, rounding)| Some(without_rounding(both.try_into().ok()?, *rounding)))
            .collect()
    }

    /// Whether nothing brings a mode back.
    fn is_free(&self, mode: usize) -> bool {
        self.symmetric && self.stiffness[mode * self.n + mode].abs() <= self.rounding[mode]
    }

    /// The motion that goes as `exp(s t)`, in the coordinates of the modes, by inverse iteration.
    fn motion(&self, s: [f64; 2]) -> Vec<C> {
        let n = self.n;
        let size = self.scale.iter().fold(0.0_f64, |m, x| m.max(*x));
        let s = C::new(
            s[0] + BESIDE * (s[0].abs() + s[1].abs()).max(BESIDE * size),
            s[1],
        );
        let number = |x: f64| C::new(x, 0.0);
        let mut y = vec![C::one(); n];
        let mut matrix = Lu::new(n);
        let entry = |row: usize, column: usize| {
            let k = row * n + column;
            s * s * number(self.mass[k]) + s * number(self.damping[k]) + number(self.stiffness[k])
        };
        if !matrix.factor(entry) {
            return y;
        }
        for _ in 0..INVERSE_ITERATIONS {
            matrix.solve(&mut y);
            let largest = y.iter().fold(0.0_f64, |m, x| m.max(x.norm()));
            for x in &mut y {
                *x = C::new(x.re / largest, x.im / largest);
            }
        }
        y
    }

    /// The part that every mode takes in the motion that goes as `exp(s t)`.
    fn parts(&self, s: [f64; 2]) -> Vec<f64> {
        let y = self.motion(s);
        let all: f64 = y.iter().map(|x| x.norm_sqr()).sum();
        y.iter().map(|x| x.norm_sqr() / all).collect()
    }

    /// The shape of the motion that goes as `exp(s t)` at the instant when the mode of the largest part stands out farthest, for a
    /// modal mass of 1.
    pub fn shape(&self, s: [f64; 2], modes: &[Mode]) -> Vec<f64> {
        let y = self.motion(s);
        let zero = C::zero();
        let largest = y.iter().fold(
            &zero,
            |a, b| if b.norm_sqr() > a.norm_sqr() { b } else { a },
        );
        let turned = largest.conj();
        let real: Vec<f64> = y.iter().map(|x| (*x * turned).re).collect();
        let length = real.iter().map(|x| x * x).sum::<f64>().sqrt();
        let coordinate = |k: usize| {
            let parts = self.basis.iter().zip(&real);
            parts.map(|(shape, y)| shape[k] * y).sum::<f64>() / length
        };
        (0..modes.len()).map(coordinate).collect()
    }
}

/// The product of a matrix with the inverse of the mass matrix. `None` where it is not finite.
fn by_mass(mass: &Lu<f64>, matrix: &[f64], n: usize) -> Option<Vec<f64>> {
    let mut out = vec![0.0; n * n];
    let mut right = vec![0.0; n];
    for column in 0..n {
        (0..n).for_each(|row| right[row] = matrix[row * n + column]);
        mass.solve(&mut right);
        (0..n).for_each(|row| out[row * n + column] = right[row]);
    }
    out.iter().all(|x| x.is_finite()).then_some(out)
}

/// Both values of `s` of a mode. Where their product, the square of its frequency, is rounding nothing brings it back: one of them is
/// zero, or both, which rounding parts by its root.
fn without_rounding(mut both: [[f64; 2]; 2], rounding: f64) -> [[f64; 2]; 2] {
    let sizes = both.map(|[re, im]| re * re + im * im);
    if (sizes[0] * sizes[1]).sqrt() <= rounding {
        let smaller = if sizes[1] < sizes[0] { 1 } else { 0 };
        both[smaller] = [0.0; 2];
        if sizes[1 - smaller] <= rounding {
            both[1 - smaller] = [0.0; 2];
        }
    }
    both
}

/// Both values of `s` where `s^2 + damping s + square = 0`.
fn alone(square: f64, damping: f64) -> [[f64; 2]; 2] {
    let half = damping / 2.0;
    let under = half * half - square;
    if under < 0.0 {
        let im = (-under).sqrt();
        return [[-half + 0.0, im], [-half + 0.0, -im]];
    }
    let far = -half
        - if half < 0.0 {
            -under.sqrt()
        } else {
            under.sqrt()
        };
    let near = if far == 0.0 { 0.0 } else { square / far };
    [[near + 0.0, 0.0], [far + 0.0, 0.0]]
}

/// The product of a matrix with shapes from both sides: row and column for each of them.
pub(super) fn between(matrix: &[f64], shapes: &[&[f64]]) -> Vec<f64> {
    let n = shapes.len();
    let times = |k: usize| -> f64 {
        let (row, shape) = (&matrix[k / n * n..][..n], shapes[k % n]);
        row.iter().zip(shape).map(|(a, x)| a * x).sum()
    };
    // Row for row of the matrix what each shape makes of it.
    let right: Vec<f64> = (0..n * n).map(times).collect();
    let entry = |k: usize| -> f64 {
        let column = right.iter().skip(k % n).step_by(n);
        shapes[k / n].iter().zip(column).map(|(x, a)| x * a).sum()
    };
    (0..n * n).map(entry).collect()
}
