//! Newton blocks on intervals: proved, not iterated.

use kempe_mechanism::plan::NewtonBlock;
use kempe_mechanism::{Branch, Configuration, Design};
use kempe_number::{Interval, Number};

use super::given::Given;
use super::system::{System, middle_of};
use crate::not_proved::NotProved;

/// Encloses the pose of a Newton block, or says why it is not proved.
pub(crate) fn enclose_block(
    block: &NewtonBlock,
    design: &Design<Interval>,
    branch: &Branch,
    state: &mut Configuration<Interval>,
) -> Result<Interval, NotProved> {
    let mechanism = &*design.mechanism;
    let system = System::of_block(block);
    let plain = design.plain.first().ok_or(NotProved::NoPose)?;
    let size = plain.size(mechanism);
    let given = Given::new(design, &state.inputs, &branch.near, size);
    let mut middle = middle_of(&branch.guess, &branch.near);
    let (_, determinant) = system.enclose(&given, &mut middle, &mut state.poses)?;
    // The Jacobian is regular in all of the box, so its determinant keeps this sign.
    Ok(Interval::from_f64(determinant))
}
