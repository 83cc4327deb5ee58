//! The smallest and largest values of a table's columns, and where they stand.

use std::collections::BTreeMap;

use crate::result::StudyResult;
use crate::table::{Column, Table, first_best};

/// What is less than this part of the largest value of its unit in the table, or in its row, is rounding.
pub const ROUNDING: f64 = 1e-12;
/// A row whose largest value is more than so many times that of all but some rows, and what part these are, is at a pole: it tells nothing of the others.
const POLE: f64 = 1e9;
const FEW: f64 = 0.1;

/// A value in a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme {
    /// The value, in the unit of its column.
    pub value: f64,
    /// The row where it stands.
    pub row: usize,
    /// The coordinate that the rows run along there, in the unit of that column.
    pub at: f64,
    /// What numbers in its unit come to: of a part of that it may be [rounding](without_rounding).
    pub size: f64,
}

/// The smallest and the largest value of a column in its rows.
#[derive(Clone, Debug)]
pub struct Extremes<'r> {
    /// The column.
    pub column: &'r Column,
    /// The smallest value; `None` where no row has one.
    pub smallest: Option<Extreme>,
    /// The largest value.
    pub largest: Option<Extreme>,
}

/// The extremes of every column but the one that the rows run along and the time.
pub fn extremes(result: &StudyResult) -> Vec<Extremes<'_>> {
    let Some(along) = result.abscissa().filter(|_| result.shapes.is_empty()) else {
        return Vec::new();
    };
    let sizes = Sizes::of(&result.table.columns);
    let own = |column: &&Column| column.name != along.name && column.name != "time";
    let columns = result.table.columns.iter().filter(own);
    columns
        .map(|column| extremes_of(column, &result.table, &along.values, &sizes))
        .collect()
}

/// The largest absolute values of a table by their unit: a force that is nothing beside the others is rounding.
pub(crate) struct Sizes(BTreeMap<String, Size>);

/// Those of a unit.
#[derive(Default)]
struct Size {
    /// In all rows but those at a pole.
    all: f64,
    /// By row.
    rows: Vec<f64>,
}

impl Sizes {
    pub(crate) fn of(columns: &[Column]) -> Self {
        let mut sizes: BTreeMap<String, Size> = BTreeMap::new();
        for column in columns {
            let unit = column.unit.text().to_owned();
            let rows = &mut sizes.entry(unit).or_default().rows;
            rows.resize(rows.len().max(column.values.len()), 0.0);
            let finite = |v: &f64| if v.is_finite() { v.abs() } else { 0.0 };
            let both = rows.iter_mut().zip(&column.values);
            both.for_each(|(row, v)| *row = row.max(finite(v)));
        }
        for size in sizes.values_mut() {
            size.all = but_for_poles(&size.rows);
        }
        Self(sizes)
    }

    /// The largest of the columns in the unit of one.
    fn of_unit(&self, column: &Column) -> f64 {
        self.0.get(column.unit.text()).map_or(0.0, |size| size.all)
    }

    /// The same, beside what stands in a row.
    fn in_row(&self, column: &Column, row: usize) -> f64 {
        let size = self.0.get(column.unit.text());
        let own = size.and_then(|size| size.rows.get(row));
        self.of_unit(column).max(own.copied().unwrap_or(0.0))
    }

    /// The largest of values in the unit of a column, and its row: the one that [`extremes_of`] tells of them.
    pub fn largest(&self, column: &Column, values: &[f64]) -> Option<(usize, f64)> {
        let rows = values.iter().copied().enumerate();
        first_best(rows, f64::gt, ROUNDING * self.of_unit(column))
    }
}

/// The extremes of a column of a table over `along`, of what says where rows are in those that were reached. Of values that differ
/// by rounding the first one has the place.
pub(crate) fn extremes_of<'r>(
    column: &'r Column,
    table: &Table,
    along: &[f64],
    sizes: &Sizes,
) -> Extremes<'r> {
    let mut places = table.columns.iter().take(table.places);
    let demanded = places.any(|place| place.name == column.name);
    let counts = |row: usize| {
        let closure = table.closure.get(row);
        !demanded || closure.is_none_or(|c| c.is_finite())
    };
    let rows = column.values.iter().copied().enumerate();
    // What is nothing beside a pole in its row is so.
    let usual = sizes.of_unit(column);
    let plain = |row: usize, value: f64| match sizes.in_row(column, row) {
        at_pole if at_pole > usual => without_rounding(value, at_pole),
        _ => value,
    };
    let rows = rows.filter(|(row, _)| counts(*row));
    let rows = rows.map(|(row, value)| (row, plain(row, value)));
    let rounding = ROUNDING * usual;
    let best = |better: fn(&f64, &f64) -> bool| {
        let (row, value) = first_best(rows.clone(), better, rounding)?;
        let at = along.get(row).copied().unwrap_or(f64::NAN);
        let size = sizes.in_row(column, row);
        Some(Extreme {
            value,
            row,
            at,
            size,
        })
    };
    Extremes {
        column,
        smallest: best(f64::lt),
        largest: best(f64::gt),
    }
}

/// The largest of the rows' values but for those of few rows beside which all others are nothing.
fn but_for_poles(rows: &[f64]) -> f64 {
    let mut sorted = rows.to_vec();
    sorted.sort_by(f64::total_cmp);
    let most = (sorted.len() as f64 * (1.0 - FEW)) as usize;
    let usual = sorted.get(most).copied().unwrap_or(0.0);
    let all = sorted.iter().copied();
    let held = all.filter(|x| usual == 0.0 || *x <= POLE * usual);
    held.fold(0.0, f64::max)
}

/// A value as people read it: what is only rounding of numbers of a size is 0.
pub fn without_rounding(value: f64, size: f64) -> f64 {
    match value.abs() <= ROUNDING * size {
        true => 0.0,
        false => value,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kempe_units::Unit;

    #[test]
    fn what_is_rounding_beside_its_kind_is_nothing_and_has_the_first_place() {
        let column = |name: &str, unit: &str, values: &[f64]| {
            let mut column = Column::new(name, Unit::parse(unit).unwrap());
            column.values = values.to_vec();
            column
        };
        let columns = [
            column("f", "N", &[1e3, 1e3 * (1.0 + 1e-15), 1e3]),
            column("g", "N", &[1e-13, -1e-12, f64::NAN]),
            column("h", "mm", &[1e-13, -1e-12, f64::INFINITY]),
        ];
        let sizes = Sizes::of(&columns);
        let table = |closure: &[f64]| Table {
            name: "t".to_owned(),
            columns: vec![column("m", "deg", &[])],
            places: 1,
            closure: closure.to_vec(),
            smallest_singular_value: Vec::new(),
            forces: None,
            balance: None,
            notes: Vec::new(),
        };
        let along = [5.0, 6.0, 7.0];
        let whole = table(&[0.0; 3]);
        let [f, g, h] = [0, 1, 2].map(|k| extremes_of(&columns[k], &whole, &along, &sizes));
        let part = table(&[0.0, 0.0, f64::NAN]);
        let drive = column("m", "deg", &[10.0, 20.0, 30.0]);
        let reached = extremes_of(&drive, &part, &along, &sizes).largest.unwrap();
        assert_eq!(
            (reached.value, reached.at),
            (20.0, 6.0),
            "demanded is not reached"
        );
        assert_eq!(
            f.largest.unwrap().at,
            5.0,
            "the first of those that differ by rounding"
        );
        let shown = |e: &Extremes<'_>| {
            [e.smallest, e.largest].map(|x| {
                let x = x.unwrap();
                without_rounding(x.value, x.size)
            })
        };
        assert_eq!(shown(&g), [0.0, 0.0]);
        assert_eq!(shown(&h), [-1e-12, f64::INFINITY]);
        assert_eq!((h.smallest.unwrap().at, h.largest.unwrap().at), (6.0, 7.0));
    }

    /// One row at a pole does not make all others nothing, and what stands in that row is nothing beside it.
    #[test]
    fn a_pole_tells_nothing_of_other_rows() {
        let column = |values: Vec<f64>| {
            let mut column = Column::new("f", Unit::parse("N").unwrap());
            column.values = values;
            column
        };
        let at_pole =
            |pole: f64, other: f64| (0..40).map(move |k| if k == 7 { pole } else { other });
        let columns = [
            column(at_pole(4e16, 3.0).collect()),
            column(at_pole(0.9, 0.3).collect()),
        ];
        let sizes = Sizes::of(&columns);
        assert_eq!(sizes.of_unit(&columns[1]), 3.0);
        let whole = Table {
            name: "t".to_owned(),
            columns: Vec::new(),
            places: 0,
            closure: vec![0.0; 40],
            smallest_singular_value: Vec::new(),
            forces: None,
            balance: None,
            notes: Vec::new(),
        };
        let other = extremes_of(&columns[1], &whole, &[0.0; 40], &sizes);
        let [low, high] = [other.smallest, other.largest].map(Option::unwrap);
        assert_eq!([low.value, high.value], [0.0, 0.3]);
        assert_eq!(without_rounding(high.value, high.size), 0.3);
    }
}
