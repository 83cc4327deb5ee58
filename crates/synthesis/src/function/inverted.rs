//! Function generation with an inverted slider-crank: a guide that turns about its pivot as a crank's end drives it.
//!
//! Pivots at 0 and 1; at the zero of the dials the crank is u and the guide lies along c. The crank's end stays beside the guide by h:
//! Im(conj(c q) (u e - 1)) = h, linear and homogeneous in c, n = u conj(c) and h: four conditions leave one linkage.

use kempe_linear::C;
use kempe_number::math;

use super::{DialZeros, PrecisionPoint, SAME_ANGLE, distinct};
use crate::error::{SynthesisError, all_finite, balanced};
use crate::kernel::{DependentRow, kernel};
use crate::polynomial::directions;
use crate::pose::{Line, Pose, cross};
use crate::slider_crank::InvertedSliderCrank;

/// An inverted slider-crank that generates a function, with the fixed pivots at 0 and 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InvertedSliderFunction {
    /// The crank at the zero of its dial, from 0.
    pub crank: C,
    /// The guide's direction at the zero of its dial, of length 1.
    pub guide: C,
    /// How far to the left of the parallel to the guide through its pivot the crank's end stays: zero where the guide passes through
    /// the pivot.
    pub offset: f64,
}

impl InvertedSliderFunction {
    /// By how much the crank's end misses the guide at two angles of the dials, rad.
    pub fn residual(&self, crank: f64, guide: f64) -> f64 {
        let along = self.guide * C::from_polar(1.0, guide);
        let end = self.crank * C::from_polar(1.0, crank) - C::one();
        cross(along, end) - self.offset
    }

    /// Its inverted slider-crank: fixed pivots at 0 and 1, the crank's end as the origin of a body whose first axis is along the guide.
    pub fn slider_crank(&self) -> InvertedSliderCrank {
        InvertedSliderCrank {
            fixed: [C::zero(), C::one()],
            crank: self.crank.norm(),
            moving: C::zero(),
            guide: Line {
                point: C::new(0.0, -self.offset),
                direction: C::one(),
            },
        }
    }

    /// The pose of that body at two angles of the dials, rad, which it takes together.
    pub fn pose(&self, crank: f64, guide: f64) -> Pose {
        Pose {
            origin: self.crank * C::from_polar(1.0, crank),
            angle: self.guide.arg() + guide,
        }
    }
}

/// Unknowns but for a factor.
const UNKNOWNS: usize = 4;

/// The inverted slider-cranks that take pairs of angles together: four conditions, counting each pair, ratio, rate of a ratio and given zero of a
/// dial as one; one linkage, or two with the crank's zero given.
///
/// # Errors
/// As of [`functions`](crate::functions).
pub fn inverted_slider_functions(
    points: &[PrecisionPoint],
    zeros: DialZeros,
) -> Result<Vec<InvertedSliderFunction>, SynthesisError> {
    all_finite(points.iter().map(PrecisionPoint::is_finite))?;
    let pairs: Vec<[f64; 2]> = points.iter().map(|p| [p.input, p.output]).collect();
    distinct(&pairs, |_| SAME_ANGLE, true)?;
    let mut rows: Vec<[f64; 5]> = Vec::with_capacity(UNKNOWNS);
    let mut datum = Vec::with_capacity(UNKNOWNS);
    for (k, point) in points.iter().enumerate() {
        let more = rows_of(point);
        datum.extend(more.iter().map(|_| k));
        rows.extend(more);
    }
    datum.push(points.len());
    if let Some(zero) = zeros.output {
        let (s, c) = math::sin_cos(zero);
        rows.push([-s, c, 0.0, 0.0, 0.0]);
    }
    balanced(rows.len() + usize::from(zeros.input.is_some()), UNKNOWNS)?;
    let dependent =
        |DependentRow(row): DependentRow| SynthesisError::Dependent { datum: datum[row] };
    let all: Vec<[f64; 5]> = match zeros.input {
        None => kernel::<5, 1>(&rows).map_err(dependent)?.to_vec(),
        Some(zero) => {
            // The crank along its zero: Im(n c e^(-i zero)) = 0, a quadratic.
            let [a, b] = kernel::<5, 2>(&rows).map_err(dependent)?;
            let turn = C::from_polar(1.0, -zero);
            let form =
                |p: &[f64; 5], r: &[f64; 5]| (C::new(p[2], p[3]) * C::new(r[0], r[1]) * turn).im;
            let mixed = form(&a, &b) + form(&b, &a);
            (directions(&[form(&a, &a), mixed, form(&b, &b)]).into_iter())
                .map(|[x, y]| std::array::from_fn(|k| a[k] * x + b[k] * y))
                .collect()
        }
    };
    Ok(all
        .iter()
        .filter_map(|x| {
            let (c, n) = (C::new(x[0], x[1]), C::new(x[2], x[3]));
            let size = c.norm();
            let crank = n * c.conj().recip();
            let bar = InvertedSliderFunction {
                crank,
                guide: c.scale(1.0 / size),
                offset: x[4] / size,
            };
            let is_linkage = crank.is_finite() && size > SHORTEST && crank.norm() > SHORTEST;
            is_linkage.then_some(bar)
        })
        .collect())
}

/// Links shorter than this, beside the frame or as long as one beside another this short, are none.
const SHORTEST: f64 = 1e-9;

/// -Im(conj(c) conj(q)) + Im(n e conj(q)) - h, and its derivatives to the input.
fn rows_of(point: &PrecisionPoint) -> Vec<[f64; 5]> {
    let (e, q) = (
        C::from_polar(1.0, point.input),
        C::from_polar(1.0, point.output),
    );
    let between = e * q.conj();
    // Im(c q) + Im(n b) - h k: conj(c q) has the opposite imaginary part.
    let row = |a: C, b: C, k: f64| [a.im, a.re, b.im, b.re, -k];
    let mut rows = vec![row(q, between, 1.0)];
    if let Some(ratio) = point.ratio {
        let i = C::i();
        rows.push(row(i * q * ratio, i * between * (1.0 - ratio), 0.0));
        if let Some(rate) = point.ratio_rate {
            let second = |z: C, turn: f64, turn_rate: f64| z * C::new(-turn * turn, turn_rate);
            rows.push(row(
                second(q, ratio, rate),
                second(between, 1.0 - ratio, -rate),
                0.0,
            ));
        }
    }
    rows
}
