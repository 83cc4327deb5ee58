//! Slider-cranks as geometry: the slider on the frame, or on the body.

use std::f64::consts::{FRAC_PI_2, PI};

use kempe_linear::C;
use kempe_number::math;

use crate::four_bar::{Turning, sign, within_a_turn};
use crate::pose::{Line, Pose, cross, dot};

/// The part of the sum of lengths to which sums of lengths are equal.
const SAME_LENGTH: f64 = 1e-9;

/// A crank, a coupler that carries the body, and a pin of it on a fixed guide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliderCrank {
    /// The crank's fixed pivot.
    pub fixed: C,
    /// The crank's length.
    pub crank: f64,
    /// The crank's moving pivot, and the slider's pin, as points of the coupler.
    pub moving: [C; 2],
    /// The slider's guide.
    pub guide: Line,
}

impl SliderCrank {
    /// Crank, coupler, and how far the guide passes to the left of the fixed pivot, seen along it.
    pub fn dimensions(&self) -> [f64; 3] {
        let coupler = self.moving[1] - self.moving[0];
        [
            self.crank,
            math::hypot(coupler.re, coupler.im),
            -self.guide.distance(self.fixed),
        ]
    }

    /// Whether the shorter of crank and coupler turns fully: their difference exceeds the offset. Else there is one circuit.
    pub fn is_grashof(&self) -> bool {
        let [a, b, h] = self.dimensions();
        (a - b).abs() > h.abs() + SAME_LENGTH * (a + b)
    }

    /// The crank's angle from the guide's direction, rad.
    pub fn crank_angle(&self, pose: &Pose) -> f64 {
        let crank = (pose.place(self.moving[0]) - self.fixed) * self.guide.direction.conj();
        math::atan2(crank.im, crank.re)
    }

    /// Whether the slider is ahead of the crank's end along the guide, 1, or behind it, -1: with the crank driven, the branch.
    pub fn branch(&self, pose: &Pose) -> i8 {
        let [a, b] = self.moving.map(|m| pose.place(m));
        sign(dot(self.guide.direction, b - a))
    }

    /// Which circuit a pose is on: 1 or -1, or 0 where there is only one.
    pub fn circuit(&self, pose: &Pose) -> i8 {
        if !self.is_grashof() {
            return 0;
        }
        let [a, b, _] = self.dimensions();
        if a < b {
            self.branch(pose)
        } else {
            sign(dot(
                self.guide.direction,
                pose.place(self.moving[0]) - self.fixed,
            ))
        }
    }

    /// How the crank turns, on the circuit of an angle: where coupler and guide are square to each other it can go no further.
    pub fn turning(&self, angle: f64) -> Turning {
        let [a, b, h] = self.dimensions();
        let slack = SAME_LENGTH;
        let (low, high) = ((h - b) / a, (h + b) / a);
        let low = (low > -1.0 + slack).then(|| math::asin(low.min(1.0)));
        let high = (high < 1.0 - slack).then(|| math::asin(high.max(-1.0)));
        match (low, high) {
            (None, None) => Turning::Crank,
            (Some(low), None) => Turning::Rocker {
                middle: FRAC_PI_2,
                half: FRAC_PI_2 - low,
            },
            (None, Some(high)) => Turning::Rocker {
                middle: -FRAC_PI_2,
                half: FRAC_PI_2 + high,
            },
            (Some(low), Some(high)) => {
                let middle = 0.5 * (low + high);
                Turning::Rocker {
                    middle: if math::cos(angle) >= 0.0 {
                        middle
                    } else {
                        PI - middle
                    },
                    half: 0.5 * (high - low),
                }
            }
        }
    }

    /// The transmission angle with the crank driven, rad, from 0 to pi: between the coupler and the guide's normal.
    pub fn transmission_angle(&self, angle: f64) -> f64 {
        let [a, b, h] = self.dimensions();
        math::acos(((h - a * math::sin(angle)) / b).clamp(-1.0, 1.0))
    }

    /// The smallest and the largest transmission angle (rad, 0 to pi) while the crank goes from an angle through `by`, both rad.
    pub fn transmission_range(&self, from: f64, by: f64) -> [f64; 2] {
        let mut range = [from, from + by].map(|angle| self.transmission_angle(angle));
        range.sort_by(f64::total_cmp);
        let [low, high] = [from.min(from + by), from.max(from + by)];
        for extreme in [FRAC_PI_2, -FRAC_PI_2] {
            if low + within_a_turn(extreme - low) <= high {
                let there = self.transmission_angle(extreme);
                range = [math::min(range[0], there), math::max(range[1], there)];
            }
        }
        range
    }
}

/// A crank whose end carries the body, which slides through a fixed pivot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InvertedSliderCrank {
    /// The crank's fixed pivot, and the one that the body slides through.
    pub fixed: [C; 2],
    /// The crank's length.
    pub crank: f64,
    /// The crank's moving pivot, as a point of the body.
    pub moving: C,
    /// The guide, on the body.
    pub guide: Line,
}

impl InvertedSliderCrank {
    /// Crank, frame, and how far the guide passes to the left of the crank's end, seen along it.
    pub fn dimensions(&self) -> [f64; 3] {
        let frame = self.fixed[1] - self.fixed[0];
        [
            self.crank,
            math::hypot(frame.re, frame.im),
            -self.guide.distance(self.moving),
        ]
    }

    /// Whether the crank turns fully: the guide always reaches the pivot. Then there are two circuits.
    pub fn is_grashof(&self) -> bool {
        let [a, g, h] = self.dimensions();
        (a - g).abs() > h.abs() + SAME_LENGTH * (a + g)
    }

    /// The crank's angle from the line of the fixed pivots, rad.
    pub fn crank_angle(&self, pose: &Pose) -> f64 {
        let crank = pose.place(self.moving) - self.fixed[0];
        let angle = crank * (self.fixed[1] - self.fixed[0]).conj();
        math::atan2(angle.im, angle.re)
    }

    /// Whether the pivot is ahead of the crank's end along the guide, 1, or behind it, -1.
    pub fn branch(&self, pose: &Pose) -> i8 {
        let along = pose.turn() * self.guide.direction;
        sign(dot(along, self.fixed[1] - pose.place(self.moving)))
    }

    /// Which circuit a pose is on: 1 or -1, or 0 where there is only one.
    pub fn circuit(&self, pose: &Pose) -> i8 {
        if self.is_grashof() {
            self.branch(pose)
        } else {
            0
        }
    }

    /// How the crank turns: where its end is as near to the pivot as to the guide it can go no further.
    pub fn turning(&self) -> Turning {
        let [a, g, h] = self.dimensions();
        let least = (a * a + g * g - h * h) / (2.0 * a * g);
        if least < 1.0 - SAME_LENGTH {
            Turning::Rocker {
                middle: PI,
                half: PI - math::acos(least.max(-1.0)),
            }
        } else {
            Turning::Crank
        }
    }

    /// The angle between the guide and the way that the crank's end goes at a pose, rad, 0 to pi/2.
    pub fn guide_angle(&self, pose: &Pose) -> f64 {
        let crank = pose.place(self.moving) - self.fixed[0];
        let along = pose.turn() * self.guide.direction;
        math::atan2(dot(crank, along).abs(), cross(crank, along).abs())
    }
}
