//! Shaking force and moment: what the inertia of the moving masses does to the frame.

use crate::acting::Acting;
use crate::instant::Instant;
use crate::number::ForceNumber;
use crate::vector::cross;
use crate::wrench::Wrench;

/// Shaking force (N) and shaking moment about the frame's origin (N m): `-sum m a`, `-sum (r x m a + J alpha)`.
pub fn shaking<T: ForceNumber>(acting: &Acting<T>, at: &Instant<T>) -> Wrench<T> {
    let mut sum = [T::zero(); 3];
    for mass in &acting.masses {
        let arm = mass.arm(at);
        let inertial = at.acceleration(mass.body, arm).map(|a| a * mass.mass);
        sum[0] -= inertial[0];
        sum[1] -= inertial[1];
        sum[2] -= cross(at.place(mass.body, arm), inertial)
            + mass.moment * at.accelerations[mass.body.index()][2];
    }
    sum
}
