//! The smallest and largest values of a table's columns, and where they stand.

use crate::result::StudyResult;
use crate::table::Column;

/// What is less than this part of the largest of its column is rounding.
pub const ROUNDING: f64 = 1e-12;

/// A value in a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme {
    /// The value, in the unit of its column.
    pub value: f64,
    /// The row where it stands.
    pub row: usize,
    /// The coordinate that the rows run along there, in the unit of that column.
    pub at: f64,
}

/// The smallest and the largest value of a column in its rows.
#[derive(Clone, Debug)]
pub struct Extremes<'r> {
    /// The column.
    pub column: &'r Column,
    /// The largest absolute value; 0 where there is none.
    pub size: f64,
    /// The smallest value; `None` where no row has one.
    pub smallest: Option<Extreme>,
    /// The largest value.
    pub largest: Option<Extreme>,
}

/// The extremes of every column but the one that the rows run along and the time.
pub fn extremes(result: &StudyResult) -> Vec<Extremes<'_>> {
    let Some(along) = result.abscissa() else {
        return Vec::new();
    };
    let own = |column: &&Column| column.name != along.name && column.name != "time";
    let columns = result.table.columns.iter().filter(own);
    columns
        .map(|column| extremes_of(column, &along.values))
        .collect()
}

/// The extremes of a column over `along`, which has as many rows. Of equal values the first one counts.
pub(crate) fn extremes_of<'r>(column: &'r Column, along: &[f64]) -> Extremes<'r> {
    let values = &column.values;
    let finite = values.iter().filter(|v| v.is_finite());
    let best = |better: fn(&f64, &f64) -> bool| {
        let numbers = values.iter().copied().enumerate();
        let found = numbers.filter(|(_, v)| !v.is_nan());
        let (row, value) = found.reduce(|a, b| if better(&b.1, &a.1) { b } else { a })?;
        let at = along.get(row).copied().unwrap_or(f64::NAN);
        Some(Extreme { value, row, at })
    };
    Extremes {
        column,
        size: finite.fold(0.0, |size, v| size.max(v.abs())),
        smallest: best(f64::lt),
        largest: best(f64::gt),
    }
}

/// A value as people read it: what is only rounding of numbers of a size is 0.
pub fn without_rounding(value: f64, size: f64) -> f64 {
    match value.abs() <= ROUNDING * size {
        true => 0.0,
        false => value,
    }
}
