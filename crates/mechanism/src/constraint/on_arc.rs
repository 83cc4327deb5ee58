//! A point on a circular arc of another link: a pin in a curved slot. Its row is how far the point lies outside the arc's
//! circle, to first order.
//!
//! In isotropic coordinates the row is a distance, so a curved slot moves as a bar between the pin and the arc's centre. The
//! circle goes on past the ends of the slot; whoever shows a motion tells where the pin leaves it.

use kempe_model::LinkId;
use kempe_number::Number;

use super::isotropic::{Isotropic, Vector};
use super::joint::{Gradient, Joint, Pairs, Touch};
use super::loads::{LoadPoint, Rubs, Sliding};
use super::situation::Situation;
use crate::ids::{ArcRef, BodyId, Marker};
use crate::parts::Parts;
use crate::pose::{cross, dot, left, sub};
use crate::step::Condition;

/// A point lies on the circle of an arc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OnArc {
    /// The point.
    pub point: Marker,
    /// The arc.
    pub arc: ArcRef,
}

impl OnArc {
    /// From the arc's centre to the point, in the frame, and the arc's radius.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn span<T: Number>(&self, at: &Situation<'_, T>) -> ([T; 2], T) {
        let arc = at.geometry.arc(self.arc);
        let center = at.poses[self.arc.body.index()].place(arc.center);
        (sub(at.place(self.point), center), arc.radius)
    }

    /// The derivatives of the distance from the arc's centre along a normal of it.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn emit_along<T: Number>(
        &self,
        at: &Situation<'_, T>,
        normal: [T; 2],
        mut emit: impl FnMut(Gradient<T>),
    ) {
        emit(Gradient {
            row: 0,
            body: self.point.body,
            to: [normal[0], normal[1], cross(at.arm(self.point), normal)],
        });
        // The radius vector turns nothing about the centre: the arm of the arc's body is that of its centre.
        let center = at.geometry.arc(self.arc).center;
        let arm = at.poses[self.arc.body.index()].turn(center);
        emit(Gradient {
            row: 0,
            body: self.arc.body,
            to: [-normal[0], -normal[1], -cross(arm, normal)],
        });
    }
}

fn length<T: Number>(span: [T; 2]) -> T {
    dot(span, span).sqrt()
}

impl Joint for OnArc {
    fn touches(&self) -> [Option<Touch>; 3] {
        let arc = self.arc.body;
        [
            Some(Touch::Point(self.point)),
            Some(Touch::Whole(arc)),
            None,
        ]
    }

    fn pairs(&self) -> Pairs {
        Pairs::HIGHER
    }

    fn links(&self, parts: &Parts) -> Vec<LinkId> {
        let arc = &parts.arcs[self.arc.index as usize];
        vec![parts.link_of(self.point), parts.link_of(arc.from)]
    }

    #[inline]
    fn residual<T: Number>(&self, at: &Situation<'_, T>) -> [T; 2] {
        let (span, radius) = self.span(at);
        // (|span|^2 - radius^2) / (2 radius): a length, and smooth at the centre.
        let row = (dot(span, span) - radius.square()) / (radius * 2.0);
        [row, T::zero()]
    }

    #[inline]
    fn gradients<T: Number>(&self, at: &Situation<'_, T>, emit: impl FnMut(Gradient<T>)) -> T {
        let (span, radius) = self.span(at);
        self.emit_along(at, span.map(|x| x / radius), emit);
        T::zero()
    }

    /// By how much the point is farther from the arc's centre than the radius: the row is that to first order.
    fn openings<T: Number>(&self, at: &Situation<'_, T>) -> [T; 2] {
        let (span, radius) = self.span(at);
        [length(span) - radius, T::zero()]
    }

    fn opening_gradients<T: Number>(&self, at: &Situation<'_, T>, emit: impl FnMut(Gradient<T>)) {
        let (span, _) = self.span(at);
        let length = length(span);
        self.emit_along(at, span.map(|x| x / length), emit);
    }

    fn condition(&self, body: BodyId) -> Option<Condition> {
        let Self { point, arc } = *self;
        if point.body == body {
            Some(Condition::OnArc { own: point, arc })
        } else if arc.body == body {
            Some(Condition::ArcThrough { arc, point })
        } else {
            None
        }
    }

    fn isotropic(&self, at: &Situation<'_, f64>, scale: f64) -> Option<Isotropic> {
        let arc = at.geometry.arc(self.arc);
        let w = Vector::Between([
            (self.arc.body, arc.center),
            (self.point.body, at.geometry.marker(self.point)),
        ]);
        let r = arc.radius / scale;
        Some(Isotropic::Bilinear {
            products: vec![(1.0, w, w)],
            constant: -r * r,
        })
    }

    fn load_point(&self, _: BodyId) -> Option<LoadPoint> {
        Some(LoadPoint::At(self.point))
    }

    fn rubs(&self) -> Option<Rubs> {
        Some(Rubs::AlongGuide)
    }

    fn sliding<T: Number>(&self, at: &Situation<'_, T>) -> Option<Sliding<T>> {
        let (span, _) = self.span(at);
        let length = length(span);
        Some(Sliding::Along {
            point: self.point,
            on: self.arc.body,
            tangent: left(span).map(|x| x / length),
        })
    }
}
