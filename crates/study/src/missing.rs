//! Rows that were not reached and values that are not there, as warnings.

use kempe_measure::CLOSURE_LIMIT;
use kempe_model::Diagnostic;

use crate::force_notes::place;
use crate::sink::RowSink;
use crate::table::Table;

fn unreached_warning(name: &str, table: &Table) -> Diagnostic {
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

/// Rows that are missing, and rows whose loops do not close; `along` is the column that they run along.
pub(crate) fn row_warnings(name: &str, table: &Table, along: usize) -> Vec<Diagnostic> {
    let unreached = (table.unreached() > 0).then(|| unreached_warning(name, table));
    unreached
        .into_iter()
        .chain(open_warning(name, table, along))
        .collect()
}

/// Rows whose loops do not close as well as every row should.
pub(crate) fn open_warning(name: &str, table: &Table, along: usize) -> Option<Diagnostic> {
    let open: Vec<usize> = (0..table.rows())
        .filter(|row| table.closure.get(*row).is_some_and(|c| *c > CLOSURE_LIMIT))
        .collect();
    let first = *open.first()?;
    let message = format!(
        "{} of {} rows of study `{name}` do not close: up to {} of the mechanism's size is left open, first at {}",
        open.len(),
        table.rows(),
        kempe_number::text::significant(table.worst_closure(), 2),
        place(table, along, first)
    );
    Some(
        Diagnostic::warning("rows-open", message)
            .note(format!("a pose counts as closed up to {CLOSURE_LIMIT:e} of the mechanism's size"))
            .help("do not rely on these rows: start or stop the drive short of that place, or change a length a little"),
    )
}

/// Says what a circuit cannot tell.
fn timeless(diagnostic: Diagnostic) -> Diagnostic {
    diagnostic
        .note("time does not run along a circuit: speeds, means, time ratios and numbers over numbers over the motion have no value there")
        .help("ask for it in a study that runs by the drives' laws, without `circuit`")
}

/// Why a number over the motion, or a column in all rows, may have no value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lack {
    /// It has none somewhere.
    Somewhere,
    /// The motion is no cycle.
    Cycle,
    /// The drives go through a cycle, of which it has no value somewhere or does not come back.
    Return,
    /// Time does not run.
    Time,
}

/// Columns and numbers over the motion that have no value where the pose is known and no note says why. `why` tells it of the numbers
/// and, asked without an index, of columns without any value.
pub(crate) fn without_value(
    rows: &RowSink,
    along: usize,
    why: impl Fn(Option<usize>) -> Lack,
) -> Vec<Diagnostic> {
    let table = &rows.table;
    let silent = |row: usize| {
        table.closure.get(row).is_some_and(|c| c.is_finite())
            && table.notes.get(row).is_some_and(Option::is_none)
    };
    // A number over the motion that is a column too is told of once.
    let is_number = |name: &str| rows.scalars.iter().any(|s| s.name == name);
    let columns = table.columns.iter().filter(|c| !is_number(&c.name));
    let columns = columns.filter_map(|column| {
        let values = column.values.iter().enumerate();
        let missing: Vec<usize> = values
            .filter(|(row, value)| !value.is_finite() && silent(*row))
            .map(|(row, _)| row)
            .collect();
        let first = *missing.first()?;
        if column.values.iter().all(|x| x.is_nan()) && why(None) == Lack::Time {
            let text = format!(
                "study `{}`: `{}` has no value in any row",
                table.name, column.name
            );
            return Some(timeless(Diagnostic::warning("no-value", text)));
        }
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
        match why(Some(index)) {
            Lack::Cycle => diagnostic
                .note("a time ratio compares both strokes of a cycle, and this motion is none")
                .help("let the drives end where they started, or whole turns from there"),
            Lack::Return => diagnostic
                .note("a time ratio compares both strokes of a cycle: what it is taken of has no value somewhere, or is not at the end what it was at the start")
                .help("let the drives go as many turns as its cycle takes: behind gears that need not be one"),
            Lack::Time => timeless(diagnostic),
            Lack::Somewhere => {
                diagnostic.help("what it is taken of has none somewhere, or the place that it asks for is not on the motion")
            }
        }
    });
    let all_reached = table.unreached() == 0;
    columns.chain(numbers.filter(|_| all_reached)).collect()
}

/// A single pose whose loops do not close.
pub(crate) fn open_pose(label: &str, closure: f64) -> Diagnostic {
    let part = kempe_number::text::significant(closure, 2);
    let message =
        format!("{label}: the loops do not close: {part} of the mechanism's size is left open");
    Diagnostic::warning("rows-open", message)
        .note(format!("a pose counts as closed up to {CLOSURE_LIMIT:e} of the mechanism's size"))
        .help("do not rely on this pose: choose another place of the drive, or change a length a little")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_that_do_not_close_are_told() {
        let table = |closure: Vec<f64>| Table {
            name: "turn".to_owned(),
            columns: Vec::new(),
            places: 0,
            smallest_singular_value: vec![1.0; closure.len()],
            forces: None,
            balance: None,
            notes: vec![None; closure.len()],
            closure,
        };
        let told = |closure| {
            let found = row_warnings("turn", &table(closure), 0);
            found.iter().map(|d| d.message.clone()).collect::<Vec<_>>()
        };
        assert!(told(vec![1e-15, 9e-10]).is_empty());
        let found = told(vec![1e-15, 2e-7, 3e-8]);
        assert_eq!(
            found,
            [
                "2 of 3 rows of study `turn` do not close: up to 2e-7 of the mechanism's size is left open, first at row 1"
            ]
        );
    }
}
