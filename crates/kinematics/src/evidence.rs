//! How far a pose can be trusted: closure residual and distance from singularity.

use crate::blocks::Unknown;
use crate::mechanism::{BodyId, Mechanism};
use crate::pose::Pose;
use crate::qr::Qr;
use crate::state::{Branch, Design, State};
use crate::trace::is_length;

/// What tells how good a pose is. Lengths are counted in mechanism sizes, angles in rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evidence {
    /// Largest residual of all joints and drives.
    pub closure: f64,
    /// Smallest singular value of the constraint Jacobian (all joints and drives, to all bodies' x, y and angle).
    pub smallest_singular_value: f64,
}

/// The largest residual of all joints and drives at a pose.
pub fn closure(
    mechanism: &Mechanism,
    design: &Design<f64>,
    branch: &Branch,
    state: &State<f64>,
    size: f64,
) -> f64 {
    let situation = state.situation(design, branch);
    let mut largest = 0.0_f64;
    for (constraint, _) in &mechanism.constraints {
        let residual = situation.residual(constraint);
        let unit = if is_length(constraint) {
            1.0 / size
        } else {
            1.0
        };
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

/// Fills and factors the scaled constraint Jacobian of the given constraints at a pose.
pub(crate) fn factor_jacobian(
    mechanism: &Mechanism,
    design: &Design<f64>,
    branch: &Branch,
    state: &State<f64>,
    size: f64,
    constraints: std::ops::Range<usize>,
    held: &[Unknown],
    qr: &mut Qr,
) {
    let situation = state.situation(design, branch);
    let columns = 3 * (mechanism.bodies - 1);
    let rows: usize = mechanism.constraints[constraints.clone()]
        .iter()
        .map(|(c, _)| c.rows())
        .sum::<usize>()
        + held.iter().map(|u| u.size()).sum::<usize>();
    qr.reset(rows.max(columns), columns);
    let mut row = 0;
    for (constraint, _) in &mechanism.constraints[constraints] {
        let unit = if is_length(constraint) {
            1.0 / size
        } else {
            1.0
        };
        situation.gradients(constraint, |g| {
            if g.body != BodyId::GROUND {
                let column = 3 * (g.body.index() - 1);
                qr.add(row + g.row, column, g.to[0] * size * unit);
                qr.add(row + g.row, column + 1, g.to[1] * size * unit);
                qr.add(row + g.row, column + 2, g.to[2] * unit);
            }
        });
        row += constraint.rows();
    }
    for unknown in held {
        let column = 3 * (unknown.body().index() - 1);
        match unknown {
            Unknown::Angle(_) => qr.add(row, column + 2, 1.0),
            Unknown::Place(_) => {
                qr.add(row, column, 1.0);
                qr.add(row + 1, column + 1, 1.0);
            }
        }
        row += unknown.size();
    }
    qr.factor();
}

/// The evidence of a pose.
pub fn evidence(
    mechanism: &Mechanism,
    plan: &crate::plan::Plan,
    design: &Design<f64>,
    branch: &Branch,
    state: &State<f64>,
    size: f64,
    qr: &mut Qr,
) -> Evidence {
    let closure = closure(mechanism, design, branch, state, size);
    if !closure.is_finite() {
        return Evidence {
            closure,
            smallest_singular_value: f64::NAN,
        };
    }
    let held: Vec<Unknown> = plan
        .decomposition
        .idle
        .iter()
        .map(|b| Unknown::Angle(*b))
        .collect();
    factor_jacobian(
        mechanism,
        design,
        branch,
        state,
        size,
        0..mechanism.constraints.len(),
        &held,
        qr,
    );
    Evidence {
        closure,
        smallest_singular_value: qr.smallest_singular_value(),
    }
}

/// Whether every number of a pose is finite.
pub(crate) fn is_finite(pose: &Pose<f64>) -> bool {
    pose.x.is_finite() && pose.y.is_finite() && pose.c.is_finite() && pose.s.is_finite()
}
