//! A belt or chain over two wheels on an arm: in angles a gear pair whose wheels turn the same way round, or, crossed, against
//! each other.
//!
//! The distance of the axes must not change, so both wheels are pinned to the arm. What a belt carries are the tensions of
//! its two straight runs, along the tangents of both wheels. Their difference follows from equilibrium and is the row's
//! multiplier: half of it pulls more in one run, half of it less in the other. The mean of both, the preload, does no work
//! and is left out, and so are the belt's stretch and mass.

use kempe_model::LinkId;
use kempe_number::Number;

use super::gears::Gears;
use super::isotropic::Isotropic;
use super::joint::{Gradient, InAngles, Joint, Pairs, Touch, Unit};
use super::loads::LoadPoint;
use super::situation::Situation;
use crate::geometry::GearConstants;
use crate::ids::{BodyId, Marker};
use crate::parts::Parts;
use crate::pose::{cross, dot, left};
use crate::step::Step;

/// `radius_a (angle_a - angle_arm) - radius_b (angle_b - angle_arm) = radius_a phase`; crossed: plus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Belt {
    /// The wheels by their angles: factors are the radii (m), the second negative for an open belt.
    pub wheels: Gears,
}

/// A straight run of a belt.
#[derive(Clone, Copy, Debug)]
struct Run<T> {
    /// Where it leaves the first wheel, in the frame.
    from: [T; 2],
    /// Where it meets the second wheel.
    to: [T; 2],
    /// Unit vector from there to here.
    along: [T; 2],
}

impl Belt {
    /// The straight runs, that on the left of the way from the first axis to the second first, where the wheels leave room
    /// for them.
    fn runs<T: Number>(k: &GearConstants<T>, a: [T; 2], axis: [T; 2]) -> [Run<T>; 2] {
        let distance = dot(axis, axis).sqrt();
        let ahead = axis.map(|x| x / distance);
        // The common normal of a run and both wheels; of a crossed belt it points away from the second wheel's centre.
        let cosine = (k.first + k.second) / distance;
        let sine = (-cosine.square() + 1.0).sqrt();
        let b = [a[0] + axis[0], a[1] + axis[1]];
        [1.0, -1.0].map(|side| {
            let up = left(ahead);
            let normal = [0, 1].map(|i| ahead[i] * cosine + up[i] * (sine * side));
            Run {
                from: [0, 1].map(|i| a[i] + normal[i] * k.first),
                to: [0, 1].map(|i| b[i] - normal[i] * k.second),
                along: left(normal).map(|x| x * -side),
            }
        })
    }
}

impl Joint for Belt {
    fn unit(&self) -> Unit {
        self.wheels.unit()
    }

    fn touches(&self) -> [Option<Touch>; 3] {
        self.wheels.touches()
    }

    fn pairs(&self) -> Pairs {
        self.wheels.pairs()
    }

    fn links(&self, parts: &Parts) -> Vec<LinkId> {
        self.wheels.links(parts)
    }

    #[inline]
    fn residual<T: Number>(&self, at: &Situation<'_, T>) -> [T; 2] {
        self.wheels.residual(at)
    }

    #[inline]
    fn gradients<T: Number>(&self, at: &Situation<'_, T>, emit: impl FnMut(Gradient<T>)) -> T {
        self.wheels.gradients(at, emit)
    }

    fn turn(&self, body: BodyId, constraint: usize) -> Option<Step> {
        self.wheels.turn(body, constraint)
    }

    #[inline]
    fn angle<T: Number>(&self, at: &Situation<'_, T>, body: BodyId) -> Option<T> {
        self.wheels.angle(at, body)
    }

    fn isotropic(&self, _: &Situation<'_, f64>, _: f64) -> Option<Isotropic> {
        None
    }

    fn in_angles(&self, at: &Situation<'_, f64>) -> Option<InAngles> {
        self.wheels.in_angles(at)
    }

    fn counts_turns(&self) -> bool {
        true
    }

    fn opened_by(&self, parts: &Parts) -> Vec<(LinkId, LinkId)> {
        self.wheels.opened_by(parts)
    }

    fn needs_pins(&self) -> Option<[Marker; 2]> {
        self.wheels.pins
    }

    fn load_gradients<T: Number>(&self, at: &Situation<'_, T>, mut emit: impl FnMut(Gradient<T>)) {
        let Some((a, axis)) = self.wheels.axes(at) else {
            self.gradients(at, emit);
            return;
        };
        let k = &at.geometry.gears[self.wheels.constants as usize];
        let by_pins = |emit: &mut dyn FnMut(Gradient<T>)| {
            // A positive multiplier pulls more in the run on the right, and turns the first wheel counter-clockwise.
            for (run, pull) in Self::runs(k, a, axis).iter().zip([-0.5, 0.5]) {
                for (body, place, sign) in [
                    (self.wheels.a, run.from, pull),
                    (self.wheels.b, run.to, -pull),
                ] {
                    let turn = cross(at.arm_to(body, place), run.along);
                    emit(Gradient {
                        row: 0,
                        body,
                        to: [run.along[0] * sign, run.along[1] * sign, turn * sign],
                    });
                }
            }
        };
        let room = dot(axis, axis) - (k.first + k.second).square();
        self.wheels.with_room(at, room, by_pins, &mut emit);
    }

    fn load_unit(&self) -> Unit {
        self.wheels.load_unit()
    }

    fn load_point(&self, body: BodyId) -> Option<LoadPoint> {
        self.wheels.load_point(body)
    }
}
