//! What is measured at a pose and over a motion, with its derivatives.

pub mod circuit_rows;
pub mod force_source;
pub mod measure;
mod path_length;
mod quadrature;
mod sampler;
pub mod sensitivity;
mod statistics;

pub use circuit_rows::{circuit_row, circuit_samplers};
pub use force_source::{Curve, ForceSource, NoForces};
pub use sampler::{CLOSURE_LIMIT, Sample, Sampler, Unmeasurable, Unprepared};
pub use sensitivity::{Held, Sensitivities, sensitivities};
