//! Motors: what a torque-speed curve leaves over what is needed.

use kempe_mechanism::Mechanism;
use kempe_model::{self as model, DriveId};
use kempe_number::piecewise;

use crate::amount::Amount;
use crate::number::{ForceNumber, PlainNumber};
use crate::problem::Problem;

/// A motor behind a turning drive.
#[derive(Clone, Debug)]
pub struct Motor<T> {
    /// The drive.
    pub drive: DriveId,
    /// Speed (rad/s) and torque (N m), speeds rising; the torque is along the speed's positive sense.
    pub curve: Vec<(T, T)>,
    /// The part of it that it gives in a simulation; the whole where it is not said.
    pub throttle: Option<Amount<T>>,
}

impl<T: ForceNumber> Motor<T> {
    /// Evaluates a motor's curve.
    pub(crate) fn new(
        mechanism: &Mechanism,
        motor: &model::Motor,
        parameters: &[T],
        problems: &mut Vec<Problem>,
    ) -> Self {
        let of = |scalar: &model::Scalar| model::value(scalar, parameters);
        let curve: Vec<(T, T)> = (motor.curve.iter())
            .map(|(speed, torque)| (of(speed), of(torque)))
            .collect();
        let rises = |w: &[(T, T)]| {
            let mut lanes = 0..T::Plain::LANES;
            lanes.all(|lane| w[1].0.value_in(lane) > w[0].0.value_in(lane))
        };
        if curve.is_empty() || !curve.windows(2).all(rises) {
            problems.push(Problem::new(
                "motor-curve",
                &motor.span,
                "a motor's curve needs points with rising speed",
            ));
        }
        let throttle = motor.throttle.as_ref().map(|throttle| {
            let name = mechanism.model.drives.get(motor.drive.index());
            let what = format!("the throttle of `{}`", name.map_or("", |d| d.name.as_str()));
            Amount::new(
                mechanism,
                throttle,
                parameters,
                &motor.span,
                &what,
                problems,
            )
        });
        Self {
            drive: motor.drive,
            curve,
            throttle,
        }
    }

    /// The torque it can give at a speed, N m: linear between the curve's points, none beyond its last one. A curve of
    /// positive speeds holds for both senses of turning.
    pub fn torque(&self, speed: T) -> T {
        let points = &self.curve;
        let [Some(first), Some(last)] = [points.first(), points.last()] else {
            return T::zero();
        };
        let x = first.0.choose_with(|| speed.abs(), || speed);
        // What lies below the first point is a piece, too.
        let past = |k: usize| x - points[k - 1].0;
        let piece = |k: usize| match k {
            0 => [points[0].1],
            _ => {
                let (low, high) = (points[k - 1], points[k]);
                [low.1 + (high.1 - low.1) * ((x - low.0) / (high.0 - low.0))]
            }
        };
        let [torque] = piecewise(points.len(), &past, &piece);
        (last.0 - x).choose(torque, T::zero())
    }

    /// The torque with which it turns a drive that is let go, N m, at a speed along its own sense: where it is turned back, as
    /// at its curve's first point.
    pub fn turns_with(&self, speed: T) -> T {
        match self.curve.first() {
            Some(first) => self.torque((speed - first.0).choose(speed, first.0)),
            None => T::zero(),
        }
    }

    /// What it has left, N m, when it must give `needed` at a speed: negative when it is too weak. Braking takes nothing
    /// from it.
    pub fn margin(&self, needed: T, speed: T) -> T {
        let along = speed.choose(needed, -needed);
        self.torque(speed) - along.max(T::zero())
    }
}

impl Motor<f64> {
    /// The torque of a part of it, N m, at a speed along its own sense: a part below 0 drives it backwards, by the same curve.
    pub fn gives(&self, part: f64, speed: f64) -> f64 {
        let sense = if part < 0.0 { -1.0 } else { 1.0 };
        part * self.turns_with(sense * speed)
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
            throttle: None,
        };
        assert_eq!(motor.torque(50.0), 30.0);
        assert_eq!(motor.torque(-125.0), 15.0);
        assert_eq!(motor.torque(200.0), 0.0);
        assert_eq!(motor.margin(40.0, 50.0), -10.0);
        assert_eq!(motor.margin(-40.0, 50.0), 30.0);
        assert_eq!(motor.margin(-40.0, -50.0), -10.0);
        for speed in [-200.0, -125.0, -50.0, 0.0, 50.0, 125.0, 200.0] {
            assert_eq!(motor.gives(-0.5, speed), -motor.gives(0.5, -speed));
        }
        assert_eq!(
            [-125.0, 125.0].map(|w| motor.gives(-1.0, w)),
            [-15.0, -30.0]
        );
    }
}
