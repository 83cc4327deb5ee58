//! A study in the report: its rows with the mechanism that moves through them, its plots, what it met, and its evidence.

use kempe_draw::plot::PlotSpec;
use kempe_draw::report::{
    Check, Column as Shown, Event, Evidence, Happening, MotionReport, NotReached, Note,
};
use kempe_dynamics::note::{EQUILIBRIUM_LIMIT, ILL_CONDITIONED, ROUTES_AGREE};
use kempe_measure::CLOSURE_LIMIT;
use kempe_model::{Model, MotionStudy};

use crate::figures::{chosen, figures, marker_kind};
use crate::figures_against::figures_against;
use crate::force_notes::place;
use crate::plotted::plotted;
use crate::point_vectors::point_vectors;
use crate::report_against::beside;
use crate::report_origin::ReportAgainst;
use crate::result::{Figure, StudyResult};
use crate::table::{Column, largest};
use crate::unit::number_text;
use crate::view::{drawing_frames, mechanism_view};

/// A column as the page has it.
pub(crate) fn shown(column: &Column) -> Shown {
    Shown::new(
        column.name.clone(),
        column.unit.text(),
        column.values.clone(),
    )
}

/// A study with its rows, and another design's beside it where one is given.
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

/// The plots of a study but for how often numbers have their values, which no place of the motion has.
fn along_the_motion(model: &Model, result: &StudyResult) -> Vec<(String, PlotSpec)> {
    let shown = chosen(model, result);
    let plots = figures(model, result).into_iter().zip(&shown);
    let along = plots.filter(|(_, figure)| !matches!(figure, Figure::Histogram { .. }));
    along.map(|(plot, _)| plot).collect()
}
