//! Poses of a body, and the points about which it turns from one to another.

use kempe_linear::C;
use kempe_number::math;

/// Where a body is: the place of its origin, and its angle in rad, counter-clockwise positive. Any unit of length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// The place of the body's origin.
    pub origin: C,
    /// Its angle, rad.
    pub angle: f64,
}

impl Pose {
    /// A pose by its coordinates and its angle in rad.
    pub const fn new(x: f64, y: f64, angle: f64) -> Self {
        Self {
            origin: C::new(x, y),
            angle,
        }
    }

    /// The turn as a complex number of length 1.
    pub fn turn(&self) -> C {
        C::from_polar(1.0, self.angle)
    }

    /// Where a point of the body is.
    pub fn place(&self, of_body: C) -> C {
        self.origin + self.turn() * of_body
    }

    /// Which point of the body is at a place.
    pub fn body_point(&self, place: C) -> C {
        self.turn().conj() * (place - self.origin)
    }

    /// How the fixed plane is seen from the body: the pose of the inverted motion.
    pub fn inverse(&self) -> Self {
        Self {
            origin: -(self.turn().conj() * self.origin),
            angle: -self.angle,
        }
    }

    /// Whether all of it is finite.
    pub fn is_finite(&self) -> bool {
        self.origin.is_finite() && self.angle.is_finite()
    }
}

/// A straight line through a point along a direction of length 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// A point of it.
    pub point: C,
    /// Its direction, of length 1.
    pub direction: C,
}

impl Line {
    /// The line through a point at an angle (rad).
    pub fn at_angle(point: C, angle: f64) -> Self {
        Self {
            point,
            direction: C::from_polar(1.0, angle),
        }
    }

    /// The line through two points, directed from the first to the second; `None` where these are one.
    pub fn through(first: C, second: C) -> Option<Self> {
        let along = second - first;
        let length = math::hypot(along.re, along.im);
        (length > 0.0 && length.is_finite()).then(|| Self {
            point: first,
            direction: along.scale(1.0 / length),
        })
    }

    /// How far a point lies to the left of it.
    pub fn distance(&self, point: C) -> f64 {
        cross(self.direction, point - self.point)
    }

    /// Whether all of it is finite.
    pub fn is_finite(&self) -> bool {
        self.point.is_finite() && self.direction.is_finite()
    }
}

/// The scalar product of two plane vectors.
pub(crate) fn dot(a: C, b: C) -> f64 {
    a.re * b.re + a.im * b.im
}

/// The cross product of two plane vectors: positive where the second lies to the left of the first.
pub(crate) fn cross(a: C, b: C) -> f64 {
    a.re * b.im - a.im * b.re
}

/// e^(i angle) - 1 without cancellation.
pub(crate) fn turn_less_one(angle: f64) -> C {
    let (s, c) = math::sin_cos(0.5 * angle);
    C::new(-2.0 * s * s, 2.0 * s * c)
}

/// The pole of two poses: the point about which the body turns from one to the other, in the fixed plane. `None` where it does
/// not turn.
///
/// P = (p + q) / 2 + i (q - p) / 2 cot(angle / 2), with p and q the places of the origin.
pub fn pole(from: &Pose, to: &Pose) -> Option<C> {
    let (s, c) = math::sin_cos(0.5 * math::within_half_a_turn(to.angle - from.angle));
    let pole = (from.origin + to.origin).scale(0.5)
        + C::i() * (to.origin - from.origin).scale(0.5 * c / s);
    pole.is_finite().then_some(pole)
}

/// The image pole of two poses as seen at a third: where, with the body at `reference`, that point of the body is which lies in
/// the pole of `from` and `to` in both of these.
pub fn image_pole(reference: &Pose, from: &Pose, to: &Pose) -> Option<C> {
    pole(from, to).map(|pole| reference.place(from.body_point(pole)))
}
