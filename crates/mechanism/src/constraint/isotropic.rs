//! Constraints in isotropic coordinates: vectors of the plane as complex numbers, beside their conjugates.
//!
//! A body is its direction `u` and its origin `z`; every point and vector of it is affine in these, and an algebraic
//! constraint is bilinear in vectors and conjugate vectors (C. W. Wampler, 1996: isotropic coordinates, circularity, and
//! Bezout numbers).

use super::situation::Situation;
use crate::ids::{BodyId, LineRef, Marker};

/// A vector of the plane, by what it hangs on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Vector {
    /// From a body's point to another's; both in their bodies' coordinates, m.
    Between([(BodyId, [f64; 2]); 2]),
    /// A vector fixed to a body, without a unit.
    Fixed(BodyId, [f64; 2]),
}

/// A constraint's equation.
#[derive(Clone, Debug, PartialEq)]
pub enum Isotropic {
    /// A vector vanishes: both rows of the constraint.
    Vanishes(Vector),
    /// Two directions are the same: it stands for the unit length of one of these bodies' directions.
    Same {
        /// The directions.
        directions: [Vector; 2],
        /// The bodies that turn them.
        bodies: [BodyId; 2],
    },
    /// `sum of sign v conj(w) + constant = 0`, lengths counted in the scale asked for.
    Bilinear {
        /// The products: sign, `v`, `w`.
        products: Vec<(f64, Vector, Vector)>,
        /// The constant.
        constant: f64,
    },
}

impl Vector {
    /// From one marker to another.
    pub(super) fn between(at: &Situation<'_, f64>, from: Marker, to: Marker) -> Self {
        let end = |m: Marker| (m.body, at.geometry.marker(m));
        Self::Between([end(from), end(to)])
    }

    /// Direction of a line, and the vector from its origin to a point.
    pub(super) fn along(at: &Situation<'_, f64>, line: LineRef, point: Marker) -> (Self, Self) {
        let local = at.geometry.line(line);
        let to = (point.body, at.geometry.marker(point));
        (
            Self::Fixed(line.body, local.direction),
            Self::Between([(line.body, local.origin), to]),
        )
    }
}
