//! A force and a moment on a link.

use kempe_number::Number;

use crate::vector::cross;

/// Force components along the frame's axes, N, and the moment about the origin of the link's body, N m.
pub type Wrench<T> = [T; 3];

/// A force that acts at `arm` from the body's origin.
#[inline(always)]
pub fn of_force<T: Number>(force: [T; 2], arm: [T; 2]) -> Wrench<T> {
    [force[0], force[1], cross(arm, force)]
}

/// Adds a wrench to another.
#[inline(always)]
pub fn add<T: Number>(to: &mut Wrench<T>, what: Wrench<T>) {
    for (to, what) in to.iter_mut().zip(what) {
        *to += what;
    }
}

/// The opposite wrench.
#[inline(always)]
pub fn opposite<T: Number>(w: Wrench<T>) -> Wrench<T> {
    w.map(|x| -x)
}

/// The moment of a wrench about a point at `arm` from the body's origin.
#[inline(always)]
pub fn moment_at<T: Number>(w: Wrench<T>, arm: [T; 2]) -> T {
    w[2] - cross(arm, [w[0], w[1]])
}

/// Its power on a motion (velocity of the body's origin and angular speed), or its projection on kinematic coefficients.
#[inline(always)]
pub fn power<T: Number>(w: Wrench<T>, motion: [T; 3]) -> T {
    w[0] * motion[0] + w[1] * motion[1] + w[2] * motion[2]
}
