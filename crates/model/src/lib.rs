//! Kempe's model file and what it means.

mod bound;
pub mod build;
mod clearance;
mod codes;
mod complete;
mod contact;
mod decimal;
mod diagnostic;
mod document;
mod drawing;
mod drive;
mod edit;
mod geometry;
mod help;
mod hint;
mod ids;
mod item;
mod joint;
mod key_path;
#[rustfmt::skip]
mod key_table;
mod keys;
mod law;
mod link;
mod load;
mod measure;
mod mend;
mod model;
mod outline;
mod part;
mod partial;
mod path;
mod polynomials;
mod read;
mod registry;
mod same;
mod schema;
pub mod spline;
mod starter;
mod study;
mod tables;
mod text_edit;
mod unsound;
mod write;

pub use bound::{Bound, Keeps};
pub use clearance::*;
pub use codes::{CODES, Code, LATER_CODES};
pub use complete::{Completion, CompletionKind, complete};
pub use contact::*;
pub use diagnostic::{Diagnostic, Label, Severity, Source};
pub use drawing::{Drawing, DrawnPlace, StartsElsewhere};
pub use drive::*;
pub use edit::delete::{DeleteError, Deletion, delete, delete_with_dependants};
pub use edit::rename::rename;
pub use edit::{add_entry, set_value, value_edit};
pub use geometry::value;
pub use hint::*;
pub use ids::*;
pub use joint::*;
pub use law::SAME_END;
pub use link::*;
pub use load::*;
pub use measure::{ForceMeasure, JointRef, Leaf, Measure, PoseMeasure, Statistic};
pub use model::{FileUnits, Model, Parameter, UnitName};
pub use part::{Naming, Part, PartKind, namings, parts};
pub use partial::Partial;
pub use path::{PathAt, PathPart, PathPlaces, path_at, places_of};
pub use polynomials::{COEFFICIENTS, Polynomials};
pub use read::{Checked, MAX_FILE_BYTES, MAX_TABLE_BYTES, PARTIAL_TABLE, partial_table};
pub use registry::{Argument, MeasureEntry, Nature, Registry};
pub use schema::schema;
pub use starter::{STARTERS, Starter, starter};
pub use study::*;
pub use tables::Tables;
pub use text_edit::{EditError, TextEdit, apply};
pub use write::ModelFile;

/// The words of the model file as data: every section, kind of entry and key, with what it takes, an example and a sentence.
pub mod language {
    pub use crate::help::{help, visit_keys};
    pub use crate::key_table::{ANNOUNCED_STUDIES, FILE};
    pub use crate::keys::{Key, Kind, Named, Need, Quantity, Sign, Takes};
}
