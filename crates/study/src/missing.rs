//! Rows that were not reached and values that are not there, as warnings.

use kempe_model::Diagnostic;

use crate::force_notes::place;
use crate::sink::RowSink;
use crate::table::Table;

pub(crate) fn unreached_warning(name: &str, table: &Table) -> Diagnostic {
    let reason = table.notes.iter().zip(&table.closure);
    let reason = reason
        .filter(|(_, closure)| !closure.is_finite())
        .find_map(|(note, _)| note.as_deref())
        .unwrap_or("no pose was found");
    Diagnostic::warning(
        "rows-not-reached",
        format!(
            "{} of {} rows of study `{name}` could not be reached: {reason}",
            table.unreached(),
            table.rows()
        ),
    )
    .help("the column `note` says why, row by row")
}

/// Columns and numbers over the motion that have no value where the pose is known and no note says why. `lacks_cycle` tells
/// of which numbers that is because the motion is no cycle.
pub(crate) fn without_value(
    rows: &RowSink,
    along: usize,
    lacks_cycle: impl Fn(usize) -> bool,
) -> Vec<Diagnostic> {
    let table = &rows.table;
    let silent = |row: usize| {
        table.closure.get(row).is_some_and(|c| c.is_finite())
            && table.notes.get(row).is_some_and(Option::is_none)
    };
    let columns = table.columns.iter().filter_map(|column| {
        let values = column.values.iter().enumerate();
        let missing: Vec<usize> = values
            .filter(|(row, value)| !value.is_finite() && silent(*row))
            .map(|(row, _)| row)
            .collect();
        let first = *missing.first()?;
        Some(
            Diagnostic::warning(
                "no-value",
                format!(
                    "study `{}`: `{}` has no finite value in {} of {} rows, first at {}",
                    table.name,
                    column.name,
                    missing.len(),
                    table.rows(),
                    place(table, along, first)
                ),
            )
            .help("a quotient by zero, or a root, logarithm or arc of a number outside its range"),
        )
    });
    let numbers = rows.scalars.iter().enumerate();
    let numbers = numbers.filter(|(_, s)| s.value.is_nan());
    let numbers = numbers.map(|(index, scalar)| {
        let diagnostic = Diagnostic::warning(
            "no-value",
            format!("study `{}`: `{}` has no finite value", table.name, scalar.name),
        );
        if lacks_cycle(index) {
            return diagnostic
                .note("a time ratio compares both strokes of a cycle, and this motion is none")
                .help("let the drives end where they started, or whole turns from there");
        }
        diagnostic.help("what it is taken of has none somewhere, or the place that it asks for is not on the motion")
    });
    let all_reached = table.unreached() == 0;
    columns.chain(numbers.filter(|_| all_reached)).collect()
}
