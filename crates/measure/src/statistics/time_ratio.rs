//! Durations of both strokes of a cycle.

use std::f64::consts::TAU;

use kempe_model::{Drive, LawPiece, Measure};
use kempe_motion::Motion;
use kempe_motion::drive_path::is_cycle;
use kempe_number::Number;
use kempe_units::Dimension;

use super::survey::Point;
use crate::force_source::ForceSource;
use crate::sampler::{Asked, Sampler};

/// Values that differ by less than this part of the range are the same.
const SAME: f64 = 1e-6;
/// A motion goes through so many cycles of a measure at most, or through a product of such numbers.
const PRIMES: [usize; 25] = [
    2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53, 59, 61, 67, 71, 73, 79, 83, 89, 97,
];
/// A stroke that takes less than this part of a cycle is a leap, and takes no time.
const AT_ONCE: f64 = 1e-12;
/// No more are told apart.
const MOST: usize = 10_000;
/// Parts of the motion at which a cycle that is repeated is held to the next one.
const PLACES: [f64; 8] = [0.037, 0.103, 0.161, 0.229, 0.283, 0.347, 0.419, 0.473];

/// Duration of the slower stroke over that of the faster, from the time between both extremes and how long [a cycle](cycle_of) is.
pub(crate) fn time_ratio<T: Number>(between: T, cycle: T) -> T {
    let between = between.abs();
    let stroke = between - cycle * (between.value() / cycle.value()).floor();
    let back = cycle - stroke;
    let quicker = stroke.min(back);
    let ratio = stroke.max(back) / quicker;
    (quicker - cycle * AT_ONCE).choose(ratio, T::from_f64(f64::INFINITY))
}

/// The times from which a ratio counts, and what it would be by other extremes that are as small and as large.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Strokes {
    /// When the measure is smallest, and largest, s.
    pub ends: [f64; 2],
    /// When else it is, and what the ratio would be by that.
    pub other: Option<([f64; 2], f64)>,
}

/// From which of several extremes the ratio counts: from the first of each, where it matters.
///
/// A lever that its rod meets in line within its swing stands farthest out twice in a turn: which of both rounding finds larger says nothing.
pub(super) fn strokes(found: [f64; 2], rivals: &[Vec<f64>; 2], cycle: f64) -> Strokes {
    let ratio = |[low, high]: [f64; 2]| time_ratio(high - low, cycle);
    let first = |times: &[f64], found: f64| times.iter().copied().fold(found, f64::min);
    let first = [0, 1].map(|side| first(&rivals[side], found[side]));
    let own = ratio(first);
    // What a change of the strokes makes of their ratio: a cycle later it is the same.
    let differs = |other: f64| (other - own).abs() > SAME * (1.0 + own.max(other)) * (1.0 + own);
    let others = [1, 0].into_iter().flat_map(|side| {
        let mut times = rivals[side].clone();
        times.sort_by(f64::total_cmp);
        times.into_iter().map(move |time| {
            let mut ends = first;
            ends[side] = time;
            ends
        })
    });
    let mut others = others.map(|ends| (ends, ratio(ends)));
    let other = others.find(|(_, other)| differs(*other));
    Strokes {
        ends: if other.is_some() { first } else { found },
        other,
    }
}

/// The part of the motion, 1 over a whole number, after which a measure with this range does what it did before; `None` where the motion is no cycle of it.
///
/// Every drive has to end where it started, or whole turns from there. One turn need not be a cycle: behind gears the measure goes through a part of one, or
/// through several.
pub(crate) fn cycle_of<F: ForceSource>(
    sampler: &mut Sampler<F>,
    measure: &Measure,
    range: f64,
) -> Option<f64> {
    let model = &sampler.motion().mechanism().model;
    if !is_cycle(model, sampler.parameters()) {
        return None;
    }
    let turns = Turns::of(sampler);
    let asked = sampler.asked(&[measure]);
    let back = match turns {
        Turns::None => true,
        // What forces do at a start may differ from what they do at an end.
        _ if asked.forces => stands_as_before(sampler.motion()),
        Turns::Some => comes_back(sampler, &asked, range, false),
        Turns::Even => comes_back(sampler, &asked, range, true),
    };
    if !back || !matches!(turns, Turns::Even) {
        return back.then_some(1.0);
    }
    let duration = sampler.duration();
    let mut value = |part: f64| Point::take(sampler, &asked, part * duration).value();
    let first = value(PLACES[0]);
    let same = |before: f64, behind: f64| (before - behind).abs() <= SAME * range;
    let mut repeats = |cycles: usize| {
        let part = 1.0 / cycles as f64;
        same(first, value(PLACES[0] + part))
            && (PLACES[1..].iter()).all(|place| same(value(*place), value(place + part)))
    };
    let mut cycles = 1;
    // What is the same all along has no cycles to count.
    for prime in PRIMES.into_iter().filter(|_| range > 0.0) {
        while cycles < MOST && repeats(cycles * prime) {
            cycles *= prime;
        }
    }
    Some(1.0 / cycles as f64)
}

/// Whether a measure is at the end of the motion what it was at its start, and, where asked, goes on as it began.
fn comes_back<F: ForceSource>(
    sampler: &mut Sampler<F>,
    asked: &Asked,
    range: f64,
    and_goes_on: bool,
) -> bool {
    let duration = sampler.duration();
    let [first, last] = [0.0, duration].map(|time| Point::take(sampler, asked, time));
    let turned = (first.rate() - last.rate()).abs() * duration / TAU;
    // A rate that is not known says nothing.
    let goes_on = !and_goes_on || !(turned > SAME * range);
    goes_on && (first.value() - last.value()).abs() <= SAME * range
}

/// Whether all bodies stand at the end of a motion as they did at its start.
fn stands_as_before(motion: &Motion) -> bool {
    let [first, last] = [0, motion.nodes() - 1].map(|index| motion.node(index).1);
    let size = motion.size();
    first.iter().zip(&last).all(|(a, b)| {
        let moved = (a.x - b.x).abs().max((a.y - b.y).abs());
        let turned = (a.c - b.c).abs().max((a.s - b.s).abs());
        moved <= SAME * size && turned <= SAME
    })
}

/// How drives that end where they started, or whole turns from there, do so.
enum Turns {
    /// All where they started.
    None,
    /// The only one that moves goes whole turns at one speed.
    Even,
    /// In another way.
    Some,
}

impl Turns {
    fn of<F: ForceSource>(sampler: &Sampler<F>) -> Self {
        let (model, parameters) = (&sampler.motion().mechanism().model, sampler.parameters());
        let stays = |drive: &Drive| {
            drive.dimension != Dimension::ANGLE || drive.law.way(parameters).abs() < 0.5 * TAU
        };
        if model.drives.iter().all(stays) {
            return Self::None;
        }
        let path = sampler.path_drive();
        let drive = path.and_then(|drive| model.drives.get(drive.index()));
        match drive.map(|drive| drive.law.pieces.as_slice()) {
            Some([LawPiece::ConstantSpeed { .. }]) => Self::Even,
            _ => Self::Some,
        }
    }
}
