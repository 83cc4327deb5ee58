//! What a design of a sweep answers.

use crate::table::Table;

/// What is known of one design.
#[derive(Clone, Debug)]
pub(super) struct Answer {
    /// Its numbers in their units, none where there are none.
    pub numbers: Vec<f64>,
    /// The worst closure of its rows.
    pub closure: f64,
    /// The least singular value of its rows.
    pub singular_value: f64,
    /// Why it has no value.
    pub note: Option<String>,
    /// Its rows, where they are asked for.
    pub rows: Option<Table>,
    /// What its rows run along, and its curves: where it is drawn.
    pub curves: Option<Vec<Vec<f64>>>,
}
