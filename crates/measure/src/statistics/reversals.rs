//! Where what rubs dry turns back between two samples: forces jump there.

use crate::force_source::ForceSource;
use crate::sampler::{Asked, Sampler};

/// So far from where it turns back, as a part of the motion's duration, both sides of a jump are looked at: nearer it counts as resting, and has the forces
/// of the way it goes on.
pub(crate) const BESIDE: f64 = 1e-11;

/// What turns back nearer to a sample than this part of the motion's duration does so there.
const ROUNDING: f64 = 1e-14;

/// A speed of less than this part of the one beside it is that of rest, up to which it is looked at no nearer than it slides so fast, in so many steps at most,
/// each so many times as near as the one before: friction jumps where something comes to rest, too.
const RESTS: f64 = 1e-9;
const SLIDES: f64 = 1e-8;
const NEARER: f64 = 0.1;
const STEPS: i32 = 6;

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
    pub(crate) fn turns(&self, near: f64) -> bool {
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
    /// So near behind the first one that this one still has the forces of the way before.
    pub behind: Option<f64>,
    /// At the second one, or so near before it that both sides are not looked at.
    pub at_end: Option<f64>,
    /// Right behind the first one, where something begins to slide there, and right before the second one, where it comes to rest; rising.
    pub from_rest: Vec<f64>,
    pub to_rest: Vec<f64>,
}

impl Reversals {
    /// Where samples are put between both times, rising, each with whether nothing lies between it and the one before.
    pub fn sides(&self, beside: f64) -> Vec<(f64, bool)> {
        let between = self.between.iter();
        let turns = between.flat_map(|t| [(t - beside, true), (t + beside, false)]);
        let begins = self.from_rest.iter().enumerate();
        let begins = begins.map(|(k, t)| (*t, k > 0));
        let ends = self.to_rest.iter().map(|t| (*t, true));
        let behind = self.behind.map(|t| (t + beside, false));
        let at_end = self.at_end.map(|t| (t - beside, true));
        let all = turns.chain(begins).chain(ends).chain(behind).chain(at_end);
        let mut all: Vec<(f64, bool)> = all.collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        all
    }

    /// Whether forces jump at the second one.
    pub fn ends(&self) -> bool {
        self.at_end.is_some() || !self.to_rest.is_empty()
    }
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
    // What is passed by less than rounding is met.
    let passed = |it: &Slide| match it.speed / it.rate {
        by if by.abs() > ROUNDING * sampler.duration() => by,
        _ => 0.0,
    };
    let since = |slides: &[Slide]| -> Vec<f64> {
        let turning = slides.iter().filter(|it| it.turns(near) && it.rate != 0.0);
        turning.map(passed).collect()
    };
    let later = since(before).into_iter().map(|by| from - by);
    found.behind = later.filter(|time| *time > from).reduce(f64::max);
    if found.between.contains(&to) {
        let earlier = since(behind).into_iter().map(|by| to - by);
        found.at_end = Some(earlier.fold(to, f64::min));
    }
    let all = before.iter().zip(behind).enumerate();
    for (which, (a, b)) in all {
        let rests = |it: &Slide, other: &Slide| {
            let least = RESTS * other.speed.abs();
            let [speed, gain] = [it.speed, it.rate * (to - from)].map(f64::abs);
            least > 0.0 && speed <= least && gain <= least
        };
        let mut beside = |rest: f64, other: f64, speed: f64| -> Vec<f64> {
            let nearer = (1..=STEPS).map(|k| rest + (other - rest) * kempe_number::powi(NEARER, k));
            let mut slides = |time: &f64| {
                let now = sampler.sliding_at(asked, *time).get(which).copied();
                now.is_some_and(|now| now.abs() > SLIDES * speed.abs())
            };
            nearer.take_while(&mut slides).collect()
        };
        if rests(a, b) {
            found.from_rest.extend(beside(from, to, b.speed));
        }
        if rests(b, a) {
            found.to_rest.extend(beside(to, from, a.speed));
        }
    }
    for times in [&mut found.from_rest, &mut found.to_rest] {
        times.sort_by(f64::total_cmp);
        times.dedup_by(|b, a| *b - *a <= near);
    }
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
