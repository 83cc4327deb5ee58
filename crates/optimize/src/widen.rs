//! A front led to its ends, and filled where it is thin.
//!
//! The ends are the least of each objective. Of two objectives, the widest gaps between neighbours are filled by ways down towards the chord between
//! them, which the front crosses if it has anything there, hollow or not (I. Das and J. E. Dennis's normal-boundary intersection, 1998, between neighbours).

use crate::front::{EndsFrom, Refined, RefinedFront, Way, go, ranges, undominated};
use crate::gaps::{Place, gaps, objectives_of, width};
use crate::problem::{self, Candidate, Problem, evaluate_all};
use crate::progress::{Ended, Hears};
use crate::refine::{FIRST, GENEROUS, LEAST, evenly};
use crate::rounds::Further;
use crate::space::Space;
use crate::sqp::SqpOptions;
use crate::workers::Workers;

/// Gaps are filled so many times at most.
const ROUNDS: usize = 6;
/// Neighbours of a front that are so many times as far apart as usual lie in two valleys. From one to another it is tried so often at most, for each design.
const APART: f64 = 2.0;
const ACROSS: usize = 4;
/// How often a front is filled again that lower valleys took over.
const AGAIN: usize = 3;
/// A design that is nearer to a gap's end than this part of the gap does not fill it.
pub(crate) const NEAR: f64 = 0.02;

/// Where designs do not do for this part of all points in one gap, that is told.
const MISSING: f64 = 0.2;
/// Where all designs are no more than so many times as many as samples, there are none.
const ENOUGH: usize = 8;
/// Designs that a way down tries, about: no more ways are begun than can be gone to their ends.
const OF_WAY: usize = 10;
/// Where no more are left than for so many ways, gaps that nothing filled may be none.
const FEW: usize = 2;
/// Known designs that are looked at, at most.
const KNOWN: usize = 2000;

/// How far a front is led, and from where its ends are sought besides.
#[derive(Clone, Debug, PartialEq)]
pub struct Widening {
    /// Designs of a front of two objectives.
    pub points: usize,
    /// Designs for each variable, from all over the box, of which the best for each objective are starts.
    pub samples: usize,
    /// How many of them.
    pub starts: usize,
    /// Whether as many are looked at and followed again.
    pub further: Option<Further>,
    /// What they come from.
    pub seed: u64,
    /// Designs that are known: beside samples starts of ways from other valleys.
    pub known: Vec<Candidate>,
    /// So many of them, the first, are from all over the box: where few may be evaluated they stand for samples.
    pub even: usize,
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
            further: None,
            seed: 1,
            known: Vec::new(),
            even: 0,
            start: None,
        }
    }
}

/// Leads a front to its ends and fills its gaps up to so many designs, side by side; options hold for every descent, and all together evaluate so many
/// designs at most. A front that nobody refined has its designs where they were. It [ends](RefinedFront::ended) as [`Ended::Budget`] where designs did not do
/// for its ends or left a wide gap.
pub fn widen(
    problem: &dyn Problem,
    front: Vec<Refined>,
    widening: impl Into<Widening>,
    (options, budget): (&SqpOptions, usize),
    workers: &dyn Workers,
    hears: Hears,
) -> RefinedFront {
    let widening = widening.into();
    let mut lead = Lead {
        evaluations: 0,
        is_short: false,
        ends_from: EndsFrom::Own,
        led: Vec::new(),
        empty: Vec::new(),
        crossed: Vec::new(),
        points: widening.points,
        problem,
        options,
        budget,
        workers,
        hears,
        ended: Ended::Converged,
    };
    let has_samples = widening.samples * problem.bounds().len() <= budget / ENOUGH;
    let starts = if has_samples { widening.starts } else { 0 };
    let mut samples = Vec::new();
    let mut members = lead.with_ends(front, &mut samples, (&widening, starts));
    members = if samples.is_empty() {
        let known = &widening.known[..widening.even.min(widening.known.len())];
        lead.with_other_ends(members, (known, widening.starts))
    } else {
        let known = evenly(&widening.known, KNOWN);
        lead.with_other_valleys(members, &[samples, known].concat())
    };
    members = lead.with_ends_of_others(members, has_samples);
    if problem.objectives() == 2 {
        members = lead.fill(members);
        // Where a lower valley takes over it may go on beyond the end, and has gaps of its own.
        for _ in 0..AGAIN {
            let filled = members.clone();
            members = lead.across(members);
            members = lead.with_ends_of_others(members, false);
            if members == filled || !lead.goes_on() {
                break;
            }
            members = lead.fill(members);
        }
    }
    let ended = match (lead.ended, lead.is_short) {
        (Ended::Stopped, _) => Ended::Stopped,
        (_, true) => Ended::Budget,
        (_, false) => Ended::Converged,
    };
    RefinedFront {
        ends_from: lead.ends_from,
        ..RefinedFront::of(joined(members, widening.points), lead.evaluations, ended)
    }
}

/// How ways were gone.
pub(crate) struct Gone {
    /// Designs that one took.
    pub of_way: usize,
    /// Whether some ended for want of designs.
    pub was_cut: bool,
}

/// A front that is led on.
pub(crate) struct Lead<'l> {
    pub problem: &'l dyn Problem,
    /// Designs of a front of two objectives.
    points: usize,
    pub options: &'l SqpOptions,
    pub budget: usize,
    pub workers: &'l dyn Workers,
    pub hears: Hears<'l>,
    pub evaluations: usize,
    pub ended: Ended,
    /// Whether designs did not do for something.
    pub is_short: bool,
    pub ends_from: EndsFrom,
    /// Objectives and designs from which a way went to the end of each, or at which it ended.
    pub led: Vec<(usize, Vec<f64>)>,
    /// The ends of gaps that nothing fills.
    empty: Vec<[Vec<f64>; 2]>,
    /// Designs that were led towards others in other valleys.
    crossed: Vec<[Vec<f64>; 2]>,
}

impl Lead<'_> {
    pub fn known(&mut self, design: Vec<f64>) -> Candidate {
        self.evaluations += 1;
        Candidate {
            evaluation: problem::evaluate(self.problem, &design),
            design,
        }
    }

    pub fn left(&self) -> usize {
        self.budget.saturating_sub(self.evaluations)
    }

    pub fn goes_on(&self) -> bool {
        self.ended == Ended::Converged && self.left() > 0
    }

    pub fn ranges(&self, all: &[Refined]) -> Vec<f64> {
        ranges(all.iter().map(|m| &m.candidate), self.problem.objectives())
    }

    /// Goes ways to their ends, for which so many of the designs that are left may be evaluated. What ways or these use up does not end what has designs left.
    pub fn go(&mut self, ways: &mut [Way], ranges: &[f64], most: usize) -> Gone {
        let before = self.evaluations;
        let budget = before.saturating_add(most.min(self.left()));
        let with = (self.options, budget, before);
        (self.evaluations, self.ended) =
            go(self.problem, ways, ranges, with, self.workers, self.hears);
        let was_cut = self.ended == Ended::Budget;
        if was_cut && self.left() > 0 {
            self.ended = Ended::Converged;
        }
        Gone {
            of_way: (self.evaluations - before) / ways.len().max(1),
            was_cut,
        }
    }

    /// The front with its gaps filled. The first few ways tell how many designs one takes.
    fn fill(&mut self, mut members: Vec<Refined>) -> Vec<Refined> {
        let (mut rounds, mut of_way) = (0, OF_WAY);
        let mut is_known = self.left() > GENEROUS * self.points;
        while rounds < ROUNDS && self.ended == Ended::Converged {
            let ranges = self.ranges(&members);
            let most = self.left() / of_way;
            let mut gaps = gaps(&members, &ranges, (self.points, most.max(1)), &self.empty);
            if gaps.is_empty() || most == 0 {
                break;
            }
            if !is_known {
                gaps.truncate(FIRST);
                let each = FIRST / gaps.len();
                (gaps.iter_mut()).for_each(|gap| gap.missing = gap.missing.min(each));
            }
            let places: Vec<Place> = gaps.iter().flat_map(|gap| gap.places(&members)).collect();
            let blends: Vec<Vec<f64>> = places.iter().map(|place| place.blend.clone()).collect();
            let known = evaluate_all(self.problem, &blends, self.workers);
            self.evaluations += blends.len();
            // Where designs do not do for all gaps the rest are filled in rounds of their own.
            rounds += usize::from(is_known && blends.len() < most);
            is_known = true;
            let starts = places.into_iter().zip(known);
            let ways = starts.map(|(place, known)| match known.is_defined() {
                true => Way::towards(place.blend, place.target),
                false => Way::towards(place.nearer, place.target),
            });
            let mut ways: Vec<Way> = ways.collect();
            of_way = self.go(&mut ways, &ranges, usize::MAX).of_way.max(LEAST);
            let ends = gaps.iter().map(|gap| gap.ends(&members).map(objectives_of));
            let ends: Vec<[Vec<f64>; 2]> = ends.collect();
            members = with_found(members, ways);
            if self.ended != Ended::Converged {
                break;
            }
            let filled = |[a, b]: &[Vec<f64>; 2]| {
                let margin = NEAR * (b[0] - a[0]);
                let mut own = members.iter().map(|m| m.candidate.evaluation.objectives[0]);
                own.any(|f| f > a[0] + margin && f < b[0] - margin)
            };
            (self.empty).extend(ends.into_iter().filter(|ends| !filled(ends)));
        }
        if self.left() < of_way.max(FEW * OF_WAY) {
            let ranges = self.ranges(&members);
            let gaps = gaps(&members, &ranges, (self.points, self.points), &[]);
            let most = MISSING * self.points as f64;
            self.is_short |= gaps.iter().any(|gap| gap.missing as f64 >= most);
        }
        joined(members, self.points)
    }

    /// The front where designs are led to from their neighbours in other valleys: a lower one takes over one design after the other. What was tried from one
    /// towards another is not tried again.
    fn across(&mut self, mut members: Vec<Refined>) -> Vec<Refined> {
        while self.goes_on() && self.crossed.len() < ACROSS * self.points {
            let pairs = seams(&members, &Space::new(self.problem.bounds())).into_iter();
            let pairs = pairs.map(|pair| pair.map(|k| members[k].candidate.clone()));
            let new = pairs.filter(|[from, to]| {
                let known = |[a, b]: &[Vec<f64>; 2]| *a == from.design && *b == to.design;
                !self.crossed.iter().any(known)
            });
            let new: Vec<[Candidate; 2]> = new.take(self.left() / OF_WAY).collect();
            if new.is_empty() {
                break;
            }
            let ways =
                (new.iter()).map(|[from, to]| Way::towards(from.design.clone(), objectives_of(to)));
            let mut ways: Vec<Way> = ways.collect();
            (self.crossed).extend(new.into_iter().map(|pair| pair.map(|it| it.design)));
            let ranges = self.ranges(&members);
            self.go(&mut ways, &ranges, usize::MAX);
            members = joined(with_found(members, ways), self.points);
        }
        members
    }
}

/// A front with what ways led to.
pub(crate) fn with_found(front: Vec<Refined>, ways: Vec<Way>) -> Vec<Refined> {
    let found = ways.into_iter().filter_map(|way| way.member);
    undominated(front.into_iter().chain(found).collect())
}

/// Neighbours of a front, either way, that are much farther apart in the box than most: they lie in two valleys, of which the one may be lower where the front
/// still has the other.
fn seams(members: &[Refined], space: &Space) -> Vec<[usize; 2]> {
    let pairs = members.windows(2);
    let apart: Vec<f64> = pairs
        .map(|pair| space.distance(&pair[0].candidate.design, &pair[1].candidate.design))
        .collect();
    let mut sorted = apart.clone();
    sorted.sort_by(f64::total_cmp);
    let usual = sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
    let seams = (0..apart.len()).filter(|k| apart[*k] > APART * usual);
    seams.flat_map(|k| [[k, k + 1], [k + 1, k]]).collect()
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
