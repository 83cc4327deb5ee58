//! A point on a straight line: a pin in a slot, or a slider on its guide. Its row is the distance to the left of the line.

use kempe_model::LinkId;
use kempe_number::Number;

use super::isotropic::{Isotropic, Vector};
use super::joint::{Gradient, Joint, Pairs, Touch};
use super::loads::{LoadPoint, Rubs, Sliding};
use super::situation::Situation;
use crate::ids::{BodyId, LineRef, Marker};
use crate::parts::Parts;
use crate::pose::{cross, dot, sub};
use crate::step::Condition;

/// A point lies on a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OnLine {
    /// The point.
    pub point: Marker,
    /// The line.
    pub line: LineRef,
}

impl Joint for OnLine {
    fn touches(&self) -> [Option<Touch>; 3] {
        [
            Some(Touch::Point(self.point)),
            Some(Touch::Whole(self.line.body)),
            None,
        ]
    }

    fn pairs(&self) -> Pairs {
        Pairs::HIGHER
    }

    fn links(&self, parts: &Parts) -> Vec<LinkId> {
        vec![parts.link_of(self.point), parts.link_of_line(self.line)]
    }

    #[inline]
    fn residual<T: Number>(&self, at: &Situation<'_, T>) -> [T; 2] {
        let (origin, direction) = at.line(self.line);
        [
            cross(direction, sub(at.place(self.point), origin)),
            T::zero(),
        ]
    }

    #[inline]
    fn gradients<T: Number>(&self, at: &Situation<'_, T>, mut emit: impl FnMut(Gradient<T>)) -> T {
        let Self { point, line } = *self;
        let (p, t) = (at.place(point), at.line(line).1);
        emit(Gradient {
            row: 0,
            body: point.body,
            to: [-t[1], t[0], dot(t, at.arm(point))],
        });
        emit(Gradient {
            row: 0,
            body: line.body,
            to: [t[1], -t[0], -dot(t, at.arm_to(line.body, p))],
        });
        T::zero()
    }

    fn condition(&self, body: BodyId) -> Option<Condition> {
        let Self { point, line } = *self;
        if point.body == body {
            Some(Condition::OnLine { own: point, line })
        } else if line.body == body {
            Some(Condition::Through { line, point })
        } else {
            None
        }
    }

    fn isotropic(&self, at: &Situation<'_, f64>, _: f64) -> Option<Isotropic> {
        let (t, w) = Vector::along(at, self.line, self.point);
        Some(Isotropic::Bilinear {
            products: vec![(1.0, w, t), (-1.0, t, w)],
            constant: 0.0,
        })
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
            on: self.line.body,
            tangent: at.line(self.line).1,
        })
    }
}
