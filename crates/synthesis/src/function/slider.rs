//! Function generation with a slider-crank: a slider goes as a crank turns.
//!
//! The crank's pivot at 0, the guide along the first axis at the height h; u the crank at the zero of its dial, X the slider's place at
//! the zero of its scale. |u e - (X + s) - i h| = b is, halved, K + s X + s^2 / 2 - s Re(u e) - Re(m e) = 0 with m = u (X - i h), linear in K, X,
//! u, m and the factor of s^2 / 2. Five conditions leave a plane, and Re(m / u) = X is a cubic there.

use kempe_linear::C;
use kempe_number::math;

use super::{CONDITIONS, SAME_ANGLE};
use crate::error::{SynthesisError, all_finite, balanced};
use crate::four_bar::sign;
use crate::kernel::{DependentRow, kernel};
use crate::newton::{Products, Row, polished};
use crate::polynomial::directions;
use crate::pose::{Line, Pose};
use crate::slider_crank::SliderCrank;

/// A crank's angle and a slider's place, both from the zero of their scales, and how the slider is to move there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliderPoint {
    /// The crank's angle, rad.
    pub angle: f64,
    /// The slider's place along the guide.
    pub place: f64,
    /// The slider's change for the crank's, per rad.
    pub rate: Option<f64>,
    /// The change of that rate, per rad^2; only where the rate is given.
    pub second_rate: Option<f64>,
}

impl SliderPoint {
    /// An angle in rad and a place.
    pub const fn new(angle: f64, place: f64) -> Self {
        Self {
            angle,
            place,
            rate: None,
            second_rate: None,
        }
    }

    /// The same with the slider's rate, per rad of the crank.
    pub const fn with_rate(self, rate: f64) -> Self {
        Self {
            rate: Some(rate),
            ..self
        }
    }

    /// The same with the change of the rate, per rad^2.
    pub const fn with_second_rate(self, rate: f64) -> Self {
        Self {
            second_rate: Some(rate),
            ..self
        }
    }

    pub(super) fn is_finite(&self) -> bool {
        let all = [
            Some(self.angle),
            Some(self.place),
            self.rate,
            self.second_rate,
        ];
        all.iter().flatten().all(|x| x.is_finite())
    }
}

/// A slider-crank that generates a function: the crank's pivot at 0, the guide along the first axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliderFunction {
    /// The crank at the zero of its dial.
    pub crank: C,
    /// The slider's pin at the zero of its scale: its place along the guide, and the guide's height.
    pub slider: C,
    /// The coupler's length.
    pub coupler: f64,
}

impl SliderFunction {
    /// The slider's place on its scale at a crank's angle (rad), the slider ahead of the crank's end (1) or behind it (-1); `None` where
    /// the linkage does not close.
    pub fn place(&self, angle: f64, branch: i8) -> Option<f64> {
        let (end, square) = self.reach(angle);
        (square >= 0.0).then(|| end.re + f64::from(branch) * square.sqrt() - self.slider.re)
    }

    /// The same; where the linkage does not close, at the dead centre that is the nearest.
    pub(super) fn nearest_place(&self, angle: f64, branch: i8) -> f64 {
        let (end, square) = self.reach(angle);
        end.re + f64::from(branch) * square.max(0.0).sqrt() - self.slider.re
    }

    /// The crank's end, and the square of how far from it along the guide the slider is.
    fn reach(&self, angle: f64) -> (C, f64) {
        let end = self.crank * C::from_polar(1.0, angle);
        let height = self.slider.im - end.im;
        (end, self.coupler * self.coupler - height * height)
    }

    /// The cosine of the transmission angle, between the coupler and what is square to the guide; beyond 1 it does not close.
    pub(super) fn transmission_cosine(&self, angle: f64) -> f64 {
        let end = self.crank * C::from_polar(1.0, angle);
        (self.slider.im - end.im) / self.coupler
    }

    /// On which side of the crank's end the slider is, at an angle (rad) and a place: 1 ahead, -1 behind.
    pub fn branch(&self, angle: f64, place: f64) -> i8 {
        let end = self.crank * C::from_polar(1.0, angle);
        sign(self.slider.re + place - end.re)
    }

    /// Its slider-crank: the crank's pivot at 0, moving pivots as points of a coupler that lies along its own first axis.
    pub fn slider_crank(&self) -> SliderCrank {
        SliderCrank {
            fixed: C::zero(),
            crank: self.crank.norm(),
            moving: [C::zero(), C::from(self.coupler)],
            guide: Line {
                point: C::new(0.0, self.slider.im),
                direction: C::one(),
            },
        }
    }

    /// The pose of that coupler at an angle (rad) and a place that it takes together.
    pub fn pose(&self, angle: f64, place: f64) -> Pose {
        let end = self.crank * C::from_polar(1.0, angle);
        Pose {
            origin: end,
            angle: (self.slider + C::from(place) - end).arg(),
        }
    }
}

/// All slider-cranks whose slider is at places as its crank is at angles: five conditions, counting each pair, rate, change of a rate, a given
/// zero of the crank's dial (its angle from the guide there, rad) and a given place of the slider's zero (from the crank's pivot) as
/// one. Up to three with both free.
///
/// # Errors
/// As of [`functions`](crate::functions).
pub fn slider_functions(
    points: &[SliderPoint],
    crank_zero: Option<f64>,
    slider_zero: Option<f64>,
) -> Result<Vec<SliderFunction>, SynthesisError> {
    let zeros = [crank_zero, slider_zero];
    all_finite(
        (points.iter().map(SliderPoint::is_finite))
            .chain(zeros.iter().flatten().map(|x| x.is_finite())),
    )?;
    for second in 0..points.len() {
        for first in 0..second {
            let (p, q) = (points[first], points[second]);
            if math::within_half_a_turn(p.angle - q.angle).abs() <= SAME_ANGLE {
                return Err(if p.place == q.place {
                    SynthesisError::Repeated { first, second }
                } else {
                    SynthesisError::Contradictory { first, second }
                });
            }
        }
    }
    // Places from their middle, in units of their spread.
    let (low, high) = (points.iter()).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| {
        (l.min(p.place), h.max(p.place))
    });
    let rates = (points.iter()).fold(0.0, |m: f64, p| {
        m.max(p.rate.unwrap_or(0.0).abs())
            .max(p.second_rate.unwrap_or(0.0).abs())
    });
    let (middle, size) = (0.5 * (low + high), math::max(0.5 * (high - low), rates));
    if !(size > 0.0) {
        return Err(SynthesisError::Dependent { datum: 0 });
    }
    let mut rows: Vec<Row> = Vec::with_capacity(CONDITIONS);
    let mut datum = Vec::with_capacity(CONDITIONS);
    for (k, point) in points.iter().enumerate() {
        if point.rate.is_none() && point.second_rate.is_some() {
            return Err(SynthesisError::TooFew {
                equations: 1,
                unknowns: 2,
            });
        }
        let more = rows_of(point, middle, size);
        datum.extend(more.iter().map(|_| k));
        rows.extend(more);
    }
    if let Some(zero) = crank_zero {
        let (s, c) = math::sin_cos(zero);
        rows.push([0.0, 0.0, 0.0, -s, c, 0.0, 0.0]);
        datum.push(points.len());
    }
    if let Some(zero) = slider_zero {
        rows.push([0.0, 1.0, -(zero + middle) / size, 0.0, 0.0, 0.0, 0.0]);
        datum.push(points.len());
    }
    balanced(rows.len(), CONDITIONS)?;
    let [one, other] = kernel::<7, 2>(&rows)
        .map_err(|DependentRow(row)| SynthesisError::Dependent { datum: datum[row] })?;
    let mut found: Vec<SliderFunction> = Vec::new();
    for [x, y] in directions(&cubic(&one, &other)) {
        let at: Row = std::array::from_fn(|k| x * one[k] + y * other[k]);
        let Some(scaled) = improved(&rows, &at) else {
            continue;
        };
        let bar = SliderFunction {
            crank: scaled.crank.scale(size),
            slider: scaled.slider.scale(size) - C::from(middle),
            coupler: scaled.coupler * size,
        };
        let twice = found.iter().any(|known| {
            let near = |a: C, b: C| (a - b).norm() <= 1e-7 * (size + a.norm());
            near(known.crank, bar.crank) && near(known.slider, bar.slider)
        });
        if !twice {
            found.push(bar);
        }
    }
    Ok(found)
}

/// The condition of a pair and its derivatives to the angle.
fn rows_of(point: &SliderPoint, middle: f64, size: f64) -> Vec<Row> {
    let s = (point.place - middle) / size;
    let e = C::from_polar(1.0, point.angle);
    let turned = C::i() * e;
    let row =
        |k: f64, x: f64, w: f64, by_u: C, by_m: C| [k, x, w, -by_u.re, by_u.im, -by_m.re, by_m.im];
    let mut rows = vec![row(1.0, s, 0.5 * s * s, e * s, e)];
    if let Some(rate) = point.rate.map(|r| r / size) {
        rows.push(row(0.0, rate, s * rate, e * rate + turned * s, turned));
        if let Some(second) = point.second_rate.map(|r| r / size) {
            rows.push(row(
                0.0,
                second,
                rate * rate + s * second,
                e * (second - s) + turned * (2.0 * rate),
                -e,
            ));
        }
    }
    rows
}

/// Re(m conj(u)) w - |u|^2 X on the plane of two vectors.
fn cubic(one: &Row, other: &Row) -> [f64; 4] {
    let parts = |x: &Row| (x[1], x[2], C::new(x[3], x[4]), C::new(x[5], x[6]));
    let both = [parts(one), parts(other)];
    let mut cubic = [0.0; 4];
    for (i, (_, _, _, m)) in both.iter().enumerate() {
        for (j, (_, _, u, _)) in both.iter().enumerate() {
            for (k, (x, w, _, _)) in both.iter().enumerate() {
                let (_, _, u_first, _) = both[i];
                cubic[i + j + k] += (*m * u.conj()).re * w - (u_first * u.conj()).re * x;
            }
        }
    }
    cubic
}

/// What is left of a solution's conditions, and the shortest crank and coupler in units of the slider's way.
const SOLVED: f64 = 1e-11;
const SHORTEST: f64 = 1e-6;

/// K, X, h and u.
struct CrankAndSlider;

impl Products<CONDITIONS> for CrankAndSlider {
    fn products(x: &[f64; CONDITIONS]) -> Row {
        let m = C::new(x[3], x[4]) * C::new(x[1], -x[2]);
        [x[0], x[1], 1.0, x[3], x[4], m.re, m.im]
    }

    /// m = u (X - i h): Re(c m) with c = (row[5], -row[6]).
    fn derivatives(row: &Row, x: &[f64; CONDITIONS]) -> [f64; CONDITIONS] {
        let c = C::new(row[5], -row[6]);
        let (by_slider, by_u) = (c * C::new(x[3], x[4]), c * C::new(x[1], -x[2]));
        [
            row[0],
            row[1] + by_slider.re,
            by_slider.im,
            row[3] + by_u.re,
            row[4] - by_u.im,
        ]
    }
}

/// The slider-crank of a point of the plane; `None` where it does not solve the conditions or no linkage is meant.
fn improved(rows: &[Row], at: &Row) -> Option<SliderFunction> {
    let w = at[2];
    let u = C::new(at[3], at[4]).scale(1.0 / w);
    let m = C::new(at[5], at[6]).scale(1.0 / w);
    let h = -(m * u.conj()).im / u.norm_sqr();
    let start = [at[0] / w, at[1] / w, h, u.re, u.im];
    if !start.iter().all(|x| x.is_finite()) || u.norm() < SHORTEST {
        return None;
    }
    let (x, left) = polished::<CONDITIONS, CrankAndSlider>(rows, start, f64::INFINITY);
    let (crank, slider) = (C::new(x[3], x[4]), C::new(x[1], x[2]));
    let square = crank.norm_sqr() + slider.norm_sqr() - 2.0 * x[0];
    (left <= SOLVED && square > SHORTEST * SHORTEST).then(|| SliderFunction {
        crank,
        slider,
        coupler: square.sqrt(),
    })
}
