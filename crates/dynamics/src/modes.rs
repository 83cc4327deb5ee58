//! The natural vibrations of linear equations of motion: frequencies, shapes, damping.
//!
//! Without damping `M x" + K x = 0` has solutions `x = phi cos(w t)` with `K phi = w^2 M phi`. With it solutions go as `exp(s t)`
//! where `s^2 M + s C + K` is singular: two values of `s` belong to every mode, found as the eigenvalues of a matrix of twice the
//! size in the coordinates of the undamped modes, and each to the mode that takes the largest part in its motion.
//! (L. Meirovitch, "Principles and techniques of vibrations", 1997, chapters 4 and 8.)

mod modal;
mod mode;

use kempe_linear::generalised_eigen;

use self::modal::{Modal, between};
use self::mode::FLUTTERS;
pub use self::mode::Mode;
use crate::linearised::Linearised;

/// A stiffness below this part of the terms it is the sum of is rounding: nothing brings that motion back.
const NO_STIFFNESS: f64 = 1e-11;
/// An eigenvalue below this part of the largest has few digits of its own: the stiffness along its vector has more.
const BESIDE_STIFFEST: f64 = 1e-10;

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
