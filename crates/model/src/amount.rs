//! Values of what acts that may vary along the motion.

use kempe_units::Dimension;

use crate::ids::Scalar;
use crate::measure::Measure;

/// A value that may vary along the motion.
#[derive(Clone, Debug, PartialEq)]
pub enum Amount {
    /// An expression over parameters, drives, time and measures.
    Measure(Measure),
    /// A measured curve: the value over a measure, joined smoothly (monotone where the data is), SI.
    Table {
        /// What the table goes by.
        over: Box<Measure>,
        /// Dimension of that.
        over_dimension: Dimension,
        /// Abscissas, rising.
        at: Vec<f64>,
        /// Values.
        values: Vec<f64>,
        /// The abscissa repeats with this period (an engine's cycle), SI.
        period: Option<f64>,
        /// Factor on the values (a piston's area turns a pressure into a force).
        factor: Scalar,
    },
}
