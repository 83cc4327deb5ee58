//! How it stands in the note of a design what it is warned of and why it does not run.

use kempe_model::{Diagnostic, Severity};

/// What a warning begins with in a note, and what parts its code from its text.
pub(super) const BEGINS: &str = "warned of `";
pub(super) const PARTS: &str = "`: ";
/// What parts one thing in a note from the next.
pub(super) const NEXT: &str = "; ";

/// What is noted of a design on whose way branches cross.
pub(super) const CROSSES: &str = "through a change point";

/// The warnings among what is told of studies of these names, as they stand in a note: each once, whichever told it.
pub(super) fn noted<'d>(
    studies: &[&str],
    told: impl IntoIterator<Item = &'d Diagnostic>,
) -> Vec<String> {
    let of_studies = studies.iter().map(|study| format!("study `{study}`: "));
    let of_studies: Vec<String> = of_studies.collect();
    let warnings = told.into_iter().filter(|d| d.severity == Severity::Warning);
    let mut lines = Vec::new();
    for d in warnings {
        let own = |of: &String| d.message.strip_prefix(of.as_str());
        let text = of_studies.iter().find_map(own).unwrap_or(&d.message);
        let line = format!("{BEGINS}{}{PARTS}{text}", d.code);
        if !lines.contains(&line) {
            lines.push(line);
        }
    }
    lines
}

/// What is told of a design that does not run: what and why.
pub(super) fn with_notes(told: &Diagnostic) -> String {
    let all = std::iter::once(&told.message).chain(&told.notes);
    all.map(String::as_str).collect::<Vec<_>>().join(": ")
}
