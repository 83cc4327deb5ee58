//! A pin: two points coincide. Its rows are the distance from the first to the second along the frame's axes.

use kempe_model::LinkId;
use kempe_number::Number;

use super::isotropic::{Isotropic, Vector};
use super::joint::{Gradient, Joint, Pairs, Touch};
use super::loads::{LoadPoint, Rubs, Sliding};
use super::situation::Situation;
use crate::ids::{BodyId, Marker};
use crate::parts::Parts;
use crate::pose::sub;

/// Two points coincide: two rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coincide {
    /// Point of the earlier body.
    pub a: Marker,
    /// Point of the later body.
    pub b: Marker,
}

impl Joint for Coincide {
    fn rows(&self) -> usize {
        2
    }

    fn touches(&self) -> [Option<Touch>; 3] {
        [Some(Touch::Point(self.a)), Some(Touch::Point(self.b)), None]
    }

    fn pairs(&self) -> Pairs {
        Pairs {
            lower: 1,
            ..Pairs::default()
        }
    }

    fn links(&self, parts: &Parts) -> Vec<LinkId> {
        vec![parts.link_of(self.b), parts.link_of(self.a)]
    }

    #[inline]
    fn residual<T: Number>(&self, at: &Situation<'_, T>) -> [T; 2] {
        sub(at.place(self.b), at.place(self.a))
    }

    #[inline]
    fn gradients<T: Number>(&self, at: &Situation<'_, T>, mut emit: impl FnMut(Gradient<T>)) -> T {
        let (zero, one) = (T::zero(), T::one());
        for (marker, sign) in [(self.b, 1.0), (self.a, -1.0)] {
            let r = at.arm(marker);
            emit(Gradient {
                row: 0,
                body: marker.body,
                to: [one * sign, zero, r[1] * -sign],
            });
            emit(Gradient {
                row: 1,
                body: marker.body,
                to: [zero, one * sign, r[0] * sign],
            });
        }
        zero
    }

    fn pin(&self, body: BodyId) -> Option<(Marker, Marker)> {
        if self.a.body == body {
            Some((self.a, self.b))
        } else if self.b.body == body {
            Some((self.b, self.a))
        } else {
            None
        }
    }

    fn isotropic(&self, at: &Situation<'_, f64>, _: f64) -> Option<Isotropic> {
        Some(Isotropic::Vanishes(Vector::between(at, self.a, self.b)))
    }

    fn load_point(&self, _: BodyId) -> Option<LoadPoint> {
        Some(LoadPoint::At(self.b))
    }

    fn rubs(&self) -> Option<Rubs> {
        Some(Rubs::AboutPin)
    }

    fn sliding<T: Number>(&self, _: &Situation<'_, T>) -> Option<Sliding<T>> {
        Some(Sliding::Turning {
            a: self.a.body,
            b: self.b.body,
        })
    }
}
