//! Local peaks of a measure over a motion.

use std::sync::Arc;

use kempe_measure::Held;
use kempe_motion::Motion;

use crate::designs::bench::{Bench, Refused};
use crate::quantity::Quantity;
use crate::rows::RowPlace;

/// Instants at which a measure is looked at for peaks.
const INSTANTS: usize = 121;
/// Peaks lower than the highest by more than this part of the measure's range are left out.
const HIGH: f64 = 0.3;
/// Peaks at most: where a motion goes through the same several times, several of each.
const MOST: usize = 32;
/// A measure that changes by no more than this part of its size is level: what is seen of it is rounding.
const LEVEL: f64 = 1e-12;
/// ... and one that changes by no more than this part and has more peaks than so many, as sums of what is much larger than they are.
const ROUGH: f64 = 1e-6;
const MOST_ROUGH: usize = 24;
/// Rounds in which a peak between three instants is closed in on, and to which part of their distance: nearer, values are rounding.
const ROUNDS: usize = 40;
const CLOSE: f64 = 1e-8;

/// A local peak of a measure times a sense.
pub(super) struct Peak {
    /// Which of the measures.
    pub which: usize,
    pub sense: f64,
    pub held: Held,
    /// What the measure times the sense is there.
    pub value: f64,
    /// When it is, as a part of the whole time.
    pub part: f64,
}

/// What is looked at for peaks.
pub(super) struct Sought<'q> {
    pub measure: &'q Quantity,
    /// In which senses.
    pub senses: &'static [f64],
}

/// Where measures have local peaks near the highest.
///
/// # Errors
///
/// What cannot be measured.
pub(super) fn peaks(
    bench: &Bench<'_>,
    motion: &Arc<Motion>,
    sought: &[Sought<'_>],
) -> Result<Vec<Peak>, Refused> {
    if sought.is_empty() {
        return Ok(Vec::new());
    }
    let duration =
        kempe_motion::drive_path::duration(&motion.mechanism().model, &motion.design.parameters);
    let quantities: Vec<&Quantity> = sought.iter().map(|it| it.measure).collect();
    let mut along = bench.along(motion, &quantities, &mut bench.watch())?;
    let time = |i: usize| duration * i as f64 / (INSTANTS - 1) as f64;
    let rows: Vec<Vec<f64>> = (0..INSTANTS)
        .map(|i| along.values(RowPlace::Time(time(i))))
        .collect();
    let mut found = Vec::new();
    for (which, it) in sought.iter().enumerate() {
        for sense in it.senses {
            let h: Vec<f64> = rows.iter().map(|row| sense * row[which]).collect();
            let sound = h.iter().copied().filter(|x| x.is_finite());
            let ends = (f64::INFINITY, f64::NEG_INFINITY);
            let (low, high) = sound.fold(ends, |(a, b), x| (a.min(x), b.max(x)));
            let range = high - low;
            if is_level(&h, range, low.abs().max(high.abs())) {
                continue;
            }
            let mut at = |t: f64| sense * along.values(RowPlace::Time(t))[which];
            let own = local_peaks(&h, high - HIGH * range, &time, &mut at);
            found.extend(own.into_iter().map(|(value, time)| Peak {
                which,
                sense: *sense,
                value,
                part: time / duration,
                held: Held::Extreme { of: which, time },
            }));
        }
    }
    Ok(found)
}

/// Whether values of this range and size are level but for rounding: no place is higher than another.
fn is_level(h: &[f64], range: f64, size: f64) -> bool {
    let is_peak = |w: &&[f64]| w[1] > w[0] && w[1] >= w[2];
    let rough = || h.windows(3).filter(is_peak).count() > MOST_ROUGH;
    !(range > LEVEL * size) || (range <= ROUGH * size && rough())
}

/// Local peaks above a level among values at even times, the highest first, each with its time.
fn local_peaks(
    h: &[f64],
    level: f64,
    time: &dyn Fn(usize) -> f64,
    at: &mut dyn FnMut(f64) -> f64,
) -> Vec<(f64, f64)> {
    let last = h.len() - 1;
    let mut own: Vec<(f64, f64)> = Vec::new();
    for i in 0..h.len() {
        let before = i.checked_sub(1).map_or(f64::NEG_INFINITY, |j| h[j]);
        let after = h.get(i + 1).copied().unwrap_or(f64::NEG_INFINITY);
        if !(h[i] >= before && h[i] > after && h[i] >= level) {
            continue;
        }
        own.push(match i == 0 || i == last {
            true => (h[i], time(i)),
            false => {
                let (t, value) = closed_in([time(i - 1), time(i), time(i + 1)], h[i], at);
                (value, t)
            }
        });
    }
    own.sort_by(|a, b| b.0.total_cmp(&a.0));
    own.truncate(MOST);
    own
}

/// A peak between three instants, by parabolas and, where these do not serve, golden sections (R. P. Brent, 1973); its time and value. What
/// its place is missed by, slopes are missed by: it is closed in on as far as values tell.
fn closed_in(
    [mut low, middle, mut high]: [f64; 3],
    value: f64,
    at: &mut dyn FnMut(f64) -> f64,
) -> (f64, f64) {
    const GOLDEN: f64 = 0.381_966_011_250_105;
    let near = CLOSE * (high - low);
    let (mut best, mut second, mut third) = ((middle, value), (middle, value), (middle, value));
    let (mut step, mut before): (f64, f64) = (0.0, 0.0);
    for _ in 0..ROUNDS {
        let centre = 0.5 * (low + high);
        if (best.0 - centre).abs() + 0.5 * (high - low) <= 2.0 * near {
            break;
        }
        let [a, b] = [second, third].map(|other| (best.0 - other.0, best.1 - other.1));
        let (over, under) = (
            b.0 * b.0 * a.1 - a.0 * a.0 * b.1,
            2.0 * (b.0 * a.1 - a.0 * b.1),
        );
        let parabola = -over / under;
        let inside = low < best.0 + parabola && best.0 + parabola < high;
        (before, step) = match inside && parabola.abs() < 0.5 * before.abs() {
            true => (step, parabola),
            false => {
                let longer = if best.0 < centre { high } else { low } - best.0;
                (longer, GOLDEN * longer)
            }
        };
        let next = best.0 + step.signum() * step.abs().max(near);
        let there = (next, at(next));
        let better = there.1 > best.1;
        let (inside, outside) = if better {
            (there.0, best.0)
        } else {
            (best.0, there.0)
        };
        match outside > inside {
            true => high = outside,
            false => low = outside,
        }
        if better {
            (best, second, third) = (there, best, second);
        } else if there.1 >= second.1 || second.0 == best.0 {
            (second, third) = (there, second);
        } else if there.1 >= third.1 || third.0 == best.0 || third.0 == second.0 {
            third = there;
        }
    }
    (best.0, best.1)
}
