//! A quantity that a study evaluates.

use kempe_model::{ForceMeasure, Leaf, Measure, Statistic};
use kempe_units::{Dimension, Expr, Unit};

use crate::unit::Units;

/// A quantity to evaluate.
#[derive(Clone, Debug)]
pub struct Quantity {
    /// Its name: that of a named measure, or the measure as written.
    pub name: String,
    /// What it is.
    pub measure: Measure,
    /// Its dimension.
    pub dimension: Dimension,
}

impl Quantity {
    /// The unit it is shown in. An energy and a torque have one dimension and two units.
    pub fn unit(&self, units: &Units) -> Unit {
        match is_energy(&self.measure) {
            true => Unit::parse("J").unwrap_or_else(|_| units.unit(self.dimension)),
            false => units.unit(self.dimension),
        }
    }
}

/// Whether a measure is an energy, or what one comes to over a motion.
fn is_energy(measure: &Measure) -> bool {
    match measure {
        Expr::Leaf(Leaf::Force(ForceMeasure::KineticEnergy | ForceMeasure::PotentialEnergy)) => {
            true
        }
        Expr::Leaf(Leaf::Over(Statistic::TimeRatio, _)) => false,
        Expr::Leaf(Leaf::Over(_, within)) => is_energy(within),
        Expr::Neg(part) => is_energy(part),
        Expr::Add(a, b) | Expr::Sub(a, b) => is_energy(a) && is_energy(b),
        _ => false,
    }
}
