//! The natural vibrations of linear equations of motion: frequencies, shapes, damping.
//!
//! Without damping `M x" + K x = 0` has solutions `x = phi cos(w t)` with `K phi = w^2 M phi`. With it solutions go as `exp(s t)`
//! where `s^2 M + s C + K` is singular: two values of `s` belong to every mode, found as the eigenvalues of a matrix of twice the
//! size in the coordinates of the undamped modes, and each to the mode that takes the largest part in its motion.
//! (L. Meirovitch, "Principles and techniques of vibrations", 1997, chapters 4 and 8.)

mod modal;

use kempe_linear::generalised_eigen;

use self::modal::{Modal, between};
use crate::linearised::Linearised;

/// A stiffness below this part of the terms it is the sum of is rounding: nothing brings that motion back.
const NO_STIFFNESS: f64 = 1e-11;
/// An eigenvalue below this part of the largest has few digits of its own: the stiffness along its vector has more.
const BESIDE_STIFFEST: f64 = 1e-10;

/// What grows by less than this part of how fast it swings does so by rounding.
const FLUTTERS: f64 = 1e-7;

/// A natural vibration.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Square of the angular frequency without damping, 1/s^2: zero of a free motion, negative where it is unstable.
    pub square: f64,
    /// How far each coordinate goes, SI, for a modal mass of 1 kg m^2 or kg.
    pub shape: Vec<f64>,
    /// The two values of `s` (real and imaginary part, 1/s) with damping: conjugates where it vibrates, two real ones where it
    /// creeps.
    pub rates: [[f64; 2]; 2],
    /// Whether it swings and grows, or dies away, even without damping: loads that follow the motion feed it, and it has no frequency of its own.
    pub flutters: bool,
}

impl Mode {
    /// Angular frequency without damping, rad/s; 0 of a free motion, `None` of one that is unstable without damping.
    pub fn angular_frequency(&self) -> Option<f64> {
        (self.square >= 0.0 && !self.flutters).then(|| self.square.sqrt())
    }

    /// Angular frequency with damping, rad/s; 0 where it creeps.
    pub fn damped_angular_frequency(&self) -> f64 {
        self.rates[0][1].abs()
    }

    /// Damping in parts of the least for which it does not swing; `None` of free and unstable motions.
    pub fn damping_ratio(&self) -> Option<f64> {
        let known = self.square > 0.0 && !self.flutters;
        known.then(|| self.ratio_of_rates()).flatten()
    }

    /// The same by the rates alone, whatever brings it back: gyroscopic terms may. `None` where it does not die away or swing to both sides.
    pub fn ratio_of_rates(&self) -> Option<f64> {
        let [a, b] = self.rates;
        let product = a[0] * b[0] - a[1] * b[1];
        (product > 0.0).then(|| -(a[0] + b[0]) / 2.0 / product.sqrt() + 0.0)
    }

    /// Whether it grows by more than rounding.
    pub fn grows(&self) -> bool {
        let size = |s: [f64; 2]| s[0].abs() + s[1].abs();
        self.growth() > FLUTTERS * self.rates.map(size).into_iter().fold(0.0, f64::max)
    }

    /// The rate at which it grows, 1/s: negative where it dies away.
    pub fn growth(&self) -> f64 {
        self.rates[0][0].max(self.rates[1][0])
    }
}

/// Why there are no modes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoModes {
    /// This coordinate, by its place among those that are free, moves no mass that the ones before it do not move.
    NoMass(usize),
    /// Something is not finite.
    NoValue,
}

/// The modes of linear equations of motion, the slowest first.
///
/// # Errors
/// Where a coordinate moves no mass, or something has no value.
pub fn modes(it: &Linearised) -> Result<Vec<Mode>, NoModes> {
    let n = it.size;
    if !it.is_finite() {
        return Err(NoModes::NoValue);
    }
    let pairs = generalised_eigen(&it.stiffness, &it.mass, n).map_err(NoModes::NoMass)?;
    let stiffest = pairs.iter().fold(0.0_f64, |m, p| m.max(p.value.abs()));
    let vectors: Vec<&[f64]> = pairs.iter().map(|pair| pair.vector.as_slice()).collect();
    let along = between(&it.stiffness, &vectors);
    let (squares, rounding): (Vec<f64>, Vec<f64>) = (pairs.iter().enumerate())
        .map(|(mode, pair)| {
            let terms: f64 = (0..n * n)
                .map(|k| (pair.vector[k / n] * it.stiffness_terms[k] * pair.vector[k % n]).abs())
                .sum();
            let (square, off) = match pair.value.abs() > BESIDE_STIFFEST * stiffest {
                true => (pair.value, 0.0),
                false => by_vector(&along, n, mode),
            };
            let rounding = NO_STIFFNESS * terms + off;
            let none = square.abs() <= rounding;
            (if none { 0.0 } else { square }, rounding)
        })
        .unzip();
    let mut modes: Vec<Mode> = (pairs.into_iter().zip(squares))
        .map(|(pair, square)| Mode {
            square,
            shape: pair.vector,
            rates: [[0.0; 2]; 2],
            flutters: false,
        })
        .collect();
    let modal = Modal::new(it, &modes, rounding);
    if !modal.symmetric {
        // Loads that follow the motion: the frequencies are those of the whole, still without damping.
        let undamped = modal.undamped();
        let rates = undamped.rates(&modes).ok_or(NoModes::NoValue)?;
        let shapes: Vec<Vec<f64>> = rates
            .iter()
            .map(|[s, _]| undamped.shape(*s, &modes))
            .collect();
        for ((mode, [a, b]), shape) in modes.iter_mut().zip(rates).zip(shapes) {
            mode.square = a[0] * b[0] - a[1] * b[1];
            mode.flutters = a[0].abs() > FLUTTERS * a[1].abs() && a[1] != 0.0;
            mode.shape = shape;
        }
    }
    // In the basis of the symmetric part, of which the shapes no longer are where loads follow the motion.
    let rates = match modal.symmetric {
        true => modal.rates(&modes),
        false => modal.general(),
    };
    let rates = rates.ok_or(NoModes::NoValue)?;
    for (mode, rates) in modes.iter_mut().zip(rates) {
        mode.rates = rates;
    }
    modes.sort_by(|a, b| a.square.total_cmp(&b.square));
    Ok(modes)
}

/// The square of a mode's frequency by the stiffness along its shape, as `along` has it between all shapes, and how far off that
/// may be because its shape has a part in others: of second order in what is left between them (Rayleigh).
fn by_vector(along: &[f64], n: usize, mode: usize) -> (f64, f64) {
    let own = along[mode * n + mode];
    let others = (0..n).filter(|other| *other != mode);
    let off = others.map(|other| {
        let left = (along[mode * n + other] + along[other * n + mode]).abs() / 2.0;
        let apart = (along[other * n + other] - own).abs();
        if left < apart {
            left * left / apart
        } else {
            left
        }
    });
    (own, off.sum())
}
