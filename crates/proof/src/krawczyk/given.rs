//! What the rows of a system are evaluated with.

use kempe_mechanism::Design;
use kempe_mechanism::Mechanism;
use kempe_mechanism::constraint::{Input, Situation};
use kempe_mechanism::geometry::Geometry;
use kempe_mechanism::pose::Pose;
use kempe_number::Interval;

/// What the rows are evaluated with.
pub(crate) struct Given<'a> {
    pub mechanism: &'a Mechanism,
    pub geometry: &'a Geometry<Interval>,
    pub plain: &'a Geometry<f64>,
    pub inputs: &'a [Input<Interval>],
    pub near: &'a [f64],
    /// Size of the mechanism, m.
    pub size: f64,
}

impl<'a> Given<'a> {
    /// A design's dimensions at the drives' `inputs`; `size` is the mechanism's, m.
    pub fn new(
        design: &'a Design<Interval>,
        inputs: &'a [Input<Interval>],
        near: &'a [f64],
        size: f64,
    ) -> Self {
        let mechanism = &*design.mechanism;
        Self {
            mechanism,
            geometry: &design.geometry,
            plain: &design.plain[0],
            inputs,
            near,
            size,
        }
    }

    /// What the rows see at some poses.
    pub(super) fn situation<'s>(&'s self, poses: &'s [Pose<Interval>]) -> Situation<'s, Interval> {
        Situation {
            geometry: self.geometry,
            inputs: self.inputs,
            poses,
            near: self.near,
        }
    }
}
