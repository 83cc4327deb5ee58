//! Kempe's model file and what it means.

mod diagnostic;
mod document;
mod geometry;
mod law;
mod measure;
mod model;
mod read;
mod registry;
mod spline;

pub use diagnostic::{Diagnostic, Label, Severity, Source};
pub use geometry::value;
pub use measure::{Leaf, Measure, PoseMeasure, Statistic};
pub use model::*;
pub use read::{Checked, MAX_FILE_BYTES};
pub use registry::{MeasureEntry, Registry};
