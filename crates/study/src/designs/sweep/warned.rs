//! What the designs of a sweep are warned of, as the study that is run would be alone. It stands in their notes, which parts keep.

use kempe_model::{Diagnostic, Severity};

use super::question::Question;
use crate::table::Table;

/// What a warning begins with in a note, and what parts its code from its text.
const BEGINS: &str = "warned of `";
const PARTS: &str = "`: ";
/// What parts one thing in a note from the next.
pub(super) const NEXT: &str = "; ";

/// The warnings among what is told of a study of this name, as they stand in a note.
pub(super) fn noted<'d>(
    study: &str,
    told: impl IntoIterator<Item = &'d Diagnostic>,
) -> Vec<String> {
    let of_study = format!("study `{study}`: ");
    let warnings = told.into_iter().filter(|d| d.severity == Severity::Warning);
    let line = |d: &Diagnostic| {
        let text = d.message.strip_prefix(&of_study).unwrap_or(&d.message);
        format!("{BEGINS}{}{PARTS}{text}", d.code)
    };
    warnings.map(line).collect()
}

/// For each code, of how many designs it is told, with the first of them.
pub(super) fn warned(question: &Question<'_>, table: &Table) -> Vec<Diagnostic> {
    let mut all: Vec<(&str, usize, usize, &str)> = Vec::new();
    for (row, note) in table.notes.iter().enumerate() {
        let told = note.iter().flat_map(|note| note.split(BEGINS).skip(1));
        for (code, text) in told.filter_map(|told| told.split_once(PARTS)) {
            let text = text.strip_suffix(NEXT).unwrap_or(text);
            match all.iter_mut().find(|it| it.0 == code) {
                Some(known) => known.1 += 1,
                None => all.push((code, 1, row, text)),
            }
        }
    }
    let over = &question.study.over;
    let warning = |(code, count, row, text): (&str, usize, usize, &str)| {
        let designs = match count {
            1 => "1 design is".to_owned(),
            _ => format!("{count} designs are"),
        };
        let message = format!(
            "study `{}`: {designs} warned of `{code}`, first number {}: {text}",
            question.name,
            row + 1
        );
        let values = question.designs.values(row);
        let values = values.iter().enumerate().map(|(k, si)| {
            let name = question.name_of(k);
            format!("--set \"{name} = {}\"", question.text_of(k, *si))
        });
        let values: Vec<String> = values.collect();
        Diagnostic::warning("designs-warned", message)
            .at(over.span.clone(), "")
            .note(format!("of {} designs; the notes tell which", table.rows()))
            .help(format!(
                "run `{}` alone as that design: {}",
                over.name,
                values.join(" ")
            ))
    };
    all.into_iter().map(warning).collect()
}
