//! Conditions: what a switch goes by, what ends a simulation, what a design must keep.

use kempe_units::Dimension;

use crate::measure::Measure;

/// Something that holds or does not at every instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    /// As written: `angle(rocker) <= 0 deg`.
    pub text: String,
    /// It holds where this is not negative.
    pub above: Measure,
    /// Dimension of what it compares.
    pub dimension: Dimension,
}
