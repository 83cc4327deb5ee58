//! A quantity that a study evaluates.

use kempe_model::Measure;
use kempe_units::{Dimension, Unit};

use crate::unit::{Units, text_in};

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
    /// The unit it is shown in.
    pub fn unit(&self, units: &Units) -> Unit {
        units.of_measure(&self.measure, self.dimension)
    }

    /// A value of it with its unit, as people read it.
    pub(crate) fn text(&self, si: f64, units: &Units) -> String {
        text_in(si, &self.unit(units))
    }
}
