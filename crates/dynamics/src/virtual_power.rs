//! Virtual power: what a drive gives, from the motion that it alone would cause.
//!
//! `Q_j = sum over bodies of (m a - applied - friction) . dr/dq_j + (J alpha - moments) dtheta/dq_j`.

use kempe_number::Number;

use crate::number::ForceNumber;
use crate::wrench::{self, Wrench};

/// What one drive gives, by virtual power.
#[derive(Clone, Copy, Debug)]
pub struct ByPower<T: ForceNumber> {
    /// Torque (N m) or force (N), positive along the drive's coordinate.
    pub value: T,
    /// Sum of the sizes of all terms: what the value's rounding is to be counted in.
    pub scale: T::Plain,
}

/// Projects what every body needs (`m a` less everything applied, about its origin) on a drive's coefficients.
pub fn project<T: ForceNumber>(needed: &[Wrench<T>], coefficients: &[[T; 3]]) -> ByPower<T> {
    let mut it = ByPower {
        value: T::zero(),
        scale: T::Plain::zero(),
    };
    for (w, k) in needed.iter().zip(coefficients).skip(1) {
        it.value += wrench::power(*w, *k);
        it.scale += (0..3)
            .map(|i| (w[i].plain() * k[i].plain()).abs())
            .fold(T::Plain::zero(), |sum, term| sum + term);
    }
    it
}
