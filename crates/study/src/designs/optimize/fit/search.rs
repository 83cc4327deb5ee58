//! Looks for the designs that fit best: many are looked at, the best that lie apart are led down a few steps, the best of these all the way.

use std::ops::ControlFlow;

use kempe_model::{OptimizeMethod, OptimizeStudy};
use kempe_number::math;
use kempe_optimize::{
    Descent, Ended, Even, Hears, Linear, Optima, Optimum, Piece, Problem, Progress, Scales,
    SqpOptions, Squares, least_squares, sqp,
};

use kempe_units::Dimension;

use super::super::pieces::{Wanted, pieces};
use super::super::problem::Designs;
use super::{Fitted, Pairing, SQUARES};

/// Designs that are looked at, for each parameter, where the file does not say.
const LOOKED_AT: usize = 60;
/// Of those looked at one of so many is led down at first, and so many at least.
const LED_OF: usize = 8;
const LED_LEAST: usize = 12;
/// First steps; of those led so far one of so many goes on, and so many at least and at most.
const FIRST_STEPS: usize = 12;
const ON_OF: usize = 5;
const ON: [usize; 2] = [4, 24];
/// Steps all the way down.
const STEPS: usize = 250;
/// So many of the best are shown to be optima, or how far they are from it.
const SHOWN: usize = 3;
/// How many times the extent of what is given lengths may be near it.
const SIZES: f64 = 4.0;
/// Designs nearer to each other than this part of the box are one start, or one optimum.
const APART: f64 = 0.03;
const SAME: f64 = 1e-4;
/// Starts that are led at once, between which is heard whether the work may go on.
const AT_ONCE: usize = 4;

/// A fit as sums of squares.
struct Sums<'p, 'b, 'm> {
    fit: &'p Fitted<'b, 'm>,
    /// What must be kept, behind the goal.
    wanted: &'p [Wanted],
    bounds: &'p [[f64; 2]],
    pairing: Pairing,
}

impl Squares for Sums<'_, '_, '_> {
    fn bounds(&self) -> &[[f64; 2]] {
        self.bounds
    }

    fn square(&self, design: &[f64]) -> Option<(f64, Vec<f64>)> {
        if self.wanted.len() == 1 {
            let seen = self.fit.seen_as(design, self.pairing).ok()?;
            return Some((seen.met.square(), Vec::new()));
        }
        let bench = self.fit.bench;
        let motion = bench.motion(design, &mut kempe_motion::Silent).ok()?;
        let numbers = bench.answer_of(&motion).ok()?.numbers;
        let signed = numbers.iter().zip(self.wanted).map(|(x, w)| w.sign * x);
        let kept: Vec<f64> = signed.skip(1).collect();
        let sound = kept.iter().all(|x| x.is_finite());
        let seen = self.fit.along(&motion, self.pairing).ok()?;
        sound.then_some((seen.met.square(), kept))
    }

    fn linear(&self, design: &[f64]) -> Option<Linear> {
        let mut seen = self.fit.seen_as(design, self.pairing).ok()?;
        let residuals = self.fit.residuals(&mut seen).ok()?;
        let constraints: Vec<Vec<Piece>> = match self.wanted.len() {
            1 => Vec::new(),
            _ => pieces(self.fit.bench, self.wanted, design)
                .ok()?
                .split_off(1),
        };
        Some(Linear {
            residuals,
            constraints,
        })
    }
}

/// What is found of each of some designs, in their order. They are independent of each other: whoever has threads may share them out here.
fn each<T>(designs: &[Vec<f64>], find: impl Fn(&[f64]) -> T) -> Vec<T> {
    designs.iter().map(|design| find(design)).collect()
}

/// The largest difference of two designs, in parts of the box.
fn distance(a: &[f64], b: &[f64], bounds: &[[f64; 2]]) -> f64 {
    let parts = a.iter().zip(b).zip(bounds);
    parts
        .filter(|(_, [low, high])| high > low)
        .map(|((a, b), [low, high])| (a - b).abs() / (high - low))
        .fold(0.0, f64::max)
}

/// Bounds within which lengths are of the size of what is given: nearer to fits than most of a wide box.
fn near(fit: &Fitted<'_, '_>, bounds: &[[f64; 2]]) -> Vec<[f64; 2]> {
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
    let varied = fit.bench.varied.iter().zip(bounds);
    varied
        .map(|(id, [low, high])| {
            if model.parameters[id.index()].dimension != Dimension::LENGTH {
                return [*low, *high];
            }
            // Lengths are some extents, coordinates about as far away as what is given.
            let most = match *low > 0.0 {
                true => SIZES * extent,
                false => far + SIZES / 2.0 * extent,
            };
            let some = [low.max(-most), high.min(most)];
            if some[0] < some[1] {
                some
            } else {
                [*low, *high]
            }
        })
        .collect()
}

/// A design by its place in the unit box: in turns within the bounds and near what is given, there also with sizes even in their ratios.
fn place(unit: &[f64], bounds: &[[f64; 2]], near: &[[f64; 2]], turn: usize) -> Vec<f64> {
    let ends = if turn.is_multiple_of(3) { bounds } else { near };
    let places = unit.iter().zip(ends);
    places
        .map(|(u, [low, high])| match turn % 3 == 1 && *low > 0.0 {
            true => low * math::powf(high / low, *u),
            false => low + u * (high - low),
        })
        .collect()
}

/// What has been done, and who hears of it.
struct Work<'h> {
    hears: Hears<'h>,
    done: usize,
    budget: usize,
    slopes: usize,
    best: Option<Descent>,
}

impl Work<'_> {
    fn tell(&mut self) -> ControlFlow<()> {
        let best = self.best.as_ref();
        (self.hears)(&Progress {
            evaluations: self.done,
            budget: self.budget.max(self.done),
            best: best.map(|it| (it.design.as_slice(), it.square)),
            violation: best.map_or(f64::INFINITY, |it| it.violation),
        })
    }

    /// Designs led down so many steps, the best first; and whether it was stopped.
    fn led(
        &mut self,
        sums: &Sums<'_, '_, '_>,
        starts: &[Vec<f64>],
        steps: usize,
    ) -> (Vec<Descent>, bool) {
        let mut found: Vec<Descent> = Vec::new();
        let mut stopped = false;
        for some in starts.chunks(AT_ONCE) {
            for descent in each(some, |start| least_squares(sums, start, steps)) {
                let Some(descent) = descent else { continue };
                self.done += descent.evaluations;
                self.slopes += descent.slopes;
                let asked = sums.pairing == Pairing::Asked;
                let known = self.best.as_ref();
                if asked && known.is_none_or(|best| is_better(&descent, best)) {
                    self.best = Some(descent.clone());
                }
                found.push(descent);
            }
            if self.tell().is_break() {
                stopped = true;
                break;
            }
        }
        found.sort_by(order);
        (found, stopped)
    }
}

/// Violations below this, in their scale, are none.
const KEPT: f64 = 1e-8;

fn order(a: &Descent, b: &Descent) -> std::cmp::Ordering {
    let missed = |it: &Descent| {
        if it.violation > KEPT {
            it.violation
        } else {
            0.0
        }
    };
    let by = missed(a).total_cmp(&missed(b));
    by.then(a.square.total_cmp(&b.square))
}

fn is_better(a: &Descent, b: &Descent) -> bool {
    order(a, b).is_lt()
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
        if !list
            .iter()
            .any(|other| distance(other, design, bounds) < least)
        {
            list.push(design.clone());
        }
    }
    list
}

/// The best designs of a fit, and how they were found.
pub(in super::super) fn fitted(
    problem: &mut Designs<'_, '_>,
    study: &OptimizeStudy,
    local: &SqpOptions,
    hears: Hears,
) -> (Optima, String) {
    let own = problem.bench.own_values();
    let n = own.len();
    let bounds = problem.bounds().to_vec();
    let alone = study.method == Some(OptimizeMethod::Local);
    let looked_at = match alone {
        true => 0,
        false => study.designs.unwrap_or(LOOKED_AT * n).max(1),
    };
    let led = match alone {
        true => 0,
        false => (looked_at / LED_OF).max(LED_LEAST),
    };
    let on = (led / ON_OF).clamp(ON[0], ON[1]);
    let mut work = Work {
        hears,
        done: 0,
        budget: looked_at + led * FIRST_STEPS + on * STEPS / 4,
        slopes: 0,
        best: None,
    };
    let mut found: Vec<Descent> = Vec::new();
    let mut stopped = false;
    if let Some(fit) = &problem.fit {
        let sums = Sums {
            fit,
            wanted: &problem.wanted,
            bounds: &bounds,
            pairing: Pairing::Asked,
        };
        // From far away nearest places say little: half of the designs are led by the parts of the curve's length first.
        let leading = Sums {
            pairing: Pairing::Leading,
            ..sums
        };
        let ways: &[&Sums<'_, '_, '_>] = match fit.is_free() {
            true => &[&leading, &sums],
            false => &[&sums],
        };
        let near = near(fit, &bounds);
        let mut even = Even::new(n, study.seed as u64);
        let mut seen: Vec<Vec<(Vec<f64>, f64)>> = vec![Vec::new(); ways.len()];
        let mut drawn = 0;
        while drawn < looked_at && !stopped {
            let count = (looked_at - drawn).min(4 * AT_ONCE);
            let some: Vec<Vec<f64>> = (0..count)
                .map(|k| place(&even.point(), &bounds, &near, drawn + k))
                .collect();
            for (way, seen) in ways.iter().zip(&mut seen) {
                let squares = each(&some, |design| way.square(design));
                let known = some.iter().cloned().zip(squares);
                seen.extend(known.filter_map(|(design, it)| Some((design, it?.0))));
                work.done += count;
            }
            drawn += count;
            stopped = work.tell().is_break();
        }
        for (way, mut seen) in ways.iter().zip(seen) {
            seen.sort_by(|a, b| a.1.total_cmp(&b.1));
            let designs = seen.iter().map(|(design, _)| design);
            let mut starts = vec![own.clone()];
            starts.extend(apart(designs, &bounds, APART, led / ways.len()));
            if way.pairing == Pairing::Leading && !stopped {
                let (some, ended) = work.led(&leading, &starts, FIRST_STEPS);
                starts = some.into_iter().map(|it| it.design).collect();
                stopped = ended;
            }
            if !stopped {
                let (some, ended) = work.led(&sums, &starts, FIRST_STEPS);
                found.extend(some);
                stopped = ended;
            }
        }
        found.sort_by(order);
        if !stopped {
            let designs = found.iter().map(|it| &it.design);
            let starts = apart(designs, &bounds, SAME, on);
            let (better, ended) = work.led(&sums, &starts, STEPS);
            stopped = ended;
            found.extend(better);
            found.sort_by(order);
        }
    }
    let designs = found.iter().map(|it| &it.design);
    let best = apart(designs, &bounds, SAME, found.len());
    let reached = best.iter().map(|design| {
        let same = found.iter();
        same.filter(|it| distance(&it.design, design, &bounds) < SAME)
            .count()
    });
    let reached: Vec<usize> = reached.collect();
    problem.asked += work.done;
    problem.sloped += work.slopes;
    let (done, budget) = (work.done, work.budget);
    let size = problem.fit.as_ref().map_or(0.0, size);
    let mut list: Vec<Optimum> = Vec::new();
    let mut starts: Vec<Vec<f64>> = best.into_iter().take(SHOWN).collect();
    if starts.is_empty() {
        starts.push(own);
    }
    for start in starts {
        let options = SqpOptions {
            scales: scales(problem, &start, size),
            ..local.clone()
        };
        let optimum = sqp(problem, &start, &options, &mut |told| match stopped {
            true => ControlFlow::Break(()),
            false => (work.hears)(&Progress {
                evaluations: done + told.evaluations,
                budget: budget.max(done + told.evaluations),
                ..*told
            }),
        });
        stopped |= optimum.ended == Ended::Stopped;
        list.push(optimum);
    }
    let mut optima: Vec<(Optimum, usize)> = Vec::new();
    for (optimum, count) in list.into_iter().zip(reached.into_iter().chain([1])) {
        let same = |other: &&mut (Optimum, usize)| {
            distance(&other.0.design, &optimum.design, &bounds) < SAME
        };
        match optima.iter_mut().find(same) {
            Some(known) => known.1 += count,
            None => optima.push((optimum, count)),
        }
    }
    optima.sort_by(|(a, _), (b, _)| {
        let missed = |it: &Optimum| {
            if it.violation > KEPT {
                it.violation
            } else {
                0.0
            }
        };
        let defined = |it: &Optimum| !it.evaluation.is_defined();
        let by = defined(a)
            .cmp(&defined(b))
            .then(missed(a).total_cmp(&missed(b)));
        by.then(a.objective().total_cmp(&b.objective()))
    });
    let (list, reached) = optima.into_iter().unzip();
    let how = match alone {
        true => format!("{SQUARES}: downhill from the file's own design"),
        false => format!(
            "{SQUARES}: {looked_at} designs looked at, the best of them and the file's own led downhill"
        ),
    };
    let optima = Optima {
        list,
        reached,
        stopped,
    };
    (optima, how)
}

/// The size of what is given.
fn size(fit: &Fitted<'_, '_>) -> f64 {
    let all = fit.given.places.iter().map(super::square);
    all.fold(0.0, f64::max).sqrt()
}

/// A fit that is missed by less than this part of the size of what is given is exact.
const EXACT: f64 = 1e-10;

/// In what an optimum of a fit counts: the product of misses and slopes, so that 1 is a slope along which all of the misses vanishes, whatever the
/// width of the box.
fn scales(problem: &mut Designs<'_, '_>, design: &[f64], size: f64) -> Option<Scales> {
    let slopes = problem.slopes(design)?;
    let square = slopes.objectives.first()?.first()?.value;
    let bounds = problem.bounds();
    let over = |piece: &Piece| {
        let all = piece.slope.iter().zip(bounds);
        let all = all.map(|(d, [low, high])| (d * (high - low)).abs());
        all.fold(0.0, f64::max)
    };
    let fit = problem.fit.as_ref()?;
    let residuals = fit.residuals(&mut fit.seen(design).ok()?).ok()?;
    let longest = (0..design.len()).map(|k| {
        let squares: f64 = residuals.iter().map(|r| r.slope[k] * r.slope[k]).sum();
        squares.sqrt() * (bounds[k][1] - bounds[k][0])
    });
    let longest = longest.fold(0.0, f64::max);
    let constraints = slopes.constraints.iter().map(|pieces| {
        let sizes = pieces.iter().map(|p| over(p).max(p.value.abs()));
        let size = sizes.fold(0.0, f64::max);
        if size > 0.0 { size } else { 1.0 }
    });
    let objective = 2.0 * square.sqrt().max(EXACT * size) * longest;
    Some(Scales {
        objectives: vec![if objective > 0.0 { objective } else { 1.0 }],
        constraints: constraints.collect(),
    })
}

/// The design to which the squares lead down from one; itself where nothing is fitted.
pub(in super::super) fn downhill(problem: &mut Designs<'_, '_>, design: &[f64]) -> Vec<f64> {
    let bounds = problem.bounds().to_vec();
    let Some(fit) = &problem.fit else {
        return design.to_vec();
    };
    let sums = Sums {
        fit,
        wanted: &problem.wanted,
        bounds: &bounds,
        pairing: Pairing::Asked,
    };
    match least_squares(&sums, design, STEPS) {
        Some(found) => {
            problem.asked += found.evaluations;
            problem.sloped += found.slopes;
            found.design
        }
        None => design.to_vec(),
    }
}
