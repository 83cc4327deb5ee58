//! Poses as displacements from the first, in a scale and about a point of their own.
//!
//! The place of the body's origin and the unit of length are the user's; precision must not hang on them. About the point that
//! the displacements move least, and with their shifts over their turns as unit, all that is looked for lies within a few units.

use kempe_linear::C;
use kempe_number::math;

use crate::error::{SynthesisError, all_finite};
use crate::newton::Row;
use crate::pose::{Pose, dot, turn_less_one};

/// Turns and shifts below this are none: two poses are one, a set of poses is turned about one point or not at all.
const NONE: f64 = 1e-11;

/// The body's origin is far from what moves where shifts about the point moved least are this part of its own.
const FAR_OFF: f64 = 0.5;
/// Largest unit of length, beside the shifts.
const MOST_SCALE: f64 = 1e4;

/// A displacement z -> shift + turn z of points of the body, given by their places in the first pose.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Displacement {
    pub(crate) shift: C,
    pub(crate) turn: C,
    /// turn - 1.
    pub(crate) turn_less_one: C,
}

/// The displacements from the first pose to the others.
#[derive(Clone, Debug)]
pub(crate) struct Displacements {
    first: Pose,
    /// Where the coordinates begin.
    centre: C,
    /// Their unit.
    pub(crate) scale: f64,
    /// The shifts' size, in the unit of the poses.
    pub(crate) size: f64,
    pub(crate) all: Vec<Displacement>,
    does_turn: bool,
}

impl Displacements {
    /// # Errors
    /// A pose that is not finite or repeats another, or poses that are turns about one point.
    pub(crate) fn new(poses: &[Pose]) -> Result<Self, SynthesisError> {
        all_finite(poses.iter().map(Pose::is_finite))?;
        let Some((first, later)) = poses.split_first() else {
            return Err(SynthesisError::TooFew {
                equations: 0,
                unknowns: 4,
            });
        };
        let mut all: Vec<Displacement> = (later.iter())
            .map(|pose| {
                let angle = math::within_half_a_turn(pose.angle - first.angle);
                let turn_less_one = turn_less_one(angle);
                Displacement {
                    shift: pose.origin - first.origin,
                    turn: turn_less_one + C::one(),
                    turn_less_one,
                }
            })
            .collect();
        let sum = |f: &dyn Fn(&Displacement) -> f64| all.iter().map(f).sum::<f64>();
        let turns = sum(&|d| d.turn_less_one.norm_sqr());
        let shifts = sum(&|d| d.shift.norm_sqr());
        let does_turn = turns.sqrt() > NONE;
        let mut centre = C::zero();
        let mut size = shifts.sqrt();
        if does_turn && all.len() > 1 {
            // About the point moved least; once more, because far away the first answer is rounded.
            let mut about = all.clone();
            for _ in 0..2 {
                let mut least = C::zero();
                for d in &about {
                    least -= d.turn_less_one.conj() * d.shift;
                }
                let least = least.scale(1.0 / turns);
                for d in &mut about {
                    d.shift += d.turn_less_one * least;
                }
                centre += least;
            }
            let left = about.iter().map(|d| d.shift.norm_sqr()).sum::<f64>().sqrt();
            if !(left > NONE * size) {
                repeated(&all, 0.0, turns.sqrt())?;
                return Err(SynthesisError::OnePole {
                    pole: first.origin + centre,
                });
            }
            if left < FAR_OFF * size {
                (all, size) = (about, left);
            } else {
                centre = C::zero();
            }
        }
        // Poses turned by little have their poles far away; where they are hardly turned these are no measure.
        let mut scale = size;
        if does_turn {
            scale *= math::min(1.0 / turns.sqrt(), MOST_SCALE);
        }
        if !(scale > 0.0) {
            // A turn about the body's origin has no length of its own.
            scale = 1.0;
        }
        for d in &mut all {
            d.shift = d.shift.scale(1.0 / scale);
        }
        let turn = if does_turn { turns.sqrt() } else { 1.0 };
        repeated(&all, size / scale, turn)?;
        Ok(Self {
            does_turn,
            first: *first,
            centre: first.origin + centre,
            scale,
            size: if size > 0.0 { size } else { scale },
            all,
        })
    }

    /// # Errors
    /// Poses that only shift the body.
    pub(crate) fn must_turn(&self) -> Result<(), SynthesisError> {
        if self.does_turn {
            Ok(())
        } else {
            Err(SynthesisError::Translations)
        }
    }

    /// A place in these coordinates.
    pub(crate) fn seen(&self, place: C) -> C {
        (place - self.centre).scale(1.0 / self.scale)
    }

    /// A point of the body, where it is in the first pose, in these coordinates.
    pub(crate) fn seen_of_body(&self, point: C) -> C {
        self.seen(self.first.place(point))
    }

    /// The place that these coordinates mean.
    pub(crate) fn place(&self, seen: C) -> C {
        self.centre + seen.scale(self.scale)
    }

    /// The point of the body whose place in the first pose these coordinates mean.
    pub(crate) fn body_point(&self, seen: C) -> C {
        self.first.body_point(self.place(seen))
    }

    /// A direction of the fixed plane as one of the body in the first pose.
    pub(crate) fn body_direction(&self, direction: C) -> C {
        self.first.turn().conj() * direction
    }

    /// A direction of the body as one of the fixed plane in the first pose.
    pub(crate) fn direction_of_body(&self, direction: C) -> C {
        self.first.turn() * direction
    }

    /// The condition that a pose puts on the pivots of a link with two pins: its length there is that in the first pose.
    ///
    /// |s + T z - g|^2 = |z - g|^2, halved: |s|^2 / 2 + Re(conj(s) T z) - Re(conj(s) g) - Re((T - 1) z conj(g)) = 0.
    pub(crate) fn rows(&self) -> impl Iterator<Item = Row> {
        self.all.iter().map(|d| {
            let a = d.shift.conj() * d.turn;
            [
                0.5 * d.shift.norm_sqr(),
                a.re,
                -a.im,
                -d.shift.re,
                -d.shift.im,
                -d.turn_less_one.re,
                d.turn_less_one.im,
            ]
        })
    }
}

/// The seven products that all conditions on a pair of pivots are linear in: 1, the moving pivot's place in the first pose z, the fixed pivot g,
/// and z conj(g).
pub(crate) fn products(moving: C, fixed: C) -> Row {
    let p = moving * fixed.conj();
    [1.0, moving.re, moving.im, fixed.re, fixed.im, p.re, p.im]
}

/// A row for a fixed pivot: (a, b, c) with a + b x + c y = 0 for the moving one's place.
pub(crate) fn with_fixed(row: &Row, fixed: C) -> [f64; 3] {
    let q = C::new(row[5], -row[6]) * fixed.conj();
    [
        row[0] + row[3] * fixed.re + row[4] * fixed.im,
        row[1] + q.re,
        row[2] - q.im,
    ]
}

/// A row for a moving pivot: (a, b, c) with a + b x + c y = 0 for the fixed one.
pub(crate) fn with_moving(row: &Row, moving: C) -> [f64; 3] {
    let q = C::new(row[5], -row[6]) * moving;
    [
        row[0] + row[1] * moving.re + row[2] * moving.im,
        row[3] + q.re,
        row[4] + q.im,
    ]
}

/// Whether a displacement is none, or two are one, beside shifts and turns of these sizes.
fn repeated(all: &[Displacement], shift: f64, turn: f64) -> Result<(), SynthesisError> {
    let none = Displacement {
        shift: C::zero(),
        turn: C::one(),
        turn_less_one: C::zero(),
    };
    let at = |k: usize| if k == 0 { none } else { all[k - 1] };
    for second in 1..=all.len() {
        for first in 0..second {
            let (a, b) = (at(first), at(second));
            let apart = a.shift - b.shift;
            let turned = a.turn_less_one - b.turn_less_one;
            if dot(apart, apart).sqrt() <= NONE * shift && dot(turned, turned).sqrt() <= NONE * turn
            {
                return Err(SynthesisError::Repeated { first, second });
            }
        }
    }
    Ok(())
}
