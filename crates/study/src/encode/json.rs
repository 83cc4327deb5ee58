//! Results and diagnostics as JSON for scripts. What has no value is null; so is what is infinite, with its sign beside it,
//! because JSON has no word for it.

use kempe_model::Diagnostic;
use kempe_motion::events::EventKind;
use serde_json::{Value, json};

use crate::result::{ContactMet, Event, FoundDesign, Scalar, StudyResult};
use crate::table::{Column, Table};

/// A table: its columns with name, unit and values.
pub fn table(table: &Table) -> Value {
    let columns: Vec<Value> = table.with_evidence().iter().map(column).collect();
    json!({ "name": table.name, "rows": table.rows(), "columns": columns, "notes": table.notes })
}

fn column(column: &Column) -> Value {
    let mut out =
        json!({ "name": column.name, "unit": column.unit.text(), "values": column.values });
    let rows = column.values.iter().enumerate();
    let infinite = rows.filter_map(|(row, value)| Some((row.to_string(), infinite(*value)?)));
    let infinite: serde_json::Map<String, Value> = infinite.collect();
    if !infinite.is_empty() {
        out["infinite"] = infinite.into();
    }
    out
}

fn scalar(scalar: &Scalar) -> Value {
    let mut out = json!({ "name": scalar.name, "unit": scalar.unit.text(), "value": scalar.value });
    if let Some(sign) = infinite(scalar.value) {
        out["infinite"] = sign;
    }
    out
}

/// The sign of what is infinite: 1 or -1.
pub(super) fn infinite(value: f64) -> Option<Value> {
    value.is_infinite().then(|| (value.signum() as i8).into())
}

/// A study's result without its poses. The table is left out unless asked for: it is in its own file.
pub fn result(result: &StudyResult, with_table: bool) -> Value {
    let mut out = json!({
        "study": result.name,
        "rows": result.table.rows(),
        "rows_demanded": result.demanded_rows,
        "rows_not_reached": result.table.unreached(),
        "interrupted": result.interrupted(),
        "how_far": result.how_far(),
        "values": result.scalars.iter().map(scalar).collect::<Vec<_>>(),
        "listings": result.listings.iter().map(|l| json!({ "title": l.title, "head": l.head, "rows": l.rows })).collect::<Vec<_>>(),
        "events": result.events.iter().map(event).collect::<Vec<_>>(),
        "assemblies": { "matching": result.assemblies.0, "other": result.assemblies.1 },
        "worst_closure": result.table.worst_closure(),
        "least_singular_value": result.table.least_singular_value(),
        "worst_route_difference": result.table.worst_route_difference().map(|(_, d)| d),
        "worst_condition": result.table.worst_condition().map(|(_, c)| c),
        "diagnostics": result.diagnostics.iter().map(diagnostic).collect::<Vec<_>>(),
    });
    if !result.contacts.is_empty() {
        out["contacts"] = result.contacts.iter().map(contact).collect();
    }
    if !result.designs.is_empty() {
        out["designs"] = result.designs.iter().map(design).collect();
    }
    if with_table {
        out["table"] = table(&result.table);
    }
    out
}

/// A contact in a joint with play. What no contact has that takes no time is null, and so is the speed after one that lasts.
fn contact(contact: &ContactMet) -> Value {
    let touch = contact.touch;
    json!({
        "joint": contact.joint,
        "place": contact.place,
        "time_si": contact.time,
        "speed_si": contact.speed,
        "speed_after_si": contact.speed_after,
        "until_si": touch.map(|it| it.until),
        "force_si": touch.map(|it| it.force),
        "depth_si": touch.map(|it| it.depth),
    })
}

/// A mechanism that was found, with its file.
fn design(design: &FoundDesign) -> Value {
    json!({ "name": design.name, "title": design.title, "model": design.file.toml })
}

fn event(event: &Event) -> Value {
    let kind = match event.kind {
        EventKind::Limit => "limit",
        EventKind::ChangePoint => "change-point",
        EventKind::ModeChange => "mode-change",
    };
    json!({ "kind": kind, "at_si": event.at, "place": event.place, "row": event.row })
}

/// A diagnostic with its spans in bytes of the model file.
pub fn diagnostic(diagnostic: &Diagnostic) -> Value {
    serde_json::to_value(diagnostic).unwrap_or(Value::Null)
}

#[cfg(test)]
mod tests {
    use super::*;
    use kempe_units::Unit;

    #[test]
    fn what_is_infinite_is_told_from_what_has_no_value() {
        let unit = Unit::parse("mm").unwrap();
        let mut c = Column::new("x", unit.clone());
        c.values = vec![1.0, f64::NEG_INFINITY, f64::NAN, f64::INFINITY];
        let found = column(&c);
        assert_eq!(found["values"], json!([1.0, null, null, null]));
        assert_eq!(found["infinite"], json!({ "1": -1, "3": 1 }));
        let number = |value| {
            scalar(&Scalar {
                name: "peak".to_owned(),
                unit: unit.clone(),
                value,
            })
        };
        assert_eq!(number(f64::INFINITY)["infinite"], json!(1));
        assert_eq!(number(f64::NAN).get("infinite"), None);
        assert_eq!(
            number(2.0),
            json!({ "name": "peak", "unit": "mm", "value": 2.0 })
        );
    }
}
