//! The worst case: the least and the greatest that a number comes to where everything may differ as far as its tolerance goes.
//!
//! By conditional gradients (M. Frank and P. Wolfe, Naval Res. Logist. Quart. 3 (1956) 95-110): from a design towards the corner of all tolerances that
//! its derivatives point to, until none is better. Corners are where nearly all worst cases lie. What has no
//! derivative there, or one that points nowhere, is moved by itself to where the file has it and as far as it may go. Where such a way ends at no corner,
//! on a ridge or between the ends, it is led on as an optimum is (`ridge.rs`).

use super::answers::Answers;
use super::ridge::{best_near, is_pole, pieces};
use super::rounding::{ROUNDING, scale_of};
use super::source::Source;
use crate::designs::bench::Bench;
use crate::designs::optimize::least;

/// So many steps from one start; most take two.
const STEPS: usize = 12;
/// Parts of the way to a corner that are tried, one after the other.
const PARTS: [f64; 4] = [1.0, 0.5, 0.2, 0.05];
/// What is better by less than this part is not.
const BETTER: f64 = 1e-12;
/// What a number is nearer to where it cannot go farther than this part of what pieces differ by is rounding, and a place whose derivatives promise no more
/// is held.
const FLOOR: f64 = 1e-9;
/// What is nearer to its own value or an end than this part of its tolerance is tried just there.
const BESIDE: f64 = 1e-6;
/// So many pieces show whether a number differs.
const MANY: usize = 16;
/// So many corners of all tolerances are tried at most, of simulations, which take long, no more than pieces were drawn; and so many places of a grid
/// with the middles.
const CORNERS: usize = 256;
const GRID: usize = 81;

/// The worst case of a number: its least and its greatest value, SI, infinite where it has no bound, and the values of what differs there, or beside it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Worst {
    pub values: [f64; 2],
    pub at: [Vec<f64>; 2],
}

/// The worst cases of numbers.
pub(super) struct Worsts {
    /// By number.
    pub numbers: Vec<Option<Worst>>,
    /// Why a design within the tolerances that was tried does not move.
    pub refused: Option<String>,
}

/// A worst case that is looked for.
#[derive(Clone, Copy)]
struct Goal {
    number: usize,
    /// 1 where it is the greatest, -1 where it is the least.
    sign: f64,
    /// It never goes beyond this, and nearer to it there is rounding.
    end: f64,
    /// What changes it by less than this is rounding.
    rounding: f64,
}

/// A value, and the values of what differs where it is.
type At = (f64, Vec<f64>);

impl Goal {
    fn is_better(&self, value: f64, than: f64) -> bool {
        self.sign * (value - than) > BETTER * than.abs()
    }

    /// Whether a value is as far as it can be.
    fn is_met(&self, value: f64) -> bool {
        self.sign * (value - self.end) >= 0.0
    }

    /// Whether a way promises nothing by the derivatives where it begins.
    fn is_held(&self, slope: &[f64], [from, to]: [&[f64]; 2]) -> bool {
        let steps = from.iter().zip(to).map(|(from, to)| to - from);
        let promised: f64 = slope.iter().zip(steps).map(|(d, step)| d * step).sum();
        self.sign * promised <= self.rounding
    }

    /// The better of two, the first one where they are alike.
    fn better(&self, first: Option<At>, second: Option<At>) -> Option<At> {
        match (first, second) {
            (Some(a), Some(b)) if self.sign * (b.0 - a.0) > 0.0 => Some(b),
            (first, second) => first.or(second),
        }
    }
}

pub(super) struct Search<'s, 'm> {
    bench: &'s Bench<'m>,
    sources: &'s [Source],
    own: &'s [f64],
    answers: Answers<'s, 'm>,
    /// Of the mechanism.
    size: f64,
    /// How many pieces were drawn.
    drawn: usize,
}

impl<'s, 'm> Search<'s, 'm> {
    pub fn new(
        bench: &'s Bench<'m>,
        sources: &'s [Source],
        own: &'s [f64],
        slopes: Vec<&'s [f64]>,
        (size, drawn): (f64, usize),
    ) -> Self {
        Self {
            bench,
            sources,
            own,
            answers: Answers::new(bench, sources, own, slopes),
            size,
            drawn,
        }
    }

    /// The worst cases of as many numbers as there are pieces of each: those with its least and with its greatest value. `goes_on` is asked
    /// before each number.
    pub fn all(
        mut self,
        pieces: &[[Vec<f64>; 2]],
        mut goes_on: impl FnMut(usize) -> bool,
    ) -> Worsts {
        let mut numbers = Vec::new();
        for (number, pieces) in pieces.iter().enumerate() {
            if !goes_on(number) {
                break;
            }
            let worst = self.worst(number, pieces);
            // What was stopped on its way is no worst case.
            if self.bench.watch().stops() {
                break;
            }
            numbers.push(worst);
        }
        numbers.resize(pieces.len(), None);
        Worsts {
            numbers,
            refused: self.answers.refused,
        }
    }

    fn worst(&mut self, number: usize, drawn: &[Vec<f64>; 2]) -> Option<Worst> {
        let [low, high] = drawn.each_ref().map(|piece| self.value(number, piece));
        let spread = low.zip(high).map_or(0.0, |(low, high)| (high - low).abs());
        // What is rounding in all of many pieces has no worst case but theirs.
        let quantity = &self.bench.numbers[number];
        let own = low.map_or(f64::NAN, f64::abs);
        let rounding = ROUNDING * own.max(scale_of(quantity.dimension, self.size));
        let is_rounding = spread <= rounding && self.drawn >= MANY;
        if let (true, Some(low), Some(high)) = (is_rounding, low, high) {
            return Some(Worst {
                values: [low.min(high), low.max(high)],
                at: drawn.clone(),
            });
        }
        let mut found = [-1.0, 1.0].into_iter().zip(drawn).map(|(sign, piece)| {
            let measure = &self.bench.numbers[number].measure;
            let beyond = least(self.bench.mechanism(), measure, -sign);
            let goal = Goal {
                number,
                sign,
                end: -sign * (beyond + FLOOR * spread),
                rounding: FLOOR * spread,
            };
            // The file's own design may lie outside of what its tolerances let be.
            let starts = [self.within(self.own), self.within(piece)];
            let best = self.best_from(goal, None, starts);
            let starts = self.by_pieces(goal);
            let best = self.best_from(goal, best, starts);
            let corners = match self.bench.has_slopes() {
                true => CORNERS,
                false => CORNERS.min(self.drawn),
            };
            match self.is_few(2, corners) {
                true => {
                    let starts = self.of_grid(goal);
                    self.best_from(goal, best, starts)
                }
                false => self.one_by_one(goal, best),
            }
        });
        let (mut low, mut high) = (found.next()??, found.next()??);
        drop(found);
        for (sign, end) in [(-1.0, &mut low), (1.0, &mut high)] {
            if self.has_no_bound(number, sign, end) {
                end.0 = sign * f64::INFINITY;
            }
        }
        Some(Worst {
            values: [low.0, high.0],
            at: [low.1, high.1],
        })
    }

    /// Whether the worst that was found is beside a pole: nearer to it there is worse.
    fn has_no_bound(&mut self, number: usize, sign: f64, worst: &At) -> bool {
        let own = self.within(self.own);
        let about = (self.sources, self.own);
        let usual = self.value(number, &own);
        usual.is_some_and(|usual| is_pole(&self.of(number), about, sign, (worst, usual)))
    }

    /// The best of what is known and of the ends of ways from some starts.
    fn best_from(
        &mut self,
        goal: Goal,
        known: Option<At>,
        starts: impl IntoIterator<Item = Vec<f64>>,
    ) -> Option<At> {
        starts.into_iter().fold(known, |best, start| {
            match best.as_ref().is_some_and(|it| goal.is_met(it.0)) {
                true => best,
                false => goal.better(best, self.walk(goal, start)),
            }
        })
    }

    /// Where else the worst case may lie, by all that a number is the largest of in the file's own design: the best near it, where that makes it better to
    /// lower all of them; else the corners that they point to, of which each may become the largest.
    fn by_pieces(&self, Goal { number, sign, .. }: Goal) -> Vec<Vec<f64>> {
        if !self.bench.has_slopes() {
            return Vec::new();
        }
        let (bench, own) = (self.of(number), self.within(self.own));
        let about = (self.sources, self.own);
        let mut starts = Vec::new();
        if pieces(&bench, about, -sign, &own).len() > 1 {
            starts.extend(best_near(&bench, about, sign, &own));
        }
        for piece in pieces(&bench, about, sign, &own).iter().skip(1) {
            let slope: Vec<f64> = (piece.slope.iter())
                .map(|d| if d.is_finite() { sign * d } else { 0.0 })
                .collect();
            let corner = self.corner(&slope, sign, &own);
            if !starts.contains(&corner) {
                starts.push(corner);
            }
        }
        starts
    }

    /// The ends of all parameters that differ, by where they are among what differs.
    fn ends(&self) -> Vec<(usize, [f64; 2])> {
        let ends = |it: &Source| Some((it.first, it.between(self.own)?));
        self.sources.iter().filter_map(ends).collect()
    }

    /// Whether a grid with so many values of each parameter is no larger than this.
    fn is_few(&self, levels: usize, most: usize) -> bool {
        let count = levels.checked_pow(self.ends().len() as u32);
        count.is_some_and(|count| count <= most)
    }

    /// Where there are too many corners: the best after one parameter after the other went to its other end, until none betters it.
    fn one_by_one(&mut self, goal: Goal, best: Option<At>) -> Option<At> {
        let mut best = best?;
        if !self.bench.has_slopes() {
            return Some(best);
        }
        for _ in 0..STEPS {
            let mut moved = None;
            for (k, ends) in self.ends() {
                for end in ends {
                    let mut values = best.1.clone();
                    values[k] = end;
                    let value = self.value(goal.number, &values);
                    let than = moved.as_ref().map_or(best.0, |(value, _)| *value);
                    if let Some(value) = value.filter(|value| goal.is_better(*value, than)) {
                        moved = Some((value, values));
                    }
                }
            }
            match moved {
                Some((_, values)) => best = self.best_from(goal, Some(best), [values])?,
                None => break,
            }
        }
        Some(best)
    }

    /// The best of the corners of all tolerances, and where these are few of what lies in their middles: all numbers share them.
    fn of_grid(&mut self, goal: Goal) -> Option<Vec<f64>> {
        let ends = self.ends();
        // Simulations at the corners alone.
        let with_middles = self.bench.has_slopes() && self.is_few(3, GRID);
        let own = self.within(self.own);
        let mut all = vec![own.clone()];
        for (k, [low, high]) in &ends {
            let levels = match with_middles {
                true => &[*low, own[*k], *high][..],
                false => &[*low, *high],
            };
            let with = |values: &Vec<f64>, x: f64| {
                let mut values = values.clone();
                values[*k] = x;
                values
            };
            let with = all
                .iter()
                .flat_map(|values| levels.iter().map(move |x| with(values, *x)));
            all = with.collect();
        }
        let known = |values: Vec<f64>| Some((self.value(goal.number, &values)?, values));
        let known: Vec<Option<At>> = all.into_iter().map(known).collect();
        let best = known.into_iter().reduce(|a, b| goal.better(a, b));
        best.flatten().map(|(_, values)| values)
    }

    /// The bench with one number alone.
    fn of(&self, number: usize) -> Bench<'m> {
        let mut bench = self.bench.clone();
        bench.numbers = vec![bench.numbers[number].clone()];
        bench
    }

    /// A piece as far as tolerances go: what is normal may differ by more.
    fn within(&self, piece: &[f64]) -> Vec<f64> {
        let mut values = piece.to_vec();
        for source in self.sources {
            if let Some([low, high]) = source.between(self.own) {
                values[source.first] = values[source.first].clamp(low, high);
            }
        }
        values
    }

    /// The end of a way, and its value.
    fn walk(&mut self, goal: Goal, start: Vec<f64>) -> Option<At> {
        let mut best = (self.value(goal.number, &start)?, start);
        if !goal.is_met(best.0) {
            best = self.descend(goal, best.1)?;
        }
        let mut led = false;
        for _ in 0..STEPS {
            if goal.is_met(best.0) {
                break;
            }
            if let Some(values) = self.beside(goal, &best) {
                best = self.descend(goal, values)?;
            } else if !led && !self.is_held(goal, &best.1) {
                best = self.led_on(goal, best);
                led = true;
            } else {
                break;
            }
        }
        Some(self.tidied(goal, best))
    }

    /// The same with what does not change the number as the file has it, and what lies beside its own value, an end or zero just there.
    fn tidied(&mut self, goal: Goal, best: At) -> At {
        let slope = match self.bench.has_slopes() {
            true => self.slope(goal.number, &best.1),
            false => None,
        };
        let Some(slope) = slope else { return best };
        let own = self.within(self.own);
        let mut values = best.1.clone();
        for source in self.sources {
            if source.slope(&slope) == 0.0 {
                let all = source.first..source.first + source.width();
                all.for_each(|k| values[k] = own[k]);
            } else if let Some([low, high]) = source.between(self.own) {
                let value = &mut values[source.first];
                let near = |to: &f64| (to - *value).abs() <= BESIDE * (high - low);
                let all = [own[source.first], low, high, 0.0_f64.clamp(low, high)];
                *value = all.into_iter().find(near).unwrap_or(*value);
            }
        }
        match self.value(goal.number, &values) {
            Some(value) if !goal.is_better(best.0, value) => (value, values),
            _ => best,
        }
    }

    /// Whether derivatives hold everything where it is, as far as it may go: the corner that they point to is no better by them.
    fn is_held(&mut self, goal: Goal, at: &[f64]) -> bool {
        // Simulations have none, and optima of them take long.
        !self.bench.has_slopes()
            || self.slope(goal.number, at).is_some_and(|slope| {
                let corner = self.corner(&slope, goal.sign, at);
                goal.is_held(&slope, [at, &corner])
            })
    }

    /// The best place near another, where that is better.
    fn led_on(&mut self, goal: Goal, best: At) -> At {
        let bench = self.of(goal.number);
        let found = best_near(&bench, (self.sources, self.own), goal.sign, &best.1);
        let found = found.and_then(|values| Some((self.value(goal.number, &values)?, values)));
        match found {
            Some(found) if goal.is_better(found.0, best.0) => found,
            _ => best,
        }
    }

    /// A design that is better, where one of those differs that derivatives say nothing of.
    fn beside(&mut self, goal: Goal, best: &At) -> Option<Vec<f64>> {
        if !self.bench.has_slopes() {
            return None;
        }
        let slope = self.slope(goal.number, &best.1)?;
        let own = self.within(self.own);
        for source in self.sources {
            let k = source.first;
            // Exactly 0 it is where nothing goes by it.
            let Some([low, high]) = source.between(self.own).filter(|_| slope[k].is_nan()) else {
                continue;
            };
            for to in [own[k], low, high] {
                let mut values = best.1.clone();
                values[k] = to;
                let value = self.value(goal.number, &values);
                if value.is_some_and(|x| goal.is_better(x, best.0)) {
                    return Some(values);
                }
            }
        }
        None
    }

    /// The same by derivatives alone.
    fn descend(&mut self, goal: Goal, start: Vec<f64>) -> Option<At> {
        let mut at = start;
        let mut best = self.value(goal.number, &at)?;
        // Of simulations, which take long, corners alone.
        let parts = match self.bench.has_slopes() {
            true => &PARTS[..],
            false => &PARTS[..1],
        };
        for _ in 0..STEPS {
            let slope = self.slope(goal.number, &at)?;
            let slope: Vec<f64> = (slope.iter())
                .map(|x| if x.is_finite() { *x } else { 0.0 })
                .collect();
            let corner = self.corner(&slope, goal.sign, &at);
            let held = goal.is_held(&slope, [&at, &corner]);
            let towards = |part: &f64| -> Vec<f64> {
                let both = at.iter().zip(&corner);
                // At the corner itself to the last digit.
                both.map(|(a, c)| if *part == 1.0 { *c } else { a + part * (c - a) })
                    .collect()
            };
            let tried: Vec<Vec<f64>> = parts.iter().map(towards).collect();
            let tried = tried.into_iter().find_map(|values| {
                let value = self.value(goal.number, &values)?;
                goal.is_better(value, best).then_some((value, values))
            });
            let Some(better) = tried else { break };
            let gained = (better.0 - best).abs();
            (best, at) = better;
            if held && gained <= goal.rounding {
                break;
            }
        }
        Some((best, at))
    }

    /// Where everything differs as far as it may, as derivatives at a place say; what they do not change stays.
    fn corner(&self, slope: &[f64], sign: f64, from: &[f64]) -> Vec<f64> {
        let mut values = from.to_vec();
        let play = |values: &[f64]| {
            let plays = self.sources.iter().filter_map(|it| Some((it, it.play()?)));
            let parameters = plays.clone().next().map(|_| self.bench.parameters(values));
            let parameters = parameters.unwrap_or_default();
            let sizes = plays.map(|(it, play)| it.slope(slope).abs() * play.at(&parameters));
            sizes.sum::<f64>()
        };
        for source in self.sources {
            let Some(ends) = source.between(self.own) else {
                continue;
            };
            let k = source.first;
            let [low, high] = ends.map(|end| {
                let mut there = from.to_vec();
                there[k] = end;
                (sign * slope[k] * there[k] + play(&there), there[k])
            });
            if low.0 != high.0 {
                values[k] = if low.0 > high.0 { low.1 } else { high.1 };
            }
        }
        let parameters = self.bench.parameters(&values);
        for source in self.sources {
            let Some(play) = source.play().map(|it| it.at(&parameters)) else {
                continue;
            };
            let size = source.slope(slope);
            for k in source.first..source.first + source.width() {
                if size != 0.0 {
                    values[k] = self.own[k] + sign * play * slope[k] / size.abs();
                }
            }
        }
        values
    }

    fn value(&mut self, number: usize, values: &[f64]) -> Option<f64> {
        self.answers.value(number, values)
    }

    fn slope(&mut self, number: usize, values: &[f64]) -> Option<Vec<f64>> {
        self.answers.slope(number, values)
    }
}
