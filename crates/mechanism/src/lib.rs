//! Planar mechanisms: what they are made of, and how a pose is found.

mod apart;
pub mod assur;
#[doc(hidden)]
pub mod blocks;
#[doc(hidden)]
pub mod bordered;
mod bound_dyad;
mod branch;
mod closed_form;
pub mod configuration;
pub mod constraint;
pub mod curve;
mod cut;
mod design;
mod dyad_lanes;
pub mod evidence;
pub mod geometry;
mod ids;
#[doc(hidden)]
pub mod layout;
mod local_marker;
mod mechanism;
pub mod mobility;
mod modes;
#[doc(hidden)]
pub mod newton;
mod parts;
mod pilots;
mod pinned_group;
pub mod plan;
mod plan_number;
pub mod pose;
mod recognise;
mod releasing;
pub mod solve;
mod solve_apart;
mod sources;
mod spanning_tree;
mod step;
pub mod structure;

pub use branch::Branch;
pub use configuration::Configuration;
pub use constraint::{Input, Situation};
pub use cut::{CutOpen, NotCut};
pub use design::Design;
pub use dyad_lanes::PointRoom;
pub use geometry::Geometry;
pub use mechanism::Mechanism;
pub use plan::Plan;
pub use plan_number::PlanNumber;
pub use pose::Pose;
pub use releasing::NotReleased;

pub use structure::{BodyId, Structure};
