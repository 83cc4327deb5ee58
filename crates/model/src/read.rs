//! From the text of a model file to a [`Model`], with everything that is to be said about it.

mod actuators;
mod adjust;
mod algebra;
mod arguments;
mod assembly;
mod carrier;
mod choices;
mod clearance;
mod cognates;
mod column;
mod context;
mod controls;
mod csv;
mod designs;
mod draft;
mod drawn;
mod drives;
mod dwell;
mod ends;
mod entry;
mod fit;
mod force_names;
mod friction;
mod guidance;
mod holder;
mod joints;
mod law_table;
pub(crate) mod laws;
mod links;
mod loads;
mod masses;
mod measure_names;
mod measures;
pub(crate) mod names;
mod nature;
mod oil;
mod one_measure;
mod parameters;
mod path;
mod phrase;
mod place;
mod places;
pub(crate) mod play_start;
mod plots;
mod rows;
mod sections;
mod simulate;
pub(crate) mod springs;
pub(crate) mod studies;
mod switches;
mod synthesis;
mod transmission;
mod value;
mod vibrations;

use std::borrow::Cow;
use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Severity};
use crate::document;
use crate::edit::set_value;
use crate::item::{number, quoted};
use crate::model::Model;
use crate::tables::Tables;
use context::Context;
pub use csv::{MAX_TABLE_BYTES, PARTIAL_TABLE, partial_table};
pub use one_measure::Compared;

/// A model that stands, and what a careful engineer would want to be told about its file.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Checked {
    /// The model.
    pub model: Model,
    /// Warnings, in the order of the file.
    pub warnings: Vec<Diagnostic>,
}

/// The largest file that is read, in bytes.
pub const MAX_FILE_BYTES: usize = 8 << 20;

impl Model {
    /// Reads a model file.
    ///
    /// `name` is the title of a file that has none. `files` is asked for the content of files that the model names (tables
    /// of measured motions); it answers with the reason where it cannot.
    ///
    /// # Errors
    ///
    /// Everything that is wrong with the file, in the order of the file, warnings included.
    ///
    /// # Example
    ///
    /// ```
    /// use kempe_model::Model;
    /// let text = r#"
    ///     units = { length = "mm", angle = "deg" }
    ///     [links]
    ///     frame   = { A = [0, 0], D = [60, 0] }
    ///     crank   = { A-B = 20 }
    ///     coupler = { B-C = 50 }
    ///     rocker  = { D-C = 40 }
    ///     [drives]
    ///     motor = { turns = "crank", speed = "1 rad/s" }
    /// "#;
    /// let checked = Model::from_toml(text, "four-bar", &mut |name| Err(format!("no file {name}"))).unwrap();
    /// assert_eq!(checked.model.links.len(), 4);
    /// ```
    pub fn from_toml(
        text: &str,
        name: &str,
        files: &mut dyn FnMut(&str) -> Result<String, String>,
    ) -> Result<Checked, Vec<Diagnostic>> {
        Self::from_toml_with(text, name, files, &[])
    }

    /// Reads a model file, with parameters set from outside: `("a", "25 mm")`. Of two for one name the later counts.
    ///
    /// # Errors
    ///
    /// Those of [`from_toml`](Self::from_toml); what is wrong with an override is labelled in the override's own text.
    pub fn from_toml_with(
        text: &str,
        name: &str,
        files: &mut dyn FnMut(&str) -> Result<String, String>,
        overrides: &[(String, String)],
    ) -> Result<Checked, Vec<Diagnostic>> {
        if text.len() > MAX_FILE_BYTES {
            return Err(vec![too_large(text.len())]);
        }
        let mut tables = Tables::new();
        let mut elsewhere = false;
        let mut files = |name: &str| {
            let text = files(name)?;
            elsewhere |= !is_beside(name);
            tables.insert(name, &*text);
            Ok(text)
        };
        let mut cx = Context::new(name, &mut files);
        let root = document::parse(text, &mut cx.found, &mut cx.broken);
        let own = cx.found.len();
        sections::read(&mut cx, &root, overrides);
        let (mut found, broken) = (cx.found, cx.broken);
        // what may follow from what could not be read is not told
        let rest = found.split_off(own).into_iter();
        let rest = rest.filter(|d| !broken.may_cause(d, text));
        found.extend(rest.map(|d| match broken.has_lines() {
            true => of_a_broken_file(d),
            false => d,
        }));
        for label in found
            .iter_mut()
            .flat_map(|d| &mut d.labels)
            .filter(|l| l.source.is_none())
        {
            // a string with a broken escape has no sure places
            label.span =
                text.floor_char_boundary(label.span.start)..text.ceil_char_boundary(label.span.end);
        }
        found.sort_by_key(Diagnostic::start);
        found.dedup();
        if found.iter().any(|d| d.severity == Severity::Error) {
            return Err(found);
        }
        let mut model = cx.model;
        if !elsewhere {
            model.source = with_overrides(text, overrides);
            model.tables = Arc::new(tables);
        }
        Ok(Checked {
            model,
            warnings: found,
        })
    }

    /// Reads a model file from its bytes.
    ///
    /// # Errors
    ///
    /// Those of [`from_toml_with`](Self::from_toml_with), and `not-utf8` with the offset of the first byte that is no text.
    pub fn from_bytes(
        bytes: &[u8],
        name: &str,
        files: &mut dyn FnMut(&str) -> Result<String, String>,
        overrides: &[(String, String)],
    ) -> Result<Checked, Vec<Diagnostic>> {
        if bytes.len() > MAX_FILE_BYTES {
            return Err(vec![too_large(bytes.len())]);
        }
        match std::str::from_utf8(bytes) {
            Ok(text) => Self::from_toml_with(text, name, files, overrides),
            Err(error) => {
                let offset = error.valid_up_to();
                let line = bytes
                    .get(..offset)
                    .unwrap_or(&[])
                    .iter()
                    .filter(|b| **b == b'\n')
                    .count()
                    + 1;
                let byte = bytes.get(offset).copied().unwrap_or(0);
                Err(vec![
                    Diagnostic::error(
                        "not-utf8",
                        format!(
                            "line {line} is not UTF-8 text: byte 0x{byte:02x} at offset {offset}"
                        ),
                    )
                    .at(offset..offset, "")
                    .help("save the file as UTF-8"),
                ])
            }
        }
    }
}

/// Whether a table stands beside the file, so that another file with these tables beside it may name it in the same words.
fn is_beside(name: &str) -> bool {
    let is_file = !name.is_empty() && !name.starts_with('.') && !name.ends_with(".toml");
    is_file && !name.contains(['/', '\\', ':'])
}

/// The text with parameters set in it.
fn with_overrides(text: &str, overrides: &[(String, String)]) -> Option<Arc<str>> {
    let mut text = Cow::Borrowed(text);
    for (name, value) in overrides {
        let value = toml_value(value);
        text = Cow::Owned(set_value(&text, &["parameters", name], &value).ok()?);
    }
    Some(text.into())
}

/// What is given for a parameter as TOML: a number, or a text.
fn toml_value(value: &str) -> String {
    match value.trim().parse::<f64>() {
        Ok(x) => number(x),
        Err(_) => quoted(value),
    }
}

/// A list of what the file has is not whole where a part of it could not be read.
fn of_a_broken_file(mut d: Diagnostic) -> Diagnostic {
    if let Some(help) = &mut d.help
        && d.code == "unknown-name"
        && !help.starts_with("did you mean")
    {
        help.push_str("; lines that are not TOML may hold more");
    }
    d
}

fn too_large(bytes: usize) -> Diagnostic {
    Diagnostic::error("too-large", format!("the file has {bytes} bytes"))
        .help(format!("a model file has at most {MAX_FILE_BYTES} bytes"))
}
