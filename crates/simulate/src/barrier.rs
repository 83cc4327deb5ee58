//! What stops the motion, and how far it is open at a state.

use kempe_measure::measure::visit_leaves;
use kempe_mechanism::Mechanism;
use kempe_model::{Leaf, Measure};

use crate::question::{Resistance, Stop};
use crate::touched::Place;
use crate::vector::dot;

/// What tells how far a stop is open.
#[derive(Clone, Debug)]
pub(crate) enum Opens {
    /// A measure of the pose.
    Measure(Measure),
    /// How far a joint with play stands open.
    Joint(Place),
}

/// Something that stops the motion.
#[derive(Clone, Debug)]
pub(crate) struct Barrier {
    /// What tells how far it is open.
    pub opens: Opens,
    /// How it resists.
    pub resistance: Resistance,
    /// Whether bodies carry what it pushes, and not a drive that is let go alone.
    pub on_bodies: bool,
    /// Whether drives have a part in it.
    pub on_drives: bool,
}

impl Barrier {
    /// The stop that was asked for.
    pub fn of(mechanism: &Mechanism, stop: &Stop) -> Self {
        Self {
            opens: Opens::Measure(stop.gap.clone()),
            resistance: stop.resistance,
            on_bodies: asks(mechanism, &stop.gap, |leaf| matches!(leaf, Leaf::Pose(_))),
            on_drives: asks(mechanism, &stop.gap, |leaf| matches!(leaf, Leaf::Drive(_))),
        }
    }
}

/// Whether a measure goes by something of a kind.
fn asks(mechanism: &Mechanism, measure: &Measure, kind: impl Fn(&Leaf) -> bool) -> bool {
    let mut asks = false;
    visit_leaves(mechanism, measure, &mut |leaf| asks |= kind(leaf));
    asks
}

/// A stop at a state.
#[derive(Clone, Debug)]
pub(crate) struct Gap {
    /// How far it is open.
    pub open: f64,
    /// How fast it opens.
    pub rate: f64,
    /// How its rate changes while no coordinate that is let go accelerates.
    pub bend: f64,
    /// Its derivatives to the coordinates that are let go.
    pub gradient: Vec<f64>,
    /// And to those of drives that keep laws by which they move.
    pub by_driven: Vec<f64>,
}

impl Gap {
    /// How much of its own unit one unit of what moves is: `scales` are the sizes of the coordinates that are let go.
    pub fn scale(&self, scales: &[f64]) -> f64 {
        let along = self.gradient.iter().zip(scales);
        along.map(|(j, scale)| (j * scale).abs()).sum()
    }

    /// Whether anything that is let go opens or closes it.
    pub fn gives_way(&self) -> bool {
        self.gradient.iter().any(|slope| *slope != 0.0)
    }

    /// What the terms of [`Gap::opening`] come to, all of one sign.
    pub fn terms(&self, accelerations: &[f64]) -> f64 {
        self.bend.abs() + self.scale(accelerations)
    }

    /// The rate of its rate where the coordinates that are let go accelerate so.
    pub fn opening(&self, accelerations: &[f64]) -> f64 {
        self.bend + dot(&self.gradient, accelerations)
    }
}

/// What forces or impulses at some gaps come to along `n` coordinates that are let go.
pub(crate) fn along(gaps: &[Gap], forces: &[f64], n: usize) -> Vec<f64> {
    let mut sums = vec![0.0; n];
    for (gap, force) in gaps.iter().zip(forces) {
        for (sum, j) in sums.iter_mut().zip(&gap.gradient) {
            *sum += force * j;
        }
    }
    sums
}
