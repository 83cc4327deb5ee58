//! Another design in the report of a run: its poses and values at this one's rows, its warnings, its file.

use kempe_draw::report::Against;
use kempe_draw::{Frame as DrawnFrame, MechanismView};
use kempe_model::{Diagnostic, Model, Source};

use crate::comparison::Matched;
use crate::figures_against::{converted_all, quantity};
use crate::plotted::plotted;
use crate::report_origin::{ReportAgainst, ReportOrigin};
use crate::result::{Frame, StudyResult};
use crate::table::Column;
use crate::view::{drawn, mechanism_view};

/// A diagnostic of the other one of two designs: it says so, and its places name the file that they are in.
pub fn of_other_design(diagnostic: &Diagnostic, origin: &ReportOrigin<'_>) -> Diagnostic {
    let mut it = diagnostic.clone();
    for label in &mut it.labels {
        match &mut label.source {
            // What the reader calls a given value is given by another option.
            Some(source) => source.name = source.name.replace("--set", "--against-set"),
            source => {
                *source = Some(Source {
                    name: origin.file_name.to_owned(),
                    text: origin.text.to_owned(),
                });
            }
        }
    }
    it.note(format!("of the other design, {}", origin.design_name()))
}

/// What is told of the other design.
pub(crate) fn findings_of_other(against: &ReportAgainst<'_>) -> Vec<Diagnostic> {
    let run = against.design.outcomes.iter().flat_map(|o| o.diagnostics());
    let all = against.warnings.iter().chain(run);
    all.map(|d| of_other_design(d, against.origin)).collect()
}

/// Name and text of the other design's file, where that is another text.
pub(crate) fn other_source(
    this: &ReportOrigin<'_>,
    other: &ReportOrigin<'_>,
) -> Option<(String, String)> {
    let text = other.text.replace("\r\n", "\n");
    (this.text != other.text).then(|| (other.file_name.to_owned(), text))
}

/// What is drawn of another design over this one: its mechanism, and its pose at each row of this one's result; a pose without
/// points where it has none.
pub fn outline(
    result: &StudyResult,
    model: &Model,
    other: &StudyResult,
) -> (MechanismView, Vec<DrawnFrame>) {
    let study = model.studies.iter().find(|s| s.name == other.name);
    let frame = |pose: Option<&Frame>| match pose {
        Some(pose) => drawn(model, pose, String::new()),
        None => DrawnFrame::default(),
    };
    let matched = Matched::of(result, other);
    let frames = matched.frames(&other.frames).into_iter().map(frame);
    (
        mechanism_view(model, study.map(|s| s.kind.along())),
        frames.collect(),
    )
}

/// The other design at the rows of this one. `more` is what this one plots besides its table.
pub(crate) fn beside(
    against: &ReportAgainst<'_>,
    result: &StudyResult,
    more: &[Column],
    other: &StudyResult,
) -> Against {
    let (design, matched) = (against.design, Matched::of(result, other));
    let plotted_there = plotted(design.model, other);
    let evidence = [result.table.evidence(), other.table.evidence()];
    let twin = |column: &Column| {
        let plain = quantity(other, &column.name);
        let other = plain
            .or_else(|| plotted_there.iter().find(|c| c.name == column.name))
            .or_else(|| evidence[1].iter().find(|c| c.name == column.name))?;
        let same = other.unit.dimension() == column.unit.dimension();
        same.then(|| matched.values(&converted_all(&other.values, &other.unit, &column.unit)))
    };
    let columns = result.table.columns.iter().chain(more);
    let (view, frames) = outline(result, design.model, other);
    Against {
        name: design.name.to_owned(),
        matched: matched.told(other),
        view,
        frames,
        values: columns.chain(&evidence[0]).map(twin).collect(),
    }
}
