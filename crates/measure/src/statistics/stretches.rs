//! The stretches of a motion on which everything is smooth, and how finely each is sampled.

use std::f64::consts::TAU;

use kempe_motion::drive_path::law_knots;
use kempe_units::Dimension;

use crate::force_source::ForceSource;
use crate::sampler::Sampler;

/// Intervals of time searched for extremes in every turn of a drive, and in the whole motion at least.
const GRID: usize = 360;

/// Intervals in which every piece of a law is searched at least.
const LEAST: usize = 48;

/// Intervals in which every segment of a table is searched at least: of a law, and of a load.
const LEAST_IN_TABLE: usize = 4;
const LEAST_IN_CURVE: usize = 2;

/// Intervals at most: a motion of more turns is searched more coarsely.
const MOST_INTERVALS: usize = 360_000;

/// A knot of a curve is known to this part of the motion's duration; nothing is sampled nearer to it.
const KNOT: f64 = 8.0 * f64::EPSILON;

/// A stretch of time on which all laws are smooth.
#[derive(Clone, Debug)]
pub(super) struct SmoothStretch {
    /// Its ends; the law behind `from` and that before `to` are meant.
    pub from: f64,
    pub to: f64,
    /// Intervals in which it is searched.
    pub intervals: usize,
}

impl SmoothStretch {
    /// Times at which it is sampled, rising, both ends included: evenly, and at those of `more` that lie on it.
    pub fn times(&self, more: &[f64], duration: f64) -> Vec<f64> {
        let even = (0..=self.intervals).map(|k| {
            let part = k as f64 / self.intervals as f64;
            if k == self.intervals {
                self.to
            } else {
                self.from + (self.to - self.from) * part
            }
        });
        let mut times: Vec<f64> = even.collect();
        let beside = KNOT * duration;
        let first = more.partition_point(|t| *t <= self.from + beside);
        let own = more.iter().skip(first);
        let own: Vec<f64> = own
            .take_while(|t| **t < self.to - beside)
            .copied()
            .collect();
        if !own.is_empty() {
            let apart = |t: &f64| {
                let next = times.partition_point(|even| even < t);
                let near = |k: usize| times.get(k).is_some_and(|even| (even - t).abs() <= beside);
                !near(next) && !near(next.max(1) - 1)
            };
            let own: Vec<f64> = own.into_iter().filter(apart).collect();
            times.extend(own);
            times.sort_by(f64::total_cmp);
        }
        times
    }
}

/// The stretches of a motion between the knots of its laws. However short, each is searched.
pub(super) fn stretches<F: ForceSource>(sampler: &Sampler<F>) -> Vec<SmoothStretch> {
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
    let mut stretches: Vec<SmoothStretch> = (list.windows(2))
        .map(|pair| {
            let ([_, from], [end, _]) = (pair[0], pair[1]);
            // The last bit before a knot: what is evaluated at the knot itself is what follows.
            let to = if end < duration { end.next_down() } else { end };
            let whole = pieces.contains(&pair[0]) && pieces.contains(&pair[1]);
            let least = if whole { LEAST } else { LEAST_IN_TABLE };
            let parts = turns(from, to).max((to - from) / duration);
            SmoothStretch {
                from,
                to: to.max(from),
                intervals: ((GRID as f64 * parts).ceil() as usize).max(least),
            }
        })
        .collect();
    coarsen(&mut stretches);
    if stretches.is_empty() {
        stretches.push(SmoothStretch {
            from: 0.0,
            to: 0.0,
            intervals: 1,
        });
    }
    stretches
}

/// The stretches parted at knots: rising times at which a curve goes from one cubic to the next.
pub(super) fn parted(
    stretches: &[SmoothStretch],
    knots: &[f64],
    duration: f64,
) -> Vec<SmoothStretch> {
    let beside = KNOT * duration;
    let mut parts = Vec::with_capacity(stretches.len() + knots.len());
    let mut knots = knots.iter().peekable();
    for stretch in stretches {
        let width = stretch.to - stretch.from;
        let mut from = stretch.from;
        let push = |parts: &mut Vec<SmoothStretch>, from: f64, to: f64, least: usize| {
            let share = stretch.intervals as f64 * ((to - from) / width);
            parts.push(SmoothStretch {
                from,
                to,
                intervals: (share.ceil() as usize).max(least),
            });
        };
        let mut least = stretch.intervals;
        while let Some(&&knot) = knots.peek() {
            if knot >= stretch.to - 2.0 * beside {
                break;
            }
            knots.next();
            if knot > from + 2.0 * beside {
                push(&mut parts, from, knot - beside, LEAST_IN_CURVE);
                from = knot + beside;
                least = LEAST_IN_CURVE;
            }
        }
        push(&mut parts, from, stretch.to, least);
    }
    coarsen(&mut parts);
    parts
}

fn coarsen(stretches: &mut [SmoothStretch]) {
    let all: usize = stretches.iter().map(|s| s.intervals).sum();
    let coarser = (all as f64 / MOST_INTERVALS as f64).max(1.0);
    for stretch in stretches {
        stretch.intervals = ((stretch.intervals as f64 / coarser).ceil() as usize).max(1);
    }
}
