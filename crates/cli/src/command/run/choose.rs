//! Which studies of a model are run.

use std::path::Path;

use kempe_model::{Diagnostic, Model, Study};
use kempe_study::study_named;

/// The studies named on the command line, each once, or all.
pub(super) fn chosen<'m>(
    model: &'m Model,
    names: &[String],
    file: &str,
) -> Result<Vec<&'m Study>, Box<Diagnostic>> {
    let mut studies: Vec<&Study> = Vec::new();
    for name in names {
        let study = named(model, name, file)?;
        if studies.iter().all(|s| s.name != study.name) {
            studies.push(study);
        }
    }
    if names.is_empty() {
        studies.extend(&model.studies);
    }
    match studies.is_empty() {
        true => Err(Box::new(nothing_to_run())),
        false => Ok(studies),
    }
}

/// Why a model without studies that can run has none.
pub fn nothing_to_run() -> Diagnostic {
    Diagnostic::error(
        "no-drive",
        "there is nothing to run: the file has no study and no drive",
    )
    .help("say what moves: [drives] motor = { turns = \"crank\", from = 0, to = 360, speed = \"1 rad/s\" }")
}

/// A study named on the command line.
fn named<'m>(model: &'m Model, name: &str, file: &str) -> Result<&'m Study, Box<Diagnostic>> {
    study_named(model, name).map_err(|unknown| {
        let is_file =
            Path::new(name).extension().is_some_and(|e| e == "toml") || Path::new(name).is_file();
        Box::new(match is_file && unknown.code == "unknown-study" {
            true => unknown
                .note(format!(
                    "what follows the model file {file} are its studies"
                ))
                .help(format!("one model file at a time: kempe run {name}")),
            false => unknown,
        })
    })
}
