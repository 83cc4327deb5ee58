//! A plan on intervals: its Newton blocks are proved.

use kempe_number::{Interval, Number};

use super::{Given, System, middle_of};
use crate::blocks::Unknown;
use crate::certify::NotProved;
use crate::newton::PlanNumber;
use crate::plan::NewtonBlock;
use crate::state::{Branch, Design, State};

/// Encloses the pose of a Newton block, or says why it is not proved.
pub(crate) fn enclose_block(
    block: &NewtonBlock,
    design: &Design<Interval>,
    branch: &Branch,
    state: &mut State<Interval>,
) -> Result<Interval, NotProved> {
    let mechanism = &*design.mechanism;
    let system = System::of_block(mechanism, block);
    let plain = design.plain.first().ok_or(NotProved::NoPose)?;
    let size = plain.size(mechanism);
    let given = Given::new(design, &state.inputs, &branch.near, size);
    let mut middle = middle_of(&branch.guess, &branch.near);
    let (_, determinant) = system.enclose(&given, &mut middle, &mut state.poses)?;
    // The Jacobian is regular in all of the box, so its determinant keeps this sign.
    Ok(Interval::from_f64(determinant))
}

impl PlanNumber for Interval {
    /// The poses are proved by Krawczyk's operator; where they are not, they and the determinant are empty.
    fn solve_newton(
        block: &NewtonBlock,
        design: &Design<Self>,
        branch: &Branch,
        state: &mut State<Self>,
    ) -> Self {
        enclose_block(block, design, branch, state).unwrap_or_else(|_| {
            for unknown in &block.unknowns {
                let pose = &mut state.poses[unknown.body().index()];
                match unknown {
                    Unknown::Place(_) => (pose.x, pose.y) = (Self::EMPTY, Self::EMPTY),
                    Unknown::Angle(_) => (pose.c, pose.s) = (Self::EMPTY, Self::EMPTY),
                }
            }
            Self::EMPTY
        })
    }
}
