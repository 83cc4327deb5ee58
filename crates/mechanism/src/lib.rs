//! Planar mechanisms: what they are made of, and how a pose is found.

pub mod assur;
pub mod blocks;
pub mod bordered;
mod closed_form;
pub mod constraint;
pub mod evidence;
pub mod geometry;
mod known;
mod mechanism;
pub mod mobility;
pub mod newton;
mod pinned_group;
pub mod plan;
pub mod pose;
pub mod qr;
mod rank;
mod recognise;
pub mod solve;
pub mod state;
pub mod structure;

pub use constraint::{Input, Situation};
pub use geometry::Geometry;
pub use mechanism::Mechanism;
pub use newton::PlanNumber;
pub use plan::Plan;
pub use pose::Pose;
pub use qr::Qr;
pub use state::{Branch, Design, State};
pub use structure::{BodyId, Structure};
