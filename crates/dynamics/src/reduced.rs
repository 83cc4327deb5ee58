//! The whole mechanism reduced to one drive: Eksergian's equation of motion.
//!
//! `I q" + I' q'^2 / 2 = Q + drive`, with `I = sum m |dr/dq|^2 + J (dtheta/dq)^2` (M. Eksergian, "Dynamical analysis of
//! machines", 1930-31).

use kempe_number::Number;

use crate::acting::Acting;
use crate::instant::Instant;
use crate::number::ForceNumber;
use crate::vector::{add, times};
use crate::wrench::{self, Wrench};

/// Equivalent mass (kg) or moment of inertia (kg m^2) at a drive, and its derivative to the drive's coordinate, the other
/// drives at rest.
pub fn mass<T: ForceNumber>(acting: &Acting<T>, at: &Instant<T>, drive: usize) -> [T; 2] {
    let (first, second) = (&at.coefficients[drive], &at.coefficient_rates[drive]);
    let mut sum = [T::zero(); 2];
    for mass in &acting.masses {
        let arm = mass.arm(at);
        let moved = mass.moved(arm, first);
        let (rate, turn) = mass.moved(arm, second);
        // The arm turns too.
        let rate = (add(rate, times(arm, -moved.1.square())), turn);
        sum[0] += mass.coupling(&moved, &moved);
        sum[1] += mass.coupling(&moved, &rate) * 2.0;
    }
    sum
}

/// Gravity, loads, springs and dampers reduced to a drive, N or N m, positive where they help it along its coordinate.
/// `applied` are the bodies' wrenches about their origins.
pub fn load<T: Number>(applied: &[Wrench<T>], at: &Instant<T>, drive: usize) -> T {
    (applied.iter().zip(&at.coefficients[drive]).skip(1))
        .fold(T::zero(), |sum, (w, k)| sum + wrench::power(*w, *k))
}
