//! Steps with the method that suits: explicit ones until they are held back by stiffness alone, implicit ones while that lasts.

mod stiffness;

use stiffness::Watch;

use crate::dop853::Dop853;
use crate::radau5::Radau5;
use crate::track::Track;
use crate::{Stopped, System, Tolerance};

/// How steps are made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Explicit steps only, of order 8 (Dormand and Prince).
    Explicit,
    /// Implicit steps only, of order 5 (Radau IIA).
    Implicit,
    /// Explicit steps, and implicit ones where the system is stiff.
    #[default]
    Choose,
}

/// What steps were made.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Used {
    /// Explicit steps.
    pub explicit: usize,
    /// Implicit steps.
    pub implicit: usize,
    /// When the first implicit step began.
    pub implicit_from: Option<f64>,
}

/// A solution that is followed step by step, by the method asked for. All storage is its own; once both methods were used, steps
/// allocate nothing.
#[derive(Clone, Debug)]
pub struct Integrator {
    method: Method,
    now: Steps,
    /// The other method, if it was used before.
    other: Option<Steps>,
    watch: Watch,
    used: Used,
}

/// Steps of one method or the other.
#[derive(Clone, Debug)]
enum Steps {
    Explicit(Box<Dop853>),
    Implicit(Box<Radau5>),
}

/// The same of either.
macro_rules! either {
    ($steps:expr, $it:ident => $answer:expr) => {
        match $steps {
            Steps::Explicit($it) => $answer,
            Steps::Implicit($it) => $answer,
        }
    };
}

impl Steps {
    fn track(&self) -> &Track {
        either!(self, it => &it.track)
    }

    fn track_mut(&mut self) -> &mut Track {
        either!(self, it => &mut it.track)
    }

    fn rates(&self) -> &[f64] {
        either!(self, it => it.rates())
    }

    /// The other method's, without a solution.
    fn counterpart(&self) -> Self {
        let track = self.track();
        let empty = Track::new(track.size(), track.step, track.tolerance.clone());
        match self {
            Self::Explicit(_) => Self::Implicit(Box::new(Radau5::on(empty))),
            Self::Implicit(_) => Self::Explicit(Box::new(Dop853::on(empty))),
        }
    }
}

impl Integrator {
    /// From a state at a time on, forwards or (`heading` negative) backwards, with the method that suits. `None` where there are no
    /// rates.
    pub fn new(
        system: &mut impl System,
        time: f64,
        state: &[f64],
        heading: f64,
        tolerance: Tolerance,
    ) -> Option<Self> {
        Self::with(Method::Choose, system, time, state, heading, tolerance)
    }

    /// As [`Integrator::new`], with the method that is asked for.
    pub fn with(
        method: Method,
        system: &mut impl System,
        time: f64,
        state: &[f64],
        heading: f64,
        tolerance: Tolerance,
    ) -> Option<Self> {
        let track = Track::new(state.len(), heading, tolerance);
        let now = match method {
            Method::Implicit => Steps::Implicit(Box::new(Radau5::on(track))),
            Method::Explicit | Method::Choose => Steps::Explicit(Box::new(Dop853::on(track))),
        };
        let mut it = Self {
            method,
            now,
            other: None,
            watch: Watch::default(),
            used: Used::default(),
        };
        it.restart(system, time, state).then_some(it)
    }

    /// Begins again from another state (one after an impact, say), with the storage and the method it has. `false` where there
    /// are no rates.
    pub fn restart(&mut self, system: &mut impl System, time: f64, state: &[f64]) -> bool {
        self.now.track_mut().place(time, state);
        either!(&mut self.now, it => it.restart(system))
    }

    /// The time that was reached.
    pub fn time(&self) -> f64 {
        self.now.track().time
    }

    /// The state there.
    pub fn state(&self) -> &[f64] {
        &self.now.track().state
    }

    /// The rates there.
    pub fn rates(&self) -> &[f64] {
        self.now.rates()
    }

    /// The time before the last step.
    pub fn before(&self) -> f64 {
        self.now.track().before
    }

    /// How often rates were asked for, by both methods.
    pub fn evaluations(&self) -> usize {
        self.now.track().evaluations
    }

    /// What steps were made so far.
    pub fn used(&self) -> Used {
        self.used
    }

    /// One step that keeps the tolerance and does not pass `end`.
    ///
    /// # Errors
    ///
    /// Where no step can be made, by either method where it may choose; the state stays where it was.
    pub fn step(&mut self, system: &mut impl System, end: f64) -> Result<(), Stopped> {
        if self.method != Method::Choose {
            return self.step_as_it_is(system, end);
        }
        if self.watch.wants_other() {
            self.switch();
        }
        match self.step_as_it_is(system, end) {
            // What one method cannot follow the other may: stiffness the implicit one, corners the explicit one.
            Err(Stopped::TooShort) => {
                self.switch();
                either!(&mut self.now, it => it.choose_step(system));
                self.step_as_it_is(system, end)?;
            }
            made => made?,
        }
        match &mut self.now {
            Steps::Explicit(it) => self.watch.explicit_step(it.strain(), it.bend()),
            Steps::Implicit(it) => {
                let (length, work) = (it.track.length().abs(), it.track.evaluations);
                self.watch.implicit_step(length, work, || it.fastest());
            }
        }
        Ok(())
    }

    fn step_as_it_is(&mut self, system: &mut impl System, end: f64) -> Result<(), Stopped> {
        let from = self.time();
        either!(&mut self.now, it => it.step(system, end))?;
        match self.now {
            Steps::Explicit(_) => self.used.explicit += 1,
            Steps::Implicit(_) => {
                self.used.implicit += 1;
                self.used.implicit_from.get_or_insert(from);
            }
        }
        Ok(())
    }

    /// Goes on with the other method, from where this one is.
    fn switch(&mut self) {
        let mut next = (self.other.take()).unwrap_or_else(|| self.now.counterpart());
        std::mem::swap(self.now.track_mut(), next.track_mut());
        either!(&mut next, it => it.take_over(self.now.rates()));
        self.watch.switched(next.track().evaluations);
        self.other = Some(std::mem::replace(&mut self.now, next));
    }

    /// How fast the solution goes at a time within the last step, into `rates`, as that step itself has it: where the system is stiff, rates
    /// of states that are a little off are far off. `false` where the step was explicit, as rates of states serve better then.
    pub fn slopes(&self, time: f64, rates: &mut [f64]) -> bool {
        match &self.now {
            Steps::Explicit(_) => false,
            Steps::Implicit(it) => it.slopes(time, rates),
        }
    }

    /// The state at a time within the last step, into `state`. `false` where rates that are needed for it are not there.
    pub fn between(&mut self, system: &mut impl System, time: f64, state: &mut [f64]) -> bool {
        either!(&mut self.now, it => it.between(system, time, state))
    }
}
