//! Two gears in mesh on an arm. Its row is an angle: the teeth passed, over those of both wheels.
//!
//! The row ties angles only; its multiplier is a torque on each gear and on the arm. With the gears' pins on the arm known,
//! the same condition is that both pitch circles have the same speed at the pitch point `P = A + (B - A) z_a / (z_a + z_b)`
//! (`z_b` negative for a ring). Its multiplier is the tooth force along the common tangent of the pitch circles there, and the
//! pins carry its reaction. What the pressure angle and friction add goes with that multiplier, and is no part of the row.

use kempe_model::LinkId;
use kempe_number::Number;

use super::isotropic::Isotropic;
use super::joint::{Gradient, InAngles, Joint, Pairs, Touch, Unit};
use super::loads::{LoadPoint, Rubs, Sliding};
use super::situation::Situation;
use crate::ids::{BodyId, Marker};
use crate::parts::Parts;
use crate::pose::{cross, dot, left, sub};
use crate::step::Step;

/// `ratio_a (angle_a - angle_arm) + ratio_b (angle_b - angle_arm) = phase`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gears {
    /// First gear.
    pub a: BodyId,
    /// Second gear.
    pub b: BodyId,
    /// Arm.
    pub arm: BodyId,
    /// Index into the geometry's gear constants.
    pub constants: u32,
    /// Pins of the gears on the arm, where both are pinned to it.
    pub pins: Option<[Marker; 2]>,
}

/// Where two wheels meet.
struct Pitch<T> {
    /// The pitch point in the frame.
    point: [T; 2],
    /// Unit vector from the first axis to the second.
    ahead: [T; 2],
    /// Length that one of the teeth, or one of what the radii are counted in, takes of the distance.
    unit: T,
}

impl Gears {
    /// Where wheels pinned to their arm meet; without direction and unit where they do not.
    fn pitch<T: Number>(&self, at: &Situation<'_, T>) -> Option<Pitch<T>> {
        let (a, axis) = self.axes(at)?;
        let k = &at.geometry.gears[self.constants as usize];
        let (teeth, square) = (k.first + k.second, dot(axis, axis));
        let (none, zero) = (-Self::room(teeth, square), T::zero());
        let (part, distance) = (k.first / teeth, square.sqrt());
        Some(Pitch {
            point: [0, 1].map(|i| none.choose(a[i], a[i] + axis[i] * part)),
            ahead: axis.map(|x| none.choose(zero, x / distance)),
            unit: none.choose(zero, distance / teeth.abs()),
        })
    }

    /// Positive for wheels that meet at a pitch point: none do on one axis, and none that turn alike.
    fn room<T: Number>(teeth: T, square: T) -> T {
        teeth.abs().min(square)
    }

    /// Centre of the first wheel and the way from there to that of the second; `None` for wheels not pinned to their arm.
    pub(super) fn axes<T: Number>(&self, at: &Situation<'_, T>) -> Option<([T; 2], [T; 2])> {
        let [a, b] = self.pins?.map(|pin| at.place(pin));
        Some((a, sub(b, a)))
    }

    /// Hands out derivatives found from the pins where `room` is positive, and those to the angles alone elsewhere: every
    /// part of a number as it asks.
    pub(super) fn with_room<T: Number>(
        &self,
        at: &Situation<'_, T>,
        room: T,
        by_pins: impl FnOnce(&mut dyn FnMut(Gradient<T>)),
        mut emit: impl FnMut(Gradient<T>),
    ) {
        let none = -room;
        match none.nonnegative() {
            Some(true) => {
                self.gradients(at, emit);
            }
            Some(false) => by_pins(&mut emit),
            None => {
                let zero = T::zero();
                by_pins(&mut |g| {
                    let to = g.to.map(|x| none.choose(zero, x));
                    emit(Gradient { to, ..g });
                });
                self.gradients(at, |g| {
                    let to = g.to.map(|x| none.choose(x, zero));
                    emit(Gradient { to, ..g });
                });
            }
        }
    }
}

impl Joint for Gears {
    fn unit(&self) -> Unit {
        Unit::Angle
    }

    fn touches(&self) -> [Option<Touch>; 3] {
        [self.a, self.b, self.arm].map(|body| Some(Touch::Angle(body)))
    }

    fn pairs(&self) -> Pairs {
        Pairs::HIGHER
    }

    fn links(&self, parts: &Parts) -> Vec<LinkId> {
        parts.gears[self.constants as usize].links.to_vec()
    }

    #[inline]
    fn residual<T: Number>(&self, at: &Situation<'_, T>) -> [T; 2] {
        let k = &at.geometry.gears[self.constants as usize];
        let arm = at.angle(self.arm);
        let row = (k.first * (at.angle(self.a) - arm) + k.second * (at.angle(self.b) - arm)
            - k.constant)
            / (k.first.abs() + k.second.abs());
        [row, T::zero()]
    }

    #[inline]
    fn gradients<T: Number>(&self, at: &Situation<'_, T>, mut emit: impl FnMut(Gradient<T>)) -> T {
        let k = &at.geometry.gears[self.constants as usize];
        let size = k.first.abs() + k.second.abs();
        let arm = -k.first - k.second;
        for (body, factor) in [(self.a, k.first), (self.b, k.second), (self.arm, arm)] {
            emit(Gradient::to_angle(body, factor / size));
        }
        T::zero()
    }

    fn turn(&self, body: BodyId, constraint: usize) -> Option<Step> {
        Some(Step::Gear { body, constraint })
    }

    #[inline]
    fn angle<T: Number>(&self, at: &Situation<'_, T>, body: BodyId) -> Option<T> {
        let Self { a, b, arm, .. } = *self;
        let k = &at.geometry.gears[self.constants as usize];
        let angle = |body| at.angle(body);
        Some(if body == a {
            (k.constant - k.second * (angle(b) - angle(arm))) / k.first + angle(arm)
        } else if body == b {
            (k.constant - k.first * (angle(a) - angle(arm))) / k.second + angle(arm)
        } else {
            (k.first * angle(a) + k.second * angle(b) - k.constant) / (k.first + k.second)
        })
    }

    fn isotropic(&self, _: &Situation<'_, f64>, _: f64) -> Option<Isotropic> {
        None
    }

    fn in_angles(&self, at: &Situation<'_, f64>) -> Option<InAngles> {
        let k = &at.geometry.gears[self.constants as usize];
        let arm = -k.first - k.second;
        Some(InAngles {
            terms: [(self.a, k.first), (self.b, k.second), (self.arm, arm)],
            constant: k.constant,
        })
    }

    fn counts_turns(&self) -> bool {
        true
    }

    fn opened_by(&self, parts: &Parts) -> Vec<(LinkId, LinkId)> {
        let [a, b, arm] = parts.gears[self.constants as usize].links;
        vec![(a, arm), (b, arm)]
    }

    fn needs_pins(&self) -> Option<[Marker; 2]> {
        self.pins
    }

    fn load_gradients<T: Number>(&self, at: &Situation<'_, T>, mut emit: impl FnMut(Gradient<T>)) {
        let Some((a, axis)) = self.axes(at) else {
            self.gradients(at, emit);
            return;
        };
        let k = &at.geometry.gears[self.constants as usize];
        let (teeth, square) = (k.first + k.second, dot(axis, axis));
        let by_pins = |emit: &mut dyn FnMut(Gradient<T>)| {
            let part = k.first / teeth;
            let point = [a[0] + axis[0] * part, a[1] + axis[1] * part];
            // Equal speeds, positive to the left of the line from the first axis to the second.
            let along = T::one() / square.sqrt();
            let tangent = left([axis[0] * along, axis[1] * along]);
            for (body, sign) in [(self.a, 1.0), (self.b, -1.0)] {
                let turn = cross(at.arm_to(body, point), tangent);
                emit(Gradient {
                    row: 0,
                    body,
                    to: [tangent[0] * sign, tangent[1] * sign, turn * sign],
                });
            }
        };
        self.with_room(at, Self::room(teeth, square), by_pins, &mut emit);
    }

    fn load_unit(&self) -> Unit {
        match self.pins {
            Some(_) => Unit::Length,
            None => Unit::Angle,
        }
    }

    fn load_point(&self, body: BodyId) -> Option<LoadPoint> {
        Some(match self.pins {
            Some([a, _]) if a.body == body => LoadPoint::At(a),
            Some([_, b]) => LoadPoint::At(b),
            None => LoadPoint::Origin(body),
        })
    }

    fn load_place<T: Number>(&self, at: &Situation<'_, T>) -> Option<[T; 2]> {
        Some(self.pitch(at)?.point)
    }

    fn rubs(&self) -> Option<Rubs> {
        self.pins.map(|_| Rubs::Teeth {
            constants: self.constants,
            rack: false,
        })
    }

    fn sliding<T: Number>(&self, at: &Situation<'_, T>) -> Option<Sliding<T>> {
        let Pitch { point, ahead, unit } = self.pitch(at)?;
        let k = &at.geometry.gears[self.constants as usize];
        // Teeth push the axes of two wheels apart, and that of a wheel towards the axis of its ring.
        let back = k.second.choose(-T::one(), T::one());
        Some(Sliding::Rolling {
            a: self.a,
            b: self.b,
            point,
            off: ahead.map(|x| x * back),
            unit,
        })
    }
}
