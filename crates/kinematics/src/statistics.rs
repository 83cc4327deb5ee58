//! One number over a whole motion: extremes located between rows, means integrated, ratios of times.

use kempe_model::{Measure, Statistic};

use crate::force_source::ForceSource;
use crate::sampler::Sampler;
use crate::swept::GAUSS;
use crate::watch::{Stage, Watch};

/// Intervals of time searched for extremes, besides the breaks of the laws.
const GRID: usize = 360;

/// Halvings of an interval by which an end without a rate of its own is approached: nearer than its 2^40th part nothing
/// can be told from the end.
const HALVINGS: i32 = 40;

/// Evaluates a statistic of a measure over the motion, SI. NaN where the motion does not reach; `None` when stopped.
pub(crate) fn over<F: ForceSource>(
    sampler: &mut Sampler<'_, F>,
    statistic: Statistic,
    measure: &Measure,
    watch: &mut dyn Watch,
) -> Option<f64> {
    if let Statistic::At { drive, value } = statistic {
        let time = match drive {
            Some(drive) => sampler.time_of(drive, value),
            None => Some(value),
        };
        return Some(time.map_or(f64::NAN, |t| sampler.value_and_rate(measure, t)[0]));
    }
    if statistic == Statistic::Mean {
        return mean(sampler, measure, watch);
    }
    let Some((low, high)) = extremes(sampler, measure, watch)? else {
        return Some(f64::NAN);
    };
    Some(match statistic {
        Statistic::Min => low.1,
        Statistic::Max => high.1,
        Statistic::Range => high.1 - low.1,
        _ => {
            let stroke = (high.0 - low.0).abs();
            let back = sampler.duration() - stroke;
            stroke.max(back) / stroke.min(back)
        }
    })
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

/// Smallest and largest value with their times: ends, breaks, and the zeros of the rate between grid points. `None`
/// inside where the motion does not reach, outside when stopped.
pub(crate) fn extremes<F: ForceSource>(
    sampler: &mut Sampler<'_, F>,
    measure: &Measure,
    watch: &mut dyn Watch,
) -> Option<Option<(At, At)>> {
    let times = times(sampler);
    let breaks = sampler.breaks();
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
    for (done, &t) in times.iter().enumerate() {
        let part = done as f64 / times.len() as f64;
        watch
            .reached(Stage::Measuring, Some(part))
            .continue_value()?;
        let [value, rate] = sampler.value_and_rate(measure, t);
        if value.is_nan() {
            return Some(None);
        }
        take(t, value);
        if let Some((before, rate_before)) = last {
            let ends = [(before, rate_before), (t, rate)];
            let probes = rates_between(sampler, measure, ends, breaks.contains(&t));
            for pair in probes.windows(2) {
                let ((mut a, rate_a), (mut b, rate_b)) = (pair[0], pair[1]);
                if !(rate_a * rate_b < 0.0) {
                    continue;
                }
                for _ in 0..52 {
                    let middle = 0.5 * (a + b);
                    if sampler.value_and_rate(measure, middle)[1] * rate_a > 0.0 {
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
        }
        last = Some((t, rate));
    }
    Some(low.1.is_finite().then_some((low, high)))
}

/// Times of an interval with the rates there, rising: its ends, and where an end has no rate (at a limit), or that of
/// what follows (`broken`: at a break of a law), times ever nearer to it.
fn rates_between<F: ForceSource>(
    sampler: &mut Sampler<'_, F>,
    measure: &Measure,
    [(from, rate_from), (to, rate_to)]: [(f64, f64); 2],
    broken: bool,
) -> Vec<(f64, f64)> {
    if rate_from.is_finite() && rate_to.is_finite() && !broken {
        return vec![(from, rate_from), (to, rate_to)];
    }
    let part = |k: i32| (to - from) * 2.0_f64.powi(-k);
    let mut at: Vec<f64> = Vec::new();
    if !rate_from.is_finite() {
        at.extend((1..=HALVINGS).rev().map(|k| from + part(k)));
    }
    if !rate_to.is_finite() {
        at.extend((1..=HALVINGS).map(|k| to - part(k)));
    } else if broken {
        at.push(to - part(HALVINGS));
    }
    let mut probes = vec![(from, rate_from)];
    probes.extend((at.into_iter()).map(|t| (t, sampler.value_and_rate(measure, t)[1])));
    if !broken {
        probes.push((to, rate_to));
    }
    probes.retain(|(_, rate)| rate.is_finite());
    probes
}

/// Mean over time by Gauss quadrature between the times that matter; `None` when stopped.
fn mean<F: ForceSource>(
    sampler: &mut Sampler<'_, F>,
    measure: &Measure,
    watch: &mut dyn Watch,
) -> Option<f64> {
    let times = times(sampler);
    let duration = sampler.duration();
    if duration <= 0.0 {
        return Some(sampler.value_and_rate(measure, 0.0)[0]);
    }
    let mut sum = 0.0;
    for (done, pair) in times.windows(2).enumerate() {
        let part = done as f64 / times.len() as f64;
        watch
            .reached(Stage::Measuring, Some(part))
            .continue_value()?;
        let (middle, half) = (0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
        for (x, w) in GAUSS {
            sum += w * half * sampler.value_and_rate(measure, middle + half * x)[0];
        }
    }
    Some(sum / duration)
}
