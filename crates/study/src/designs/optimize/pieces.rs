//! A number over the motion as the largest of its local peaks.
//!
//! The greatest value over a motion has a kink wherever another peak becomes the greatest, and an optimum often lies just there: of two
//! peaks neither can be lowered without the other rising. Who descends must know both. A number with one `max` or `min` in it is, at
//! each local peak, the measure inside put in its place; between two values of the parameters the peaks move smoothly.

use std::sync::Arc;

use kempe_measure::Held;
use kempe_mechanism::Mechanism;
use kempe_model::{Leaf, Measure, Model, Statistic};
use kempe_motion::{Motion, Silent};
use kempe_optimize::Piece;

use crate::columns::is_of_whole_motion;
use crate::designs::bench::{Bench, Refused};
use crate::quantity::Quantity;
use crate::rows::RowPlace;

/// Instants at which a measure is looked at for peaks.
const INSTANTS: usize = 121;
/// Peaks lower than the highest by more than this part of the measure's range are left out.
const HIGH: f64 = 0.3;
/// Peaks at most.
const MOST: usize = 8;
/// Rounds in which a peak between three instants is closed in on.
const ROUNDS: usize = 12;
/// Two peaks that differ by these parts of their value and of their slope are one.
const SAME: f64 = 1e-5;
const SAME_SLOPE: f64 = 1e-2;
/// Measures that name others more often than this are not looked into.
const MOST_LEAVES: usize = 200;

/// A number that is to be small.
pub(super) struct Wanted {
    pub number: Quantity,
    /// 1 where it is to be small as it is, -1 where it is to be large.
    pub sign: f64,
    /// The measure that takes its place at an instant, where it is the greatest or least of such.
    inner: Option<Quantity>,
}

impl Wanted {
    pub fn new(mechanism: &Mechanism, number: Quantity, sign: f64) -> Self {
        let inner = inner(mechanism, &number.measure).map(|measure| Quantity {
            name: number.name.clone(),
            measure,
            dimension: number.dimension,
        });
        Self {
            number,
            sign,
            inner,
        }
    }
}

/// A measure with those that it names written out; `None` where that is long.
fn written_out(model: &Model, measure: &Measure, left: &mut usize) -> Option<Measure> {
    let mut whole = true;
    let out = measure.substitute(&mut |leaf| {
        *left = left.saturating_sub(1);
        if *left == 0 || !whole {
            whole = false;
            return Measure::Leaf(leaf.clone());
        }
        match leaf {
            Leaf::Named(index) => {
                let named = model.measures.get(*index);
                let found = named.and_then(|named| written_out(model, &named.measure, left));
                whole &= found.is_some();
                found.unwrap_or_else(|| Measure::Leaf(leaf.clone()))
            }
            _ => Measure::Leaf(leaf.clone()),
        }
    });
    whole.then_some(out)
}

/// What takes the place of a number at an instant: its measure with what stands in its one `max` or `min`.
fn inner(mechanism: &Mechanism, measure: &Measure) -> Option<Measure> {
    let out = written_out(&mechanism.model, measure, &mut { MOST_LEAVES })?;
    let mut over = out.leaves().filter(|leaf| matches!(leaf, Leaf::Over(..)));
    let first = over.next()?.clone();
    let Leaf::Over(Statistic::Max | Statistic::Min, within) = &first else {
        return None;
    };
    if over.any(|other| *other != first) {
        return None;
    }
    // One within another has no place of its own.
    if is_of_whole_motion(mechanism, within) {
        return None;
    }
    Some(out.substitute(&mut |leaf| match leaf {
        Leaf::Over(..) => (**within).clone(),
        _ => Measure::Leaf(leaf.clone()),
    }))
}

/// The pieces of numbers at a design, with their derivatives to the varied parameters: of each the largest is its value, times its sign.
///
/// # Errors
///
/// Why the design has none.
pub(super) fn pieces(
    bench: &Bench<'_>,
    wanted: &[Wanted],
    values: &[f64],
) -> Result<Vec<Vec<Piece>>, Refused> {
    let motion = bench.motion(values, &mut Silent)?;
    let measures: Vec<&Measure> = wanted.iter().map(|w| &w.number.measure).collect();
    let exact = bench.sensitivities(&motion, &[Held::Path(motion.start)], &measures)?;
    let exact = exact.into_iter().next();
    let mut all: Vec<Vec<Piece>> = Vec::with_capacity(wanted.len());
    for (k, w) in wanted.iter().enumerate() {
        let found = exact.as_ref().map(|it| (it.values[k], &it.derivatives[k]));
        let (value, slope) = found.ok_or_else(|| Refused {
            lack: 2.0,
            why: format!("`{}` has no value", w.number.name),
        })?;
        all.push(vec![Piece {
            value: w.sign * value,
            slope: slope.iter().map(|d| w.sign * d).collect(),
        }]);
    }
    let inner: Vec<(usize, &Quantity)> = (wanted.iter().enumerate())
        .filter_map(|(k, w)| Some((k, w.inner.as_ref()?)))
        .collect();
    if inner.is_empty() {
        return Ok(all);
    }
    let peaks = peaks(bench, &motion, wanted, &inner, &all)?;
    let held: Vec<Held> = peaks.iter().map(|(_, held)| *held).collect();
    if held.is_empty() {
        return Ok(all);
    }
    let measures: Vec<&Measure> = inner.iter().map(|(_, q)| &q.measure).collect();
    let there = bench.sensitivities(&motion, &held, &measures)?;
    for ((which, _), found) in peaks.iter().zip(there) {
        let (k, _) = inner[*which];
        let sign = wanted[k].sign;
        let piece = Piece {
            value: sign * found.values[*which],
            slope: found.derivatives[*which].iter().map(|d| sign * d).collect(),
        };
        let sound = piece.value.is_finite() && piece.slope.iter().all(|d| d.is_finite());
        if sound && !is_top(&piece, &all[k][0]) {
            let value = piece.value.min(all[k][0].value);
            all[k].push(Piece { value, ..piece });
        }
    }
    Ok(all)
}

/// Whether a peak is the highest itself, which is known more exactly: it has its value and its slope. Another peak may come as near in value.
fn is_top(piece: &Piece, top: &Piece) -> bool {
    let size = |slope: &[f64]| slope.iter().map(|d| d * d).sum::<f64>().sqrt();
    let apart: Vec<f64> = piece
        .slope
        .iter()
        .zip(&top.slope)
        .map(|(a, b)| a - b)
        .collect();
    let near = (piece.value - top.value).abs() <= SAME * top.value.abs().max(piece.value.abs());
    near && size(&apart) <= SAME_SLOPE * size(&top.slope)
}

/// Where measures have local peaks besides the highest: which of them, and its place.
fn peaks(
    bench: &Bench<'_>,
    motion: &Arc<Motion>,
    wanted: &[Wanted],
    inner: &[(usize, &Quantity)],
    exact: &[Vec<Piece>],
) -> Result<Vec<(usize, Held)>, Refused> {
    let duration =
        kempe_motion::drive_path::duration(&motion.mechanism().model, &motion.design.parameters);
    let quantities: Vec<&Quantity> = inner.iter().map(|(_, q)| *q).collect();
    let mut along = bench.along(motion, &quantities, &mut Silent)?;
    let last = INSTANTS - 1;
    let time = |i: usize| duration * i as f64 / last as f64;
    let rows: Vec<Vec<f64>> = (0..INSTANTS)
        .map(|i| along.values(RowPlace::Time(time(i))))
        .collect();
    let mut found = Vec::new();
    for (which, (k, _)) in inner.iter().enumerate() {
        let sign = wanted[*k].sign;
        let h: Vec<f64> = rows.iter().map(|row| sign * row[which]).collect();
        let sound = h.iter().copied().filter(|x| x.is_finite());
        let (low, high) = sound.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
            (a.min(x), b.max(x))
        });
        let range = high - low;
        let top = exact[*k][0].value;
        // Where the number is not the greatest of what it is at instants, peaks say nothing of it.
        let apart = (top - high).abs();
        if !(range > 0.0) || apart > 0.1 * range {
            continue;
        }
        let mut own: Vec<(f64, Held)> = Vec::new();
        for i in 0..INSTANTS {
            let before = i.checked_sub(1).map_or(f64::NEG_INFINITY, |j| h[j]);
            let after = h.get(i + 1).copied().unwrap_or(f64::NEG_INFINITY);
            if !(h[i] >= before && h[i] > after && h[i] >= high - HIGH * range) {
                continue;
            }
            let at_end = i == 0 || i == last;
            let (at, value) = match at_end {
                true => (time(i), h[i]),
                false => closed_in([time(i - 1), time(i), time(i + 1)], h[i], &mut |t| {
                    sign * along.values(RowPlace::Time(t))[which]
                }),
            };
            let held = match at_end {
                true => Held::Break(at),
                false => Held::Time(at),
            };
            own.push((value, held));
        }
        own.sort_by(|a, b| b.0.total_cmp(&a.0));
        own.truncate(MOST);
        found.extend(own.into_iter().map(|(_, held)| (which, held)));
    }
    Ok(found)
}

/// A peak between three instants, by golden sections; its time and value.
fn closed_in(
    [mut low, middle, mut high]: [f64; 3],
    value: f64,
    at: &mut dyn FnMut(f64) -> f64,
) -> (f64, f64) {
    const GOLDEN: f64 = 0.381_966_011_250_105;
    let mut best = (middle, value);
    for _ in 0..ROUNDS {
        let longer_above = high - best.0 > best.0 - low;
        let next = match longer_above {
            true => best.0 + GOLDEN * (high - best.0),
            false => best.0 - GOLDEN * (best.0 - low),
        };
        let there = at(next);
        let (inside, outside) = match there > best.1 {
            true => ((next, there), best.0),
            false => (best, next),
        };
        match outside > inside.0 {
            true => high = outside,
            false => low = outside,
        }
        best = inside;
    }
    best
}
