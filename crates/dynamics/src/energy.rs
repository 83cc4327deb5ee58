//! Energy and power.

use kempe_mechanism::{Design, Geometry};

use crate::acting::Acting;
use crate::instant::Instant;
use crate::number::ForceNumber;
use crate::vector::dot;
use crate::wrench::{self, Wrench};

/// Kinetic energy of all links, J.
pub fn kinetic<T: ForceNumber>(acting: &Acting<T>, at: &Instant<T>) -> T {
    (acting.masses.iter()).fold(T::zero(), |sum, mass| sum + mass.kinetic_energy(at))
}

/// Potential energy of gravity (zero at the frame's origin) and of springs (zero at their free length), J.
pub fn potential<T: ForceNumber>(acting: &Acting<T>, geometry: &Geometry<T>, at: &Instant<T>) -> T {
    let weights = (acting.masses.iter()).fold(T::zero(), |sum, mass| {
        let place = at.place(mass.body, mass.arm(at));
        sum - dot(acting.gravity, place) * mass.mass
    });
    (acting.springs.iter()).fold(weights, |sum, spring| sum + spring.energy(geometry, at))
}

/// Power that the loads give to the mechanism, W. `storage` has a place for every link.
pub fn of_loads<T: ForceNumber>(
    acting: &Acting<T>,
    design: &Design<T>,
    at: &Instant<T>,
    storage: &mut [Wrench<T>],
) -> T {
    storage.fill([T::zero(); 3]);
    for load in &acting.loads {
        load.act(&design.mechanism, &design.geometry, at, storage);
    }
    let seats = design.mechanism.seats.iter();
    seats.zip(storage).fold(T::zero(), |sum, (seat, w)| {
        sum + wrench::power(*w, at.velocities[seat.body.index()])
    })
}

/// Power that the motors of drives give that are let go and hold nothing, W.
pub fn of_motors<T: ForceNumber>(acting: &Acting<T>, at: &Instant<T>) -> T {
    (acting.turning.iter()).fold(T::zero(), |sum, it| sum + it.power(&acting.motors, at))
}

/// Power that the dampers take from the mechanism, W, never negative.
pub fn dissipation<T: ForceNumber>(
    acting: &Acting<T>,
    geometry: &Geometry<T>,
    at: &Instant<T>,
) -> T {
    (acting.dampers.iter()).fold(T::zero(), |sum, d| sum + d.dissipation(geometry, at))
}
