//! Collects the rows of a study into columns.

use kempe_dynamics::ForceEvidence;
use kempe_mechanism::Mechanism;
use kempe_model::{Diagnostic, ForceMeasure, Leaf, Measure, Model, Plot};
use kempe_units::{Expr, Unit};

use crate::along::Row;
use crate::columns::Asked;
use crate::force_notes::ForceNotes;
use crate::quantity::Quantity;
use crate::result::{Figure, Frame, Scalar};
use crate::table::{Column, Table};
use crate::unit::{Units, shown};

/// Collects samples into columns.
pub(crate) struct RowSink {
    pub table: Table,
    drives: Vec<Unit>,
    columns: usize,
    curves: Vec<Column>,
    pub force_notes: ForceNotes,
    pub scalars: Vec<Scalar>,
    /// Values of what is hidden by row, SI.
    pub hidden: Vec<Vec<f64>>,
}

impl RowSink {
    /// Columns for what is asked, behind `first`: time, or the arc length of a circuit.
    pub fn new(name: &str, model: &Model, units: &Units, asked: &Asked, first: Column) -> Self {
        let column = |q: &Quantity| Column::new(q.name.clone(), q.unit(units));
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
            unit: q.unit(units),
            value: f64::NAN,
        });
        Self {
            table: Table {
                name: name.to_owned(),
                places: 1 + drives.len(),
                columns,
                closure: Vec::new(),
                smallest_singular_value: Vec::new(),
                forces: None,
                balance: None,
                notes: Vec::new(),
            },
            force_notes: ForceNotes::default(),
            drives,
            columns: asked.columns.len(),
            curves: asked.curves.iter().map(column).collect(),
            scalars: scalars.collect(),
            hidden: vec![Vec::new(); asked.hidden.len()],
        }
    }

    /// Adds a row; `first` is its value in the first column.
    pub fn push(&mut self, mechanism: &Mechanism, first: f64, row: Row) -> Frame {
        let note = row.note(mechanism);
        let Row { sample, forces, .. } = row;
        let drives = sample.coordinates.iter().zip(&self.drives);
        let places = drives.map(|(si, unit)| shown(*si, unit));
        let values = sample.values.iter();
        let (own, rest) = sample.values.split_at(self.columns.min(values.len()));
        let (curves, scalars) = rest.split_at(self.curves.len().min(rest.len()));
        let (scalars, hidden) = scalars.split_at(self.scalars.len().min(scalars.len()));
        for (values, value) in self.hidden.iter_mut().zip(hidden) {
            values.push(*value);
        }
        let fixed = self.table.places;
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
        let mut arrows = Vec::new();
        if let Some(forces) = forces {
            let at = self.table.notes.len();
            let columns = self.table.forces.get_or_insert_default();
            let of = |f: fn(&ForceEvidence) -> f64| forces.evidence.as_ref().map_or(f64::NAN, f);
            columns.route_difference.push(of(|e| e.route_difference));
            columns.residual.push(of(|e| e.residual));
            columns.condition.push(of(|e| e.condition));
            self.force_notes.add(at, forces.notes);
            arrows = forces.arrows;
        }
        self.table.notes.push(note);
        Frame {
            links: sample.links,
            points: sample.points,
            rates: sample.rates,
            arrows,
        }
    }

    /// The plots in the order of the file.
    pub fn figures(&self, plots: &[Plot]) -> Vec<Figure> {
        let mut curves = self.curves.iter();
        plots
            .iter()
            .filter_map(|plot| match plot {
                Plot::Curves(columns) => {
                    let own: Vec<Column> = curves.by_ref().take(columns.len()).cloned().collect();
                    (own.len() == columns.len()).then(|| curves_of(columns, own))
                }
                Plot::Path(point) => Some(Figure::Path(*point)),
                Plot::Hodograph(it) => {
                    let axes = [curves.next()?.clone(), curves.next()?.clone()];
                    Some(Figure::Hodograph(it.name.clone(), axes))
                }
            })
            .collect()
    }

    /// What was noted about the forces, as warnings.
    pub fn force_warnings(&self, mechanism: &Mechanism, along: usize) -> Vec<Diagnostic> {
        self.force_notes.warnings(mechanism, &self.table, along)
    }
}

/// A picture of columns: what a cylinder or motor can give is a limit of what it gives.
fn curves_of(asked: &[kempe_model::Column], columns: Vec<Column>) -> Figure {
    let is_limit =
        |measure: &Measure| matches!(measure, Expr::Leaf(Leaf::Force(ForceMeasure::Capacity(_))));
    let (mut curves, mut limits) = (Vec::new(), Vec::new());
    for (asked, column) in asked.iter().zip(columns) {
        if is_limit(&asked.measure) {
            limits.push(column);
        } else {
            curves.push(column);
        }
    }
    if curves.is_empty() {
        std::mem::swap(&mut curves, &mut limits);
    }
    Figure::Curves { curves, limits }
}
