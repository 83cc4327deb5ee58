//! Reference values of the columns and numbers of a study.

use kempe_model::{Diagnostic, Model, Study, StudyKind};
use kempe_motion::MotionError;
use kempe_motion::progress::Silent;
use kempe_simulate::Simulated;
use kempe_units::{Dimension, Unit};

use super::quantity::dimension_fits;
use crate::along::Along;
use crate::clearance::contact;
use crate::explain::cannot_move;
use crate::pose::Setting;
use crate::prepared::design;
use crate::quantity::Quantity;
use crate::result::{ContactMet, StudyResult};
use crate::rows::RowPlace;
use crate::run::run;
use crate::table::Table;

/// A row stands where it is asked for up to this part of its place.
const SAME_PLACE: f64 = 1e-9;

/// How a place among the contacts of a study begins, and how their number is asked for.
const CONTACT: &str = "contact";
const CONTACTS: &str = "contacts";

/// A study of a model that was run.
pub(super) struct OfStudy<'m> {
    model: &'m Model,
    result: StudyResult,
    /// What was found where joints have contacts.
    found: Option<Simulated>,
}

impl<'m> OfStudy<'m> {
    /// Runs a study of the model.
    pub fn new(model: &'m Model, study: &Study) -> Result<Self, Vec<Diagnostic>> {
        let (result, found) = match &study.kind {
            StudyKind::Contact(play) => {
                let (result, found) = contact(model, &study.name, play, &mut Silent)?;
                (result, Some(found))
            }
            _ => (run(model, study, &mut Silent)?, None),
        };
        Ok(Self {
            model,
            result,
            found,
        })
    }

    /// A column at a place such as `lock = -40 deg`, something of a contact at one such as `contact = 2` or `contact at B = 2`, or without
    /// a place a number of the study, in a unit; with its dimension.
    pub fn value(&self, name: &str, place: &str, unit: &Unit) -> Result<(f64, Dimension), String> {
        let (si, dimension) = match (place, &self.found) {
            ("", Some(_)) if name.split_once(" at ").map_or(name, |it| it.0) == CONTACTS => {
                let joint = name.split_once(" at ").map(|(_, joint)| joint);
                let count = self.contacts(joint)?.count();
                (count as f64, Dimension::NONE)
            }
            ("", _) => self.number(name)?,
            (_, Some(found)) if place.starts_with(CONTACT) => {
                self.of_contact(name, place, found)?
            }
            _ => self.cell(name, place)?,
        };
        dimension_fits(dimension, unit)?;
        Ok((unit.from_si(si), dimension))
    }

    /// The contacts of a joint, or of all, in order of time.
    fn contacts<'a>(
        &'a self,
        joint: Option<&'a str>,
    ) -> Result<impl Iterator<Item = &'a ContactMet>, String> {
        let known = |name: &str| {
            self.result
                .table
                .column(&format!("{name} touching"))
                .is_some()
        };
        if let Some(name) = joint.filter(|name| !known(name)) {
            return Err(format!("the study has no contact at `{name}`"));
        }
        let all = self.result.contacts.iter();
        Ok(all.filter(move |met| joint.is_none_or(|name| met.joint == name)))
    }

    /// What the list of contacts tells of one, or a measure just before it.
    fn of_contact(
        &self,
        name: &str,
        place: &str,
        found: &Simulated,
    ) -> Result<(f64, Dimension), String> {
        let wanted = || format!("write `{CONTACT} = 2` or `{CONTACT} at B = 2`, not `{place}`");
        let (which, number) = place.split_once('=').ok_or_else(wanted)?;
        let number: usize = number.trim().parse().map_err(|_| wanted())?;
        let joint = match which.trim().strip_prefix(CONTACT).map(str::trim) {
            Some("") => None,
            Some(at) => Some(at.strip_prefix("at ").ok_or_else(wanted)?.trim()),
            None => return Err(wanted()),
        };
        let mut contacts = self.contacts(joint)?;
        let met = number.checked_sub(1).and_then(|index| contacts.nth(index));
        let met = met.ok_or_else(|| format!("the study has no {place}"))?;
        let touch = || {
            let touch = met.touch.ok_or(
                "this contact takes no time: it has a `time`, a `speed` and a `speed after` alone",
            );
            touch.map_err(str::to_owned)
        };
        let speed = Dimension::LENGTH / Dimension::TIME;
        Ok(match name {
            "time" => (met.time, Dimension::TIME),
            "speed" => (met.speed, speed),
            "speed after" => {
                let after = met.speed_after.ok_or("it lasts to the end")?;
                (after, speed)
            }
            "until" => (touch()?.until, Dimension::TIME),
            "lasts" => (touch()?.until - met.time, Dimension::TIME),
            "largest force" => (touch()?.force, Dimension::FORCE),
            "deepest" => (touch()?.depth, Dimension::LENGTH),
            // Of speeds that an impact changes those before it are meant.
            _ => self.just_before(name, met.time, found)?,
        })
    }

    /// A measure on the motion that was found, just before a time, s.
    fn just_before(
        &self,
        name: &str,
        time: f64,
        found: &Simulated,
    ) -> Result<(f64, Dimension), String> {
        let first =
            |told: Vec<Diagnostic>| told.first().map_or(String::new(), |d| d.message.clone());
        let measure = self.model.measure(name).map_err(first)?;
        let quantity = Quantity {
            name: name.to_owned(),
            measure: measure.measure.clone(),
            dimension: measure.dimension,
        };
        let why = |error: MotionError| cannot_move(&design(self.model), &error).message;
        let motion = found.motion(&mut Silent).map_err(why)?;
        let model = &motion.mechanism().model;
        let sampler = Along::new(model, &motion, &[&quantity], measure.needs_forces);
        let values = sampler
            .map_err(first)?
            .values(RowPlace::Time(time.next_down()));
        match values.first() {
            Some(value) if value.is_finite() => Ok((*value, quantity.dimension)),
            _ => Err("no value".to_owned()),
        }
    }

    /// A number of the study, or the sum of a column of a table besides: `sum(A_x)`.
    fn number(&self, name: &str) -> Result<(f64, Dimension), String> {
        let summed = name
            .strip_prefix("sum(")
            .and_then(|rest| rest.strip_suffix(')'));
        let mut besides = self.result.beside.iter();
        if let Some(column) = summed.and_then(|name| besides.find_map(|table| table.column(name))) {
            return Ok((column.si().iter().sum(), column.unit.dimension()));
        }
        let scalar = self.result.scalars.iter().find(|s| s.name == name);
        let scalar = scalar.ok_or_else(|| format!("the study tells no `{name}`"))?;
        Ok((scalar.unit.to_si(scalar.value), scalar.unit.dimension()))
    }

    /// A place such as `linkage = 2`, where the rows are numbered by their first column and stand along no drive, or in a table besides one
    /// by the value of any of its columns: `A_x = 0.195 m`. The table with it.
    fn numbered(&self, place: &str) -> Option<(&Table, Setting)> {
        let (name, number) = place.split_once('=')?;
        let own = self
            .result
            .table
            .columns
            .first()
            .map(|column| (&self.result.table, column));
        let beside = self.result.beside.iter();
        let beside =
            beside.flat_map(|table| table.columns.iter().map(move |column| (table, column)));
        let mut all = own.into_iter().chain(beside);
        let (table, column) = all.find(|(_, column)| column.name == name.trim())?;
        let is_drive = self.model.drives.iter().any(|d| d.name == column.name);
        let number = number.trim();
        let value = match number.split_once(' ') {
            Some((number, unit)) => {
                let unit = Unit::parse(unit.trim()).ok()?;
                unit.to_si(number.parse().ok()?)
            }
            None => number.parse().ok()?,
        };
        let setting = Setting {
            name: column.name.clone(),
            value,
            text: place.to_owned(),
        };
        (!is_drive).then_some((table, setting))
    }

    fn cell(&self, name: &str, place: &str) -> Result<(f64, Dimension), String> {
        let (table, setting) = match self.numbered(place) {
            Some(numbered) => numbered,
            None => {
                let setting = Setting::parse(self.model, place).map_err(|d| d.message)?;
                (&self.result.table, setting)
            }
        };
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
