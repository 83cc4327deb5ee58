//! Poses proved by interval arithmetic: Krawczyk's operator on the constraint rows.
//!
//! For a system F(x) = 0, a plain approximate inverse Y of its Jacobian at x0 and a box U of corrections about x0,
//!
//! K(U) = -Y F(x0) + (I - Y J(x0 + U)) U.
//!
//! If K(U) lies in the interior of U, then F has exactly one zero in x0 + U, it lies in x0 + K(U), and every matrix of
//! J(x0 + U) is regular (R. Krawczyk, Computing 4 (1969) 187; R. E. Moore, SIAM J. Numer. Anal. 14 (1977) 611; S. M.
//! Rump, Acta Numerica 19 (2010) 287, theorem 13.2). All of it holds for every value of a parameter at once when F and J
//! are evaluated for an interval of that parameter: existence and uniqueness all along a stretch of the motion
//! (A. Neumaier, *Interval Methods for Systems of Equations*, 1990, section 5.1).
//!
//! The unknowns are x, y (m) and the angle (rad) of the bodies, an angle entering the rows by enclosures of its sine and
//! cosine: a direction can not leave the unit circle. A box is looked for by epsilon inflation (S. M. Rump, 1983): the
//! image, a little widened, is tried as the next box.
//!
//! `System` is the rows and unknowns, `polish` finds the middle on plain numbers, `contract` looks for the box, `tube` proves
//! a stretch of a motion, and `block` lets a plan run on intervals.

mod block;
mod contract;
mod polish;
mod system;
mod tube;

pub(crate) use self::block::enclose_block;
pub(crate) use self::system::System;
pub(crate) use self::tube::{Curve, Tube};

use kempe_mechanism::Design;
use kempe_mechanism::Mechanism;
use kempe_mechanism::constraint::{Input, Situation};
use kempe_mechanism::geometry::Geometry;
use kempe_mechanism::pose::Pose;
use kempe_number::{Interval, Number};

use self::contract::multiply;
use crate::not_proved::NotProved;

/// What the rows are evaluated with.
pub(crate) struct Given<'a> {
    pub mechanism: &'a Mechanism,
    pub geometry: &'a Geometry<Interval>,
    pub plain: &'a Geometry<f64>,
    pub inputs: &'a [Input<Interval>],
    pub near: &'a [f64],
    /// Size of the mechanism, m.
    pub size: f64,
}

impl<'a> Given<'a> {
    /// A design's dimensions at the drives' `inputs`; `size` is the mechanism's, m.
    pub fn new(
        design: &'a Design<Interval>,
        inputs: &'a [Input<Interval>],
        near: &'a [f64],
        size: f64,
    ) -> Self {
        let mechanism = &*design.mechanism;
        Self {
            mechanism,
            geometry: &design.geometry,
            plain: &design.plain[0],
            inputs,
            near,
            size,
        }
    }

    /// What the rows see at some poses.
    fn situation<'s>(&'s self, poses: &'s [Pose<Interval>]) -> Situation<'s, Interval> {
        Situation {
            geometry: self.geometry,
            inputs: self.inputs,
            poses,
            near: self.near,
        }
    }
}

/// The middle of a box: x, y and angle of every body.
pub(crate) type Middle = Vec<[f64; 3]>;

/// The middle of poses with unwrapped angles near `near`.
pub(crate) fn middle_of(poses: &[Pose<f64>], near: &[f64]) -> Middle {
    let parts = poses.iter().zip(near);
    parts
        .map(|(pose, near)| [pose.x, pose.y, pose.angle_near(*near)])
        .collect()
}

impl System {
    /// Proves one pose near `middle` for the given inputs, which may be intervals, and encloses it in `poses`. Poses of
    /// bodies that are not sought are taken as they are. Returns where it lies about the middle, and the determinant there.
    pub fn enclose(
        &self,
        given: &Given<'_>,
        middle: &mut Middle,
        poses: &mut [Pose<Interval>],
    ) -> Result<(Vec<Interval>, f64), NotProved> {
        let plain_inputs: Vec<Input<f64>> = given.inputs.iter().map(Input::plain).collect();
        let (qr, inverse) = self.polish(given, &plain_inputs, poses, middle)?;
        let still = vec![0.0; self.size];
        let zero = Interval::from_f64(0.0);
        let here = (still.as_slice(), zero);
        self.spread(middle, here, &vec![zero; self.size], poses);
        let residuals = self.residuals(given.mechanism, &given.situation(poses));
        let value = multiply(&inverse, &residuals);
        let (_, image) = self.contract(given, &inverse, &value, false, poses, |reach, poses| {
            self.spread(middle, here, reach, poses);
        })?;
        self.spread(middle, here, &image, poses);
        Ok((image, qr.determinant()))
    }
}
