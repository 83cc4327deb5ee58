//! Collects the rows of a study into columns.

use kempe_kinematics::Sample;
use kempe_model::{Model, Plot};
use kempe_units::Unit;

use crate::columns::{Asked, Quantity};
use crate::result::{Figure, Frame, Scalar};
use crate::table::{Column, Table};
use crate::unit::{Units, shown};

/// Collects samples into columns.
pub(crate) struct RowSink {
    pub table: Table,
    drives: Vec<Unit>,
    columns: usize,
    curves: Vec<Column>,
    pub scalars: Vec<Scalar>,
}

impl RowSink {
    /// Columns for what is asked, behind `first`: time, or the arc length of a circuit.
    pub fn new(name: &str, model: &Model, units: &Units, asked: &Asked, first: Column) -> Self {
        let column = |q: &Quantity| Column::new(q.name.clone(), units.unit(q.dimension));
        let mut columns = vec![first];
        let drives: Vec<Unit> = model
            .drives
            .iter()
            .map(|d| units.unit(d.dimension))
            .collect();
        columns.extend(
            model
                .drives
                .iter()
                .zip(&drives)
                .map(|(d, u)| Column::new(d.name.clone(), u.clone())),
        );
        columns.extend(asked.columns.iter().map(column));
        let scalars = asked.scalars.iter().map(|q| Scalar {
            name: q.name.clone(),
            unit: units.unit(q.dimension),
            value: f64::NAN,
        });
        Self {
            table: Table {
                name: name.to_owned(),
                columns,
                closure: Vec::new(),
                smallest_singular_value: Vec::new(),
                notes: Vec::new(),
            },
            drives,
            columns: asked.columns.len(),
            curves: asked.curves.iter().map(column).collect(),
            scalars: scalars.collect(),
        }
    }

    /// Adds a row; `first` is its value in the first column.
    pub fn push(&mut self, first: f64, sample: Sample) -> Frame {
        let drives = sample.coordinates.iter().zip(&self.drives);
        let places = drives.map(|(si, unit)| shown(*si, unit));
        let values = sample.values.iter();
        let (own, rest) = sample.values.split_at(self.columns.min(values.len()));
        let (curves, scalars) = rest.split_at(self.curves.len().min(rest.len()));
        let fixed = 1 + self.drives.len();
        let mut columns = self.table.columns.iter_mut();
        for (column, value) in columns
            .by_ref()
            .take(fixed)
            .zip(std::iter::once(first).chain(places))
        {
            column.values.push(value);
        }
        for (column, value) in columns.zip(own).chain(self.curves.iter_mut().zip(curves)) {
            column.values.push(column.unit.from_si(*value));
        }
        for (scalar, value) in self.scalars.iter_mut().zip(scalars) {
            if !scalar.value.is_finite() {
                scalar.value = scalar.unit.from_si(*value);
            }
        }
        self.table.closure.push(sample.closure);
        self.table
            .smallest_singular_value
            .push(sample.smallest_singular_value);
        self.table.notes.push(sample.note);
        Frame {
            links: sample.links,
            points: sample.points,
        }
    }

    /// The plots in the order of the file.
    pub fn figures(&self, plots: &[Plot]) -> Vec<Figure> {
        let mut curves = self.curves.iter();
        plots
            .iter()
            .filter_map(|plot| match plot {
                Plot::Column(_) => curves.next().cloned().map(Figure::Curve),
                Plot::Path(point) => Some(Figure::Path(*point)),
            })
            .collect()
    }
}
