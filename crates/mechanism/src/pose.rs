//! Where a body is.

use kempe_number::Number;

/// Place and direction of a body: its origin in the frame (m) and the unit vector of its x axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<T> {
    /// x of the body's origin, m.
    pub x: T,
    /// y of the body's origin, m.
    pub y: T,
    /// Cosine of the body's angle.
    pub c: T,
    /// Sine of the body's angle.
    pub s: T,
}

impl Pose<f64> {
    /// How far two poses are apart, in mechanism sizes and rad.
    pub fn apart(&self, other: &Self, size: f64) -> f64 {
        let places = (self.x - other.x).abs() + (self.y - other.y).abs();
        places / size + (self.c - other.c).abs() + (self.s - other.s).abs()
    }
}

impl<T: Number> Pose<T> {
    /// The frame's own pose.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn identity() -> Self {
        Self {
            x: T::zero(),
            y: T::zero(),
            c: T::one(),
            s: T::zero(),
        }
    }

    /// The pose at (`x`, `y`) turned by `angle` rad.
    #[inline]
    pub fn from_angle(x: T, y: T, angle: T) -> Self {
        let (s, c) = angle.sin_cos();
        Self { x, y, c, s }
    }

    /// A vector of the body seen from the frame.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn turn(&self, v: [T; 2]) -> [T; 2] {
        match T::IN_PLACE {
            true => self.turn_in_place(&v),
            false => self.turn_called(&v),
        }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn turn_in_place(&self, v: &[T; 2]) -> [T; 2] {
        [self.c * v[0] - self.s * v[1], self.s * v[0] + self.c * v[1]]
    }

    #[inline(never)]
    fn turn_called(&self, v: &[T; 2]) -> [T; 2] {
        self.turn_in_place(v)
    }

    /// A vector of the frame seen from the body.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn unturn(&self, v: [T; 2]) -> [T; 2] {
        [dot([self.c, self.s], v), cross([self.c, self.s], v)]
    }

    /// A point of the body seen from the frame.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn place(&self, p: [T; 2]) -> [T; 2] {
        match T::IN_PLACE {
            true => self.place_in_place(&p),
            false => self.place_called(&p),
        }
    }

    /// A point of the body's x axis seen from the frame.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn place_on_axis(&self, reach: T) -> [T; 2] {
        [self.x + self.c * reach, self.y + self.s * reach]
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn place_in_place(&self, p: &[T; 2]) -> [T; 2] {
        let v = self.turn_in_place(p);
        [self.x + v[0], self.y + v[1]]
    }

    #[inline(never)]
    fn place_called(&self, p: &[T; 2]) -> [T; 2] {
        self.place_in_place(p)
    }

    /// This pose with its origin moved so that the body's point `p` lies at `world`.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn pinned(c: T, s: T, p: [T; 2], world: [T; 2]) -> Self {
        let mut pose = Self {
            x: world[0],
            y: world[1],
            c,
            s,
        };
        let arm = pose.turn(p);
        pose.x -= arm[0];
        pose.y -= arm[1];
        pose
    }

    /// The pose moved by (`dx`, `dy`) and turned further by `turn` rad.
    #[inline]
    pub fn moved(&self, dx: T, dy: T, turn: T) -> Self {
        let (sn, cs) = turn.sin_cos();
        Self {
            x: self.x + dx,
            y: self.y + dy,
            c: self.c * cs - self.s * sn,
            s: self.s * cs + self.c * sn,
        }
    }

    /// Angle of the body in rad, within half a turn of `near`.
    #[inline]
    pub fn angle_near(&self, near: f64) -> T {
        let (s0, c0) = kempe_number::math::sin_cos(near);
        (self.s * c0 - self.c * s0).atan2(self.c * c0 + self.s * s0) + near
    }

    /// Every part through `f`.
    pub fn map<U>(&self, f: impl Fn(T) -> U) -> Pose<U> {
        Pose {
            x: f(self.x),
            y: f(self.y),
            c: f(self.c),
            s: f(self.s),
        }
    }

    /// The plain value of every part.
    #[inline]
    pub fn value(&self) -> Pose<f64> {
        Pose {
            x: self.x.value(),
            y: self.y.value(),
            c: self.c.value(),
            s: self.s.value(),
        }
    }
}

/// Dot product.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn dot<T: Number>(a: [T; 2], b: [T; 2]) -> T {
    match T::IN_PLACE {
        true => dot_in_place(&a, &b),
        false => dot_called(&a, &b),
    }
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn dot_in_place<T: Number>(a: &[T; 2], b: &[T; 2]) -> T {
    a[0] * b[0] + a[1] * b[1]
}

#[inline(never)]
fn dot_called<T: Number>(a: &[T; 2], b: &[T; 2]) -> T {
    dot_in_place(a, b)
}

/// Cross product: positive when `b` lies counter-clockwise of `a`.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn cross<T: Number>(a: [T; 2], b: [T; 2]) -> T {
    match T::IN_PLACE {
        true => cross_in_place(&a, &b),
        false => cross_called(&a, &b),
    }
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn cross_in_place<T: Number>(a: &[T; 2], b: &[T; 2]) -> T {
    a[0] * b[1] - a[1] * b[0]
}

#[inline(never)]
fn cross_called<T: Number>(a: &[T; 2], b: &[T; 2]) -> T {
    cross_in_place(a, b)
}

/// Sum of two vectors.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn add<T: Number>(a: [T; 2], b: [T; 2]) -> [T; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

/// Difference of two vectors.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn sub<T: Number>(a: [T; 2], b: [T; 2]) -> [T; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

/// Quarter turn to the left.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn left<T: Number>(a: [T; 2]) -> [T; 2] {
    [-a[1], a[0]]
}
