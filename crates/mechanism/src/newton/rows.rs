//! The rows of a block: residuals, Jacobian, and the step they ask for.

use kempe_number::Number;

use crate::Mechanism;
use crate::blocks::Unknown;
use crate::constraint::Situation;
use crate::plan::NewtonBlock;
use crate::pose::Pose;
use crate::qr::Qr;

/// Fills the block's Jacobian into `qr` and factors it.
pub(super) fn factor_block(
    block: &NewtonBlock,
    mechanism: &Mechanism,
    situation: &Situation<'_, f64>,
    qr: &mut Qr,
) {
    qr.reset(block.rows.len(), block.size);
    for (constraint, at) in &block.constraints {
        situation.gradients(&mechanism.constraints[*constraint].0, |gradient| {
            let Some(row) = at[gradient.row] else { return };
            for (unknown, &column) in block.unknowns.iter().zip(&block.columns) {
                if unknown.body() != gradient.body {
                    continue;
                }
                match unknown {
                    Unknown::Angle(_) => qr.add(row, column, gradient.to[2]),
                    Unknown::Place(_) => {
                        qr.add(row, column, gradient.to[0]);
                        qr.add(row, column + 1, gradient.to[1]);
                    }
                }
            }
        });
    }
    qr.factor();
}

/// Fills the rows' residuals into `rhs`.
pub(super) fn fill_residuals<T: Number>(
    block: &NewtonBlock,
    mechanism: &Mechanism,
    situation: &Situation<'_, T>,
    rhs: &mut [T],
) {
    for (constraint, at) in &block.constraints {
        let rows = situation.residual(&mechanism.constraints[*constraint].0);
        for k in 0..2 {
            if let Some(place) = at[k] {
                rhs[place] = rows[k];
            }
        }
    }
}

/// Takes a step off the poses.
pub(super) fn apply_step<T: Number>(block: &NewtonBlock, poses: &mut [Pose<T>], step: &[T]) {
    for (unknown, &column) in block.unknowns.iter().zip(&block.columns) {
        let pose = &mut poses[unknown.body().index()];
        *pose = match unknown {
            Unknown::Angle(_) => pose.moved(T::zero(), T::zero(), -step[column]),
            Unknown::Place(_) => Pose {
                x: pose.x - step[column],
                y: pose.y - step[column + 1],
                ..*pose
            },
        };
    }
}
