//! The numbers Kempe's plans run on.

pub mod math;
mod number;

pub use number::Number;
