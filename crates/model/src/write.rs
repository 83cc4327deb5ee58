//! A model as a file that reads back the same.

mod actions;
mod adjust;
mod designs;
mod laws;
mod links;
mod mechanism;
mod spelling;
mod studies;
mod synthesis;

use crate::edit::set_value;
use crate::ids::ParameterId;
use crate::item::{File, Item};
use crate::key_table::UNITS;
use crate::keys::{Key, Takes};
use crate::model::{FileUnits, Model, Parameter, UnitName};
use crate::tables::Tables;
use kempe_units::{Dimension, Unit};
use spelling::Writer;

/// A model as text: the file, and the tables that it names.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ModelFile {
    /// The model file.
    pub toml: String,
    /// Measured laws and loads, by the names that the file gives them.
    pub tables: Tables,
}

impl ModelFile {
    /// A text, with the tables that it names.
    pub fn new(toml: impl Into<String>, tables: Tables) -> Self {
        Self {
            toml: toml.into(),
            tables,
        }
    }
}

impl Model {
    /// The model as a file, with the tables beside it.
    ///
    /// Reading the file gives [the same](Model::same_as) model: numbers have the fewest digits that read back to the same
    /// bits, in the file's units where these have such a number, and expressions over parameters stay expressions. What is
    /// not part of the model is not in the file: comments, what an entry leaves to its default, and how a thing was said
    /// where it can be said in several ways (a `bar` is written as mass, inertia and centre; values by `--set` as the values
    /// of the parameters).
    ///
    /// The model must be one that was read: of one put together by hand, what the language cannot say is lost or told when
    /// the file is read.
    ///
    /// # Example
    ///
    /// ```
    /// use kempe_model::Model;
    /// let text = r#"
    ///     units = { length = "mm", angle = "deg" }
    ///     [parameters]
    ///     a = "20 mm"
    ///     [links]
    ///     frame   = { A = [0, 0], D = [60, 0] }
    ///     crank   = { A-B = "a" }
    ///     coupler = { B-C = "2*a + 10 mm" }
    ///     rocker  = { D-C = 40 }
    ///     [drives]
    ///     motor = { turns = "crank", speed = "1 rad/s" }
    /// "#;
    /// let model = Model::from_toml(text, "four-bar", &mut |_| Err(String::new())).unwrap().model;
    /// let file = model.to_toml();
    /// assert!(file.toml.contains("coupler = { B-C = \"2 * a + 10 mm\" }"), "{}", file.toml);
    /// let again = Model::from_toml(&file.toml, "", &mut file.tables.files()).unwrap().model;
    /// assert!(again.same_as(&model));
    /// ```
    pub fn to_toml(&self) -> ModelFile {
        let mut writer = Writer::new(self);
        let mut file = File {
            head: vec![
                ("title".to_owned(), Item::text(&self.title)),
                ("units".to_owned(), units(&self.units)),
            ],
            ..File::default()
        };
        writer.gravity(&mut file);
        let parameters = self.parameters.iter();
        *file.section("parameters") = parameters
            .map(|p| (p.name.clone(), writer.parameter(p)))
            .collect();
        writer.links(&mut file);
        writer.mechanism(&mut file);
        writer.actions(&mut file);
        writer.clearances(&mut file);
        writer.questions(&mut file);
        ModelFile {
            toml: file.to_toml(),
            tables: writer.tables,
        }
    }
}

impl Model {
    /// The text that the model was read from, with what was set from outside, and the tables that it names; where one of these stands in another folder, or
    /// it was not read, [the model as text](Self::to_toml).
    pub fn as_written(&self) -> ModelFile {
        match self.source.as_deref() {
            Some(text) => ModelFile {
                toml: text.to_owned(),
                tables: Tables::clone(&self.tables),
            },
            None => self.to_toml(),
        }
    }

    /// The model with other values (SI) of some parameters, and as a file: the text that it was read from with just these values changed, or
    /// where it names tables in other folders, or was not read, [the model as text](Self::to_toml).
    pub fn with_values(&self, values: &[(ParameterId, f64)]) -> (Self, ModelFile) {
        let mut model = self.clone();
        for (id, value) in values {
            if let Some(parameter) = model.parameters.get_mut(id.index()) {
                parameter.value = kempe_units::Expr::Const(*value);
            }
        }
        let writer = Writer::new(&model);
        let mut text = model.source.as_deref().map(str::to_owned);
        for (id, _) in values {
            let parameter = model.parameters.get(id.index());
            text = text.zip(parameter).and_then(|(text, parameter)| {
                let mut value = String::new();
                writer.parameter(parameter).write(&mut value);
                set_value(&text, &["parameters", &parameter.name], &value).ok()
            });
        }
        model.source = text.as_deref().map(Into::into);
        let file = model.as_written();
        (model, file)
    }
}

impl Writer<'_> {
    /// A parameter's value says what it measures: a bare number none.
    fn parameter(&self, parameter: &Parameter) -> Item {
        match parameter.value {
            kempe_units::Expr::Const(x) if parameter.dimension == Dimension::NONE => {
                Item::Number(x)
            }
            _ => self.expression(&parameter.value, parameter.dimension),
        }
    }
}

fn units(units: &FileUnits) -> Item {
    let named = |key: &str, unit: &UnitName| (key.to_owned(), Item::text(&unit.name));
    let mut entries = vec![named("length", &units.length), named("angle", &units.angle)];
    for unit in &units.more {
        let dimension = Unit::parse(&unit.name).map(|u| u.dimension());
        let is = |key: &&Key| matches!(key.takes, Takes::Unit(d) if Ok(d) == dimension);
        entries.extend(UNITS.keys().find(is).map(|key| named(key.name, unit)));
    }
    Item::Table(entries)
}
