//! How far a pose can be trusted: closure residual and distance from singularity.

use crate::bordered::Bordered;
use crate::branch::Branch;
use crate::configuration::Configuration;
use crate::constraint::Joint;
use crate::design::Design;
use crate::pose::Pose;

/// What tells how good a pose is. Lengths are counted in mechanism sizes, angles in rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evidence {
    /// Largest residual of all joints and drives.
    pub closure: f64,
    /// Smallest singular value of the constraint Jacobian (all joints and drives, to all bodies' x, y and angle).
    pub smallest_singular_value: f64,
}

/// The largest residual of all joints and drives at a pose, and of every body's length.
pub fn closure(
    design: &Design<f64>,
    branch: &Branch,
    state: &Configuration<f64>,
    size: f64,
) -> f64 {
    let mechanism = &*design.mechanism;
    let situation = state.situation(design, branch);
    // Directions that are no unit vectors stretch their bodies: poses that were joined from two sides may have them.
    let mut largest = (state.poses.iter())
        .map(|pose| (pose.c * pose.c + pose.s * pose.s - 1.0).abs())
        .fold(0.0, |a: f64, b| if b.is_nan() { b } else { a.max(b) });
    if largest.is_nan() {
        return f64::NAN;
    }
    for (constraint, _) in &mechanism.constraints {
        let residual = situation.residual(constraint);
        let unit = constraint.unit().factor(size);
        if situation.is_reversed(constraint) {
            largest = largest.max(2.0);
        }
        for r in &residual[..constraint.rows()] {
            if r.is_nan() {
                return f64::NAN;
            }
            largest = largest.max((r * unit).abs());
        }
    }
    largest
}

/// A pose of which the smallest singular value is no more is at a change point or a dead point, or so near to one that little is known
/// there of accelerations and forces.
pub const NEARLY_SINGULAR: f64 = 1e-3;

/// The evidence of a pose; `system` is storage that is reused from pose to pose.
pub fn evidence(
    design: &Design<f64>,
    branch: &Branch,
    state: &Configuration<f64>,
    size: f64,
    system: &mut Bordered,
) -> Evidence {
    let mechanism = &*design.mechanism;
    let closure = closure(design, branch, state, size);
    if !closure.is_finite() {
        return Evidence {
            closure,
            smallest_singular_value: f64::NAN,
        };
    }
    let rates = vec![0.0; mechanism.model.drives.len()];
    system.fill(mechanism, &state.situation(design, branch), size, &rates);
    Evidence {
        closure,
        smallest_singular_value: system.smallest_singular_value(),
    }
}

/// Whether every number of a pose is finite.
pub fn is_finite(pose: &Pose<f64>) -> bool {
    pose.x.is_finite() && pose.y.is_finite() && pose.c.is_finite() && pose.s.is_finite()
}
