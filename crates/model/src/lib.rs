//! Kempe's model file and what it means.

mod bounds;
mod codes;
mod diagnostic;
mod document;
mod edit;
mod geometry;
mod help;
#[rustfmt::skip]
mod key_table;
mod keys;
mod law;
mod load;
mod measure;
mod mend;
mod model;
mod read;
mod registry;
mod schema;
mod spline;
mod starter;

pub use bounds::{Bound, Keeps};
pub use codes::{CODES, Code};
pub use diagnostic::{Diagnostic, Label, Severity, Source};
pub use edit::set_value;
pub use geometry::value;
pub use law::SAME_END;
pub use load::*;
pub use measure::{ForceMeasure, JointRef, Leaf, Measure, PoseMeasure, Statistic};
pub use model::*;
pub use read::{Checked, MAX_FILE_BYTES};
pub use registry::{Argument, MeasureEntry, Nature, Registry};
pub use schema::schema;
pub use starter::{STARTERS, Starter, starter};

/// The words of the model file as data: every section, kind of entry and key, with what it takes, an example and a sentence.
pub mod language {
    pub use crate::help::{help, visit_keys};
    pub use crate::key_table::{ANNOUNCED_STUDIES, FILE};
    pub use crate::keys::{Key, Kind, Named, Need, Quantity, Sign, Takes};
}
