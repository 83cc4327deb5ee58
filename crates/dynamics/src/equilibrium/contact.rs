//! Friction at one joint at an instant, and what it resists with at given multipliers.

use kempe_mechanism::BodyId;

use crate::friction::{Friction, Sense};
use crate::number::ForceNumber;
use crate::vector::length;
use crate::wrench::Wrench;

/// Friction at one joint at an instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrictionContact<T: ForceNumber> {
    /// Which friction.
    pub friction: usize,
    /// First row of the joint.
    pub row: usize,
    /// Relative speed, rad/s or m/s; of flanks that at which they part.
    pub speed: T,
    /// The rate of that speed where it is none, rad/s^2 or m/s^2.
    pub gain: T,
    /// Sense of sliding, or the part of the greatest friction that acts.
    pub direction: T,
    /// The resistance, where no load tells it.
    pub resists: Option<T>,
    /// What a unit of resistance does: to the body that slides and to the other.
    pub unit: [(BodyId, Wrench<T>); 2],
}

/// Whether nothing but its speed tells the sense of dry friction.
pub(super) fn slides_dry<T: ForceNumber>(
    frictions: &[Friction<T>],
    contact: &FrictionContact<T>,
) -> bool {
    let friction = frictions.get(contact.friction);
    friction.is_some_and(|it| matches!(it.sense, Sense::BySpeed) && it.is_dry())
}

pub(super) fn resistance<T: ForceNumber>(
    frictions: &[Friction<T>],
    contact: &FrictionContact<T>,
    lambda: &[T],
) -> T {
    let friction = &frictions[contact.friction];
    contact.resists.unwrap_or_else(|| {
        let load = load(friction, contact, lambda);
        friction.resistance(contact.speed, contact.direction, load)
    })
}

/// The load of a joint that rubs, N.
pub(super) fn load<T: ForceNumber>(
    friction: &Friction<T>,
    contact: &FrictionContact<T>,
    lambda: &[T],
) -> T {
    match lambda[contact.row..][..friction.rows()] {
        [x, y] => length([x, y]),
        _ => lambda[contact.row].abs(),
    }
}
