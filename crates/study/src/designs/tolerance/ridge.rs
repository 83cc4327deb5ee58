//! Worst cases where derivatives alone do not lead on: between the ends of what differs, and on ridges, where a number is the largest of several that are
//! equally large.
//!
//! The least that the largest of several peaks comes to lies where lowering one raises another: one derivative leads to the ridge and no farther. As a
//! problem of optimisation all of them are known as pieces (`optimize/pieces.rs`). What differs is a box; the direction of a pin with play is an angle.

use kempe_number::math;
use kempe_optimize::{Alone, Evaluation, Piece, Problem, Slopes, SqpOptions, sqp};

use super::source::{Kind, Source};
use crate::designs::bench::Bench;
use crate::designs::optimize::{Designs, Wanted};

/// Steps and designs at most from one start.
const OPTIONS: (usize, usize) = (60, 400);
/// A formula of a play is told by differences over this part of a tolerance.
const DIFFERENCE: f64 = 1e-6;

/// What differs, as variables: parameters, and the angles to which pins with play stand off.
struct Differing<'s, 'm> {
    designs: Designs<'s, 'm>,
    sources: &'s [Source],
    own: &'s [f64],
    /// The side to which each source without a variable stands off.
    sides: Vec<f64>,
    bounds: Vec<[f64; 2]>,
}

/// The pieces of a bench's one number at a place, with their derivatives to all that differs: times `sign`, the number is the largest of them.
pub(super) fn pieces(
    bench: &Bench<'_>,
    (sources, own): (&[Source], &[f64]),
    sign: f64,
    at: &[f64],
) -> Vec<Piece> {
    let Some(number) = bench.numbers.first() else {
        return Vec::new();
    };
    let wanted = Wanted::new(bench.mechanism(), number.clone(), sign);
    let problem = Differing::new(bench, (sources, own), wanted, at);
    let found = problem.designs.slopes(at);
    found
        .and_then(|mut all| all.objectives.pop())
        .unwrap_or_default()
}

/// The best place near a start, by all pieces of a bench's one number; `sign` is 1 where it is to be large, -1 where it is to be small.
pub(super) fn best_near(
    bench: &Bench<'_>,
    (sources, own): (&[Source], &[f64]),
    sign: f64,
    start: &[f64],
) -> Option<Vec<f64>> {
    let wanted = Wanted::new(bench.mechanism(), bench.numbers.first()?.clone(), -sign);
    let problem = Differing::new(bench, (sources, own), wanted, start);
    let options = SqpOptions {
        iterations: OPTIONS.0,
        evaluations: OPTIONS.1,
        ..SqpOptions::default()
    };
    let from = problem.variables(start);
    let found = sqp(
        &problem,
        &from,
        &options,
        &Alone,
        &mut |_| match bench.watch().stops() {
            true => std::ops::ControlFlow::Break(()),
            false => std::ops::ControlFlow::Continue(()),
        },
    );
    (found.evaluation.is_defined()).then(|| problem.values(&found.design))
}

/// Whether a bench's one number, as large, or for `sign` -1 as small as it was found, has no bound there; `usual` is its value elsewhere.
pub(super) fn is_pole(
    bench: &Bench<'_>,
    about: (&[Source], &[f64]),
    sign: f64,
    ((value, at), usual): (&(f64, Vec<f64>), f64),
) -> bool {
    let Some(number) = bench.numbers.first() else {
        return false;
    };
    let wanted = Wanted::new(bench.mechanism(), number.clone(), -sign);
    let problem = Differing::new(bench, about, wanted, at).designs;
    problem.take_up(&[usual]);
    let towards = |at_edge| problem.is_pole(at, (0, -sign * value), (false, at_edge));
    towards(false) || towards(true)
}

impl<'s, 'm> Differing<'s, 'm> {
    fn new(
        bench: &'s Bench<'m>,
        (sources, own): (&'s [Source], &'s [f64]),
        wanted: Wanted,
        start: &[f64],
    ) -> Self {
        let mut ranges: Vec<[f64; 2]> = own.iter().map(|x| [*x, *x]).collect();
        let (mut bounds, mut sides) = (Vec::new(), Vec::new());
        for source in sources {
            let k = source.first;
            let mut side = 0.0;
            match &source.kind {
                Kind::Parameter(_) => {
                    ranges[k] = source.between(own).unwrap_or(ranges[k]);
                    bounds.push(ranges[k]);
                }
                Kind::Round(play) => {
                    for k in [k, k + 1] {
                        ranges[k] = [own[k] - play.own, own[k] + play.own];
                    }
                    let way = direction(own, start, k);
                    bounds.push([way - std::f64::consts::PI, way + std::f64::consts::PI]);
                }
                Kind::Across(play) => {
                    ranges[k] = [own[k] - play.own, own[k] + play.own];
                    side = sign_of(start[k] - own[k]);
                }
            }
            sides.push(side);
        }
        Self {
            designs: Designs::within(bench, vec![wanted], 1, ranges),
            sources,
            own,
            sides,
            bounds,
        }
    }

    /// The variables of values of all that differs.
    fn variables(&self, values: &[f64]) -> Vec<f64> {
        let of = |source: &Source| match source.kind {
            Kind::Parameter(_) => Some(values[source.first]),
            Kind::Round(_) => Some(direction(self.own, values, source.first)),
            Kind::Across(_) => None,
        };
        self.sources.iter().filter_map(of).collect()
    }

    /// Values of all that differs; joints stand off by all of their play.
    fn values(&self, variables: &[f64]) -> Vec<f64> {
        let mut values = self.own.to_vec();
        let with_variable = |source: &&Source| !matches!(source.kind, Kind::Across(_));
        let both = self.sources.iter().filter(with_variable).zip(variables);
        let angles: Vec<f64> = both
            .filter_map(|(source, x)| match source.kind {
                Kind::Parameter(_) => {
                    values[source.first] = *x;
                    None
                }
                _ => Some(*x),
            })
            .collect();
        let parameters = self.designs.bench.parameters(&values);
        let mut angles = angles.into_iter();
        for (source, side) in self.sources.iter().zip(&self.sides) {
            let k = source.first;
            match &source.kind {
                Kind::Parameter(_) => {}
                Kind::Round(play) => {
                    let (sin, cos) = math::sin_cos(angles.next().unwrap_or_default());
                    let play = play.at(&parameters);
                    values[k] = self.own[k] + play * cos;
                    values[k + 1] = self.own[k + 1] + play * sin;
                }
                Kind::Across(play) => values[k] = self.own[k] + side * play.at(&parameters),
            }
        }
        values
    }

    /// How all that differs changes with each variable.
    fn rates(&self, variables: &[f64]) -> Vec<Vec<f64>> {
        let plays = self.sources.iter().any(|source| source.play().is_some());
        let rate = |(k, [low, high]): (usize, &[f64; 2])| {
            let step = DIFFERENCE * (high - low);
            if step == 0.0 {
                return vec![0.0; self.own.len()];
            }
            let beside = |side: f64| {
                let mut there = variables.to_vec();
                there[k] += side * step;
                self.values(&there)
            };
            let both = beside(1.0).into_iter().zip(beside(-1.0));
            both.map(|(above, below)| (above - below) / (2.0 * step))
                .collect()
        };
        match plays {
            true => self.bounds.iter().enumerate().map(rate).collect(),
            false => {
                let one = |k: usize| (0..self.own.len()).map(|i| f64::from(i == k)).collect();
                self.sources
                    .iter()
                    .map(|source| one(source.first))
                    .collect()
            }
        }
    }
}

impl Problem for Differing<'_, '_> {
    fn bounds(&self) -> &[[f64; 2]] {
        &self.bounds
    }

    fn least(&self) -> f64 {
        self.designs.least()
    }

    fn evaluate(&self, variables: &[f64]) -> Evaluation {
        self.designs.evaluate(&self.values(variables))
    }

    fn slopes(&self, variables: &[f64]) -> Option<Slopes> {
        let mut found = self.designs.slopes(&self.values(variables))?;
        let rates = self.rates(variables);
        for piece in found.objectives.iter_mut().flatten() {
            *piece = through(piece, &rates);
        }
        Some(found)
    }
}

/// A piece by variables whose values change at these rates.
fn through(piece: &Piece, rates: &[Vec<f64>]) -> Piece {
    let along = |rate: &Vec<f64>| {
        let both = rate.iter().zip(&piece.slope);
        let moved = both.filter(|(rate, _)| **rate != 0.0);
        moved.map(|(rate, slope)| rate * slope).sum()
    };
    Piece {
        value: piece.value,
        slope: rates.iter().map(along).collect(),
    }
}

/// The direction in which a pin stands off, rad.
fn direction(own: &[f64], values: &[f64], k: usize) -> f64 {
    math::atan2(values[k + 1] - own[k + 1], values[k] - own[k])
}

fn sign_of(x: f64) -> f64 {
    if x < 0.0 { -1.0 } else { 1.0 }
}
