//! The worst case: the least and the greatest that a number comes to where everything may differ as far as its tolerance goes.
//!
//! By conditional gradients (M. Frank and P. Wolfe, Naval Res. Logist. Quart. 3 (1956) 95-110): from a design towards the corner of all tolerances that
//! its derivatives point to, until none is better. Corners are where nearly all worst cases lie. What has no
//! derivative there, or one that points nowhere, is moved by itself to where the file has it and as far as it may go. Where such a way ends at no corner,
//! on a ridge or between the ends, it is led on as an optimum is (`ridge.rs`).

use std::collections::{HashMap, VecDeque};
use std::sync::Arc;

use kempe_measure::Held;
use kempe_motion::Motion;

use super::ridge::{best_near, pieces};
use super::source::{Kind, Source};
use crate::designs::bench::{Bench, Refused};
use crate::designs::optimize::least;

/// So many steps from one start; most take two.
const STEPS: usize = 12;
/// Parts of the way to a corner that are tried, one after the other.
const PARTS: [f64; 4] = [1.0, 0.5, 0.2, 0.05];
/// What is better by less than this part is not.
const BETTER: f64 = 1e-12;
/// A derivative that changes a number by less than this part of what the largest does, over what may differ, points nowhere.
const POINTS: f64 = 1e-6;
/// What a number is nearer to where it cannot go farther than this part of what pieces differ by is rounding.
const FLOOR: f64 = 1e-9;
/// What is nearer to its own value or an end than this part of its tolerance is tried just there.
const BESIDE: f64 = 1e-6;
/// So many designs of a grid over the tolerances are tried at most.
const GRID: usize = 81;
/// Motions that are kept, the last ones: derivatives are asked where values were asked just before.
const KEPT: usize = 4;

/// The worst case of a number: its least and its greatest value, SI, and the values of what differs there.
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

/// What differs, by its bits.
type Key = Vec<u64>;

pub(super) struct Search<'s, 'm> {
    bench: &'s Bench<'m>,
    sources: &'s [Source],
    own: &'s [f64],
    /// The derivatives of the file's own design, by number.
    slopes: Vec<&'s [f64]>,
    /// All numbers of designs; none of those that do not move.
    values: HashMap<Key, Option<Vec<f64>>>,
    /// Derivatives of numbers.
    known_slopes: HashMap<(usize, Key), Option<Vec<f64>>>,
    motions: VecDeque<(Key, Arc<Motion>)>,
    refused: Option<String>,
}

impl<'s, 'm> Search<'s, 'm> {
    pub fn new(
        bench: &'s Bench<'m>,
        sources: &'s [Source],
        own: &'s [f64],
        slopes: Vec<&'s [f64]>,
    ) -> Self {
        Self {
            bench,
            sources,
            own,
            slopes,
            values: HashMap::new(),
            known_slopes: HashMap::new(),
            motions: VecDeque::new(),
            refused: None,
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
            refused: self.refused,
        }
    }

    fn worst(&mut self, number: usize, drawn: &[Vec<f64>; 2]) -> Option<Worst> {
        let spread = {
            let [low, high] = drawn.each_ref().map(|piece| self.value(number, piece));
            low.zip(high).map_or(0.0, |(low, high)| (high - low).abs())
        };
        let mut found = [-1.0, 1.0].into_iter().zip(drawn).map(|(sign, piece)| {
            let measure = &self.bench.numbers[number].measure;
            // Never beyond this, and nearer to it there is rounding.
            let beyond = least(self.bench.mechanism(), measure, -sign);
            let end = -sign * (beyond + FLOOR * spread);
            let mut best: Option<(f64, Vec<f64>)> = None;
            let mut take = |it: &mut Self, start: Vec<f64>| {
                let reaches = |it: &(f64, _)| sign * (it.0 - end) >= 0.0;
                if !best.as_ref().is_some_and(reaches) {
                    let found = it.walk((number, sign, end), start);
                    let worse = best.take();
                    let all = worse.into_iter().chain(found);
                    best = all.max_by(|a, b| (sign * a.0).total_cmp(&(sign * b.0)));
                }
            };
            // The file's own design may lie outside of what its tolerances let be.
            take(self, self.within(self.own));
            take(self, self.within(piece));
            for start in self.by_pieces(number, sign) {
                take(self, start);
            }
            if let Some(start) = self.of_grid(number, sign) {
                take(self, start);
            }
            best
        });
        let (low, high) = (found.next()??, found.next()??);
        Some(Worst {
            values: [low.0, high.0],
            at: [low.1, high.1],
        })
    }

    /// Where else the worst case may lie, by all that a number is the largest of in the file's own design: the best near it, where that makes it better to
    /// lower all of them; else the corners that they point to, of which each may become the largest.
    fn by_pieces(&mut self, number: usize, sign: f64) -> Vec<Vec<f64>> {
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

    /// The best of the corners of all tolerances, and of what lies in their middles, where these are few: all numbers share them.
    fn of_grid(&mut self, number: usize, sign: f64) -> Option<Vec<f64>> {
        if !self.bench.has_slopes() {
            return None;
        }
        let mut all = vec![self.within(self.own)];
        let own = all[0].clone();
        let ends = self.sources.iter().filter_map(|source| match &source.kind {
            Kind::Parameter(it) => {
                Some((source.first, it.ends.map(|x| self.own[source.first] + x)))
            }
            _ => None,
        });
        let ends: Vec<(usize, [f64; 2])> = ends.collect();
        let differ = ends.len() as u32;
        let is_few = |levels: usize| {
            let count = levels.checked_pow(differ);
            count.is_some_and(|count| count <= GRID)
        };
        if !is_few(2) {
            return None;
        }
        for (k, [low, high]) in ends {
            let levels = match is_few(3) {
                true => vec![low, own[k], high],
                false => vec![low, high],
            };
            let with = all.iter().flat_map(|values| {
                levels.iter().map(move |x| {
                    let mut values = values.clone();
                    values[k] = *x;
                    values
                })
            });
            all = with.collect();
        }
        let mut best: Option<(f64, Vec<f64>)> = None;
        // That one of these does not move says nothing of the worst case.
        let refused = self.refused.clone();
        for values in all {
            let Some(value) = self.value(number, &values) else {
                continue;
            };
            let known = best.as_ref();
            if known.is_none_or(|best| sign * (value - best.0) > 0.0) {
                best = Some((value, values));
            }
        }
        self.refused = refused;
        best.map(|(_, values)| values)
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
            if let Kind::Parameter(deviation) = &source.kind {
                let [low, high] = deviation.ends.map(|end| self.own[source.first] + end);
                values[source.first] = values[source.first].clamp(low, high);
            }
        }
        values
    }

    /// The value at the end of a way up, or down where `sign` is negative, and where that is; none goes beyond `end`.
    fn walk(
        &mut self,
        (number, sign, end): (usize, f64, f64),
        start: Vec<f64>,
    ) -> Option<(f64, Vec<f64>)> {
        let reaches = |it: &(f64, Vec<f64>)| sign * (it.0 - end) >= 0.0;
        let mut best = (self.value(number, &start)?, start);
        if !reaches(&best) {
            best = self.descend(number, sign, best.1)?;
        }
        let mut led = false;
        for _ in 0..STEPS {
            if reaches(&best) {
                break;
            }
            if let Some(values) = self.beside(number, sign, &best) {
                best = self.descend(number, sign, values)?;
            } else if !led && sign * (best.0 - end) < 0.0 && !self.is_corner(number, sign, &best.1)
            {
                best = self.led_on(number, sign, best);
                led = true;
            } else {
                break;
            }
        }
        Some(self.tidied(number, sign, best))
    }

    /// The same with what does not change the number as the file has it, and what lies beside its own value, an end or zero just there.
    fn tidied(&mut self, number: usize, sign: f64, best: (f64, Vec<f64>)) -> (f64, Vec<f64>) {
        let slope = match self.bench.has_slopes() {
            true => self.slope(number, &best.1),
            false => None,
        };
        let Some(slope) = slope else { return best };
        let mut values = best.1.clone();
        for source in self.sources {
            let k = source.first;
            let idle = source.slope(&slope) == 0.0;
            let Kind::Parameter(deviation) = &source.kind else {
                let all = k..k + source.width();
                all.filter(|_| idle).for_each(|k| values[k] = self.own[k]);
                continue;
            };
            let ends = deviation.ends.map(|end| self.own[k] + end);
            let own = self.own[k].clamp(ends[0], ends[1]);
            let near = |to: &f64| (to - values[k]).abs() <= BESIDE * (ends[1] - ends[0]);
            let zero = 0.0_f64.clamp(ends[0], ends[1]);
            let beside = [own, ends[0], ends[1], zero].into_iter().find(near);
            values[k] = match idle {
                true => own,
                false => beside.unwrap_or(values[k]),
            };
        }
        match self.value(number, &values) {
            Some(value) if sign * (value - best.0) >= -BETTER * best.0.abs() => (value, values),
            _ => best,
        }
    }

    /// Whether derivatives hold everything where it is, as far as it may go.
    fn is_corner(&mut self, number: usize, sign: f64, at: &[f64]) -> bool {
        // Simulations have none, and optima of them take long.
        !self.bench.has_slopes()
            || self.slope(number, at).is_some_and(|slope| {
                let known = slope.iter().all(|x| x.is_finite());
                known && self.corner(&slope, sign, at) == at
            })
    }

    /// The best place near another, where that is better.
    fn led_on(&mut self, number: usize, sign: f64, best: (f64, Vec<f64>)) -> (f64, Vec<f64>) {
        let bench = self.of(number);
        let found = best_near(&bench, (self.sources, self.own), sign, &best.1);
        let found = found.and_then(|values| Some((self.value(number, &values)?, values)));
        match found {
            Some(found) if sign * (found.0 - best.0) > BETTER * best.0.abs() => found,
            _ => best,
        }
    }

    /// A design that is better, where one of those differs that derivatives say nothing of.
    fn beside(&mut self, number: usize, sign: f64, best: &(f64, Vec<f64>)) -> Option<Vec<f64>> {
        if !self.bench.has_slopes() {
            return None;
        }
        let slope = self.slope(number, &best.1)?;
        for source in self.sources {
            let (k, Kind::Parameter(deviation)) = (source.first, &source.kind) else {
                continue;
            };
            // Exactly 0 it is where nothing goes by it.
            if !slope[k].is_nan() {
                continue;
            }
            let ends = deviation.ends.map(|end| self.own[k] + end);
            let own = self.own[k].clamp(ends[0], ends[1]);
            for to in [own, ends[0], ends[1]] {
                let mut values = best.1.clone();
                values[k] = to;
                let value = self.value(number, &values);
                if value.is_some_and(|x| sign * (x - best.0) > BETTER * best.0.abs()) {
                    return Some(values);
                }
            }
        }
        None
    }

    /// The same by derivatives alone.
    fn descend(&mut self, number: usize, sign: f64, start: Vec<f64>) -> Option<(f64, Vec<f64>)> {
        let mut at = start;
        let mut best = self.value(number, &at)?;
        // Of simulations, which take long, corners alone.
        let parts = match self.bench.has_slopes() {
            true => &PARTS[..],
            false => &PARTS[..1],
        };
        for _ in 0..STEPS {
            let slope = self.slope(number, &at)?;
            let slope: Vec<f64> = (slope.iter())
                .map(|x| if x.is_finite() { *x } else { 0.0 })
                .collect();
            let corner = self.corner(&slope, sign, &at);
            let towards = |part: &f64| -> Vec<f64> {
                let both = at.iter().zip(&corner);
                // At the corner itself to the last digit.
                both.map(|(a, c)| if *part == 1.0 { *c } else { a + part * (c - a) })
                    .collect()
            };
            let tried: Vec<Vec<f64>> = parts.iter().map(towards).collect();
            let tried = tried.into_iter().find_map(|values| {
                let value = self.value(number, &values)?;
                let better = sign * (value - best) > BETTER * best.abs();
                better.then_some((value, values))
            });
            match tried {
                Some(better) => (best, at) = better,
                None => break,
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
            let Kind::Parameter(deviation) = &source.kind else {
                continue;
            };
            let k = source.first;
            let [low, high] = deviation.ends.map(|end| {
                let mut there = from.to_vec();
                there[k] = self.own[k] + end;
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
        let key = key(values);
        if !self.values.contains_key(&key) {
            let found = (self.motion(values)).and_then(|motion| {
                let found = self.bench.answer_of(&motion);
                self.heard(found.map(|answer| answer.numbers))
            });
            self.values.insert(key.clone(), found);
        }
        let value = *self.values[&key].as_ref()?.get(number)?;
        value.is_finite().then_some(value)
    }

    /// The derivatives of a number at a design; not a number where there is none, or where it points nowhere.
    fn slope(&mut self, number: usize, values: &[f64]) -> Option<Vec<f64>> {
        if !self.bench.has_slopes() || values == self.own {
            return self.slopes.get(number).map(|own| self.pointing(own));
        }
        let key = (number, key(values));
        if !self.known_slopes.contains_key(&key) {
            let found = (self.motion(values)).and_then(|motion| {
                let measure = &self.bench.numbers[number].measure;
                let held = [Held::Path(motion.start)];
                let found = (self.bench).two_sided_sensitivities(&motion, &held, &[measure]);
                self.heard(found)?.pop()?.derivatives.pop()
            });
            self.known_slopes.insert(key.clone(), found);
        }
        let slope = self.known_slopes[&key].as_ref()?;
        Some(self.pointing(slope))
    }

    /// Derivatives to what differs without those that point nowhere.
    fn pointing(&self, slope: &[f64]) -> Vec<f64> {
        let mut slope = slope.to_vec();
        let parameter = |source: &Source| match &source.kind {
            Kind::Parameter(deviation) => {
                Some((source.first, deviation.ends[1] - deviation.ends[0]))
            }
            _ => None,
        };
        let parameters: Vec<(usize, f64)> = self.sources.iter().filter_map(parameter).collect();
        let changes = parameters
            .iter()
            .map(|(k, width)| (slope[*k] * width).abs());
        let most = changes.filter(|x| x.is_finite()).fold(0.0, f64::max);
        for (k, width) in parameters {
            let change = (slope[k] * width).abs();
            if !change.is_finite() || change != 0.0 && change <= POINTS * most {
                slope[k] = f64::NAN;
            }
        }
        slope
    }

    /// How a design moves.
    fn motion(&mut self, values: &[f64]) -> Option<Arc<Motion>> {
        let key = key(values);
        if let Some((_, known)) = self.motions.iter().find(|(of, _)| *of == key) {
            return Some(known.clone());
        }
        let found = self.bench.motion(values, &mut self.bench.watch());
        let motion = self.heard(found)?;
        if self.motions.len() == KEPT {
            self.motions.pop_front();
        }
        self.motions.push_back((key, motion.clone()));
        Some(motion)
    }

    /// What a design answers; why it does not is kept.
    fn heard<T>(&mut self, found: Result<T, Refused>) -> Option<T> {
        let why = match found {
            Ok(found) => return Some(found),
            Err(why) => why,
        };
        // What was stopped tells nothing.
        if why.lack.is_finite() {
            self.refused.get_or_insert(why.why);
        }
        None
    }
}

fn key(values: &[f64]) -> Key {
    values.iter().map(|x| x.to_bits()).collect()
}
