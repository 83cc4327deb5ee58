//! What measures can be between two moments of a motion, from the series at both.
//!
//! Poses between two samples are bounded by the polynomials of both, and by as much again as these differ in the middle.
//! Measures of such poses are evaluated on intervals: whatever a formula does between samples, a narrow peak or a pole, its
//! bounds show. The bounds of the poses are no proof; those of the formulas on them are.

use std::cell::OnceCell;
use std::sync::Arc;

use kempe_mechanism::Design;
use kempe_mechanism::pose::Pose;
use kempe_model::PointId;
use kempe_number::{Interval, Jet};

use super::{Asked, Sampler};
use crate::force_source::ForceSource;
use crate::measure::{Along, History, KnownStatistic, Moment};
use crate::state::{Abscissa, ORDER, Series, State};

/// Binomial coefficients: of a series shifted, the k-th coefficient takes up the n-th with weight n over k.
const BINOMIAL: [[f64; ORDER]; ORDER] = [
    [1.0, 0.0, 0.0, 0.0, 0.0],
    [1.0, 1.0, 0.0, 0.0, 0.0],
    [1.0, 2.0, 1.0, 0.0, 0.0],
    [1.0, 3.0, 3.0, 1.0, 0.0],
    [1.0, 4.0, 6.0, 4.0, 1.0],
];

/// A moment that was sampled, kept to say what lies between it and the next.
pub(crate) struct Kept {
    state: State<f64>,
    lengths: Vec<(PointId, f64)>,
    /// Those of the measures that are bounded, once they are asked for.
    series: OnceCell<Vec<Series<f64>>>,
}

/// The poses that two samples tell of the middle between them agree to this: directions as they are, places in mechanism sizes.
const FOLLOWS: f64 = 1e-6;

impl Kept {
    /// Whether the poses here and at a later moment tell the same of the middle between. What has no rate, as at a limit,
    /// tells nothing.
    pub fn shows(&self, later: &Self, size: f64) -> bool {
        let places = [self, later].map(|it| it.state.abscissa.clock.coefficient(0));
        let half = 0.5 * (places[1] - places[0]);
        let apart = |a: &Series<f64>, b: &Series<f64>| (a.evaluate(half) - b.evaluate(-half)).abs();
        let mut poses = self.state.poses.iter().zip(&later.state.poses);
        poses.all(|(a, b)| {
            let turned = apart(&a.c, &b.c).max(apart(&a.s, &b.s));
            let moved = apart(&a.x, &b.x).max(apart(&a.y, &b.y));
            !(turned > FOLLOWS || moved > FOLLOWS * size)
        })
    }
}

/// What measures need to be bounded between kept moments.
pub(crate) struct Between {
    pub asked: Asked,
    design: Arc<Design<Series<Interval>>>,
    statistics: Vec<KnownStatistic<Interval>>,
}

impl<F: ForceSource> Sampler<F> {
    /// Prepares to bound measures between moments.
    pub(crate) fn between(&self, asked: Asked) -> Between {
        let known = self.measurer.statistics.iter();
        let on_intervals = |(statistic, measure, value): &KnownStatistic<f64>| {
            (statistic.clone(), measure.clone(), interval(*value))
        };
        Between {
            asked,
            design: Arc::new(self.motion().design_on()),
            statistics: known.map(on_intervals).collect(),
        }
    }

    /// Keeps the state last found.
    pub(crate) fn keep(&mut self, between: &Between) -> Kept {
        let state = self.measurer.state().clone();
        let lengths = self.lengths_at(&between.asked.lengths, state.time);
        Kept {
            state,
            lengths,
            series: OnceCell::new(),
        }
    }

    /// The series in time that measures can have anywhere from one moment to a later one; empty where nothing is known.
    pub(crate) fn bounds(&self, between: &Between, a: &Kept, b: &Kept) -> Vec<Series<Interval>> {
        let motion = self.motion();
        let p = a.state.abscissa.clock.coefficient(0);
        let lengths = a.lengths.iter().zip(&b.lengths);
        let history = History {
            lengths: lengths
                .map(|((point, from), (_, to))| (*point, Interval::new(*from, *to)))
                .collect(),
            ..self.measurer.directions.history(motion, p)
        };
        let state = between.state(&a.state, &b.state);
        let moment = Moment::new(&state, &history, &between.statistics, None);
        let measures = between.asked.measures.iter();
        measures.map(|m| moment.series(m, Along::Time)).collect()
    }

    /// Bounds of one of the measures, of which so many coefficients are known: of all but the last from its series at both ends, each as far as
    /// the middle, with the last one's bounds as the remainder (B. Taylor). Where parts of a formula cancel each other, these are far narrower.
    /// The measure must be smooth; where it has a kink all the same, its two ends do not meet, and the bounds hold both.
    pub(crate) fn bounds_of_smooth(
        &self,
        between: &Between,
        ends: [&Kept; 2],
        (measure, known): (usize, usize),
        bounds: &Series<Interval>,
    ) -> Series<Interval> {
        let Some(last) = known.checked_sub(1) else {
            return *bounds;
        };
        let half = 0.5 * (ends[1].state.time - ends[0].state.time);
        let steps = [Interval::new(0.0, half), Interval::new(-half, 0.0)];
        let side = |end: usize, k: usize| {
            let series = self.series_of(between, ends[end])[measure];
            shifted(k, last, steps[end], |n| match n == last {
                true => bounds.coefficient(n) * BINOMIAL[n][k],
                false => interval(series.coefficient(n) * BINOMIAL[n][k]),
            })
        };
        Jet::from_coefficients(std::array::from_fn(|k| {
            let own = bounds.coefficient(k);
            if k >= last {
                return own;
            }
            let both = own.intersect(side(0, k).hull(side(1, k)));
            // One of them may be a single number, and rounding lie beside it.
            if both.is_empty() { own } else { both }
        }))
    }

    /// The series in time of measures at a kept moment.
    fn series_of<'k>(&self, between: &Between, at: &'k Kept) -> &'k [Series<f64>] {
        at.series.get_or_init(|| {
            let p = at.state.abscissa.clock.coefficient(0);
            let history = History {
                lengths: at.lengths.clone(),
                ..self.measurer.directions.history(self.motion(), p)
            };
            let moment = Moment::new(&at.state, &history, &self.measurer.statistics, None);
            let measures = between.asked.measures.iter();
            measures.map(|m| moment.series(m, Along::Time)).collect()
        })
    }
}

impl Between {
    /// Everything that a state can be from one to a later one.
    fn state(&self, a: &State<f64>, b: &State<f64>) -> State<Interval> {
        let times = [a.time, b.time];
        let over = Interval::new(a.time, b.time);
        let clock = bounded([&a.abscissa.clock, &b.abscissa.clock], times, over);
        let places = [a, b].map(|state| state.abscissa.clock.coefficient(0));
        let path = clock.coefficient(0);
        let along = |ends: [&Series<f64>; 2]| bounded(ends, places, path);
        let alone = a.alone.iter().zip(&b.alone).map(|(a, b)| {
            let (a, b) = (a.as_ref()?, b.as_ref()?);
            Some(between_poses(a, b, &apart))
        });
        State {
            design: self.design.clone(),
            time: over,
            poses: between_poses(&a.poses, &b.poses, &along),
            coordinates: (a.coordinates.iter().zip(&b.coordinates))
                .map(|(a, b)| along([a, b]))
                .collect(),
            near: a.near.clone(),
            alone: alone.collect(),
            inner: (a.inner.iter().zip(&b.inner))
                .map(|(a, b)| bounded([a, b], times, over))
                .collect(),
            abscissa: Abscissa {
                drive: a.abscissa.drive,
                clock,
                heading: a.abscissa.heading,
                unit: a.abscissa.unit,
            },
        }
    }
}

fn between_poses(
    a: &[Pose<Series<f64>>],
    b: &[Pose<Series<f64>>],
    along: &dyn Fn([&Series<f64>; 2]) -> Series<Interval>,
) -> Vec<Pose<Series<Interval>>> {
    let pairs = a.iter().zip(b);
    pairs
        .map(|(a, b)| Pose {
            x: along([&a.x, &b.x]),
            y: along([&a.y, &b.y]),
            c: along([&a.c, &b.c]),
            s: along([&a.s, &b.s]),
        })
        .collect()
}

/// A number as an interval: empty where there is none.
fn interval(x: f64) -> Interval {
    Interval::new(x, x)
}

/// The k-th coefficient of a series a step away, from its coefficients up to the last, weighted as they count in it.
fn shifted(
    k: usize,
    last: usize,
    step: Interval,
    weighted: impl Fn(usize) -> Interval,
) -> Interval {
    (k..last)
        .rev()
        .fold(weighted(last), |sum, n| sum * step + weighted(n))
}

/// Bounds of poses count as exact to this part of themselves.
const ROUNDED: f64 = 2.0 * f64::EPSILON;

/// Two series about two places, and whatever lies between them: each holds as far as the middle. (Rounding of the steps on the way is left to
/// [`ROUNDED`]: that the series tell what lies between is no proof either, and every body's pose passes here between all samples.)
fn bounded(series: [&Series<f64>; 2], at: [f64; 2], over: Interval) -> Series<Interval> {
    if over.is_empty() {
        return Jet::from_coefficients([Interval::EMPTY; ORDER]);
    }
    let middle = 0.5 * (at[0] + at[1]);
    let halves = match at[0] <= at[1] {
        true => [[over.lo(), middle], [middle, over.hi()]],
        false => [[middle, over.hi()], [over.lo(), middle]],
    };
    Jet::from_coefficients(std::array::from_fn(|k| {
        let weighted = |end: usize, n: usize| series[end].coefficient(n) * BINOMIAL[n][k];
        let side = |end: usize| {
            let [from, to] = halves[end].map(|place| place - at[end]);
            let last = weighted(end, ORDER - 1);
            (k..ORDER - 1).rev().fold([last; 2], |[lo, hi], n| {
                let [a, b, c, d] = [lo * from, lo * to, hi * from, hi * to];
                let constant = weighted(end, n);
                [
                    a.min(b).min(c.min(d)) + constant,
                    a.max(b).max(c.max(d)) + constant,
                ]
            })
        };
        let meets = |end: usize| {
            let step = middle - at[end];
            let last = weighted(end, ORDER - 1);
            (k..ORDER - 1)
                .rev()
                .fold(last, |sum, n| sum * step + weighted(end, n))
        };
        // Not a number where a coefficient is none: then nothing is known.
        let differ = (meets(0) - meets(1)).abs();
        let ([a, b], [c, d]) = (side(0), side(1));
        let (lo, hi) = (a.min(c), b.max(d));
        let beyond = differ + ROUNDED * lo.abs().max(hi.abs());
        Interval::new(lo - beyond, hi + beyond)
    }))
}

/// Two series that run along another drive than the one by which their places differ.
fn apart([a, b]: [&Series<f64>; 2]) -> Series<Interval> {
    Jet::from_coefficients(std::array::from_fn(|k| {
        let (a, b) = (a.coefficient(k), b.coefficient(k));
        let differ = (a - b).abs();
        interval(a).hull(interval(b)) + Interval::new(-differ, differ)
    }))
}
