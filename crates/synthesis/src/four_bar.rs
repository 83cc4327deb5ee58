//! Four-bars as geometry: lengths, which links turn fully, circuits, branches, transmission.

use std::f64::consts::{PI, TAU};

use kempe_linear::C;
use kempe_number::math;

use crate::pose::{Pose, cross};

/// A four-bar whose coupler carries the body: fixed pivots, and the moving ones as points of the coupler.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FourBar {
    /// The fixed pivots of the first and the second link.
    pub fixed: [C; 2],
    /// The moving pivots, as points of the coupler.
    pub moving: [C; 2],
    /// The lengths of the first and the second link.
    pub lengths: [f64; 2],
}

/// Which link is turned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Driver {
    /// The first.
    First,
    /// The second.
    Second,
}

/// F. Grashof's condition, by the shortest and the longest link against the other two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grashof {
    /// The shortest link turns fully beside its neighbours: two circuits.
    Grashof,
    /// No link turns fully beside another: one circuit.
    NonGrashof,
    /// Both sums are equal: the circuits meet where all pivots are in line.
    ChangePoint,
    /// One link is longer than the others together.
    Open,
}

/// How a link may turn about its fixed pivot, on one circuit. Angles count from the line of the fixed pivots, from this pivot to the
/// other, in rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Turning {
    /// All the way round.
    Crank,
    /// Between two angles.
    Rocker {
        /// The middle of its swing.
        middle: f64,
        /// Half of its swing.
        half: f64,
    },
}

/// The part of the sum of lengths to which sums of lengths are equal.
const SAME_LENGTH: f64 = 1e-9;

impl FourBar {
    /// Lengths of the frame, the first link, the coupler and the second link.
    pub fn all_lengths(&self) -> [f64; 4] {
        let apart = |[a, b]: [C; 2]| math::hypot((b - a).re, (b - a).im);
        [
            apart(self.fixed),
            self.lengths[0],
            apart(self.moving),
            self.lengths[1],
        ]
    }

    /// The longest link over the shortest.
    pub fn link_ratio(&self) -> f64 {
        let lengths = self.all_lengths();
        let longest = lengths.iter().fold(0.0, |m, x| math::max(m, *x));
        longest / lengths.iter().fold(f64::INFINITY, |m, x| math::min(m, *x))
    }

    /// Its type by the lengths.
    pub fn grashof(&self) -> Grashof {
        let mut sorted = self.all_lengths();
        sorted.sort_by(f64::total_cmp);
        let [s, p, q, l] = sorted;
        let excess = (s + l) - (p + q);
        if l > (s + p + q) * (1.0 + SAME_LENGTH) {
            Grashof::Open
        } else if excess.abs() <= SAME_LENGTH * (s + p + q + l) {
            Grashof::ChangePoint
        } else if excess < 0.0 {
            Grashof::Grashof
        } else {
            Grashof::NonGrashof
        }
    }

    /// The same four-bar with first and second exchanged.
    pub fn exchanged(&self) -> Self {
        let turned = |[a, b]: [C; 2]| [b, a];
        Self {
            fixed: turned(self.fixed),
            moving: turned(self.moving),
            lengths: [self.lengths[1], self.lengths[0]],
        }
    }

    /// The same four-bar with the driven link first.
    pub(crate) fn driven_first(&self, driver: Driver) -> Self {
        match driver {
            Driver::First => *self,
            Driver::Second => self.exchanged(),
        }
    }

    /// The moving pivots' places.
    pub fn places(&self, pose: &Pose) -> [C; 2] {
        self.moving.map(|m| pose.place(m))
    }

    /// The angle of the first link from the line of the fixed pivots, rad.
    pub fn first_angle(&self, pose: &Pose) -> f64 {
        let link = pose.place(self.moving[0]) - self.fixed[0];
        let angle = link * (self.fixed[1] - self.fixed[0]).conj();
        math::atan2(angle.im, angle.re)
    }

    /// On which side of the diagonal from the first moving pivot to the second fixed one the second moving pivot is: 1 left, -1 right, 0
    /// where coupler and second link are in line. With the first link driven, the branch.
    pub fn branch(&self, pose: &Pose) -> i8 {
        let [a, b] = self.places(pose);
        sign(cross(self.fixed[1] - a, b - a))
    }

    /// Which circuit a pose is on: 1 or -1 for the two of a Grashof four-bar, 0 where there is only one, or the place is between them.
    pub fn circuit(&self, pose: &Pose) -> i8 {
        if self.grashof() != Grashof::Grashof {
            return 0;
        }
        let lengths = self.all_lengths();
        let shortest = (0..4).min_by(|i, j| lengths[*i].total_cmp(&lengths[*j]));
        let [a, b] = self.places(pose);
        let [a0, b0] = self.fixed;
        // The angle at a joint that is not the shortest link's never passes through 0 or a half turn.
        sign(match shortest {
            Some(0 | 1) => cross(a - b, b0 - b),
            Some(2) => cross(b - b0, a0 - b0),
            _ => cross(a0 - a, b - a),
        })
    }

    /// How the first link turns, on the circuit of a first angle.
    pub fn turning(&self, first_angle: f64) -> Turning {
        let [d, a, b, c] = self.all_lengths();
        // Where coupler and second link are in line: outstretched the largest, folded the smallest angle.
        let at = |diagonal: f64| (a * a + d * d - diagonal * diagonal) / (2.0 * a * d);
        let (outstretched, folded) = (at(b + c), at(b - c));
        let slack = SAME_LENGTH;
        let (most, least) = (
            (outstretched > -1.0 + slack).then(|| math::acos(outstretched.min(1.0))),
            (folded < 1.0 - slack).then(|| math::acos(folded.max(-1.0))),
        );
        match (least, most) {
            (None, None) => Turning::Crank,
            (None, Some(most)) => Turning::Rocker {
                middle: 0.0,
                half: most,
            },
            (Some(least), None) => Turning::Rocker {
                middle: PI,
                half: PI - least,
            },
            (Some(least), Some(most)) => Turning::Rocker {
                middle: (0.5 * (least + most)).copysign(first_angle),
                half: 0.5 * (most - least),
            },
        }
    }

    /// The transmission angle where the first link is driven, rad, from 0 to pi: that between coupler and second link.
    pub fn transmission_angle(&self, first_angle: f64) -> f64 {
        let [d, a, b, c] = self.all_lengths();
        let square = a * a + d * d - 2.0 * a * d * math::cos(first_angle);
        math::acos(((b * b + c * c - square) / (2.0 * b * c)).clamp(-1.0, 1.0))
    }

    /// The smallest and the largest transmission angle (rad, 0 to pi) while the first link goes from one angle through `by`, both rad.
    ///
    /// The diagonal opposite grows from the angle 0 to pi, so extremes are at the ends or there.
    pub fn transmission_range(&self, from: f64, by: f64) -> [f64; 2] {
        let mut range = [from, from + by].map(|angle| self.transmission_angle(angle));
        range.sort_by(f64::total_cmp);
        let [low, high] = [from.min(from + by), from.max(from + by)];
        for extreme in [0.0, PI] {
            let next = low + within_a_turn(extreme - low);
            if next <= high {
                let there = self.transmission_angle(extreme);
                range = [math::min(range[0], there), math::max(range[1], there)];
            }
        }
        range
    }

    /// The pose of the coupler at an angle of the first link, with its other end on the side of a branch (1 left of the diagonal, -1
    /// right); `None` where it does not close.
    pub fn pose(&self, first_angle: f64, branch: i8) -> Option<Pose> {
        let frame = self.fixed[1] - self.fixed[0];
        let a = self.fixed[0]
            + frame.scale(self.lengths[0] / frame.norm()) * C::from_polar(1.0, first_angle);
        let diagonal = self.fixed[1] - a;
        let coupler = self.moving[1] - self.moving[0];
        let (f, b) = (diagonal.norm(), coupler.norm());
        let cos = (f * f + b * b - self.lengths[1] * self.lengths[1]) / (2.0 * f * b);
        if !(cos.abs() <= 1.0) {
            return None;
        }
        let sin = (1.0 - cos * cos).sqrt() * f64::from(branch);
        let turn = diagonal * C::new(cos, sin) * coupler.conj().scale(1.0 / (f * b));
        Some(Pose {
            origin: a - turn * self.moving[0],
            angle: turn.arg(),
        })
    }
}

/// An angle, less whole turns, from 0 to a whole turn.
pub(crate) fn within_a_turn(angle: f64) -> f64 {
    let rest = angle - TAU * (angle / TAU).floor();
    if rest >= TAU { 0.0 } else { rest }
}

pub(crate) fn sign(x: f64) -> i8 {
    if x > 0.0 {
        1
    } else if x < 0.0 {
        -1
    } else {
        0
    }
}
