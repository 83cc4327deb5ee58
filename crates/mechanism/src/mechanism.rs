//! A mechanism compiled: its structure and the plan by which it is solved.

use std::ops::Deref;
use std::sync::Arc;

use kempe_model::{DriveId, Model};

use crate::plan::Plan;
use crate::structure::Structure;

/// A compiled mechanism. It lives once, shared by all that is computed of it: designs, motions and samplers each hold their
/// share.
#[derive(Clone, Debug)]
pub struct Mechanism {
    /// Its bodies and constraints; what asks the mechanism for these asks here.
    pub structure: Structure,
    /// How its poses are found for given coordinates of the drives.
    pub plan: Plan,
    /// Coordinates that are let go: no law gives them, they move as forces make them.
    pub released: Vec<DriveId>,
}

impl Mechanism {
    /// Compiles a model.
    pub fn new(model: &Model) -> Arc<Self> {
        Self::of(Structure::new(model))
    }

    /// Plans a structure.
    pub fn of(structure: Structure) -> Arc<Self> {
        Arc::new(Self::planned(structure))
    }

    pub(crate) fn planned(structure: Structure) -> Self {
        let plan = Plan::new(&structure);
        Self {
            structure,
            plan,
            released: Vec::new(),
        }
    }
}

impl Deref for Mechanism {
    type Target = Structure;

    fn deref(&self) -> &Structure {
        &self.structure
    }
}
