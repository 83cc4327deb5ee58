//! Random linkages that tests recover.
#![allow(dead_code, reason = "each test takes its part")]

use kempe_number::Random;
use kempe_synthesis::{C, Dyad, DyadSolution, Pose};

/// Even between two numbers.
pub fn between(random: &mut Random, low: f64, high: f64) -> f64 {
    low + (high - low) * random.uniform()
}

/// A place in the square of this half side.
pub fn place(random: &mut Random, size: f64) -> C {
    C::new(between(random, -size, size), between(random, -size, size))
}

/// A four-bar: fixed pivots, moving pivots as points of the coupler.
#[derive(Clone, Copy, Debug)]
pub struct RandomFourBar {
    pub fixed: [C; 2],
    pub moving: [C; 2],
    pub lengths: [f64; 2],
    pub side: f64,
}

impl RandomFourBar {
    pub fn new(random: &mut Random) -> Self {
        let side = if random.uniform() < 0.5 { -1.0 } else { 1.0 };
        Self {
            fixed: [place(random, 2.0), place(random, 2.0)],
            moving: [place(random, 2.0), place(random, 2.0)],
            lengths: [between(random, 0.3, 3.0), between(random, 0.3, 3.0)],
            side,
        }
    }

    /// The coupler's pose at an angle of the first link; `None` where it does not close.
    pub fn pose(&self, angle: f64) -> Option<Pose> {
        let a = self.fixed[0] + C::from_polar(self.lengths[0], angle);
        let to = self.fixed[1] - a;
        let (f, coupler) = (to.norm(), self.moving[1] - self.moving[0]);
        let b = coupler.norm();
        let cos = (f * f + b * b - self.lengths[1] * self.lengths[1]) / (2.0 * f * b);
        if !(cos.abs() < 0.999) {
            return None;
        }
        let sin = self.side * (1.0 - cos * cos).sqrt();
        let turn = to.scale(1.0 / f) * C::new(cos, sin) * coupler.conj().scale(1.0 / b);
        Some(Pose {
            origin: a - turn * self.moving[0],
            angle: turn.arg(),
        })
    }

    /// So many poses at random angles of the first link, at least so far apart, with their angles.
    pub fn poses(
        &self,
        random: &mut Random,
        count: usize,
        apart: f64,
    ) -> Option<(Vec<Pose>, Vec<f64>)> {
        let (mut poses, mut angles): (Vec<Pose>, Vec<f64>) = (Vec::new(), Vec::new());
        for _ in 0..200 {
            let angle = between(random, -3.1, 3.1);
            if angles
                .iter()
                .any(|a| kempe_number::math::sin((a - angle) * 0.5).abs() < 0.5 * apart)
            {
                continue;
            }
            if let Some(pose) = self.pose(angle) {
                poses.push(pose);
                angles.push(angle);
                if poses.len() == count {
                    return Some((poses, angles));
                }
            }
        }
        None
    }
}

/// Whether a dyad with these pivots is among those found, and how near.
pub fn nearest(found: &[DyadSolution], fixed: C, moving: C) -> f64 {
    (found.iter())
        .map(|d| match d.dyad {
            Dyad::Rr {
                fixed: f,
                moving: m,
                ..
            } => (f - fixed).norm().max((m - moving).norm()),
            _ => f64::INFINITY,
        })
        .fold(f64::INFINITY, f64::min)
}

/// Poses moved, turned and scaled.
pub fn moved(poses: &[Pose], scale: f64, turn: f64, shift: C) -> Vec<Pose> {
    let turned = C::from_polar(scale, turn);
    (poses.iter())
        .map(|p| Pose {
            origin: shift + turned * p.origin,
            angle: p.angle + turn,
        })
        .collect()
}
