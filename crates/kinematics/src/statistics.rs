//! One number over a whole motion: extremes located between rows, means integrated, ratios of times.

use kempe_model::{Measure, Statistic};

use crate::force_source::ForceSource;
use crate::sampler::Sampler;
use crate::swept::GAUSS;

/// Intervals of time searched for extremes, besides the breaks of the laws.
const GRID: usize = 360;

/// Evaluates a statistic of a measure over the motion, SI. NaN where the motion does not reach.
pub(crate) fn over<F: ForceSource>(
    sampler: &mut Sampler<'_, F>,
    statistic: Statistic,
    measure: &Measure,
) -> f64 {
    match statistic {
        Statistic::At { drive, value } => {
            let time = match drive {
                Some(drive) => sampler.time_of(drive, value),
                None => Some(value),
            };
            time.map_or(f64::NAN, |t| sampler.value_and_rate(measure, t)[0])
        }
        Statistic::Mean => mean(sampler, measure),
        Statistic::Min => extremes(sampler, measure).map_or(f64::NAN, |(low, _)| low.1),
        Statistic::Max => extremes(sampler, measure).map_or(f64::NAN, |(_, high)| high.1),
        Statistic::Range => {
            extremes(sampler, measure).map_or(f64::NAN, |(low, high)| high.1 - low.1)
        }
        Statistic::TimeRatio => extremes(sampler, measure).map_or(f64::NAN, |(low, high)| {
            let stroke = (high.0 - low.0).abs();
            let back = sampler.duration() - stroke;
            stroke.max(back) / stroke.min(back)
        }),
    }
}

/// Times that matter: the breaks of the laws and an even grid.
fn times<F: ForceSource>(sampler: &Sampler<'_, F>) -> Vec<f64> {
    let duration = sampler.duration();
    let mut times: Vec<f64> = (0..=GRID)
        .map(|k| duration * k as f64 / GRID as f64)
        .collect();
    times.extend(sampler.breaks());
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
}

pub(crate) type At = (f64, f64);

/// Smallest and largest value with their times: ends, breaks, and the zeros of the rate between grid points.
pub(crate) fn extremes<F: ForceSource>(
    sampler: &mut Sampler<'_, F>,
    measure: &Measure,
) -> Option<(At, At)> {
    let times = times(sampler);
    let mut low: At = (f64::NAN, f64::INFINITY);
    let mut high: At = (f64::NAN, f64::NEG_INFINITY);
    let mut take = |t: f64, value: f64| {
        // Equal to rounding is not an improvement: the first time counts.
        if value < low.1 {
            low = (t, value);
        }
        if value > high.1 {
            high = (t, value);
        }
    };
    let mut last: Option<(f64, f64)> = None;
    for &t in &times {
        let [value, rate] = sampler.value_and_rate(measure, t);
        if value.is_nan() {
            return None;
        }
        take(t, value);
        if let Some((t0, rate0)) = last
            && rate0 * rate < 0.0
        {
            let (mut a, mut b) = (t0, t);
            for _ in 0..52 {
                let middle = 0.5 * (a + b);
                if sampler.value_and_rate(measure, middle)[1] * rate0 > 0.0 {
                    a = middle;
                } else {
                    b = middle;
                }
            }
            let t = 0.5 * (a + b);
            let value = sampler.value_and_rate(measure, t)[0];
            if !value.is_nan() {
                take(t, value);
            }
        }
        last = Some((t, rate));
    }
    low.1.is_finite().then_some((low, high))
}

/// Mean over time by Gauss quadrature between the times that matter.
fn mean<F: ForceSource>(sampler: &mut Sampler<'_, F>, measure: &Measure) -> f64 {
    let times = times(sampler);
    let duration = sampler.duration();
    if duration <= 0.0 {
        return sampler.value_and_rate(measure, 0.0)[0];
    }
    let mut sum = 0.0;
    for pair in times.windows(2) {
        let (middle, half) = (0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
        for (x, w) in GAUSS {
            sum += w * half * sampler.value_and_rate(measure, middle + half * x)[0];
        }
    }
    sum / duration
}
