//! What designs within tolerances answer: numbers and their derivatives, each asked once.

use std::collections::{HashMap, VecDeque};
use std::sync::Arc;

use kempe_measure::Held;
use kempe_motion::Motion;

use super::source::Source;
use crate::designs::bench::{Bench, Refused};

/// A derivative that changes a number by less than this part of what the largest does, over what may differ, points nowhere.
const POINTS: f64 = 1e-6;
/// Motions that are kept, the last ones: derivatives are asked where values were asked just before.
const KEPT: usize = 4;

/// What differs, by its bits.
type Key = Vec<u64>;

pub(super) struct Answers<'s, 'm> {
    bench: &'s Bench<'m>,
    sources: &'s [Source],
    own: &'s [f64],
    /// The derivatives of the file's own design, by number.
    own_slopes: Vec<&'s [f64]>,
    /// All numbers of designs; none of those that do not move.
    values: HashMap<Key, Option<Vec<f64>>>,
    /// Derivatives of numbers.
    slopes: HashMap<(usize, Key), Option<Vec<f64>>>,
    motions: VecDeque<(Key, Arc<Motion>)>,
    /// Why a design does not move, the first one.
    pub refused: Option<String>,
}

impl<'s, 'm> Answers<'s, 'm> {
    pub fn new(
        bench: &'s Bench<'m>,
        sources: &'s [Source],
        own: &'s [f64],
        own_slopes: Vec<&'s [f64]>,
    ) -> Self {
        Self {
            bench,
            sources,
            own,
            own_slopes,
            values: HashMap::new(),
            slopes: HashMap::new(),
            motions: VecDeque::new(),
            refused: None,
        }
    }

    /// A number of a design, SI.
    pub fn value(&mut self, number: usize, values: &[f64]) -> Option<f64> {
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
    pub fn slope(&mut self, number: usize, values: &[f64]) -> Option<Vec<f64>> {
        if !self.bench.has_slopes() || values == self.own {
            return self.own_slopes.get(number).map(|own| self.pointing(own));
        }
        let key = (number, key(values));
        if !self.slopes.contains_key(&key) {
            let found = (self.motion(values)).and_then(|motion| {
                let measure = &self.bench.numbers[number].measure;
                let held = [Held::Path(motion.start)];
                let found = (self.bench).two_sided_sensitivities(&motion, &held, &[measure]);
                self.heard(found)?.pop()?.derivatives.pop()
            });
            self.slopes.insert(key.clone(), found);
        }
        let slope = self.slopes[&key].as_ref()?;
        Some(self.pointing(slope))
    }

    /// Derivatives to what differs without those that point nowhere.
    fn pointing(&self, slope: &[f64]) -> Vec<f64> {
        let mut slope = slope.to_vec();
        let width = |source: &Source| {
            let [low, high] = source.between(self.own)?;
            Some((source.first, high - low))
        };
        let parameters: Vec<(usize, f64)> = self.sources.iter().filter_map(width).collect();
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
