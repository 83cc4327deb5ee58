//! Smallest and largest value of a measure: the samples, and the zeros of the rate between them.

use super::rivals::Rivals;
use super::survey::Point;
use crate::extremes::At;
use crate::force_source::ForceSource;
use crate::measure::ORDER;
use crate::sampler::{Asked, Sampler};

/// What a measure changes by less than this part of itself is rounding, and no extreme.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// A zero of the rate that its series finds within this part of the interval is found: the next step is exact to rounding.
const NEAR: f64 = 1e-6;
/// Steps of Newton's method on a polynomial.
const STEPS: usize = 12;
/// Where two branches seem to meet, both sides are looked at this part of the interval away.
const BESIDE: f64 = 1e-4;
/// Where the motion rests at an end of an interval, the rate is looked at this part of it inside.
const AT_REST: f64 = 1e-4;
/// Where series do not close in on a place by this factor in two rounds, only bisections follow.
const SLOW: f64 = 1e-2;

/// Between two samples something jumps that changes by so many times as much as the rates of both let it, and by more than this part of its size.
const JUMPS: (f64, f64) = (2.0, 1e-9);

/// The extremes of a measure as far as it was looked at.
#[derive(Clone, Debug)]
pub(super) struct Search {
    low: At,
    high: At,
    /// Whether the smallest, and the largest, is closed in on between samples.
    pub wanted: [bool; 2],
    /// Somewhere it has no value.
    pub missing: bool,
    /// The smallest, with their signs turned, and the largest.
    rivals: [Rivals; 2],
}

impl Search {
    /// Of a motion that lasts so long.
    pub fn new(duration: f64) -> Self {
        Self {
            rivals: [Rivals::new(duration), Rivals::new(duration)],
            low: (f64::NAN, f64::INFINITY),
            high: (f64::NAN, f64::NEG_INFINITY),
            wanted: [false; 2],
            missing: false,
        }
    }

    /// Smallest and largest with their times, of samples only where not wanted; `None` where it has no value somewhere.
    pub fn found(&self) -> Option<(At, At)> {
        (!self.missing && !self.low.0.is_nan()).then_some((self.low, self.high))
    }

    /// Adds a sample, and what lies between it and the one before on the same stretch. `known` is how many coefficients of
    /// its series are known.
    pub fn add<F: ForceSource>(
        &mut self,
        sampler: &mut Sampler<F>,
        asked: &Asked,
        known: usize,
        before: Option<Point>,
        now: Point,
    ) {
        if self.missing {
            return;
        }
        if now.value().is_nan() {
            self.missing = true;
            return;
        }
        self.take(now);
        let Some(before) = before else {
            return;
        };
        let width = now.time - before.time;
        let rates = [
            rate_inside(&before, known, width),
            rate_inside(&now, known, -width),
        ];
        let steepest = rates[0].abs().max(rates[1].abs());
        let rounding = ROUNDING * now.value().abs();
        let [lows, highs] = self.wanted;
        if asked.forces && (lows || highs) && jumps(&before, &now) {
            self.take_sides(sampler, asked, [before, now]);
            return;
        }
        let wanted = if rates[0] < 0.0 { lows } else { highs };
        if wanted && rates[0] * rates[1] < 0.0 && steepest * width > rounding {
            self.close_in(sampler, asked, known, [before, now], rates[0]);
        }
    }

    /// Takes what is right before and behind a jump between two samples.
    fn take_sides<F: ForceSource>(
        &mut self,
        sampler: &mut Sampler<F>,
        asked: &Asked,
        [mut a, mut b]: [Point; 2],
    ) {
        loop {
            let middle = 0.5 * (a.time + b.time);
            if !(a.time < middle && middle < b.time) {
                break;
            }
            let point = Point::take(sampler, asked, middle);
            let [before, behind] = [&a, &b].map(|end| (point.value() - end.value()).abs());
            if before > behind {
                b = point;
            } else {
                a = point;
            }
        }
        self.take(a);
        self.take(b);
    }

    fn take(&mut self, point: Point) {
        self.take_value(point.time, point.value());
    }

    /// Takes a value at a time.
    pub fn take_value(&mut self, time: f64, value: f64) {
        // Equal to rounding is not an improvement: the first time counts.
        if value < self.low.1 {
            self.low = (time, value);
        }
        if value > self.high.1 {
            self.high = (time, value);
        }
        let size = self.low.1.abs().max(self.high.1.abs());
        for (rivals, sign) in self.rivals.iter_mut().zip([-1.0, 1.0]) {
            rivals.take((time, sign * value), size);
        }
    }

    /// Times at which it is smallest, and largest, but for rounding; right where that is wanted.
    pub fn rivals(&self) -> [Vec<f64>; 2] {
        self.rivals.each_ref().map(Rivals::times)
    }

    /// Closes in on the change of sign of a rate, which has `sign` behind the first point: where the series of the nearer end says that the rate is zero; where the
    /// series of both ends meet, for a kink; and in the middle, for what is neither. On both sides: there may be a jump.
    fn close_in<F: ForceSource>(
        &mut self,
        sampler: &mut Sampler<F>,
        asked: &Asked,
        known: usize,
        [mut a, mut b]: [Point; 2],
        sign: f64,
    ) {
        let whole = b.time - a.time;
        let mut met = Vec::new();
        let mut look = |a: &mut Point, b: &mut Point, time: f64| {
            if !(a.time < time && time < b.time) {
                return None;
            }
            let point = Point::take(sampler, asked, time);
            *(if point.rate() * sign > 0.0 { a } else { b }) = point;
            met.push(point);
            Some(point)
        };
        let mut bisect_only = false;
        let mut level_at = f64::NAN;
        for round in 0.. {
            let width = b.time - a.time;
            if !bisect_only {
                if let Some(time) = level(&a, &b, known)
                    && let Some(point) = look(&mut a, &mut b, time)
                {
                    let step = zero_of_rate(&point, known).filter(|s| s.abs() <= NEAR * whole);
                    if let Some(step) = step {
                        let last = look(&mut a, &mut b, point.time + step);
                        let last = last.unwrap_or(point);
                        level_at = last.time;
                        self.take(last);
                        break;
                    }
                }
                if let Some(time) = meeting(&a, &b, known) {
                    let beside = BESIDE * (b.time - a.time);
                    look(&mut a, &mut b, time - beside);
                    look(&mut a, &mut b, time + beside);
                }
            }
            let middle = 0.5 * (a.time + b.time);
            if look(&mut a, &mut b, middle).is_none() {
                self.take(a);
                self.take(b);
                break;
            }
            bisect_only |= round > 0 && b.time - a.time > SLOW * width;
        }
        // On the way only what is more than rounding, and nothing beside a zero of the rate, where values differ by rounding
        // alone: the time of an extreme is where its rate vanishes.
        met.retain(|point| !((point.time - level_at).abs() <= BESIDE * whole));
        for point in met {
            let rounding = ROUNDING * point.value().abs();
            let beyond = [self.low.1 - point.value(), point.value() - self.high.1];
            if beyond.iter().any(|beyond| *beyond > rounding) {
                self.take(point);
            }
        }
    }
}

/// Whether a measure changes between two points by more than it could if nothing jumped: loads do, and directions of forces at half a turn.
fn jumps(a: &Point, b: &Point) -> bool {
    let change = (b.value() - a.value()).abs();
    let steady = a.rate().abs().max(b.rate().abs()) * (b.time - a.time);
    let size = a.value().abs().max(b.value().abs());
    change > JUMPS.0 * steady && change > JUMPS.1 * size
}

/// The rate at an end of an interval; where the motion rests there, that so little inside.
fn rate_inside(point: &Point, known: usize, width: f64) -> f64 {
    match point.rate() == 0.0 {
        true => slopes(point, known, AT_REST * width)[1],
        false => point.rate(),
    }
}

/// Derivative and second derivative, a step away, of the polynomial that a point's series is.
fn slopes(point: &Point, known: usize, step: f64) -> [f64; 3] {
    let c = point.series.coefficients();
    let mut at = [0.0; 3];
    for k in (0..known.min(ORDER)).rev() {
        let k_th = k as f64;
        at[0] = at[0] * step + c[k];
        if k >= 1 {
            at[1] = at[1] * step + k_th * c[k];
        }
        if k >= 2 {
            at[2] = at[2] * step + k_th * (k_th - 1.0) * c[k];
        }
    }
    at
}

/// The step from a point to the zero of its series' rate by Newton's method; `None` where it finds none.
fn zero_of_rate(point: &Point, known: usize) -> Option<f64> {
    if known < 3 {
        return None;
    }
    let mut step = 0.0;
    for _ in 0..STEPS {
        let [_, rate, bend] = slopes(point, known, step);
        let change = rate / bend;
        step -= change;
        if !step.is_finite() {
            return None;
        }
        if change.abs() <= f64::EPSILON * step.abs() {
            break;
        }
    }
    Some(step)
}

/// Where the rate vanishes between two points, by the series of the end with the smaller rate, or by the straight line
/// between both rates where the series say nothing.
fn level(a: &Point, b: &Point, known: usize) -> Option<f64> {
    let near = if a.rate().abs() <= b.rate().abs() {
        a
    } else {
        b
    };
    let by_series = zero_of_rate(near, known).map(|step| near.time + step);
    let inside = |t: &f64| a.time < *t && *t < b.time;
    by_series.filter(inside).or_else(|| {
        let part = a.rate() / (a.rate() - b.rate());
        Some(a.time + (b.time - a.time) * part).filter(inside)
    })
}

/// Where the series of two points meet between them: a kink, if there is one.
fn meeting(a: &Point, b: &Point, known: usize) -> Option<f64> {
    let mut time = 0.5 * (a.time + b.time);
    for _ in 0..STEPS {
        let [left, left_rate, _] = slopes(a, known, time - a.time);
        let [right, right_rate, _] = slopes(b, known, time - b.time);
        let change = (left - right) / (left_rate - right_rate);
        time -= change;
        if !(a.time < time && time < b.time) {
            return None;
        }
        if change.abs() <= f64::EPSILON * time.abs() {
            break;
        }
    }
    Some(time)
}
