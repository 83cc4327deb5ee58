//! Designs of which none is better in all objectives: NSGA-II (K. Deb, A. Pratap, S. Agarwal and T. Meyarivan 2002), and its points moved to where the
//! first-order conditions hold.

use std::cmp::Ordering;
use std::ops::ControlFlow;

use kempe_number::Random;
use kempe_number::math::{max, powf};

use crate::population::{Asker, Member, PopulationOptions};
use crate::problem::{self, Evaluation, Piece, Problem, Scales, Slopes};
use crate::progress::Hears;
use crate::rank::feasibility;
use crate::sequence::Even;
use crate::space::Space;
use crate::sqp::{SqpOptions, sqp};

/// Designs of a generation unless said otherwise.
const SIZE: usize = 100;
/// How near children lie to their parents, and mutants to what they were.
const CROSSED: f64 = 15.0;
const MUTATED: f64 = 20.0;
/// How many are crossed.
const CROSSING: f64 = 0.9;

/// A design of a front.
#[derive(Clone, Debug, PartialEq)]
pub struct FrontPoint {
    /// The design.
    pub design: Vec<f64>,
    /// What it is worth.
    pub evaluation: Evaluation,
    /// How far the first-order conditions are missed; not a number where they were not looked at.
    pub residual: f64,
    /// The largest violation, in the constraints' scales.
    pub violation: f64,
}

/// A front.
#[derive(Clone, Debug, PartialEq)]
pub struct Front {
    /// Its points, by the first objective. Where no design keeps all constraints, the best one alone.
    pub points: Vec<FrontPoint>,
    /// Sizes of objectives and constraints.
    pub scales: Scales,
    /// Designs evaluated.
    pub evaluations: usize,
    /// Whether whoever listened stopped it.
    pub stopped: bool,
}

/// Whether one design is at least as good in every objective and better in one.
pub fn dominates(a: &[f64], b: &[f64]) -> bool {
    a.iter().zip(b).all(|(a, b)| a <= b) && a.iter().zip(b).any(|(a, b)| a < b)
}

/// Order of two designs: what keeps more first, then by domination; equal where neither dominates.
fn order(a: &Evaluation, b: &Evaluation, scales: &Scales) -> Ordering {
    let kept = feasibility(a, b, scales);
    if kept != Ordering::Equal || !a.is_defined() {
        return kept;
    }
    match () {
        () if dominates(&a.objectives, &b.objectives) => Ordering::Less,
        () if dominates(&b.objectives, &a.objectives) => Ordering::Greater,
        () => Ordering::Equal,
    }
}

/// Ranks of members: 0 where none is better, 1 where only those are, and so on.
fn ranks(all: &[Member], scales: &Scales) -> Vec<usize> {
    let n = all.len();
    let mut better: Vec<usize> = vec![0; n];
    let mut worse: Vec<Vec<usize>> = vec![Vec::new(); n];
    for i in 0..n {
        for j in i + 1..n {
            match order(&all[i].evaluation, &all[j].evaluation, scales) {
                Ordering::Less => {
                    worse[i].push(j);
                    better[j] += 1;
                }
                Ordering::Greater => {
                    worse[j].push(i);
                    better[i] += 1;
                }
                Ordering::Equal => {}
            }
        }
    }
    let mut rank = vec![0; n];
    let mut front: Vec<usize> = (0..n).filter(|k| better[*k] == 0).collect();
    let mut level = 0;
    while !front.is_empty() {
        let mut next = Vec::new();
        for i in front {
            rank[i] = level;
            for j in &worse[i] {
                better[*j] -= 1;
                if better[*j] == 0 {
                    next.push(*j);
                }
            }
        }
        next.sort_unstable();
        front = next;
        level += 1;
    }
    rank
}

/// How far the neighbours of each member of a front lie apart, in parts of the front.
fn crowding(all: &[Member], of: &[usize], distance: &mut [f64]) {
    of.iter().for_each(|k| distance[*k] = 0.0);
    let objectives = of
        .first()
        .map_or(0, |k| all[*k].evaluation.objectives.len());
    for m in 0..objectives {
        let value = |k: usize| all[k].evaluation.objectives[m];
        let mut sorted = of.to_vec();
        sorted.sort_by(|a, b| value(*a).total_cmp(&value(*b)).then(a.cmp(b)));
        let (first, last) = (sorted[0], sorted[sorted.len() - 1]);
        let extent = value(last) - value(first);
        distance[first] = f64::INFINITY;
        distance[last] = f64::INFINITY;
        for w in sorted.windows(3) {
            distance[w[1]] += match extent > 0.0 {
                true => (value(w[2]) - value(w[0])) / extent,
                false => 0.0,
            };
        }
    }
}

/// Ranks and crowding of all.
fn sorted(all: &[Member], scales: &Scales) -> (Vec<usize>, Vec<f64>) {
    let rank = ranks(all, scales);
    let mut distance = vec![0.0; all.len()];
    let most = rank.iter().copied().max().unwrap_or(0);
    for level in 0..=most {
        let of: Vec<usize> = (0..all.len()).filter(|k| rank[*k] == level).collect();
        if all[of[0]].evaluation.is_defined() {
            crowding(all, &of, &mut distance);
        }
    }
    (rank, distance)
}

/// The front that a population finds, with a design that is in the first generation; `None` where the bounds do not fit.
pub fn nsga2(
    problem: &mut dyn Problem,
    start: &[f64],
    options: &PopulationOptions,
    hears: Hears,
) -> Option<Front> {
    let n = start.len();
    let space = Space::new(problem.bounds());
    if !space.holds(n) {
        return None;
    }
    let size = options.size.unwrap_or(SIZE).max(4);
    let mut even = Even::new(n, options.seed);
    let mut first: Vec<Vec<f64>> = (1..size).map(|_| even.point()).collect();
    first.push(space.unit(&space.within(start)));
    let (mut asker, mut all) = Asker::begin(problem, first, options.evaluations, hears);
    let mut random = Random(options.seed ^ 0x2545_f491);
    while !asker.is_over() {
        let (rank, distance) = sorted(&all, &asker.scales);
        let better = |a: usize, b: usize| {
            rank[a]
                .cmp(&rank[b])
                .then(distance[b].total_cmp(&distance[a]))
                .is_le()
        };
        let pick = |random: &mut Random| {
            let (a, b) = (random.below(all.len()), random.below(all.len()));
            if better(a, b) { a } else { b }
        };
        let mut children: Vec<Vec<f64>> = Vec::with_capacity(size);
        while children.len() < size.min(asker.left().max(1)) {
            let (a, b) = (pick(&mut random), pick(&mut random));
            let pair = crossed(&all[a].place, &all[b].place, &mut random);
            children.extend(pair.map(|place| mutated(place, &mut random)));
        }
        children.truncate(size.min(asker.left().max(1)));
        all.extend(asker.ask(children));
        let (rank, distance) = sorted(&all, &asker.scales);
        let mut order: Vec<usize> = (0..all.len()).collect();
        order.sort_by(|a, b| {
            rank[*a]
                .cmp(&rank[*b])
                .then(distance[*b].total_cmp(&distance[*a]))
                .then(a.cmp(b))
        });
        order.truncate(size);
        all = order.iter().map(|k| all[*k].clone()).collect();
    }
    let rank = ranks(&all, &asker.scales);
    let scales = asker.scales.clone();
    let points = (all.iter().zip(rank))
        .filter(|(_, rank)| *rank == 0)
        .map(|(m, _)| FrontPoint {
            design: asker.space.design(&m.place),
            violation: match m.evaluation.is_defined() {
                true => m.evaluation.violation(&scales),
                false => f64::INFINITY,
            },
            evaluation: m.evaluation.clone(),
            residual: f64::NAN,
        });
    let mut front = Front {
        points: points.collect(),
        evaluations: asker.asked,
        stopped: asker.stopped,
        scales,
    };
    front.clean();
    Some(front)
}

/// Two children between and beside two parents (K. Deb and R. B. Agrawal 1995).
fn crossed(a: &[f64], b: &[f64], random: &mut Random) -> [Vec<f64>; 2] {
    let mut pair = [a.to_vec(), b.to_vec()];
    if random.uniform() > CROSSING {
        return pair;
    }
    for k in 0..a.len() {
        if random.uniform() > 0.5 || (a[k] - b[k]).abs() < 1e-14 {
            continue;
        }
        let (low, high) = (a[k].min(b[k]), a[k].max(b[k]));
        let u = random.uniform();
        let spread = |room: f64| {
            let beta = 1.0 + 2.0 * room / (high - low);
            let alpha = 2.0 - powf(beta, -(CROSSED + 1.0));
            match u <= 1.0 / alpha {
                true => powf(u * alpha, 1.0 / (CROSSED + 1.0)),
                false => powf(1.0 / (2.0 - u * alpha), 1.0 / (CROSSED + 1.0)),
            }
        };
        let first = 0.5 * (low + high - spread(low) * (high - low));
        let second = 0.5 * (low + high + spread(1.0 - high) * (high - low));
        let swap = random.uniform() < 0.5;
        pair[usize::from(swap)][k] = first.clamp(0.0, 1.0);
        pair[usize::from(!swap)][k] = second.clamp(0.0, 1.0);
    }
    pair
}

/// A place with about one of its coordinates moved.
fn mutated(mut place: Vec<f64>, random: &mut Random) -> Vec<f64> {
    let n = place.len();
    for x in &mut place {
        if random.uniform() * n as f64 >= 1.0 {
            continue;
        }
        let u = random.uniform();
        let power = 1.0 / (MUTATED + 1.0);
        let moved = match u < 0.5 {
            true => {
                powf(
                    2.0 * u + (1.0 - 2.0 * u) * powf(1.0 - *x, MUTATED + 1.0),
                    power,
                ) - 1.0
            }
            false => {
                1.0 - powf(
                    2.0 * (1.0 - u) + (2.0 * u - 1.0) * powf(*x, MUTATED + 1.0),
                    power,
                )
            }
        };
        *x = (*x + moved).clamp(0.0, 1.0);
    }
    place
}

impl Front {
    /// Leaves out what another point dominates or is, and sorts by the first objective.
    fn clean(&mut self) {
        let scales = &self.scales;
        let points = std::mem::take(&mut self.points);
        for point in points {
            let beaten = |other: &FrontPoint| {
                order(&other.evaluation, &point.evaluation, scales) == Ordering::Less
                    || (other.evaluation.is_defined()
                        && other.evaluation.objectives == point.evaluation.objectives)
            };
            if self.points.iter().any(beaten) {
                continue;
            }
            self.points.retain(|other| {
                order(&point.evaluation, &other.evaluation, scales) != Ordering::Less
            });
            self.points.push(point);
        }
        self.points.sort_by(|a, b| {
            let pairs = a.evaluation.objectives.iter().zip(&b.evaluation.objectives);
            pairs
                .map(|(a, b)| a.total_cmp(b))
                .find(|o| o.is_ne())
                .unwrap_or(Ordering::Equal)
        });
        // Where nothing keeps the constraints there is no front.
        let kept = |p: &FrontPoint| p.violation <= crate::rank::KEPT;
        if !self.points.iter().any(kept) {
            self.points.truncate(1);
        }
    }
}

/// How much of the sum of all objectives counts beside the largest: without it a point could be improved in one of them alone (the augmented
/// weighted Chebyshev problem of R. E. Steuer and E.-U. Choo, 1983).
const SUM: f64 = 1e-3;

/// A problem whose objectives count from a reference, in their scales: the largest of them is minimised.
struct From<'a> {
    inner: &'a mut dyn Problem,
    reference: Vec<f64>,
    sizes: Vec<f64>,
}

impl From<'_> {
    /// Each objective seen from the reference, with its part of the sum of all.
    fn seen(&self, objectives: &[f64]) -> Vec<f64> {
        let places = objectives.iter().zip(&self.reference).zip(&self.sizes);
        let own: Vec<f64> = places.map(|((f, r), s)| (f - r) / s).collect();
        let sum: f64 = own.iter().sum();
        own.iter().map(|f| f + SUM * sum).collect()
    }
}

impl Problem for From<'_> {
    fn bounds(&self) -> &[[f64; 2]] {
        self.inner.bounds()
    }

    fn objectives(&self) -> usize {
        self.inner.objectives()
    }

    fn constraints(&self) -> usize {
        self.inner.constraints()
    }

    fn evaluate(&mut self, designs: &[Vec<f64>]) -> Vec<Evaluation> {
        let mut all = self.inner.evaluate(designs);
        for evaluation in &mut all {
            evaluation.objectives = self.seen(&evaluation.objectives);
        }
        all
    }

    fn slopes(&mut self, design: &[f64]) -> Option<Slopes> {
        let mut slopes = self.inner.slopes(design)?;
        let places = slopes
            .objectives
            .iter_mut()
            .zip(&self.reference)
            .zip(&self.sizes);
        for ((pieces, r), s) in places {
            for Piece { value, slope } in pieces {
                *value = (*value - r) / s;
                slope.iter_mut().for_each(|d| *d /= s);
            }
        }
        let mut sum = Piece {
            value: 0.0,
            slope: vec![0.0; design.len()],
        };
        for pieces in &slopes.objectives {
            let highest = pieces.iter().max_by(|a, b| a.value.total_cmp(&b.value))?;
            sum.value += highest.value;
            sum.slope
                .iter_mut()
                .zip(&highest.slope)
                .for_each(|(s, d)| *s += d);
        }
        for Piece { value, slope } in slopes.objectives.iter_mut().flatten() {
            *value += SUM * sum.value;
            slope
                .iter_mut()
                .zip(&sum.slope)
                .for_each(|(s, d)| *s += SUM * d);
        }
        Some(slopes)
    }
}

/// The largest violation of a refined point, in the constraints' scales.
const REFINED: f64 = 1e-8;

/// Moves every point of a front to where no step betters all objectives to first order: what it lies above the ideal by, in parts of the front's extent, is
/// lessened alike (A. Pascoletti and P. Serafini 1984). What is dominated then goes.
pub fn refine(problem: &mut dyn Problem, front: &mut Front, options: &SqpOptions, hears: Hears) {
    let kept: Vec<&FrontPoint> = front
        .points
        .iter()
        .filter(|p| p.violation <= crate::rank::KEPT)
        .collect();
    if kept.is_empty() {
        return;
    }
    let objectives = problem.objectives();
    let sizes: Vec<f64> = (0..objectives)
        .map(|m| {
            let values = kept.iter().map(|p| p.evaluation.objectives[m]);
            let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
                (a.min(x), b.max(x))
            });
            if high > low {
                high - low
            } else {
                max(high.abs(), 1.0)
            }
        })
        .collect();
    let mut points = Vec::with_capacity(front.points.len());
    for point in &front.points {
        if front.stopped || point.violation > crate::rank::KEPT {
            points.push(point.clone());
            continue;
        }
        let mut shifted = From {
            inner: &mut *problem,
            reference: point.evaluation.objectives.clone(),
            sizes: sizes.clone(),
        };
        let found = sqp(&mut shifted, &point.design, options, &mut |progress| {
            let mut told = *progress;
            told.evaluations += front.evaluations;
            match hears(&told) {
                ControlFlow::Break(()) => {
                    front.stopped = true;
                    ControlFlow::Break(())
                }
                go_on => go_on,
            }
        });
        front.evaluations += found.evaluations;
        let better =
            found.evaluation.is_defined() && found.violation <= REFINED && found.objective() <= 0.0;
        points.push(match better {
            true => FrontPoint {
                evaluation: problem::evaluate(problem, std::slice::from_ref(&found.design))
                    .swap_remove(0),
                design: found.design,
                residual: found.residual,
                violation: 0.0,
            },
            false => point.clone(),
        });
    }
    front.points = points;
    front.clean();
}
