//! Planar mechanisms in motion.

pub mod assemble;
pub mod assur;
pub mod batch;
pub mod blocks;
pub mod bordered;
mod bridge;
pub mod certify;
pub mod check;
pub mod circuit;
mod closed_form;
mod complex_linear;
pub mod constraint;
pub mod drive_path;
pub mod events;
pub mod evidence;
pub mod force_source;
pub mod four_bar;
pub mod geometry;
pub mod homotopy;
mod known;
mod krawczyk;
pub mod measure;
pub mod mechanism;
pub mod mobility;
pub mod motion;
mod newton;
pub mod plan;
mod pose;
mod qr;
mod recognise;
mod sampler;
pub mod sensitivity;
mod solve;
mod state;
mod statistics;
mod swept;
mod swing;
pub mod trace;

pub use batch::{Batch, BatchError, Designs, sweep_states};
pub use certify::{
    Certificate, CertifiedMotion, Certifier, Subdivision, certify_motion, certify_pose,
};
pub use check::{Findings, Reach, check};
pub use constraint::{Input, Situation};
pub use force_source::{ForceSource, NoForces};
pub use geometry::Geometry;
pub use mechanism::{BodyId, Mechanism};
pub use motion::{EndReason, Motion, MotionError};
pub use newton::PlanNumber;
pub use plan::Plan;
pub use pose::Pose;
pub use qr::Qr;
pub use sampler::{CLOSURE_LIMIT, Sample, Sampler, Unmeasurable};
pub use sensitivity::{Held, Sensitivities, sensitivities};
pub use state::{Branch, Design, State};
