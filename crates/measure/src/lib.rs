//! What is measured at a pose and over a motion, with its derivatives.

mod base;
pub mod circuit_rows;
mod clock;
mod designs_in_lanes;
mod direction;
mod extremes;
pub mod force_source;
mod history;
pub mod measure;
mod measurer;
mod path_length;
mod prepare;
mod quadrature;
pub mod row_note;
mod sampler;
pub mod sensitivity;
pub mod side_by_side;
pub mod state;
mod states_along;
mod statistic_note;
mod statistics;

pub use base::{Base, Varying};
pub use circuit_rows::{circuit_row, circuit_samplers};
pub use designs_in_lanes::{DesignsInLanes, is_of_poses};
pub use direction::Directions;
pub use force_source::{Curve, ForceSource, NoForces};
pub use prepare::{Unmeasurable, Unprepared, unmeasurable};
pub use row_note::RowNote;
pub use sampler::{CLOSURE_LIMIT, PointRates, Sample, Sampler};
pub use sensitivity::{
    Held, OneSided, Sensitivities, sensitivities, sensitivities_at, sensitivities_with,
};
pub use state::{Abscissa, ORDER, Series, State};
pub use statistic_note::StatisticNote;
