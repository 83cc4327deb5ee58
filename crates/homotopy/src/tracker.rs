//! Follows the paths of a homotopy from its start points to its ends.

use kempe_number::math;

use crate::system::{Start, System};
use kempe_linear::{Affine, C, solve_complex};

/// Size of the unknowns (in units of the mechanism) beyond which a path counts as gone to infinity.
const INFINITY: f64 = 1e7;

/// How carefully a path is followed.
#[derive(Clone, Copy)]
pub(crate) struct Care {
    /// Largest first correction, as a part of the unknowns' size: beyond it another path may be near.
    correction: f64,
    /// Largest growth of a step.
    growth: f64,
}

/// Points passed that the predictor looks back to.
const MEMORY: usize = 3;
/// Steps after which a path is given up.
const STEPS: usize = 20_000;
/// Correction after which the next changes nothing that counts: at the end of a path, and on the way as a part of the largest first
/// one.
const AT_THE_END: f64 = 1e-10;
const ON_THE_WAY: f64 = 1e-2;
/// Largest first correction, as a part of the unknowns' size, from the end of another system's path.
const NEARBY: f64 = 0.1;
/// First correction aimed at, as a part of the largest.
const AIM: f64 = 0.2;

/// The usual care, and that for paths that were lost or met another.
pub(crate) const CARES: [Care; 2] = [
    Care {
        correction: 1e-4,
        growth: 2.0,
    },
    Care {
        correction: 1e-7,
        growth: 1.2,
    },
];

/// An affine function by its entries that are not zero.
struct Sparse {
    entries: Vec<(usize, C)>,
    constant: C,
}

impl Sparse {
    fn of(f: &Affine, shift: usize) -> Self {
        let n = f.0.len() - 1;
        let entries = f.0[..n]
            .iter()
            .enumerate()
            .filter(|(_, c)| c.norm_sqr() > 0.0);
        Self {
            entries: entries.map(|(j, c)| (j + shift, *c)).collect(),
            constant: f.0[n],
        }
    }

    fn value(&self, x: &[C]) -> C {
        (self.entries.iter()).fold(self.constant, |sum, (j, c)| sum + *c * x[*j])
    }
}

/// Follows the paths of H = (1 - t) gamma G + t F.
pub(crate) struct Tracker {
    n: usize,
    start: Vec<(Sparse, Sparse)>,
    target: Vec<Vec<(Sparse, Sparse)>>,
    gamma: C,
    /// Right-hand sides: the value, and the derivative to t turned about.
    sides: Vec<[C; 2]>,
    jacobian: Vec<C>,
    pub(crate) solves: usize,
}

impl Tracker {
    pub(crate) fn new(system: &System, start: &Start) -> Self {
        let (d, n) = (system.d, 2 * system.d);
        let pair = |l: &Affine, r: &Affine| (Sparse::of(l, 0), Sparse::of(r, d));
        Self {
            n,
            start: (start.plain.iter().zip(&start.conjugate))
                .map(|(l, r)| pair(l, r))
                .collect(),
            target: (system.target.iter())
                .map(|e| e.0.iter().map(|(l, r)| pair(l, r)).collect())
                .collect(),
            gamma: start.gamma,
            sides: vec![[C::zero(); 2]; n],
            jacobian: vec![C::zero(); n * n],
            solves: 0,
        }
    }

    /// Value, Jacobian (row-major) and derivative to t.
    fn evaluate(&mut self, x: &[C], t: f64) {
        let n = self.n;
        self.jacobian.fill(C::zero());
        let weight = self.gamma * (1.0 - t);
        for k in 0..n {
            let row = &mut self.jacobian[k * n..(k + 1) * n];
            let (left, right) = &self.start[k];
            let (p, q) = (left.value(x), right.value(x));
            let g = self.gamma * p * q;
            for (j, c) in &left.entries {
                row[*j] += weight * q * *c;
            }
            for (j, c) in &right.entries {
                row[*j] += weight * p * *c;
            }
            let mut f = C::zero();
            for (left, right) in &self.target[k] {
                let (l, r) = (left.value(x), right.value(x));
                f += l * r;
                for (j, c) in &left.entries {
                    row[*j] += r * *c * t;
                }
                for (j, c) in &right.entries {
                    row[*j] += l * *c * t;
                }
            }
            self.sides[k] = [g * (1.0 - t) + f * t, g - f];
        }
    }

    /// Solves for the correction of `x` and the tangent there, side by side.
    fn solve(&mut self, x: &[C], t: f64) -> bool {
        self.evaluate(x, t);
        self.solves += 1;
        solve_complex(&mut self.jacobian, &mut self.sides, self.n)
    }

    fn slope(&self) -> Vec<C> {
        self.sides.iter().map(|side| side[1]).collect()
    }

    fn tangent(&mut self, x: &[C], t: f64) -> Option<Vec<C>> {
        self.solve(x, t).then(|| self.slope())
    }

    /// A step of the classical fourth-order rule: how a path begins.
    fn runge_kutta(&mut self, x: &[C], k1: &[C], t: f64, step: f64) -> Option<Vec<C>> {
        let ahead = |k: &[C], f: f64| -> Vec<C> {
            x.iter().zip(k).map(|(a, b)| *a + *b * (step * f)).collect()
        };
        let k2 = self.tangent(&ahead(k1, 0.5), t + 0.5 * step)?;
        let k3 = self.tangent(&ahead(&k2, 0.5), t + 0.5 * step)?;
        let k4 = self.tangent(&ahead(&k3, 1.0), t + step)?;
        Some(
            (0..self.n)
                .map(|i| x[i] + (k1[i] + (k2[i] + k3[i]) * 2.0 + k4[i]) * (step / 6.0))
                .collect(),
        )
    }

    /// Newton's method at fixed t; the first correction, and the tangent but for the last one. `None` when the first is too
    /// large (the path may have been left for another) or the corrections do not shrink.
    fn correct(&mut self, x: &mut [C], t: f64, care: Care) -> Option<(f64, Vec<C>)> {
        const CORRECTIONS: usize = 3;
        let enough = if is_end(t) {
            AT_THE_END
        } else {
            ON_THE_WAY * care.correction
        };
        let (mut first, mut last) = (0.0, f64::INFINITY);
        for round in 0..CORRECTIONS {
            if !self.solve(x, t) {
                return None;
            }
            let change = self.take_correction(x);
            if !change.is_finite()
                || (round == 0 && change > care.correction)
                || (round > 0 && change > last)
            {
                return None;
            }
            if round == 0 {
                first = change;
            }
            last = change;
            if change < enough {
                return Some((first, self.slope()));
            }
        }
        None
    }

    /// Newton's method at t = 1 from a point nearby; whether it comes to a regular solution there.
    pub(crate) fn correct_end(&mut self, x: &mut [C]) -> bool {
        const CORRECTIONS: usize = 8;
        let mut last = NEARBY;
        for _ in 0..CORRECTIONS {
            if !self.solve(x, 1.0) {
                return false;
            }
            let change = self.take_correction(x);
            if !(change <= last) {
                return false;
            }
            if change < AT_THE_END {
                return true;
            }
            last = 0.5 * change;
        }
        false
    }

    /// Takes the correction last solved for off the unknowns; returns how large it is, as a part of their size.
    fn take_correction(&self, x: &mut [C]) -> f64 {
        let mut square = 0.0_f64;
        for (a, [b, _]) in x.iter_mut().zip(&self.sides) {
            *a -= *b;
            square = square.max(b.norm_sqr());
        }
        square.sqrt() / (1.0 + largest(x))
    }

    /// Follows one path from t = 0 to 1.
    pub(crate) fn follow(&mut self, start: Vec<C>, care: Care) -> End {
        let mut step = 0.02_f64;
        let Some(slope) = self.tangent(&start, 0.0) else {
            return End::Lost;
        };
        let mut passed = vec![Passed {
            t: 0.0,
            x: start,
            slope,
        }];
        for _ in 0..STEPS {
            let Some(here) = passed.last() else { break };
            let t = here.t;
            let now = step.min(1.0 - t);
            let predicted = match passed.as_slice() {
                [first] => self.runge_kutta(&first.x, &first.slope, t, now),
                several => Some(extrapolate(several, t + now)),
            };
            let corrected = predicted.and_then(|mut next| {
                let (first, slope) = self.correct(&mut next, t + now, care)?;
                Some((next, first, slope))
            });
            let Some((x, first, slope)) = corrected else {
                step = now * 0.4;
                // What lies far back does not help where the path bends.
                passed.drain(..passed.len().saturating_sub(2));
                if step < 1e-12 {
                    break;
                }
                continue;
            };
            if largest(&x) > INFINITY {
                return End::Infinite;
            }
            if is_end(t + now) {
                return End::Finite(x);
            }
            // The predictor's error goes with the power of the step that the points passed give.
            let order = 1.0 / (2 * passed.len().max(2)) as f64;
            let room = AIM * care.correction / first.max(f64::MIN_POSITIVE);
            step = now * math::exp(order * math::ln(room)).clamp(0.3, care.growth);
            if passed.len() == MEMORY {
                passed.remove(0);
            }
            passed.push(Passed {
                t: t + now,
                x,
                slope,
            });
        }
        // A path that runs away slows down as it grows.
        if passed.last().is_some_and(|here| largest(&here.x) > 1e3) {
            End::Infinite
        } else {
            End::Lost
        }
    }
}

/// Whether a path ends there: the last step may end short of 1 by a rounding error.
fn is_end(t: f64) -> bool {
    (1.0 - t).abs() < f64::EPSILON
}

fn largest(v: &[C]) -> f64 {
    v.iter().map(|c| c.norm_sqr()).fold(0.0, f64::max).sqrt()
}

/// A point of a path with its tangent.
struct Passed {
    t: f64,
    x: Vec<C>,
    slope: Vec<C>,
}

/// The polynomial through the points passed with their tangents (Hermite, by divided differences), a step further.
fn extrapolate(passed: &[Passed], t: f64) -> Vec<C> {
    let count = 2 * passed.len();
    let at = |i: usize| passed[i / 2].t;
    // Products (t - t_0)(t - t_0)(t - t_1)... in front of the differences.
    let mut factors = [1.0; 2 * MEMORY];
    for i in 1..count {
        factors[i] = factors[i - 1] * (t - at(i - 1));
    }
    let width = passed.first().map_or(0, |p| p.x.len());
    (0..width)
        .map(|k| {
            let mut table = [C::zero(); 2 * MEMORY];
            for (i, entry) in table[..count].iter_mut().enumerate() {
                *entry = passed[i / 2].x[k];
            }
            let mut sum = table[0];
            for order in 1..count {
                for i in 0..count - order {
                    table[i] = if order == 1 && i % 2 == 0 {
                        passed[i / 2].slope[k]
                    } else {
                        (table[i + 1] - table[i]) * (1.0 / (at(i + order) - at(i)))
                    };
                }
                sum += table[0] * factors[order];
            }
            sum
        })
        .collect()
}

pub(crate) enum End {
    Finite(Vec<C>),
    Infinite,
    Lost,
}
