//! Tables as bytes: CSV, Parquet, JSON. The same table gives the same bytes.

mod comparison;
mod csv;
mod json;
#[cfg(feature = "parquet")]
mod parquet;

pub use comparison::{csv as comparison_csv, json as comparison_json};
pub use csv::{csv, marked_partial};
pub use json::{diagnostic, result, table};
#[cfg(feature = "parquet")]
pub(crate) use parquet::ParquetWriter;
#[cfg(feature = "parquet")]
pub use parquet::{ParquetError, parquet};
