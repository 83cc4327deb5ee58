//! Linkages near to more pairs than they can keep that the first link drives through all of them.
//!
//! The least sum of squares often lies where the linkage comes to a dead centre on the way: it is then of no use, and the best of use lies at the
//! edge of what can be driven, where no sum of squares is least. So it is looked for besides among linkages whose transmission angle keeps from 0
//! and 180 degrees, by several angles: what is beyond counts heavily, and outputs of places that are not reached are those of the nearest.

use std::f64::consts::TAU;

use kempe_linear::{Qr, Residuals, smallest_squares};
use kempe_number::{Random, math};

use crate::error::SynthesisError;
use crate::guidance_fit::subsets;

/// From 0 and 180 degrees the transmission angle keeps by one of these, deg.
const APART_FROM_DEAD: [f64; 5] = [2.0, 10.0, 20.0, 30.0, 40.0];

/// What is beyond counts so many times as much as an error of one radian, or of the size of the places: more from turn to turn, as the way along
/// a steep edge is long.
const HEAVILY: [f64; 3] = [10.0, 100.0, 1000.0];
/// So far inside, in parts of the cosine, is aimed at, for what is found to keep the angle itself; turns with the heaviest weight until it does.
const INSIDE: f64 = 1e-8;
const TURNS: usize = 12;
/// Starts of few pairs that are gone on from, and the least number of many; how many of the best are kept for each angle.
const STARTS: usize = 24;
const FEWEST: usize = 6;
const KEPT: usize = 2;
/// Sets of pairs from which starts are taken.
const SETS: usize = 60;
/// Links that are drawn by lot as starts besides: of pairs with errors few sets of five may have a linkage.
const BY_LOT: usize = 60;
/// Differences, in parts of the frame or of the size of the places.
const STEP: f64 = 1e-6;

/// Unknowns nearer than this, in parts of their size, are those of one linkage.
const SAME: f64 = 1e-4;
/// Links so many times as long as the frame, or as short, are none that anybody would build.
pub(super) const LONG: f64 = 30.0;

/// How many cosines tell how near a linkage comes to a dead centre.
pub(super) const COSINES: usize = 4;

/// Linkages of one branch, of a kind that pairs ask for, and how far their output is off.
pub(super) trait Generates: Residuals {
    /// A linkage.
    type Linkage;
    /// One of them, on its branch, with how far it is off.
    type Fit;

    /// How many pairs there are, and how many a linkage keeps.
    fn pairs(&self) -> [usize; 2];

    /// In which errors and lengths are counted.
    fn size(&self) -> f64;

    fn unknowns(&self, linkage: &Self::Linkage) -> Vec<f64>;

    /// The branch of a fit, 1 or -1, its unknowns, and the root of the mean square of its errors.
    fn of_fit(&self, fit: &Self::Fit) -> (i8, Vec<f64>, f64);

    /// What these unknowns are on this branch, where all places are reached.
    fn fit(&self, unknowns: &[f64]) -> Option<Self::Fit>;

    /// Linkages that keep some of the pairs, by their places, on either branch.
    fn exact(&self, chosen: &[usize]) -> Vec<Self::Linkage>;

    /// A linkage of lengths and angles drawn by lot.
    fn by_lot(&self, lots: &mut Lots) -> Self::Linkage;

    /// Errors of the output; of places that are not reached, those of the nearest.
    fn nearest_errors(&self, unknowns: &[f64]) -> Vec<f64>;

    /// Cosines of the transmission angle at both ends of a way of the input, and where it is least and largest on it: beyond 1 it does not close.
    fn cosines(&self, unknowns: &[f64], way: Way) -> [f64; COSINES];

    /// Whether a linkage is one that can be built.
    fn is_sound(&self, unknowns: &[f64]) -> bool;
}

/// From where to where the input goes, rad.
#[derive(Clone, Copy)]
pub(super) struct Way(pub [f64; 2]);

impl Way {
    /// The input on the way that is nearest to an angle, give or take whole turns.
    pub(super) fn nearest(self, angle: f64) -> f64 {
        let [from, to] = self.0;
        let middle = 0.5 * (from + to);
        let near = middle + math::within_half_a_turn(angle - middle);
        near.max(from.min(to)).min(from.max(to))
    }
}

/// Numbers for linkages that are drawn by lot.
pub(super) struct Lots(Random);

impl Lots {
    /// From a third of a size to three times it.
    pub(super) fn length(&mut self, size: f64) -> f64 {
        size * math::powf(3.0, 2.0 * self.0.uniform() - 1.0)
    }

    pub(super) fn angle(&mut self) -> f64 {
        TAU * self.0.uniform()
    }

    /// 1 or -1.
    pub(super) fn sign(&mut self) -> f64 {
        if self.0.uniform() < 0.5 { -1.0 } else { 1.0 }
    }
}

/// A linkage as a start or a result: the number of its problem, of those of both branches, and its unknowns.
type Placed = (usize, Vec<f64>);

/// Linkages whose transmission angle keeps from 0 and 180 degrees.
struct Kept<'g, G> {
    of: &'g G,
    way: Way,
    /// Beyond which each cosine counts.
    most: [f64; COSINES],
    heavily: f64,
}

impl<G: Generates> Kept<'_, G> {
    fn beyond(&self, unknowns: &[f64]) -> [f64; COSINES] {
        let cosines = self.of.cosines(unknowns, self.way);
        std::array::from_fn(|k| (cosines[k].abs() - self.most[k]).max(0.0))
    }

    /// From a start, the best linkage whose cosines are hardly larger.
    fn near(&mut self, start: &[f64]) -> Option<Vec<f64>> {
        HEAVILY.iter().try_fold(start.to_vec(), |at, heavily| {
            self.heavily = *heavily;
            smallest_squares(self, &at)
        })
    }

    /// From such a linkage, the one whose cosines are no larger than `most`: where they are, the next turn aims lower by as much (the multipliers of
    /// M. R. Hestenes and M. J. D. Powell, 1969).
    fn within(&mut self, most: f64, mut at: Vec<f64>) -> Option<Vec<f64>> {
        for _ in 0..TURNS {
            if largest_cosine(self.of, &at, self.way) <= most {
                return Some(at);
            }
            let cosines = self.of.cosines(&at, self.way);
            for (aim, cosine) in self.most.iter_mut().zip(cosines) {
                *aim -= (cosine.abs() - (most - INSIDE)).max(0.0);
            }
            at = smallest_squares(self, &at)?;
        }
        None
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

/// Whether unknowns are those of one linkage.
fn is_same(a: &[f64], b: &[f64], size: f64) -> bool {
    let near = |(a, b): (&f64, &f64)| (a - b).abs() <= SAME * (size + a.abs());
    a.iter().zip(b).all(near)
}

/// The largest cosine of the transmission angle on the way, of either sign.
fn largest_cosine(of: &impl Generates, unknowns: &[f64], way: Way) -> f64 {
    let cosines = of.cosines(unknowns, way).map(f64::abs);
    cosines.iter().fold(0.0, |m: f64, c| m.max(*c))
}

fn sum(errors: &[f64]) -> f64 {
    errors.iter().map(|x| x * x).sum()
}

/// What was found without that condition, and the best linkages besides whose transmission angle keeps off 0 and 180 degrees, by each of
/// [`APART_FROM_DEAD`] that the best of all does not keep by itself: the best first. The problems are those of the branches 1 and -1.
///
/// # Errors
/// [`SynthesisError::None`] where there is none of either, and any other of what was found.
pub(super) fn with_driven<G: Generates>(
    problems: &[G; 2],
    found: Result<Vec<G::Fit>, SynthesisError>,
    way: [f64; 2],
) -> Result<Vec<G::Fit>, SynthesisError> {
    let mut fits = match found {
        Err(SynthesisError::None) => Vec::new(),
        found => found?,
    };
    let of = &problems[0];
    let known: Vec<Placed> = (fits.iter().map(|fit| of.of_fit(fit)))
        .map(|(branch, at, _)| (usize::from(branch < 0), at))
        .collect();
    let besides = driven(problems, &known, Way(way)).into_iter();
    fits.extend(besides.filter_map(|(problem, at)| problems[problem].fit(&at)));
    let rms = |fit: &G::Fit| of.of_fit(fit).2;
    fits.sort_by(|a, b| rms(a).total_cmp(&rms(b)));
    match fits.is_empty() {
        true => Err(SynthesisError::None),
        false => Ok(fits),
    }
}

/// The best linkages besides those known, by each of [`APART_FROM_DEAD`].
fn driven<G: Generates>(problems: &[G; 2], known: &[Placed], way: Way) -> Vec<Placed> {
    let mut starts = starts(problems);
    starts.extend_from_slice(known);
    let mut all = known.to_vec();
    for (k, apart) in APART_FROM_DEAD.into_iter().enumerate() {
        let most = math::cos(apart.to_radians());
        let square = |(problem, at): &&Placed| {
            let errors = problems[*problem].residuals(at);
            errors.map_or(f64::INFINITY, |errors| sum(&errors))
        };
        let sound = all
            .iter()
            .filter(|(problem, at)| problems[*problem].is_sound(at));
        let best = sound.min_by(|a, b| square(a).total_cmp(&square(b)));
        // The best that is known may be no more than that: from more starts there may be a better one.
        if k > 0
            && best
                .is_some_and(|(problem, at)| largest_cosine(&problems[*problem], at, way) <= most)
        {
            continue;
        }
        let found = best_kept(problems, &starts, way, most);
        starts.extend_from_slice(&found);
        for (problem, at) in found {
            let size = problems[problem].size();
            if !all
                .iter()
                .any(|(p, other)| *p == problem && is_same(other, &at, size))
            {
                all.push((problem, at));
            }
        }
    }
    all.split_off(known.len())
}

/// Linkages that keep some of the pairs, and others by lot, on both branches.
fn starts<G: Generates>(problems: &[G; 2]) -> Vec<Placed> {
    let of = &problems[0];
    let [pairs, exact] = of.pairs();
    let mut lots = Lots(Random(1));
    let kept = subsets(pairs, exact, SETS)
        .into_iter()
        .flat_map(|chosen| of.exact(&chosen));
    let all = kept.chain((0..BY_LOT).map(|_| of.by_lot(&mut lots)));
    all.flat_map(|linkage| {
        let at = of.unknowns(&linkage);
        [(0, at.clone()), (1, at)]
    })
    .collect()
}

/// The best linkages whose cosine of the transmission angle is no larger than `most`.
fn best_kept<G: Generates>(
    problems: &[G; 2],
    starts: &[Placed],
    way: Way,
    most: f64,
) -> Vec<Placed> {
    let kept = |problem: usize| Kept {
        of: &problems[problem],
        way,
        most: [most - INSIDE; COSINES],
        heavily: HEAVILY[0],
    };
    let mut ordered: Vec<(f64, &Placed)> = (starts.iter())
        .filter_map(|start| Some((sum(&kept(start.0).residuals(&start.1)?), start)))
        .collect();
    ordered.sort_by(|a, b| a.0.total_cmp(&b.0));
    let [pairs, _] = problems[0].pairs();
    ordered.truncate((STARTS * STARTS / pairs).clamp(FEWEST, STARTS));
    let mut found: Vec<(f64, Placed)> = (ordered.into_iter())
        .filter_map(|(_, (problem, start))| {
            let at = kept(*problem).near(start)?;
            let errors = problems[*problem].residuals(&at)?;
            Some((sum(&errors), (*problem, at)))
        })
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut best: Vec<Placed> = Vec::new();
    for (_, (problem, at)) in found {
        if best.len() == KEPT {
            break;
        }
        let of = &problems[problem];
        let mut kept = kept(problem);
        kept.heavily = HEAVILY[HEAVILY.len() - 1];
        let Some(at) = kept.within(most, at) else {
            continue;
        };
        let is_known = |(p, other): &Placed| *p == problem && is_same(other, &at, of.size());
        if of.residuals(&at).is_some() && of.is_sound(&at) && !best.iter().any(is_known) {
            best.push((problem, at));
        }
    }
    best
}
