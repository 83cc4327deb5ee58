//! A number as a formula of what its motion has: statistics over it, each of which is the highest of its peaks.
//!
//! `range(v) / mean(v)` is what it is at the highest and the lowest `v`. Where another peak is nearly as high, the number is nearly what the formula is
//! with that one in its place: another piece, if a higher peak makes the number worse.

use kempe_mechanism::Mechanism;
use kempe_model::{Leaf, Measure, PoseMeasure, Statistic};
use kempe_number::Dual;
use kempe_optimize::Piece;
use kempe_units::Expr;

use super::parts::{MOST_LEAVES, written_out};
use crate::columns::is_of_whole_motion;
use crate::quantity::Quantity;

/// So many combinations of peaks are pieces at most.
const MOST: usize = 64;

/// A formula with statistics in it that have peaks.
pub(super) struct Formula {
    /// Its leaves by their places among these.
    out: Expr<usize>,
    pub terms: Vec<Term>,
}

/// What stands in a formula.
pub(super) struct Term {
    pub quantity: Quantity,
    /// Of which measure it is the highest, and in which sense: -1 where it is the least.
    pub peaks: Option<(Quantity, f64)>,
}

/// Whether a measure has peaks that are looked for: it is another one from instant to instant, also if numbers over the motion stand in it. The way so far is
/// longest at its end.
fn has_peaks(mechanism: &Mechanism, within: &Measure) -> bool {
    if !is_of_whole_motion(mechanism, within) {
        return true;
    }
    let Some(out) = written_out(&mechanism.model, within, &mut { MOST_LEAVES }) else {
        return false;
    };
    let (mut instant, mut way) = (false, false);
    out.map_leaves(&mut |leaf| {
        way |= matches!(leaf, Leaf::Pose(PoseMeasure::PathLength(_)));
        instant |= !matches!(leaf, Leaf::Over(..) | Leaf::Parameter(_));
    });
    instant && !way
}

impl Formula {
    /// That of a number; none where nothing in it has peaks.
    pub fn new(mechanism: &Mechanism, number: &Quantity) -> Option<Self> {
        let out = written_out(&mechanism.model, &number.measure, &mut { MOST_LEAVES })?;
        let out = out.substitute(&mut |leaf: &Leaf| match leaf {
            Leaf::Over(Statistic::Range, within) => {
                let of = |statistic| Box::new(Measure::Leaf(Leaf::Over(statistic, within.clone())));
                Measure::Sub(of(Statistic::Max), of(Statistic::Min))
            }
            _ => Measure::Leaf(leaf.clone()),
        });
        let mut leaves: Vec<Leaf> = Vec::new();
        let out = out.map_leaves(&mut |leaf| {
            let known = leaves.iter().position(|known| known == leaf);
            known.unwrap_or_else(|| {
                leaves.push(leaf.clone());
                leaves.len() - 1
            })
        });
        let named = |measure: Measure| Quantity {
            name: number.name.clone(),
            measure,
            dimension: number.dimension,
        };
        let term = |leaf: Leaf| Term {
            peaks: match &leaf {
                Leaf::Over(statistic @ (Statistic::Max | Statistic::Min), within)
                    if has_peaks(mechanism, within) =>
                {
                    let sense = if *statistic == Statistic::Max {
                        1.0
                    } else {
                        -1.0
                    };
                    Some((named((**within).clone()), sense))
                }
                _ => None,
            },
            quantity: named(Measure::Leaf(leaf)),
        };
        let terms: Vec<Term> = leaves.into_iter().map(term).collect();
        let any = terms.iter().any(|it| it.peaks.is_some());
        any.then_some(Self { out, terms })
    }

    fn value(&self, at: &[f64]) -> f64 {
        self.out.eval(&mut |k| at[*k])
    }

    /// The derivatives to its terms.
    fn slope(&self, at: &[f64]) -> Vec<f64> {
        let to = |which: usize| {
            let value: Dual<f64, 1> = self.out.eval(&mut |k| match *k == which {
                true => Dual::variable(at[*k], 0),
                false => Dual::constant(at[*k]),
            });
            value.eps[0]
        };
        (0..at.len()).map(to).collect()
    }

    /// What a number is, times its sign, with peaks of its terms in all combinations that make it no better. Of each term there is at least one, the highest
    /// first.
    pub fn pieces(&self, sign: f64, terms: &[Vec<Piece>]) -> Vec<Piece> {
        let highest: Vec<f64> = terms.iter().map(|own| own[0].value).collect();
        let slope = self.slope(&highest);
        let mut all: Vec<Vec<&Piece>> = vec![Vec::new()];
        for ((term, peaks), slope) in self.terms.iter().zip(terms).zip(slope) {
            let grows = (term.peaks.as_ref()).is_some_and(|(_, sense)| sign * sense * slope > 0.0);
            let most = if grows { MOST / all.len() } else { 1 };
            let peaks = &peaks[..most.clamp(1, peaks.len())];
            let firsts = all.iter();
            let pairs = firsts.flat_map(|first| peaks.iter().map(move |peak| (first, peak)));
            let with = pairs.map(|(first, peak)| first.iter().copied().chain([peak]).collect());
            all = with.collect();
        }
        let piece = |terms: Vec<&Piece>| self.piece(sign, &terms);
        all.into_iter().map(piece).collect()
    }

    fn piece(&self, sign: f64, terms: &[&Piece]) -> Piece {
        let at: Vec<f64> = terms.iter().map(|it| it.value).collect();
        let slopes = self.slope(&at);
        let mut slope = vec![0.0; terms.first().map_or(0, |it| it.slope.len())];
        for (term, by) in terms.iter().zip(slopes).filter(|(_, by)| *by != 0.0) {
            let both = slope.iter_mut().zip(&term.slope);
            both.for_each(|(d, own)| *d += sign * by * own);
        }
        Piece {
            value: sign * self.value(&at),
            slope,
        }
    }
}
