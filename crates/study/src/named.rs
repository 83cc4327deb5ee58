//! Studies by their names.

use kempe_model::{Diagnostic, Model, Study};
use kempe_units::nearest;

/// The study of a model that has this name.
///
/// # Errors
///
/// That there is none, with the name that is near.
pub fn study_named<'m>(model: &'m Model, name: &str) -> Result<&'m Study, Diagnostic> {
    if let Some(study) = model.studies.iter().find(|s| s.name == name) {
        return Ok(study);
    }
    let error = Diagnostic::error("unknown-study", format!("there is no study `{name}`"));
    let known = model.studies.iter().map(|s| s.name.as_str());
    Err(match nearest(name, known) {
        Some(near) => error.help(format!("did you mean `{near}`?")),
        None => error.help(others(model)),
    })
}

/// The studies that can run.
fn others(model: &Model) -> String {
    let known: Vec<&str> = model.studies.iter().map(|s| s.name.as_str()).collect();
    match known.is_empty() {
        true => "the file has no other study; ask for the motion: [studies.turn] with the line kind = \"motion\"".to_owned(),
        false => format!("the file has: {}", known.join(", ")),
    }
}
