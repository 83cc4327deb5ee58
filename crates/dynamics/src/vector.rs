//! Vectors of the plane.

use kempe_number::Number;

pub(crate) use kempe_mechanism::pose::{cross, dot, left, sub};

#[inline(always)]
pub(crate) fn add<T: Number>(a: [T; 2], b: [T; 2]) -> [T; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

#[inline(always)]
pub(crate) fn times<T: Number>(a: [T; 2], k: T) -> [T; 2] {
    [a[0] * k, a[1] * k]
}

/// The length of a vector. Its derivatives are zero, not NaN, where it vanishes.
#[inline(always)]
pub(crate) fn length<T: Number>(a: [T; 2]) -> T {
    let square = dot(a, a);
    (-square).choose_with(T::zero, || square.sqrt())
}

/// The sign of the plain value: -1, 0 or 1.
#[inline(always)]
pub(crate) fn sign(x: f64) -> f64 {
    if x > 0.0 {
        1.0
    } else if x < 0.0 {
        -1.0
    } else {
        0.0
    }
}
