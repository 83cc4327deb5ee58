//! What happened before a state.

use kempe_model::{ForceMeasure, PointId};

/// What was found of the motion before a state: it lifts what a state alone leaves open.
#[derive(Clone, Debug)]
pub struct History<B> {
    /// Directions between points of different bodies, rad, within half a turn; principal values where they are not here.
    pub directions: Vec<((PointId, PointId), f64)>,
    /// Lengths of path that points have gone since the start, m.
    pub lengths: Vec<(PointId, B)>,
    /// The same as `directions` of forces.
    pub forces: Vec<(ForceMeasure, f64)>,
}

impl<B> Default for History<B> {
    fn default() -> Self {
        Self {
            directions: Vec::new(),
            lengths: Vec::new(),
            forces: Vec::new(),
        }
    }
}
