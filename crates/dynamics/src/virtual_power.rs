//! Virtual power: what a drive gives, from the motion that it alone would cause.
//!
//! `Q_j = sum over bodies of (m a - applied - friction) . dr/dq_j + (J alpha - moments) dtheta/dq_j`.

use crate::number::ForceNumber;
use crate::wrench::{self, Wrench};

/// What one drive gives, by virtual power.
#[derive(Clone, Copy, Debug)]
pub struct ByPower<T> {
    /// Torque (N m) or force (N), positive along the drive's coordinate.
    pub value: T,
    /// Sum of the sizes of all terms: what the value's rounding is to be counted in.
    pub scale: f64,
}

/// Projects what every body needs (`m a` less everything applied, about its origin) on a drive's coefficients.
pub fn project<T: ForceNumber>(needed: &[Wrench<T>], coefficients: &[[T; 3]]) -> ByPower<T> {
    let mut it = ByPower {
        value: T::zero(),
        scale: 0.0,
    };
    for (w, k) in needed.iter().zip(coefficients).skip(1) {
        it.value += wrench::power(*w, *k);
        it.scale += (0..3)
            .map(|i| (w[i].value() * k[i].value()).abs())
            .sum::<f64>();
    }
    it
}
