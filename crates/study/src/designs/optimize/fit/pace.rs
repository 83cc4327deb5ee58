//! Where places are met whose timing is given: at values of a drive or of time, at even times, or where the path is passed to the same part of its length.

use super::nearest::{Nodes, dot};
use super::way::{Here, Way};
use super::{Given, Met, Moving, miss, square};

/// Steps in which a place is closed in on.
const STEPS: usize = 80;
/// A step below this part of the way ends that.
const CLOSE: f64 = 1e-15;

/// What tells how far along the way a place is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum By {
    Time,
    Length,
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

    /// Between which nodes a part lies, and about where.
    fn about(&self, part: f64) -> (usize, f64) {
        let k = self.marks.partition_point(|mark| *mark <= part);
        let k = k.clamp(1, self.marks.len() - 1) - 1;
        let (a, b) = (self.marks[k], self.marks[k + 1]);
        let along = if b > a { (part - a) / (b - a) } else { 0.0 };
        (k, along.clamp(0.0, 1.0))
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
            let done = (next - u).abs() <= CLOSE * self.way.end();
            u = next;
            here = self.way.here(u);
            if done {
                break;
            }
        }
        let rate = speed(&here) / self.whole;
        here.rate = here.rate.map(|x| x / rate);
        (u, here)
    }

    /// About what is there, between the nodes.
    fn roughly(&self, part: f64) -> [f64; 3] {
        let (k, along) = self.about(part.rem_euclid(1.0));
        let [a, b] = [k, k + 1].map(|k| self.nodes.here[k].at);
        [0, 1, 2].map(|i| a[i] + along * (b[i] - a[i]))
    }
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
    let cost = |paced: &Paced<'_>, shift: f64, sense: f64| -> f64 {
        let all = parts.iter().enumerate();
        all.map(|(k, part)| square(&miss(&paced.roughly(shift + sense * part), given, k)))
            .sum()
    };
    let mut best = (f64::INFINITY, 0.0, 1.0);
    for k in 0..tried {
        for sense in [1.0, -1.0] {
            let shift = k as f64 / tried as f64;
            let there = cost(paced, shift, sense);
            if there < best.0 {
                best = (there, shift, sense);
            }
        }
    }
    let (_, mut shift, sense) = best;
    let step = 2.0 / tried as f64;
    let [mut low, mut high] = [shift - step, shift + step];
    let mut before: Option<(f64, f64)> = None;
    for _ in 0..STEPS {
        let (mut slope, mut small) = (0.0, 0.0);
        for (k, part) in parts.iter().enumerate() {
            let (_, here) = paced.here(shift + sense * part);
            slope += dot(&miss(&here.at, given, k), &here.rate);
            small += square(&here.rate);
        }
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
        let done = (next - shift).abs() <= 1e-14;
        shift = next;
        if done {
            break;
        }
    }
    (shift, sense)
}
