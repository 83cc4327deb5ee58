//! A comparison as CSV and JSON.

use serde_json::{Value, json};

use super::csv::{push_number, quoted};
use super::json::infinite;
use crate::comparison::{Axis, Comparison, Pair, StudyPair};

/// The heads of the CSV table.
const HEADS: [&str; 15] = [
    "study",
    "kind",
    "name",
    "unit",
    "this",
    "against",
    "difference",
    "difference_percent",
    "this_along",
    "this_at",
    "this_at_unit",
    "against_along",
    "against_at",
    "against_at_unit",
    "note",
];

/// A comparison as CSV text: a line for each parameter that differs, each number over the motion and each smallest and largest
/// value, those that are equal too. Numbers have 17 significant digits; what is not known is empty.
pub fn csv(comparison: &Comparison) -> String {
    let mut out = HEADS.join(",") + "\n";
    for pair in &comparison.parameters {
        push_pair(&mut out, None, pair);
    }
    for study in &comparison.studies {
        if !study.note.is_empty() {
            let mut fields = vec![String::new(); HEADS.len()];
            fields[0] = study.name.clone();
            fields[HEADS.len() - 1] = study.note.clone();
            push_fields(&mut out, &fields);
        }
        for pair in &study.pairs {
            push_pair(&mut out, Some(study), pair);
        }
    }
    out
}

fn push_pair(out: &mut String, study: Option<&StudyPair>, pair: &Pair) {
    let number = |value: Option<f64>| {
        let mut text = String::new();
        push_number(&mut text, value.unwrap_or(f64::NAN));
        text
    };
    let mut fields = vec![
        study.map_or_else(String::new, |s| s.name.clone()),
        pair.kind.name().to_owned(),
        pair.name.clone(),
        or_one(pair.unit.text()).to_owned(),
        number(pair.values[0]),
        number(pair.values[1]),
        number(pair.difference()),
        number(pair.relative().map(|r| 100.0 * r)),
    ];
    for k in 0..2 {
        let place = pair.places[k].zip(study.and_then(|s| s.along[k].as_ref()));
        fields.extend(match place {
            Some((at, Axis { name, unit })) => [
                name.clone(),
                number(Some(at)),
                or_one(unit.text()).to_owned(),
            ],
            None => [String::new(), String::new(), String::new()],
        });
    }
    fields.push(pair.note.clone());
    push_fields(out, &fields);
}

fn push_fields(out: &mut String, fields: &[String]) {
    let fields: Vec<String> = fields.iter().map(|f| quoted(f)).collect();
    out.push_str(&fields.join(","));
    out.push('\n');
}

/// Plain numbers have the unit 1, as in tables.
fn or_one(unit: &str) -> &str {
    match unit {
        "" => "1",
        unit => unit,
    }
}

/// A comparison as data.
pub fn json(comparison: &Comparison) -> Value {
    json!({
        "this": comparison.this,
        "against": comparison.against,
        "differs": comparison.differs(),
        "parameters": comparison.parameters.iter().map(pair_json).collect::<Vec<_>>(),
        "studies": comparison.studies.iter().map(study_json).collect::<Vec<_>>(),
    })
}

fn study_json(study: &StudyPair) -> Value {
    let rows = |k: usize| study.rows[k].map(|(all, _)| all);
    let missed = |k: usize| study.rows[k].map(|(_, missed)| missed);
    let along = |k: usize| {
        let axis = study.along[k].as_ref();
        axis.map(|axis| json!({ "name": axis.name, "unit": axis.unit.text() }))
    };
    json!({
        "study": study.name,
        "note": study.note,
        "rows": { "this": rows(0), "against": rows(1) },
        "rows_not_reached": { "this": missed(0), "against": missed(1) },
        "along": { "this": along(0), "against": along(1) },
        "values": study.pairs.iter().map(pair_json).collect::<Vec<_>>(),
    })
}

fn pair_json(pair: &Pair) -> Value {
    let mut out = json!({
        "kind": pair.kind.name(),
        "name": pair.name,
        "unit": pair.unit.text(),
        "this": pair.values[0],
        "against": pair.values[1],
        "difference": pair.difference(),
        "relative": pair.relative(),
        "differs": pair.differs(),
        "this_at": pair.places[0],
        "against_at": pair.places[1],
        "note": pair.note,
    });
    for (name, value) in ["this", "against"].into_iter().zip(pair.values) {
        if let Some(sign) = value.and_then(infinite) {
            out["infinite"][name] = sign;
        }
    }
    out
}
