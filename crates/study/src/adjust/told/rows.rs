//! The rows of what was measured, with what becomes of them.

use std::sync::Arc;

use kempe_motion::Motion;
use kempe_motion::drive_path::DrivePath;
use kempe_motion::progress::Silent;
use kempe_units::Unit;

use super::Teller;
use crate::adjust::certainty::Certainty;
use crate::adjust::fit::Solution;
use crate::along::{Along, Row};
use crate::result::{Figure, Frame};
use crate::rows::RowPlace;
use crate::table::{Column, Table};
use crate::unit::shown;

impl Teller<'_, '_> {
    /// Rows as measured: where, what was measured, what it is, what is missed, and what an error of it does.
    pub(super) fn table(&self, best: &Solution, known: &Certainty) -> (Table, usize) {
        let data = &self.bench.data;
        let rows = data.rows.len();
        let mut number = Column::new("row", Unit::one());
        number.values = (1..=rows).map(|i| i as f64).collect();
        let mut columns = vec![number];
        for drive in data.drives() {
            let of = &self.bench.model.drives[drive.index()];
            let unit = self.units.unit(of.dimension);
            let mut column = Column::new(&of.name, unit.clone());
            let at = data.rows.iter().map(|row| match &row.at {
                Some(at) => shown(at[drive.index()], &unit),
                None => f64::NAN,
            });
            column.values = at.collect();
            columns.push(column);
        }
        let places = columns.len();
        let one_way =
            |c: &Column| c.values.is_sorted_by(|a, b| a < b) || c.values.is_sorted_by(|a, b| a > b);
        let along = usize::from(places == 2 && one_way(&columns[1]));
        for (measure, asked) in self.bench.study.measures.iter().enumerate() {
            let unit = self.units.unit(asked.dimension);
            let mut all = ["measured", "adjusted", "missed"].map(|what| {
                let mut column = Column::new(format!("{} {what}", asked.name), unit.clone());
                column.values = vec![f64::NAN; rows];
                column
            });
            let mut by: Vec<Column> = (0..self.bench.study.unknown.len())
                .map(|k| {
                    let id = self.bench.study.unknown[k];
                    let name = &self.bench.model.parameters[id.index()].name;
                    let of = self.dimension(k) / asked.dimension;
                    let name = format!("d({name})/d({})", asked.name);
                    let mut column = Column::new(name, self.units.unit(of));
                    column.values = vec![f64::NAN; rows];
                    column
                })
                .collect();
            for (value, datum) in data.values.iter().enumerate() {
                if datum.measure != measure {
                    continue;
                }
                let missed = best.misses[value] * datum.scale;
                let values = [datum.value, datum.value + missed, missed];
                for (column, value) in all.iter_mut().zip(values) {
                    column.values[datum.row] = shown(value, &column.unit);
                }
                for (k, column) in by.iter_mut().enumerate() {
                    let slope = known.moved[k][value] / datum.scale;
                    column.values[datum.row] = column.unit.from_si(slope);
                }
            }
            columns.extend(all);
            columns.extend(by);
        }
        columns.extend(self.by_drives(best, known));
        let table = Table {
            name: self.name.to_owned(),
            columns,
            places,
            closure: vec![f64::NAN; rows],
            smallest_singular_value: vec![f64::NAN; rows],
            forces: None,
            balance: None,
            notes: vec![None; rows],
        };
        (table, along)
    }

    /// What an error of where a drive stood does to the unknown parameters.
    pub(super) fn by_drives(&self, best: &Solution, known: &Certainty) -> Vec<Column> {
        let data = &self.bench.data;
        let slopes = self.bench.by_drives(&best.moved);
        let mut columns = Vec::new();
        for drive in data.drives() {
            let of = &self.bench.model.drives[drive.index()];
            for (k, id) in self.bench.study.unknown.iter().enumerate() {
                let parameter = &self.bench.model.parameters[id.index()];
                let name = format!("d({})/d({})", parameter.name, of.name);
                let unit = self.units.unit(parameter.dimension / of.dimension);
                let mut column = Column::new(name, unit);
                column.values = vec![f64::NAN; data.rows.len()];
                for (value, datum) in data.values.iter().enumerate() {
                    let given = &data.rows[datum.row].given;
                    let Some(at) = given.iter().position(|of| *of == drive) else {
                        continue;
                    };
                    // A drive that stood elsewhere is a measure that was other.
                    let by = -known.moved[k][value] / datum.scale * slopes[value][at];
                    let cell = &mut column.values[datum.row];
                    *cell = column.unit.from_si(by) + if cell.is_nan() { 0.0 } else { *cell };
                }
                columns.push(column);
            }
        }
        columns
    }

    /// Places of the rows on the motion through them.
    pub(super) fn row_places(&self, motion: &Motion) -> Vec<RowPlace> {
        let rows = self.bench.data.rows.iter();
        rows.map(|row| match (&motion.path, &row.at) {
            (DrivePath::Coordinate { drive, .. }, Some(at)) => RowPlace::Drive(at[*drive]),
            (DrivePath::Time { .. }, Some(_)) => RowPlace::Time(row.time),
            (_, None) => RowPlace::Time(0.0),
        })
        .collect()
    }

    pub(super) fn rows(&self, motion: &Arc<Motion>) -> Vec<Row> {
        let places = self.row_places(motion);
        let along = Along::with_progress(self.bench.model, motion, &[], false, &[], &mut Silent);
        along.map_or_else(
            |_| Vec::new(),
            |mut along| places.into_iter().map(|place| along.row(place)).collect(),
        )
    }

    pub(super) fn frames(&self, motion: &Arc<Motion>) -> Vec<Frame> {
        let rows = self.rows(motion).into_iter();
        rows.map(|row| Frame {
            links: row.sample.links,
            points: row.sample.points,
            rates: row.sample.rates,
            arrows: Vec::new(),
        })
        .collect()
    }

    pub(super) fn evidence(&self, best: &Solution) -> Option<(Vec<f64>, Vec<f64>)> {
        let motion = self.bench.motion_of(&best.moved)?;
        let rows = self.rows(motion);
        let of = rows
            .iter()
            .map(|row| (row.sample.closure, row.sample.smallest_singular_value));
        (!rows.is_empty()).then(|| of.unzip())
    }

    /// What was measured and what is, over where; and what is missed.
    pub(super) fn figures(&self, table: &Table, exact: bool) -> Vec<Figure> {
        if table.rows() < 2 {
            return Vec::new();
        }
        let column = |name: String| table.column(&name).cloned();
        let measures = self.bench.study.measures.iter();
        measures
            .flat_map(|asked| {
                let both =
                    ["measured", "adjusted"].map(|what| column(format!("{} {what}", asked.name)));
                // Of what is met only rounding is missed.
                let missed = column(format!("{} missed", asked.name)).filter(|_| !exact);
                [
                    both.into_iter().flatten().collect::<Vec<_>>(),
                    missed.into_iter().collect(),
                ]
            })
            .filter(|curves| !curves.is_empty())
            .map(|curves| Figure::Curves {
                curves,
                limits: Vec::new(),
            })
            .collect()
    }
}
