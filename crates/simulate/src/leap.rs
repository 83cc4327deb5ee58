//! Across a change point where several coordinates move.
//!
//! Right at a change point no coordinates tell how the mechanism goes on: two of its branches cross there, and the rank of its loops
//! falls; beside it rounding grows without bound. But the mechanism has speeds and goes on smoothly, on the branch that its bodies come to
//! as they move. So one step is made across, by collocation: its rates are the polynomial of time that they are in places on both sides,
//! none of them near the change point. What the step before it goes on to is the guess, and tells the branch behind.

use kempe_integrate::Tolerance;
use kempe_mechanism::pose::Pose;
use kempe_number::{math, polynomial_through, powi};

use crate::plant::Plant;
use crate::step::Step;

/// Such a step is tried where the change point is no farther off than so many steps; where it is not good enough, and from so many steps
/// off, steps come no nearer than half the way at once.
const NEAR: f64 = 1.5;
const AHEAD: f64 = 3.0;
/// A shorter step makes the usual one shorter by this part, and by no more than so many times its own: those of rounding, of which there are ever so
/// many, hardly do.
const SHORTER: [f64; 2] = [0.05, 60.0];
/// How determinants change is seen within such a part of a step.
const JUST: f64 = 1e-3;
/// Where rates are looked at, in parts of the way to the change point, which is at 0: on both sides of it, or, where it begins so near
/// that rounding spoils what is on its own side, behind, in parts of a longer way. What is recorded of it at its quarters does not fall
/// upon the change point.
const BOTH_SIDES: &[f64] = &[-1.0, -0.9, -0.74, -0.54, 0.54, 0.76, 1.0, LAST];
const BEHIND: &[f64] = &[0.3, 0.4, 0.57, 0.83, 1.08, LAST];
/// Where the branch behind is told.
const BRANCH: f64 = 0.54;
const LAST: f64 = 1.2;
/// Such a longer way is so many times a usual step at most, and halved so often at most until it serves.
const LONGEST: f64 = 2.0;
const HALVINGS: i32 = 10;
/// Where rates on both sides are held against the polynomial.
const BETWEEN: [f64; 2] = [-0.35, 0.35];
/// What rates there may differ by, over the whole way, in tolerances and in parts of what is followed.
const TOLERANCES: f64 = 100.0;
const SAME: f64 = 1e-10;
/// The same where ties close loops: more rates, of links whose rounding is more near the change point.
const SAME_TIED: f64 = 3e-10;
/// Where it is not to be had so well after so many attempts in a row, ten times as much is allowed, and again after as many more.
const ATTEMPTS: usize = 15;
const MOST_OFTEN: usize = 4;
/// Polynomials without the last place are off by so many times as much as those with it, and more.
const WITH_LAST: f64 = 10.0;
/// Most rounds of collocation, and by what part of what is followed the last may change it.
const ROUNDS: usize = 30;
const SETTLED: f64 = 1e-13;
/// Places of the step before, equal parts of it, by which it goes on; unless that is so many times shorter than the way.
const BEFORE: usize = 7;
const FAR: f64 = 3.0;
/// Bodies that come to be elsewhere by more than this part of how far any moves across are on another branch.
const ELSEWHERE: f64 = 0.1;

/// What is ahead of the end of a step.
pub(crate) enum Ahead {
    /// Nothing so near that the next step has to know of it.
    Nothing,
    /// A change point, to which the next step comes no nearer than at this time, s.
    Slowly(f64),
    /// A change point at this time, s, across which a step is to be tried; if it is not good, the next goes until the other.
    Leap { at: f64, until: f64 },
}

/// How it comes to change points.
pub(crate) struct Approach {
    /// How long steps are, s: shorter ones near a change point are those of rounding.
    usual: f64,
    /// Steps across in a row that were not good.
    refused: usize,
    /// Those that were.
    pub made: Across,
}

/// Steps across change points.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Across {
    /// How many there were.
    pub steps: usize,
    /// By how much their rates are off at worst where they were held against them, over the whole step and in parts of what moves.
    pub off: f64,
}

impl Approach {
    /// Where steps are about so long, s.
    pub fn new(usual: f64) -> Self {
        Self {
            usual,
            refused: 0,
            made: Across::default(),
        }
    }

    /// What is ahead of the end of the step last made, where the plant took its state last.
    pub fn ahead(&mut self, step: &dyn Step, plant: &mut Plant) -> Ahead {
        let (time, long) = (step.time(), step.time() - step.before());
        let way = plant.meets_in(time, JUST * long);
        let [of_usual, of_own] = SHORTER;
        let shorter = (of_usual * self.usual).min(of_own * long);
        self.usual = long.max(self.usual - shorter);
        let Some(way) = way.filter(|way| *way <= AHEAD * self.usual) else {
            self.refused = 0;
            return Ahead::Nothing;
        };
        let until = time + 0.5 * way;
        match way <= NEAR * self.usual {
            true => Ahead::Leap {
                at: time + way,
                until,
            },
            false => Ahead::Slowly(until),
        }
    }

    /// A step from the end of another on, across the change point to which the mechanism comes at a time, but not beyond `end`. None where it
    /// cannot be seen how it goes on, or not well enough.
    pub fn leap(
        &mut self,
        step: &mut dyn Step,
        plant: &mut Plant,
        [at, end]: [f64; 2],
        tolerance: &Tolerance,
    ) -> Option<Leap> {
        if plant.mode.stuck {
            return None;
        }
        let more = (self.refused / ATTEMPTS).min(MOST_OFTEN);
        let same = match plant.ties {
            None => SAME,
            Some(_) => SAME_TIED,
        };
        let allowed = same.max(TOLERANCES * tolerance.relative) * powi(10.0, more as i32);
        let way = at - step.time();
        let longer = (0..HALVINGS).map(|k| LONGEST * self.usual * powi(0.5, k));
        let longer = longer.take_while(|unit| *unit >= LONGEST * way);
        let longer = longer.map(|unit| (unit, BEHIND));
        let found = std::iter::once((way, BOTH_SIDES))
            .chain(longer)
            .find_map(|(unit, places)| {
                let mut it = Leap::without_rates(step, [at, unit], places, tolerance);
                if it.time_of(LAST) > end {
                    return None;
                }
                let across = it.across(step, plant, allowed);
                if across.is_none() {
                    plant.places.stay_on_branch();
                }
                across.map(|()| it)
            });
        match &found {
            Some(leap) => {
                self.refused = 0;
                self.made.steps += 1;
                self.made.off = self.made.off.max(leap.off);
            }
            None => {
                self.refused += 1;
                // How friction is looked at hangs on what was looked at last.
                plant.accelerate(
                    step.time(),
                    step.state(),
                    &mut vec![0.0; step.state().len()],
                );
            }
        }
        found
    }
}

/// A step across a change point.
pub(crate) struct Leap {
    from: f64,
    at: f64,
    /// What places are parts of, s, and those at which rates are looked at.
    unit: f64,
    places: &'static [f64],
    begin: Vec<f64>,
    /// Rates as polynomials of the place.
    rates: Vec<Vec<f64>>,
    /// State and rates at its end.
    state: Vec<f64>,
    end: Vec<f64>,
    /// By how much its rates are off where they were held against the polynomials.
    off: f64,
    /// How large what is followed is at least, where it is not: errors are parts of that.
    least: Vec<f64>,
}

impl Leap {
    /// From the end of a step on; its rates are not known yet.
    fn without_rates(
        step: &dyn Step,
        [at, unit]: [f64; 2],
        places: &'static [f64],
        tolerance: &Tolerance,
    ) -> Self {
        let size = step.state().len();
        let absolute = tolerance.absolute.iter();
        Self {
            from: step.time(),
            at,
            unit,
            places,
            begin: step.state().to_vec(),
            rates: vec![vec![0.0; places.len()]; size],
            state: vec![0.0; size],
            end: vec![0.0; size],
            off: 0.0,
            least: absolute.map(|a| a / tolerance.relative).collect(),
        }
    }

    fn across(&mut self, step: &mut dyn Step, plant: &mut Plant, allowed: f64) -> Option<()> {
        let guess = Guess::by(step, plant, self.unit)?;
        let guessed: Vec<Vec<f64>> = (self.places.iter())
            .map(|s| guess.rates(self.time_of(*s)))
            .collect();
        self.take(|place, k| guessed[place][k]);
        let behind = self.time_of(BRANCH);
        self.state_at(behind);
        plant.take(behind, &self.state);
        let (poses, angles) = guess.poses(behind);
        let off = (plant.places).branch_on(self.at, &poses, &angles, &plant.coordinates)?;
        let size = plant.forces.design.size();
        let moved = |(a, b): (&Pose<f64>, &Pose<f64>)| a.apart(b, size);
        let before = guess.poses(self.from).0;
        let farthest = poses.iter().zip(&before).map(moved).fold(0.0, f64::max);
        if !(off <= ELSEWHERE * farthest) {
            return None;
        }
        self.collocate(step.rates(), plant, allowed)?;
        self.is_good(plant, allowed).then_some(())
    }

    /// Lets the polynomials be what the rates are in all places along them.
    fn collocate(&mut self, first: &[f64], plant: &mut Plant, allowed: f64) -> Option<()> {
        let places = self.places;
        let mut all = vec![first.to_vec(); places.len()];
        // The rates at the beginning are known.
        let known = usize::from(places[0] == -1.0);
        let mut last = f64::INFINITY;
        for _ in 0..ROUNDS {
            let mut change = 0.0_f64;
            for (place, s) in places.iter().enumerate().skip(known) {
                self.state_at(self.time_of(*s));
                if !plant.accelerate(self.time_of(*s), &self.state, &mut all[place]) {
                    return None;
                }
                change = math::max(change, self.off(*s, &all[place]));
            }
            self.take(|place, k| all[place][k]);
            if change <= SETTLED || (change >= 0.5 * last && change <= allowed) {
                let end = self.time_of(LAST);
                self.state_at(end);
                self.end.clone_from(&all[places.len() - 1]);
                return Some(());
            }
            last = change;
        }
        None
    }

    /// Whether rates between the places are as the polynomials say.
    fn is_good(&mut self, plant: &mut Plant, allowed: f64) -> bool {
        if self.places[0] > 0.0 {
            self.off = self.off_without_last() / WITH_LAST;
            return self.off <= allowed;
        }
        let end = self.state.clone();
        let mut rates = vec![0.0; end.len()];
        let good = BETWEEN.iter().all(|s| {
            self.state_at(self.time_of(*s));
            let known = plant.accelerate(self.time_of(*s), &self.state, &mut rates);
            self.off = math::max(self.off, self.off(*s, &rates));
            known && self.off <= allowed
        });
        self.state = end;
        good
    }

    /// How much the polynomials are off, at a place where the rates are these and the state is known, over the whole way and in parts of what
    /// is followed.
    fn off(&self, s: f64, rates: &[f64]) -> f64 {
        let long = self.time_of(LAST) - self.from;
        let sizes = self.state.iter().zip(&self.least);
        let sizes = sizes.map(|(value, least)| value.abs().max(*least) / long);
        let parts = rates.iter().zip(&self.rates).zip(sizes);
        let parts = parts.map(|((rate, powers), size)| {
            // Nothing is held to what has no bound, such as the work.
            match size.is_infinite() {
                true => 0.0,
                false => (rate - at(powers, s)).abs() / rate.abs().max(size),
            }
        });
        parts.fold(0.0, math::max)
    }

    /// The same where it begins, of the polynomials that go through all places but the last.
    fn off_without_last(&mut self) -> f64 {
        let s = (self.from - self.at) / self.unit;
        let state = std::mem::replace(&mut self.state, self.begin.clone());
        let places = &self.places[..self.places.len() - 1];
        let fewer = self.rates.iter().map(|powers| {
            let mut values: Vec<f64> = places.iter().map(|place| at(powers, *place)).collect();
            polynomial_through(places, &mut values);
            at(&values, s)
        });
        let off = self.off(s, &fewer.collect::<Vec<f64>>());
        self.state = state;
        off
    }

    /// Takes the polynomials through the rates by place and what is followed.
    fn take(&mut self, rate: impl Fn(usize, usize) -> f64) {
        for (k, powers) in self.rates.iter_mut().enumerate() {
            for (place, value) in powers.iter_mut().enumerate() {
                *value = rate(place, k);
            }
            polynomial_through(self.places, powers);
        }
    }

    fn time_of(&self, s: f64) -> f64 {
        self.at + s * self.unit
    }

    /// Finds the state at a time.
    fn state_at(&mut self, time: f64) {
        let mut state = std::mem::take(&mut self.state);
        self.state_into(time, &mut state);
        self.state = state;
    }

    fn state_into(&self, time: f64, state: &mut [f64]) {
        let [from, s] = [self.from, time].map(|time| (time - self.at) / self.unit);
        for ((value, begin), powers) in state.iter_mut().zip(&self.begin).zip(&self.rates) {
            *value = begin + self.unit * (integral(powers, s) - integral(powers, from));
        }
    }
}

impl Step for Leap {
    fn before(&self) -> f64 {
        self.from
    }

    fn time(&self) -> f64 {
        self.time_of(LAST)
    }

    fn state(&self) -> &[f64] {
        &self.state
    }

    fn rates(&self) -> &[f64] {
        &self.end
    }

    fn between(&mut self, _: &mut Plant, time: f64, state: &mut [f64]) -> bool {
        self.state_into(time, state);
        true
    }

    fn slopes(&self, time: f64, rates: &mut [f64]) -> bool {
        let s = (time - self.at) / self.unit;
        for (rate, powers) in rates.iter_mut().zip(&self.rates) {
            *rate = at(powers, s);
        }
        true
    }
}

/// How a step goes on: polynomials of time, in parts of it, 0 at its end.
struct Guess {
    from: f64,
    long: f64,
    rates: Vec<[f64; BEFORE]>,
    /// By body: x and y, m, and angle, rad.
    places: Vec<[f64; BEFORE]>,
}

impl Guess {
    /// For a change point to which it is such a way, s.
    fn by(step: &mut dyn Step, plant: &mut Plant, way: f64) -> Option<Self> {
        let (before, from) = (step.before(), step.time());
        if way > FAR * (from - before) {
            return Self::at_once(step, plant, way);
        }
        let size = step.state().len();
        let (mut state, mut found) = (vec![0.0; size], vec![0.0; size]);
        let (mut rates, mut places) = (Vec::new(), Vec::new());
        let equal: [f64; BEFORE] = std::array::from_fn(|k| k as f64 / (BEFORE - 1) as f64 - 1.0);
        for (k, s) in equal.iter().enumerate() {
            let time = from + s * (from - before);
            let known = match k + 1 == BEFORE {
                true => {
                    state.copy_from_slice(step.state());
                    true
                }
                false => step.between(plant, time, &mut state),
            };
            let known = known
                && match step.slopes(time, &mut found) {
                    true => plant.look(time, &state),
                    false => plant.accelerate(time, &state, &mut found),
                };
            if !known {
                return None;
            }
            let instant = plant.instant();
            let bodies = instant.poses.iter().zip(instant.angles());
            let there: Vec<f64> = bodies.flat_map(|(p, angle)| [p.x, p.y, angle]).collect();
            for (all, values) in [(&mut rates, &found), (&mut places, &there)] {
                all.resize(values.len(), [0.0; BEFORE]);
                for (all, value) in all.iter_mut().zip(values) {
                    all[k] = *value;
                }
            }
        }
        let polynomials = |all: Vec<[f64; BEFORE]>| -> Vec<[f64; BEFORE]> {
            let through = |mut values: [f64; BEFORE]| {
                polynomial_through(&equal, &mut values);
                values
            };
            all.into_iter().map(through).collect()
        };
        Some(Self {
            from,
            long: from - before,
            rates: polynomials(rates),
            places: polynomials(places),
        })
    }

    /// By the rates at its end alone.
    fn at_once(step: &dyn Step, plant: &mut Plant, way: f64) -> Option<Self> {
        let line = |value: f64, rate: f64| {
            let mut powers = [0.0; BEFORE];
            (powers[0], powers[1]) = (value, rate * way);
            powers
        };
        plant.look(step.time(), step.state()).then(|| {
            let instant = plant.instant();
            let bodies = instant.poses.iter().zip(instant.angles());
            let places = bodies
                .zip(&instant.velocities)
                .flat_map(|((p, angle), v)| [line(p.x, v[0]), line(p.y, v[1]), line(angle, v[2])]);
            Self {
                from: step.time(),
                long: way,
                rates: step.rates().iter().map(|rate| line(*rate, 0.0)).collect(),
                places: places.collect(),
            }
        })
    }

    fn at(&self, all: &[[f64; BEFORE]], time: f64) -> Vec<f64> {
        let s = (time - self.from) / self.long;
        all.iter().map(|powers| at(powers, s)).collect()
    }

    fn rates(&self, time: f64) -> Vec<f64> {
        self.at(&self.rates, time)
    }

    /// Poses of all bodies and their angles, rad.
    fn poses(&self, time: f64) -> (Vec<Pose<f64>>, Vec<f64>) {
        let places = self.at(&self.places, time);
        let bodies = places.chunks_exact(3);
        bodies
            .map(|p| (Pose::from_angle(p[0], p[1], p[2]), p[2]))
            .unzip()
    }
}

fn at(powers: &[f64], s: f64) -> f64 {
    powers.iter().rev().fold(0.0, |sum, c| sum * s + c)
}

fn integral(powers: &[f64], s: f64) -> f64 {
    let parts = powers.iter().enumerate().rev();
    parts.fold(0.0, |sum, (k, c)| (sum + c / (k + 1) as f64) * s)
}
