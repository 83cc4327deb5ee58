//! Everything about a model and its studies as one HTML report.

use kempe_draw::report::{Block, Report, Section};
use kempe_model::{Diagnostic, Model, Study, StudyKind};

use crate::designs::listed;
use crate::findings::Report as CheckReport;
use crate::findings_text::warnings_section;
use crate::parameters_section::parameters_section;
use crate::report_against::{findings_of_other, other_source};
use crate::report_designs::{
    designs_section, front_report, histograms_section, moving_designs, planes_section,
};
use crate::report_motion::motion;
use crate::report_origin::{ReportAgainst, ReportOrigin};
use crate::report_shapes::mode_shapes;
use crate::result::{Listing, StudyOutcome, StudyResult};
use crate::unit::SHORT_DIGITS;

/// So many of the first designs of a sweep stand in the page, and of the rest so many of which there is something to say.
const DESIGNS: [usize; 2] = [400, 99];

/// The report of a model, with another design beside it where one is given. `warnings` are those of reading the file.
pub fn report(
    model: &Model,
    origin: &ReportOrigin<'_>,
    warnings: &[Diagnostic],
    check: &CheckReport,
    studies: &[StudyOutcome<'_>],
    against: Option<&ReportAgainst<'_>>,
) -> Report {
    let results = studies.iter();
    let results = results.filter_map(|s| Some((s.study, s.result.as_ref().ok()?)));
    let mut sections: Vec<Section> = against.map_or_else(Vec::new, |a| a.comparison.sections());
    sections.extend(results.flat_map(|(study, r)| {
        let found = designs_section(r).into_iter();
        let found = found.chain(planes_section(model, r));
        let found = found.chain(histograms_section(model, r));
        found.chain(values_section(r)).chain(listings(study, r))
    }));
    sections.extend(parameters_section(model, origin));
    sections.extend(check.sections());
    let mut findings: Vec<Diagnostic> = warnings.to_vec();
    let others = against.map_or_else(Vec::new, findings_of_other);
    let more = studies.iter().flat_map(StudyOutcome::diagnostics);
    for diagnostic in check.diagnostics.iter().chain(more).chain(&others) {
        if findings
            .iter()
            .all(|d| d.code != diagnostic.code || d.message != diagnostic.message)
        {
            findings.push(diagnostic.clone());
        }
    }
    let motions = studies.iter().flat_map(|outcome| {
        let study = outcome.study.kind.along();
        match &outcome.result {
            // no linkage was accepted, say
            Ok(result) if result.table.rows() == 0 => Vec::new(),
            Ok(result) if result.frames.is_empty() && is_of_designs(outcome.study, result) => {
                moving_designs(result)
            }
            Ok(result) if result.shapes.is_empty() => vec![motion(model, study, result, against)],
            Ok(result) => mode_shapes(model, study, result),
            Err(_) => Vec::new(),
        }
    });
    let fronts = studies.iter().filter_map(|s| s.result.as_ref().ok());
    Report {
        title: model.title.clone(),
        file_name: origin.file_name.to_owned(),
        fronts: fronts.filter_map(front_report).collect(),
        motions: motions.collect(),
        first: warnings_section(&findings).into_iter().collect(),
        sections,
        source: origin.text.replace("\r\n", "\n"),
        other_source: against.and_then(|a| other_source(origin, a.origin)),
        generator: origin.generator.to_owned(),
        date: origin.date.to_owned(),
    }
}

/// Whether a study has no motion of its own: it found designs, or ran another study for them.
fn is_of_designs(study: &Study, result: &StudyResult) -> bool {
    !result.designs.is_empty() || matches!(study.kind, StudyKind::Sweep(_))
}

/// The numbers over the whole motion of a study, if it has any.
fn values_section(result: &StudyResult) -> Option<Section> {
    (!result.scalars.is_empty()).then(|| Section {
        title: format!("Values over {}", result.name),
        blocks: vec![Block::Facts(scalar_facts(result))],
    })
}

/// What a study tells in words; of designs of a sweep more than there is room for elsewhere.
fn listings(study: &Study, result: &StudyResult) -> Vec<Section> {
    let mut all = result.listings.clone();
    if let (StudyKind::Sweep(_), Some(designs)) = (&study.kind, all.first_mut()) {
        *designs = listed(&result.table, designs.title.clone(), DESIGNS);
    }
    let section = |listing: Listing| Section {
        title: format!("{}: {}", result.name, listing.title),
        blocks: vec![if listing.head.is_empty() {
            Block::List(listing.rows.iter().map(|r| r.join("  ")).collect())
        } else {
            Block::Table {
                head: listing.head,
                rows: listing.rows,
            }
        }],
    };
    all.into_iter().map(section).collect()
}

fn scalar_facts(result: &StudyResult) -> Vec<(String, String)> {
    let fact = |s: &crate::result::Scalar| {
        let value = kempe_number::text::significant(s.value, SHORT_DIGITS);
        let text = format!("{value} {}", s.unit.text());
        (s.name.clone(), text.trim_end().to_owned())
    };
    result.scalars.iter().map(fact).collect()
}
