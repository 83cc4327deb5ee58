//! The structure of a mechanism: a model compiled to bodies and constraints, its dimensions still free.

mod compile;

pub use crate::constraint::{Constraint, Source};
pub use crate::ids::{ArcRef, BodyId, CurveRef, LineRef, Marker, Spot};
pub use crate::parts::Parts;
pub use crate::sources::{AngleSource, ArcSource, CurveSource, GearSource, LineSource, LinkSeat};

use std::ops::{Deref, DerefMut};

use kempe_model::{DriveId, JointId, Model};

/// A model compiled to its parts and their constraints.
#[derive(Clone, Debug)]
pub struct Structure {
    /// Bodies and what they carry.
    pub parts: Parts,
    /// Joints' constraints first, then the drives'.
    pub constraints: Vec<(Constraint, Source)>,
    /// How many constraints come from joints.
    pub joint_constraints: usize,
}

impl Structure {
    /// Compiles a model.
    pub fn new(model: &Model) -> Self {
        let mut it = Self {
            parts: Parts::new(model),
            constraints: Vec::new(),
            joint_constraints: 0,
        };
        it.add_pins();
        for index in 0..model.joints.len() {
            it.add_joint(JointId(index as u32));
        }
        let opened = it.open_joints();
        it.joint_constraints = it.constraints.len();
        for index in 0..model.drives.len() {
            it.add_drive(DriveId(index as u32), &opened);
        }
        it
    }
}

impl Deref for Structure {
    type Target = Parts;

    fn deref(&self) -> &Parts {
        &self.parts
    }
}

impl DerefMut for Structure {
    fn deref_mut(&mut self) -> &mut Parts {
        &mut self.parts
    }
}
