//! What designs are warned of, as the study that is run would be alone: what their rows warn of, and of how many their notes tell it.

use std::sync::Arc;

use kempe_model::{Diagnostic, Model, OverStudy, StudyKind};
use kempe_motion::Motion;

use super::bench::Bench;
use super::notes::{BEGINS, NEXT, PARTS};
use super::rows::rows_of;
use crate::columns::Asked;
use crate::motion::abscissa;
use crate::slot_ends::has_ends;

/// Whether designs may be warned of anything: of forces, of pins that leave their slots, of how a simulation goes.
pub(super) fn may_warn(model: &Model, kind: &StudyKind) -> bool {
    match kind {
        StudyKind::Forces(_) | StudyKind::Simulate(_) => true,
        StudyKind::Motion(_) => has_ends(model),
        _ => false,
    }
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

/// What is told of some designs: for each code of how many, and what it says of the first of them.
#[derive(Debug, Default)]
pub(super) struct Tally(Vec<Counted>);

/// What is told of some designs under one code.
#[derive(Debug)]
pub(super) struct Counted {
    pub code: String,
    /// Of how many designs.
    pub count: usize,
    /// The first of them, from zero.
    pub first: usize,
    /// What it says there.
    pub text: String,
    last: usize,
}

impl Tally {
    /// Takes up what is told of a design; of one design a code counts once. Designs come in their order.
    pub fn take(&mut self, design: usize, code: &str, text: &str) {
        match self.0.iter_mut().find(|it| it.code == code) {
            Some(known) => {
                known.count += usize::from(known.last != design);
                known.last = design;
            }
            None => self.0.push(Counted {
                code: code.to_owned(),
                count: 1,
                first: design,
                text: text.to_owned(),
                last: design,
            }),
        }
    }

    /// By code, in the order in which they were told first.
    pub fn counted(self) -> Vec<Counted> {
        self.0
    }
}

/// For each code in the notes of the first designs of a study of this name, of so many, of how many it is told, with the first of them; `values` are
/// those of the varied parameters of a design, SI.
pub(super) fn warned<'n>(
    (name, over): (&str, &OverStudy),
    bench: &Bench<'_>,
    (notes, designs): (impl Iterator<Item = Option<&'n str>>, usize),
    values: impl Fn(usize) -> Vec<f64>,
) -> Vec<Diagnostic> {
    let (mut tally, mut looked_at) = (Tally::default(), 0);
    for note in notes {
        let told = note.iter().flat_map(|note| note.split(BEGINS).skip(1));
        for (code, text) in told.filter_map(|told| told.split_once(PARTS)) {
            tally.take(looked_at, code, text.strip_suffix(NEXT).unwrap_or(text));
        }
        looked_at += 1;
    }
    let of = match looked_at < designs {
        true => format!("of the first {looked_at} designs of {designs}"),
        false => format!("of {designs} designs"),
    };
    let warning = |it: Counted| {
        let are = match it.count {
            1 => "1 design is".to_owned(),
            count => format!("{count} designs are"),
        };
        let (code, number, text) = (&it.code, it.first + 1, &it.text);
        let message =
            format!("study `{name}`: {are} warned of `{code}`, first number {number}: {text}");
        Diagnostic::warning("designs-warned", message)
            .at(over.span.clone(), "")
            .note(format!("{of}; the notes tell which"))
            .help(format!(
                "run `{}` alone as that design: {}",
                over.name,
                bench.set(&values(it.first))
            ))
    };
    tally.counted().into_iter().map(warning).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two pins that leave their slots in one design are one design.
    #[test]
    fn designs_are_counted_not_warnings() {
        let mut tally = Tally::default();
        for (design, code, text) in [(1, "a", "x"), (1, "a", "y"), (1, "b", "z"), (4, "a", "w")] {
            tally.take(design, code, text);
        }
        let told = tally.counted().into_iter();
        let told: Vec<(String, usize, usize, String)> = told
            .map(|it| (it.code, it.count, it.first, it.text))
            .collect();
        let wanted = [("a", 2, 1, "x"), ("b", 1, 1, "z")];
        let wanted = wanted
            .map(|(code, count, first, text)| (code.to_owned(), count, first, text.to_owned()));
        assert_eq!(told, wanted);
    }
}
