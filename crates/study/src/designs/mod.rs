//! Studies of many designs: another study, run again with other values of some parameters.
//!
//! `bench.rs` moves one design and tells the numbers that are asked of it, with their derivatives; `asked.rs` says which numbers these are.
//! `over.rs` finds the study that is run, `notes.rs` and `warned.rs` say how it stands with a design, `kept_parts.rs` keeps what was computed.
//! Sweeps, tolerances and optima differ only in which designs they put on the bench and in what they make of the answers.

mod asked;
mod bench;
mod idle;
mod kept_parts;
mod lanes;
mod notes;
mod optimize;
mod over;
mod rows;
mod sweep;
mod together;
mod tolerance;
mod warned;

pub(crate) use asked::numbers_of;
pub use kept_parts::Parts;
pub(crate) use kept_parts::Unkept;
pub use optimize::{Otherwise, most_parts, optimum_otherwise};
pub(crate) use optimize::{findings_of_optimization, optimization};
pub(crate) use over::in_words;
#[cfg(feature = "parquet")]
pub use sweep::{RowFiles, RowsError};
pub(crate) use sweep::{bytes_of_sweep, findings_of_sweep, listed, sweep};
pub use sweep::{compute_parts, part_count};
pub(crate) use tolerance::{CURVES as DEFAULT_CURVES, KEPT, findings_of_tolerance, tolerance};
