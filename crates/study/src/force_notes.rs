//! What the rows of a study note about their forces, gathered into warnings: one for each kind, with where it is worst.

use kempe_dynamics::ForceNote;
use kempe_measure::measure::visit_leaves;
use kempe_mechanism::Mechanism;
use kempe_model::{Diagnostic, DriveId, ForceMeasure, Leaf, Measure};
use kempe_motion::events::EventKind;

use crate::quantity::Quantity;
use crate::result::{Event, Scalar};
use crate::table::Table;
use crate::unit::number_text;

/// Notes of all rows, one entry for each kind and drive.
#[derive(Debug, Default)]
pub(crate) struct ForceNotes {
    kinds: Vec<Kind>,
}

#[derive(Debug)]
struct Kind {
    code: &'static str,
    drive: Option<DriveId>,
    first: usize,
    last: usize,
    count: usize,
    worst: (usize, ForceNote),
}

impl ForceNotes {
    /// Adds the notes of a row.
    pub fn add(&mut self, row: usize, notes: Vec<ForceNote>) {
        for note in notes {
            // A drive that starts or stops is at rest for one row: no news.
            if note == ForceNote::AtRest {
                continue;
            }
            let (code, drive) = (note.code(), note.drive());
            let known = self.kinds.iter_mut();
            match known
                .into_iter()
                .find(|k| k.code == code && k.drive == drive)
            {
                Some(kind) => {
                    kind.last = row;
                    kind.count += 1;
                    if note.severity() > kind.worst.1.severity() {
                        kind.worst = (row, note);
                    }
                }
                None => self.kinds.push(Kind {
                    code,
                    drive,
                    first: row,
                    last: row,
                    count: 1,
                    worst: (row, note),
                }),
            }
        }
    }

    /// A warning for each kind; rows are told by their value in the column `along`.
    pub fn warnings(&self, mechanism: &Mechanism, table: &Table, along: usize) -> Vec<Diagnostic> {
        let warnings = self.kinds.iter().map(|kind| {
            let text = kind.worst.1.text(mechanism);
            let everywhere = kind.count == table.rows();
            let message = if everywhere && kind.worst.1.severity() == 0.0 {
                format!("study `{}`: {text}", table.name)
            } else {
                format!(
                    "study `{}`: {text}, at {}",
                    table.name,
                    place(table, along, kind.worst.0)
                )
            };
            let warning = Diagnostic::warning(kind.code, message).help(kind.worst.1.remedy());
            if kind.count == 1 {
                warning
            } else if everywhere {
                warning.note("in all rows")
            } else {
                warning.note(format!(
                    "in {} of {} rows, from {} to {}",
                    kind.count,
                    table.rows(),
                    place(table, along, kind.first),
                    place(table, along, kind.last)
                ))
            }
        });
        warnings.collect()
    }
}

impl ForceNotes {
    /// A warning for each kind that others do not have, with where it is worst, told by `place`.
    pub fn beside(
        &self,
        others: &Self,
        (study, mechanism): (&str, &Mechanism),
        place: impl Fn(usize) -> String,
    ) -> Vec<Diagnostic> {
        let told = |kind: &&Kind| {
            let mut known = others.kinds.iter();
            !known.any(|it| it.code == kind.code && it.drive == kind.drive)
        };
        let warnings = self.kinds.iter().filter(told).map(|kind| {
            let (row, note) = &kind.worst;
            let (text, at) = (note.text(mechanism), place(*row));
            let message = format!("study `{study}`: {text}, at {at}");
            Diagnostic::warning(kind.code, message).help(note.remedy())
        });
        warnings.collect()
    }
}

/// Where a row stands: `lift = 0.42 m`.
pub(crate) fn place(table: &Table, along: usize, row: usize) -> String {
    let Some(column) = table.columns.get(along) else {
        return format!("row {row}");
    };
    let at = column.values.get(row).copied().unwrap_or(f64::NAN);
    let digits = number_text(at);
    format!("{} = {digits} {}", column.name, column.unit.text())
        .trim_end()
        .to_owned()
}

/// Warnings of numbers over the motion that hold joint loads, where the motion meets a pose at which these grow without
/// bound: such a number tells how near that pose was looked at.
pub(crate) fn unbounded(
    mechanism: &Mechanism,
    (scalars, values): (&[Quantity], &[Scalar]),
    events: &[Event],
) -> Vec<Diagnostic> {
    let singular: Vec<&str> = (events.iter())
        .filter(|e| e.kind != EventKind::ModeChange)
        .map(|e| e.place.as_str())
        .collect();
    let Some(first) = singular.first() else {
        return Vec::new();
    };
    let holding = scalars
        .iter()
        .filter(|q| holds_joint_load(mechanism, &q.measure));
    let warnings = holding.map(|q| {
        Diagnostic::warning(
            "unbounded-load",
            format!(
                "`{}` is taken over a singular pose, at {first}: joint loads grow without bound towards it",
                q.name
            ),
        )
        .note(match values.iter().any(|it| it.name == q.name && it.value.is_finite()) {
            true => "its value tells how near that pose was looked at; the condition of every row stands in the table",
            false => "right at that pose it has none; the condition of every row stands in the table",
        })
        .help("ask for it over a motion that keeps away from that pose")
    });
    warnings.collect()
}

/// Whether a measure asks for what a joint carries, itself or by another measure.
fn holds_joint_load(mechanism: &Mechanism, measure: &Measure) -> bool {
    let mut found = false;
    visit_leaves(mechanism, measure, &mut |leaf| {
        found |= matches!(
            leaf,
            Leaf::Force(
                ForceMeasure::Reaction(_)
                    | ForceMeasure::ReactionX(_)
                    | ForceMeasure::ReactionY(_)
                    | ForceMeasure::ReactionAlong(_)
                    | ForceMeasure::ReactionAcross(_)
                    | ForceMeasure::ReactionMoment(_)
            )
        );
    });
    found
}
