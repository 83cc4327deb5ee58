//! Where two gears touch: the tooth force acts at the pitch point, not as a pure torque.
//!
//! The joint's own row ties angles only; its multiplier is a torque on each gear and on the arm. With the gears' pins on
//! the arm known, the same condition is that both pitch circles have the same speed at the pitch point
//! `P = A + (B - A) z_a / (z_a + z_b)` (`z_b` negative for a ring). Its multiplier is the tangential tooth force, and the
//! pins carry its reaction. The radial part of a real tooth force depends on the pressure angle and is left out.

use kempe_mechanism::constraint::{Gradient, Situation};
use kempe_mechanism::structure::{Constraint, Marker};
use kempe_mechanism::{BodyId, Mechanism};
use kempe_model::LinkPointRef;
use kempe_number::Number;

use crate::vector::{add, cross, left, length, sub, times};

/// The pins of two gears in mesh.
#[derive(Clone, Copy, Debug)]
pub struct GearMesh {
    /// Pin of the first gear on the arm.
    pub a: Marker,
    /// Pin of the second gear on the arm.
    pub b: Marker,
    /// Index of the gears' constants.
    pub constants: u32,
}

impl GearMesh {
    /// Finds the pins of a gear constraint; `None` for other constraints and for gears not pinned to their arm.
    pub fn new(mechanism: &Mechanism, constraint: &Constraint) -> Option<Self> {
        let Constraint::Gears {
            a,
            b,
            arm,
            constants,
        } = *constraint
        else {
            return None;
        };
        Some(Self {
            a: pin(mechanism, a, arm)?,
            b: pin(mechanism, b, arm)?,
            constants,
        })
    }

    /// The pitch point; `None` for gears on one axis.
    pub fn pitch_point<T: Number>(&self, situation: &Situation<'_, T>) -> Option<[T; 2]> {
        let k = &situation.geometry.gears[self.constants as usize];
        let (a, b) = (situation.place(self.a), situation.place(self.b));
        let axis = sub(b, a);
        let teeth = k.first + k.second;
        let meets = teeth.value() != 0.0 && length(axis).value() > 0.0;
        meets.then(|| add(a, times(axis, k.first / teeth)))
    }

    /// The row of equal speeds at the pitch point, positive to the left of the line from the first axis to the second.
    pub fn gradients<T: Number>(
        &self,
        situation: &Situation<'_, T>,
        mut emit: impl FnMut(Gradient<T>),
    ) -> bool {
        let Some(point) = self.pitch_point(situation) else {
            return false;
        };
        let axis = sub(situation.place(self.b), situation.place(self.a));
        let tangent = left(times(axis, T::one() / length(axis)));
        for (body, sign) in [(self.a.body, 1.0), (self.b.body, -1.0)] {
            let pose = &situation.poses[body.index()];
            let turn = cross(sub(point, [pose.x, pose.y]), tangent);
            emit(Gradient {
                row: 0,
                body,
                to: [tangent[0] * sign, tangent[1] * sign, turn * sign],
            });
        }
        true
    }
}

/// The marker on `body` of a point that pins it to `other`.
fn pin(mechanism: &Mechanism, body: BodyId, other: BodyId) -> Option<Marker> {
    mechanism.markers.iter().find_map(|at: &LinkPointRef| {
        if mechanism.body_of(at.link) != body {
            return None;
        }
        let shared = mechanism.model.points.get(at.point.index())?;
        (shared.links.iter())
            .any(|link| mechanism.body_of(*link) == other)
            .then(|| mechanism.marker(*at))?
    })
}
