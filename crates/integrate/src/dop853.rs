//! The explicit Runge–Kutta method of order 8 of Dormand and Prince with the error of orders 5 and 3 of Hairer, Nørsett and
//! Wanner ("Solving Ordinary Differential Equations I", 2nd ed., 1993, sections II.4 and II.5), and its polynomial of order 7
//! between the ends of a step.

mod coefficients;

use coefficients::{BETWEEN, ERROR_3, ERROR_5, LAST, NODES, STAGE, STAGES};
use kempe_number::math::powf;

use crate::System;

/// Stages with their coefficients.
type Terms = &'static [(usize, f64)];

/// Stages of the step itself.
const OWN: usize = 12;
/// Coefficients of the polynomial between the ends.
const POWERS: usize = 7;
/// A new step is the one that just keeps the tolerance, times this.
const SAFETY: f64 = 0.9;
/// A step is at most so many times shorter or longer than the one before.
const SHORTER: f64 = 0.2;
const LONGER: f64 = 6.0;
/// Order of the error that rules the step.
const ORDER: f64 = 8.0;
/// A step without rates is tried again so much shorter.
const RETREAT: f64 = 0.25;
/// A step shorter than this part of the time goes nowhere.
const SHORTEST: f64 = 4.0 * f64::EPSILON;

/// How large the error of one step may be: `absolute + relative * |y|`, in the root of the mean square of all components.
#[derive(Clone, Debug, PartialEq)]
pub struct Tolerance {
    /// Part of the size of a component.
    pub relative: f64,
    /// By component, in its own unit; one for all where there is one only.
    pub absolute: Vec<f64>,
}

impl Tolerance {
    /// The scale against which an error of component `index` of this size counts.
    fn scale(&self, index: usize, size: f64) -> f64 {
        let own = self.absolute.get(index).or(self.absolute.last());
        own.copied().unwrap_or(0.0) + self.relative * size
    }
}

/// Why no step was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stopped {
    /// The rates are not finite or not there just ahead.
    NoRates,
    /// No step is short enough for the tolerance: the solution runs away, jumps, or is stiff beyond an explicit method.
    TooShort,
}

/// A solution that is followed step by step. All storage is its own; steps allocate nothing.
#[derive(Clone, Debug)]
pub struct Dop853 {
    time: f64,
    state: Vec<f64>,
    before: f64,
    earlier: Vec<f64>,
    /// What rounding took from the state, so that long motions lose nothing to many steps.
    carry: Vec<f64>,
    stages: Vec<f64>,
    trial: Vec<f64>,
    between: Vec<f64>,
    known_between: bool,
    /// Whether the rates at the state are those of the last stage of the step that led there, not yet the first of the next.
    ended: bool,
    step: f64,
    tolerance: Tolerance,
    refused: bool,
    evaluations: usize,
}

impl Dop853 {
    /// From a state at a time on, forwards or (`heading` negative) backwards, with a first step chosen from the rates.
    /// `None` where there are none.
    pub fn new(
        system: &mut impl System,
        time: f64,
        state: &[f64],
        heading: f64,
        tolerance: Tolerance,
    ) -> Option<Self> {
        let size = state.len();
        let mut it = Self {
            time,
            state: state.to_vec(),
            before: time,
            earlier: state.to_vec(),
            carry: vec![0.0; size],
            stages: vec![0.0; STAGES * size],
            trial: vec![0.0; size],
            between: vec![0.0; POWERS * size],
            known_between: false,
            ended: false,
            step: heading.signum(),
            tolerance,
            refused: false,
            evaluations: 0,
        };
        if !it.evaluate(system, 0, time, true) {
            return None;
        }
        it.step = heading.signum() * it.first_step(system);
        Some(it)
    }

    /// The time that was reached.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// The state there.
    pub fn state(&self) -> &[f64] {
        &self.state
    }

    /// The rates there.
    pub fn rates(&self) -> &[f64] {
        self.stage(if self.ended { LAST } else { 0 })
    }

    /// The time before the last step.
    pub fn before(&self) -> f64 {
        self.before
    }

    /// How often rates were asked for.
    pub fn evaluations(&self) -> usize {
        self.evaluations
    }

    fn stage(&self, index: usize) -> &[f64] {
        let size = self.state.len();
        self.stages
            .get(index * size..(index + 1) * size)
            .unwrap_or(&[])
    }

    /// Rates into a stage, at the state (`here`) or at the trial.
    fn evaluate(&mut self, system: &mut impl System, index: usize, time: f64, here: bool) -> bool {
        self.evaluations += 1;
        let size = self.state.len();
        let at = if here { &self.state } else { &self.trial };
        let Some(rates) = self.stages.get_mut(index * size..(index + 1) * size) else {
            return false;
        };
        system.rates(time, at, rates) && rates.iter().all(|r| r.is_finite())
    }

    /// `earlier + step * (sum of stages)` of a component.
    fn sum(&self, terms: Terms, component: usize) -> f64 {
        let size = self.state.len();
        terms.iter().fold(0.0, |sum, (stage, factor)| {
            sum + factor
                * self
                    .stages
                    .get(stage * size + component)
                    .copied()
                    .unwrap_or(0.0)
        })
    }

    fn try_at(&mut self, terms: Terms, step: f64) {
        for component in 0..self.state.len() {
            let sum = self.sum(terms, component);
            self.trial[component] = self.state[component] + step * sum;
        }
    }

    /// Root of the mean square of something against the tolerance.
    fn norm(&self, value: impl Fn(&Self, usize) -> f64, at: impl Fn(&Self, usize) -> f64) -> f64 {
        let size = self.state.len();
        let sum = (0..size).fold(0.0, |sum, k| {
            let part = value(self, k) / self.tolerance.scale(k, at(self, k).abs());
            sum + part * part
        });
        (sum / size.max(1) as f64).sqrt()
    }

    /// A first step by the size of the state, of its rates and of theirs (section II.4 there).
    fn first_step(&mut self, system: &mut impl System) -> f64 {
        let here = |it: &Self, k: usize| it.state[k];
        let sizes = self.norm(here, here);
        let rates = self.norm(|it, k| it.stages[k], here);
        let rough = match sizes > 1e-5 && rates > 1e-5 {
            true => 0.01 * sizes / rates,
            false => 1e-6,
        };
        self.try_at(&[(0, 1.0)], rough * self.step.signum());
        let time = self.time + rough * self.step.signum();
        if !self.evaluate(system, 1, time, false) {
            return RETREAT * rough;
        }
        let size = self.state.len();
        let change = self.norm(|it, k| it.stages[size + k] - it.stages[k], here) / rough;
        let most = rates.max(change);
        let fine = match most <= 1e-15 {
            true => (1e-3 * rough).max(1e-6),
            false => powf(0.01 / most, 1.0 / ORDER),
        };
        fine.min(100.0 * rough)
    }

    /// One step that keeps the tolerance and does not pass `end`.
    ///
    /// # Errors
    ///
    /// Where no step can be made; the state stays where it was.
    pub fn step(&mut self, system: &mut impl System, end: f64) -> Result<(), Stopped> {
        loop {
            let left = end - self.time;
            let last = self.step.abs() >= left.abs();
            let step = if last { left } else { self.step };
            let shortest = SHORTEST * self.time.abs().max(end.abs());
            if !(step.abs() > shortest) {
                if last && left.abs() <= shortest {
                    // Nothing is left but rounding.
                    self.time = end;
                    return Ok(());
                }
                return Err(Stopped::TooShort);
            }
            let Some(error) = self.attempt(system, step) else {
                self.refused = true;
                self.step = RETREAT * step;
                if !(self.step.abs() > shortest) {
                    return Err(Stopped::NoRates);
                }
                continue;
            };
            let fits = SAFETY * powf(error, -1.0 / ORDER);
            if error > 1.0 {
                self.refused = true;
                self.step = step * fits.max(SHORTER);
                continue;
            }
            let most = if self.refused { 1.0 } else { LONGER };
            let next = step * fits.clamp(SHORTER, most);
            // A step cut off at the end says nothing against longer ones.
            self.step = if last && next.abs() < self.step.abs() {
                self.step
            } else {
                next
            };
            self.refused = false;
            self.accept(if last { end } else { self.time + step });
            return Ok(());
        }
    }

    /// All stages of a step, with the trial at its end; the error against the tolerance, `None` where rates are missing.
    fn attempt(&mut self, system: &mut impl System, step: f64) -> Option<f64> {
        if self.ended {
            // The rates at the end of the last step are those at the beginning of this one.
            let size = self.state.len();
            self.stages.copy_within(LAST * size..(LAST + 1) * size, 0);
            self.ended = false;
        }
        for index in 1..OWN {
            self.try_at(STAGE[index], step);
            if !self.evaluate(system, index, self.time + NODES[index] * step, false) {
                return None;
            }
        }
        self.try_at(STAGE[LAST], step);
        if !self.evaluate(system, LAST, self.time + step, false) {
            return None;
        }
        let size = |it: &Self, k: usize| it.state[k].abs().max(it.trial[k].abs());
        let five = self.norm(|it, k| it.sum(ERROR_5, k), size);
        let three = self.norm(|it, k| it.sum(ERROR_3, k), size);
        let (five, three) = (five * five, three * three);
        if five == 0.0 && three == 0.0 {
            return Some(f64::MIN_POSITIVE);
        }
        Some((step.abs() * five / (five + 0.01 * three).sqrt()).max(f64::MIN_POSITIVE))
    }

    fn accept(&mut self, time: f64) {
        let step = time - self.time;
        for k in 0..self.state.len() {
            let (was, carry) = (self.state[k], self.carry[k]);
            let add = step * self.sum(STAGE[LAST], k) + carry;
            let now = was + add;
            // Kahan: what the sum lost.
            self.carry[k] = add - (now - was);
            self.earlier[k] = was;
            self.state[k] = now;
        }
        self.before = self.time;
        self.time = time;
        self.known_between = false;
        self.ended = true;
    }

    /// The state at a time within the last step, into `state`. Three more rates are asked for, once a step; `false` where
    /// they are not there.
    pub fn between(&mut self, system: &mut impl System, time: f64, state: &mut [f64]) -> bool {
        let step = self.time - self.before;
        if !self.ended || step == 0.0 {
            state.copy_from_slice(&self.state);
            return true;
        }
        if !self.known_between && !self.find_between(system, step) {
            return false;
        }
        let x = (time - self.before) / step;
        let size = self.state.len();
        for (k, value) in state.iter_mut().enumerate().take(size) {
            let mut sum = 0.0;
            for power in (0..POWERS).rev() {
                sum += self.between[power * size + k];
                sum *= if power % 2 == 0 { x } else { 1.0 - x };
            }
            *value = self.earlier[k] + sum;
        }
        true
    }

    /// The polynomial between the ends of the last step.
    fn find_between(&mut self, system: &mut impl System, step: f64) -> bool {
        let size = self.state.len();
        for index in LAST + 1..STAGES {
            for component in 0..size {
                let sum = self.sum(STAGE[index], component);
                self.trial[component] = self.earlier[component] + step * sum;
            }
            let time = self.before + NODES[index] * step;
            if !self.evaluate(system, index, time, false) {
                return false;
            }
        }
        for k in 0..size {
            let change = self.state[k] - self.earlier[k];
            let (first, last) = (self.stages[k], self.stages[LAST * size + k]);
            let rest = BETWEEN.map(|terms| step * self.sum(terms, k));
            let own = [
                change,
                step * first - change,
                2.0 * change - step * (first + last),
            ];
            for (power, value) in own.into_iter().chain(rest).enumerate() {
                self.between[power * size + k] = value;
            }
        }
        self.known_between = true;
        true
    }
}
