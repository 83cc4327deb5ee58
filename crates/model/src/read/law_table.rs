//! `law = { table = "measured.csv", time = "t", value = "angle" }`: measured points from a file beside the model.

use kempe_units::{Dimension, Expr};

use crate::drive::{Law, LawPiece};
use crate::ids::Span;
use crate::read::context::Context;
use crate::read::csv::{Ask, Pick, Words, columns};
use crate::read::entry::Entry;
use crate::spline::moments;

const WORDS: Words = Words {
    not_rising: Some("its time is not later than that of the row before"),
    least: 2,
    order: "rows are numbers in order of increasing time",
    few: "a motion needs at least two rows",
};

/// Reads a table law.
pub(crate) fn read_table(
    cx: &mut Context<'_>,
    table: &Entry<'_>,
    dimension: Dimension,
) -> Option<Law> {
    let file = table.required_like(cx, "table", table.example_of("table"))?;
    let mut column = |key: &str, default: &str, dimension: Dimension| {
        let (pick, span) = column_name(cx, table, key)?
            .unwrap_or_else(|| (Pick::Name(default.to_owned()), file.span.clone()));
        Some(Ask {
            pick,
            span,
            dimension,
        })
    };
    let time = column("time", "t", Dimension::TIME);
    let value = column("value", "value", dimension);
    let (mut times, values) = columns(cx, file, [&time?, &value?], &WORDS)?;
    // the motion starts with the table
    let start = times.first().copied().unwrap_or(0.0);
    for t in &mut times {
        *t -= start;
    }
    let from = Expr::Const(values.first().copied().unwrap_or(0.0));
    let moments = moments(&times, &values);
    Some(Law {
        pieces: vec![LawPiece::Table {
            times,
            values,
            moments,
        }],
        from,
    })
}

/// The column that a key names; `Some(None)` without the key.
pub(crate) fn column_name(
    cx: &mut Context<'_>,
    table: &Entry<'_>,
    key: &str,
) -> Option<Option<(Pick, Span)>> {
    let Some(node) = table.get(key) else {
        return Some(None);
    };
    let text = table.text(cx, key, node)?;
    Some(Some((
        Pick::Name(text.content.trim().to_owned()),
        node.span.clone(),
    )))
}
