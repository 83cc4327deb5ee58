//! Newton's method on plain numbers.

use kempe_linear::Qr;

use super::rows::{apply_step, factor_block, fill_residuals};
use crate::Mechanism;
use crate::blocks::Unknown;
use crate::branch::Branch;
use crate::constraint::{Input, Situation};
use crate::geometry::Geometry;
use crate::plan::NewtonBlock;
use crate::pose::Pose;

/// A scaled step below this is taken as converged (one more step is made after it).
pub const NEWTON_STEP: f64 = 1e-9;
/// Newton steps before a block is given up.
pub const NEWTON_LIMIT: usize = 30;

/// Solves a block from the branch's guess; returns the determinant. What cannot be solved becomes NaN.
#[allow(
    clippy::too_many_arguments,
    reason = "the parts of a state, borrowed apart"
)]
pub(super) fn plain_newton(
    block: &NewtonBlock,
    mechanism: &Mechanism,
    geometry: &Geometry<f64>,
    inputs: &[Input<f64>],
    branch: &Branch,
    poses: &mut [Pose<f64>],
    qr: &mut Qr,
    rhs: &mut [f64],
) -> f64 {
    let rhs = &mut rhs[..block.rows.len()];
    start(block, branch, poses);
    let mut converged = false;
    for _ in 0..NEWTON_LIMIT {
        let situation = Situation {
            geometry,
            inputs,
            poses,
            near: &branch.near,
        };
        fill_residuals(block, mechanism, &situation, rhs);
        factor_block(block, mechanism, &situation, qr);
        qr.solve(rhs);
        let size = scaled_size(block, geometry, poses, &rhs[..block.size]);
        if !size.is_finite() {
            break;
        }
        apply_step(block, poses, &rhs[..block.size]);
        normalise(block, poses);
        if converged {
            return qr.determinant();
        }
        converged = size <= NEWTON_STEP;
    }
    for unknown in &block.unknowns {
        poses[unknown.body().index()] = Pose {
            x: f64::NAN,
            y: f64::NAN,
            c: f64::NAN,
            s: f64::NAN,
        };
    }
    f64::NAN
}

/// Puts the block's bodies where the branch guesses them.
fn start(block: &NewtonBlock, branch: &Branch, poses: &mut [Pose<f64>]) {
    for unknown in &block.unknowns {
        let body = unknown.body().index();
        let (pose, guess) = (&mut poses[body], &branch.guess[body]);
        match unknown {
            Unknown::Angle(_) => (pose.c, pose.s) = (guess.c, guess.s),
            Unknown::Place(_) => (pose.x, pose.y) = (guess.x, guess.y),
        }
    }
}

/// Keeps the direction a unit vector against rounding.
fn normalise(block: &NewtonBlock, poses: &mut [Pose<f64>]) {
    for unknown in &block.unknowns {
        if let Unknown::Angle(body) = unknown {
            let pose = &mut poses[body.index()];
            let size = (pose.c * pose.c + pose.s * pose.s).sqrt();
            (pose.c, pose.s) = (pose.c / size, pose.s / size);
        }
    }
}

/// Largest part of a step: angles in rad, lengths against the largest coordinate.
fn scaled_size(
    block: &NewtonBlock,
    geometry: &Geometry<f64>,
    poses: &[Pose<f64>],
    step: &[f64],
) -> f64 {
    let mut length = 0.0_f64;
    let mut reach = geometry.least_reach();
    let mut angle = 0.0_f64;
    let mut bad = false;
    for &(unknown, column) in &block.columns.unknowns {
        match unknown {
            Unknown::Angle(_) => {
                bad |= !step[column].is_finite();
                angle = angle.max(step[column].abs());
            }
            Unknown::Place(body) => {
                let pose = &poses[body.index()];
                bad |= !(step[column].is_finite() && step[column + 1].is_finite());
                length = length.max(step[column].abs()).max(step[column + 1].abs());
                reach = reach.max(pose.x.abs()).max(pose.y.abs());
            }
        }
    }
    if bad {
        f64::NAN
    } else {
        angle.max(length / reach)
    }
}
