//! A front led to its ends, and filled where it is thin.
//!
//! The ends are the least of each objective. Of two objectives, the widest gaps between neighbours are filled by ways down towards the chord between
//! them, which the front crosses if it has anything there, hollow or not (I. Das and J. E. Dennis's normal-boundary intersection, 1998, between neighbours).

use crate::front::{Refined, RefinedFront, Way, go, ranges, undominated};
use crate::multi_start::{choose, sample, scales_of};
use crate::problem::{self, Evaluation, Problem, evaluate_all};
use crate::progress::{Ended, Hears};
use crate::space::Space;
use crate::sqp::SqpOptions;
use crate::standing::{Candidate, ranked};
use crate::workers::Workers;

/// Gaps are filled so many times at most.
const ROUNDS: usize = 6;
/// Designs are led to from their neighbours in other valleys so many times at most, and how many times as far apart as usual these are.
const ACROSS: usize = 5;
const APART: f64 = 2.0;
/// A gap this many times as wide as others should be is one.
const WIDE: f64 = 1.6;
/// A design that is nearer to a gap's end than this part of the gap does not fill it.
const NEAR: f64 = 0.02;

/// Where all designs are no more than so many times as many as samples, there are none.
const ENOUGH: usize = 8;
/// Designs that a way down tries, about: no more ways are begun than can be gone to their ends.
const OF_WAY: usize = 10;

/// How far a front is led, and from where its ends are sought besides.
#[derive(Clone, Debug, PartialEq)]
pub struct Widening {
    /// Designs of a front of two objectives.
    pub points: usize,
    /// Designs for each variable, from all over the box, of which the best for each objective are starts.
    pub samples: usize,
    /// How many of them.
    pub starts: usize,
    /// What they come from.
    pub seed: u64,
    /// A design that is a start, too.
    pub start: Option<Vec<f64>>,
}

impl From<usize> for Widening {
    /// Up to so many designs.
    fn from(points: usize) -> Self {
        Self {
            points,
            samples: 24,
            starts: 3,
            seed: 1,
            start: None,
        }
    }
}

/// Leads a front to its ends and fills its gaps up to so many designs, side by side; options hold for every descent, and all together evaluate so many
/// designs at most. A front that nobody refined has its designs where they were.
pub fn widen(
    problem: &dyn Problem,
    front: Vec<Refined>,
    widening: impl Into<Widening>,
    (options, budget): (&SqpOptions, usize),
    workers: &dyn Workers,
    hears: Hears,
) -> RefinedFront {
    let Widening {
        points,
        samples,
        starts,
        seed,
        start,
    } = widening.into();
    let objectives = problem.objectives();
    let scales = |all: &[Refined]| ranges(all.iter().map(|m| &m.candidate), objectives);
    let count = samples * problem.bounds().len();
    let count = if count > budget / ENOUGH { 0 } else { count };
    let (samples, stopped) = sample(problem, (seed, count), budget, workers, hears);
    if stopped == Ended::Stopped {
        return RefinedFront::of(joined(front, points), samples.len(), stopped);
    }
    let own = start.map(|start| Space::new(problem.bounds()).within(&start));
    let own = own.filter(|_| count > 0).map(|design| Candidate {
        evaluation: problem::evaluate(problem, &design),
        design,
    });
    let own = own.filter(|it| it.evaluation.is_defined());
    let tried = samples.len() + usize::from(own.is_some());
    let begun = (0..objectives).flat_map(|k| {
        let others = from_elsewhere(problem, &samples, (k, starts), options.feasibility);
        let all = best(&front, k).into_iter().chain(&own).chain(others);
        all.map(move |start| (k, Way::to_end(start, k)))
    });
    let (ends, mut ways): (Vec<usize>, Vec<Way>) = begun.unzip();
    let with = (options, budget, tried);
    let (mut evaluations, mut ended) =
        go(problem, &mut ways, &scales(&front), with, workers, hears);
    let is_open = |k: &usize| {
        let mut own = ends.iter().zip(&ways).filter(|(end, _)| *end == k);
        own.any(|(_, way)| way.is_open)
    };
    let open: Vec<usize> = (0..objectives).filter(is_open).collect();
    // What was stopped on its way is no end.
    ways.retain(|way| {
        let stopped = |m: &Refined| m.ended == Ended::Stopped;
        !way.member.as_ref().is_some_and(stopped)
    });
    let mut members = with_found(front, ways);
    if !open.is_empty() && ended == Ended::Converged {
        let ranges = scales(&members);
        let ways = (open.iter()).filter_map(|k| Some(Way::beside(best(&members, *k)?, *k)));
        let mut ways: Vec<Way> = ways.collect();
        let with = (options, budget, evaluations);
        (evaluations, ended) = go(problem, &mut ways, &ranges, with, workers, hears);
        members = with_found(members, ways);
    }
    // The left ends of gaps that nothing fills.
    let mut empty: Vec<Vec<f64>> = Vec::new();
    for _ in 0..ROUNDS {
        if objectives != 2 || ended != Ended::Converged || evaluations >= budget {
            break;
        }
        let ranges = scales(&members);
        let most = (budget - evaluations) / OF_WAY;
        let gaps = gaps(&members, &ranges, (points, most), &empty);
        if gaps.is_empty() {
            break;
        }
        let places: Vec<Place> = gaps.iter().flat_map(|gap| gap.places(&members)).collect();
        let blends: Vec<Vec<f64>> = places.iter().map(|place| place.blend.clone()).collect();
        let known = evaluate_all(problem, &blends, workers);
        evaluations += blends.len();
        let starts = places.into_iter().zip(known);
        let ways = starts.map(|(place, known)| match known.is_defined() {
            true => Way::towards(place.blend, place.target),
            false => Way::towards(place.nearer, place.target),
        });
        let mut ways: Vec<Way> = ways.collect();
        let with = (options, budget, evaluations);
        (evaluations, ended) = go(problem, &mut ways, &ranges, with, workers, hears);
        let ends = gaps.iter().map(|gap| gap.ends(&members).map(objectives_of));
        let ends: Vec<[Vec<f64>; 2]> = ends.collect();
        members = with_found(members, ways);
        let filled = |[a, b]: &[Vec<f64>; 2]| {
            let margin = NEAR * (b[0] - a[0]);
            let mut own = members.iter().map(|m| m.candidate.evaluation.objectives[0]);
            own.any(|f| f > a[0] + margin && f < b[0] - margin)
        };
        let unfilled = ends.into_iter().filter(|ends| !filled(ends));
        empty.extend(unfilled.map(|[a, _]| a));
    }
    let mut members = joined(members, points);
    for _ in 0..ACROSS {
        if objectives != 2 || ended != Ended::Converged || evaluations >= budget {
            break;
        }
        let ranges = scales(&members);
        let most = (budget - evaluations) / OF_WAY;
        let pairs = seams(&members, &Space::new(problem.bounds()));
        let ways = pairs.into_iter().take(most).map(|(from, to)| {
            let [from, to] = [from, to].map(|k| &members[k].candidate);
            Way::towards(from.design.clone(), objectives_of(to))
        });
        let mut ways: Vec<Way> = ways.collect();
        let with = (options, budget, evaluations);
        (evaluations, ended) = go(problem, &mut ways, &ranges, with, workers, hears);
        let before = members.clone();
        members = joined(with_found(members, ways), points);
        if members == before {
            break;
        }
    }
    RefinedFront::of(members, evaluations, ended)
}

/// The samples from which the least of one objective is sought besides: from the end of a front there may be a way to a place alone that is least among
/// those near to it.
fn from_elsewhere<'c>(
    problem: &dyn Problem,
    samples: &'c [Candidate],
    (objective, starts): (usize, usize),
    tolerance: f64,
) -> Vec<&'c Candidate> {
    let alone = samples.iter().map(|it| {
        let own = it.evaluation.objectives.get(objective).copied();
        Candidate {
            design: it.design.clone(),
            evaluation: Evaluation {
                objectives: own.into_iter().collect(),
                ..it.evaluation.clone()
            },
        }
    });
    let alone: Vec<Candidate> = alone.collect();
    let order = ranked(&alone, &scales_of(problem, samples), tolerance);
    choose(samples, &order, starts, &Space::new(problem.bounds()))
}

/// The design of a front with the least of one objective.
fn best(front: &[Refined], objective: usize) -> Option<&Candidate> {
    let value = |c: &&Candidate| c.evaluation.objectives[objective];
    let all = front.iter().map(|m| &m.candidate);
    all.min_by(|a, b| value(a).total_cmp(&value(b)))
}

/// A front with what ways led to.
fn with_found(front: Vec<Refined>, ways: Vec<Way>) -> Vec<Refined> {
    let found = ways.into_iter().filter_map(|way| way.member);
    undominated(front.into_iter().chain(found).collect())
}

/// Neighbours of a front, either way, that are much farther apart in the box than most: they lie in two valleys, of which the one may be lower where the front
/// still has the other.
fn seams(members: &[Refined], space: &Space) -> Vec<(usize, usize)> {
    let pairs = members.windows(2);
    let apart: Vec<f64> = pairs
        .map(|pair| space.distance(&pair[0].candidate.design, &pair[1].candidate.design))
        .collect();
    let mut sorted = apart.clone();
    sorted.sort_by(f64::total_cmp);
    let usual = sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
    let seams = (0..apart.len()).filter(|k| apart[*k] > APART * usual);
    seams.flat_map(|k| [(k, k + 1), (k + 1, k)]).collect()
}

/// What none of some designs betters, by their first objective; of two objectives so many at most.
pub fn joined(members: Vec<Refined>, points: usize) -> Vec<Refined> {
    let mut members = undominated(members);
    let two = |m: &Refined| m.candidate.evaluation.objectives.len() == 2;
    if members.iter().all(two) {
        thin(&mut members, points);
    }
    members
}

/// Leaves out designs of a front of two objectives where it is thickest, until there are no more than asked for; its ends stay.
fn thin(members: &mut Vec<Refined>, points: usize) {
    while members.len() > points.max(2) {
        let ranges = ranges(members.iter().map(|m| &m.candidate), 2);
        let room = members
            .windows(3)
            .map(|three| width(&three[0], &three[2], &ranges));
        let thickest = room.enumerate().min_by(|(_, a), (_, b)| a.total_cmp(b));
        members.remove(thickest.map_or(0, |(k, _)| k) + 1);
    }
}

/// How far two designs are apart, by the front's ranges.
fn width(a: &Refined, b: &Refined, ranges: &[f64]) -> f64 {
    let [a, b] = [a, b].map(|m| &m.candidate.evaluation.objectives);
    let both = a.iter().zip(b).zip(ranges);
    both.map(|((a, b), range)| ((b - a) / range).abs()).sum()
}

/// Between a member and the next, so many designs are missing.
struct Gap {
    after: usize,
    missing: usize,
}

impl Gap {
    fn ends<'m>(&self, members: &'m [Refined]) -> [&'m Candidate; 2] {
        [self.after, self.after + 1].map(|k| &members[k].candidate)
    }

    /// Places on the chord between its ends.
    fn places(&self, members: &[Refined]) -> Vec<Place> {
        let [a, b] = self.ends(members);
        let between = |a: &[f64], b: &[f64], part: f64| -> Vec<f64> {
            let both = a.iter().zip(b);
            both.map(|(a, b)| a + part * (b - a)).collect()
        };
        let parts = (1..=self.missing).map(|k| k as f64 / (self.missing + 1) as f64);
        let place = parts.map(|part| Place {
            blend: between(&a.design, &b.design, part),
            nearer: if part <= 0.5 { a } else { b }.design.clone(),
            target: between(&a.evaluation.objectives, &b.evaluation.objectives, part),
        });
        place.collect()
    }
}

/// A place on the chord between two designs.
struct Place {
    /// The design between them.
    blend: Vec<f64>,
    /// The nearer of both.
    nearer: Vec<f64>,
    /// The objectives there.
    target: Vec<f64>,
}

fn objectives_of(candidate: &Candidate) -> Vec<f64> {
    candidate.evaluation.objectives.clone()
}

/// The gaps of a front of two objectives that should have so many designs evenly, the widest first, with so many missing at most.
fn gaps(
    members: &[Refined],
    ranges: &[f64],
    (points, most): (usize, usize),
    empty: &[Vec<f64>],
) -> Vec<Gap> {
    // What is too much in the end where it was thick is left out.
    let left = (2 * points).saturating_sub(members.len()).min(most);
    let widths = members.windows(2).map(|pair| {
        let known = empty.contains(&objectives_of(&pair[0].candidate));
        if known {
            0.0
        } else {
            width(&pair[0], &pair[1], ranges)
        }
    });
    let widths: Vec<f64> = widths.collect();
    let wanted = widths.iter().sum::<f64>() / points.saturating_sub(1).max(1) as f64;
    let mut order: Vec<usize> = (0..widths.len()).collect();
    order.sort_by(|a, b| widths[*b].total_cmp(&widths[*a]).then(a.cmp(b)));
    let mut all: Vec<Gap> = Vec::new();
    let mut placed = 0;
    for after in order {
        let missing = (widths[after] / wanted).round() as usize;
        let missing = missing.saturating_sub(1).max(1).min(left - placed);
        if missing == 0 || widths[after].is_nan() || widths[after] <= WIDE * wanted {
            break;
        }
        placed += missing;
        all.push(Gap { after, missing });
    }
    all
}
