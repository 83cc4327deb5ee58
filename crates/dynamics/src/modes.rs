//! The natural vibrations of linear equations of motion: frequencies, shapes, damping.
//!
//! Without damping `M x" + K x = 0` has solutions `x = phi cos(w t)` with `K phi = w^2 M phi`. With it solutions go as `exp(s t)`
//! where `s^2 M + s C + K` is singular: two values of `s` belong to every mode, found as the eigenvalues of a matrix of twice the
//! size in the coordinates of the undamped modes, and each to the mode that takes the largest part in its motion.
//! (L. Meirovitch, "Principles and techniques of vibrations", 1997, chapters 4 and 8.)

use kempe_linear::{C, eigenvalues, generalised_eigen, solve_complex};

use crate::linearised::Linearised;

/// A stiffness below this part of the terms it is the sum of is rounding: nothing brings that motion back.
const NO_STIFFNESS: f64 = 1e-11;
/// An eigenvalue below this part of the largest has few digits of its own: the stiffness along its vector has more.
const BESIDE_STIFFEST: f64 = 1e-10;
/// Parts of matrices that are not symmetric count from this part of the largest entry.
const SYMMETRIC: f64 = 1e-9;
/// Damping between modes below this part of the largest is none: each vibrates by itself.
const UNCOUPLED: f64 = 1e-12;
/// A real part below this part of the largest entry of the matrix whose eigenvalue it is of is rounding.
const NO_GROWTH: f64 = 1e-13;
/// A matrix is made singular only up to this part of an eigenvalue, so that it can be solved with.
const BESIDE: f64 = 1e-9;

/// A natural vibration.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Square of the angular frequency without damping, 1/s^2: zero of a free motion, negative where it is unstable.
    pub square: f64,
    /// How far each coordinate goes, SI, for a modal mass of 1 kg m^2 or kg.
    pub shape: Vec<f64>,
    /// The two values of `s` (real and imaginary part, 1/s) with damping: conjugates where it vibrates, two real ones where it
    /// creeps.
    pub rates: [[f64; 2]; 2],
}

impl Mode {
    /// Angular frequency without damping, rad/s; 0 of a free motion, `None` of an unstable one.
    pub fn angular_frequency(&self) -> Option<f64> {
        (self.square >= 0.0).then(|| self.square.sqrt())
    }

    /// Angular frequency with damping, rad/s; 0 where it creeps.
    pub fn damped_angular_frequency(&self) -> f64 {
        self.rates[0][1].abs()
    }

    /// Damping in parts of the least for which it does not swing; `None` of free and unstable motions.
    pub fn damping_ratio(&self) -> Option<f64> {
        let [a, b] = self.rates;
        let product = a[0] * b[0] - a[1] * b[1];
        (self.square > 0.0 && product > 0.0).then(|| -(a[0] + b[0]) / 2.0 / product.sqrt() + 0.0)
    }

    /// The rate at which it grows, 1/s: negative where it dies away.
    pub fn growth(&self) -> f64 {
        self.rates[0][0].max(self.rates[1][0])
    }
}

/// Why there are no modes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoModes {
    /// This coordinate, by its place among those that are free, moves no mass that the ones before it do not move.
    NoMass(usize),
    /// Something is not finite.
    NoValue,
}

/// The modes of linear equations of motion, the slowest first.
///
/// # Errors
/// Where a coordinate moves no mass, or something has no value.
pub fn modes(it: &Linearised) -> Result<Vec<Mode>, NoModes> {
    let n = it.size;
    if !it.is_finite() {
        return Err(NoModes::NoValue);
    }
    let Some(pairs) = generalised_eigen(&it.stiffness, &it.mass, n) else {
        let leading = |size: usize| -> Vec<f64> {
            let rows = it.mass.chunks_exact(n).take(size);
            rows.flat_map(|row| row[..size].to_vec()).collect()
        };
        let fits =
            |size: &usize| generalised_eigen(&leading(*size), &leading(*size), *size).is_some();
        let most = (1..n).take_while(fits).last().unwrap_or(0);
        return Err(NoModes::NoMass(most));
    };
    let stiffest = pairs.iter().fold(0.0_f64, |m, p| m.max(p.value.abs()));
    let vectors: Vec<&[f64]> = pairs.iter().map(|pair| pair.vector.as_slice()).collect();
    let along = between(&it.stiffness, &vectors);
    let (squares, rounding): (Vec<f64>, Vec<f64>) = (pairs.iter().enumerate())
        .map(|(mode, pair)| {
            let terms: f64 = (0..n * n)
                .map(|k| (pair.vector[k / n] * it.stiffness_terms[k] * pair.vector[k % n]).abs())
                .sum();
            let (square, off) = match pair.value.abs() > BESIDE_STIFFEST * stiffest {
                true => (pair.value, 0.0),
                false => by_vector(&along, n, mode),
            };
            let rounding = NO_STIFFNESS * terms + off;
            let none = square.abs() <= rounding;
            (if none { 0.0 } else { square }, rounding)
        })
        .unzip();
    let mut modes: Vec<Mode> = (pairs.into_iter().zip(squares))
        .map(|(pair, square)| Mode {
            square,
            shape: pair.vector,
            rates: [[0.0; 2]; 2],
        })
        .collect();
    let modal = Modal::new(it, &modes, rounding);
    if !modal.symmetric {
        // Loads that follow the motion: the frequencies are those of the whole, still without damping.
        let undamped = Modal {
            damping: vec![0.0; n * n],
            ..modal.clone()
        };
        let rates = undamped.rates(&modes).ok_or(NoModes::NoValue)?;
        let shapes: Vec<Vec<f64>> = rates
            .iter()
            .map(|[s, _]| undamped.shape(*s, &modes))
            .collect();
        for ((mode, [a, b]), shape) in modes.iter_mut().zip(rates).zip(shapes) {
            mode.square = a[0] * b[0] - a[1] * b[1];
            mode.shape = shape;
        }
    }
    // In the basis of the symmetric part, of which the shapes no longer are where loads follow the motion.
    let rates = match modal.symmetric {
        true => modal.rates(&modes),
        false => modal.general(),
    };
    let rates = rates.ok_or(NoModes::NoValue)?;
    for (mode, rates) in modes.iter_mut().zip(rates) {
        mode.rates = rates;
    }
    modes.sort_by(|a, b| a.square.total_cmp(&b.square));
    Ok(modes)
}

/// The product of a matrix with shapes from both sides: row and column for each of them.
fn between(matrix: &[f64], shapes: &[&[f64]]) -> Vec<f64> {
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

/// The square of a mode's frequency by the stiffness along its shape, as `along` has it between all shapes, and how far off that
/// may be because its shape has a part in others: of second order in what is left between them (Rayleigh).
fn by_vector(along: &[f64], n: usize, mode: usize) -> (f64, f64) {
    let own = along[mode * n + mode];
    let others = (0..n).filter(|other| *other != mode);
    let off = others.map(|other| {
        let left = (along[mode * n + other] + along[other * n + mode]).abs() / 2.0;
        let apart = (along[other * n + other] - own).abs();
        if left < apart {
            left * left / apart
        } else {
            left
        }
    });
    (own, off.sum())
}

/// The equations in the coordinates of the undamped modes.
#[derive(Clone, Debug)]
struct Modal {
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
    symmetric: bool,
}

impl Modal {
    fn new(it: &Linearised, modes: &[Mode], rounding: Vec<f64>) -> Self {
        let n = it.size;
        let basis: Vec<Vec<f64>> = modes.iter().map(|m| m.shape.clone()).collect();
        let shapes: Vec<&[f64]> = basis.iter().map(Vec::as_slice).collect();
        let between = |matrix: &[f64]| between(matrix, &shapes);
        let skew = |m: &[f64]| {
            (0..n * n)
                .map(|k| (m[k] - m[k % n * n + k / n]).abs())
                .fold(0.0, f64::max)
        };
        let largest = |m: &[f64]| m.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let (mut mass, mut stiffness) = (between(&it.mass), between(&it.stiffness));
        let terms = between(&it.stiffness_terms);
        let symmetric = skew(&mass) <= SYMMETRIC * largest(&mass)
            && skew(&stiffness) <= SYMMETRIC * largest(&terms);
        if symmetric {
            for k in 0..n * n {
                let own = k / n == k % n;
                mass[k] = if own { 1.0 } else { 0.0 };
                stiffness[k] = if own { modes[k / n].square } else { 0.0 };
            }
        }
        let mut damping = between(&it.damping);
        let coupling = UNCOUPLED * largest(&damping);
        for k in 0..n * n {
            if k / n != k % n && damping[k].abs() <= coupling {
                damping[k] = 0.0;
            }
        }
        let fastest = modes
            .iter()
            .fold(0.0_f64, |m, mode| m.max(mode.square.abs().sqrt()));
        let least = if fastest > 0.0 { 1e-6 * fastest } else { 1.0 };
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

    /// Both values of `s` of every mode.
    fn rates(&self, modes: &[Mode]) -> Option<Vec<[[f64; 2]; 2]>> {
        let n = self.n;
        let coupled = (0..n * n).any(|k| k / n != k % n && self.damping[k] != 0.0);
        if self.symmetric && !coupled {
            let one = |k: usize| alone(modes[k].square, self.damping[k * n + k]);
            return Some((0..n).map(one).collect());
        }
        self.general()
    }

    /// The same where the modes act on each other.
    fn general(&self) -> Option<Vec<[[f64; 2]; 2]>> {
        let n = self.n;
        // In the coordinates (scale y, y').
        let (by_stiffness, by_damping) =
            (self.by_mass(&self.stiffness)?, self.by_mass(&self.damping)?);
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

    /// The product of a matrix with the inverse of the mass matrix.
    fn by_mass(&self, matrix: &[f64]) -> Option<Vec<f64>> {
        let n = self.n;
        let mut out = vec![0.0; n * n];
        for column in 0..n {
            let mut mass: Vec<C> = self.mass.iter().map(|x| C::new(*x, 0.0)).collect();
            let mut rhs: Vec<[C; 1]> = (0..n)
                .map(|row| [C::new(matrix[row * n + column], 0.0)])
                .collect();
            if !solve_complex(&mut mass, &mut rhs, n) {
                return None;
            }
            (0..n).for_each(|row| out[row * n + column] = rhs[row][0].re);
        }
        Some(out)
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
        let mut y: Vec<[C; 1]> = vec![[C::one()]; n];
        for _ in 0..3 {
            let mut matrix: Vec<C> = (0..n * n)
                .map(|k| {
                    s * s * number(self.mass[k])
                        + s * number(self.damping[k])
                        + number(self.stiffness[k])
                })
                .collect();
            if !solve_complex(&mut matrix, &mut y, n) {
                break;
            }
            let largest = y.iter().fold(0.0_f64, |m, x| m.max(x[0].norm()));
            for x in &mut y {
                x[0] = C::new(x[0].re / largest, x[0].im / largest);
            }
        }
        y.into_iter().map(|[x]| x).collect()
    }

    /// The part that every mode takes in the motion that goes as `exp(s t)`.
    fn parts(&self, s: [f64; 2]) -> Vec<f64> {
        let y = self.motion(s);
        let all: f64 = y.iter().map(|x| x.norm_sqr()).sum();
        y.iter().map(|x| x.norm_sqr() / all).collect()
    }

    /// The shape of the motion that goes as `exp(s t)` at the instant when the mode of the largest part stands out farthest, for a
    /// modal mass of 1.
    fn shape(&self, s: [f64; 2], modes: &[Mode]) -> Vec<f64> {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn made(n: usize, mass: &[f64], damping: &[f64], stiffness: &[f64]) -> Vec<Mode> {
        let it = Linearised {
            size: n,
            mass: mass.to_vec(),
            damping: damping.to_vec(),
            stiffness: stiffness.to_vec(),
            stiffness_terms: stiffness.iter().map(|x| x.abs()).collect(),
            force: vec![0.0; n],
            force_terms: vec![0.0; n],
        };
        modes(&it).expect("modes")
    }

    #[test]
    fn one_coordinate_by_hand() {
        let [swings] = &made(1, &[4.0], &[8.0], &[100.0])[..] else {
            panic!()
        };
        assert_eq!(swings.square, 25.0);
        assert_eq!(swings.damping_ratio(), Some(0.2));
        assert!((swings.damped_angular_frequency() - 24.0_f64.sqrt()).abs() < 1e-14);
        let [creeps] = &made(1, &[1.0], &[5.0], &[4.0])[..] else {
            panic!()
        };
        assert_eq!(creeps.rates, [[-1.0, 0.0], [-4.0, 0.0]]);
        assert_eq!(creeps.damping_ratio(), Some(1.25));
        let [falls] = &made(1, &[1.0], &[0.0], &[-9.0])[..] else {
            panic!()
        };
        assert_eq!(
            (
                falls.growth(),
                falls.angular_frequency(),
                falls.damping_ratio()
            ),
            (3.0, None, None)
        );
        let [free] = &made(1, &[1.0], &[0.0], &[0.0])[..] else {
            panic!()
        };
        assert_eq!((free.growth(), free.angular_frequency()), (0.0, Some(0.0)));
    }

    #[test]
    fn damping_between_modes_satisfies_the_equation() {
        // Two masses in a row, one damper between the first and the wall: not proportional.
        let (m, c, k) = (
            [1.0, 0.0, 0.0, 2.0],
            [3.0, 0.0, 0.0, 0.0],
            [30.0, -10.0, -10.0, 10.0],
        );
        for factor in [0.01, 0.3, 1.0, 5.0, 40.0] {
            let c: Vec<f64> = c.iter().map(|x| x * factor).collect();
            let modes = made(2, &m, &c, &k);
            let mut sum = 0.0;
            for s in modes.iter().flat_map(|mode| mode.rates) {
                let s = C::new(s[0], s[1]);
                let p = |e: usize| {
                    s * s * C::new(m[e], 0.0) + s * C::new(c[e], 0.0) + C::new(k[e], 0.0)
                };
                let singular = p(0) * p(3) - p(1) * p(2);
                assert!(
                    singular.norm() < 1e-9 * (1.0 + s.norm_sqr() * s.norm_sqr()),
                    "{factor}: {s:?}"
                );
                sum += s.re;
            }
            // The sum of all is minus the trace of the damping over the mass.
            assert!((sum + 3.0 * factor).abs() < 1e-10 * (1.0 + factor));
        }
    }

    #[test]
    fn every_rate_makes_the_equation_singular_whatever_the_damping() {
        let mut random = kempe_number::Random(5);
        for n in 1..6 {
            for strength in [0.0, 0.05, 1.0, 20.0] {
                let mut positive = |size: f64| {
                    let half: Vec<f64> = (0..n * n).map(|_| random.uniform() - 0.5).collect();
                    let entry = |k: usize| -> f64 {
                        (0..n)
                            .map(|j| half[k / n * n + j] * half[k % n * n + j])
                            .sum()
                    };
                    let own = |k: usize| if k / n == k % n { 0.2 } else { 0.0 };
                    (0..n * n)
                        .map(|k| size * (entry(k) + own(k)))
                        .collect::<Vec<f64>>()
                };
                let (m, c, k) = (positive(1.0), positive(strength), positive(50.0));
                let found = made(n, &m, &c, &k);
                assert!(found.windows(2).all(|w| w[0].square <= w[1].square));
                for [re, im] in found.iter().flat_map(|mode| mode.rates) {
                    assert!(re <= 0.0, "{re}");
                    // A right side that the singular matrix cannot make makes the solution large.
                    let s = C::new(re, im);
                    let number = |x: f64| C::new(x, 0.0);
                    let mut matrix: Vec<C> = (0..n * n)
                        .map(|e| s * s * number(m[e]) + s * number(c[e]) + number(k[e]))
                        .collect();
                    let largest = |m: &[f64]| m.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
                    let size = s.norm_sqr() * largest(&m) + largest(&k);
                    let mut y: Vec<[C; 1]> =
                        (0..n).map(|k| [number(1.0 + 0.3 * k as f64)]).collect();
                    if solve_complex(&mut matrix, &mut y, n) {
                        let large = y.iter().fold(0.0_f64, |most, x| most.max(x[0].norm()));
                        assert!(large * size > 1e7, "{n} {strength}: {re} {im}: {large:e}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_following_load_makes_it_flutter() {
        // x" + K x = 0 with K = [1 b; -b 2]: the squares of w meet at b = 1/2 and part into the plane.
        let below = made(2, &[1.0, 0.0, 0.0, 1.0], &[0.0; 4], &[1.0, 0.3, -0.3, 2.0]);
        let w = |sign: f64| 1.5 + sign * (0.25_f64 - 0.09).sqrt();
        assert!(
            (below[0].square - w(-1.0)).abs() < 1e-9 && (below[1].square - w(1.0)).abs() < 1e-9,
            "{below:?}"
        );
        assert!(below.iter().all(|m| m.growth().abs() < 1e-9));
        let above = made(2, &[1.0, 0.0, 0.0, 1.0], &[0.0; 4], &[1.0, 0.8, -0.8, 2.0]);
        let most = above.iter().map(Mode::growth).fold(f64::MIN, f64::max);
        // s^2 = -(3/2) +- i sqrt(b^2 - 1/4)
        let im = (0.64_f64 - 0.25).sqrt();
        let size = (2.25 + im * im).sqrt();
        assert!(
            (most - ((size - 1.5) / 2.0).sqrt()).abs() < 1e-9,
            "{above:?}"
        );
    }

    #[test]
    fn what_nothing_brings_back_stays_free_beside_following_loads() {
        let mut random = kempe_number::Random(17);
        for n in 2..6 {
            for _ in 0..20 {
                let mut any = || 2.0 * random.uniform() - 1.0;
                // Neither stiffness nor damping feels one motion, which takes part in every coordinate.
                let still: Vec<f64> = (0..n).map(|_| 1.0 + 0.5 * any()).collect();
                let length: f64 = still.iter().map(|x| x * x).sum();
                let mut blind = |own: f64, follows: f64| -> Vec<f64> {
                    let whole: Vec<f64> = (0..n * n)
                        .map(|k| if k / n == k % n { own } else { follows * any() })
                        .collect();
                    let entry = |k: usize| {
                        let row = &whole[k / n * n..][..n];
                        let along: f64 = row.iter().zip(&still).map(|(a, x)| a * x).sum();
                        row[k % n] - along * still[k % n] / length
                    };
                    (0..n * n).map(entry).collect()
                };
                let (damping, stiffness) = (blind(0.5, 0.1), blind(50.0, 4.0));
                let mass: Vec<f64> = (0..n * n)
                    .map(|k| {
                        if k / n == k % n {
                            1.0 + 0.1 * k as f64
                        } else {
                            0.1
                        }
                    })
                    .collect();
                let found = made(n, &mass, &damping, &stiffness);
                let free: Vec<&Mode> = found.iter().filter(|m| m.square == 0.0).collect();
                assert_eq!(free.len(), 1, "{found:?}");
                assert_eq!(free[0].rates, [[0.0; 2]; 2], "{found:?}");
                assert!(found.iter().all(|m| m.growth() <= 0.0), "{found:?}");
            }
        }
    }

    #[test]
    fn a_slow_mode_keeps_its_digits_beside_a_stiff_one() {
        // A milligram on a stiff spring and a ton on a soft one, joined by another; then two that nothing holds.
        let mass = [1e-6, 0.0, 0.0, 1e3];
        let [slow, fast] = &made(2, &mass, &[0.0; 4], &[1e7 + 1.0, -1.0, -1.0, 2.0])[..] else {
            panic!()
        };
        // By the sum and the product of both squares.
        let (sum, product) = ((1e7 + 1.0) / 1e-6 + 2e-3, ((1e7 + 1.0) * 2.0 - 1.0) / 1e-3);
        assert!((fast.square / sum - 1.0).abs() < 1e-12);
        assert!(
            (slow.square * fast.square / product - 1.0).abs() < 1e-11,
            "{}",
            slow.square
        );
        let [free, swings] = &made(2, &mass, &[0.0; 4], &[1e7, -1e7, -1e7, 1e7])[..] else {
            panic!()
        };
        assert_eq!(free.square, 0.0);
        assert!((swings.square / (1e7 * (1e6 + 1e-3)) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn what_moves_no_mass_is_named() {
        let it = Linearised {
            size: 2,
            mass: vec![1.0, 0.0, 0.0, 0.0],
            damping: vec![0.0; 4],
            stiffness: vec![1.0, 0.0, 0.0, 1.0],
            stiffness_terms: vec![1.0; 4],
            force: vec![0.0; 2],
            force_terms: vec![0.0; 2],
        };
        assert_eq!(modes(&it), Err(NoModes::NoMass(1)));
    }
}
