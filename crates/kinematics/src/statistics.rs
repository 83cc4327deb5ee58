//! One number over a whole motion: extremes located between rows, means integrated, ratios of times.

use std::f64::consts::TAU;

use kempe_model::{LawPiece, Measure, Statistic};
use kempe_number::Number;
use kempe_units::Dimension;

use crate::force_source::ForceSource;
use crate::sampler::Sampler;
use crate::swept::GAUSS;
use crate::watch::{Stage, Watch};

/// Intervals of time searched for extremes in every turn of a drive, besides the breaks of the laws.
const GRID: usize = 360;

/// Intervals at most: a motion of more turns is searched more coarsely.
const MOST_INTERVALS: usize = 360_000;

/// How near, in turns, to a whole number of turns a motion of several cycles ends.
const WHOLE: f64 = 1e-9;

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
        _ => time_ratio(sampler, high.0 - low.0, sampler.duration()),
    })
}

/// Times that matter: the breaks of the laws and an even grid.
fn times<F: ForceSource>(sampler: &Sampler<'_, F>) -> Vec<f64> {
    let duration = sampler.duration();
    let turns = turns(sampler).iter().fold(1.0, |all: f64, t| all.max(*t));
    let intervals = ((GRID as f64 * turns).ceil() as usize).clamp(GRID, MOST_INTERVALS);
    let mut times: Vec<f64> = (0..=intervals)
        .map(|k| duration * k as f64 / intervals as f64)
        .collect();
    times.extend(sampler.breaks());
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
}

/// Turns that each turning drive makes, both ways counted.
fn turns<F: ForceSource>(sampler: &Sampler<'_, F>) -> Vec<f64> {
    let drives = sampler.motion().mechanism.model.drives.iter();
    let parameters = sampler.motion().mechanism.model.parameter_values::<f64>();
    drives
        .filter(|d| d.dimension == Dimension::ANGLE)
        .map(|d| {
            let at = |t: &f64| d.law.at(*t, &parameters);
            let breaks = d.law.breaks(&parameters);
            let ways = breaks.windows(2).map(|w| (at(&w[1]) - at(&w[0])).abs());
            ways.sum::<f64>() / TAU
        })
        .collect()
}

/// Duration of the slower stroke over that of the faster, from the time between both extremes and the duration of the
/// motion. Over several turns the cycle is one of them.
pub(crate) fn time_ratio<T: Number, F: ForceSource>(
    sampler: &Sampler<'_, F>,
    between: T,
    duration: T,
) -> T {
    let cycle = duration / whole_turns(sampler);
    let between = between.abs();
    let stroke = between - cycle * (between.value() / cycle.value()).floor();
    let back = cycle - stroke;
    stroke.max(back) / stroke.min(back)
}

/// How many whole turns the only moving drive makes one way; 1 for any other motion.
fn whole_turns<F: ForceSource>(sampler: &Sampler<'_, F>) -> f64 {
    let Some(drive) = sampler.path_drive() else {
        return 1.0;
    };
    let model = &sampler.motion().mechanism.model;
    let Some(drive) = model.drives.get(drive.index()) else {
        return 1.0;
    };
    let turns = match drive.law.pieces.as_slice() {
        [LawPiece::ConstantSpeed { .. }] if drive.dimension == Dimension::ANGLE => {
            let (low, high) = drive.law.extent(&model.parameter_values::<f64>());
            (high - low) / TAU
        }
        _ => 1.0,
    };
    let whole = turns.round();
    if whole >= 1.0 && (turns - whole).abs() <= WHOLE {
        whole
    } else {
        1.0
    }
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
