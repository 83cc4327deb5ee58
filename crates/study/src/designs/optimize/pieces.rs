//! A number over the motion as the largest of its local peaks.
//!
//! The greatest value over a motion has a kink wherever another peak becomes the greatest, and an optimum often lies just there: of two
//! peaks neither can be lowered without the other rising. Who descends must know both. A number with one `max` or `min` in it is, at
//! each local peak, the measure inside put in its place; a `range` is what a peak lies above a valley. Between two values of the parameters both move
//! smoothly. The largest of several numbers, as a formula has it, has such kinks, too: all of them are pieces.

use std::sync::Arc;

use kempe_measure::Held;
use kempe_mechanism::Mechanism;
use kempe_model::{Leaf, Measure, Model, Statistic};
use kempe_motion::Motion;
use kempe_optimize::Piece;
use kempe_units::Builtin;

use super::differences::Difference;
use super::peaks::{Peak, Sought, peaks};
use crate::columns::is_of_whole_motion;
use crate::designs::bench::{Bench, Refused};
use crate::quantity::Quantity;
use crate::rows::RowPlace;

/// Between designs that hardly differ a peak moves by less than this part of the whole time.
const MOVES: f64 = 2e-3;
/// Two peaks that differ by these parts of their value and of their slope are one.
const SAME: f64 = 1e-5;
const SAME_SLOPE: f64 = 1e-2;
/// Different peaks of one measure at most.
const MOST: usize = 8;
/// A number that is the largest of more than so many by its formula is not parted into these.
const MOST_PARTS: usize = 32;
/// Measures that name others more often than this are not looked into.
pub(super) const MOST_LEAVES: usize = 200;

/// A number that is to be small.
pub(in crate::designs) struct Wanted {
    pub number: Quantity,
    /// 1 where it is to be small as it is, -1 where it is to be large.
    pub sign: f64,
    /// The numbers of which it is the largest by its formula; itself where it is of none.
    parts: Vec<Part>,
}

/// A number of which another is the largest.
struct Part {
    number: Quantity,
    sign: f64,
    /// What it is made of at instants, where that is known.
    inner: Option<Inner>,
}

/// What a number is made of at instants.
struct Inner {
    measure: Quantity,
    kind: Kind,
}

/// How.
#[derive(Clone, Copy)]
enum Kind {
    /// It is the greatest of the measure times the number's sign.
    Peak,
    /// It is the greatest less the least of the measure, less this.
    Range(f64),
}

impl Wanted {
    pub fn new(mechanism: &Mechanism, number: Quantity, sign: f64) -> Self {
        let parts = largest_of(&mechanism.model, &number.measure, sign).into_iter();
        let named = |measure: Measure| Quantity {
            name: number.name.clone(),
            measure,
            dimension: number.dimension,
        };
        let part = |(measure, sign): (Measure, f64)| Part {
            inner: inner(mechanism, &measure, sign).map(|(measure, kind)| Inner {
                measure: named(measure),
                kind,
            }),
            number: named(measure),
            sign,
        };
        Self {
            parts: parts.map(part).collect(),
            number,
            sign,
        }
    }
}

/// A measure with those that it names written out; `None` where that is long.
pub(super) fn written_out(model: &Model, measure: &Measure, left: &mut usize) -> Option<Measure> {
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

/// Numbers, each with its sign, of which one times its sign is the largest by its formula, as `max(a, b)`, `abs(a)` and sums of these are: where two are equally
/// large it has a kink. Where there is none, or there are too many, it alone.
fn largest_of(model: &Model, measure: &Measure, sign: f64) -> Vec<(Measure, f64)> {
    let out = written_out(model, measure, &mut { MOST_LEAVES });
    let parts = out.map_or(Vec::new(), |out| parted(&out, sign));
    match (2..=MOST_PARTS).contains(&parts.len()) {
        true => parts,
        false => vec![(measure.clone(), sign)],
    }
}

fn parted(measure: &Measure, sign: f64) -> Vec<(Measure, f64)> {
    let of = |part: &Measure, sign: f64| parted(part, sign);
    let sum = |a: Vec<(Measure, f64)>, b: Vec<(Measure, f64)>| -> Vec<(Measure, f64)> {
        if a.len() * b.len() == 1 || a.len() * b.len() > MOST_PARTS {
            return vec![(measure.clone(), sign)];
        }
        let signed = |(part, own): &(Measure, f64)| match *own == sign {
            true => Box::new(part.clone()),
            false => Box::new(Measure::Neg(Box::new(part.clone()))),
        };
        let pairs = a.iter().flat_map(|a| b.iter().map(move |b| (a, b)));
        pairs
            .map(|(a, b)| (Measure::Add(signed(a), signed(b)), sign))
            .collect()
    };
    match measure {
        Measure::Call(Builtin::Max, all) if sign > 0.0 => {
            all.iter().flat_map(|part| of(part, sign)).collect()
        }
        Measure::Call(Builtin::Min, all) if sign < 0.0 => {
            all.iter().flat_map(|part| of(part, sign)).collect()
        }
        Measure::Call(Builtin::Abs, all) if sign > 0.0 => {
            let signs = all.iter().flat_map(|part| [(part, 1.0), (part, -1.0)]);
            signs.flat_map(|(part, sign)| of(part, sign)).collect()
        }
        Measure::Neg(part) => of(part, -sign),
        Measure::Add(a, b) => sum(of(a, sign), of(b, sign)),
        Measure::Sub(a, b) => sum(of(a, sign), of(b, -sign)),
        Measure::Mul(a, b) => match (a.as_constant(), b.as_constant()) {
            (Some(k), _) => scaled(k, b, sign),
            (_, Some(k)) => scaled(k, a, sign),
            _ => vec![(measure.clone(), sign)],
        },
        Measure::Div(a, b) => match b.as_constant() {
            Some(k) => scaled(1.0 / k, a, sign),
            None => vec![(measure.clone(), sign)],
        },
        _ => vec![(measure.clone(), sign)],
    }
}

/// The parts of a number so many times as large.
fn scaled(factor: f64, measure: &Measure, sign: f64) -> Vec<(Measure, f64)> {
    let parts = parted(measure, sign * factor.signum()).into_iter();
    let size = Measure::Const(factor.abs());
    parts
        .map(|(part, sign)| {
            let both = Measure::Mul(Box::new(size.clone()), Box::new(part));
            (both, sign)
        })
        .collect()
}

/// What a number is made of at instants: its measure with what stands in its one `max` or `min`, or in its `range`.
fn inner(mechanism: &Mechanism, measure: &Measure, sign: f64) -> Option<(Measure, Kind)> {
    let out = written_out(&mechanism.model, measure, &mut { MOST_LEAVES })?;
    let mut over = out.leaves().filter(|leaf| matches!(leaf, Leaf::Over(..)));
    let first = over.next()?.clone();
    let Leaf::Over(statistic, within) = &first else {
        return None;
    };
    // Of different ones none stands for the whole; one within another has no place of its own.
    if over.any(|other| *other != first) || is_of_whole_motion(mechanism, within) {
        return None;
    }
    match statistic {
        Statistic::Max | Statistic::Min => {
            let measure = out.substitute(&mut |leaf| match leaf {
                Leaf::Over(..) => (**within).clone(),
                _ => Measure::Leaf(leaf.clone()),
            });
            Some((measure, Kind::Peak))
        }
        Statistic::Range => {
            // range, range - c, or c - range that is to be large.
            let less = match (&out, sign > 0.0) {
                (Measure::Leaf(_), true) => 0.0,
                (Measure::Sub(a, c), true) if matches!(**a, Measure::Leaf(_)) => c.as_constant()?,
                (Measure::Sub(c, a), false) if matches!(**a, Measure::Leaf(_)) => {
                    c.as_constant()?
                }
                _ => return None,
            };
            Some(((**within).clone(), Kind::Range(less)))
        }
        _ => None,
    }
}

/// Quantities of the design at hand with derivatives to the varied parameters by differences.
pub(super) type Differences<'d> = &'d dyn Fn(&[&Quantity]) -> Option<Vec<Difference>>;

/// The pieces of numbers at a design, with their derivatives to the varied parameters: of each the largest is its value, times its sign. What has no exact
/// derivative is asked of differences.
///
/// # Errors
///
/// Why the design has none.
pub(super) fn pieces(
    bench: &Bench<'_>,
    wanted: &[Wanted],
    values: &[f64],
    differences: Differences<'_>,
) -> Result<Vec<Vec<Piece>>, Refused> {
    let parts: Vec<&Part> = wanted.iter().flat_map(|w| &w.parts).collect();
    let mut found = pieces_of(bench, &parts, values, differences)?.into_iter();
    let own = |w: &Wanted| found.by_ref().take(w.parts.len()).flatten().collect();
    Ok(wanted.iter().map(own).collect())
}

/// The same of parts.
fn pieces_of(
    bench: &Bench<'_>,
    wanted: &[&Part],
    values: &[f64],
    differences: Differences<'_>,
) -> Result<Vec<Vec<Piece>>, Refused> {
    let motion = bench.motion(values, &mut bench.watch())?;
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
    mend(wanted, &mut all, differences);
    let inner = with_peaks(wanted);
    let values: Vec<f64> = all.iter().map(|own| own[0].value).collect();
    let peaks = peaks_of(bench, &motion, wanted, &values)?;
    if peaks.is_empty() {
        return Ok(all);
    }
    let held: Vec<Held> = peaks.iter().map(|peak| peak.held).collect();
    let measures: Vec<&Measure> = inner.iter().map(|(_, it)| &it.measure.measure).collect();
    let there = bench.sensitivities(&motion, &held, &measures)?;
    let with_slopes = peaks.iter().zip(&there).map(|(peak, found)| {
        let slope = found.derivatives[peak.which].iter();
        let piece = Piece {
            value: peak.sense * found.values[peak.which],
            slope: slope.map(|d| peak.sense * d).collect(),
        };
        (peak, piece)
    });
    add_peaks(wanted, &mut all, &with_slopes.collect::<Vec<_>>());
    Ok(all)
}

/// Puts differences where the numbers that parts are have no exact value or derivative.
fn mend(wanted: &[&Part], all: &mut [Vec<Piece>], differences: Differences<'_>) {
    let lacking = (0..all.len()).filter(|k| !is_sound(&all[*k][0]));
    let lacking: Vec<usize> = lacking.collect();
    if lacking.is_empty() {
        return;
    }
    let quantities: Vec<&Quantity> = lacking.iter().map(|k| &wanted[*k].number).collect();
    let told = differences(&quantities).unwrap_or_default();
    for (k, told) in lacking.into_iter().zip(told) {
        let (own, sign) = (&mut all[k], wanted[k].sign);
        own[0].value = sign * told.value;
        let both = own[0].slope.iter_mut().zip(&told.slope);
        both.filter(|(d, _)| !d.is_finite())
            .for_each(|(d, told)| *d = sign * told);
        // At a corner it is the largest of what goes on to either side.
        let corners = told.bends.iter().enumerate();
        for (variable, bend) in corners.filter(|(_, bend)| sign * **bend > 0.0) {
            for side in [-1.0, 1.0] {
                let mut piece = own[0].clone();
                piece.slope[variable] += side * bend.abs();
                own.push(piece);
            }
        }
    }
}

/// Whether value and slope are numbers.
fn is_sound(piece: &Piece) -> bool {
    piece.value.is_finite() && piece.slope.iter().all(|d| d.is_finite())
}

/// The parts of which more is known than their value: what stands in them, with the part's place.
fn with_peaks<'p>(wanted: &[&'p Part]) -> Vec<(usize, &'p Inner)> {
    let all = wanted.iter().enumerate();
    all.filter_map(|(k, w)| Some((k, w.inner.as_ref()?)))
        .collect()
}

/// The peaks of what stands in parts that have these values times their signs, each by its place among those of which more is known.
fn peaks_of(
    bench: &Bench<'_>,
    motion: &Arc<Motion>,
    wanted: &[&Part],
    values: &[f64],
) -> Result<Vec<Peak>, Refused> {
    let sought = with_peaks(wanted).into_iter().map(|(k, it)| Sought {
        measure: &it.measure,
        senses: match (it.kind, wanted[k].sign > 0.0) {
            (Kind::Range(_), _) => &[1.0, -1.0],
            (Kind::Peak, true) => &[1.0],
            (Kind::Peak, false) => &[-1.0],
        },
        // Where the number is not the greatest of what it is at instants, peaks say nothing of it.
        highest: matches!(it.kind, Kind::Peak).then_some(values[k]),
    });
    match sought.collect::<Vec<_>>() {
        none if none.is_empty() => Ok(Vec::new()),
        sought => peaks(bench, motion, &sought),
    }
}

/// Adds to the values of parts the pieces that their peaks are.
fn add_peaks(wanted: &[&Part], all: &mut [Vec<Piece>], peaks: &[(&Peak, Piece)]) {
    for (which, (k, it)) in with_peaks(wanted).into_iter().enumerate() {
        let of = |sense: f64| -> Vec<Piece> {
            let own = peaks.iter();
            let own = own.filter(|(peak, _)| peak.which == which && peak.sense == sense);
            once(own.map(|(_, piece)| piece))
        };
        let mut pieces = match it.kind {
            Kind::Peak => of(wanted[k].sign),
            Kind::Range(less) => {
                let (highs, lows) = (of(1.0), of(-1.0));
                let pair = |high: &Piece, low: &Piece| Piece {
                    value: high.value + low.value - less,
                    slope: high
                        .slope
                        .iter()
                        .zip(&low.slope)
                        .map(|(a, b)| a + b)
                        .collect(),
                };
                let pairs = highs
                    .iter()
                    .flat_map(|high| lows.iter().map(move |low| pair(high, low)));
                pairs.collect()
            }
        };
        let top = all[k][0].clone();
        pieces.retain(|piece| is_sound(piece) && !is_one(piece, &top));
        pieces.sort_by(|a, b| b.value.total_cmp(&a.value));
        pieces.truncate(MOST);
        for piece in pieces {
            let value = piece.value.min(top.value);
            all[k].push(Piece { value, ..piece });
        }
    }
}

/// Numbers of a design whose derivatives are differences.
pub(super) struct Seen {
    /// Values of all parts times their signs.
    values: Vec<f64>,
    peaks: Vec<Peak>,
}

/// The numbers of a design and their peaks, whose derivatives are differences.
///
/// # Errors
///
/// Why the design has none.
pub(super) fn seen(bench: &Bench<'_>, wanted: &[Wanted], values: &[f64]) -> Result<Seen, Refused> {
    let parts: Vec<&Part> = wanted.iter().flat_map(|w| &w.parts).collect();
    let motion = bench.motion(values, &mut bench.watch())?;
    let quantities: Vec<&Quantity> = parts.iter().map(|part| &part.number).collect();
    let mut along = bench.along(&motion, &quantities, &mut bench.watch())?;
    let found = along.row(RowPlace::Drive(motion.start)).sample.values;
    let signed = found.iter().zip(&parts).map(|(x, part)| part.sign * x);
    let values: Vec<f64> = signed.collect();
    Ok(Seen {
        peaks: peaks_of(bench, &motion, &parts, &values)?,
        values,
    })
}

/// The pieces of numbers by central differences: of each variable two designs below and above, how far apart they are, and both numbers;
/// none of one that does not move.
pub(super) fn by_differences(
    wanted: &[Wanted],
    own: &Seen,
    beside: &[Option<(f64, [Seen; 2])>],
) -> Vec<Vec<Piece>> {
    let parts: Vec<&Part> = wanted.iter().flat_map(|w| &w.parts).collect();
    let slope = |of: &dyn Fn(&Seen) -> Option<f64>| -> Option<Vec<f64>> {
        let one = |beside: &Option<(f64, [Seen; 2])>| match beside {
            None => Some(0.0),
            Some((apart, [below, above])) => Some((of(above)? - of(below)?) / apart),
        };
        beside.iter().map(one).collect()
    };
    let mut all: Vec<Vec<Piece>> = Vec::with_capacity(parts.len());
    for (k, value) in own.values.iter().enumerate() {
        let slope = slope(&|seen| seen.values.get(k).copied());
        all.push(vec![Piece {
            value: *value,
            slope: slope.unwrap_or_default(),
        }]);
    }
    // A peak is the one that is as good as at the same time beside.
    let same = |peak: &Peak, seen: &Seen| {
        let others = seen.peaks.iter();
        let others = others.filter(|it| it.which == peak.which && it.sense == peak.sense);
        let apart = |it: &Peak| (it.part - peak.part).abs();
        let nearest = others.min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
        (apart(nearest) <= MOVES).then_some(nearest.value)
    };
    let with_slopes = own.peaks.iter().filter_map(|peak| {
        let piece = Piece {
            value: peak.value,
            slope: slope(&|seen| same(peak, seen))?,
        };
        Some((peak, piece))
    });
    add_peaks(&parts, &mut all, &with_slopes.collect::<Vec<_>>());
    let mut found = all.into_iter();
    let own = |w: &Wanted| found.by_ref().take(w.parts.len()).flatten().collect();
    wanted.iter().map(own).collect()
}

/// Each of several peaks once, the highest first, where a motion goes through the same several times.
fn once<'p>(peaks: impl Iterator<Item = &'p Piece>) -> Vec<Piece> {
    let mut found: Vec<Piece> = Vec::new();
    for peak in peaks {
        if found.len() < MOST && !found.iter().any(|known| is_one(peak, known)) {
            found.push(peak.clone());
        }
    }
    found
}

/// Whether two peaks are one, as the highest itself is, which is known more exactly: it has its value and its slope. Another peak may come as near in value.
fn is_one(piece: &Piece, top: &Piece) -> bool {
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
