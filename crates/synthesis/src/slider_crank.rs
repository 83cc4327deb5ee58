//! Slider-cranks as geometry: the slider on the frame, or on the body.

use std::f64::consts::{FRAC_PI_2, PI};

use kempe_linear::C;
use kempe_number::math;

use crate::four_bar::{Turning, sign, within_a_turn};
use crate::pose::{Line, Pose, cross, dot};

/// The part of the sum of lengths to which sums of lengths are equal.
const SAME_LENGTH: f64 = 1e-9;

/// How a crank of a radius turns whose end stays within a reach of a line at a height over its pivot; angles from the line's direction.
fn turning_beside(radius: f64, reach: f64, height: f64, angle: f64) -> Turning {
    let (low, high) = ((height - reach) / radius, (height + reach) / radius);
    let low = (low > -1.0 + SAME_LENGTH).then(|| math::asin(low.min(1.0)));
    let high = (high < 1.0 - SAME_LENGTH).then(|| math::asin(high.max(-1.0)));
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
            let ahead = math::cos(angle) >= 0.0;
            Turning::Rocker {
                middle: if ahead { middle } else { PI - middle },
                half: 0.5 * (high - low),
            }
        }
    }
}

/// The smallest and the largest value of a function of the sine of an angle that goes from one through `by`.
fn range_over_sine(from: f64, by: f64, value: impl Fn(f64) -> f64) -> [f64; 2] {
    let mut range = [value(from), value(from + by)];
    range.sort_by(f64::total_cmp);
    let [low, high] = [from.min(from + by), from.max(from + by)];
    for extreme in [FRAC_PI_2, -FRAC_PI_2] {
        if low + within_a_turn(extreme - low) <= high {
            let there = value(extreme);
            range = [math::min(range[0], there), math::max(range[1], there)];
        }
    }
    range
}

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
        turning_beside(a, b, h, angle)
    }

    /// The transmission angle with the crank driven, rad, from 0 to pi: between the coupler and the guide's normal.
    pub fn transmission_angle(&self, angle: f64) -> f64 {
        let [a, b, h] = self.dimensions();
        math::acos(((h - a * math::sin(angle)) / b).clamp(-1.0, 1.0))
    }

    /// The smallest and the largest transmission angle (rad, 0 to pi) while the crank goes from an angle through `by`, both rad.
    pub fn transmission_range(&self, from: f64, by: f64) -> [f64; 2] {
        range_over_sine(from, by, |angle| self.transmission_angle(angle))
    }

    /// The slider's place along the guide, from where that is nearest to the crank's pivot.
    pub fn slider_place(&self, pose: &Pose) -> f64 {
        dot(
            self.guide.direction,
            pose.place(self.moving[1]) - self.fixed,
        )
    }

    /// On which side of the line from the crank's pivot to the slider the crank is: 1 left, -1 right. With the slider driven, the
    /// branch.
    pub fn slider_branch(&self, pose: &Pose) -> i8 {
        let [a, b] = self.moving.map(|m| pose.place(m) - self.fixed);
        sign(cross(b, a))
    }

    /// How far the slider goes, on the circuit of a place: the middle of its travel and half of it. At the ends crank and coupler are in
    /// line.
    pub fn travel(&self, place: f64) -> [f64; 2] {
        let [a, b, h] = self.dimensions();
        let at = |reach: f64| math::max(reach * reach - h * h, 0.0).sqrt();
        let outer = at(a + b);
        if self.is_grashof() {
            let inner = at(a - b);
            let middle = 0.5 * (outer + inner);
            [middle.copysign(place), 0.5 * (outer - inner)]
        } else {
            [0.0, outer]
        }
    }

    /// The transmission angle with the slider driven, rad, from 0 to pi: between coupler and crank.
    pub fn slider_transmission_angle(&self, place: f64) -> f64 {
        let [a, b, h] = self.dimensions();
        math::acos(((a * a + b * b - place * place - h * h) / (2.0 * a * b)).clamp(-1.0, 1.0))
    }

    /// The smallest and the largest transmission angle (rad, 0 to pi) while the slider goes from one place through `by`.
    pub fn slider_transmission_range(&self, from: f64, by: f64) -> [f64; 2] {
        let to = from + by;
        let mut range = [from, to].map(|place| self.slider_transmission_angle(place));
        range.sort_by(f64::total_cmp);
        if from * to < 0.0 {
            range[0] = math::min(range[0], self.slider_transmission_angle(0.0));
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

    /// The guide's angle, from the line from its pivot to the crank's, rad.
    pub fn guide_angle(&self, pose: &Pose) -> f64 {
        let along = pose.turn() * self.guide.direction;
        let angle = along * (self.fixed[0] - self.fixed[1]).conj();
        math::atan2(angle.im, angle.re)
    }

    /// Whether the crank's end is ahead of its pivot along the guide, 1, or behind it, -1: with the guide driven, the branch.
    pub fn guide_branch(&self, pose: &Pose) -> i8 {
        let along = pose.turn() * self.guide.direction;
        sign(dot(along, pose.place(self.moving) - self.fixed[0]))
    }

    /// How the guide turns, on the circuit of its angle: where the crank is square to it it can go no further.
    pub fn guide_turning(&self, angle: f64) -> Turning {
        let [a, g, h] = self.dimensions();
        turning_beside(g, a, h, angle)
    }

    /// The transmission angle with the guide driven, rad, from 0 to pi: between the crank and the guide's normal.
    pub fn guide_transmission_angle(&self, angle: f64) -> f64 {
        let [a, g, h] = self.dimensions();
        math::acos(((h - g * math::sin(angle)) / a).clamp(-1.0, 1.0))
    }

    /// The smallest and the largest transmission angle (rad, 0 to pi) while the guide goes from an angle through `by`, both rad.
    pub fn guide_transmission_range(&self, from: f64, by: f64) -> [f64; 2] {
        range_over_sine(from, by, |angle| self.guide_transmission_angle(angle))
    }
}
