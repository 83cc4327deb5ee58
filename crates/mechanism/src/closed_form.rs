//! The closed forms: every class II group comes down to finding one vector with a known projection.
//!
//! Each takes a `sign` (the assembly mode) and returns with the answer its *determinant*: a signed length or area that
//! is smooth along the motion, carries the sign of the assembly mode, and vanishes where two assemblies meet.

use kempe_number::Number;

use crate::pose::{cross, dot, left, sub};

/// How many constants a dyad prepares per design.
pub const DYAD_CONSTANTS: usize = 7;

/// A condition on a point: `normal . X = k`, or `|X - center| = radius`.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Locus<T> {
    /// A straight line by its unit normal and distance.
    Line([T; 2], T),
    /// A circle by centre and radius.
    Circle([T; 2], T),
}

/// The vector of squared length `square` whose projection on the unit vector `n` is `k`; `sign` > 0 puts it on the side
/// that `n` turned left by 90 degrees and reversed points to (ahead along a line whose left normal is `n`).
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn with_projection<T: Number>(n: [T; 2], k: T, square: T, sign: f64) -> ([T; 2], T) {
    let h = (square - k.square()).sqrt() * sign;
    let along = [n[1], -n[0]];
    ([n[0] * k + along[0] * h, n[1] * k + along[1] * h], h)
}

/// The vector from the centre of one circle to its meeting point with another: `v` joins the centres, `square` is
/// |v|^2, `difference` = r1^2 - r2^2, `outer` = (r1 + r2)^2, `inner` = (r1 - r2)^2. `sign` > 0 puts it left of `v`.
///
/// The height comes from Heron's product, which keeps full accuracy near the dead points.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn circle_circle<T: Number>(
    v: [T; 2],
    difference: T,
    outer: T,
    inner: T,
    sign: f64,
) -> ([T; 2], T) {
    let square = dot(v, v);
    let k = square + difference;
    let h = ((outer - square) * (square - inner)).sqrt() * sign;
    let scale = T::from_f64(0.5) / square;
    let up = left(v);
    (
        [
            (v[0] * k + up[0] * h) * scale,
            (v[1] * k + up[1] * h) * scale,
        ],
        h * 0.5,
    )
}

/// The meeting point of a locus with a circle of squared radius `square` (radius `radius`) about `center`, from there.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn reach_locus<T: Number>(
    center: [T; 2],
    radius: T,
    locus: Locus<T>,
    sign: f64,
) -> ([T; 2], T) {
    match locus {
        Locus::Line(n, k) => with_projection(n, k - dot(n, center), radius.square(), sign),
        Locus::Circle(far, other) => {
            let outer = (radius + other).square();
            let inner = (radius - other).square();
            circle_circle(
                sub(far, center),
                radius.square() - other.square(),
                outer,
                inner,
                sign,
            )
        }
    }
}

/// The meeting point of two loci.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn meet<T: Number>(a: Locus<T>, b: Locus<T>, sign: f64) -> ([T; 2], T) {
    match (a, b) {
        (Locus::Line(n, k), Locus::Line(m, l)) => {
            let area = cross(n, m);
            (
                [(k * m[1] - l * n[1]) / area, (l * n[0] - k * m[0]) / area],
                area,
            )
        }
        (Locus::Circle(center, radius), other) | (other, Locus::Circle(center, radius)) => {
            let (reach, h) = reach_locus(center, radius, other, sign);
            ([center[0] + reach[0], center[1] + reach[1]], h)
        }
    }
}

/// Direction of a body from one of its vectors seen in the body (`own`) and in the frame (`seen`), of the same length:
/// (cosine, sine). `square` is that length squared.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn direction<T: Number>(own: [T; 2], seen: [T; 2], square: T) -> [T; 2] {
    [dot(own, seen) / square, cross(own, seen) / square]
}

/// Constants of a dyad for its two bodies' outer and inner pins in body coordinates.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn dyad_constants<T: Number>(
    a: ([T; 2], [T; 2]),
    b: ([T; 2], [T; 2]),
) -> [T; DYAD_CONSTANTS] {
    let (da, db) = (sub(a.1, a.0), sub(b.1, b.0));
    let (sa, sb) = (dot(da, da), dot(db, db));
    let (la, lb) = (sa.sqrt(), sb.sqrt());
    [
        da[0] / sa,
        da[1] / sa,
        db[0] / sb,
        db[1] / sb,
        sa - sb,
        (la + lb).square(),
        (la - lb).square(),
    ]
}

/// The vectors from the placed pins of an RRR dyad to its inner pin, `v` joining the placed pins, and the determinant. The
/// inner pin lies left of `v` for `sign` > 0.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn dyad<T: Number>(
    constants: &[T; DYAD_CONSTANTS],
    v: [T; 2],
    sign: f64,
) -> ([T; 2], [T; 2], T) {
    let (da, h) = circle_circle(v, constants[4], constants[5], constants[6], sign);
    (da, sub(da, v), h)
}
