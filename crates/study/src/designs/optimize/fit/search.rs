//! Looks for the designs that fit best: many are looked at, the best that lie apart are led down a few steps, the best of these all the way.

use std::cmp::Ordering;

use kempe_model::OptimizeStudy;
use kempe_number::math;
use kempe_optimize::{
    Descent, Ended, Evaluation, Hears, Optimum, Problem, Progress, SqpOptions, Squares, Workers,
    each, each_heard, halton, least_squares, sqp,
};
use kempe_units::Dimension;

use super::super::designs::Designs;
use super::super::effort::{local, of_descent};
use super::super::optima::{Optima, plain};
use super::fitted::{Fitted, Pairing};
use super::goal::SQUARES;
use super::sums::{Sums, is_alone, scaled, sums};

/// Designs that are moved for each parameter, where the file does not say how many.
const MOVED: usize = 600;
/// Of all designs one of so many is looked at to choose starts from, one of so many moved in first steps from these, and one of so many in showing what is an
/// optimum at least; the others are for the ways down.
const LOOKED_AT_OF: usize = 6;
const FIRST_OF: usize = 6;
const SHOWN_OF: usize = 8;
/// First steps, and from how many starts at least.
const FIRST_STEPS: usize = 12;
const LED_LEAST: usize = 4;
/// So many of those led so far go on at least and at most, and so many designs each needs on the mean.
const ON: [usize; 2] = [2, 24];
const EACH: usize = 120;
/// Steps all the way down.
const STEPS: usize = 250;
/// So many of the best are shown to be optima, or how far they are from it.
const SHOWN: usize = 3;
/// How many times the extent of what is given lengths may be near it.
const SIZES: f64 = 4.0;
/// Designs nearer to each other than this part of the box are one start, or one optimum.
const APART: f64 = 0.03;
const SAME: f64 = 1e-4;
/// Descents, and designs looked at, between which is heard whether the work may go on.
const AT_ONCE: usize = 16;
const LOOKED_AT_ONCE: usize = 64;
/// Violations below this, in their scale, are none.
const KEPT: f64 = 1e-8;

/// The largest difference of two designs, in parts of the box.
fn distance(a: &[f64], b: &[f64], bounds: &[[f64; 2]]) -> f64 {
    let parts = a.iter().zip(b).zip(bounds);
    parts
        .filter(|(_, [low, high])| high > low)
        .map(|((a, b), [low, high])| (a - b).abs() / (high - low))
        .fold(0.0, f64::max)
}

/// Bounds within which lengths are of the size of what is given: nearer to fits than most of a wide box.
fn near(problem: &Designs<'_, '_>, fit: &Fitted<'_, '_>) -> Vec<[f64; 2]> {
    let places = &fit.given.places;
    let ends = [0, 1].map(|axis| {
        let values = places.iter().map(|p| p[axis]);
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| {
            [a.min(x), b.max(x)]
        })
    });
    let extents = ends.iter().map(|[low, high]| high - low);
    let extent = extents.fold(0.0, f64::max);
    let far = ends.as_flattened().iter();
    let far = far.map(|x| x.abs()).fold(0.0, f64::max);
    let model = fit.bench.model;
    let varied = fit.bench.varied.iter().zip(problem.ranges());
    let ranges = varied.map(|(id, [low, high])| {
        if model.parameters[id.index()].dimension != Dimension::LENGTH {
            return [*low, *high];
        }
        // Lengths are some extents, coordinates about as far away as what is given.
        let most = match *low > 0.0 {
            true => SIZES * extent,
            false => far + SIZES / 2.0 * extent,
        };
        let some = [low.max(-most), high.min(most)];
        match some[0] < some[1] {
            true => some,
            false => [*low, *high],
        }
    });
    ranges.collect()
}

/// A design by its place in the unit box: in turns within the bounds and near what is given, there also with sizes even in their ratios.
fn place(problem: &Designs<'_, '_>, unit: &[f64], near: &[[f64; 2]], turn: usize) -> Vec<f64> {
    if turn.is_multiple_of(3) {
        let places = unit.iter().zip(problem.bounds());
        return places
            .map(|(u, [low, high])| low + u * (high - low))
            .collect();
    }
    let places = unit.iter().zip(near);
    let values = places.map(|(u, [low, high])| match turn % 3 == 1 && *low > 0.0 {
        true => low * math::powf(high / low, *u),
        false => low + u * (high - low),
    });
    problem.variables(&values.collect::<Vec<f64>>())
}

/// What has been done, and who hears of it.
struct Work<'h> {
    workers: &'h dyn Workers,
    hears: Hears<'h>,
    done: usize,
    /// So many designs are moved at most.
    most: usize,
    /// So many are left, besides, for showing what is an optimum.
    left: usize,
    best: Option<Descent>,
    stopped: bool,
}

impl Work<'_> {
    fn is_over(&self) -> bool {
        self.stopped || self.done >= self.most
    }

    fn tell(&mut self) {
        let best = self.best.as_ref();
        let told = (self.hears)(&Progress {
            evaluations: self.done,
            budget: self.most.max(self.done),
            best: best.map(|it| (it.design.as_slice(), it.square)),
            violation: best.map_or(f64::INFINITY, |it| it.violation),
        });
        self.stopped |= told.is_break();
    }

    /// The sums of squares of designs that have some, in their order.
    fn looked(&mut self, sums: &Sums<'_, '_, '_>, designs: &[Vec<f64>]) -> Vec<(Vec<f64>, f64)> {
        let squares = each(self.workers, designs.iter().collect(), |design| {
            sums.square(design)
        });
        self.done += designs.len();
        let known = designs.iter().zip(squares);
        let known: Vec<(Vec<f64>, f64, Vec<f64>)> = known
            .filter_map(|(design, it)| it.map(|(square, kept)| (design.clone(), square, kept)))
            .collect();
        if sums.pairing == Pairing::Asked {
            for (design, square, constraints) in &known {
                let keeps = constraints.iter().all(|c| *c <= 0.0);
                let better = |best: &Descent| *square < best.square;
                if keeps && self.best.as_ref().is_none_or(better) {
                    self.best = Some(Descent {
                        design: design.clone(),
                        square: *square,
                        constraints: constraints.clone(),
                        violation: 0.0,
                        settled: false,
                        evaluations: 1,
                        slopes: 0,
                    });
                }
            }
        }
        let both = known.into_iter();
        both.map(|(design, square, _)| (design, square)).collect()
    }

    /// Designs led down so many steps, the best first.
    fn led(&mut self, sums: &Sums<'_, '_, '_>, starts: &[Vec<f64>], steps: usize) -> Vec<Descent> {
        let mut found: Vec<Descent> = Vec::new();
        for some in starts.chunks(AT_ONCE) {
            if self.is_over() {
                break;
            }
            // What is left is for all of them.
            let left = (self.most - self.done).div_ceil(some.len());
            let steps = steps.min(left);
            let workers = self.workers;
            let starts = some.iter().collect();
            let descents = each_heard(workers, starts, &mut || self.tell(), |start| {
                least_squares(sums, start, steps)
            });
            for descent in descents.into_iter().flatten() {
                self.done += descent.evaluations;
                let known = self.best.as_ref();
                let better = known.is_none_or(|best| order(&descent, best).is_lt());
                if sums.pairing == Pairing::Asked && better {
                    self.best = Some(descent.clone());
                }
                found.push(descent);
            }
            self.tell();
        }
        found.sort_by(order);
        found
    }
}

/// Which descent ended better.
fn order(a: &Descent, b: &Descent) -> Ordering {
    let by = missed(a.violation).total_cmp(&missed(b.violation));
    by.then(a.square.total_cmp(&b.square))
}

fn missed(violation: f64) -> f64 {
    if violation > KEPT { violation } else { 0.0 }
}

/// Those of designs in their order that lie apart.
fn apart<'d>(
    designs: impl Iterator<Item = &'d Vec<f64>>,
    bounds: &[[f64; 2]],
    least: f64,
    count: usize,
) -> Vec<Vec<f64>> {
    let mut list: Vec<Vec<f64>> = Vec::new();
    for design in designs {
        if list.len() >= count {
            break;
        }
        let known = list.iter();
        if !known
            .clone()
            .any(|other| distance(other, design, bounds) < least)
        {
            list.push(design.clone());
        }
    }
    list
}

/// The best designs of a fit, and how they were found; `None` where nothing is fitted.
pub(in super::super) fn fitted(
    problem: &Designs<'_, '_>,
    (study, own, own_design): (&OptimizeStudy, Vec<f64>, &str),
    workers: &dyn Workers,
    hears: Hears,
) -> Option<(Optima, String)> {
    let asked = sums(problem, Pairing::Asked)?;
    let n = own.len();
    let alone = is_alone(study);
    let all = study.designs.unwrap_or(MOVED * n).max(1);
    let left = all.div_ceil(SHOWN_OF).min(all - 1);
    let mut work = Work {
        workers,
        hears,
        done: 0,
        most: all - left,
        left,
        best: None,
        stopped: false,
    };
    let (found, looked_at) = descents(&asked, study, &own, all, &mut work);
    // What the ways down left is for showing, too; where the file does not say how many designs there are, it has as many as any descent.
    work.left = match study.designs {
        Some(_) => all.saturating_sub(work.done).max(1),
        None => SHOWN * of_descent(n),
    };
    let how = match alone {
        true => format!("{SQUARES}: downhill from {own_design}"),
        false => format!(
            "{SQUARES}: {looked_at} designs looked at, the best of them and {own_design} led downhill"
        ),
    };
    Some((shown(&asked, found, own, &mut work), how))
}

/// Descents from all over the box, the best first, and how many designs were looked at.
fn descents(
    asked: &Sums<'_, '_, '_>,
    study: &OptimizeStudy,
    own: &[f64],
    all: usize,
    work: &mut Work<'_>,
) -> (Vec<Descent>, usize) {
    let (problem, fit) = (asked.problem, asked.fit);
    if is_alone(study) {
        let start = own.to_vec();
        return (work.led(asked, std::slice::from_ref(&start), STEPS), 0);
    }
    let bounds = problem.bounds();
    // From far away nearest places say little: half of the designs are led by the parts of the curve's length first.
    let leading = sums(problem, Pairing::Leading).filter(|_| fit.is_led());
    let ways: Vec<&Sums<'_, '_, '_>> = leading.iter().chain([asked]).collect();
    let looked_at = (all / LOOKED_AT_OF / ways.len()).max(1);
    let led = (all / FIRST_OF / FIRST_STEPS).max(LED_LEAST);
    let near = near(problem, fit);
    let units = halton(study.seed as u64, looked_at, own.len());
    let designs = units.iter().enumerate();
    let designs: Vec<Vec<f64>> = designs
        .map(|(k, unit)| place(problem, unit, &near, k))
        .collect();
    let mut seen: Vec<Vec<(Vec<f64>, f64)>> = vec![Vec::new(); ways.len()];
    for some in designs.chunks(LOOKED_AT_ONCE) {
        if work.is_over() {
            break;
        }
        for (way, seen) in ways.iter().zip(&mut seen) {
            seen.extend(work.looked(way, some));
        }
        work.tell();
    }
    let mut found: Vec<Descent> = Vec::new();
    for (way, mut seen) in ways.iter().zip(seen) {
        seen.sort_by(|a, b| a.1.total_cmp(&b.1));
        let designs = seen.iter().map(|(design, _)| design);
        let mut starts = vec![own.to_vec()];
        starts.extend(apart(designs, bounds, APART, led / ways.len()));
        if way.pairing == Pairing::Leading {
            let some = work.led(way, &starts, FIRST_STEPS);
            starts = some.into_iter().map(|it| it.design).collect();
        }
        found.extend(work.led(asked, &starts, FIRST_STEPS));
    }
    found.sort_by(order);
    let on = work.most.saturating_sub(work.done) / EACH;
    let designs = found.iter().map(|it| &it.design);
    let starts = apart(designs, bounds, SAME, on.clamp(ON[0], ON[1]));
    found.extend(work.led(asked, &starts, STEPS));
    found.sort_by(order);
    if found.is_empty() {
        found.extend(work.best.clone());
    }
    (found, looked_at)
}

/// Where a descent ended, as an optimum of which nothing else is known.
fn ended(descent: &Descent) -> Optimum {
    let evaluation = Evaluation {
        objectives: vec![descent.square],
        constraints: descent.constraints.clone(),
        lack: 0.0,
    };
    Optimum {
        ended: Ended::Stopped,
        ..plain(descent.design.clone(), evaluation, descent.violation)
    }
}

/// The best of what descents found, shown to be optima or not.
fn shown(
    asked: &Sums<'_, '_, '_>,
    found: Vec<Descent>,
    own: Vec<f64>,
    work: &mut Work<'_>,
) -> Optima {
    let bounds = asked.problem.bounds();
    let designs = found.iter().map(|it| &it.design);
    let mut best = apart(designs, bounds, SAME, SHOWN);
    if best.is_empty() {
        best.push(own);
    }
    let (done, budget) = (work.done, work.most + work.left);
    let mut optima: Vec<(Optimum, usize)> = Vec::new();
    for start in best {
        let same = |design: &[f64]| distance(design, &start, bounds) < SAME;
        let reached = found.iter().filter(|it| same(&it.design)).count().max(1);
        let known = found.iter().find(|it| it.design == start).map(ended);
        if let Some(known) = known.clone().filter(|_| work.stopped) {
            optima.push((known, reached));
            continue;
        }
        let problem = scaled(asked, &start);
        let options = SqpOptions {
            evaluations: work.left.min(of_descent(start.len())),
            ..local()
        };
        let mut optimum = sqp(&problem, &start, &options, work.workers, &mut |told| {
            (work.hears)(&Progress {
                evaluations: done + told.evaluations,
                budget: budget.max(done + told.evaluations),
                ..*told
            })
        });
        work.stopped |= optimum.ended == Ended::Stopped;
        // Where whoever stopped it did so in the middle of its first design, it is what the descent found.
        if let Some(known) = known.filter(|_| !optimum.evaluation.is_defined()) {
            optimum = known;
        }
        work.left = work.left.saturating_sub(optimum.evaluations).max(1);
        let known = optima.iter_mut();
        match known.into_iter().find(|(other, _)| {
            let apart = distance(&other.design, &optimum.design, bounds);
            apart < SAME
        }) {
            Some(known) => known.1 += reached,
            None => optima.push((optimum, reached)),
        }
    }
    optima.sort_by(|(a, _), (b, _)| {
        let undefined = |it: &Optimum| !it.evaluation.is_defined();
        (undefined(a).cmp(&undefined(b)))
            .then(missed(a.violation).total_cmp(&missed(b.violation)))
            .then(a.objective().total_cmp(&b.objective()))
    });
    let (list, reached) = optima.into_iter().unzip();
    Optima {
        list,
        reached,
        stopped: work.stopped,
    }
}

/// The optima to which the squares lead from the best design of another method and from the file's own; `None` where nothing is fitted.
pub(in super::super) fn led(
    problem: &Designs<'_, '_>,
    best: Optima,
    workers: &dyn Workers,
    hears: Hears,
) -> Option<Optima> {
    let asked = sums(problem, Pairing::Asked)?;
    let start = best.list.first()?.design.clone();
    let starts = [start.clone(), problem.begin().0];
    let mut work = Work {
        workers,
        hears,
        done: problem.asked(),
        most: problem.asked() + starts.len() * STEPS,
        left: of_descent(start.len()),
        best: None,
        stopped: best.stopped,
    };
    let found = work.led(&asked, &starts, STEPS);
    if found.is_empty() {
        return Some(best);
    }
    Some(shown(&asked, found, start, &mut work))
}
