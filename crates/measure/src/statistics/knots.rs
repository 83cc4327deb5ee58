//! When a motion passes the knots of the curves that loads are made of.

use kempe_motion::progress::Progress;

use super::stretches::SmoothStretch;
use super::survey::{Point, survey};
use crate::force_source::{Curve, ForceSource};
use crate::sampler::{Asked, Sampler};

/// Knots that are passed at most: of a motion that passes more none is looked for, its samples are dense beside them.
const MOST: usize = 100_000;
/// Steps that close in on the time at which a knot is passed.
const STEPS: usize = 60;

/// Times at which the motion passes knots of curves, rising; `None` when stopped.
pub(super) fn passed<F: ForceSource>(
    sampler: &mut Sampler<F>,
    curves: &[Curve],
    stretches: &[SmoothStretch],
    progress: &mut dyn Progress,
) -> Option<Vec<f64>> {
    let mut times = Vec::new();
    if curves.is_empty() {
        return Some(times);
    }
    let alone: Vec<Asked> = (curves.iter())
        .map(|curve| sampler.asked(&[&curve.over]))
        .collect();
    let over: Vec<_> = curves.iter().map(|curve| &curve.over).collect();
    let together = sampler.asked(&over);
    survey(
        sampler,
        &together,
        stretches,
        progress,
        &mut |sampler, before, now| {
            let Some(before) = before else {
                return true;
            };
            for (index, (curve, alone)) in curves.iter().zip(&alone).enumerate() {
                let ends = [before.point(index), now.point(index)];
                between(curve, ends.map(|p| p.value()), MOST, &mut |knot| {
                    times.push(crossing(sampler, alone, ends, knot));
                });
            }
            times.len() <= MOST
        },
    )?;
    if times.len() > MOST {
        times.clear();
    }
    times.sort_by(f64::total_cmp);
    Some(times)
}

/// Calls `f` with the knots of a curve between two abscissas, `most` at most.
fn between(curve: &Curve, ends: [f64; 2], most: usize, f: &mut dyn FnMut(f64)) {
    let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
    if !(low < high && high.is_finite() && low.is_finite()) {
        return;
    }
    let inside = |knot: &f64| low < *knot && *knot < high;
    let Some((first, period)) = curve.at.first().zip(curve.period) else {
        let from = curve.at.partition_point(|at| *at <= low);
        (curve.at.iter().skip(from).copied())
            .take_while(inside)
            .for_each(f);
        return;
    };
    let turns = [low, high].map(|x| ((x - first) / period).floor());
    let all = (turns[1] - turns[0] + 1.0) * curve.at.len() as f64;
    if !(all <= most as f64) {
        return;
    }
    for turn in 0..=(turns[1] - turns[0]) as usize {
        let shift = (turns[0] + turn as f64) * period;
        let from = curve.at.partition_point(|at| at + shift <= low);
        (curve.at.iter().skip(from))
            .map(|at| at + shift)
            .take_while(inside)
            .for_each(&mut *f);
    }
}

/// When the only measure asked for takes a value between two samples: Newton's method, kept between both.
fn crossing<F: ForceSource>(
    sampler: &mut Sampler<F>,
    asked: &Asked,
    [mut a, mut b]: [Point; 2],
    value: f64,
) -> f64 {
    let rises = b.value() > a.value();
    let mut time = {
        let part = (value - a.value()) / (b.value() - a.value());
        a.time + (b.time - a.time) * part
    };
    for _ in 0..STEPS {
        if !(a.time < time && time < b.time) {
            time = 0.5 * (a.time + b.time);
        }
        let point = Point::take(sampler, asked, time);
        let short = value - point.value();
        let step = short / point.rate();
        if step.abs() <= 2.0 * f64::EPSILON * time.abs() || b.time - a.time <= f64::EPSILON * time {
            break;
        }
        *(if (short > 0.0) == rises {
            &mut a
        } else {
            &mut b
        }) = point;
        time += step;
    }
    time
}
