//! What a host asks, and what it is answered.

use std::collections::BTreeMap;

use kempe_model::{Checked, Diagnostic, Model};
use kempe_study::{Silent, encode};
use serde::Deserialize;
use serde_json::{Value, json};

/// A model as text, with what belongs to it.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Request {
    /// The text of the model file.
    pub text: String,
    /// Its title where the file gives none.
    #[serde(default = "untitled")]
    pub title: String,
    /// The tables that the file names, each as text.
    #[serde(default)]
    pub tables: BTreeMap<String, String>,
    /// The study to run; the first of the file where it is left out.
    #[serde(default)]
    pub study: Option<String>,
}

fn untitled() -> String {
    "model".to_owned()
}

impl Request {
    /// Reads a request from JSON.
    ///
    /// # Errors
    ///
    /// What is wrong with it, as an answer with the code `bad-request`: a mistake of the host, not of the model.
    pub fn from_json(bytes: &[u8]) -> Result<Self, Value> {
        serde_json::from_slice(bytes).map_err(|error| {
            let message = format!("the request cannot be read: {error}");
            refusal(&[Diagnostic::error("bad-request", message)])
        })
    }

    fn read(&self) -> Result<Checked, Value> {
        let mut tables = |name: &str| {
            let table = self.tables.get(name);
            table.cloned().ok_or_else(|| "it was not given".to_owned())
        };
        Model::from_toml(&self.text, &self.title, &mut tables).map_err(|found| refusal(&found))
    }
}

/// An answer that tells why there is no other: `{ "diagnostics": […] }`, in the shape of `kempe … --json`.
fn refusal(found: &[Diagnostic]) -> Value {
    json!({ "diagnostics": found.iter().map(encode::diagnostic).collect::<Vec<_>>() })
}

/// What `kempe check --json` prints, without the name of the file.
///
/// # Errors
///
/// What is wrong with the model file, as `{ "diagnostics": […] }`.
pub fn check(request: &Request) -> Result<Value, Value> {
    let checked = request.read()?;
    let report = kempe_study::check(&checked.model);
    let finding = checked.warnings.iter().chain(&report.diagnostics);
    let finding: Vec<Value> = finding.map(encode::diagnostic).collect();
    let mut answer = serde_json::to_value(&report).unwrap_or_default();
    answer["diagnostics"] = Value::Array(finding);
    Ok(answer)
}

/// The table of a study as CSV, byte for byte what `kempe run` writes.
///
/// # Errors
///
/// What is wrong with the model file, that it has no such study (`unknown-study`) or none at all (`no-drive`), and why the
/// study cannot start, as `{ "diagnostics": […] }`.
pub fn run(request: &Request) -> Result<String, Value> {
    let model = request.read()?.model;
    let study = match &request.study {
        Some(name) => model.studies.iter().find(|s| s.name == *name),
        None => model.studies.first(),
    };
    let Some(study) = study else {
        return Err(refusal(&[no_study(&model, request.study.as_deref())]));
    };
    let result = kempe_study::run(&model, study, &mut Silent).map_err(|found| refusal(&found))?;
    Ok(encode::csv(&result.table))
}

/// Why there is no study to run.
fn no_study(model: &Model, asked: Option<&str>) -> Diagnostic {
    let Some(name) = asked else {
        let message = "there is nothing to run: the file has no study and no drive";
        return Diagnostic::error("no-drive", message);
    };
    let finding = Diagnostic::error("unknown-study", format!("there is no study `{name}`"));
    let known: Vec<&str> = model.studies.iter().map(|s| s.name.as_str()).collect();
    match known.is_empty() {
        true => finding,
        false => finding.help(format!("the file has: {}", known.join(", "))),
    }
}
