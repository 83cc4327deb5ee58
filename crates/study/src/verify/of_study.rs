//! Reference values of the columns and numbers of a study.

use kempe_model::{Diagnostic, Model, Study};
use kempe_motion::progress::Silent;
use kempe_units::{Dimension, Unit};

use super::compare::dimension_fits;
use crate::pose::Setting;
use crate::result::StudyResult;
use crate::run::run;

/// A row stands where it is asked for up to this part of its place.
const SAME_PLACE: f64 = 1e-9;

/// A study of a model that was run.
pub(super) struct OfStudy<'m> {
    model: &'m Model,
    result: StudyResult,
}

impl<'m> OfStudy<'m> {
    /// Runs a study of the model.
    pub fn new(model: &'m Model, study: &Study) -> Result<Self, Vec<Diagnostic>> {
        let result = run(model, study, &mut Silent)?;
        Ok(Self { model, result })
    }

    /// A column at a place such as `lock = -40 deg`, or without a place a number of the study, in a unit; with its dimension.
    pub fn value(&self, name: &str, place: &str, unit: &Unit) -> Result<(f64, Dimension), String> {
        let (si, dimension) = match place {
            "" => self.number(name)?,
            _ => self.cell(name, place)?,
        };
        dimension_fits(dimension, unit)?;
        Ok((unit.from_si(si), dimension))
    }

    fn number(&self, name: &str) -> Result<(f64, Dimension), String> {
        let scalar = self.result.scalars.iter().find(|s| s.name == name);
        let scalar = scalar.ok_or_else(|| format!("the study tells no `{name}`"))?;
        Ok((scalar.unit.to_si(scalar.value), scalar.unit.dimension()))
    }

    fn cell(&self, name: &str, place: &str) -> Result<(f64, Dimension), String> {
        let table = &self.result.table;
        let setting = Setting::parse(self.model, place).map_err(|d| d.message)?;
        let along = table.column(&setting.name);
        let along = along.ok_or_else(|| format!("the study has no column `{}`", setting.name))?;
        let near =
            |at: &f64| (at - setting.value).abs() <= SAME_PLACE * setting.value.abs().max(1.0);
        let row = along.si().iter().position(near);
        let row = row.ok_or_else(|| format!("the study has no row at {place}"))?;
        let column = table.column(name);
        let column = column.ok_or_else(|| format!("the study has no column `{name}`"))?;
        match column.values.get(row) {
            Some(value) if value.is_finite() => {
                Ok((column.unit.to_si(*value), column.unit.dimension()))
            }
            _ => {
                let note = table.notes.get(row).and_then(Option::as_deref);
                Err(note.unwrap_or("no value").to_owned())
            }
        }
    }
}
