//! Kempe's model file and what it means.

pub mod build;
mod codes;
mod complete;
mod diagnostic;
mod document;
mod edit;
mod geometry;
mod item;
mod law;
mod load;
mod measure;
mod mend;
mod model;
mod outline;
mod part;
mod partial;
mod path;
mod read;
mod registry;
mod same;
mod schema;
mod spline;
mod starter;
mod tables;
mod write;

pub use codes::{CODES, Code};
pub use complete::{Completion, CompletionKind, complete};
pub use diagnostic::{Diagnostic, Label, Severity, Source};
pub use edit::{
    DeleteError, Deletion, EditError, TextEdit, add_entry, apply, delete, delete_with_dependants,
    rename, set_value, value_edit,
};
pub use geometry::value;
pub use law::SAME_END;
pub use load::*;
pub use measure::{ForceMeasure, JointRef, Leaf, Measure, PoseMeasure, Statistic};
pub use model::*;
pub use part::{Naming, Part, PartKind, namings, parts};
pub use partial::Partial;
pub use path::{PathAt, PathPart, PathPlaces, path_at, places_of};
pub use read::{Checked, MAX_FILE_BYTES};
pub use registry::{MeasureEntry, Registry};
pub use schema::schema;
pub use starter::{STARTERS, Starter, starter};
pub use tables::Tables;
pub use write::ModelFile;
