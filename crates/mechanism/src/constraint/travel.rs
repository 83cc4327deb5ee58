//! A drive along a guide: a point's coordinate along a line is the drive's. Its row is how far the point is ahead.

use kempe_model::{DriveId, LinkId};
use kempe_number::Number;

use super::isotropic::{Isotropic, Vector};
use super::joint::{Gradient, Joint, Pairs, Touch};
use super::loads::LoadPoint;
use super::situation::Situation;
use crate::ids::{BodyId, LineRef, Marker};
use crate::parts::Parts;
use crate::pose::{cross, dot, sub};
use crate::step::Condition;

/// A point's coordinate along a line is the drive's coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Travel {
    /// The point.
    pub point: Marker,
    /// The line.
    pub line: LineRef,
    /// The drive.
    pub input: DriveId,
}

impl Joint for Travel {
    fn touches(&self) -> [Option<Touch>; 3] {
        [
            Some(Touch::Point(self.point)),
            Some(Touch::Whole(self.line.body)),
            None,
        ]
    }

    fn drive(&self) -> Option<DriveId> {
        Some(self.input)
    }

    fn pairs(&self) -> Pairs {
        Pairs::default()
    }

    fn links(&self, parts: &Parts) -> Vec<LinkId> {
        vec![parts.link_of(self.point), parts.link_of_line(self.line)]
    }

    #[inline]
    fn residual<T: Number>(&self, at: &Situation<'_, T>) -> [T; 2] {
        let input = at.inputs[self.input.index()].value;
        [travelled(at, self.point, self.line) - input, T::zero()]
    }

    #[inline]
    fn gradients<T: Number>(&self, at: &Situation<'_, T>, emit: impl FnMut(Gradient<T>)) -> T {
        travel_gradients(at, self.point, self.line, emit);
        -T::one()
    }

    fn condition(&self, body: BodyId) -> Option<Condition> {
        let Self { point, line, input } = *self;
        if point.body == body {
            Some(Condition::TravelOn {
                own: point,
                line,
                input,
            })
        } else if line.body == body {
            Some(Condition::TravelThrough { line, point, input })
        } else {
            None
        }
    }

    fn isotropic(&self, at: &Situation<'_, f64>, scale: f64) -> Option<Isotropic> {
        let (t, w) = Vector::along(at, self.line, self.point);
        let q = at.inputs[self.input.index()].value / scale;
        Some(Isotropic::Bilinear {
            products: vec![(1.0, w, t), (1.0, t, w)],
            constant: -2.0 * q,
        })
    }

    fn load_point(&self, _: BodyId) -> Option<LoadPoint> {
        Some(LoadPoint::At(self.point))
    }
}

/// Coordinate of a point along a line, m.
#[inline]
pub(super) fn travelled<T: Number>(at: &Situation<'_, T>, point: Marker, line: LineRef) -> T {
    let (origin, direction) = at.line(line);
    dot(direction, sub(at.place(point), origin))
}

/// Its derivatives.
#[inline]
pub(super) fn travel_gradients<T: Number>(
    at: &Situation<'_, T>,
    point: Marker,
    line: LineRef,
    mut emit: impl FnMut(Gradient<T>),
) {
    let (p, t) = (at.place(point), at.line(line).1);
    emit(Gradient {
        row: 0,
        body: point.body,
        to: [t[0], t[1], cross(at.arm(point), t)],
    });
    emit(Gradient {
        row: 0,
        body: line.body,
        to: [-t[0], -t[1], cross(t, at.arm_to(line.body, p))],
    });
}
