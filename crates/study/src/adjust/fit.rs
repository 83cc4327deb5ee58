//! Values of unknown parameters with which what was measured is met, or missed least.

use std::cell::RefCell;

use kempe_linear::{Qr, Residuals, smallest_squares};
use kempe_model::value;
use kempe_motion::progress::{Done, Progress, Stage};
use kempe_number::{Random, math};
use kempe_units::Dimension;

use super::bench::{Assembled, Begin, Bench, Measured, Moved};

/// A minimum of the sum of squares of what is missed.
pub(super) struct Solution {
    /// The unknown parameters, SI.
    pub unknown: Vec<f64>,
    /// Whether the file means the mechanism put together so.
    pub meant: bool,
    pub assembled: Assembled,
    pub moved: Moved,
    pub measured: Measured,
    /// What is missed, in units of its scale, by values.
    pub misses: Vec<f64>,
}

impl Solution {
    /// The sum of squares of what is missed.
    pub fn square(&self) -> f64 {
        self.misses.iter().map(|x| x * x).sum()
    }

    /// Whether everything measured is met, but for rounding.
    pub fn is_exact(&self, bench: &Bench<'_>) -> bool {
        let values = self.misses.iter().zip(&bench.data.values);
        let mut missed = values.map(|(miss, datum)| (miss * datum.scale / datum.typical).abs());
        missed.all(|miss| miss <= MET)
    }
}

/// What is missed by no more than this, rad or in parts of the mechanism's size, is met.
const MET: f64 = 1e-9;
/// Starts of the search besides the file's values: so many for each unknown, and at most.
const STARTS: usize = 12;
const MOST_STARTS: usize = 60;
/// Without bounds lengths and other numbers are looked for within these factors of the file's.
const LENGTH_FACTOR: f64 = 4.0;
const FACTOR: f64 = 10.0;
/// So many ways to put the mechanism together are tried at a start.
const ASSEMBLIES: usize = 6;
/// Minima nearer to each other than this, in parts of their values, are one.
const SAME: f64 = 1e-6;
/// The starts are the same every time.
const SEED: u64 = 0x6164_6a75_7374;

/// All minima that are found, the best first, of those that meet everything the nearest to the file's values; `None` where the search was stopped before there was one.
pub(super) fn solutions(bench: &Bench<'_>, progress: &mut dyn Progress) -> Option<Vec<Solution>> {
    let mut found: Vec<Solution> = Vec::new();
    let starts = starts(bench);
    let all = starts.len();
    for (done, start) in starts.into_iter().enumerate() {
        let ways = bench.begins().iter().flat_map(|begin| {
            // The first of those at the start is the one that is meant.
            let known = usize::from(*begin == Begin::Start);
            let all = bench.assemblies(&start, *begin).into_iter().skip(known);
            all.take(ASSEMBLIES)
                .map(|assembly| Assembled::Like(*begin, Box::new(assembly)))
        });
        for assembled in [Assembled::AsMeant].into_iter().chain(ways) {
            let minimum = minimum(bench, &start, &assembled, &scales(bench));
            let Some(solution) = minimum else {
                continue;
            };
            let known = found.iter().position(|it| same(bench, it, &solution));
            match known {
                Some(k) => {
                    // Beside a change point the file's own motion leads to a minimum from one side only.
                    let meant = found[k].meant || solution.meant;
                    if solution.square() < found[k].square() {
                        found[k] = solution;
                    }
                    found[k].meant = meant;
                }
                None => found.push(solution),
            }
        }
        let part = Done::Of(done + 1, all);
        if progress.reached(Stage::Trying, part).is_break() {
            if found.is_empty() {
                return None;
            }
            break;
        }
    }
    // Of those that meet everything rounding would decide: they do equally well.
    let start = bench.start();
    let order = |it: &Solution| match it.is_exact(bench) {
        true => (0.0, change(bench, &start, &it.unknown)),
        false => (it.square(), 0.0),
    };
    found.sort_by(|a, b| {
        let [(a, from_a), (b, from_b)] = [order(a), order(b)];
        a.total_cmp(&b).then(from_a.total_cmp(&from_b))
    });
    Some(found)
}

/// How far values lie from those of the file, which are nearly what is meant: squares of changes, angles in rad, others in parts of their values.
fn change(bench: &Bench<'_>, start: &[f64], unknown: &[f64]) -> f64 {
    let changes = start.iter().zip(unknown).enumerate();
    let squares = changes.map(|(k, (own, value))| {
        let parameter = &bench.model.parameters[bench.study.unknown[k].index()];
        let size = match parameter.dimension == Dimension::ANGLE || *own == 0.0 {
            true => 1.0,
            false => *own,
        };
        let by = (value - own) / size;
        by * by
    });
    squares.sum()
}

/// What errors are measured by.
pub(super) fn scales(bench: &Bench<'_>) -> Vec<f64> {
    bench.data.values.iter().map(|datum| datum.scale).collect()
}

/// Whether two minima are one: the same values, and the links alike.
fn same(bench: &Bench<'_>, a: &Solution, b: &Solution) -> bool {
    let near = |(x, y): (&f64, &f64)| (x - y).abs() <= SAME * (x.abs() + y.abs());
    let signs = |it: &Solution| {
        let assembly = bench.assembly_of(&it.moved)?;
        Some(assembly.branch.signs.clone())
    };
    a.unknown.iter().zip(&b.unknown).all(near) && signs(a) == signs(b)
}

/// The file's values, and others around them or between their bounds.
fn starts(bench: &Bench<'_>) -> Vec<Vec<f64>> {
    let own = bench.start();
    let mut random = Random(SEED);
    let count = (STARTS * own.len()).min(MOST_STARTS);
    let ranges: Vec<[f64; 2]> = (0..own.len()).map(|k| bounds(bench, k)).collect();
    let size = bench.design(&own).size();
    let mut all = vec![own.clone()];
    for _ in 0..count {
        let start = own.iter().enumerate().map(|(k, own)| {
            let part = random.uniform();
            let dimension = bench.model.parameters[bench.study.unknown[k].index()].dimension;
            let by = |factor: f64| own * math::powf(factor, 2.0 * part - 1.0);
            let free = match dimension {
                Dimension::ANGLE => own + std::f64::consts::PI * (2.0 * part - 1.0),
                Dimension::LENGTH if *own == 0.0 => size * (2.0 * part - 1.0),
                Dimension::LENGTH => by(LENGTH_FACTOR),
                _ => by(FACTOR),
            };
            match ranges[k] {
                [low, high] if low.is_finite() && high.is_finite() => low + part * (high - low),
                [low, high] => free.max(low).min(high),
            }
        });
        all.push(start.collect());
    }
    all
}

/// The least and the largest value of an unknown, SI.
fn bounds(bench: &Bench<'_>, unknown: usize) -> [f64; 2] {
    let none = [f64::NEG_INFINITY, f64::INFINITY];
    let id = bench.study.unknown[unknown];
    let Some((_, ends)) = bench.study.bounds.iter().find(|(of, _)| *of == id) else {
        return none;
    };
    let parameters = bench.model.parameter_values::<f64>();
    let end = |k: usize| ends[k].as_ref().map_or(none[k], |e| value(e, &parameters));
    [end(0), end(1)]
}

/// The minimum to which a start leads, errors measured by `scales`.
pub(super) fn minimum(
    bench: &Bench<'_>,
    start: &[f64],
    assembled: &Assembled,
    scales: &[f64],
) -> Option<Solution> {
    let problem = Problem {
        bench,
        assembled,
        scales,
        last: RefCell::new(None),
    };
    let unknown = smallest_squares(&problem, start)?;
    let moved = bench.moved(&unknown, assembled).ok()?;
    let measured = bench.measured(&moved, &bench.study.unknown)?;
    let misses = bench.data.misses(&measured.values);
    Some(Solution {
        unknown,
        meant: assembled.is_meant(),
        assembled: assembled.clone(),
        moved,
        measured,
        misses,
    })
}

/// What is missed, as a function of the unknowns.
struct Problem<'b, 'm> {
    bench: &'b Bench<'m>,
    assembled: &'b Assembled,
    scales: &'b [f64],
    /// Where it was asked last: its derivatives are mostly wanted next.
    last: RefCell<Option<(Vec<f64>, Moved)>>,
}

impl Problem<'_, '_> {
    fn scaled(&self, misses: Vec<f64>) -> Vec<f64> {
        let all = misses.iter().zip(&self.bench.data.values).zip(self.scales);
        all.map(|((miss, datum), scale)| miss * (datum.scale / scale))
            .collect()
    }
}

impl Residuals for Problem<'_, '_> {
    fn residuals(&self, unknown: &[f64]) -> Option<Vec<f64>> {
        let moved = self.bench.moved(unknown, self.assembled).ok()?;
        let measured = self.bench.measured(&moved, &[])?;
        *self.last.borrow_mut() = Some((unknown.to_vec(), moved));
        Some(self.scaled(self.bench.data.misses(&measured.values)))
    }

    fn jacobian(&self, unknown: &[f64], _: &[f64], jacobian: &mut Qr) -> bool {
        let ids = &self.bench.study.unknown;
        let last = self.last.borrow();
        let measured = match last.as_ref().filter(|(at, _)| at == unknown) {
            Some((_, moved)) => self.bench.measured(moved, ids),
            None => {
                let moved = self.bench.moved(unknown, self.assembled).ok();
                moved.and_then(|moved| self.bench.measured(&moved, ids))
            }
        };
        let Some(measured) = measured else {
            return false;
        };
        for (row, (slopes, scale)) in measured.slopes.iter().zip(self.scales).enumerate() {
            for (column, slope) in slopes.iter().enumerate() {
                jacobian.add(row, column, slope / scale);
            }
        }
        true
    }

    fn bounds(&self, unknown: usize) -> [f64; 2] {
        bounds(self.bench, unknown)
    }
}
