//! How the rates change with the state, and the factored matrices that a step is solved with.

use kempe_linear::{C, Lu};
use kempe_number::math::{exp, ln};

use super::collocation::{COMPLEX, REAL};
use crate::System;
use crate::track::{At, Track};

/// Size of a component's change for a difference, against its own size.
const SMALL: f64 = 1.490_116_119_384_765_6e-8;
/// Size of a component where neither it nor the tolerance tells one, against its absolute tolerance.
const LEAST_SIZE: f64 = 1e6;
/// Factors for a step that is longer or shorter by this part at most serve: the same step later ends at another rounded time, and
/// Newton's rounds shrink what it changes by as much.
const SAME_STEP: f64 = 1e-6;
/// Products with the matrix before its growth is looked at, and over which it is.
const PRODUCTS: usize = 8;

/// The Jacobian and what is made of it for a length of step.
#[derive(Clone, Debug)]
pub(super) struct Matrices {
    jacobian: Vec<f64>,
    /// Whether it is that of the state where the solution stands.
    pub(super) fresh: bool,
    /// Whether it is to be found again.
    wanted: bool,
    /// For which step the systems are factored.
    factored: Option<f64>,
    pub(super) real: Lu<f64>,
    pub(super) complex: Lu<C>,
    /// Largest eigenvalue of the Jacobian, if it was asked for.
    largest: Option<f64>,
}

/// Why there are no matrices.
pub(super) enum Missing {
    /// Rates around the state.
    Rates,
    /// An inverse, for this length of the step.
    Inverse,
}

impl Matrices {
    pub(super) fn new(size: usize) -> Self {
        Self {
            jacobian: vec![0.0; size * size],
            fresh: false,
            wanted: true,
            factored: None,
            real: Lu::new(size),
            complex: Lu::new(size),
            largest: None,
        }
    }

    /// Asks for another Jacobian before the next step.
    pub(super) fn renew(&mut self) {
        self.fresh = false;
        self.wanted = true;
    }

    /// The solution has moved on; whether the Jacobian still serves.
    pub(super) fn moved(&mut self, serves: bool) {
        self.fresh = false;
        self.wanted |= !serves;
    }

    /// Makes what a step of this length needs; `rates` are those at the state, `scratch` as many.
    pub(super) fn prepare(
        &mut self,
        track: &mut Track,
        system: &mut impl System,
        step: f64,
        rates: &[f64],
        scratch: &mut [f64],
    ) -> Result<(), Missing> {
        if self.wanted {
            self.factored = None;
            self.largest = None;
            if !self.find(track, system, rates, scratch) {
                return Err(Missing::Rates);
            }
            self.wanted = false;
            self.fresh = true;
        }
        let serves = |known: f64| (known - step).abs() <= SAME_STEP * step.abs();
        if !self.factored.is_some_and(serves) {
            let (size, jacobian) = (rates.len(), &self.jacobian);
            let diagonal = |row, column| if row == column { 1.0 / step } else { 0.0 };
            let real = |row, column| REAL * diagonal(row, column) - jacobian[row * size + column];
            let pair = |row, column| {
                COMPLEX.scale(diagonal(row, column)) - C::from(jacobian[row * size + column])
            };
            if !(self.real.factor(real) && self.complex.factor(pair)) {
                self.factored = None;
                return Err(Missing::Inverse);
            }
            self.factored = Some(step);
        }
        Ok(())
    }

    /// The Jacobian at the state, from the system or from differences.
    fn find(
        &mut self,
        track: &mut Track,
        system: &mut impl System,
        rates: &[f64],
        scratch: &mut [f64],
    ) -> bool {
        if system.jacobian(track.time, &track.state, &mut self.jacobian) {
            return self.jacobian.iter().all(|x| x.is_finite());
        }
        let size = rates.len();
        for column in 0..size {
            let change = SMALL * typical_size(track, column).copysign(rates[column] * track.step);
            // Where there are no rates on one side, there may be on the other.
            let found = [change, -change].into_iter().find_map(|change| {
                track.trial.copy_from_slice(&track.state);
                track.trial[column] += change;
                let change = track.trial[column] - track.state[column];
                (track.rates(system, track.time, At::Trial, scratch) && change != 0.0)
                    .then_some(change)
            });
            let Some(change) = found else {
                return false;
            };
            for row in 0..size {
                self.jacobian[row * size + column] = (scratch[row] - rates[row]) / change;
            }
        }
        true
    }

    /// How fast nearby solutions part or meet, at most: the size of the Jacobian's largest eigenvalue, by the growth of a
    /// vector over several products, which is that of a pair too. Good to a few parts in ten.
    pub(super) fn largest_eigenvalue(&mut self, x: &mut [f64], product: &mut [f64]) -> f64 {
        if let Some(known) = self.largest {
            return known;
        }
        let size = product.len();
        // Nothing special: no symmetry that an eigenvector might lack.
        for (k, x) in x.iter_mut().enumerate().take(size) {
            *x = 1.0 + 0.37 * ((k * 7 + 3) % 11) as f64;
        }
        let mut grown = 0.0;
        for times in 0..2 * PRODUCTS {
            for (row, product) in self.jacobian.chunks_exact(size.max(1)).zip(&mut *product) {
                *product = row.iter().zip(&*x).map(|(a, x)| a * x).sum();
            }
            let length = product.iter().map(|x| x * x).sum::<f64>().sqrt();
            if !(length > 0.0 && length.is_finite()) {
                return *self.largest.insert(0.0);
            }
            for (x, product) in x.iter_mut().zip(&*product) {
                *x = product / length;
            }
            if times >= PRODUCTS {
                grown += ln(length);
            }
        }
        *self.largest.insert(exp(grown / PRODUCTS as f64))
    }
}

/// How large a component is, or is taken to be where it is nearly zero.
fn typical_size(track: &Track, component: usize) -> f64 {
    let (absolute, relative) = (
        track.tolerance.absolute(component),
        track.tolerance.relative,
    );
    let least = match relative > 0.0 {
        true => absolute / relative,
        false => LEAST_SIZE * absolute,
    };
    // Where nobody asks how exact a component is, its tolerance tells no size.
    let least = if least.is_finite() { least } else { 0.0 };
    let size = track.state[component].abs().max(least);
    if size > 0.0 { size } else { 1.0 }
}
