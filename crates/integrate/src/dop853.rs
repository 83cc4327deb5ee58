//! The explicit Runge–Kutta method of order 8 of Dormand and Prince with the error of orders 5 and 3 of Hairer, Nørsett and
//! Wanner ("Solving Ordinary Differential Equations I", 2nd ed., 1993, sections II.4 and II.5), and its polynomial of order 7
//! between the ends of a step.

mod coefficients;

use coefficients::{BETWEEN, ERROR_3, ERROR_5, LAST, NODES, STAGE, STAGES, Terms};
use kempe_number::math::powf;

use crate::track::{At, Next, Track};
use crate::{Stopped, System};

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

/// A solution that is followed step by step. All storage is its own; steps allocate nothing.
#[derive(Clone, Debug)]
pub(crate) struct Dop853 {
    pub(crate) track: Track,
    stages: Vec<f64>,
    between: Vec<f64>,
    known_between: bool,
    /// Whether the rates at the state are those of the last stage of the step that led there, not yet the first of the next.
    ended: bool,
}

impl Dop853 {
    /// Storage for steps on a track, which is nowhere yet.
    pub(crate) fn on(track: Track) -> Self {
        let size = track.size();
        Self {
            track,
            stages: vec![0.0; STAGES * size],
            between: vec![0.0; POWERS * size],
            known_between: false,
            ended: false,
        }
    }

    /// Begins where the track is. `false` where there are no rates.
    pub(crate) fn restart(&mut self, system: &mut impl System) -> bool {
        self.ended = false;
        if !self.evaluate(system, 0, self.track.time, At::State) {
            return false;
        }
        self.choose_step(system);
        true
    }

    /// Chooses the next step from the rates alone.
    pub(crate) fn choose_step(&mut self, system: &mut impl System) {
        self.begin();
        let size = self.track.size();
        let (here, there) = self.stages.split_at_mut(size);
        (self.track).choose_step(system, ORDER, here, &mut there[..size]);
    }

    /// Goes on from where another method led, with its rates there.
    pub(crate) fn take_over(&mut self, rates: &[f64]) {
        self.ended = false;
        self.stages[..rates.len()].copy_from_slice(rates);
    }

    /// The rates at the state.
    pub(crate) fn rates(&self) -> &[f64] {
        self.stage(if self.ended { LAST } else { 0 })
    }

    fn stage(&self, index: usize) -> &[f64] {
        let size = self.track.size();
        self.stages
            .get(index * size..(index + 1) * size)
            .unwrap_or(&[])
    }

    /// Rates into a stage, at the state or at the trial.
    fn evaluate(&mut self, system: &mut impl System, index: usize, time: f64, at: At) -> bool {
        let size = self.track.size();
        let Some(rates) = self.stages.get_mut(index * size..(index + 1) * size) else {
            return false;
        };
        self.track.rates(system, time, at, rates)
    }

    /// The sum of stages of a component.
    fn sum(&self, terms: Terms, component: usize) -> f64 {
        sum(&self.stages, self.track.size(), terms, component)
    }

    fn try_at(&mut self, terms: Terms, step: f64) {
        for component in 0..self.track.size() {
            let sum = self.sum(terms, component);
            self.track.trial[component] = self.track.state[component] + step * sum;
        }
    }

    /// One step that keeps the tolerance and does not pass `end`.
    ///
    /// # Errors
    ///
    /// Where no step can be made; the state stays where it was.
    pub(crate) fn step(&mut self, system: &mut impl System, end: f64) -> Result<(), Stopped> {
        loop {
            let Next::Step { step, to, last } = self.track.next(end)? else {
                return Ok(());
            };
            let Some(error) = self.attempt(system, step) else {
                self.track.retreat(step)?;
                continue;
            };
            let fits = SAFETY * powf(error, -1.0 / ORDER);
            if error > 1.0 {
                self.track.refuse(step * fits.max(SHORTER));
                continue;
            }
            let most = if self.track.refused { 1.0 } else { LONGER };
            let next = step * fits.clamp(SHORTER, most);
            self.track.follow_with(next, last);
            self.accept(to);
            return Ok(());
        }
    }

    /// The rates at the end of the last step are those at the beginning of this one.
    fn begin(&mut self) {
        if self.ended {
            let size = self.track.size();
            self.stages.copy_within(LAST * size..(LAST + 1) * size, 0);
            self.ended = false;
        }
    }

    /// All stages of a step, with the trial at its end; the error against the tolerance, `None` where rates are missing or the
    /// error is not finite.
    fn attempt(&mut self, system: &mut impl System, step: f64) -> Option<f64> {
        self.begin();
        for index in 1..OWN {
            self.try_at(STAGE[index], step);
            let time = self.track.time + NODES[index] * step;
            if !self.evaluate(system, index, time, At::Trial) {
                return None;
            }
        }
        self.try_at(STAGE[LAST], step);
        if !self.evaluate(system, LAST, self.track.time + step, At::Trial) {
            return None;
        }
        let (five, three) = (self.error(ERROR_5), self.error(ERROR_3));
        let (five, three) = (five * five, three * three);
        if five == 0.0 && three == 0.0 {
            return Some(f64::MIN_POSITIVE);
        }
        let both = five + 0.01 * three;
        // Neither no number nor one that is too large to square says that the step is good.
        (both.is_finite()).then(|| (step.abs() * five / both.sqrt()).max(f64::MIN_POSITIVE))
    }

    /// A sum of stages against the tolerance over the step that is tried.
    fn error(&self, terms: Terms) -> f64 {
        let track = &self.track;
        let sum = |k| self.sum(terms, k);
        (track.tolerance).norm(track.size(), sum, |k| track.size_over_step(k))
    }

    /// How large the last step is for the fastest change that nearby solutions show: its length times their rate. Steps
    /// beyond the bound of stability, about 6, are those of a stiff system (section IV.2 of volume II).
    pub(crate) fn strain(&self) -> f64 {
        if !self.ended {
            return 0.0;
        }
        let track = &self.track;
        let (size, before_last) = (track.size(), OWN - 1);
        // The last two stages are taken at the same time at states that differ a little.
        let rates =
            track.norm(|k| self.stages[LAST * size + k] - self.stages[before_last * size + k]);
        let states = track.norm(|k| self.sum(STAGE[LAST], k) - self.sum(STAGE[before_last], k));
        if states > 0.0 { rates / states } else { 0.0 }
    }

    /// By what part the rates change over the last step.
    pub(crate) fn bend(&self) -> f64 {
        let track = &self.track;
        let (size, stages) = (track.size(), &self.stages);
        let change = track.norm(|k| stages[LAST * size + k] - stages[k]);
        change / track.norm(|k| stages[LAST * size + k])
    }

    fn accept(&mut self, time: f64) {
        let step = time - self.track.time;
        let (stages, size) = (&self.stages, self.track.size());
        (self.track).accept(time, |k| step * sum(stages, size, STAGE[LAST], k));
        self.known_between = false;
        self.ended = true;
    }

    /// The state at a time within the last step, into `state`. Three more rates are asked for, once a step; `false` where
    /// they are not there.
    pub(crate) fn between(
        &mut self,
        system: &mut impl System,
        time: f64,
        state: &mut [f64],
    ) -> bool {
        let track = &self.track;
        let step = track.length();
        if !self.ended || step == 0.0 {
            state.copy_from_slice(&track.state);
            return true;
        }
        if !self.known_between && !self.find_between(system, step) {
            return false;
        }
        let track = &self.track;
        let x = (time - track.before) / step;
        let size = track.size();
        for (k, value) in state.iter_mut().enumerate().take(size) {
            let mut sum = 0.0;
            for power in (0..POWERS).rev() {
                sum += self.between[power * size + k];
                sum *= if power % 2 == 0 { x } else { 1.0 - x };
            }
            *value = track.earlier[k] + sum;
        }
        true
    }

    /// The polynomial between the ends of the last step.
    fn find_between(&mut self, system: &mut impl System, step: f64) -> bool {
        let size = self.track.size();
        for index in LAST + 1..STAGES {
            for component in 0..size {
                let sum = self.sum(STAGE[index], component);
                self.track.trial[component] = self.track.earlier[component] + step * sum;
            }
            let time = self.track.before + NODES[index] * step;
            if !self.evaluate(system, index, time, At::Trial) {
                return false;
            }
        }
        for k in 0..size {
            let change = self.track.state[k] - self.track.earlier[k];
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

/// The sum of stages of a component, in the order of the terms.
fn sum(stages: &[f64], size: usize, terms: Terms, component: usize) -> f64 {
    terms.iter().fold(0.0, |sum, (stage, factor)| {
        let rate = stages.get(stage * size + component);
        sum + factor * rate.copied().unwrap_or(0.0)
    })
}
