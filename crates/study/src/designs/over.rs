//! The study that is run for every design, and what is told of it.

use kempe_model::{Diagnostic, Model, OverStudy, ParameterId, Severity, Study};

/// What a study of designs asks for, in words, for `check`.
pub(crate) fn in_words(
    model: &Model,
    what: &str,
    over: &OverStudy,
    ids: &[ParameterId],
    besides: Option<&'static str>,
) -> String {
    let names = ids.iter().filter_map(|id| model.parameters.get(id.index()));
    let names = names.map(|p| p.name.as_str()).chain(besides);
    let names: Vec<&str> = names.collect();
    format!("{what} of `{}` over {}", over.name, names.join(", "))
}

/// The study that is run for every design.
pub(super) fn study_of<'m>(
    model: &'m Model,
    over: &OverStudy,
) -> Result<&'m Study, Vec<Diagnostic>> {
    crate::named::study_named(model, &over.name).map_err(|unknown| vec![unknown])
}

/// That some of what was asked for a number has none, `missing` of so many designs or pieces.
pub(super) fn valueless(name: &str, (missing, of): (usize, &str), over: &OverStudy) -> Diagnostic {
    let message = format!("`{name}` has no value in {missing} of {of}");
    Diagnostic::warning("no-value", message)
        .at(over.span.clone(), "")
        .help("a root, logarithm or arc of a number outside its range, a quotient by zero, what passes infinity (as the centre of a link that does not turn), or a place that is not on the motion")
}

/// What is wrong with the file's own design does not keep others from being tried.
pub(super) fn softened(mut told: Diagnostic) -> Diagnostic {
    if told.severity == Severity::Error {
        told.severity = Severity::Warning;
        told.message = format!("the file's own design: {}", told.message);
    }
    told
}
