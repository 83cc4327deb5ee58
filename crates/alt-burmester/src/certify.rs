//! The proof that a real solution exists, by Krawczyk's operator on intervals.
//!
//! A real linkage is four pivots and a turn less one per point, 24 real numbers at most, that make as many real equations zero. For a plain
//! approximate inverse Y of their Jacobian J at x0 and a box U of corrections, if
//!
//!   K(U) = -Y F(x0) + (I - Y J(x0 + U)) U
//!
//! lies in the interior of U, then x0 + U holds exactly one solution, and it is regular (R. Krawczyk, Computing 4:187, 1969; S. M. Rump,
//! Acta Numerica 19:287, 2010, theorem 13.2).
//!
//! Of two solutions a ten thousandth apart rounding of F(x0) alone, times Y, is wider than the box may be. Where the data are exact F(x0) is then taken with
//! twice the digits, at an x0 of as many.

use kempe_linear::{C, Lu};
use kempe_number::{Complex, Interval, Number, math};

use crate::double::Double;
use crate::equations::{PIVOTS, Row, State, link};
use crate::given::{Given, Kind, PLACES, TURNS};

type Z = Complex<Interval>;
type Fine = Complex<Double>;

/// Real unknowns, at most.
const UNKNOWNS: usize = 8 + 2 * PLACES;
/// Boxes tried before a proof is given up.
const INFLATIONS: usize = 10;
/// How much wider than the last image the next box is.
const INFLATION: f64 = 1.5;
/// Half width of the smallest box, beside the unknown's size and one: a box must have an interior.
const SMALLEST: f64 = 1e-17;
/// More than rounding takes from a sum of 24 products, beside the sum of their sizes: 26 units of 2^-53.
const ROUNDING: f64 = 4e-15;
/// Sums of a few dozen non-negative numbers are too small by less than this part.
const SUMMED: f64 = 1.0 + 1e-12;

/// More than rounding takes from an equation in numbers of twice the digits, beside the sum of the sizes of its terms: each of some thirty operations on
/// parts of complex numbers takes less than 2^-103.
const FINE_ROUNDING: f64 = 5e-29;
/// Corrections of a solution that is looked at with twice the digits.
const CORRECTIONS: usize = 3;

/// A linkage is near a proved one by this part of its size: far below what lies between linkages that an engineer would tell apart.
const NEAR: f64 = 1e-8;

/// Real data as bounds: where the proof says that a linkage exists for all data within them.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    kind: Kind,
    place: [Z; PLACES],
    turn: [Z; TURNS],
    /// The places where they are exactly known, and no poses are given.
    exact: Option<[Fine; PLACES]>,
}

/// Equations and their Jacobian on a box.
type Values = [Interval; UNKNOWNS];
type Jacobian = [Values; UNKNOWNS];
/// Row i of a matrix by columns: `[k][i]`.
type Inverse = [[f64; UNKNOWNS]; UNKNOWNS];

impl Bounds {
    /// Bounds of data that are what they are.
    pub fn of(given: &Given) -> Self {
        Self::within(
            given.kind,
            |k| {
                let place = given.place[k];
                Z::new(Interval::from_f64(place.re), Interval::from_f64(place.im))
            },
            |k| Interval::from_f64(given.log_turn[k].im),
        )
        .with_exact(|k| [given.place[k].re, given.place[k].im].map(|x| [x, 0.0]))
    }

    /// With places (x and y) that are exactly sums of two numbers each, the second no more than rounding of the first. Where poses are given this
    /// changes nothing: their turns have no end of digits.
    pub fn with_exact(self, place: impl Fn(usize) -> [[f64; 2]; 2]) -> Self {
        let sum = |[high, low]: [f64; 2]| Double { high, low };
        let places = self.kind.places();
        let exact = (self.kind.turns() == 0).then(|| {
            std::array::from_fn(|k| {
                let [x, y] = if k < places { place(k) } else { [[0.0; 2]; 2] };
                Fine::new(sum(x), sum(y))
            })
        });
        Self { exact, ..self }
    }

    /// Bounds of places less the first, and of angles (rad) of poses after the first, by their numbers.
    pub fn within(
        kind: Kind,
        place: impl Fn(usize) -> Z,
        angle: impl Fn(usize) -> Interval,
    ) -> Self {
        let nothing = Z::zero();
        let mut bounds = Self {
            kind,
            place: [nothing; PLACES],
            turn: [nothing; TURNS],
            exact: None,
        };
        for (k, bound) in bounds.place[..kind.places()].iter_mut().enumerate() {
            *bound = place(k);
        }
        for (k, turn) in bounds.turn[..kind.turns()].iter_mut().enumerate() {
            let (s, c) = angle(k).sin_cos();
            *turn = Z::new(c - 1.0, s);
        }
        bounds
    }

    /// Proves a real solution near a state; `None` where that does not succeed, mostly because the solution is singular or nearly so.
    pub fn certify(&self, state: &State) -> Option<Proved> {
        let middle = real_unknowns(self.kind, state);
        let (value, jacobian) = self.evaluate(&middle.map(Interval::from_f64));
        let inverse = self.inverse(&jacobian)?;
        let nothing = [0.0; UNKNOWNS];
        let proved = self.prove(&inverse, [&middle, &nothing], &value);
        proved.or_else(|| self.certify_finely(&inverse, &middle))
    }

    /// The same with twice the digits, where the data have no bounds but themselves.
    fn certify_finely(&self, inverse: &Inverse, middle: &[f64; UNKNOWNS]) -> Option<Proved> {
        let places = self.exact.as_ref()?;
        let n = self.kind.unknowns();
        let mut at = middle.map(|high| Double { high, low: 0.0 });
        let mut value = fine_values(places, &at);
        for _ in 0..CORRECTIONS {
            for i in 0..n {
                let step = (0..n).fold(0.0, |sum, k| sum + inverse[k][i] * value[k].0.high);
                at[i] -= Double {
                    high: step,
                    low: 0.0,
                };
            }
            value = fine_values(places, &at);
        }
        let bounds = value.map(|(v, off)| Interval::around(v.high, (v.low.abs() + off) * SUMMED));
        let parts = [at.map(|x| x.high), at.map(|x| x.low)];
        self.prove(inverse, parts.each_ref(), &bounds)
    }

    /// An approximate inverse of the middle of a Jacobian.
    fn inverse(&self, jacobian: &Jacobian) -> Option<Inverse> {
        let n = self.kind.unknowns();
        let mut lu = Lu::new(n);
        if !lu.factor(|i, j| jacobian[i][j].midpoint()) {
            return None;
        }
        let mut inverse = [[0.0; UNKNOWNS]; UNKNOWNS];
        for (k, column) in inverse[..n].iter_mut().enumerate() {
            column[k] = 1.0;
            lu.solve(&mut column[..n]);
        }
        Some(inverse)
    }

    /// Krawczyk's operator about a point, the sum of two parts, where the equations have values within bounds.
    fn prove(
        &self,
        inverse: &Inverse,
        [middle, rest]: [&[f64; UNKNOWNS]; 2],
        value: &Values,
    ) -> Option<Proved> {
        let n = self.kind.unknowns();
        let mut image = [Interval::from_f64(0.0); UNKNOWNS];
        for (k, column) in inverse[..n].iter().enumerate() {
            for i in 0..n {
                image[i] -= value[k] * column[i];
            }
        }
        let mut radius = [0.0; UNKNOWNS];
        for i in 0..n {
            radius[i] = INFLATION * image[i].mag() + SMALLEST * (1.0 + middle[i].abs());
        }
        let mut reach = [Interval::from_f64(0.0); UNKNOWNS];
        for _ in 0..INFLATIONS {
            for i in 0..n {
                reach[i] = Interval::around(middle[i], (radius[i] + rest[i].abs()).next_up());
            }
            let (_, jacobian) = self.evaluate(&reach);
            let spread = deviation(inverse, &jacobian, &radius, n);
            let width: [f64; UNKNOWNS] =
                std::array::from_fn(|i| (image[i].mag() + spread[i]) * SUMMED);
            // NaN is inside nothing.
            if (0..n).all(|i| width[i] < radius[i]) {
                return Some(Proved {
                    kind: self.kind,
                    pivots: std::array::from_fn(|i| reach[i]),
                });
            }
            for i in 0..n {
                radius[i] = INFLATION * width[i] + SMALLEST * (1.0 + middle[i].abs());
            }
        }
        None
    }

    /// The equations and their Jacobian on a box.
    fn evaluate(&self, u: &Values) -> (Values, Jacobian) {
        let zero = Interval::from_f64(0.0);
        let mut value = [zero; UNKNOWNS];
        let mut jacobian = [[zero; UNKNOWNS]; UNKNOWNS];
        let at = |k: usize| Z::new(u[2 * k], u[2 * k + 1]);
        let points = self.kind.points();
        let mut row = 0;
        for j in 0..self.kind.places() {
            let turn = if j < points {
                at(4 + j)
            } else {
                self.turn[j - points]
            };
            let place = self.place[j];
            for side in 0..2 {
                let (x, a) = (at(2 * side), at(2 * side + 1));
                let of: Row<Interval> = link(
                    [x, a, x.conj(), a.conj()],
                    [turn, turn.conj()],
                    [place, place.conj()],
                    [Z::zero(); 2],
                );
                value[row] = of.right[0].re;
                let mut derivative = |unknown: usize, by: Z| {
                    jacobian[row][2 * unknown] = by.re * 2.0;
                    jacobian[row][2 * unknown + 1] = by.im * -2.0;
                };
                derivative(2 * side, of.pivot[0]);
                derivative(2 * side + 1, of.pivot[1]);
                if j < points {
                    derivative(4 + j, of.turn[0]);
                }
                row += 1;
            }
            if j < points {
                let k = 8 + 2 * j;
                value[row] = turn.norm_sqr() + turn.re * 2.0;
                jacobian[row][k] = turn.re * 2.0 + 2.0;
                jacobian[row][k + 1] = turn.im * 2.0;
                row += 1;
            }
        }
        (value, jacobian)
    }
}

/// The equations of nine points with twice the digits, each with a bound of what rounding takes from it.
fn fine_values(places: &[Fine; PLACES], u: &[Double; UNKNOWNS]) -> [(Double, f64); UNKNOWNS] {
    let zero = Double {
        high: 0.0,
        low: 0.0,
    };
    let at = |k: usize| Fine::new(u[2 * k], u[2 * k + 1]);
    let size = |z: &Fine| z.re.high.abs() + z.im.high.abs();
    let mut values = [(zero, 0.0); UNKNOWNS];
    for (j, place) in places.iter().enumerate() {
        let turn = at(4 + j);
        let (d, g) = (size(place), size(&turn));
        for side in 0..2 {
            let (x, a) = (at(2 * side), at(2 * side + 1));
            let row: Row<Double> = link(
                [x, a, x.conj(), a.conj()],
                [turn, turn.conj()],
                [*place, place.conj()],
                [Fine::zero(); 2],
            );
            let (of_x, of_a) = (size(&x), size(&a));
            let terms = 2.0 * ((of_a + d) * of_x * g + (of_a + of_x + d) * d);
            values[3 * j + side] = (row.right[0].re, FINE_ROUNDING * terms);
        }
        let unit = turn.norm_sqr() + turn.re * 2.0;
        values[3 * j + 2] = (unit, FINE_ROUNDING * (g * g + 2.0 * g));
    }
    values
}

/// Bounds of |I - Y J| r, with J by its middle and half width, and what rounding takes from the product added.
fn deviation(
    inverse: &Inverse,
    jacobian: &Jacobian,
    radius: &[f64; UNKNOWNS],
    n: usize,
) -> [f64; UNKNOWNS] {
    let mut product = [[0.0; UNKNOWNS]; UNKNOWNS];
    let mut unsure = [[0.0; UNKNOWNS]; UNKNOWNS];
    for k in 0..n {
        for j in 0..n {
            let entry = jacobian[k][j];
            if entry.mag() == 0.0 {
                continue;
            }
            let middle = entry.midpoint();
            let half = (entry.hi() - middle).max(middle - entry.lo()).next_up();
            let slack = half + ROUNDING * middle.abs();
            // Undefined bounds must not disappear.
            let slack = if entry.is_empty() { f64::NAN } else { slack };
            for i in 0..n {
                product[j][i] += inverse[k][i] * middle;
                unsure[j][i] += inverse[k][i].abs() * slack;
            }
        }
    }
    let mut spread = [0.0; UNKNOWNS];
    for j in 0..n {
        product[j][j] -= 1.0;
        for i in 0..n {
            spread[i] += (product[j][i].abs() * (1.0 + ROUNDING) + unsure[j][i]) * radius[j];
        }
    }
    spread.map(|s| s * SUMMED)
}

/// Pivots and turns as real numbers: x, a, y, b, then the turns.
fn real_unknowns(kind: Kind, state: &State) -> [f64; UNKNOWNS] {
    let mut out = [0.0; UNKNOWNS];
    let pivots = [0, 1, 4, 5].map(|k| state[k]);
    let turns = (0..kind.points()).map(|j| state[8 + 2 * j]);
    for (k, z) in pivots.into_iter().chain(turns).enumerate() {
        (out[2 * k], out[2 * k + 1]) = (z.re, z.im);
    }
    out
}

/// A proved linkage: bounds of its pivots.
#[derive(Clone, Copy, Debug)]
pub struct Proved {
    kind: Kind,
    /// x, a, y and b, real and imaginary parts.
    pivots: [Interval; PIVOTS],
}

impl Proved {
    /// Bounds of the moving and the fixed pivot of the first link, then of the second, from the first place of the coupler point.
    pub fn pivots(&self) -> [Z; 4] {
        std::array::from_fn(|k| Z::new(self.pivots[2 * k], self.pivots[2 * k + 1]))
    }

    /// The next cognate of nine points, which exists with this one: as of [`cognate`](crate::cognate).
    pub fn cognate(&self) -> Self {
        let [x, a, y, b] = self.pivots();
        let over = (x - y).recip();
        let next = [(x - a) * y * over, (b * x - a * y) * over, a - x, a];
        Self {
            kind: self.kind,
            pivots: std::array::from_fn(|k| {
                let z = next[k / 2];
                if k % 2 == 0 { z.re } else { z.im }
            }),
        }
    }

    /// Whether a plain solution is certainly near it.
    pub fn is_near(&self, state: &State) -> bool {
        let plain = [0, 1, 4, 5].map(|k| state[k]);
        (self.pivots().iter().zip(plain)).all(|(z, p): (&Z, C)| {
            let off = math::max(
                (z.re - Interval::from_f64(p.re)).mag(),
                (z.im - Interval::from_f64(p.im)).mag(),
            );
            off <= NEAR * (1.0 + p.norm())
        })
    }

    /// Whether another linkage is certainly of another class: by the foci of nine points, by both dyads otherwise.
    pub fn differs(&self, other: &Self) -> bool {
        let (own, of_other) = (self.pivots(), other.pivots());
        if self.kind == Kind::NinePoints {
            let centre = |[x, a, y, b]: [Z; 4]| a + b + (b * x - a * y) * (x - y).recip();
            return any_apart(&[centre(own)], &[centre(of_other)])
                || any_apart(&symmetric(own), &symmetric(of_other));
        }
        let [x, a, y, b] = of_other;
        any_apart(&own, &of_other) && any_apart(&own, &[y, b, x, a])
    }

    /// Whether a plain solution is inside.
    pub fn contains(&self, state: &State) -> bool {
        let plain = [0, 1, 4, 5].map(|k| state[k]);
        (self.pivots().iter().zip(plain))
            .all(|(z, p): (&Z, C)| z.re.contains(p.re) && z.im.contains(p.im))
    }
}

fn any_apart<const N: usize>(a: &[Z; N], b: &[Z; N]) -> bool {
    let apart = |a: Interval, b: Interval| a.hi() < b.lo() || b.hi() < a.lo();
    (a.iter().zip(b)).any(|(a, b)| apart(a.re, b.re) || apart(a.im, b.im))
}

/// The symmetric functions of the three foci beside their sum.
fn symmetric([x, a, y, b]: [Z; 4]) -> [Z; 2] {
    let c = (b * x - a * y) * (x - y).recip();
    [a * b + b * c + c * a, a * b * c]
}
