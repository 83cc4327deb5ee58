//! Planar mechanisms in motion.

pub mod assemble;
pub mod blocks;
mod closed_form;
mod complex_linear;
pub mod constraint;
pub mod geometry;
pub mod homotopy;
pub mod mechanism;
mod newton;
pub mod plan;
mod pose;
mod qr;
mod solve;
mod state;

pub use constraint::{Input, Situation};
pub use geometry::Geometry;
pub use mechanism::{BodyId, Mechanism};
pub use newton::PlanNumber;
pub use plan::Plan;
pub use pose::Pose;
pub use state::{Branch, Design, State};
