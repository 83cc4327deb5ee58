//! Motors: what a torque-speed curve leaves over what is needed.

use kempe_model::{self as model, DriveId};
use kempe_number::Number;

use crate::problem::Problem;

/// A motor behind a turning drive.
#[derive(Clone, Debug)]
pub struct Motor<T> {
    /// The drive.
    pub drive: DriveId,
    /// Speed (rad/s) and torque (N m), speeds rising; the torque is along the speed's positive sense.
    pub curve: Vec<(T, T)>,
}

impl<T: Number> Motor<T> {
    /// Evaluates a motor's curve.
    pub(crate) fn new(motor: &model::Motor, parameters: &[T], problems: &mut Vec<Problem>) -> Self {
        let of = |scalar: &model::Scalar| model::value(scalar, parameters);
        let curve: Vec<(T, T)> = (motor.curve.iter())
            .map(|(speed, torque)| (of(speed), of(torque)))
            .collect();
        let rises = |w: &[(T, T)]| w[1].0.value() > w[0].0.value();
        if curve.is_empty() || !curve.windows(2).all(rises) {
            problems.push(Problem::new(
                "motor-curve",
                &motor.span,
                "a motor's curve needs points with rising speed",
            ));
        }
        Self {
            drive: motor.drive,
            curve,
        }
    }

    /// The torque it can give at a speed, N m: linear between the curve's points, none beyond its last one. A curve of
    /// positive speeds holds for both senses of turning.
    pub fn torque(&self, speed: T) -> T {
        let one_sided = self.curve.first().is_some_and(|p| p.0.value() >= 0.0);
        let x = if one_sided { speed.abs() } else { speed };
        match self.curve.as_slice() {
            [] => T::zero(),
            [first, ..] => (x - first.0).choose_with(|| beyond(&self.curve, x), || first.1),
        }
    }

    /// What it has left, N m, when it must give `needed` at a speed: negative when it is too weak. Braking takes nothing
    /// from it.
    pub fn margin(&self, needed: T, speed: T) -> T {
        let along = speed.choose(needed, -needed);
        self.torque(speed) - along.max(T::zero())
    }
}

/// The torque at a speed that is not below the first of these points.
fn beyond<T: Number>(curve: &[(T, T)], x: T) -> T {
    match curve {
        [low, high, ..] => (x - high.0).choose_with(
            || beyond(&curve[1..], x),
            || low.1 + (high.1 - low.1) * ((x - low.0) / (high.0 - low.0)),
        ),
        [last] => (last.0 - x).choose_with(|| last.1, T::zero),
        [] => T::zero(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn margin_along_the_curve() {
        let motor = Motor {
            drive: DriveId(0),
            curve: vec![(0.0, 30.0), (100.0, 30.0), (150.0, 0.0)],
        };
        assert_eq!(motor.torque(50.0), 30.0);
        assert_eq!(motor.torque(-125.0), 15.0);
        assert_eq!(motor.torque(200.0), 0.0);
        assert_eq!(motor.margin(40.0, 50.0), -10.0);
        assert_eq!(motor.margin(-40.0, 50.0), 30.0);
        assert_eq!(motor.margin(-40.0, -50.0), -10.0);
    }
}
