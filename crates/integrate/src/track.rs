//! What every method keeps of the solution that it follows, and what it does not do differently from the others.

use kempe_number::math::powf;

use crate::{System, Tolerance};

/// A step without rates is tried again so much shorter.
const RETREAT: f64 = 0.25;
/// A step shorter than this part of the time goes nowhere.
const SHORTEST: f64 = 4.0 * f64::EPSILON;
/// A state or rates below so many tolerances say nothing of how long a first step may be.
const TOO_SMALL: f64 = 1e-5;
/// A first step where nothing says how long it may be, in the unit of the time.
const BLIND: f64 = 1e-6;
/// The first step that is tried changes the state by this part; of the one that is chosen its highest term is as small.
const CHANGE: f64 = 0.01;
/// Rates and their change below so many tolerances a unit of time stand still.
const STANDING: f64 = 1e-15;
/// The first step beside the one that was tried: where everything stands still, and at most.
const BEHIND: f64 = 1e-3;
const BEYOND: f64 = 100.0;
/// So many of the shortest steps it is at least.
const LEAST: f64 = 1000.0;

/// Why no step was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stopped {
    /// The rates are not finite or not there just ahead, or so large that no error can be told.
    NoRates,
    /// No step is short enough for the tolerance: the solution runs away, jumps, or is stiff beyond an explicit method.
    TooShort,
}

/// Where rates are asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum At {
    State,
    Trial,
}

/// What is to be done next.
pub(crate) enum Next {
    /// A step to a time, and whether that is the end. The step is as long as the time that it takes, to the last bit: the solution
    /// may go far in little time.
    Step { step: f64, to: f64, last: bool },
    /// Nothing: the end is reached but for rounding.
    Arrived,
}

/// A solution and the steps along it.
#[derive(Clone, Debug)]
pub(crate) struct Track {
    pub(crate) time: f64,
    pub(crate) state: Vec<f64>,
    pub(crate) before: f64,
    pub(crate) earlier: Vec<f64>,
    /// What rounding took from the state, so that long motions lose nothing to many steps.
    carry: Vec<f64>,
    /// A state that is tried.
    pub(crate) trial: Vec<f64>,
    /// The step to be tried next, with its sign.
    pub(crate) step: f64,
    pub(crate) tolerance: Tolerance,
    /// Whether the last attempt was no step.
    pub(crate) refused: bool,
    pub(crate) evaluations: usize,
}

impl Track {
    pub(crate) fn new(size: usize, heading: f64, tolerance: Tolerance) -> Self {
        Self {
            time: 0.0,
            state: vec![0.0; size],
            before: 0.0,
            earlier: vec![0.0; size],
            carry: vec![0.0; size],
            trial: vec![0.0; size],
            step: heading.signum(),
            tolerance,
            refused: false,
            evaluations: 0,
        }
    }

    /// Begins at a state, heading where it headed.
    pub(crate) fn place(&mut self, time: f64, state: &[f64]) {
        (self.time, self.before) = (time, time);
        self.state.copy_from_slice(state);
        self.earlier.copy_from_slice(state);
        self.carry.fill(0.0);
        self.step = self.step.signum();
        self.refused = false;
    }

    /// How long the last step was, with its sign.
    pub(crate) fn length(&self) -> f64 {
        self.time - self.before
    }

    pub(crate) fn size(&self) -> usize {
        self.state.len()
    }

    /// Rates at the state or at the trial.
    pub(crate) fn rates(
        &mut self,
        system: &mut impl System,
        time: f64,
        at: At,
        rates: &mut [f64],
    ) -> bool {
        self.evaluations += 1;
        let at = match at {
            At::State => &self.state,
            At::Trial => &self.trial,
        };
        system.rates(time, at, rates) && rates.iter().all(|r| r.is_finite())
    }

    /// Something against the tolerance at the state.
    pub(crate) fn norm(&self, value: impl Fn(usize) -> f64) -> f64 {
        self.tolerance.norm(self.size(), value, |k| self.state[k])
    }

    /// The size of a component over a step: the larger of those at its ends.
    pub(crate) fn size_over_step(&self, component: usize) -> f64 {
        self.state[component].abs().max(self.trial[component].abs())
    }

    /// Chooses a first step by the size of the state, of its rates and of theirs, for a method whose error has this order
    /// (Hairer, Nørsett, Wanner, "Solving Ordinary Differential Equations I", section II.4).
    pub(crate) fn choose_step(
        &mut self,
        system: &mut impl System,
        order: f64,
        here: &[f64],
        there: &mut [f64],
    ) {
        let heading = self.step.signum();
        let sizes = self.norm(|k| self.state[k]);
        let rates = self.norm(|k| here[k]);
        let rough = match sizes > TOO_SMALL && rates > TOO_SMALL {
            true => CHANGE * sizes / rates,
            false => BLIND,
        };
        for k in 0..self.size() {
            self.trial[k] = self.state[k] + rough * heading * here[k];
        }
        let time = self.time + rough * heading;
        if !self.rates(system, time, At::Trial, there) {
            self.step = heading * RETREAT * rough;
            return;
        }
        let change = self.norm(|k| there[k] - here[k]) / rough;
        let most = rates.max(change);
        let fine = match most <= STANDING {
            true => (BEHIND * rough).max(BLIND),
            false => powf(CHANGE / most, 1.0 / order),
        };
        // Of a state that is next to nothing it would be no step.
        let least = LEAST * SHORTEST * self.time.abs();
        self.step = heading * fine.min(BEYOND * rough).max(least);
    }

    /// Whether a step of this length changes the time.
    fn goes_on(&self, step: f64) -> bool {
        step.abs() > SHORTEST * self.time.abs()
    }

    /// The next step, not beyond `end`.
    pub(crate) fn next(&mut self, end: f64) -> Result<Next, Stopped> {
        let left = end - self.time;
        if left.abs() <= SHORTEST * self.time.abs().max(end.abs()) {
            self.time = end;
            return Ok(Next::Arrived);
        }
        // What would be left behind it is no step.
        let rest = left.abs() - self.step.abs();
        let last = rest <= SHORTEST * self.time.abs().max(end.abs());
        let to = if last { end } else { self.time + self.step };
        match self.goes_on(if last { left } else { self.step }) {
            true => Ok(Next::Step {
                step: to - self.time,
                to,
                last,
            }),
            false => Err(Stopped::TooShort),
        }
    }

    /// After a step whose rates are missing, or whose error is: a much shorter one, if that goes anywhere.
    pub(crate) fn retreat(&mut self, step: f64) -> Result<(), Stopped> {
        self.refuse(RETREAT * step);
        match self.goes_on(self.step) {
            true => Ok(()),
            false => Err(Stopped::NoRates),
        }
    }

    /// After a step that was none: the one to try instead.
    pub(crate) fn refuse(&mut self, step: f64) {
        self.refused = true;
        self.step = step;
    }

    /// Makes a step: the state changes by `change`.
    pub(crate) fn accept(&mut self, time: f64, change: impl Fn(usize) -> f64) {
        for k in 0..self.size() {
            let (was, carry) = (self.state[k], self.carry[k]);
            let add = change(k) + carry;
            let now = was + add;
            // Kahan: what the sum lost.
            self.carry[k] = add - (now - was);
            self.earlier[k] = was;
            self.state[k] = now;
        }
        self.before = self.time;
        self.time = time;
        self.refused = false;
    }

    /// The step after one that was made; a step cut off at the end says nothing against longer ones.
    pub(crate) fn follow_with(&mut self, next: f64, last: bool) {
        if !(last && next.abs() < self.step.abs()) {
            self.step = next;
        }
    }
}
