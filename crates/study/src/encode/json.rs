//! Results and diagnostics as JSON for scripts. What is not finite becomes null.

use kempe_model::Diagnostic;
use kempe_motion::events::EventKind;
use serde_json::{Value, json};

use crate::result::{Event, StudyResult};
use crate::table::{Column, Table};

/// A table: its columns with name, unit and values.
pub fn table(table: &Table) -> Value {
    let columns: Vec<Value> = table.with_evidence().iter().map(column).collect();
    json!({ "name": table.name, "rows": table.rows(), "columns": columns, "notes": table.notes })
}

fn column(column: &Column) -> Value {
    json!({ "name": column.name, "unit": column.unit.text(), "values": column.values })
}

/// A study's result without its poses. The table is left out unless asked for: it is in its own file.
pub fn result(result: &StudyResult, with_table: bool) -> Value {
    let scalars = result
        .scalars
        .iter()
        .map(|s| json!({ "name": s.name, "unit": s.unit.text(), "value": s.value }));
    let mut out = json!({
        "study": result.name,
        "rows": result.table.rows(),
        "rows_demanded": result.demanded_rows,
        "rows_not_reached": result.table.unreached(),
        "interrupted": result.interrupted(),
        "values": scalars.collect::<Vec<_>>(),
        "listings": result.listings.iter().map(|l| json!({ "title": l.title, "head": l.head, "rows": l.rows })).collect::<Vec<_>>(),
        "events": result.events.iter().map(event).collect::<Vec<_>>(),
        "assemblies": { "matching": result.assemblies.0, "other": result.assemblies.1 },
        "worst_closure": result.table.worst_closure(),
        "least_singular_value": result.table.least_singular_value(),
        "worst_route_difference": result.table.worst_route_difference().map(|(_, d)| d),
        "worst_condition": result.table.worst_condition().map(|(_, c)| c),
        "diagnostics": result.diagnostics.iter().map(diagnostic).collect::<Vec<_>>(),
    });
    if with_table {
        out["table"] = table(&result.table);
    }
    out
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
