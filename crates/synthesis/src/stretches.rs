//! Stretches of a point's way that come near to a circle or a line: those that do so best among their neighbours.

use crate::C;
use crate::one_dimension::golden;

/// Samples of a stretch while it is looked for, and when it is placed.
const COARSE: usize = 48;
const FINE: usize = 96;
/// Errors that differ by less than this, in sizes of the way, are the same.
const SAME: f64 = 1e-10;
/// Steps by which a stretch is placed.
const STEPS: usize = 28;

/// A point's way over a parameter.
pub struct Way<'a> {
    /// Where the point is; `None` where it does not get.
    pub place: &'a mut dyn FnMut(f64) -> Option<C>,
    /// The parameter's range.
    pub range: [f64; 2],
    /// Whether the way ends where it begins, so that a stretch may go on over its end.
    pub closed: bool,
}

/// By how much a stretch is off what it comes near to at most, and what that is.
pub type Nearest<'a, F> = &'a dyn Fn(&[C]) -> Option<(f64, F)>;

/// A stretch of a way.
#[derive(Clone, Copy, Debug)]
pub struct Stretch<F> {
    /// The parameter at its start, within the range.
    pub from: f64,
    /// By how much the way is off what it comes near to, at most.
    pub deviation: f64,
    /// What it comes near to.
    pub near: F,
}

impl Way<'_> {
    fn at(&mut self, parameter: f64) -> Option<C> {
        let [low, high] = self.range;
        let beyond = self.closed && parameter > high;
        (self.place)(if beyond {
            parameter - (high - low)
        } else {
            parameter
        })
    }

    /// Places of so many steps between two parameters.
    fn between(&mut self, [from, to]: [f64; 2], steps: usize) -> Option<Vec<C>> {
        let at = |k: usize| from + (to - from) * (k as f64 / steps as f64);
        (0..=steps).map(|k| self.at(at(k))).collect()
    }

    /// The places of the whole way, in so many steps; of a closed one the last is the first.
    pub fn places(&mut self, steps: usize) -> Option<Vec<C>> {
        self.between(self.range, steps)
    }
}

/// The stretches of a length (of the parameter) that come nearer to something than their neighbours, the best first and at most so many. `nearest`
/// says how far a stretch is off, and off what.
///
/// `None` where the point does not get through the whole range, or the length is none of it.
pub fn stretches<F>(
    way: &mut Way<'_>,
    length: f64,
    most: usize,
    nearest: Nearest<'_, F>,
) -> Option<Vec<Stretch<F>>> {
    let [low, high] = way.range;
    let room = match way.closed {
        true => high - low,
        false => high - low - length,
    };
    if !(length > 0.0 && room >= 0.0 && length <= high - low) {
        return None;
    }
    let step = length / COARSE as f64;
    let steps = (room / step).floor();
    // Both ends of an open way start or end a stretch; of a closed one they are the same.
    let mut starts: Vec<f64> = (0..=steps as usize)
        .map(|k| low + k as f64 * step)
        .filter(|start| !way.closed || *start < high)
        .collect();
    if !way.closed && starts.last().is_some_and(|last| *last < low + room) {
        starts.push(low + room);
    }
    let mut errors = Vec::with_capacity(starts.len());
    let mut size = 0.0_f64;
    let table = way.between(
        [low, low + (steps + COARSE as f64) * step],
        steps as usize + COARSE,
    );
    let table = match way.closed {
        true => table,
        // Rounding may put the last place a little beyond the end.
        false => table.or_else(|| way.between([low, high], steps as usize + COARSE)),
    }?;
    if let Some(first) = table.first() {
        size = table.iter().fold(size, |m, p| m.max((*p - *first).norm()));
    }
    for (k, start) in starts.iter().enumerate() {
        let own = match table.get(k..=k + COARSE) {
            Some(own) => own.to_vec(),
            None => way.between([*start, start + length], COARSE)?,
        };
        errors.push(nearest(&own).map_or(f64::INFINITY, |(error, _)| error));
    }
    let alike = |error: f64| (error / (SAME * size)).round();
    let rounded: Vec<f64> = errors.iter().map(|e| alike(*e)).collect();
    let mut found = Vec::new();
    let mut lows = valleys(&rounded, way.closed);
    lows.sort_by(|a, b| errors[a.0].total_cmp(&errors[b.0]));
    for (first, last) in lows.into_iter().take(most) {
        let before = starts[first] - step;
        let after = starts[last % starts.len()]
            + if last >= starts.len() {
                high - low
            } else {
                0.0
            }
            + step;
        let bounds = match way.closed {
            true => [before, after],
            false => [before.max(low), after.min(low + room)],
        };
        found.extend(placed(way, length, nearest, bounds));
    }
    found.sort_by(|a, b| a.deviation.total_cmp(&b.deviation));
    Some(found)
}

/// Runs of equal values with none less beside them, by their first and last index; on a circle the last may be counted on over the end.
fn valleys(values: &[f64], closed: bool) -> Vec<(usize, usize)> {
    let count = values.len();
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for k in 0..count {
        match runs.last_mut() {
            Some((_, last)) if values[*last] == values[k] => *last = k,
            _ => runs.push((k, k)),
        }
    }
    if let (true, [(0, end), .., (start, _)]) = (closed, runs.as_slice())
        && values[0] == values[count - 1]
    {
        let joined = (*start, end + count);
        runs.pop();
        runs[0] = joined;
    }
    let level = |k: usize| values[runs[k].0 % count];
    let mut found = Vec::new();
    for k in 0..runs.len() {
        let before = match (k, closed) {
            (0, false) => None,
            (0, true) => Some(runs.len() - 1),
            _ => Some(k - 1),
        };
        let after = match (k + 1 == runs.len(), closed) {
            (true, false) => None,
            (true, true) => Some(0),
            _ => Some(k + 1),
        };
        let lower = |other: Option<usize>| other.is_none_or(|o| o == k || level(o) > level(k));
        if level(k).is_finite() && lower(before) && lower(after) {
            found.push(runs[k]);
        }
    }
    found
}

/// The best stretch that starts between two parameters, by the golden section.
fn placed<F>(
    way: &mut Way<'_>,
    length: f64,
    nearest: Nearest<'_, F>,
    [low, high]: [f64; 2],
) -> Option<Stretch<F>> {
    let [begin, end] = way.range;
    let wrapped = |start: f64, closed: bool| match closed {
        true if start < begin => start + (end - begin),
        true if start >= end => start - (end - begin),
        _ => start,
    };
    let mut best: Option<Stretch<F>> = None;
    let mut look = |start: f64| -> f64 {
        let start = wrapped(start, way.closed);
        let places = way.between([start, start + length], FINE);
        let Some((deviation, near)) = places.and_then(|places| nearest(&places)) else {
            return f64::NEG_INFINITY;
        };
        if best.as_ref().is_none_or(|best| deviation < best.deviation) {
            best = Some(Stretch {
                from: start,
                deviation,
                near,
            });
        }
        -deviation
    };
    // Ends of an open way may be best themselves.
    look(low);
    look(high);
    golden([low, high], STEPS, &mut look);
    best
}
