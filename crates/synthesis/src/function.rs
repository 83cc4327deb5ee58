//! Function generation: four-bars whose second link turns as the first one asks.
//!
//! With the fixed pivots at 0 and 1, the first link's vector u and the second's v at the zero of their dials, turned by e and q, the
//! coupler's length is kept where K + Re(v q) - Re(u e) - Re(u conj(v) e / q) = 0: F. Freudenstein's equation (1955), linear in K, u, v and
//! p = u conj(v), and so are its derivatives. Five conditions leave two of the seven free; what makes a product of p is a cubic in their
//! ratio.

mod dials;
mod driven;
mod inverted;
mod least_squares;
mod slider;
mod slider_fit;
mod two_lengths;

pub use dials::{Dials, chebyshev_spacing};
pub use inverted::{InvertedSliderFunction, inverted_slider_functions};
pub use least_squares::{Fit, fit_driven_function, fit_function, fit_lengths};
pub use slider::{SliderFunction, SliderPoint, slider_functions};
pub use slider_fit::{SliderFit, fit_driven_slider_function, fit_slider_function};
pub use two_lengths::{TwoLengths, two_lengths};

use kempe_linear::C;
use kempe_number::math;

use crate::error::{SynthesisError, all_finite, balanced};
use crate::four_bar::{FourBar, sign};
use crate::kernel::{DependentRow, kernel};
use crate::newton::{Products, Row, polished};
use crate::polynomial::directions;
use crate::pose::{Pose, cross};

/// A pair of angles that a linkage is to take together, both from the zero of their dials, and how they are to change there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrecisionPoint {
    /// The first link's angle, rad.
    pub input: f64,
    /// The second link's angle, rad.
    pub output: f64,
    /// The second's change for that of the first, d output / d input.
    pub ratio: Option<f64>,
    /// The change of that ratio, d^2 output / d input^2, 1/rad; only where the ratio is given.
    pub ratio_rate: Option<f64>,
}

impl PrecisionPoint {
    /// A pair of angles in rad, without conditions on their change.
    pub const fn new(input: f64, output: f64) -> Self {
        Self {
            input,
            output,
            ratio: None,
            ratio_rate: None,
        }
    }

    /// The same with the ratio d output / d input.
    pub const fn with_ratio(self, ratio: f64) -> Self {
        Self {
            ratio: Some(ratio),
            ..self
        }
    }

    /// The same with d^2 output / d input^2, 1/rad.
    pub const fn with_ratio_rate(self, rate: f64) -> Self {
        Self {
            ratio_rate: Some(rate),
            ..self
        }
    }

    fn is_finite(&self) -> bool {
        let all = [
            Some(self.input),
            Some(self.output),
            self.ratio,
            self.ratio_rate,
        ];
        all.iter().flatten().all(|x| x.is_finite())
    }
}

/// Where the links are when their dials show zero: angles from the line of the fixed pivots, rad, or left to the synthesis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DialZeros {
    /// Of the first link.
    pub input: Option<f64>,
    /// Of the second.
    pub output: Option<f64>,
}

impl DialZeros {
    /// How many pairs determine a four-bar.
    fn exact(&self) -> usize {
        CONDITIONS - usize::from(self.input.is_some()) - usize::from(self.output.is_some())
    }
}

/// A four-bar that generates a function, with the fixed pivots at 0 and 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FunctionFourBar {
    /// The first link at the zero of its dial, from 0.
    pub input: C,
    /// The second link at the zero of its dial, from 1.
    pub output: C,
    /// The coupler's length.
    pub coupler: f64,
}

impl FunctionFourBar {
    /// The coupler's vector at two angles of the dials, rad.
    pub fn coupler_at(&self, input: f64, output: f64) -> C {
        C::one() + self.output * C::from_polar(1.0, output) - self.input * C::from_polar(1.0, input)
    }

    /// The branch with the first link driven, at two angles of the dials, rad: as of [`FourBar::branch`].
    pub fn branch(&self, input: f64, output: f64) -> i8 {
        let turned = self.output * C::from_polar(1.0, output);
        sign(cross(self.coupler_at(input, output), turned))
    }

    /// The output's angle (rad, from the zero of its dial, within half a turn of `near`) at an input's, on a branch; `None` where
    /// the linkage does not close.
    pub fn output_angle(&self, input: f64, branch: i8, near: f64) -> Option<f64> {
        let (x, cos) = self.triangle(input);
        (cos.abs() <= 1.0).then(|| self.turned(x, cos, branch, near))
    }

    /// The same; where the linkage does not close, at the dead centre that is the nearest.
    fn nearest_output_angle(&self, input: f64, branch: i8, near: f64) -> f64 {
        let (x, cos) = self.triangle(input);
        self.turned(x, cos.clamp(-1.0, 1.0), branch, near)
    }

    /// |x + v q| = b with x = 1 - u e: Re(conj(x) v q) is known, here over |x| |v|.
    fn triangle(&self, input: f64) -> (C, f64) {
        let x = C::one() - self.input * C::from_polar(1.0, input);
        let (far, c) = (x.norm(), self.output.norm());
        let cos = (self.coupler * self.coupler - far * far - c * c) / (2.0 * far * c);
        (x, cos)
    }

    fn turned(&self, x: C, cos: f64, branch: i8, near: f64) -> f64 {
        let side = f64::from(branch);
        let turned = x * C::new(cos, side * (1.0 - cos * cos).sqrt()) * self.output.conj();
        near + math::within_half_a_turn(math::atan2(turned.im, turned.re) - near)
    }

    /// The cosine of the transmission angle, between coupler and second link, at an input's angle, rad; beyond 1 it does not close.
    fn transmission_cosine(&self, input: f64) -> f64 {
        let far = (C::one() - self.input * C::from_polar(1.0, input)).norm();
        let (b, c) = (self.coupler, self.output.norm());
        (b * b + c * c - far * far) / (2.0 * b * c)
    }

    /// Its four-bar: fixed pivots at 0 and 1, moving ones as points of a coupler that lies along its own first axis.
    pub fn four_bar(&self) -> FourBar {
        FourBar {
            fixed: [C::zero(), C::one()],
            moving: [C::zero(), C::from(self.coupler)],
            lengths: [self.input.norm(), self.output.norm()],
        }
    }

    /// The pose of that coupler at two angles of the dials, rad, which it takes together.
    pub fn pose(&self, input: f64, output: f64) -> Pose {
        Pose {
            origin: self.input * C::from_polar(1.0, input),
            angle: self.coupler_at(input, output).arg(),
        }
    }
}

/// Conditions that leave a cubic.
const CONDITIONS: usize = 5;
/// Two dial angles nearer than this, rad, are one.
const SAME_ANGLE: f64 = 1e-11;

/// All four-bars that take pairs of angles together: five conditions, counting each pair, ratio, rate of a ratio and given zero of a dial as
/// one. Up to three with both zeros free, two with one, one with both given.
///
/// A link may come out along the opposite of a given zero: the pointer is then the link's extension. About 5 us.
///
/// # Errors
/// Conditions too few or too many, not finite, repeated or contradictory (one input, two outputs), or dependent. What no real linkage
/// keeps gives an empty list.
///
/// # Example
/// ```
/// use kempe_synthesis::{DialZeros, PrecisionPoint, functions};
///
/// // Inputs of 45, 90, 135 degrees with outputs of 52, 82, 112 degrees.
/// let points = [(45.0, 52.0), (90.0, 82.0), (135.0, 112.0_f64)]
///     .map(|(i, o): (f64, f64)| PrecisionPoint::new(i.to_radians(), o.to_radians()));
/// let zeros = DialZeros { input: Some(0.0), output: Some(0.0) };
/// let [bar] = functions(&points, zeros)?[..] else { unreachable!() };
/// assert!((bar.input.re - 0.552585713179).abs() < 1e-12);
/// assert!((bar.coupler - 1.144725789330).abs() < 1e-12);
/// assert!((bar.output.re - 0.822207109373).abs() < 1e-12);
/// # Ok::<(), kempe_synthesis::SynthesisError>(())
/// ```
pub fn functions(
    points: &[PrecisionPoint],
    zeros: DialZeros,
) -> Result<Vec<FunctionFourBar>, SynthesisError> {
    let zero_list = [zeros.input, zeros.output];
    all_finite(
        (points.iter().map(PrecisionPoint::is_finite))
            .chain(zero_list.iter().flatten().map(|x| x.is_finite())),
    )?;
    let inputs: Vec<[f64; 2]> = points.iter().map(|p| [p.input, p.output]).collect();
    distinct(&inputs, |k| SAME_ANGLE * (1.0 + inputs[k][0].abs()), true)?;
    let mut rows = Vec::with_capacity(CONDITIONS);
    let mut datum = Vec::with_capacity(CONDITIONS);
    for (k, point) in points.iter().enumerate() {
        if point.ratio.is_none() && point.ratio_rate.is_some() {
            return Err(SynthesisError::TooFew {
                equations: 1,
                unknowns: 2,
            });
        }
        let more = rows_of(point);
        datum.extend(more.iter().map(|_| k));
        rows.extend(more);
    }
    // A link along its dial's zero has nothing beside it.
    if let Some(zero) = zeros.output {
        let (s, c) = math::sin_cos(zero);
        rows.push([0.0, -s, c, 0.0, 0.0, 0.0, 0.0]);
        datum.push(points.len());
    }
    if let Some(zero) = zeros.input {
        let (s, c) = math::sin_cos(zero);
        rows.push([0.0, 0.0, 0.0, -s, c, 0.0, 0.0]);
        datum.push(points.len());
    }
    balanced(rows.len(), CONDITIONS)?;
    let [one, other] = kernel::<7, 2>(&rows)
        .map_err(|DependentRow(row)| SynthesisError::Dependent { datum: datum[row] })?;
    Ok(of_plane(&rows, &one, &other))
}

/// The condition of a pair of angles, and its derivatives to the input.
fn rows_of(point: &PrecisionPoint) -> Vec<Row> {
    let (e, q) = (
        C::from_polar(1.0, point.input),
        C::from_polar(1.0, point.output),
    );
    let between = e * q.conj();
    // Re(v a) - Re(u b) - Re(p c) + K k.
    let row = |k: f64, a: C, b: C, c: C| [k, a.re, -a.im, -b.re, b.im, -c.re, c.im];
    let mut rows = vec![row(1.0, q, e, between)];
    let i = C::i();
    if let Some(ratio) = point.ratio {
        rows.push(row(0.0, i * q * ratio, i * e, i * between * (1.0 - ratio)));
        if let Some(rate) = point.ratio_rate {
            let second = |z: C, turn: f64, turn_rate: f64| z * C::new(-turn * turn, turn_rate);
            rows.push(row(
                0.0,
                second(q, ratio, rate),
                second(e, 1.0, 0.0),
                second(between, 1.0 - ratio, -rate),
            ));
        }
    }
    rows
}

/// Whether data are apart by their first entries: equal ones are one datum twice, or, where the second entries differ, contradict.
fn distinct(
    data: &[[f64; 2]],
    tolerance: impl Fn(usize) -> f64,
    angles: bool,
) -> Result<(), SynthesisError> {
    let apart = |a: f64, b: f64| {
        let d = a - b;
        if angles {
            math::within_half_a_turn(d).abs()
        } else {
            d.abs()
        }
    };
    for second in 0..data.len() {
        for first in 0..second {
            if apart(data[first][0], data[second][0]) <= tolerance(second) {
                return Err(
                    if apart(data[first][1], data[second][1]) <= tolerance(second) {
                        SynthesisError::Repeated { first, second }
                    } else {
                        SynthesisError::Contradictory { first, second }
                    },
                );
            }
        }
    }
    Ok(())
}

/// Conditions of a solution vanish to this part of their terms.
const SOLVED: f64 = 1e-11;

/// The four-bars among the combinations of two vectors of unknowns.
fn of_plane(rows: &[Row], one: &Row, other: &Row) -> Vec<FunctionFourBar> {
    let parts = |x: &Row| [C::new(x[1], x[2]), C::new(x[3], x[4]), C::new(x[5], x[6])];
    let ([v1, u1, p1], [v2, u2, p2]) = (parts(one), parts(other));
    let square = [
        u1 * v1.conj(),
        u1 * v2.conj() + u2 * v1.conj(),
        u2 * v2.conj(),
    ];
    let linear = [p1, p2];
    // p = u conj(v) with a factor before both vectors: the quadratic form is parallel to the linear one.
    let mut cubic = [0.0; 4];
    for (i, q) in square.iter().enumerate() {
        for (j, l) in linear.iter().enumerate() {
            cubic[i + j] += (*q * l.conj()).im;
        }
    }
    let mut found: Vec<FunctionFourBar> = Vec::new();
    for [x, y] in directions(&cubic) {
        let q = square[0] * (x * x) + square[1] * (x * y) + square[2] * (y * y);
        let l = p1 * x + p2 * y;
        let factor = (l * q.conj()).re / q.norm_sqr();
        let mut at = [0.0; 5];
        for k in 0..5 {
            at[k] = factor * (x * one[k] + y * other[k]);
        }
        if !at.iter().all(|x| x.is_finite()) {
            continue;
        }
        let Some(bar) = improved(rows, at) else {
            continue;
        };
        let twice = found.iter().any(|known| {
            let near = |a: C, b: C| (a - b).norm() <= 1e-7 * (1e-3 + a.norm());
            near(known.input, bar.input) && near(known.output, bar.output)
        });
        if !twice {
            found.push(bar);
        }
    }
    found
}

/// K, v and u.
struct Links;

impl Products<CONDITIONS> for Links {
    fn products(x: &[f64; CONDITIONS]) -> Row {
        let p = C::new(x[3], x[4]) * C::new(x[1], -x[2]);
        [x[0], x[1], x[2], x[3], x[4], p.re, p.im]
    }

    /// p = u conj(v): Re(c p) with c = (row[5], -row[6]).
    fn derivatives(row: &Row, x: &[f64; CONDITIONS]) -> [f64; CONDITIONS] {
        let c = C::new(row[5], -row[6]);
        let (by_v, by_u) = (c * C::new(x[3], x[4]), c * C::new(x[1], -x[2]));
        [
            row[0],
            row[1] + by_v.re,
            row[2] + by_v.im,
            row[3] + by_u.re,
            row[4] - by_u.im,
        ]
    }
}

/// The four-bar of unknowns improved; `None` where they do not solve the conditions or a link has no length.
fn improved(rows: &[Row], start: [f64; CONDITIONS]) -> Option<FunctionFourBar> {
    let (x, left) = polished::<CONDITIONS, Links>(rows, start, f64::INFINITY);
    let (output, input) = (C::new(x[1], x[2]), C::new(x[3], x[4]));
    let square = 1.0 + input.norm_sqr() + output.norm_sqr() - 2.0 * x[0];
    // The frame seen as a link of length zero solves every such system.
    let shortest = SHORTEST * math::max(1.0, input.norm());
    let is_linkage =
        input.norm() > SHORTEST && output.norm() > SHORTEST && square > shortest * shortest;
    (left <= SOLVED && is_linkage).then(|| FunctionFourBar {
        input,
        output,
        coupler: square.sqrt(),
    })
}

/// Links shorter than this, beside the frame, are none.
const SHORTEST: f64 = 3e-6;
