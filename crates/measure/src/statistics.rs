//! One number over a whole motion: extremes located between rows, means integrated, ratios of times.

use std::f64::consts::TAU;

use kempe_model::{LawPiece, Measure, Statistic};
use kempe_motion::drive_path::{WHOLE, is_cycle, law_knots};
use kempe_motion::progress::{Stage, Watch};
use kempe_number::Number;
use kempe_units::Dimension;

use crate::force_source::ForceSource;
use crate::quadrature::{graded, integrate};
use crate::sampler::Sampler;

/// Intervals of time searched for extremes in every turn of a drive, and in the whole motion at least.
const GRID: usize = 360;

/// Intervals in which every piece of a law is searched at least.
const LEAST: usize = 48;

/// Intervals in which every segment of a table is searched at least.
const LEAST_IN_TABLE: usize = 4;

/// Intervals that are integrated together.
const INTERVALS_TOGETHER: usize = 12;

/// Bisections that close in on the zero of a rate.
const BISECTIONS: usize = 52;

/// What a measure changes by less than this part of itself is rounding, and no extreme.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Intervals at most: a motion of more turns is searched more coarsely.
const MOST_INTERVALS: usize = 360_000;

/// Halvings of an interval by which an end without a rate of its own is approached: nearer than its 2^40th part nothing
/// can be told from the end.
const HALVINGS: i32 = 40;

/// Evaluates a statistic of a measure over the motion, SI. NaN where the motion does not reach; `None` when stopped.
pub(crate) fn over<F: ForceSource>(
    sampler: &mut Sampler<F>,
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

/// A stretch of time on which all laws are smooth.
struct Stretch {
    /// Its ends; the law behind `from` and that before `to` are meant.
    from: f64,
    to: f64,
    /// Intervals in which it is searched.
    intervals: usize,
}

/// The stretches of a motion between the knots of its laws. However short, each is searched.
fn stretches<F: ForceSource>(sampler: &Sampler<F>) -> Vec<Stretch> {
    let model = &sampler.motion().mechanism().model;
    let parameters = sampler.parameters();
    let duration = sampler.duration();
    let turning = || (model.drives.iter()).filter(|d| d.dimension == Dimension::ANGLE);
    let turns = |from: f64, to: f64| {
        let ways = turning().map(|d| (d.law.at(to, parameters) - d.law.at(from, parameters)).abs());
        ways.fold(0.0, f64::max) / TAU
    };
    let pieces = law_knots(model, parameters, true);
    let list = law_knots(model, parameters, false);
    let mut stretches: Vec<Stretch> = (list.windows(2))
        .map(|pair| {
            let ([_, from], [end, _]) = (pair[0], pair[1]);
            // The last bit before a knot: what is evaluated at the knot itself is what follows.
            let to = if end < duration { end.next_down() } else { end };
            let whole = pieces.contains(&pair[0]) && pieces.contains(&pair[1]);
            let least = if whole { LEAST } else { LEAST_IN_TABLE };
            let parts = turns(from, to).max((to - from) / duration);
            Stretch {
                from,
                to: to.max(from),
                intervals: ((GRID as f64 * parts).ceil() as usize).max(least),
            }
        })
        .collect();
    let all: usize = stretches.iter().map(|s| s.intervals).sum();
    let coarser = (all as f64 / MOST_INTERVALS as f64).max(1.0);
    for stretch in &mut stretches {
        stretch.intervals = ((stretch.intervals as f64 / coarser).ceil() as usize).max(1);
    }
    if stretches.is_empty() {
        stretches.push(Stretch {
            from: 0.0,
            to: 0.0,
            intervals: 1,
        });
    }
    stretches
}

/// Duration of the slower stroke over that of the faster, from the time between both extremes and the duration of the
/// motion; NaN where the motion is no cycle. Over several turns the cycle is one of them.
pub(crate) fn time_ratio<T: Number, F: ForceSource>(
    sampler: &Sampler<F>,
    between: T,
    duration: T,
) -> T {
    if !is_cycle(&sampler.motion().mechanism().model, sampler.parameters()) {
        return T::from_f64(f64::NAN);
    }
    let cycle = duration / whole_turns(sampler);
    let between = between.abs();
    let stroke = between - cycle * (between.value() / cycle.value()).floor();
    let back = cycle - stroke;
    stroke.max(back) / stroke.min(back)
}

/// How many whole turns the only moving drive makes one way; 1 for any other motion.
fn whole_turns<F: ForceSource>(sampler: &Sampler<F>) -> f64 {
    let Some(drive) = sampler.path_drive() else {
        return 1.0;
    };
    let model = &sampler.motion().mechanism().model;
    let Some(drive) = model.drives.get(drive.index()) else {
        return 1.0;
    };
    let turns = match drive.law.pieces.as_slice() {
        [LawPiece::ConstantSpeed { .. }] if drive.dimension == Dimension::ANGLE => {
            let (low, high) = drive.law.extent(sampler.parameters());
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

/// Smallest and largest value with their times: ends of stretches, and the zeros of the rate between grid points. `None`
/// inside where the motion does not reach, outside when stopped.
pub(crate) fn extremes<F: ForceSource>(
    sampler: &mut Sampler<F>,
    measure: &Measure,
    watch: &mut dyn Watch,
) -> Option<Option<(At, At)>> {
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
    let duration = sampler.duration();
    for stretch in stretches(sampler) {
        let mut last: Option<[f64; 3]> = None;
        for k in 0..=stretch.intervals {
            let part = k as f64 / stretch.intervals as f64;
            let t = if k == stretch.intervals {
                stretch.to
            } else {
                stretch.from + (stretch.to - stretch.from) * part
            };
            watch
                .reached(Stage::Measuring, Some(t / duration))
                .continue_value()?;
            let [value, rate] = sampler.value_and_rate(measure, t);
            if value.is_nan() {
                return Some(None);
            }
            take(t, value);
            if let Some(before) = last {
                let probes = rates_between(sampler, measure, [before, [t, value, rate]]);
                for pair in probes.windows(2) {
                    let ([mut a, _, rate_a], [mut b, _, rate_b]) = (pair[0], pair[1]);
                    let steepest = rate_a.abs().max(rate_b.abs());
                    let rounding = ROUNDING * value.abs();
                    if !(rate_a * rate_b < 0.0) || steepest * (b - a) <= rounding {
                        continue;
                    }
                    for _ in 0..BISECTIONS {
                        let middle = 0.5 * (a + b);
                        if sampler.value_and_rate(measure, middle)[1] * rate_a > 0.0 {
                            a = middle;
                        } else {
                            b = middle;
                        }
                    }
                    // On both sides: between them there may be a jump.
                    for t in [a, b] {
                        let value = sampler.value_and_rate(measure, t)[0];
                        if !value.is_nan() {
                            take(t, value);
                        }
                    }
                }
            }
            last = Some([t, value, rate]);
        }
    }
    Some(low.1.is_finite().then_some((low, high)))
}

/// Times of an interval with values and rates there, rising: its ends, and where an end has no rate (at a limit), times
/// ever nearer to it.
fn rates_between<F: ForceSource>(
    sampler: &mut Sampler<F>,
    measure: &Measure,
    [from, to]: [[f64; 3]; 2],
) -> Vec<[f64; 3]> {
    if from[2].is_finite() && to[2].is_finite() {
        return vec![from, to];
    }
    let part = |k: i32| (to[0] - from[0]) * 2.0_f64.powi(-k);
    let mut at: Vec<f64> = Vec::new();
    if !from[2].is_finite() {
        at.extend((1..=HALVINGS).rev().map(|k| from[0] + part(k)));
    }
    if !to[2].is_finite() {
        at.extend((1..=HALVINGS).map(|k| to[0] - part(k)));
    }
    let mut probes = vec![from];
    probes.extend((at.into_iter()).map(|t| {
        let [value, rate] = sampler.value_and_rate(measure, t);
        [t, value, rate]
    }));
    probes.push(to);
    probes.retain(|[.., rate]| rate.is_finite());
    probes
}

/// Mean over time between the knots of the laws; `None` when stopped.
fn mean<F: ForceSource>(
    sampler: &mut Sampler<F>,
    measure: &Measure,
    watch: &mut dyn Watch,
) -> Option<f64> {
    let duration = sampler.duration();
    if duration <= 0.0 {
        return Some(sampler.value_and_rate(measure, 0.0)[0]);
    }
    let stretches = stretches(sampler);
    let parts: usize = stretches.iter().map(|s| parts_of(s.intervals)).sum();
    let mut sum = 0.0;
    let mut done = 0;
    for stretch in stretches {
        let own = parts_of(stretch.intervals);
        // Where a rate is infinite at an end, as at a limit, equal steps of this variable come ever nearer to it.
        let width = stretch.to - stretch.from;
        let [part] = integrate(&graded(own), 0.0, &mut |u| {
            let told = (done as f64 + u * own as f64) / parts as f64;
            watch
                .reached(Stage::Measuring, Some(told))
                .continue_value()?;
            let t = stretch.from + width * (u * u * (3.0 - 2.0 * u));
            let weight = width * 6.0 * u * (1.0 - u);
            Some([weight * sampler.value_and_rate(measure, t)[0]])
        })?;
        sum += part;
        done += own;
    }
    Some(sum / duration)
}

/// Parts in which a stretch of so many intervals is integrated first.
fn parts_of(intervals: usize) -> usize {
    intervals.div_ceil(INTERVALS_TOGETHER)
}
