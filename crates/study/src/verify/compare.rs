//! Running validation cases.

use std::sync::Arc;

use kempe_model::{Diagnostic, Model, NamedMeasure, StudyKind};
use kempe_motion::Motion;
use kempe_motion::events::EventKind;
use kempe_units::Dimension;
use serde::Serialize;

use super::case::{Case, Expected, Target};
use super::of_study::OfStudy;
use super::quantity::dimension_fits;
use crate::along::{Along, Row};
use crate::findings::check;
use crate::named::study_named;
use crate::pose::Setting;
use crate::prepared::{design, motion};
use crate::quantity::Quantity;
use crate::rows::RowPlace;
use crate::simulation::moved;
use kempe_motion::progress::Silent;

/// Ours and the reference, side by side.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// The case.
    pub case: String,
    /// What is compared: a measure, an event, a number of the check.
    pub what: String,
    /// Where; empty over the whole motion.
    pub place: String,
    /// Ours, in the reference's unit; NaN (null in JSON) when there is none.
    pub ours: f64,
    /// The reference as written.
    pub reference: String,
    /// The unit of both.
    pub unit: String,
    /// Ours less the reference.
    pub difference: f64,
    /// The difference that passes.
    pub allowed: f64,
    /// Whether it passes.
    pub passed: bool,
    /// Why there is no value of ours.
    pub problem: Option<String>,
    /// Where the reference comes from.
    pub source: String,
}

/// What a case needs of its model.
struct Subject<'m> {
    model: &'m Model,
    sampler: Along,
    motion: Arc<Motion>,
    /// Measures asked for, in the order of the sampler's.
    measures: Vec<String>,
}

/// Compares a case with its model, whose file says `text`. `files` gives the files that the model names.
///
/// # Errors
///
/// Diagnostics over the model file when the case cannot be run at all.
pub fn compare(
    case: &Case,
    text: &str,
    files: &mut dyn FnMut(&str) -> Result<String, String>,
) -> Result<Vec<Comparison>, Vec<Diagnostic>> {
    let model = Model::from_toml_with(text, &case.title, files, &case.set)?.model;
    let study = match &case.study {
        Some(name) => Some(study_named(&model, name).map_err(|unknown| vec![unknown])?),
        None => None,
    };
    if let Some(study) = study.filter(|s| !matches!(s.kind, StudyKind::Simulate(_))) {
        let study = OfStudy::new(&model, study)?;
        let compared = case.expected.iter().map(|expected| {
            let found = match &expected.target {
                Target::Measure { measure, at } => {
                    let place = at.as_deref().unwrap_or_default();
                    study.value(measure, place, &expected.reference.unit)
                }
                Target::Event(_) | Target::Check(_) => {
                    Err("a case of a study compares its columns and numbers alone".to_owned())
                }
            };
            compared(case, expected, found)
        });
        return Ok(compared.collect());
    }
    let mut measures: Vec<String> = Vec::new();
    for expected in &case.expected {
        if let Target::Measure { measure, .. } = &expected.target
            && !measures.contains(measure)
        {
            measures.push(measure.clone());
        }
    }
    let design = design(&model);
    let motion = match study.map(|study| (&study.name, &study.kind)) {
        Some((name, StudyKind::Simulate(study))) => {
            moved(&model, (name, study), false, &mut Silent)?.motion
        }
        _ => motion(&design, &mut Silent)?,
    };
    let named: Vec<NamedMeasure> = (measures.iter())
        .map(|text| model.measure(text))
        .collect::<Result<_, _>>()?;
    let named: Vec<&NamedMeasure> = named.iter().collect();
    let quantities: Vec<Quantity> = (named.iter().zip(&measures))
        .map(|(m, text)| Quantity {
            name: text.clone(),
            measure: m.measure.clone(),
            dimension: m.dimension,
        })
        .collect();
    let quantities: Vec<&Quantity> = quantities.iter().collect();
    let forces = named.iter().any(|m| m.needs_forces);
    let sampler = Along::new(&model, &motion, &quantities, forces)?;
    let mut subject = Subject {
        model: &model,
        sampler,
        motion,
        measures,
    };
    let mut last: Option<(String, Vec<f64>)> = None;
    Ok(case
        .expected
        .iter()
        .map(|expected| compare_one(case, expected, &mut subject, &named, &mut last))
        .collect())
}

fn compare_one(
    case: &Case,
    expected: &Expected,
    subject: &mut Subject<'_>,
    named: &[&NamedMeasure],
    last: &mut Option<(String, Vec<f64>)>,
) -> Comparison {
    let reference = &expected.reference;
    let found = match &expected.target {
        Target::Measure { at, measure } => {
            let place = at.clone().unwrap_or_default();
            let index = subject.measures.iter().position(|m| m == measure);
            match index.and_then(|i| Some((i, *named.get(i)?))) {
                Some((index, named)) => dimension_fits(named.dimension, &reference.unit)
                    .and_then(|()| measured(subject, &place, last))
                    .map(|values| {
                        let si = values.get(index).copied().unwrap_or(f64::NAN);
                        (reference.unit.from_si(si), named.dimension)
                    }),
                None => Err("the measure was not read".to_owned()),
            }
        }
        Target::Event(kind) => nearest_event(subject, kind, expected),
        Target::Check(field) => check_number(subject.model, field).map(|x| (x, Dimension::NONE)),
    };
    compared(case, expected, found)
}

/// Ours, in the reference's unit, beside the reference.
fn compared(
    case: &Case,
    expected: &Expected,
    found: Result<(f64, Dimension), String>,
) -> Comparison {
    let reference = &expected.reference;
    let (what, place) = match &expected.target {
        Target::Measure { at, measure } => (measure.clone(), at.clone().unwrap_or_default()),
        Target::Event(kind) => (kind.clone(), String::new()),
        Target::Check(field) => (format!("check: {field}"), String::new()),
    };
    let (ours, problem, turning) = match found {
        Ok((value, dimension)) => (value, None, dimension == Dimension::ANGLE),
        Err(why) => (f64::NAN, Some(why), false),
    };
    let turn = std::f64::consts::TAU / reference.unit.factor();
    let mut difference = ours - reference.value;
    if turning {
        difference -= (difference / turn).round() * turn;
    }
    Comparison {
        case: case.title.clone(),
        what,
        place,
        ours,
        reference: reference.text.clone(),
        unit: reference.unit.text().to_owned(),
        difference,
        allowed: expected.allowed,
        passed: difference.abs() <= expected.allowed,
        problem,
        source: expected.source.clone(),
    }
}

/// All measures at a place.
fn measured(
    subject: &mut Subject<'_>,
    place: &str,
    last: &mut Option<(String, Vec<f64>)>,
) -> Result<Vec<f64>, String> {
    if let Some((at, values)) = last
        && at == place
    {
        return Ok(values.clone());
    }
    let place_of_row = if place.is_empty() {
        RowPlace::Time(0.0)
    } else {
        let model = &subject.motion.mechanism().model;
        let setting = Setting::parse(model, place).map_err(|d| d.message)?;
        if setting.name == "time" {
            RowPlace::Time(setting.value)
        } else {
            let drive = subject.sampler.path_drive();
            let moving = drive.and_then(|d| subject.model.drives.get(d.index()));
            if moving.is_none_or(|d| d.name != setting.name) {
                return Err(format!(
                    "`{}` is not the only drive that moves",
                    setting.name
                ));
            }
            RowPlace::Drive(setting.value)
        }
    };
    let Row { sample, .. } = subject.sampler.row(place_of_row);
    if !sample.closure.is_finite() {
        return Err((sample.note).map_or_else(
            || "not reached".to_owned(),
            |note| note.text(subject.motion.mechanism()),
        ));
    }
    *last = Some((place.to_owned(), sample.values.clone()));
    Ok(sample.values)
}

fn nearest_event(
    subject: &Subject<'_>,
    kind: &str,
    expected: &Expected,
) -> Result<(f64, Dimension), String> {
    let wanted = if kind == "limit" {
        EventKind::Limit
    } else {
        EventKind::ChangePoint
    };
    let unit = &expected.reference.unit;
    let mut at: Vec<f64> = subject
        .motion
        .events
        .iter()
        .filter(|e| e.kind == wanted)
        .map(|e| unit.from_si(e.at))
        .collect();
    if at.is_empty() {
        // A limit may lie beyond what the file demands.
        let report = check(subject.model);
        if let (EventKind::Limit, Some((low, high))) = (wanted, report.reach_si) {
            at = vec![unit.from_si(low), unit.from_si(high)];
        }
    }
    let gap = |x: &f64| (x - expected.reference.value).abs();
    at.into_iter()
        .min_by(|a, b| gap(a).total_cmp(&gap(b)))
        .map(|x| (x, Dimension::NONE))
        .ok_or_else(|| format!("the motion meets no {kind}"))
}

fn check_number(model: &Model, field: &str) -> Result<f64, String> {
    let report = serde_json::to_value(check(model)).unwrap_or_default();
    let value = report
        .get(field)
        .ok_or_else(|| format!("the check has no `{field}`"))?;
    match value {
        serde_json::Value::Array(list) => Ok(list.len() as f64),
        value => value
            .as_f64()
            .ok_or_else(|| format!("`{field}` is no number")),
    }
}
