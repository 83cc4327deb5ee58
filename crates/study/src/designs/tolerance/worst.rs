//! The worst case: the least and the greatest that a number comes to where everything may differ as far as its tolerance goes.
//!
//! By conditional gradients (M. Frank and P. Wolfe, Naval Res. Logist. Quart. 3 (1956) 95-110): from a design towards the corner of all tolerances that
//! its derivatives point to, until none is better. Corners are where nearly all worst cases lie; those that do not are met on the way. What has no
//! derivative there, or one that points nowhere, is moved by itself to where the file has it and as far as it may go.

use std::collections::HashMap;

use super::source::{Kind, Source};
use crate::designs::bench::{Bench, Sloped};

/// So many steps from one start; most take two.
const STEPS: usize = 12;
/// Parts of the way to a corner that are tried, one after the other.
const PARTS: [f64; 4] = [1.0, 0.5, 0.2, 0.05];
/// What is better by less than this part is not.
const BETTER: f64 = 1e-12;
/// A derivative that changes a number by less than this part of what the largest does, over what may differ, points nowhere.
const POINTS: f64 = 1e-6;

/// The worst case of a number: its least and its greatest value, SI, and the values of what differs there.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Worst {
    pub values: [f64; 2],
    pub at: [Vec<f64>; 2],
}

/// The worst cases of numbers.
pub(super) struct Worsts {
    /// By number.
    pub numbers: Vec<Option<Worst>>,
    /// Why a design within the tolerances that was tried does not move.
    pub refused: Option<String>,
}

/// What a design answers; of a simulation without derivatives.
type Answer = Result<Vec<Sloped>, String>;

pub(super) struct Search<'s, 'm> {
    bench: &'s Bench<'m>,
    sources: &'s [Source],
    own: &'s [f64],
    /// The derivatives of the file's own design, by number.
    slopes: Vec<&'s [f64]>,
    known: HashMap<Vec<u64>, Answer>,
    refused: Option<String>,
}

impl<'s, 'm> Search<'s, 'm> {
    pub fn new(
        bench: &'s Bench<'m>,
        sources: &'s [Source],
        own: &'s [f64],
        slopes: Vec<&'s [f64]>,
    ) -> Self {
        Self {
            bench,
            sources,
            own,
            slopes,
            known: HashMap::new(),
            refused: None,
        }
    }

    /// The worst cases of as many numbers as there are pieces of each: those with its least and with its greatest value. `goes_on` is asked
    /// before each number.
    pub fn all(
        mut self,
        pieces: &[[Vec<f64>; 2]],
        mut goes_on: impl FnMut(usize) -> bool,
    ) -> Worsts {
        let mut numbers = Vec::new();
        for (number, pieces) in pieces.iter().enumerate() {
            if !goes_on(number) {
                break;
            }
            let worst = self.worst(number, pieces);
            // What was stopped on its way is no worst case.
            if self.bench.watch().stops() {
                break;
            }
            numbers.push(worst);
        }
        numbers.resize(pieces.len(), None);
        Worsts {
            numbers,
            refused: self.refused,
        }
    }

    fn worst(&mut self, number: usize, pieces: &[Vec<f64>; 2]) -> Option<Worst> {
        let mut found = [-1.0, 1.0].into_iter().zip(pieces).map(|(sign, piece)| {
            // The file's own design may lie outside of what its tolerances let be.
            let starts = [self.within(self.own), self.within(piece)];
            let ends = starts.map(|start| self.walk(number, sign, start));
            let best = ends.into_iter().flatten();
            best.max_by(|a, b| (sign * a.0).total_cmp(&(sign * b.0)))
        });
        let (low, high) = (found.next()??, found.next()??);
        Some(Worst {
            values: [low.0, high.0],
            at: [low.1, high.1],
        })
    }

    /// A piece as far as tolerances go: what is normal may differ by more.
    fn within(&self, piece: &[f64]) -> Vec<f64> {
        let mut values = piece.to_vec();
        for source in self.sources {
            if let Kind::Parameter(deviation) = &source.kind {
                let [low, high] = deviation.ends.map(|end| self.own[source.first] + end);
                values[source.first] = values[source.first].clamp(low, high);
            }
        }
        values
    }

    /// The value at the end of a way up, or down where `sign` is negative, and where that is.
    fn walk(&mut self, number: usize, sign: f64, start: Vec<f64>) -> Option<(f64, Vec<f64>)> {
        let mut best = self.descend(number, sign, start)?;
        for _ in 0..STEPS {
            let Some(values) = self.beside(number, sign, &best) else {
                break;
            };
            best = self.descend(number, sign, values)?;
        }
        Some(best)
    }

    /// A design that is better, where one of those differs that derivatives say nothing of.
    fn beside(&mut self, number: usize, sign: f64, best: &(f64, Vec<f64>)) -> Option<Vec<f64>> {
        if !self.bench.has_slopes() {
            return None;
        }
        let slope = self.slope(number, &best.1)?;
        for source in self.sources {
            let (k, Kind::Parameter(deviation)) = (source.first, &source.kind) else {
                continue;
            };
            // Exactly 0 it is where nothing goes by it.
            if !slope[k].is_nan() {
                continue;
            }
            let ends = deviation.ends.map(|end| self.own[k] + end);
            let own = self.own[k].clamp(ends[0], ends[1]);
            for to in [own, ends[0], ends[1]] {
                let mut values = best.1.clone();
                values[k] = to;
                let value = self.value(number, &values);
                if value.is_some_and(|x| sign * (x - best.0) > BETTER * best.0.abs()) {
                    return Some(values);
                }
            }
        }
        None
    }

    /// The same by derivatives alone.
    fn descend(&mut self, number: usize, sign: f64, start: Vec<f64>) -> Option<(f64, Vec<f64>)> {
        let mut at = start;
        let mut best = self.value(number, &at)?;
        // Of simulations, which take long, corners alone.
        let parts = match self.bench.has_slopes() {
            true => &PARTS[..],
            false => &PARTS[..1],
        };
        for _ in 0..STEPS {
            let slope = self.slope(number, &at)?;
            let slope: Vec<f64> = (slope.iter())
                .map(|x| if x.is_finite() { *x } else { 0.0 })
                .collect();
            let corner = self.corner(&slope, sign, &at);
            let towards = |part: &f64| -> Vec<f64> {
                let both = at.iter().zip(&corner);
                // At the corner itself to the last digit.
                both.map(|(a, c)| if *part == 1.0 { *c } else { a + part * (c - a) })
                    .collect()
            };
            let tried: Vec<Vec<f64>> = parts.iter().map(towards).collect();
            let tried = tried.into_iter().find_map(|values| {
                let value = self.value(number, &values)?;
                let better = sign * (value - best) > BETTER * best.abs();
                better.then_some((value, values))
            });
            match tried {
                Some(better) => (best, at) = better,
                None => break,
            }
        }
        Some((best, at))
    }

    /// Where everything differs as far as it may, as derivatives at a place say; what they do not change stays.
    fn corner(&self, slope: &[f64], sign: f64, from: &[f64]) -> Vec<f64> {
        let mut values = from.to_vec();
        let play = |values: &[f64]| {
            let plays = self.sources.iter().filter_map(|it| Some((it, it.play()?)));
            let parameters = plays.clone().next().map(|_| self.bench.parameters(values));
            let parameters = parameters.unwrap_or_default();
            let sizes = plays.map(|(it, play)| it.slope(slope).abs() * play.at(&parameters));
            sizes.sum::<f64>()
        };
        for source in self.sources {
            let Kind::Parameter(deviation) = &source.kind else {
                continue;
            };
            let k = source.first;
            let [low, high] = deviation.ends.map(|end| {
                let mut there = from.to_vec();
                there[k] = self.own[k] + end;
                (sign * slope[k] * there[k] + play(&there), there[k])
            });
            if low.0 != high.0 {
                values[k] = if low.0 > high.0 { low.1 } else { high.1 };
            }
        }
        let parameters = self.bench.parameters(&values);
        for source in self.sources {
            let Some(play) = source.play().map(|it| it.at(&parameters)) else {
                continue;
            };
            let size = source.slope(slope);
            let width = if matches!(source.kind, Kind::Round(_)) {
                2
            } else {
                1
            };
            for k in source.first..source.first + width {
                if size != 0.0 {
                    values[k] = self.own[k] + sign * play * slope[k] / size.abs();
                }
            }
        }
        values
    }

    fn value(&mut self, number: usize, values: &[f64]) -> Option<f64> {
        let value = self.answer(values)?.get(number)?.value;
        value.is_finite().then_some(value)
    }

    /// The derivatives of a number at a design; not a number where there is none, or where it points nowhere.
    fn slope(&mut self, number: usize, values: &[f64]) -> Option<Vec<f64>> {
        let slope = self.answer(values)?.get(number)?.slope.clone();
        let mut slope = match slope.is_empty() {
            true => self.slopes.get(number)?.to_vec(),
            false => slope,
        };
        let parameter = |source: &Source| match &source.kind {
            Kind::Parameter(deviation) => {
                Some((source.first, deviation.ends[1] - deviation.ends[0]))
            }
            _ => None,
        };
        let parameters: Vec<(usize, f64)> = self.sources.iter().filter_map(parameter).collect();
        let changes = parameters
            .iter()
            .map(|(k, width)| (slope[*k] * width).abs());
        let most = changes.filter(|x| x.is_finite()).fold(0.0, f64::max);
        for (k, width) in parameters {
            let change = (slope[k] * width).abs();
            if !change.is_finite() || change != 0.0 && change <= POINTS * most {
                slope[k] = f64::NAN;
            }
        }
        Some(slope)
    }

    fn answer(&mut self, values: &[f64]) -> Option<&[Sloped]> {
        let key: Vec<u64> = values.iter().map(|x| x.to_bits()).collect();
        let (bench, refused) = (self.bench, &mut self.refused);
        let known = self.known.entry(key).or_insert_with(|| {
            let found = if bench.has_slopes() {
                bench.slopes(values)
            } else {
                let numbers = bench.numbers(values);
                numbers.map(|all| {
                    let all = all.into_iter();
                    all.map(|value| Sloped {
                        value,
                        slope: Vec::new(),
                    })
                    .collect()
                })
            };
            found.map_err(|it| {
                // What was stopped tells nothing.
                if it.lack.is_finite() {
                    refused.get_or_insert_with(|| it.why.clone());
                }
                it.why
            })
        });
        known.as_ref().ok().map(|all| &**all)
    }
}
