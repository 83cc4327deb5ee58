//! A number over the motion as the largest of its local peaks.
//!
//! The greatest value over a motion has a kink wherever another peak becomes the greatest, and an optimum often lies just there: of two
//! peaks neither can be lowered without the other rising. Who descends must know both. A number is a formula of such values (`formula.rs`): a piece of
//! it is what it comes to with another peak in the highest one's place. Between two values of the parameters all move
//! smoothly. The largest of several numbers, as a formula has it (`parts.rs`), has such kinks, too: all of them are pieces.

use kempe_measure::Held;
use kempe_mechanism::Mechanism;
use kempe_model::Measure;
use kempe_optimize::Piece;

use super::formula::{Formula, Term};
use super::parts::largest_of;
use super::peaks::{Peak, Sought, peaks};
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
    /// What it is made of, where that has peaks.
    formula: Option<Formula>,
}

impl Wanted {
    pub fn new(mechanism: &Mechanism, number: Quantity, sign: f64) -> Self {
        let parts = largest_of(&mechanism.model, &number.measure, sign).into_iter();
        let named = |measure: Measure| Quantity {
            name: number.name.clone(),
            measure,
            dimension: number.dimension,
        };
        let part = |(measure, sign): (Measure, f64)| {
            let number = named(measure);
            Part {
                formula: Formula::new(mechanism, &number),
                number,
                sign,
            }
        };
        Self {
            parts: parts.map(part).collect(),
            number,
            sign,
        }
    }
}

/// A number with its derivatives by differences.
pub(super) struct Difference {
    pub value: f64,
    pub slope: Vec<f64>,
    /// By how much the slope changes at a corner to either side; nothing where there is none, or the number has a ridge there.
    pub bends: Vec<f64>,
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
    let sought = sought(wanted);
    let peaks = peaks(bench, &motion, &sought)?;
    if peaks.is_empty() {
        return Ok(all);
    }
    let held: Vec<Held> = peaks.iter().map(|peak| peak.held).collect();
    let measures: Vec<&Measure> = sought.iter().map(|it| &it.measure.measure).collect();
    let there = bench.sensitivities(&motion, &held, &measures)?;
    let with_slopes = peaks.iter().zip(&there).map(|(peak, found)| {
        let piece = Piece {
            value: found.values[peak.which],
            slope: found.derivatives[peak.which].clone(),
        };
        (peak, piece)
    });
    let with_slopes: Vec<_> = with_slopes.collect();
    let lacking =
        terms(wanted).filter(|(_, _, term)| peaks_of(term, &sought, &with_slopes).is_empty());
    let lacking: Vec<(usize, usize, &Term)> = lacking.collect();
    let measures: Vec<&Measure> = (lacking.iter())
        .map(|(_, _, term)| &term.quantity.measure)
        .collect();
    let found = match measures.is_empty() {
        true => None,
        false => (bench.sensitivities(&motion, &[Held::Path(motion.start)], &measures)?).pop(),
    };
    let alone = |part: usize, term: usize| {
        let place = lacking.iter().position(|it| (it.0, it.1) == (part, term))?;
        let found = found.as_ref()?;
        Some(Piece {
            value: *found.values.get(place)?,
            slope: found.derivatives.get(place)?.clone(),
        })
    };
    add_peaks(wanted, &mut all, (&sought, &with_slopes), &alone);
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

/// What stands in the formulas of parts, with the places of part and term.
fn terms<'p>(parts: &[&'p Part]) -> impl Iterator<Item = (usize, usize, &'p Term)> {
    let all = parts.iter().enumerate();
    all.flat_map(|(k, part)| {
        let terms = part.formula.iter().flat_map(|it| &it.terms);
        terms.enumerate().map(move |(i, term)| (k, i, term))
    })
}

/// The measures whose peaks stand in the formulas of parts, each once.
fn sought<'p>(parts: &[&'p Part]) -> Vec<Sought<'p>> {
    let mut all: Vec<Sought<'p>> = Vec::new();
    for (measure, sense) in terms(parts).filter_map(|(_, _, term)| term.peaks.as_ref()) {
        let known = all
            .iter_mut()
            .find(|it| it.measure.measure == measure.measure);
        match known {
            Some(known) if !known.senses.contains(sense) => known.senses = &[1.0, -1.0],
            Some(_) => {}
            None => all.push(Sought {
                measure,
                senses: if *sense > 0.0 { &[1.0] } else { &[-1.0] },
            }),
        }
    }
    all
}

/// The peaks of a term, the highest first; none where it has none.
fn peaks_of(term: &Term, sought: &[Sought<'_>], peaks: &[(&Peak, Piece)]) -> Vec<Piece> {
    let Some((measure, sense)) = &term.peaks else {
        return Vec::new();
    };
    let which = (sought.iter()).position(|it| it.measure.measure == measure.measure);
    let own = (peaks.iter()).filter(|(peak, _)| Some(peak.which) == which && peak.sense == *sense);
    once(own.map(|(_, piece)| piece))
}

/// Adds to the values of parts the pieces that their peaks are. What has no peaks is asked of `alone`, by the places of part and term.
fn add_peaks(
    wanted: &[&Part],
    all: &mut [Vec<Piece>],
    (sought, peaks): (&[Sought<'_>], &[(&Peak, Piece)]),
    alone: &dyn Fn(usize, usize) -> Option<Piece>,
) {
    for (k, part) in wanted.iter().enumerate() {
        let Some(formula) = &part.formula else {
            continue;
        };
        let terms =
            formula
                .terms
                .iter()
                .enumerate()
                .map(|(i, term)| match peaks_of(term, sought, peaks) {
                    none if none.is_empty() => Some(vec![alone(k, i)?]),
                    peaks => Some(peaks),
                });
        let Some(terms) = terms.collect::<Option<Vec<_>>>() else {
            continue;
        };
        let top = all[k][0].clone();
        let mut pieces = formula.pieces(part.sign, &terms);
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
    /// Values of all parts times their signs, then of the terms of their formulas.
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
    let quantities = parts.iter().map(|part| &part.number);
    let quantities = quantities.chain(terms(&parts).map(|(_, _, term)| &term.quantity));
    let quantities: Vec<&Quantity> = quantities.collect();
    let mut along = bench.along(&motion, &quantities, &mut bench.watch())?;
    let mut values = along.row(RowPlace::Drive(motion.start)).sample.values;
    for (value, part) in values.iter_mut().zip(&parts) {
        *value *= part.sign;
    }
    Ok(Seen {
        peaks: peaks(bench, &motion, &sought(&parts))?,
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
    let piece = |(k, value): (usize, &f64)| Piece {
        value: *value,
        slope: slope(&|seen| seen.values.get(k).copied()).unwrap_or_default(),
    };
    let mut known: Vec<Piece> = own.values.iter().enumerate().map(piece).collect();
    let alone = known.split_off(parts.len());
    let mut all: Vec<Vec<Piece>> = known.into_iter().map(|piece| vec![piece]).collect();
    // A peak is the one that is as good as at the same time beside.
    let same = |peak: &Peak, seen: &Seen| {
        let others = seen.peaks.iter();
        let others = others.filter(|it| it.which == peak.which && it.sense == peak.sense);
        let apart = |it: &Peak| (it.part - peak.part).abs();
        let nearest = others.min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
        (apart(nearest) <= MOVES).then_some(nearest.value)
    };
    let with_slopes = own.peaks.iter().filter_map(|peak| {
        let mut slope = slope(&|seen| same(peak, seen))?;
        slope.iter_mut().for_each(|d| *d *= peak.sense);
        let value = peak.sense * peak.value;
        Some((peak, Piece { value, slope }))
    });
    let places: Vec<_> = terms(&parts).map(|(part, term, _)| (part, term)).collect();
    let alone = |part: usize, term: usize| {
        let place = places.iter().position(|it| *it == (part, term))?;
        alone.get(place).cloned()
    };
    let with_slopes: Vec<_> = with_slopes.collect();
    add_peaks(&parts, &mut all, (&sought(&parts), &with_slopes), &alone);
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
