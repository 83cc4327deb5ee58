//! The stages of a step, found by Newton's method with matrices that stay the same.

use kempe_linear::C;
use kempe_number::{math::powf, powi};

use super::collocation::{COMPLEX, NODES, REAL, STAGES, from_stages, polynomial, to_stages};
use super::matrices::Matrices;
use crate::System;
use crate::track::{At, Track};

/// Rounds before a step is given up.
pub(super) const ROUNDS: usize = 7;
/// What may be left after the last round, against the tolerance. Smaller for finer tolerances, so that it shrinks with the fifth power
/// of the step as the method's error does.
const LEFT: f64 = 0.03;
const LEFT_FINE: f64 = 0.3;
/// Rounding of a component, times its own size.
const ROUNDING: f64 = 10.0 * f64::EPSILON;
/// Rounds whose changes shrink by less than this find nothing.
const SLOW: f64 = 0.99;

/// How the search ended.
pub(super) enum Outcome {
    /// After so many rounds, the last of which shrank the changes by this factor.
    Found { rounds: usize, rate: f64 },
    /// It would need a step shorter by this factor.
    Lost(f64),
    /// Rates are missing.
    NoRates,
}

/// Stages of a step and storage to find them.
#[derive(Clone, Debug)]
pub(super) struct Newton {
    /// How far the state has come at each stage, stage by stage.
    pub(super) stages: Vec<f64>,
    /// The same in the basis of eigenvectors.
    basis: Vec<f64>,
    rates: Vec<f64>,
    real: Vec<f64>,
    complex: Vec<C>,
}

impl Newton {
    pub(super) fn new(size: usize) -> Self {
        Self {
            stages: vec![0.0; STAGES * size],
            basis: vec![0.0; STAGES * size],
            rates: vec![0.0; STAGES * size],
            real: vec![0.0; size],
            complex: vec![C::zero(); size],
        }
    }

    /// The stages of a component.
    pub(super) fn component(&self, k: usize) -> [f64; STAGES] {
        let size = self.real.len();
        [0, 1, 2].map(|stage| self.stages[stage * size + k])
    }

    /// Begins from the polynomial of the last step, `ratio` times longer now, or from nothing.
    pub(super) fn guess(&mut self, last: Option<(&[f64], f64)>) {
        let size = self.real.len();
        let Some((last, ratio)) = last else {
            self.stages.fill(0.0);
            self.basis.fill(0.0);
            return;
        };
        for k in 0..size {
            let was = [0, 1, 2].map(|stage| last[stage * size + k]);
            let ahead = NODES.map(|node| polynomial(was, 1.0 + node * ratio) - was[STAGES - 1]);
            let basis = from_stages(ahead);
            for stage in 0..STAGES {
                self.stages[stage * size + k] = ahead[stage];
                self.basis[stage * size + k] = basis[stage];
            }
        }
    }

    /// Finds the stages of a step.
    pub(super) fn solve(
        &mut self,
        track: &mut Track,
        system: &mut impl System,
        matrices: &Matrices,
        step: f64,
    ) -> Outcome {
        let Enough { left, rounding } = Enough::new(track.tolerance.relative);
        let (mut last, mut last_rate) = (0.0, 0.0);
        for round in 0..ROUNDS {
            if !self.rates(track, system, step) {
                return Outcome::NoRates;
            }
            let change = self.change(track, matrices, step);
            if !change.is_finite() {
                return Outcome::Lost(0.5);
            }
            if change == 0.0 {
                let rounds = round + 1;
                return Outcome::Found { rounds, rate: 0.0 };
            }
            // One small change proves nothing: a matrix that has become too stiff makes any change small. Two show whether
            // they become smaller.
            if round > 0 {
                let now = change / last;
                let rate = match round {
                    1 => now,
                    _ => (now * last_rate).sqrt(),
                };
                last_rate = now;
                let to_come = rate / (1.0 - rate) * change;
                if (rate < SLOW && to_come <= left) || change <= rounding {
                    let rounds = round + 1;
                    return Outcome::Found { rounds, rate };
                }
                if !(rate < SLOW) {
                    return Outcome::Lost(0.5);
                }
                let more = ROUNDS - 1 - round;
                let at_last = to_come * powi(rate, more as i32) / left;
                if at_last >= 1.0 {
                    let factor = powf(at_last.min(20.0), -1.0 / (4 + more) as f64);
                    return Outcome::Lost(0.8 * factor);
                }
            }
            last = change;
        }
        Outcome::Lost(0.5)
    }

    /// Rates at all stages.
    fn rates(&mut self, track: &mut Track, system: &mut impl System, step: f64) -> bool {
        let size = track.size();
        let (stages, rates) = (
            self.stages.chunks_exact(size.max(1)),
            self.rates.chunks_exact_mut(size.max(1)),
        );
        for ((stage, rates), node) in stages.zip(rates).zip(NODES) {
            for k in 0..size {
                track.trial[k] = track.state[k] + stage[k];
            }
            let time = track.time + node * step;
            if !track.rates(system, time, At::Trial, rates) {
                return false;
            }
        }
        true
    }

    /// One round: the stages change; by how much, against the tolerance.
    fn change(&mut self, track: &Track, matrices: &Matrices, step: f64) -> f64 {
        let size = track.size();
        let (real, complex) = (REAL / step, COMPLEX.scale(1.0 / step));
        for k in 0..size {
            let [one, re, im] = from_stages([0, 1, 2].map(|stage| self.rates[stage * size + k]));
            let pair = C::new(self.basis[size + k], self.basis[2 * size + k]);
            self.real[k] = one - real * self.basis[k];
            self.complex[k] = C::new(re, im) - complex * pair;
        }
        matrices.real.solve(&mut self.real);
        matrices.complex.solve(&mut self.complex);
        for k in 0..size {
            self.basis[k] += self.real[k];
            self.basis[size + k] += self.complex[k].re;
            self.basis[2 * size + k] += self.complex[k].im;
            let stages = to_stages([0, 1, 2].map(|stage| self.basis[stage * size + k]));
            for (stage, value) in stages.into_iter().enumerate() {
                self.stages[stage * size + k] = value;
            }
        }
        let [one, re, im] = [
            track.norm(|k| self.real[k]),
            track.norm(|k| self.complex[k].re),
            track.norm(|k| self.complex[k].im),
        ];
        ((one * one + re * re + im * im) / STAGES as f64).sqrt()
    }
}

/// When a round was the last, against the tolerance.
struct Enough {
    /// What may be left to come.
    left: f64,
    /// Changes that rounding alone makes.
    rounding: f64,
}

impl Enough {
    fn new(relative: f64) -> Self {
        if !(relative > 0.0) {
            return Self {
                left: LEFT * LEFT,
                rounding: 0.0,
            };
        }
        let rounding = ROUNDING / relative;
        let left = LEFT.min(LEFT_FINE * relative.sqrt().sqrt());
        Self {
            left: left.max(rounding),
            rounding,
        }
    }
}
