//! The rows of a block: residuals, Jacobian, and the step they ask for.

use kempe_linear::Qr;
use kempe_number::Number;

use crate::Mechanism;
use crate::blocks::Unknown;
use crate::constraint::Situation;
use crate::plan::NewtonBlock;
use crate::pose::Pose;

/// Fills the block's Jacobian into `qr` and factors it.
pub(super) fn factor_block(
    block: &NewtonBlock,
    mechanism: &Mechanism,
    situation: &Situation<'_, f64>,
    qr: &mut Qr,
) {
    qr.reset(block.rows.len(), block.size);
    let jacobian = &block.equations;
    jacobian.jacobian(&block.columns, mechanism, situation, |row, _, to, value| {
        if let Some(column) = to.column() {
            qr.add(row, column, value);
        }
    });
    qr.factor();
}

/// Fills the rows' residuals into `rhs`.
pub(super) fn fill_residuals<T: Number>(
    block: &NewtonBlock,
    mechanism: &Mechanism,
    situation: &Situation<'_, T>,
    rhs: &mut [T],
) {
    (block.equations).residuals(mechanism, situation, |row, _, value| rhs[row] = value);
}

/// Takes a step off the poses.
pub(super) fn apply_step<T: Number>(block: &NewtonBlock, poses: &mut [Pose<T>], step: &[T]) {
    for &(unknown, column) in &block.columns.unknowns {
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
