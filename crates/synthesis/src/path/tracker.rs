//! The equations of a path with given ground pivots, and their solutions led from one set of points to another.
//!
//! Isotropic coordinates, ground pivots at 0 and 1, points d_0 to d_m (A. P. Morgan and C. W. Wampler, J. Mech. Design 112:544, 1990): the moving
//! pivots x and y as seen from the point, the coupler's turns T_j, and for j = 1 to m
//!
//!   T T' = 1,  (d + T x)(d' + T' x') = (d_0 + x)(d'_0 + x'),  (d - 1 + T y)(d' - 1 + T' y') = (d_0 - 1 + y)(d'_0 - 1 + y')
//!
//! with ' for conjugate coordinates. Only the equations of place j feel T_j, so what remains of a linear system when these are
//! eliminated is one equation per place in x, x', y, y'. With four places that is all; with three, x lies on a line besides.

use kempe_linear::{C, solve_complex};
use kempe_number::math;

/// Places after the first, at most.
pub(super) const PLACES: usize = 4;
/// Unknowns, at most: x, x', y, y', then T and T' of each place.
const UNKNOWNS: usize = 4 + 2 * PLACES;

/// A solution.
pub(super) type State = [C; UNKNOWNS];

/// What is given: points and their conjugates, and of a line c x + c' x' = e the factors.
#[derive(Clone, Copy, Debug)]
pub(super) struct Given {
    /// Places after the first: three with the line, four without it.
    pub(super) places: usize,
    pub(super) d: [C; PLACES + 1],
    pub(super) conjugate: [C; PLACES + 1],
    pub(super) line: [C; 3],
}

impl Given {
    /// What lies a part of the way to another.
    fn towards(&self, other: &Self, part: f64) -> Self {
        let between = |a: C, b: C| a * (1.0 - part) + b * part;
        Self {
            places: self.places,
            d: std::array::from_fn(|k| between(self.d[k], other.d[k])),
            conjugate: std::array::from_fn(|k| between(self.conjugate[k], other.conjugate[k])),
            line: std::array::from_fn(|k| between(self.line[k], other.line[k])),
        }
    }

    fn less(&self, other: &Self) -> Self {
        Self {
            places: self.places,
            d: std::array::from_fn(|k| self.d[k] - other.d[k]),
            conjugate: std::array::from_fn(|k| self.conjugate[k] - other.conjugate[k]),
            line: std::array::from_fn(|k| self.line[k] - other.line[k]),
        }
    }
}

/// The correction of Newton's method at a place, and how the solution moves as what is given moves at `rate`, both to be taken off.
fn solve(at: &State, given: &Given, rate: &Given) -> Option<[State; 2]> {
    let [x, x1, y, y1] = [at[0], at[1], at[2], at[3]];
    let (d0, c0) = (given.d[0], given.conjugate[0]);
    let (d0_rate, c0_rate) = (rate.d[0], rate.conjugate[0]);
    let one = C::one();
    let mut matrix = [C::zero(); 16];
    let mut right = [[C::zero(); 2]; 4];
    // Of each place its three equations: factors of T and T', of x, x' or y, y', and both right sides.
    let mut rows = [[[C::zero(); 6]; 3]; PLACES];
    for j in 0..given.places {
        let (t, t1) = (at[4 + 2 * j], at[5 + 2 * j]);
        let (d, c) = (given.d[j + 1], given.conjugate[j + 1]);
        let (d_rate, c_rate) = (rate.d[j + 1], rate.conjugate[j + 1]);
        let zero = C::zero();
        rows[j][0] = [t1, t, zero, zero, t * t1 - one, zero];
        for (k, (p, p1, pivot)) in [(x, x1, zero), (y, y1, one)].into_iter().enumerate() {
            let (d, c, d0, c0) = (d - pivot, c - pivot, d0 - pivot, c0 - pivot);
            let (turned, turned1) = (t * p, t1 * p1);
            let value = c * turned + d * turned1 - c0 * p - d0 * p1 + d * c - d0 * c0;
            let change = c_rate * (turned + d) + d_rate * (turned1 + c)
                - c0_rate * (p + d0)
                - d0_rate * (p1 + c0);
            rows[j][k + 1] = [c * p, d * p1, c * t - c0, d * t1 - d0, value, change];
        }
        // The combination that does not feel T and T'.
        let [a, b, e] = &rows[j];
        let factors = [
            b[0] * e[1] - e[0] * b[1],
            e[0] * a[1] - a[0] * e[1],
            a[0] * b[1] - b[0] * a[1],
        ];
        let size = factors
            .iter()
            .fold(0.0, |m, f| math::max(m, f.re.abs() + f.im.abs()));
        let [f, g, h] = factors.map(|f| f.scale(1.0 / size));
        matrix[4 * j] = g * b[2];
        matrix[4 * j + 1] = g * b[3];
        matrix[4 * j + 2] = h * e[2];
        matrix[4 * j + 3] = h * e[3];
        right[j] = [f * a[4] + g * b[4] + h * e[4], g * b[5] + h * e[5]];
    }
    if given.places < PLACES {
        let ([c, c1, e], [c_rate, c1_rate, e_rate]) = (given.line, rate.line);
        matrix[12] = c;
        matrix[13] = c1;
        right[3] = [c * x + c1 * x1 - e, c_rate * x + c1_rate * x1 - e_rate];
    }
    if !solve_complex(&mut matrix, &mut right, 4) {
        return None;
    }
    let mut found = [[C::zero(); UNKNOWNS]; 2];
    for (side, found) in found.iter_mut().enumerate() {
        for k in 0..4 {
            found[k] = right[k][side];
        }
        for j in 0..given.places {
            // The two equations that tell T and T' best.
            let left = |k: usize| {
                let row = &rows[j][k];
                let own = 2 * k.saturating_sub(1);
                row[4 + side] - row[2] * found[own] - row[3] * found[own + 1]
            };
            let minor = |i: usize, k: usize| {
                let (p, q) = (&rows[j][i], &rows[j][k]);
                p[0] * q[1] - q[0] * p[1]
            };
            let (i, k, det) = [(0, 1), (0, 2), (1, 2)]
                .map(|(i, k)| (i, k, minor(i, k)))
                .into_iter()
                .max_by(|p, q| p.2.norm_sqr().total_cmp(&q.2.norm_sqr()))?;
            let (p, q) = (&rows[j][i], &rows[j][k]);
            let (f, g, inverse) = (left(i), left(k), det.recip());
            found[4 + 2 * j] = (f * q[1] - g * p[1]) * inverse;
            found[5 + 2 * j] = (p[0] * g - q[0] * f) * inverse;
        }
    }
    found
        .iter()
        .flatten()
        .all(|x| x.is_finite())
        .then_some(found)
}

/// How carefully a path is followed: the first correction after a step, beside the unknowns' size, that is aimed at and that is too much.
#[derive(Clone, Copy)]
pub(super) struct Care {
    aim: f64,
    most: f64,
}

/// The usual care, and that for paths that were lost or met another.
pub(super) const CARES: [Care; 2] = [
    Care {
        aim: 1e-5,
        most: 3e-4,
    },
    Care {
        aim: 1e-9,
        most: 1e-7,
    },
];

/// Where a path ended.
pub(super) enum End {
    /// At a regular solution.
    Finite(State),
    /// Its unknowns grew without bound.
    Infinite,
    /// It could not be followed.
    Lost,
}

/// Unknowns beyond which a path has gone to infinity, in units of the frame.
const INFINITY: f64 = 1e8;
/// Steps of a path at most, and the shortest.
const STEPS: usize = 5000;
const SHORTEST: f64 = 1e-12;
/// A correction, beside the unknowns' size, after which the next changes nothing on the way, and at the end.
const ON_THE_WAY: f64 = 1e-7;
const AT_THE_END: f64 = 1e-13;
/// What is left of the way to a solution at infinity where following ends, and by how much the unknowns there have grown at least
/// while a hundredth of it remained: like its sixth root.
const NEAR_THE_END: f64 = 1e-3;
const GROWTH: f64 = 2.1;
/// Places passed that the predictor looks back to.
const MEMORY: usize = 3;
/// Corrections at one place at most.
const CORRECTIONS: usize = 4;

/// Leads a solution from what is given at the start to the end.
pub(super) fn follow(start: &State, from: &Given, to: &Given, care: Care) -> End {
    let rate = to.less(from);
    let (mut x, mut t, mut step) = (*start, 0.0, 0.02_f64);
    // How much was left of the way, and the unknowns' size, whenever a hundredth of what was left last remained.
    let mut sizes: Vec<(f64, f64)> = vec![(1.0, largest(start))];
    let Some([_, slope]) = solve(&x, from, &rate) else {
        return End::Lost;
    };
    let mut passed = vec![Passed { t, x, slope }];
    for _ in 0..STEPS {
        if t >= 1.0 {
            break;
        }
        let now = step.min(1.0 - t);
        let next_t = if now == 1.0 - t { 1.0 } else { t + now };
        let predicted = match passed.as_slice() {
            [first] => runge_kutta(&first.x, &first.slope, from, to, &rate, t, now),
            several => Some(hermite(several, next_t)),
        };
        let given = from.towards(to, next_t);
        let corrected =
            predicted.and_then(|guess| correct(guess, &given, &rate, care, next_t == 1.0));
        match corrected {
            Some((there, first, slope)) => {
                // The predictor's error goes with the power of the step that the places passed give.
                let order = 2 * passed.len().max(2);
                (x, t) = (there, next_t);
                if passed.len() == MEMORY {
                    passed.remove(0);
                }
                passed.push(Passed { t, x, slope });
                if largest(&x) > INFINITY {
                    return End::Infinite;
                }
                if sizes.last().is_some_and(|(left, _)| 1.0 - t < 1e-2 * left) {
                    sizes.push((1.0 - t, largest(&x)));
                }
                let room = care.aim / first.max(f64::MIN_POSITIVE);
                step = now * math::powf(room, 1.0 / order as f64).clamp(0.3, 2.0);
            }
            None => {
                step = now * 0.35;
                // What lies far back does not help where the path bends.
                passed.drain(..passed.len().saturating_sub(2));
                if step < SHORTEST {
                    break;
                }
            }
        }
    }
    if t >= 1.0 {
        End::Finite(x)
    } else if let [.., (_, before), (left, size)] = sizes[..]
        && left < NEAR_THE_END
        && size > GROWTH * before
    {
        // A path that runs away slows down as it grows: like a root of what is left of the way.
        End::Infinite
    } else {
        End::Lost
    }
}

fn largest(x: &State) -> f64 {
    x.iter().fold(0.0, |m: f64, c| m.max(c.norm_sqr())).sqrt()
}

/// Newton's method from a guess: the solution, the first correction, and the tangent.
fn correct(
    mut x: State,
    given: &Given,
    rate: &Given,
    care: Care,
    is_end: bool,
) -> Option<(State, f64, State)> {
    let (mut first, mut last) = (0.0, f64::INFINITY);
    let enough = if is_end { AT_THE_END } else { ON_THE_WAY };
    for round in 0..if is_end { 2 * CORRECTIONS } else { CORRECTIONS } {
        let [correction, tangent] = solve(&x, given, rate)?;
        let mut square = 0.0_f64;
        for (a, b) in x.iter_mut().zip(&correction) {
            *a -= *b;
            square = math::max(square, b.norm_sqr() / (1.0 + a.norm_sqr()));
        }
        let change = square.sqrt();
        if round == 0 {
            first = change;
        }
        if !(change <= if round == 0 { care.most } else { last }) {
            // At the end rounding stops the corrections from shrinking.
            return (is_end && last < 1e-9).then_some((x, first, tangent));
        }
        last = change;
        if change <= enough {
            return Some((x, first, tangent));
        }
    }
    (is_end && last < 1e-9)
        .then(|| solve(&x, given, rate).map(|[_, tangent]| (x, first, tangent)))?
}

/// x - slope * step and so on: slopes are taken off.
fn ahead(x: &State, slope: &State, step: f64) -> State {
    std::array::from_fn(|k| x[k] - slope[k] * step)
}

fn runge_kutta(
    x: &State,
    k1: &State,
    from: &Given,
    to: &Given,
    rate: &Given,
    t: f64,
    step: f64,
) -> Option<State> {
    let slope = |x: &State, t: f64| Some(solve(x, &from.towards(to, t), rate)?[1]);
    let k2 = slope(&ahead(x, k1, 0.5 * step), t + 0.5 * step)?;
    let k3 = slope(&ahead(x, &k2, 0.5 * step), t + 0.5 * step)?;
    let k4 = slope(&ahead(x, &k3, step), t + step)?;
    Some(std::array::from_fn(|k| {
        x[k] - (k1[k] + (k2[k] + k3[k]) * 2.0 + k4[k]) * (step / 6.0)
    }))
}

/// A place passed, with the solution and its slope there.
#[derive(Clone, Copy)]
struct Passed {
    t: f64,
    x: State,
    slope: State,
}

/// The polynomial through places with their slopes (C. Hermite), further on.
fn hermite(passed: &[Passed], t: f64) -> State {
    let mut found = [C::zero(); UNKNOWNS];
    for (i, here) in passed.iter().enumerate() {
        let (mut basis, mut slope) = (1.0, 0.0);
        for (j, other) in passed.iter().enumerate() {
            if j != i {
                basis *= (t - other.t) / (here.t - other.t);
                slope += 1.0 / (here.t - other.t);
            }
        }
        let square = basis * basis;
        let of_value = (1.0 - 2.0 * (t - here.t) * slope) * square;
        let of_slope = (t - here.t) * square;
        for (sum, (x, s)) in found.iter_mut().zip(here.x.iter().zip(&here.slope)) {
            *sum += *x * of_value - *s * of_slope;
        }
    }
    found
}

/// Whether two solutions are one.
pub(super) fn is_same(x: &State, y: &State) -> bool {
    (x.iter().zip(y)).all(|(a, b)| (*a - *b).norm() < 1e-6 * (1.0 + a.norm()))
}
