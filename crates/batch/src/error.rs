//! Why a batch cannot run.

use kempe_model::PointId;

/// Why a batch cannot run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BatchError {
    /// No link carries the point.
    NoSuchPoint(PointId),
    /// A slice has the wrong length.
    Length {
        /// Which slice.
        what: &'static str,
        /// Its right length.
        expected: usize,
        /// Its length.
        got: usize,
    },
}

impl std::fmt::Display for BatchError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoSuchPoint(point) => write!(f, "no link carries point number {}", point.0),
            Self::Length {
                what,
                expected,
                got,
            } => write!(f, "{what}: expected {expected} numbers, got {got}"),
        }
    }
}

impl std::error::Error for BatchError {}
