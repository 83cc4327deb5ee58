//! What holds of the check and the studies of any text, with bounded work: for the test of mutants and for the fuzz target
//! `studies`.

use std::ops::ControlFlow;

use kempe_model::{Checked, Diagnostic, Model, Severity, Study};
use kempe_study::{Done, Progress, Stage, StudyResult, check_with_progress, encode, run};

/// Links, joints, drives, measures and actions that a model may have; what comes before the first word of progress grows
/// with them.
const MOST_PARTS: usize = 80;
/// Studies of one model that are run.
const MOST_STUDIES: usize = 2;

/// Stops work after it has told of its progress so many times.
struct Budget(usize);

impl Progress for Budget {
    fn reached(&mut self, _: Stage, _: Done) -> ControlFlow<()> {
        self.0 = self.0.saturating_sub(1);
        match self.0 {
            0 => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        }
    }
}

/// How far a text came.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reached {
    /// Whether it is a model.
    pub read: bool,
    /// Studies that gave a table.
    pub tables: usize,
    /// Rows of them that were reached.
    pub rows: usize,
}

/// Reads, checks and runs; panics where an answer is not sound. `budget` bounds the work of the check, and that of each
/// study, in words of progress.
pub fn check_and_run(
    data: &[u8],
    files: &mut dyn FnMut(&str) -> Result<String, String>,
    budget: usize,
) -> Reached {
    let Ok(Checked { model, .. }) = Model::from_bytes(data, "bounded", files, &[]) else {
        return Reached::default();
    };
    let mut reached = Reached {
        read: true,
        ..Reached::default()
    };
    if parts(&model) > MOST_PARTS {
        return reached;
    }
    let text = String::from_utf8_lossy(data);
    let report = check_with_progress(&model, &mut Budget(budget));
    sound(&report.diagnostics, &text);
    assert!(serde_json::to_string(&report).is_ok());
    for study in model.studies.iter().take(MOST_STUDIES) {
        match run(&model, study, &mut Budget(budget)) {
            Ok(result) => {
                sound(&result.diagnostics, &text);
                explained(&result, study);
                reached.tables += 1;
                reached.rows += result.table.rows() - result.table.unreached();
            }
            Err(found) => {
                assert!(found.iter().any(|d| d.severity == Severity::Error));
                sound(&found, &text);
            }
        }
    }
    reached
}

fn parts(model: &Model) -> usize {
    let actions = &model.actions;
    let acting = actions.loads.len() + actions.springs.len() + actions.dampers.len();
    model.links.len() + model.joints.len() + model.drives.len() + model.measures.len() + acting
}

/// Diagnostics lie in the text and can be shown.
fn sound(found: &[Diagnostic], text: &str) {
    for d in found {
        for label in d.labels.iter().filter(|l| l.source.is_none()) {
            assert!(text.get(label.span.clone()).is_some(), "{d:?}");
        }
        assert!(d.render_plain("bounded", text).contains(d.code));
    }
}

/// A table is whole, and what has no finite value in it is told of.
fn explained(result: &StudyResult, study: &Study) {
    let table = &result.table;
    let rows = table.rows();
    assert_eq!(encode::csv(table).lines().count(), rows + 1);
    let told_once = result.diagnostics.iter().any(|d| d.code == "no-value");
    for column in table.with_evidence() {
        assert_eq!(column.values.len(), rows, "{}", column.name);
        for (row, value) in column.values.iter().enumerate() {
            assert!(
                value.is_finite() || table.notes[row].is_some() || told_once,
                "`{}` is {value} in row {row} of `{}`, and nobody says why",
                column.name,
                study.name
            );
        }
    }
    for scalar in &result.scalars {
        assert!(
            scalar.value.is_finite() || !result.diagnostics.is_empty() || result.interrupted(),
            "`{}` is {} in `{}`, and nobody says why",
            scalar.name,
            scalar.value,
            study.name
        );
    }
}
