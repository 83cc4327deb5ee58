//! Where a measure has no bound: whether it truly runs away there, and how fast.

use kempe_number::math;

use super::survey::Point;
use crate::force_source::ForceSource;
use crate::sampler::{Asked, Sampler};

/// Distances from the place at which a measure is looked at, in parts of the motion's duration: powers of two.
const DISTANCES: [i32; 5] = [-17, -21, -25, -29, -33];
/// As near to the place its integral is told by that power, in parts of the duration: a power of two.
const NEAR: i32 = -30;
/// Steps in which the place is closed in on, each to two thirds.
const STEPS: usize = 60;
/// What runs away grows from one distance to the next by at least this part of what it grew before: a logarithm evenly, what
/// has a bound ever less.
const GOES_ON: f64 = 0.5;
/// Poles nearer to each other than this part of the duration are one.
const SAME_PLACE: f64 = 1e-9;
/// Powers of the distance below this can be integrated, with some room for what is left of other terms.
const INTEGRABLE: f64 = 0.97;

/// A place where a measure is infinite.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pole {
    /// When, s.
    pub time: f64,
    /// Before and after it: infinity with its sign, or zero where it is bounded on that side.
    pub sides: [f64; 2],
    /// With which power of one over the distance it runs away, at most.
    pub power: f64,
    /// By how much that power changes near it.
    pub doubt: f64,
}

impl Pole {
    /// Looks at the only measure asked for about a place where nothing bounds it; `None` where it does not run away.
    pub fn at<F: ForceSource>(
        sampler: &mut Sampler<F>,
        asked: &Asked,
        [from, to]: [f64; 2],
        duration: f64,
    ) -> Option<Self> {
        let time = highest(sampler, asked, [from, to]);
        let mut pole = Self {
            time,
            sides: [0.0; 2],
            power: 0.0,
            doubt: 0.0,
        };
        for (side, sense) in [-1.0, 1.0].into_iter().enumerate() {
            let values = DISTANCES.map(|power| {
                let beside = time + sense * kempe_number::powi(2.0, power) * duration;
                let inside = (0.0..=duration).contains(&beside);
                match inside {
                    true => Point::take(sampler, asked, beside).value(),
                    false => f64::NAN,
                }
            });
            if let Some([power, doubt]) = growth(&values) {
                pole.sides[side] = f64::INFINITY.copysign(values[0]);
                pole.power = pole.power.max(power);
                pole.doubt = pole.doubt.max(doubt);
            }
        }
        (pole.sides != [0.0; 2]).then_some(pole)
    }

    /// Whether it is at a time.
    pub fn is_at(&self, time: f64, duration: f64) -> bool {
        (self.time - time).abs() <= SAME_PLACE * duration
    }

    /// Whether it can be integrated over.
    pub fn is_integrable(&self) -> bool {
        self.power < INTEGRABLE
    }

    /// Times on both sides of it between which integrals are told by its power.
    pub fn sides(&self, duration: f64) -> [f64; 2] {
        let near = kempe_number::powi(2.0, NEAR) * duration;
        [self.time - near, self.time + near]
    }

    /// The integral from it to a time, by the value there.
    pub fn integral(&self, to: f64, value: f64) -> f64 {
        (to - self.time).abs() * value / (1.0 - self.power)
    }
}

/// When the size of the only measure asked for is largest between two times.
fn highest<F: ForceSource>(
    sampler: &mut Sampler<F>,
    asked: &Asked,
    [mut from, mut to]: [f64; 2],
) -> f64 {
    let mut size = |time: f64| match Point::take(sampler, asked, time).value().abs() {
        value if value.is_nan() => f64::INFINITY,
        value => value,
    };
    for _ in 0..STEPS {
        let third = (to - from) / 3.0;
        let [a, b] = [from + third, to - third];
        if !(from < a && a < b && b < to) {
            break;
        }
        if size(a) < size(b) {
            from = a;
        } else {
            to = b;
        }
    }
    let times = [from, 0.5 * (from + to), to];
    let best = times.map(|time| (time, size(time))).into_iter();
    best.reduce(|a, b| if b.1 > a.1 { b } else { a })
        .map_or(from, |(time, _)| time)
}

/// The power of the distance with which values at ever smaller distances run away, and by how much it changes; `None` where
/// they do not.
fn growth(values: &[f64; 5]) -> Option<[f64; 2]> {
    let one_sign = values.iter().all(|v| *v > 0.0) || values.iter().all(|v| *v < 0.0);
    let size = values.map(f64::abs);
    let grows = size.is_sorted_by(|a, b| a < b);
    let steps: Vec<f64> = size.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let goes_on = steps.windows(2).all(|pair| pair[1] > GOES_ON * pair[0]);
    if !(one_sign && grows && goes_on) {
        return None;
    }
    let power = |k: usize| {
        let halvings = f64::from(DISTANCES[k] - DISTANCES[k + 1]);
        math::log10(size[k + 1] / size[k]) / (halvings * std::f64::consts::LOG10_2)
    };
    // Right beside where integrals are told by it.
    Some([power(2), (power(2) - power(1)).abs()])
}
