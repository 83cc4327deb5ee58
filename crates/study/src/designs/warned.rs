//! What designs are warned of, as the study that is run would be alone: what their rows warn of, how it stands in their notes, and how many it is told of.

use std::sync::Arc;

use kempe_model::{Diagnostic, Model, OverStudy, Severity, StudyKind};
use kempe_motion::Motion;

use super::bench::Bench;
use super::rows::rows_of;
use crate::columns::Asked;
use crate::motion::abscissa;
use crate::slot_ends::has_ends;

/// Whether rows may warn of anything: forces, and pins that leave their slots.
pub(super) fn may_warn(model: &Model, kind: &StudyKind) -> bool {
    matches!(kind, StudyKind::Forces(_)) || has_ends(model) && matches!(kind, StudyKind::Motion(_))
}

/// What the rows of a motion warn of, as the study that is run would; nothing where there are none.
pub(super) fn of_rows(bench: &Bench<'_>, motion: &Arc<Motion>) -> Vec<Diagnostic> {
    let (study, asked) = (bench.over.kind.along(), Asked::default());
    let by = abscissa(motion, &motion.design.parameters);
    let rows = rows_of(
        (bench, &bench.over.name),
        motion,
        study,
        (&asked, false),
        by,
    );
    rows.map_or_else(|_| Vec::new(), |rows| rows.told)
}

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

/// For each code in the notes of designs of a study of this name, of how many it is told, with the first of them; `values` are those of the
/// varied parameters of a design, SI.
pub(super) fn warned<'n>(
    (name, over): (&str, &OverStudy),
    bench: &Bench<'_>,
    notes: impl Iterator<Item = Option<&'n str>>,
    values: impl Fn(usize) -> Vec<f64>,
) -> Vec<Diagnostic> {
    let mut all: Vec<(&str, usize, usize, &str)> = Vec::new();
    let mut designs = 0;
    for note in notes {
        let told = note.iter().flat_map(|note| note.split(BEGINS).skip(1));
        for (code, text) in told.filter_map(|told| told.split_once(PARTS)) {
            let text = text.strip_suffix(NEXT).unwrap_or(text);
            match all.iter_mut().find(|it| it.0 == code) {
                Some(known) => known.1 += 1,
                None => all.push((code, 1, designs, text)),
            }
        }
        designs += 1;
    }
    let warning = |(code, count, first, text): (&str, usize, usize, &str)| {
        let are = match count {
            1 => "1 design is".to_owned(),
            _ => format!("{count} designs are"),
        };
        let number = first + 1;
        let message =
            format!("study `{name}`: {are} warned of `{code}`, first number {number}: {text}");
        Diagnostic::warning("designs-warned", message)
            .at(over.span.clone(), "")
            .note(format!("of {designs} designs; the notes tell which"))
            .help(format!(
                "run `{}` alone as that design: {}",
                over.name,
                bench.set(&values(first))
            ))
    };
    all.into_iter().map(warning).collect()
}
