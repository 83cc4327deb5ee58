//! An angle between two bodies: of a slider on its guide, or driven. Its row is the sine of what is missing.

use kempe_model::{DriveId, LinkId};
use kempe_number::{Number, math};

use super::isotropic::{Isotropic, Vector};
use super::joint::{Gradient, InAngles, Joint, Pairs, Touch, Unit};
use super::loads::LoadPoint;
use super::situation::Situation;
use crate::ids::BodyId;
use crate::parts::Parts;
use crate::pose::{cross, dot};
use crate::step::Step;

/// `angle(a) - angle(b) = offset (+ the drive's coordinate)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction {
    /// Body whose angle is set.
    pub a: BodyId,
    /// Body against which.
    pub b: BodyId,
    /// Index into the geometry's angles.
    pub offset: u32,
    /// The drive whose coordinate is added.
    pub input: Option<DriveId>,
}

impl Direction {
    /// The wanted direction of body `a`, as a unit vector.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn wanted<T: Number>(&self, at: &Situation<'_, T>) -> [T; 2] {
        let base = at.poses[self.b.index()].turn(at.geometry.angles[self.offset as usize]);
        self.driven(at, base)
    }

    /// A vector turned on by the drive's coordinate.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn driven<T: Number>(&self, at: &Situation<'_, T>, base: [T; 2]) -> [T; 2] {
        match self.input {
            Some(drive) => {
                let q = &at.inputs[drive.index()];
                [base[0] * q.c - base[1] * q.s, base[1] * q.c + base[0] * q.s]
            }
            None => base,
        }
    }
}

impl Joint for Direction {
    fn unit(&self) -> Unit {
        Unit::Angle
    }

    fn touches(&self) -> [Option<Touch>; 3] {
        [Some(Touch::Angle(self.a)), Some(Touch::Angle(self.b)), None]
    }

    fn drive(&self) -> Option<DriveId> {
        self.input
    }

    fn pairs(&self) -> Pairs {
        match self.input {
            Some(_) => Pairs::default(),
            // A slider's direction belongs to its own line: together one lower pair.
            None => Pairs {
                links: 0,
                lower: 1,
                higher: -1,
            },
        }
    }

    fn links(&self, parts: &Parts) -> Vec<LinkId> {
        let source = &parts.angles[self.offset as usize];
        vec![source.a, source.b]
    }

    #[inline]
    fn residual<T: Number>(&self, at: &Situation<'_, T>) -> [T; 2] {
        let pose = &at.poses[self.a.index()];
        [cross(self.wanted(at), [pose.c, pose.s]), T::zero()]
    }

    #[inline]
    fn gradients<T: Number>(&self, at: &Situation<'_, T>, mut emit: impl FnMut(Gradient<T>)) -> T {
        let pose = &at.poses[self.a.index()];
        let cosine = dot(self.wanted(at), [pose.c, pose.s]);
        emit(Gradient::to_angle(self.a, cosine));
        emit(Gradient::to_angle(self.b, -cosine));
        if self.input.is_some() {
            -cosine
        } else {
            T::zero()
        }
    }

    fn is_reversed<T: Number>(&self, at: &Situation<'_, T>) -> bool {
        let pose = &at.poses[self.a.index()];
        dot(self.wanted(at), [pose.c, pose.s]).value() < 0.0
    }

    fn turn(&self, body: BodyId, _: usize) -> Option<Step> {
        let reversed = self.a != body;
        Some(Step::Turn {
            body,
            from: if reversed { self.a } else { self.b },
            offset: self.offset,
            input: self.input,
            reversed,
        })
    }

    fn isotropic(&self, at: &Situation<'_, f64>, _: f64) -> Option<Isotropic> {
        let by = self.driven(at, at.geometry.angles[self.offset as usize]);
        Some(Isotropic::Same {
            directions: [Vector::Fixed(self.a, [1.0, 0.0]), Vector::Fixed(self.b, by)],
            bodies: [self.a, self.b],
        })
    }

    fn in_angles(&self, at: &Situation<'_, f64>) -> Option<InAngles> {
        let by = at.geometry.angles[self.offset as usize];
        let drive = self.input.map_or(0.0, |d| at.inputs[d.index()].value);
        Some(InAngles {
            terms: [(self.a, 1.0), (self.b, -1.0), (self.b, 0.0)],
            constant: math::atan2(by[1], by[0]) + drive,
        })
    }

    fn load_point(&self, _: BodyId) -> Option<LoadPoint> {
        None
    }
}
