//! Hydraulic cylinders: chamber pressure from force, and what a cylinder can give.
//!
//! Pushing, oil presses on the whole bore; pulling, on the ring that the rod leaves free.

use kempe_model::{self as model, DriveId, HydraulicCylinder};

use crate::number::{ForceNumber, PlainNumber};
use crate::problem::Problem;
use crate::vector::sign;

/// A hydraulic cylinder (or several side by side) behind a drive.
#[derive(Clone, Copy, Debug)]
pub struct Cylinder<T> {
    /// The drive.
    pub drive: DriveId,
    /// Area of the bore of one cylinder, m^2.
    pub bore_area: T,
    /// Area of the ring round the rod of one cylinder, m^2.
    pub ring_area: T,
    /// Highest pressure: the lower one of supply and relief, Pa.
    pub highest: Option<T>,
    /// Pressure on the side that drains, Pa.
    pub back: T,
    /// Flow the pump gives to all cylinders together, m^3/s.
    pub flow: Option<T>,
    /// Seal friction of one cylinder, N.
    pub friction: T,
    /// How many act side by side.
    pub count: T,
}

impl<T: ForceNumber> Cylinder<T> {
    /// Evaluates a cylinder's data.
    pub fn new(cylinder: &HydraulicCylinder, parameters: &[T]) -> Self {
        let of = |scalar: &model::Scalar| model::value(scalar, parameters);
        let disc = |diameter: T| diameter.square() * (std::f64::consts::PI / 4.0);
        let bore_area = disc(of(&cylinder.bore));
        let pressures = [&cylinder.supply, &cylinder.relief].map(|p| p.as_ref().map(of));
        let highest = match pressures {
            [Some(supply), Some(relief)] => Some(supply.min(relief)),
            [supply, relief] => supply.or(relief),
        };
        Self {
            drive: cylinder.drive,
            bore_area,
            ring_area: bore_area - disc(of(&cylinder.rod)),
            highest,
            back: of(&cylinder.back),
            flow: cylinder.flow.as_ref().map(of),
            friction: of(&cylinder.friction),
            count: of(&cylinder.count),
        }
    }

    pub(crate) fn check(&self, cylinder: &HydraulicCylinder, problems: &mut Vec<Problem>) {
        let mut add = |code, message: &str| {
            problems.push(Problem::new(code, &cylinder.span, message));
        };
        if self.ring_area.any_lane(|x| !(x > 0.0)) {
            add(
                "rod-too-thick",
                "the rod is as thick as the bore: the cylinder cannot pull",
            );
        }
        if self.count.any_lane(|x| !(x > 0.0)) {
            add("cylinder-count", "there must be at least one cylinder");
        }
        if self.friction.any_lane(|x| x < 0.0) {
            add(
                "negative-friction",
                "friction is never negative: it would add energy",
            );
        }
        let not_above = |p: T| {
            let mut lanes = 0..T::Plain::LANES;
            lanes.any(|lane| p.value_in(lane) <= self.back.value_in(lane))
        };
        if self.highest.is_some_and(not_above) {
            add(
                "contradictory-pressures",
                "the pressure on the side that drains is not below that of the supply or relief",
            );
        }
    }

    /// Pressure in the chamber that moves the load, Pa, when all cylinders together give `force` (N, positive pushing)
    /// at a speed whose sign is `direction`. Pushing: `p A = F + friction + back A_ring`; pulling: likewise with the
    /// areas exchanged.
    pub fn pressure(&self, force: T, direction: T::Plain) -> T {
        let one = force / self.count + self.friction.times(direction);
        one.choose_with(
            || (one + self.back * self.ring_area) / self.bore_area,
            || (self.back * self.bore_area - one) / self.ring_area,
        )
    }

    /// What all cylinders together can give along the coordinate at their highest pressure, N, moving in the sense
    /// `direction`: the push where a push is asked for (`force >= 0`), the pull (negative) where a pull is. `None`
    /// without a pressure.
    pub fn capacity(&self, force: T, direction: T::Plain) -> Option<T> {
        let highest = self.highest?;
        let one = force.choose_with(
            || highest * self.bore_area - self.back * self.ring_area,
            || self.back * self.bore_area - highest * self.ring_area,
        );
        Some((one - self.friction.times(direction)) * self.count)
    }

    /// Oil that all cylinders together take in at a speed, m^3/s.
    pub fn flow_at(&self, speed: T) -> T {
        let area = speed.choose(self.bore_area, self.ring_area);
        speed.abs() * area * self.count
    }

    /// The speed at which the pump's flow moves it, m/s, in the sense `direction`. `None` without a flow.
    pub fn speed(&self, direction: f64) -> Option<T> {
        let area = if direction >= 0.0 {
            self.bore_area
        } else {
            self.ring_area
        };
        Some(self.flow? / (area * self.count) * sign(direction))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CYLINDER: Cylinder<f64> = Cylinder {
        drive: DriveId(0),
        bore_area: 0.005,
        ring_area: 0.003,
        highest: Some(2e7),
        back: 1e5,
        flow: Some(1e-3),
        friction: 500.0,
        count: 2.0,
    };

    #[test]
    fn pressure_and_capacity_belong_together() {
        let c = &CYLINDER;
        for (force, direction) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
            let capacity = c.capacity(force, direction).unwrap();
            assert!((c.pressure(capacity, direction) / 2e7 - 1.0).abs() < 1e-14);
        }
        assert!((c.pressure(40_000.0, 1.0) - (20_500.0 + 300.0) / 0.005).abs() < 1e-6);
        assert!((c.speed(-1.0).unwrap() + 1e-3 / 0.006).abs() < 1e-15);
    }
}
