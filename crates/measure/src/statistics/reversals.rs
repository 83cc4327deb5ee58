//! Where what rubs dry turns back between two samples: forces jump there.

use crate::force_source::ForceSource;
use crate::sampler::{Asked, Sampler};

/// So far from where it turns back, as a part of the motion's duration, both sides of a jump are looked at: nearer it counts as resting, and has the forces
/// of the way it goes on.
pub(crate) const BESIDE: f64 = 1e-11;

/// How fast something slides, and how that changes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slide {
    speed: f64,
    rate: f64,
}

impl Slide {
    /// Of all that rubs dry, at the moment last sampled.
    pub fn all<F: ForceSource>(sampler: &Sampler<F>, asked: &Asked) -> Vec<Self> {
        if !asked.forces {
            return Vec::new();
        }
        let speeds = sampler.forces().sliding().into_iter();
        let of = |speed: crate::measure::Series<f64>| Self {
            speed: speed.coefficient(0),
            rate: speed.coefficient(1),
        };
        speeds.map(of).collect()
    }

    /// Of all that rubs dry, at a time; nothing where the motion does not reach.
    pub fn at<F: ForceSource>(sampler: &mut Sampler<F>, asked: &Asked, time: f64) -> Vec<Self> {
        match sampler.sliding_at(asked, time).is_empty() {
            true => Vec::new(),
            false => Self::all(sampler, asked),
        }
    }

    /// Whether it turns back at its instant, which may be missed by so much.
    fn turns(&self, near: f64) -> bool {
        self.speed.abs() <= self.rate.abs() * near
    }

    /// The sense in which it slides before its instant (-1) or behind it (1).
    fn sense(&self, side: f64, near: f64) -> f64 {
        match self.turns(near) {
            true => side * self.rate,
            false => self.speed,
        }
    }
}

/// Times at which something turns back.
#[derive(Default)]
pub(super) struct Reversals {
    /// Between two samples, rising.
    pub between: Vec<f64>,
    /// Whether at the second one.
    pub at_end: bool,
}

/// When what slides turns back between two samples.
pub(super) fn reversals<F: ForceSource>(
    sampler: &mut Sampler<F>,
    asked: &Asked,
    [(from, before), (to, behind)]: [(f64, &[Slide]); 2],
) -> Reversals {
    let near = 2.0 * BESIDE * sampler.duration();
    let mut found = Reversals::default();
    if to - from <= 2.0 * near {
        return found;
    }
    let turns = turns_between(sampler, asked, [(from, before), (to, behind)]);
    found.between = turns.into_iter().map(|(_, time)| time).collect();
    found.at_end = found.between.contains(&to);
    (found.between).retain(|time| from + near < *time && *time < to - near);
    found.between.sort_by(f64::total_cmp);
    found.between.dedup_by(|b, a| *b - *a <= near);
    found
}

/// What turns back between two times or at the second one, and when, in whatever order.
pub(crate) fn turns_between<F: ForceSource>(
    sampler: &mut Sampler<F>,
    asked: &Asked,
    [(from, before), (to, behind)]: [(f64, &[Slide]); 2],
) -> Vec<(usize, f64)> {
    let near = 2.0 * BESIDE * sampler.duration();
    let mut found = Vec::new();
    for (which, (a, b)) in before.iter().zip(behind).enumerate() {
        let [start, end] = [a.sense(1.0, near), b.sense(-1.0, near)];
        if b.turns(near) && b.rate != 0.0 {
            found.push((which, to));
        }
        if start * end < 0.0 {
            let ends = [(from, start), (to, end)];
            found.push((which, sampler.turns_back(asked, which, ends)));
        } else if a.rate * start < 0.0 && b.rate * end > 0.0 {
            // It slows down and gets faster again: what lies between may have turned back twice.
            let middle = from + (to - from) * a.rate / (a.rate - b.rate);
            let speeds = sampler.sliding_at(asked, middle);
            let least = speeds.get(which).copied().unwrap_or(start);
            if least * start < 0.0 {
                let ends = [(from, start), (middle, least), (to, end)];
                let both = [0, 1].map(|k| [ends[k], ends[k + 1]]);
                found.extend(both.map(|ends| (which, sampler.turns_back(asked, which, ends))));
            }
        }
    }
    found
}
