//! The middle of a box: Newton's method on plain numbers.

use kempe_linear::Qr;
use kempe_mechanism::Mechanism;
use kempe_mechanism::blocks::Unknown;
use kempe_mechanism::constraint::{Input, Situation};
use kempe_mechanism::pose::Pose;
use kempe_number::{Interval, math};

use super::given::Given;
use super::system::{Middle, System};
use crate::not_proved::NotProved;

/// Newton steps on plain numbers that polish the middle of a box.
const POLISH: usize = 8;

/// A step below this (mechanism sizes and rad) is the last.
const SETTLED: f64 = 1e-14;
/// So is a step below this that is not shorter than the last one by the factor `SLOW`: rounding keeps it from shrinking.
const ROUNDING: f64 = 1e-9;
const SLOW: f64 = 0.3;

impl System {
    /// Moves the middle to the pose. Returns the Jacobian there, factored, and its approximate inverse, row after row.
    pub(super) fn polish(
        &self,
        given: &Given<'_>,
        inputs: &[Input<f64>],
        poses: &[Pose<Interval>],
        middle: &mut Middle,
    ) -> Result<(Qr, Vec<f64>), NotProved> {
        let qr = self.settle(given, inputs, poses, middle);
        let qr = qr.ok_or(NotProved::NoPose)?;
        let inverse = self.inverse(&qr).ok_or(NotProved::Singular)?;
        Ok((qr, inverse))
    }

    /// Newton's method. `None` when it does not settle.
    fn settle(
        &self,
        given: &Given<'_>,
        inputs: &[Input<f64>],
        poses: &[Pose<Interval>],
        middle: &mut Middle,
    ) -> Option<Qr> {
        let mut poses: Vec<Pose<f64>> = poses.iter().map(Pose::value).collect();
        let mut qr = Qr::with_capacity(self.size, self.size);
        let mut last = f64::INFINITY;
        for _ in 0..POLISH {
            self.plain_poses(middle, &mut poses);
            let situation = Situation {
                geometry: given.plain,
                inputs,
                poses: &poses,
                near: given.near,
            };
            let mut step = self.residuals(given.mechanism, &situation);
            self.factor(given.mechanism, &situation, &mut qr);
            qr.solve(&mut step);
            let mut length = 0.0_f64;
            for &(unknown, column) in &self.columns.unknowns {
                let at = &mut middle[unknown.body().index()];
                match unknown {
                    Unknown::Place(_) => {
                        at[0] -= step[column];
                        at[1] -= step[column + 1];
                        let part = (step[column].abs() + step[column + 1].abs()) / given.size;
                        length = math::max(length, part);
                    }
                    Unknown::Angle(_) => {
                        at[2] -= step[column];
                        length = math::max(length, step[column].abs());
                    }
                }
            }
            if !length.is_finite() {
                return None;
            }
            if length < SETTLED || (length < ROUNDING && length > SLOW * last) {
                return Some(qr);
            }
            last = length;
        }
        None
    }

    /// Plain poses of a middle; bodies that are not sought keep the pose they have.
    fn plain_poses(&self, middle: &Middle, poses: &mut [Pose<f64>]) {
        for (unknown, _) in &self.columns.unknowns {
            let body = unknown.body().index();
            let [x, y, angle] = middle[body];
            let pose = &mut poses[body];
            match unknown {
                Unknown::Place(_) => (pose.x, pose.y) = (x, y),
                Unknown::Angle(_) => (pose.s, pose.c) = math::sin_cos(angle),
            }
        }
    }

    fn factor(&self, mechanism: &Mechanism, situation: &Situation<'_, f64>, qr: &mut Qr) {
        qr.reset(self.size, self.size);
        self.jacobian(mechanism, situation, |row, column, value| {
            qr.add(row, column, value)
        });
        qr.factor();
    }

    /// The approximate inverse, row after row.
    fn inverse(&self, qr: &Qr) -> Option<Vec<f64>> {
        let n = self.size;
        let mut inverse = vec![0.0; n * n];
        for column in 0..n {
            let mut unit = vec![0.0; n];
            unit[column] = 1.0;
            qr.solve(&mut unit);
            for (row, value) in unit.iter().enumerate() {
                inverse[row * n + column] = *value;
            }
        }
        inverse.iter().all(|v| v.is_finite()).then_some(inverse)
    }
}
