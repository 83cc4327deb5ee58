//! `law = { table = "measured.csv", time = "t", value = "angle" }`: measured points from a file beside the model.

use kempe_units::{Dimension, Expr, Unit, nearest};

use crate::diagnostic::Diagnostic;
use crate::document::Table;
use crate::model::{Law, LawPiece, Span};
use crate::read::context::Context;
use crate::spline::moments;

/// Keys of a table law.
pub(crate) const TABLE_KEYS: &[&str] = &["table", "time", "value"];

/// A table has at most so many rows.
const MAX_ROWS: usize = 1_000_000;

/// Reads a table law.
pub(crate) fn read_table(
    cx: &mut Context<'_>,
    table: &Table,
    place: &str,
    span: &Span,
    dimension: Dimension,
) -> Option<Law> {
    cx.unknown_keys(table, &format!("the table law of {place}"), TABLE_KEYS);
    let file = cx.required(table, "table", place, span, "\"measured.csv\"")?;
    let file_text = cx.text(file, "`table`", "\"measured.csv\"")?;
    let name = file_text.content.clone();
    let mut column = |key: &str, default: &str| -> Option<(String, Span)> {
        match table.get(key) {
            None => Some((default.to_owned(), file.span.clone())),
            Some(node) => Some((
                cx.text(node, &format!("`{key}`"), "\"t\"")?
                    .content
                    .trim()
                    .to_owned(),
                node.span.clone(),
            )),
        }
    };
    let time = column("time", "t");
    let value = column("value", "value");
    let ((time, time_span), (value, value_span)) = (time?, value?);
    let content = match (cx.files)(&name) {
        Ok(content) => content,
        Err(reason) => {
            cx.push(
                Diagnostic::error(
                    "table-unreadable",
                    format!("cannot read `{name}`: {reason}"),
                )
                .at(file.span.clone(), "")
                .help("the name counts from the folder of the model file"),
            );
            return None;
        }
    };
    let mut lines = content
        .lines()
        .enumerate()
        .filter(|(_, l)| !l.trim().is_empty() && !l.starts_with('#'));
    let header = lines
        .next()
        .map_or("", |(_, line)| line.trim_start_matches('\u{feff}'));
    let separator = [';', '\t', ',']
        .into_iter()
        .find(|c| header.contains(*c))
        .unwrap_or(',');
    let heads: Vec<&str> = header.split(separator).map(unquoted).collect();
    let time = find_column(cx, &heads, &time, &name, time_span, Dimension::TIME);
    let value = find_column(cx, &heads, &value, &name, value_span, dimension);
    let ((time, time_unit), (value, value_unit)) = (time?, value?);
    let (mut times, mut values) = (Vec::new(), Vec::new());
    for (number, line) in lines {
        let cells: Vec<&str> = line.split(separator).map(unquoted).collect();
        let cell = |i: usize| {
            cells
                .get(i)
                .and_then(|c| c.parse::<f64>().ok())
                .filter(|x| x.is_finite())
        };
        let trouble = match (cell(time), cell(value)) {
            (Some(t), Some(x)) => {
                let t = time_unit.to_si(t);
                if times.last().is_none_or(|last| t > *last) && times.len() < MAX_ROWS {
                    times.push(t);
                    values.push(value_unit.to_si(x));
                    continue;
                }
                if times.len() >= MAX_ROWS {
                    "one row too many"
                } else {
                    "its time is not later than that of the row before"
                }
            }
            _ => "a cell is not a number",
        };
        cx.push(
            Diagnostic::error(
                "table-values",
                format!("`{name}`, line {}: {trouble}", number + 1),
            )
            .at(file.span.clone(), "")
            .note(format!(
                "the line is: {}",
                line.chars().take(80).collect::<String>()
            ))
            .help(format!(
                "rows are numbers in order of increasing time, at most {MAX_ROWS} of them"
            )),
        );
        return None;
    }
    if times.len() < 2 {
        cx.push(
            Diagnostic::error(
                "table-values",
                format!("`{name}` has {} rows of data", times.len()),
            )
            .at(file.span.clone(), "")
            .help("a motion needs at least two rows"),
        );
        return None;
    }
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

fn unquoted(cell: &str) -> &str {
    let cell = cell.trim();
    cell.strip_prefix('"')
        .and_then(|c| c.strip_suffix('"'))
        .unwrap_or(cell)
        .trim()
}

/// The column of a name, with the unit in its head: `angle [deg]`, or the file's unit.
fn find_column(
    cx: &mut Context<'_>,
    heads: &[&str],
    name: &str,
    file: &str,
    span: Span,
    dimension: Dimension,
) -> Option<(usize, Unit)> {
    let split = |head: &str| match head.split_once('[') {
        Some((name, unit)) => (
            name.trim().to_owned(),
            Some(unit.trim_end_matches(']').trim().to_owned()),
        ),
        None => (head.trim().to_owned(), None),
    };
    let names: Vec<(String, Option<String>)> = heads.iter().map(|h| split(h)).collect();
    let Some(i) = heads
        .iter()
        .position(|h| *h == name)
        .or(names.iter().position(|(n, _)| n == name))
    else {
        let help = match nearest(name, names.iter().map(|(n, _)| n.as_str())) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!(
                "its columns are {}",
                names
                    .iter()
                    .take(12)
                    .map(|(n, _)| n.as_str())
                    .collect::<Vec<_>>()
                    .join(", ")
            ),
        };
        cx.push(
            Diagnostic::error("table-column", format!("`{file}` has no column `{name}`"))
                .at(span, "")
                .help(help),
        );
        return None;
    };
    let Some(text) = names.get(i).and_then(|(_, unit)| unit.clone()) else {
        return Some((i, cx.bare_unit(dimension)));
    };
    match Unit::parse(&text) {
        Ok(unit) if unit.dimension() == dimension => Some((i, unit)),
        Ok(unit) => {
            cx.push(
                Diagnostic::error(
                    "unit-mismatch",
                    format!(
                        "column `{name}` of `{file}`: {dimension} expected, found {}",
                        unit.dimension().with_article()
                    ),
                )
                .at(span, format!("its head says [{text}]"))
                .help(format!("name a column of {}", dimension.with_article())),
            );
            None
        }
        Err(issue) => {
            cx.push(
                Diagnostic::error(
                    "unknown-unit",
                    format!("column `{name}` of `{file}`: {}", issue.message),
                )
                .at(span, format!("its head says [{text}]"))
                .maybe_help(issue.help),
            );
            None
        }
    }
}
