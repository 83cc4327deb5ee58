//! The report: one HTML file that needs nothing else. The mechanism moves in the page, its plots follow, and the check's
//! findings and the evidence stand beside them.

mod base64;
mod columns;
mod content;
mod data;
mod evidence;
mod front;
mod happenings;
mod html;
mod json;
mod loads;
mod motion;
mod motion_report;
mod plots;
mod rows;
mod sections;
mod vectors;

pub use content::{FrontDesign, FrontReport, Report};
pub use evidence::{Check, Evidence, NotReached};
pub use motion_report::{
    Against, Column, Event, Happening, HappeningKind, MotionReport, Note, PointVectors, VectorKind,
};
pub use rows::MOST_ROWS;
pub use sections::{Block, Level, Section};
