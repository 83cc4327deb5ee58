//! Dyads: what may guide a body at one of its points.

use kempe_linear::C;
use kempe_number::math;

use crate::pose::{Line, Pose, cross};

/// A link with two joints between the frame and a body that is to pass through poses. In the unit of the poses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Dyad {
    /// Two pins.
    Rr {
        /// The fixed pivot.
        fixed: C,
        /// The moving pivot, as a point of the body.
        moving: C,
        /// The length of the link.
        length: f64,
    },
    /// A slider on a fixed guide, with a pin on the body.
    Pr {
        /// The guide, fixed.
        guide: Line,
        /// The pin, as a point of the body.
        moving: C,
    },
    /// A fixed pin, with a slider on a guide of the body.
    Rp {
        /// The fixed pivot.
        fixed: C,
        /// The guide, on the body.
        guide: Line,
    },
}

impl Dyad {
    /// The dyad with two pins whose length is that at a pose.
    pub fn rr(fixed: C, moving: C, pose: &Pose) -> Self {
        let link = pose.place(moving) - fixed;
        Self::Rr {
            fixed,
            moving,
            length: math::hypot(link.re, link.im),
        }
    }

    /// By how much, as a length, the dyad misses its constraint at a pose: a link too long, a pin beside its guide.
    pub fn residual(&self, pose: &Pose) -> f64 {
        match *self {
            Self::Rr {
                fixed,
                moving,
                length,
            } => {
                let link = pose.place(moving) - fixed;
                math::hypot(link.re, link.im) - length
            }
            Self::Pr { guide, moving } => guide.distance(pose.place(moving)),
            Self::Rp { fixed, guide } => guide.distance(pose.body_point(fixed)),
        }
    }

    /// How far its pivots lie from the origins of their planes.
    pub(crate) fn reach(&self) -> f64 {
        match *self {
            Self::Rr { fixed, moving, .. } => fixed.norm() + moving.norm(),
            Self::Pr { guide, moving } => guide.point.norm() + moving.norm(),
            Self::Rp { fixed, guide } => fixed.norm() + guide.point.norm(),
        }
    }

    /// The same dyad of the inverted motion, in which the body is fixed and the frame moves.
    pub fn inverse(&self) -> Self {
        match *self {
            Self::Rr {
                fixed,
                moving,
                length,
            } => Self::Rr {
                fixed: moving,
                moving: fixed,
                length,
            },
            Self::Pr { guide, moving } => Self::Rp {
                fixed: moving,
                guide,
            },
            Self::Rp { fixed, guide } => Self::Pr {
                guide,
                moving: fixed,
            },
        }
    }
}

/// A dyad that keeps all that was asked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DyadSolution {
    /// The dyad.
    pub dyad: Dyad,
    /// How many solutions of the equations fall together in it: 1, unless the data are special.
    pub multiplicity: usize,
    /// The largest of [`Dyad::residual`] over the poses.
    pub residual: f64,
}

/// The dyads of solutions, each once, with how often it was found and how well it keeps the poses; those at infinity are none.
pub(crate) fn gathered(
    dyads: impl IntoIterator<Item = Dyad>,
    poses: &[Pose],
    scale: f64,
) -> Vec<DyadSolution> {
    let mut found: Vec<DyadSolution> = Vec::new();
    for dyad in dyads {
        let residual = (poses.iter()).fold(0.0, |worst, pose| {
            math::max(worst, dyad.residual(pose).abs())
        });
        match found
            .iter_mut()
            .find(|known| same(&known.dyad, &dyad, scale))
        {
            Some(known) => {
                known.multiplicity += 1;
                if residual < known.residual {
                    (known.dyad, known.residual) = (dyad, residual);
                }
            }
            None => found.push(DyadSolution {
                dyad,
                multiplicity: 1,
                residual,
            }),
        }
    }
    found
}

/// Pivots nearer to each other than this part of the problem and of the link are those of one solution: a double one is found only to the
/// root of rounding.
const SAME: f64 = 3e-7;

/// Whether two dyads are one, found twice, in a problem of this size.
pub(crate) fn same(a: &Dyad, b: &Dyad, scale: f64) -> bool {
    let near = |p: C, q: C, size: f64| (p - q).norm() <= SAME * size;
    let along = |a: &Line, b: &Line| {
        cross(a.direction, b.direction).abs() <= SAME && a.distance(b.point).abs() <= SAME * scale
    };
    match (a, b) {
        (
            Dyad::Rr {
                fixed,
                moving,
                length,
            },
            Dyad::Rr {
                fixed: other_fixed,
                moving: other_moving,
                ..
            },
        ) => {
            let size = scale + length;
            near(*fixed, *other_fixed, size) && near(*moving, *other_moving, size)
        }
        (
            Dyad::Pr { guide, moving: pin } | Dyad::Rp { guide, fixed: pin },
            Dyad::Pr {
                guide: other,
                moving: other_pin,
            }
            | Dyad::Rp {
                guide: other,
                fixed: other_pin,
            },
        ) => {
            let of_a_kind = std::mem::discriminant(a) == std::mem::discriminant(b);
            of_a_kind && near(*pin, *other_pin, scale) && along(guide, other)
        }
        _ => false,
    }
}
