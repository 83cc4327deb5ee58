//! Linkages near to more pairs than they can keep that the first link drives through all of them.
//!
//! The least sum of squares often lies where the linkage comes to a dead centre on the way: it is then of no use, and the best of use lies at the
//! edge of what can be driven, where no sum of squares is least. So it is looked for besides among linkages whose transmission angle keeps from 0
//! and 180 degrees, by several angles: what is beyond counts heavily, and outputs of places that are not reached are those of the nearest.

use std::f64::consts::TAU;

use kempe_linear::{Qr, Residuals, smallest_squares};
use kempe_number::{Random, math};

/// From 0 and 180 degrees the transmission angle keeps by one of these, deg.
const APART_FROM_DEAD: [f64; 5] = [2.0, 10.0, 20.0, 30.0, 40.0];

/// What is beyond counts so many times as much as an error of one radian, or of the size of the places: more from turn to turn, as the way along
/// a steep edge is long.
const HEAVILY: [f64; 3] = [10.0, 100.0, 1000.0];
/// So far beyond, in parts of the cosine, is none.
const BEYOND: f64 = 1e-4;
/// Starts of few pairs that are gone on from, and the least number of many; how many of the best are kept for each angle.
const STARTS: usize = 24;
const FEWEST: usize = 6;
const KEPT: usize = 2;
/// Links that are drawn by lot as starts besides: of pairs with errors few sets of five may have a linkage.
pub(super) const BY_LOT: usize = 60;
/// Differences, in parts of the frame or of the size of the places.
const STEP: f64 = 1e-6;

/// Unknowns nearer than this, in parts of their size, are those of one linkage.
const SAME: f64 = 1e-4;
/// Links so many times as long as the frame, or as short, are none that anybody would build.
pub(super) const LONG: f64 = 30.0;

/// How many cosines tell how near a linkage comes to a dead centre.
pub(super) const COSINES: usize = 4;

/// Linkages of one branch and how far their output is off.
pub(super) trait Generates: Residuals {
    /// In which errors and lengths are counted.
    fn size(&self) -> f64;

    /// Errors of the output; of places that are not reached, those of the nearest.
    fn nearest_errors(&self, unknowns: &[f64]) -> Vec<f64>;

    /// Cosines of the transmission angle at both ends of the way, and where it is least and largest on it: beyond 1 it does not close.
    fn cosines(&self, unknowns: &[f64]) -> [f64; COSINES];

    /// Whether a linkage is one that can be built.
    fn is_sound(&self, unknowns: &[f64]) -> bool;
}

/// Linkages whose transmission angle keeps from 0 and 180 degrees.
struct Kept<'g, G> {
    of: &'g G,
    /// The largest cosine.
    most: f64,
    heavily: f64,
}

impl<G: Generates> Kept<'_, G> {
    fn beyond(&self, unknowns: &[f64]) -> [f64; COSINES] {
        let cosines = self.of.cosines(unknowns);
        cosines.map(|cosine| (cosine.abs() - self.most).max(0.0))
    }

    fn step(&self) -> f64 {
        STEP * self.of.size()
    }
}

impl<G: Generates> Residuals for Kept<'_, G> {
    fn residuals(&self, unknowns: &[f64]) -> Option<Vec<f64>> {
        let mut all = self.of.nearest_errors(unknowns);
        let heavily = self.heavily * self.of.size();
        all.extend(self.beyond(unknowns).map(|beyond| heavily * beyond));
        all.iter().all(|x| x.is_finite()).then_some(all)
    }

    /// That of the errors where the linkage closes, and differences elsewhere.
    fn jacobian(&self, unknowns: &[f64], residuals: &[f64], jacobian: &mut Qr) -> bool {
        let (step, errors) = (self.step(), residuals.len() - COSINES);
        let closes = self.of.residuals(unknowns).is_some();
        let exact = closes && self.of.jacobian(unknowns, &residuals[..errors], jacobian);
        if closes && !exact {
            return false;
        }
        let mut at = unknowns.to_vec();
        for column in 0..unknowns.len() {
            let mut side = |by: f64| {
                at[column] = unknowns[column] + by;
                let rows = match exact {
                    true => Vec::new(),
                    false => self.of.nearest_errors(&at),
                };
                let beyond = self.beyond(&at);
                at[column] = unknowns[column];
                (rows, beyond)
            };
            let ((low, least), (high, most)) = (side(-step), side(step));
            for (row, (low, high)) in low.iter().zip(&high).enumerate() {
                jacobian.add(row, column, (high - low) / (2.0 * step));
            }
            for (row, (low, high)) in least.iter().zip(&most).enumerate() {
                let slope = self.heavily * self.of.size() * (high - low) / (2.0 * step);
                jacobian.add(errors + row, column, slope);
            }
        }
        true
    }
}

/// Three lengths from a third to three times a size, and two angles, by lot.
pub(super) fn by_lot(random: &mut Random, size: f64) -> ([f64; 3], [f64; 2]) {
    let mut length = || size * math::powf(3.0, 2.0 * random.uniform() - 1.0);
    let lengths = [length(), length(), length()];
    let mut angle = || TAU * random.uniform();
    (lengths, [angle(), angle()])
}

/// Whether unknowns are those of one linkage.
fn is_same(a: &[f64], b: &[f64], size: f64) -> bool {
    let near = |(a, b): (&f64, &f64)| (a - b).abs() <= SAME * (size + a.abs());
    a.iter().zip(b).all(near)
}

/// The input nearest to an angle, rad, give or take whole turns, on a way.
pub(super) fn nearest_on_way([from, to]: [f64; 2], angle: f64) -> f64 {
    let middle = 0.5 * (from + to);
    let near = middle + math::within_half_a_turn(angle - middle);
    near.max(from.min(to)).min(from.max(to))
}

/// The largest cosine of the transmission angle on the way, of either sign.
fn largest_cosine(of: &impl Generates, unknowns: &[f64]) -> f64 {
    let cosines = of.cosines(unknowns).map(f64::abs);
    cosines.iter().fold(0.0, |m: f64, c| m.max(*c))
}

/// The best linkages whose transmission angle keeps off 0 and 180 degrees, by each of [`APART_FROM_DEAD`] that the best one known does not keep by
/// itself: unknowns with the number of their problem, of those of both branches. `known` are the minima without that condition, the best first.
pub(super) fn driven<G: Generates>(
    problems: &[G; 2],
    known: &[(usize, Vec<f64>)],
    mut starts: Vec<(usize, Vec<f64>)>,
) -> Vec<(usize, Vec<f64>)> {
    let mut sound = (known.iter()).filter(|(problem, at)| problems[*problem].is_sound(at));
    let kept = sound
        .next()
        .map_or(1.0, |(problem, at)| largest_cosine(&problems[*problem], at));
    starts.extend_from_slice(known);
    let mut all: Vec<(usize, Vec<f64>)> = Vec::new();
    for apart in APART_FROM_DEAD {
        if kept <= math::cos(apart.to_radians()) {
            continue;
        }
        let best = best_kept(problems, &starts, apart);
        starts.extend_from_slice(&best);
        for (problem, at) in best {
            let mut others = known.iter().chain(&all);
            let size = problems[problem].size();
            if !others.any(|(p, other)| *p == problem && is_same(other, &at, size)) {
                all.push((problem, at));
            }
        }
    }
    all
}

/// Unknowns of the best linkages whose transmission angle keeps this far, deg, from 0 and 180.
fn best_kept<G: Generates>(
    problems: &[G; 2],
    starts: &[(usize, Vec<f64>)],
    apart: f64,
) -> Vec<(usize, Vec<f64>)> {
    let sum = |all: &[f64]| all.iter().map(|x| x * x).sum::<f64>();
    let most = math::cos(apart.to_radians());
    let kept = |problem: usize, heavily: f64| Kept {
        of: &problems[problem],
        most,
        heavily,
    };
    let mut ordered: Vec<(f64, &(usize, Vec<f64>))> = (starts.iter())
        .filter_map(|start| Some((sum(&kept(start.0, HEAVILY[0]).residuals(&start.1)?), start)))
        .collect();
    ordered.sort_by(|a, b| a.0.total_cmp(&b.0));
    let places = ordered.first().map_or(1, |(_, (problem, at))| {
        problems[*problem].nearest_errors(at).len()
    });
    ordered.truncate((STARTS * STARTS / places).clamp(FEWEST, STARTS));
    let mut found: Vec<(f64, usize, Vec<f64>)> = Vec::new();
    for (_, (problem, start)) in ordered {
        let least = HEAVILY.iter().try_fold(start.clone(), |at, heavily| {
            smallest_squares(&kept(*problem, *heavily), &at)
        });
        let Some(at) = least else {
            continue;
        };
        let of = &problems[*problem];
        let beyond = largest_cosine(of, &at) - most;
        if let Some(errors) = of.residuals(&at)
            && beyond <= BEYOND
            && of.is_sound(&at)
        {
            found.push((sum(&errors), *problem, at));
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut best: Vec<(usize, Vec<f64>)> = Vec::new();
    for (_, problem, at) in found {
        if best.len() < KEPT
            && !best
                .iter()
                .any(|(p, b)| *p == problem && is_same(b, &at, problems[problem].size()))
        {
            best.push((problem, at));
        }
    }
    best
}
