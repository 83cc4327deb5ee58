//! The implicit Runge–Kutta method Radau IIA of order 5 for stiff systems: steps as long as the solution allows, however fast
//! nearby solutions meet it (E. Hairer and G. Wanner, "Solving Ordinary Differential Equations II", 2nd ed., 1996, section IV.8).
//!
//! | file | for |
//! | --- | --- |
//! | `radau5/collocation.rs` | the method's numbers, and the polynomial of a step |
//! | `radau5/newton.rs` | the stages of a step |
//! | `radau5/matrices.rs` | the Jacobian and the factored matrices, kept while they serve |

mod collocation;
mod matrices;
mod newton;

use collocation::{ERROR, REAL, STAGES, polynomial, slope};
use kempe_number::math::powf;
use matrices::{Matrices, Missing};
use newton::{Newton, Outcome, ROUNDS};

use crate::track::{At, Next, Track};
use crate::{Stopped, System};

/// A new step is the one that just keeps the tolerance, times this.
const SAFETY: f64 = 0.9;
/// A step is at most so many times shorter or longer than the one before.
const SHORTER: f64 = 0.125;
const LONGER: f64 = 8.0;
/// Order of the error that rules the step.
const ORDER: f64 = 4.0;
/// A step that could be longer by less than this stays, and with it its factored matrices.
const WORTH: f64 = 1.2;
/// Newton's rounds that shrink their changes by more show that the Jacobian still serves.
const SERVES: f64 = 1e-3;
/// Errors below this say no more about the next one.
const LEAST_ERROR: f64 = 1e-2;

/// A solution that is followed step by step. All storage is its own; steps allocate nothing.
///
/// The tolerance holds for the estimate of a step's error, of order 3, and with it for what lies between the ends of a step. The
/// ends themselves, of order 5, are better.
#[derive(Clone, Debug)]
pub(crate) struct Radau5 {
    pub(crate) track: Track,
    /// Rates at the state.
    rates: Vec<f64>,
    /// The stages of the last step that was made.
    last: Vec<f64>,
    /// Whether they lead to the state.
    ended: bool,
    newton: Newton,
    matrices: Matrices,
    /// The error of a step, and the rates that it was solved for from.
    error: Vec<f64>,
    error_rates: Vec<f64>,
    scratch: Vec<f64>,
    nearby: Vec<f64>,
    /// Length and error of the last step, for the next one's.
    history: Option<(f64, f64)>,
}

impl Radau5 {
    /// Storage for steps on a track, which is nowhere yet.
    pub(crate) fn on(track: Track) -> Self {
        let size = track.size();
        Self {
            track,
            rates: vec![0.0; size],
            last: vec![0.0; STAGES * size],
            ended: false,
            newton: Newton::new(size),
            matrices: Matrices::new(size),
            error: vec![0.0; size],
            error_rates: vec![0.0; size],
            scratch: vec![0.0; size],
            nearby: vec![0.0; size],
            history: None,
        }
    }

    /// Begins where the track is. `false` where there are no rates.
    pub(crate) fn restart(&mut self, system: &mut impl System) -> bool {
        self.forget();
        let time = self.track.time;
        if !(self.track).rates(system, time, At::State, &mut self.rates) {
            return false;
        }
        self.choose_step(system);
        true
    }

    /// Chooses the next step from the rates alone.
    pub(crate) fn choose_step(&mut self, system: &mut impl System) {
        (self.track).choose_step(system, ORDER, &self.rates, &mut self.scratch);
    }

    /// Goes on from where another method led, with its rates there.
    pub(crate) fn take_over(&mut self, rates: &[f64]) {
        self.forget();
        self.rates.copy_from_slice(rates);
    }

    fn forget(&mut self) {
        self.ended = false;
        self.history = None;
        self.matrices.renew();
    }

    /// The rates at the state.
    pub(crate) fn rates(&self) -> &[f64] {
        &self.rates
    }

    /// How fast nearby solutions part or meet here, in 1/s: what bounds the steps of an explicit method.
    pub(crate) fn fastest(&mut self) -> f64 {
        (self.matrices).largest_eigenvalue(&mut self.scratch, &mut self.error)
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
            let prepared = self.matrices.prepare(
                &mut self.track,
                system,
                step,
                &self.rates,
                &mut self.scratch,
            );
            match prepared {
                Ok(()) => {}
                Err(Missing::Rates) => {
                    self.track.retreat(step)?;
                    continue;
                }
                Err(Missing::Inverse) => {
                    self.track.refuse(0.5 * step);
                    continue;
                }
            }
            let ratio = step / self.track.length();
            let known = self.ended.then(|| (&self.last[..], ratio));
            self.newton.guess(known);
            let newton = &mut self.newton;
            match newton.solve(&mut self.track, system, &self.matrices, step) {
                Outcome::NoRates => self.track.retreat(step)?,
                // Another Jacobian may help; if not, only a shorter step does.
                Outcome::Lost(_) if !self.matrices.fresh => self.matrices.renew(),
                Outcome::Lost(shorter) => self.track.refuse(shorter * step),
                Outcome::Found { rounds, rate } => {
                    let Some(factor) = self.judge(system, step, rounds) else {
                        self.track.retreat(step)?;
                        continue;
                    };
                    let next = match factor {
                        Judged::Refused(factor) => {
                            if !self.matrices.fresh {
                                self.matrices.renew();
                            }
                            self.track.refuse(factor * step);
                            continue;
                        }
                        Judged::Fits(factor) => factor,
                    };
                    let serves = rate <= SERVES;
                    let stays = serves && (1.0..WORTH).contains(&next);
                    self.track
                        .follow_with(if stays { step } else { next * step }, last);
                    self.accept(to);
                    self.matrices.moved(serves);
                    return Ok(());
                }
            }
        }
    }

    /// Holds the error of a step against the tolerance, with the trial at its end and the rates there in `scratch`. `None` where
    /// rates are missing or the error is not finite.
    fn judge(&mut self, system: &mut impl System, step: f64, rounds: usize) -> Option<Judged> {
        let mut error = self.estimate(system, step)?;
        let time = self.track.time + step;
        if error <= 1.0 {
            if !(self.track).rates(system, time, At::Trial, &mut self.scratch) {
                return None;
            }
            error *= self.underestimated(system, step, error);
        }
        // A step that took many rounds shall be shorter.
        let safety = SAFETY * (2 * ROUNDS + 1) as f64 / (2 * ROUNDS + rounds) as f64;
        let fits = safety * powf(error, -1.0 / ORDER);
        if error > 1.0 {
            return Some(Judged::Refused(fits.clamp(SHORTER, SAFETY)));
        }
        // Gustafsson: errors that grew from step to step go on to do so.
        let goes_on = self.history.map_or(f64::INFINITY, |(length, was)| {
            SAFETY * (step / length).abs() * powf(was / (error * error), 1.0 / ORDER)
        });
        let most = if self.track.refused { 1.0 } else { LONGER };
        self.history = Some((step, error.max(LEAST_ERROR)));
        Some(Judged::Fits(fits.min(goes_on).clamp(SHORTER, most)))
    }

    /// The error of a step against the tolerance, with the trial at its end: what a method of order 3 on the same stages would
    /// have done otherwise, passed through the real system, so that it stays in bounds where the system is stiff.
    fn estimate(&mut self, system: &mut impl System, step: f64) -> Option<f64> {
        let size = self.track.size();
        let stages = |newton: &Newton, k| {
            let [a, b, c] = newton.component(k);
            (ERROR[0] * a + ERROR[1] * b + ERROR[2] * c) / step
        };
        for k in 0..size {
            self.error[k] = self.rates[k] + stages(&self.newton, k);
        }
        let mut error = self.filtered_error();
        if error > 1.0 {
            // Once more from what it says, which takes out of it what only stiffness has put into it.
            for k in 0..size {
                self.track.trial[k] = self.track.state[k] + self.error[k];
            }
            let time = self.track.time;
            if (self.track).rates(system, time, At::Trial, &mut self.scratch) {
                for k in 0..size {
                    self.error[k] = self.scratch[k] + stages(&self.newton, k);
                }
                error = self.filtered_error();
            }
        }
        error.is_finite().then(|| error.max(f64::MIN_POSITIVE))
    }

    /// Solves for the error from the rates that it stands for; its size, with the trial at the end of the step.
    fn filtered_error(&mut self) -> f64 {
        self.error_rates.copy_from_slice(&self.error);
        self.matrices.real.solve(&mut self.error);
        self.try_end();
        let track = &self.track;
        let size = |k| track.size_over_step(k);
        (track.tolerance).norm(track.size(), |k| self.error[k], size)
    }

    /// The trial at the end of the step.
    fn try_end(&mut self) {
        let track = &mut self.track;
        for k in 0..track.size() {
            track.trial[k] = track.state[k] + self.newton.component(k)[STAGES - 1];
        }
    }

    /// By what factor an error is larger for a system as stiff as it is at the end of the step, where its rates are known: one that
    /// has become less stiff on the way (a contact that was lost, say) does not take back what the Jacobian promised.
    fn underestimated(&mut self, system: &mut impl System, step: f64, error: f64) -> f64 {
        // Along the error itself, and as long as the tolerance allows.
        for k in 0..self.track.size() {
            self.track.trial[k] += self.error[k] / error;
        }
        let time = self.track.time + step;
        let known = (self.track).rates(system, time, At::Trial, &mut self.nearby);
        self.try_end();
        if !known {
            return 1.0;
        }
        let promised = self.track.norm(|k| self.error_rates[k] / error);
        let kept = self
            .track
            .norm(|k| REAL / step * self.error[k] / error - (self.nearby[k] - self.scratch[k]));
        let factor = promised / kept;
        if factor.is_finite() {
            factor.max(1.0)
        } else {
            1.0
        }
    }

    fn accept(&mut self, time: f64) {
        let newton = &self.newton;
        (self.track).accept(time, |k| newton.component(k)[STAGES - 1]);
        self.last.copy_from_slice(&newton.stages);
        std::mem::swap(&mut self.rates, &mut self.scratch);
        self.ended = true;
    }

    /// The state at a time within the last step, into `state`: the polynomial through its stages. Always `true`.
    pub(crate) fn between(&mut self, _: &mut impl System, time: f64, state: &mut [f64]) -> bool {
        let track = &self.track;
        let step = track.length();
        if !self.ended || step == 0.0 || time == track.time {
            state.copy_from_slice(&track.state);
            return true;
        }
        let (part, size) = ((time - track.before) / step, track.size());
        for (k, value) in state.iter_mut().enumerate().take(size) {
            let stages = [0, 1, 2].map(|stage| self.last[stage * size + k]);
            *value = track.earlier[k] + polynomial(stages, part);
        }
        true
    }

    /// How fast the polynomial through the last step's stages goes at a time within it, into `rates`; `false` where there is none.
    pub(crate) fn slopes(&self, time: f64, rates: &mut [f64]) -> bool {
        let track = &self.track;
        let (step, size) = (track.length(), track.size());
        if !self.ended || step == 0.0 {
            return false;
        }
        let part = (time - track.before) / step;
        for (k, rate) in rates.iter_mut().enumerate().take(size) {
            let stages = [0, 1, 2].map(|stage| self.last[stage * size + k]);
            *rate = slope(stages, part) / step;
        }
        true
    }
}

/// What the error of a step says, and how much longer or shorter the next one is to be.
enum Judged {
    Fits(f64),
    Refused(f64),
}
