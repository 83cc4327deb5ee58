//! Planar mechanisms in motion.

pub mod assemble;
pub mod blocks;
mod closed_form;
mod complex_linear;
pub mod constraint;
pub mod drive_path;
pub mod events;
pub mod geometry;
pub mod homotopy;
pub mod mechanism;
pub mod motion;
mod newton;
pub mod plan;
mod pose;
mod qr;
mod solve;
mod state;
pub mod trace;

pub use constraint::{Input, Situation};
pub use geometry::Geometry;
pub use mechanism::{BodyId, Mechanism};
pub use newton::PlanNumber;
pub use plan::Plan;
pub use pose::Pose;
pub use state::{Branch, Design, State};
