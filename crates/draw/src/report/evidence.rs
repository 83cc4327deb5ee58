//! How far the result of a motion can be trusted.

/// How far a result can be trusted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Evidence {
    /// Largest closure residual over all rows, and the limit it is held to, both relative to the mechanism's size.
    pub residual: Option<(f64, f64)>,
    /// Smallest singular value of the constraint Jacobian over all rows.
    pub singular_value: Option<f64>,
    /// How the Jacobian was scaled for that.
    pub scaling: String,
    /// Rows that were not reached.
    pub not_reached: Vec<NotReached>,
    /// Other checks, each with its worst value over the rows.
    pub checks: Vec<Check>,
    /// Anything else, as name and value.
    pub facts: Vec<(String, String)>,
}

/// Rows that were not reached.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NotReached {
    /// First row.
    pub first: usize,
    /// Last row.
    pub last: usize,
    /// Why.
    pub reason: String,
}

/// A check that ran over all rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Check {
    /// What was checked, such as `Two routes to the reactions`.
    pub name: String,
    /// The worst value, with its limit where it has one: `3e-13 ≤ 1e-9`.
    pub worst: String,
    /// Where it was found, such as `crank = 117.5 deg`; may be empty.
    pub place: String,
    /// What it says about the result.
    pub meaning: String,
}

impl Check {
    /// A check by name, worst value, place and meaning.
    pub fn new(
        name: impl Into<String>,
        worst: impl Into<String>,
        place: impl Into<String>,
        meaning: impl Into<String>,
    ) -> Check {
        Check {
            name: name.into(),
            worst: worst.into(),
            place: place.into(),
            meaning: meaning.into(),
        }
    }
}
