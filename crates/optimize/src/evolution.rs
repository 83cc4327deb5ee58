//! Differential evolution that adapts itself (L-SHADE; R. Tanabe and A. S. Fukunaga 2014).

use kempe_number::Random;
use kempe_number::math::{max, min, tan};

use crate::population::{Asker, Found, Member, PopulationOptions};
use crate::problem::Problem;
use crate::progress::Hears;
use crate::rank::compare;
use crate::sequence::Even;

/// Designs of the first generation for each variable; the last generation has the least.
const PER_VARIABLE: usize = 18;
const LEAST: usize = 4;
const MOST: usize = 400;
/// How many pairs of factors are remembered.
const MEMORY: usize = 6;
/// The part of the best from which one is followed.
const FOLLOWED: f64 = 0.11;
/// How many that were given up are remembered, in generations.
const ARCHIVE: f64 = 2.6;

/// The best design that differential evolution finds, with a design that is in the first generation; `None` where the bounds do not fit.
pub fn differential_evolution(
    problem: &mut dyn Problem,
    start: &[f64],
    options: &PopulationOptions,
    hears: Hears,
) -> Option<Found> {
    let n = start.len();
    let space = crate::space::Space::new(problem.bounds());
    if !space.holds(n) {
        return None;
    }
    let size = options
        .size
        .unwrap_or((PER_VARIABLE * n).min(MOST))
        .max(LEAST);
    let mut even = Even::new(n, options.seed);
    let mut first: Vec<Vec<f64>> = (1..size).map(|_| even.point()).collect();
    first.push(space.unit(&space.within(start)));
    let (mut asker, mut all) = Asker::begin(problem, first, options.evaluations, hears);
    let mut random = Random(options.seed ^ 0x5bd1_e995);
    let mut memory = vec![[0.5, 0.5]; MEMORY];
    let mut oldest = 0;
    let mut archive: Vec<Vec<f64>> = Vec::new();
    while !asker.is_over() && all.len() >= LEAST {
        all.sort_by(|a, b| compare(&a.evaluation, &b.evaluation, &asker.scales));
        let mut factors: Vec<[f64; 2]> = Vec::with_capacity(all.len());
        let mut trials: Vec<Vec<f64>> = Vec::with_capacity(all.len());
        for k in 0..all.len().min(asker.left().max(1)) {
            let factor = drawn(&memory, &mut random);
            trials.push(trial(&all, k, &archive, factor, &mut random));
            factors.push(factor);
        }
        let asked = asker.ask(trials);
        let mut won: Vec<([f64; 2], f64)> = Vec::new();
        let old = all.clone();
        for (k, (member, factor)) in asked.into_iter().zip(factors).enumerate() {
            let order = compare(&member.evaluation, &old[k].evaluation, &asker.scales);
            if order.is_gt() {
                continue;
            }
            if order.is_lt() {
                archive.push(old[k].place.clone());
                won.push((factor, gain(&old[k], &member)));
            }
            all[k] = member;
        }
        if let Some(mean) = means(&won) {
            memory[oldest] = mean;
            oldest = (oldest + 1) % MEMORY;
        }
        let part = asker.asked as f64 / options.evaluations.max(1) as f64;
        let target = size as f64 + (LEAST as f64 - size as f64) * min(part, 1.0);
        let target = (target.round() as usize).max(LEAST);
        if target < all.len() {
            all.sort_by(|a, b| compare(&a.evaluation, &b.evaluation, &asker.scales));
            all.truncate(target);
        }
        let room = (ARCHIVE * all.len() as f64) as usize;
        while archive.len() > room {
            let k = random.below(archive.len());
            archive.swap_remove(k);
        }
        if is_one(&all) {
            break;
        }
    }
    asker.found()
}

/// By how much a member is better than the one that it takes the place of.
fn gain(old: &Member, new: &Member) -> f64 {
    match old.evaluation.is_defined() && new.evaluation.is_defined() {
        true => max(
            old.evaluation.largest() - new.evaluation.largest(),
            f64::MIN_POSITIVE,
        ),
        false => 1.0,
    }
}

/// A factor of the difference and a rate of crossing from the memory.
fn drawn(memory: &[[f64; 2]], random: &mut Random) -> [f64; 2] {
    let [scale, cross] = memory[random.below(memory.len())];
    let mut factor = 0.0;
    while factor <= 0.0 {
        // A Cauchy distribution.
        factor = scale + 0.1 * tan(std::f64::consts::PI * (random.uniform() - 0.5));
    }
    let rate = match cross < 0.0 {
        true => 0.0,
        false => (cross + 0.1 * random.normal()).clamp(0.0, 1.0),
    };
    [min(factor, 1.0), rate]
}

/// A member moved towards one of the best and by a difference of two, crossed with itself; the population is sorted.
fn trial(
    all: &[Member],
    own: usize,
    archive: &[Vec<f64>],
    [factor, rate]: [f64; 2],
    random: &mut Random,
) -> Vec<f64> {
    let best = ((FOLLOWED * all.len() as f64) as usize)
        .max(2)
        .min(all.len());
    let followed = &all[random.below(best)].place;
    let first = loop {
        let k = random.below(all.len());
        if k != own {
            break k;
        }
    };
    let second = loop {
        let k = random.below(all.len() + archive.len());
        if k != own && k != first {
            break k;
        }
    };
    let second = all
        .get(second)
        .map_or_else(|| &archive[second - all.len()], |m| &m.place);
    let x = &all[own].place;
    let always = random.below(x.len());
    (0..x.len())
        .map(|k| {
            if k != always && random.uniform() >= rate {
                return x[k];
            }
            let moved =
                x[k] + factor * (followed[k] - x[k]) + factor * (all[first].place[k] - second[k]);
            // Halfway to the bound that it would pass.
            match () {
                () if moved < 0.0 => x[k] / 2.0,
                () if moved > 1.0 => (1.0 + x[k]) / 2.0,
                () => moved,
            }
        })
        .collect()
}

/// Weighted means of factors that won: Lehmer's of both; a crossing that is always none stays so.
fn means(won: &[([f64; 2], f64)]) -> Option<[f64; 2]> {
    let total: f64 = won.iter().map(|(_, gain)| gain).sum();
    if won.is_empty() || !(total > 0.0 && total.is_finite()) {
        return None;
    }
    let lehmer = |k: usize| {
        let moment = |power: i32| -> f64 {
            won.iter()
                .map(|(factor, gain)| gain / total * (0..power).fold(1.0, |p, _| p * factor[k]))
                .sum()
        };
        match moment(1) > 0.0 {
            true => moment(2) / moment(1),
            false => -1.0,
        }
    };
    Some([max(lehmer(0), 0.05), lehmer(1)])
}

/// Whether all members are one place.
fn is_one(all: &[Member]) -> bool {
    let first = &all[0].place;
    let same = |m: &Member| {
        m.place
            .iter()
            .zip(first)
            .all(|(a, b)| (a - b).abs() <= 1e-13)
    };
    all.iter().all(same)
}
