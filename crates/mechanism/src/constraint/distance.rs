//! A cylinder: the distance of two points is the drive's coordinate. Its row is a length.

use kempe_model::{DriveId, LinkId};
use kempe_number::Number;

use super::isotropic::{Isotropic, Vector};
use super::joint::{Gradient, Joint, Pairs, Touch};
use super::loads::LoadPoint;
use super::situation::Situation;
use crate::ids::{BodyId, Marker};
use crate::parts::Parts;
use crate::pose::{cross, dot, sub};
use crate::step::Condition;

/// The distance of two points is the drive's coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// Foot.
    pub a: Marker,
    /// Eye.
    pub b: Marker,
    /// The drive.
    pub input: DriveId,
}

impl Joint for Distance {
    fn touches(&self) -> [Option<Touch>; 3] {
        [Some(Touch::Point(self.a)), Some(Touch::Point(self.b)), None]
    }

    fn drive(&self) -> Option<DriveId> {
        Some(self.input)
    }

    fn pairs(&self) -> Pairs {
        // Barrel and rod, the pins at both ends and the slide between.
        Pairs {
            links: 2,
            lower: 3,
            higher: 0,
        }
    }

    fn links(&self, parts: &Parts) -> Vec<LinkId> {
        vec![parts.link_of(self.b), parts.link_of(self.a)]
    }

    #[inline]
    fn residual<T: Number>(&self, at: &Situation<'_, T>) -> [T; 2] {
        let span = sub(at.place(self.b), at.place(self.a));
        let length = at.inputs[self.input.index()].value;
        // (|span|^2 - length^2) / (2 length): a length, and smooth where the points meet.
        [
            (dot(span, span) - length.square()) / (length * 2.0),
            T::zero(),
        ]
    }

    #[inline]
    fn gradients<T: Number>(&self, at: &Situation<'_, T>, mut emit: impl FnMut(Gradient<T>)) -> T {
        let one = T::one();
        let length = at.inputs[self.input.index()].value;
        let span = sub(at.place(self.b), at.place(self.a));
        for (marker, sign) in [(self.b, one / length), (self.a, -(one / length))] {
            let turn = cross(at.arm(marker), span);
            emit(Gradient {
                row: 0,
                body: marker.body,
                to: [span[0] * sign, span[1] * sign, turn * sign],
            });
        }
        (dot(span, span) / (length * length) + 1.0) * -0.5
    }

    fn condition(&self, body: BodyId) -> Option<Condition> {
        let Self { a, b, input } = *self;
        let (own, center) = if a.body == body {
            (a, b)
        } else if b.body == body {
            (b, a)
        } else {
            return None;
        };
        Some(Condition::Radius { own, center, input })
    }

    fn isotropic(&self, at: &Situation<'_, f64>, scale: f64) -> Option<Isotropic> {
        let w = Vector::between(at, self.a, self.b);
        let q = at.inputs[self.input.index()].value / scale;
        Some(Isotropic::Bilinear {
            products: vec![(1.0, w, w)],
            constant: -q * q,
        })
    }

    fn load_point(&self, _: BodyId) -> Option<LoadPoint> {
        Some(LoadPoint::At(self.b))
    }
}
