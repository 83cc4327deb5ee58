//! Where places are met whose timing is given: at values of a drive or of time, at even times, or where the path is passed to the same part of its length.

use kempe_model::{DriveId, Model};
use kempe_motion::drive_path::duration;

use super::met::{Given, Met, Moving, dot, miss, square};
use super::nearest::Nodes;
use super::way::{Here, Way};

/// Steps in which a place is closed in on.
const STEPS: usize = 80;
/// A step below this part of the way ends that; where a closed one is begun, below the other.
const CLOSE: f64 = 1e-15;
const CLOSE_BEGUN: f64 = 1e-14;
/// ... and below this one, while places are only about where they are.
const NEARLY: f64 = 1e-9;
/// Steps below this part that get no shorter are rounding.
const ROUNDING: f64 = 1e-12;
/// A coordinate this near to the end of a law, in parts of its size, is that end.
const AT_END: f64 = 1e-12;

/// Whether a step, as a part of the way, is none but rounding: it is small, and not half as long as the last.
fn rests(step: f64, last: f64) -> bool {
    step <= ROUNDING && !(step < last / 2.0)
}

/// What tells how far along the way a place is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum By {
    Time,
    Length,
}

/// The first time at which a drive has a value, s.
pub(super) fn passed(model: &Model, drive: DriveId, value: f64, parameters: &[f64]) -> Option<f64> {
    let law = &model.drives.get(drive.index())?.law;
    if let Some(time) = law.first_time(value, parameters) {
        return Some(time);
    }
    // The last coordinate may be missed by a rounding error.
    let end = duration(model, parameters);
    let near =
        |time: f64| (law.at(time, parameters) - value).abs() <= AT_END * value.abs().max(1.0);
    [0.0, end].into_iter().find(|time| near(*time))
}

/// Places at times, s.
pub(super) fn at_times(way: &mut Way, given: &Given, times: &[f64]) -> Met {
    let mut met = Met::new(given.places.len());
    let duration = way.duration();
    for (place, time) in times.iter().enumerate() {
        let u = time / duration * way.end();
        met.at[place] = way.within(u);
        met.misses[place] = miss(&way.here(u).at, given, place);
        met.moving[place] = Moving::Timed(place);
    }
    met
}

/// How far each given place is along what is given, as a part of the whole: of an open one from 0 to 1, of a closed one below 1.
pub(super) fn parts(given: &Given, by: By, closed: bool) -> Vec<f64> {
    let n = given.places.len();
    match by {
        By::Time if closed => (0..n).map(|k| k as f64 / n as f64).collect(),
        By::Time => (0..n).map(|k| k as f64 / (n - 1) as f64).collect(),
        By::Length => {
            let apart = |a: usize, b: usize| {
                let [p, q] = [a, b].map(|k| given.places[k]);
                let [x, y] = [q[0] - p[0], q[1] - p[1]];
                (x * x + y * y).sqrt()
            };
            let mut sums = vec![0.0];
            for k in 1..n {
                sums.push(sums[k - 1] + apart(k - 1, k));
            }
            let whole = match closed {
                true => sums[n - 1] + apart(n - 1, 0),
                false => sums[n - 1],
            };
            sums.iter()
                .map(|s| s / whole.max(f64::MIN_POSITIVE))
                .collect()
        }
    }
}

/// The way by how far along it is, as a part of the whole.
struct Paced<'w> {
    way: &'w mut Way,
    nodes: &'w Nodes,
    by: By,
    /// The parts at the nodes.
    marks: Vec<f64>,
    whole: f64,
}

impl<'w> Paced<'w> {
    fn new(way: &'w mut Way, nodes: &'w Nodes, by: By) -> Option<Self> {
        let end = way.end();
        let whole = match by {
            By::Time => 1.0,
            // Of a closed way the last node is the first one.
            By::Length => way.whole_length(),
        };
        let count = nodes.segments();
        let mut marks: Vec<f64> = match by {
            By::Time => (0..=count).map(|k| k as f64 / count as f64).collect(),
            By::Length => nodes.here.iter().map(|h| h.length / whole).collect(),
        };
        if let Some(last) = marks.last_mut() {
            *last = 1.0;
        }
        let rising = marks.windows(2).all(|pair| pair[0] <= pair[1]);
        (whole > 0.0 && rising && end > 0.0).then_some(Self {
            way,
            nodes,
            by,
            marks,
            whole,
        })
    }

    /// Between which nodes a part lies, and about where: the cubic whose slopes at the nodes are how fast the path is passed there.
    fn about(&self, part: f64) -> (usize, f64) {
        let k = self.marks.partition_point(|mark| *mark <= part);
        let k = k.clamp(1, self.marks.len() - 1) - 1;
        let (a, b) = (self.marks[k], self.marks[k + 1]);
        if !(b > a) {
            return (k, 0.0);
        }
        let along = ((part - a) / (b - a)).clamp(0.0, 1.0);
        if self.by == By::Time {
            return (k, along);
        }
        let slopes = [k, k + 1].map(|k| {
            let passed = speed(&self.nodes.here[k]) / self.whole * self.nodes.step;
            (b - a) / passed
        });
        let curved = hermite([0.0, 1.0], slopes, along);
        match (0.0..=1.0).contains(&curved) {
            true => (k, curved),
            // Near a place of rest.
            false => (k, along),
        }
    }

    /// Where the way is passed to this part, and what is there; the rate is by the part.
    fn here(&mut self, part: f64) -> (f64, Here) {
        let part = match self.way.closed {
            true => part.rem_euclid(1.0),
            false => part,
        };
        let step = self.nodes.step;
        if self.by == By::Time {
            let u = part * self.way.end();
            let mut here = self.way.here(u);
            here.rate = here.rate.map(|x| x * self.way.end());
            return (u, here);
        }
        let (k, along) = self.about(part);
        let (mut low, mut high) = (k as f64 * step, (k + 1) as f64 * step);
        let mut u = low + along * step;
        let mut here = self.way.here(u);
        let mut last = f64::INFINITY;
        for _ in 0..STEPS {
            let off = here.length / self.whole - part;
            let rate = speed(&here) / self.whole;
            match off > 0.0 {
                true => high = u,
                false => low = u,
            }
            let mut next = u - off / rate;
            if !(next >= low && next <= high) {
                next = (low + high) / 2.0;
            }
            let step = (next - u).abs() / self.way.end();
            let done = step <= CLOSE || rests(step, last);
            (u, last) = (next, step);
            here = self.way.here(u);
            if done {
                break;
            }
        }
        let rate = speed(&here) / self.whole;
        here.rate = here.rate.map(|x| x / rate);
        (u, here)
    }

    /// About what is there, and its rate by the part, between the nodes.
    fn roughly(&self, part: f64) -> ([f64; 3], [f64; 3]) {
        let (k, along) = self.about(part.rem_euclid(1.0));
        let step = self.nodes.step;
        let [a, b] = [k, k + 1].map(|k| &self.nodes.here[k]);
        let at = |i: usize| {
            let slopes = [a.rate[i] * step, b.rate[i] * step];
            hermite([a.at[i], b.at[i]], slopes, along)
        };
        let width = self.marks[k + 1] - self.marks[k];
        let rate = [0, 1, 2].map(|i| (b.at[i] - a.at[i]) / width);
        ([0, 1, 2].map(at), rate)
    }
}

/// The cubic from one value to the next with these slopes, so far between them.
fn hermite([a, b]: [f64; 2], [from, to]: [f64; 2], along: f64) -> f64 {
    let back = 1.0 - along;
    let line = a + along * (b - a);
    line + along * back * (back * (from - (b - a)) - along * (to - (b - a)))
}

/// How fast the point goes along its path.
fn speed(here: &Here) -> f64 {
    (here.rate[0] * here.rate[0] + here.rate[1] * here.rate[1]).sqrt()
}

/// Places at given parts of the way; a closed one is begun where, and gone the way, that is best.
pub(super) fn paced(
    way: &mut Way,
    nodes: &Nodes,
    given: &Given,
    by: By,
    parts: &[f64],
) -> Option<Met> {
    let (n, closed) = (given.places.len(), way.closed);
    let mut met = Met::new(n);
    let mut paced = Paced::new(way, nodes, by)?;
    let (mut shift, mut sense) = (0.0, 1.0);
    if closed {
        (shift, sense) = begun(&mut paced, given, parts);
    }
    let mut tangents = Vec::new();
    for (place, part) in parts.iter().enumerate() {
        let part = shift + sense * part;
        let (u, here) = paced.here(part);
        met.misses[place] = miss(&here.at, given, place);
        met.at[place] = paced.way.within(u);
        met.moving[place] = Moving::Paced(part.rem_euclid(1.0));
        if !closed {
            met.moving[place] = match place {
                0 => Moving::End,
                last if last == n - 1 => Moving::End,
                _ => Moving::Paced(part),
            };
        }
        tangents.push((place, here.rate));
    }
    if closed {
        let size: f64 = tangents.iter().map(|(_, t)| square(t)).sum::<f64>().sqrt();
        if size > 0.0 && size.is_finite() {
            let unit = tangents.into_iter();
            met.free = vec![unit.map(|(k, t)| (k, t.map(|x| x / size))).collect()];
        }
    }
    Some(met)
}

/// Where a closed way is begun best, and which way it is gone.
fn begun(paced: &mut Paced<'_>, given: &Given, parts: &[f64]) -> (f64, f64) {
    let tried = 2 * paced.nodes.segments();
    let steps = tried as f64;
    // What is there at even steps, once round and one more.
    let all = (0..=tried).map(|k| paced.roughly((k % tried) as f64 / steps).0);
    let all: Vec<[f64; 3]> = all.collect();
    let mut best = (f64::INFINITY, 0.0, 1.0);
    for sense in [1.0, -1.0] {
        // Between which steps each place is where nothing is shifted, and how far.
        let from = parts.iter().map(|part| {
            let at = (sense * part).rem_euclid(1.0) * steps;
            let step = at.floor();
            (step as usize % tried, at - step)
        });
        let from: Vec<(usize, f64)> = from.collect();
        for shift in 0..tried {
            let there = from.iter().enumerate().map(|(place, (step, along))| {
                let step = step + shift;
                let step = if step < tried { step } else { step - tried };
                let [a, b] = [&all[step], &all[step + 1]];
                let at = [0, 1, 2].map(|i| a[i] + along * (b[i] - a[i]));
                square(&miss(&at, given, place))
            });
            let there: f64 = there.sum();
            if there < best.0 {
                best = (there, shift as f64 / steps, sense);
            }
        }
    }
    let (_, mut shift, sense) = best;
    let around = [shift - 2.0 / steps, shift + 2.0 / steps];
    // First between the nodes, then where places are.
    shift = least(around, shift, NEARLY, |shift| {
        let all = parts.iter().enumerate().map(|(k, part)| {
            let (at, rate) = paced.roughly(shift + sense * part);
            (miss(&at, given, k), rate)
        });
        fall(all)
    });
    shift = least(around, shift, CLOSE_BEGUN, |shift| {
        let all = parts.iter().enumerate().map(|(k, part)| {
            let (_, here) = paced.here(shift + sense * part);
            (miss(&here.at, given, k), here.rate)
        });
        fall(all)
    });
    (shift, sense)
}

/// How a sum of squares changes with the shift, and how it would curve if the path were straight, of misses and rates.
fn fall(all: impl Iterator<Item = ([f64; 3], [f64; 3])>) -> [f64; 2] {
    all.fold([0.0; 2], |[slope, small], (miss, rate)| {
        [slope + dot(&miss, &rate), small + square(&rate)]
    })
}

/// Where a slope that rises over a range is nothing, closed in on from a place until steps are so short.
fn least(
    [mut low, mut high]: [f64; 2],
    mut shift: f64,
    close: f64,
    mut slopes: impl FnMut(f64) -> [f64; 2],
) -> f64 {
    let mut before: Option<(f64, f64)> = None;
    let mut last = f64::INFINITY;
    for _ in 0..STEPS {
        let [slope, small] = slopes(shift);
        match slope > 0.0 {
            true => high = shift,
            false => low = shift,
        }
        let secant = before.map(|(v, other)| (slope - other) / (shift - v));
        let curvature = secant.filter(|c| *c > 0.05 * small).unwrap_or(small);
        let mut next = shift - slope / curvature;
        if !(next > low && next < high) {
            next = (low + high) / 2.0;
        }
        before = Some((shift, slope));
        let step = (next - shift).abs();
        let done = step <= close || rests(step, last);
        (shift, last) = (next, step);
        if done {
            break;
        }
    }
    shift
}
