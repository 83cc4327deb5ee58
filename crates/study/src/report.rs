//! Everything about a model and its studies as one HTML report.

use kempe_draw::report::{
    Block, Check, Column as Shown, Event, Evidence, Happening, MotionReport, NotReached, Note,
    Report, Section,
};
use kempe_dynamics::note::{EQUILIBRIUM_LIMIT, ILL_CONDITIONED, ROUTES_AGREE};
use kempe_measure::CLOSURE_LIMIT;
use kempe_model::{Diagnostic, Model, MotionStudy, Study, StudyKind};

use crate::comparison::{Comparison, Design};
use crate::designs::listed;
use crate::figures::marker_kind;
use crate::figures_against::figures_against;
use crate::findings::Report as CheckReport;
use crate::findings_text::warnings_section;
use crate::force_notes::place;
use crate::parameters_section::parameters_section;
use crate::plotted::plotted;
use crate::point_vectors::point_vectors;
use crate::report_against::{beside, findings_of_other, other_source};
use crate::report_designs::{
    along_the_motion, designs_section, front_report, histograms_section, moving_designs,
    planes_section,
};
use crate::report_shapes::mode_shapes;
use crate::result::{Listing, StudyResult};
use crate::table::{Column, largest};
use crate::unit::{SHORT_DIGITS, number_text};
use crate::view::{drawing_frames, mechanism_view};

/// So many of the first designs of a sweep stand in the page, and of the rest so many of which there is something to say.
const DESIGNS: [usize; 2] = [400, 99];

/// A study with what became of it.
#[derive(Clone, Debug)]
pub struct StudyOutcome<'a> {
    /// The study.
    pub study: &'a Study,
    /// Its result, or why there is none.
    pub result: Result<StudyResult, Vec<Diagnostic>>,
}

impl StudyOutcome<'_> {
    /// What is told of it.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        match &self.result {
            Ok(result) => &result.diagnostics,
            Err(errors) => errors,
        }
    }
}

/// Where a report comes from.
#[derive(Clone, Copy, Debug, Default)]
pub struct ReportOrigin<'a> {
    /// The model file's name.
    pub file_name: &'a str,
    /// The model file's text.
    pub text: &'a str,
    /// Parameters that were given other values than the file's, with these values as written.
    pub set: &'a [(String, String)],
    /// The program's name and version.
    pub generator: &'a str,
    /// When it was written, for those who want it in the page; may be empty.
    pub date: &'a str,
}

impl ReportOrigin<'_> {
    /// What the design is called: `four-bar.toml with a=25mm`.
    pub fn design_name(&self) -> String {
        let set: Vec<String> = (self.set.iter())
            .map(|(name, value)| format!("{name}={value}"))
            .collect();
        match set.is_empty() {
            true => self.file_name.to_owned(),
            false => format!("{} with {}", self.file_name, set.join(", ")),
        }
    }
}

/// Another design to set beside that of a report.
#[derive(Clone, Copy, Debug)]
pub struct ReportAgainst<'a> {
    /// The other design.
    pub design: Design<'a>,
    /// Where it comes from.
    pub origin: &'a ReportOrigin<'a>,
    /// Warnings of reading its file.
    pub warnings: &'a [Diagnostic],
    /// Both beside each other.
    pub comparison: &'a Comparison,
}

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

pub(crate) fn shown(column: &Column) -> Shown {
    Shown::new(
        column.name.clone(),
        column.unit.text(),
        column.values.clone(),
    )
}

pub(crate) fn motion(
    model: &Model,
    study: &MotionStudy,
    result: &StudyResult,
    against: Option<&ReportAgainst<'_>>,
) -> MotionReport {
    let other = against.and_then(|a| Some((a, a.design.result(&result.name)?)));
    let more = plotted(model, result);
    let table = &result.table;
    let evidence_columns = table.evidence();
    let note = |(first, last, text): (usize, usize, &str)| Note {
        first,
        last,
        text: text.to_owned(),
    };
    MotionReport {
        name: result.name.clone(),
        summary: summary(result),
        view: mechanism_view(model, Some(study)),
        frames: drawing_frames(model, result),
        columns: table.columns.iter().map(shown).collect(),
        // The drive that is moved by hand in the page; where several move, the first. All others are read out.
        drive: result.along.max(1),
        against: other.map(|(a, other)| beside(a, result, &more, other)),
        more: more.iter().map(shown).collect(),
        tests: evidence_columns.iter().map(shown).collect(),
        notes: table.noted().into_iter().map(note).collect(),
        mark: String::new(),
        plots: match other {
            Some((a, other)) => figures_against(model, result, a.design.model, other),
            None => along_the_motion(model, result),
        }
        .into_iter()
        .map(|(_, plot)| plot)
        .collect(),
        vectors: point_vectors(model, result),
        events: result
            .events
            .iter()
            .map(|e| Event {
                row: e.row,
                place: e.place.clone(),
                label: e.label.clone(),
                kind: marker_kind(e.kind),
            })
            .collect(),
        happenings: happenings(result),
        evidence: evidence(result),
    }
}

/// What happened, at times as the table tells them.
fn happenings(result: &StudyResult) -> Vec<Happening> {
    let unit = result.table.columns.first().map(|time| &time.unit);
    let told = |it: &Happening| {
        let times = it.times.iter();
        let told = |t: f64| unit.map_or(t, |unit| unit.from_si(t));
        Happening {
            times: times.map(|ends| ends.map(told)).collect(),
            ..it.clone()
        }
    };
    result.happenings.iter().map(told).collect()
}

fn summary(result: &StudyResult) -> String {
    let mut text = match result.abscissa() {
        Some(x) => match (x.values.first(), x.values.last()) {
            (Some(a), Some(b)) => format!(
                "{} rows, {} from {} to {} {}",
                result.table.rows(),
                x.name,
                number_text(*a),
                number_text(*b),
                x.unit.text()
            ),
            _ => String::new(),
        },
        None => String::new(),
    };
    text = text.trim_end().to_owned();
    text.push('.');
    if let Some(how_far) = result.how_far() {
        text.push_str(&format!(" Stopped early: {how_far}."));
    }
    text
}

fn evidence(result: &StudyResult) -> Evidence {
    let table = &result.table;
    let unreached = table
        .noted()
        .into_iter()
        .filter(|(first, ..)| table.closure.get(*first).is_some_and(|c| !c.is_finite()));
    let (matching, other) = result.assemblies;
    let facts = vec![(
        "Assemblies where one was chosen".to_owned(),
        format!("{matching} as the file says, {other} more"),
    )];
    Evidence {
        residual: table
            .worst_closure()
            .is_finite()
            .then(|| (table.worst_closure(), CLOSURE_LIMIT)),
        singular_value: table
            .least_singular_value()
            .is_finite()
            .then(|| table.least_singular_value()),
        scaling: "lengths counted in mechanism sizes, angles in rad".to_owned(),
        not_reached: unreached
            .map(|(first, last, reason)| NotReached {
                first,
                last,
                reason: reason.to_owned(),
            })
            .collect(),
        facts,
        checks: force_checks(result),
    }
}

/// What the forces were held against.
fn force_checks(result: &StudyResult) -> Vec<Check> {
    let table = &result.table;
    let Some(forces) = &table.forces else {
        return Vec::new();
    };
    let check = |name: &str, values: &[f64], limit: f64, meaning: &str| {
        let (row, worst) = largest(values)?;
        let compared = if worst <= limit { "≤" } else { ">" };
        Some(Check::new(
            name,
            format!("{worst:.1e} {compared} {limit:.0e}"),
            place(table, result.along, row),
            meaning,
        ))
    };
    let checks = [
        check(
            "Two routes to the drives' forces",
            &forces.route_difference,
            ROUTES_AGREE,
            "virtual power and Newton-Euler, which share no formula, agree to this part of the terms",
        ),
        check(
            "Equilibrium of every body",
            &forces.residual,
            EQUILIBRIUM_LIMIT,
            "what is left of the worst body's equilibrium, in parts of its largest term",
        ),
        check(
            "Condition of the equations",
            &forces.condition,
            ILL_CONDITIONED,
            "how much rounding may grow; beyond the limit the pose is nearly singular and joint loads grow without bound",
        ),
    ];
    checks.into_iter().flatten().collect()
}
