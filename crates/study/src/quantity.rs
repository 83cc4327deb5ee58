//! A quantity that a study evaluates.

use kempe_model::{ForceMeasure, Leaf, Measure};
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
        match self.measure {
            Expr::Leaf(Leaf::Force(
                ForceMeasure::KineticEnergy | ForceMeasure::PotentialEnergy,
            )) => Unit::parse("J").unwrap_or_else(|_| units.unit(self.dimension)),
            _ => units.unit(self.dimension),
        }
    }
}
