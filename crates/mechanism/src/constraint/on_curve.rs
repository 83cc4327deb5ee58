//! A point on a smooth curve of another link: a pin in a curved slot.
//!
//! Where on the curve the pin is tells a shoe, a body without a link or a load of its own whose origin lies at the pin and
//! whose angle is the parameter of the curve ([`LocalCurve`](crate::curve::LocalCurve)). So nothing is searched for in a
//! pose, the pin goes on along its curve even where the curve comes near or crosses itself, and the rows have derivatives
//! of every order on every number.
//!
//! The rows are no polynomials of the whole curve: assemblies do not come from the homotopy.

use kempe_model::LinkId;
use kempe_number::Number;

use super::isotropic::{Isotropic, Vector};
use super::joint::{Gradient, Joint, Pairs, Touch};
use super::loads::{LoadPoint, Rubs, Sliding};
use super::situation::Situation;
use crate::ids::{BodyId, CurveRef, Marker};
use crate::parts::Parts;
use crate::pose::{cross, dot, left, sub};

/// A point lies on a curve where the shoe says: two rows, along the frame's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OnCurve {
    /// The point.
    pub point: Marker,
    /// The curve.
    pub curve: CurveRef,
    /// The shoe.
    pub shoe: BodyId,
}

/// The curve's place at the shoe, seen from the origin of its body along the frame's axes, and its derivative to the shoe's
/// angle.
struct Foot<T> {
    arm: [T; 2],
    rate: [T; 2],
}

impl OnCurve {
    #[inline]
    fn foot<T: Number>(&self, at: &Situation<'_, T>) -> Foot<T> {
        let shoe = self.shoe.index();
        let local = (at.geometry.curve(self.curve)).at(&at.poses[shoe], at.near[shoe]);
        let pose = &at.poses[self.curve.body.index()];
        Foot {
            arm: pose.turn(local.place),
            rate: pose.turn(local.rate),
        }
    }

    /// Unit tangent of the curve at the shoe, in the frame.
    fn tangent<T: Number>(foot: &Foot<T>) -> ([T; 2], T) {
        let length = dot(foot.rate, foot.rate).sqrt();
        (foot.rate.map(|x| x / length), length)
    }

    /// Hands out the derivatives of how far the point lies from the foot along a direction of the frame that stands still.
    fn parting<T: Number>(
        &self,
        at: &Situation<'_, T>,
        foot: &Foot<T>,
        (row, along): (usize, [T; 2]),
        mut emit: impl FnMut(Gradient<T>),
    ) {
        let [x, y] = along;
        emit(Gradient {
            row,
            body: self.point.body,
            to: [x, y, cross(at.arm(self.point), along)],
        });
        emit(Gradient {
            row,
            body: self.curve.body,
            to: [-x, -y, -cross(foot.arm, along)],
        });
    }
}

impl Joint for OnCurve {
    fn rows(&self) -> usize {
        2
    }

    fn touches(&self) -> [Option<Touch>; 3] {
        [
            Some(Touch::Point(self.point)),
            Some(Touch::Whole(self.curve.body)),
            Some(Touch::Angle(self.shoe)),
        ]
    }

    fn pairs(&self) -> Pairs {
        // The shoe is no link.
        Pairs {
            links: -1,
            ..Pairs::HIGHER
        }
    }

    fn links(&self, parts: &Parts) -> Vec<LinkId> {
        let on = parts.curves[self.curve.index as usize].through[0];
        vec![parts.link_of(self.point), parts.link_of(on)]
    }

    #[inline]
    fn residual<T: Number>(&self, at: &Situation<'_, T>) -> [T; 2] {
        let pose = &at.poses[self.curve.body.index()];
        let [x, y] = self.foot(at).arm;
        sub(at.place(self.point), [pose.x + x, pose.y + y])
    }

    #[inline]
    fn gradients<T: Number>(&self, at: &Situation<'_, T>, mut emit: impl FnMut(Gradient<T>)) -> T {
        let foot = self.foot(at);
        let (zero, one) = (T::zero(), T::one());
        for (row, along) in [[one, zero], [zero, one]].into_iter().enumerate() {
            self.parting(at, &foot, (row, along), &mut emit);
            emit(Gradient {
                row,
                body: self.shoe,
                to: [zero, zero, -foot.rate[row]],
            });
        }
        zero
    }

    fn is_past_end(&self, at: &Situation<'_, f64>) -> bool {
        (at.geometry.curve(self.curve)).is_past_end(&at.poses[self.shoe.index()])
    }

    fn isotropic(&self, _: &Situation<'_, f64>, _: f64) -> Option<Isotropic> {
        None
    }

    /// The first row is the way along the curve's left normal: its multiplier is the normal force. The second is along the
    /// tangent; the shoe, on which nothing acts, makes its multiplier zero.
    fn load_gradients<T: Number>(&self, at: &Situation<'_, T>, mut emit: impl FnMut(Gradient<T>)) {
        let foot = self.foot(at);
        let (tangent, length) = Self::tangent(&foot);
        self.parting(at, &foot, (0, left(tangent)), &mut emit);
        self.parting(at, &foot, (1, tangent), &mut emit);
        emit(Gradient {
            row: 1,
            body: self.shoe,
            to: [T::zero(), T::zero(), -length],
        });
    }

    fn load_point(&self, _: BodyId) -> Option<LoadPoint> {
        Some(LoadPoint::At(self.point))
    }

    fn rubs(&self) -> Option<Rubs> {
        Some(Rubs::AlongGuide)
    }

    fn sliding<T: Number>(&self, at: &Situation<'_, T>) -> Option<Sliding<T>> {
        Some(Sliding::Along {
            point: self.point,
            on: self.curve.body,
            tangent: Self::tangent(&self.foot(at)).0,
        })
    }
}

/// The origin of a shoe lies at its pin: two rows, which carry nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shoe {
    /// The shoe's origin.
    pub own: Marker,
    /// The pin.
    pub pin: Marker,
}

impl Joint for Shoe {
    fn rows(&self) -> usize {
        2
    }

    fn touches(&self) -> [Option<Touch>; 3] {
        [
            Some(Touch::Point(self.pin)),
            Some(Touch::Point(self.own)),
            None,
        ]
    }

    fn pairs(&self) -> Pairs {
        Pairs::default()
    }

    fn links(&self, _: &Parts) -> Vec<LinkId> {
        Vec::new()
    }

    #[inline]
    fn residual<T: Number>(&self, at: &Situation<'_, T>) -> [T; 2] {
        let shoe = &at.poses[self.own.body.index()];
        sub([shoe.x, shoe.y], at.place(self.pin))
    }

    #[inline]
    fn gradients<T: Number>(&self, at: &Situation<'_, T>, mut emit: impl FnMut(Gradient<T>)) -> T {
        let (zero, one) = (T::zero(), T::one());
        let arm = at.arm(self.pin);
        for (row, along) in [[one, zero], [zero, one]].into_iter().enumerate() {
            let [x, y] = along;
            emit(Gradient {
                row,
                body: self.own.body,
                to: [x, y, zero],
            });
            emit(Gradient {
                row,
                body: self.pin.body,
                to: [-x, -y, -cross(arm, along)],
            });
        }
        zero
    }

    /// A pin of the shoe alone: it holds nothing else.
    fn pin(&self, body: BodyId) -> Option<(Marker, Marker)> {
        (body == self.own.body).then_some((self.own, self.pin))
    }

    fn isotropic(&self, at: &Situation<'_, f64>, _: f64) -> Option<Isotropic> {
        Some(Isotropic::Vanishes(Vector::between(at, self.pin, self.own)))
    }

    fn load_point(&self, _: BodyId) -> Option<LoadPoint> {
        None
    }
}
