//! Kempe's model file and what it means.

mod measure;
mod model;

pub use measure::{Leaf, Measure, PoseMeasure, Statistic};
pub use model::*;
