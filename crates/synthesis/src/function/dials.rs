//! A function of a number as angles of two dials.

use std::f64::consts::PI;

use kempe_number::math;

use super::{FunctionFourBar, PrecisionPoint};
use crate::error::SynthesisError;

/// So many numbers between two, closest at the ends: where the error of an interpolation that is right at them is smallest in its largest,
/// to first order (P. L. Chebyshev, 1854). x = middle - half cos((2 k - 1) pi / 2 n).
pub fn chebyshev_spacing(from: f64, to: f64, count: usize) -> Vec<f64> {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    (0..count)
        .map(|k| middle - half * math::cos((2 * k + 1) as f64 * PI / (2 * count) as f64))
        .collect()
}

/// Scales that show x on the first dial and y on the second, evenly; angles in rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dials {
    /// The range of x.
    pub x: [f64; 2],
    /// Angles of the first dial at the ends of the range of x.
    pub input: [f64; 2],
    /// Two values of y.
    pub y: [f64; 2],
    /// Angles of the second dial at these values of y.
    pub output: [f64; 2],
}

impl Dials {
    /// The first dial's angle for x.
    pub fn input_angle(&self, x: f64) -> f64 {
        scaled(x, self.x, self.input)
    }

    /// The second dial's angle for y.
    pub fn output_angle(&self, y: f64) -> f64 {
        scaled(y, self.y, self.output)
    }

    /// x at an angle of the first dial.
    pub fn x(&self, input: f64) -> f64 {
        scaled(input, self.input, self.x)
    }

    /// Pairs of angles at values of x.
    ///
    /// # Errors
    /// A value of the function that is not finite.
    pub fn points(
        &self,
        xs: &[f64],
        function: impl Fn(f64) -> f64,
    ) -> Result<Vec<PrecisionPoint>, SynthesisError> {
        let point = |(datum, x): (usize, &f64)| {
            let point = PrecisionPoint::new(self.input_angle(*x), self.output_angle(function(*x)));
            let finite = point.input.is_finite() && point.output.is_finite();
            finite
                .then_some(point)
                .ok_or(SynthesisError::NotFinite { datum })
        };
        xs.iter().enumerate().map(point).collect()
    }

    /// Where the output is furthest from the function: x there, and the error (generated less wanted, rad), along the range on the branch
    /// of a pair of angles. `None` where the linkage does not close all along.
    ///
    /// Samples first, then golden sections about the largest.
    pub fn structural_error(
        &self,
        bar: &FunctionFourBar,
        function: impl Fn(f64) -> f64,
        branch: i8,
    ) -> Option<[f64; 2]> {
        let error = |x: f64| {
            let wanted = self.output_angle(function(x));
            bar.output_angle(self.input_angle(x), branch, wanted)
                .map(|angle| angle - wanted)
        };
        let at = |k: usize| self.x[0] + (self.x[1] - self.x[0]) * k as f64 / SAMPLES as f64;
        let mut worst = [self.x[0], error(self.x[0])?];
        let mut place = 0;
        for k in 1..=SAMPLES {
            let here = error(at(k))?;
            if here.abs() > worst[1].abs() {
                (worst, place) = ([at(k), here], k);
            }
        }
        let (mut low, mut high) = (at(place.saturating_sub(1)), at((place + 1).min(SAMPLES)));
        for _ in 0..SECTIONS {
            let (p, q) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
            let (f, g) = (error(p)?, error(q)?);
            for [x, e] in [[p, f], [q, g]] {
                if e.abs() > worst[1].abs() {
                    worst = [x, e];
                }
            }
            if f.abs() > g.abs() {
                high = q;
            } else {
                low = p;
            }
        }
        Some(worst)
    }
}

/// Samples of the structural error: the function may have so many turns of its error, between five points at most six.
const SAMPLES: usize = 200;
/// Golden sections, each to 0.618 of the last.
const SECTIONS: usize = 40;
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// A scale at a value, the range's ends as told to the last bit.
fn scaled(x: f64, from: [f64; 2], to: [f64; 2]) -> f64 {
    let part = (x - from[0]) / (from[1] - from[0]);
    to[0] + part * (to[1] - to[0])
}
