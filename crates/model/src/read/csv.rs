//! Tables from files beside the model: two columns of a CSV file, the first of them rising.

use kempe_units::{Dimension, Unit, nearest};

use crate::bound::{beyond, remedy};
use crate::diagnostic::Diagnostic;
use crate::document::Node;
use crate::ids::Span;
use crate::read::context::Context;

/// A table has at most so many rows.
const MAX_ROWS: usize = 1_000_000;

/// A table has at most so many bytes, as many as its rows need.
pub const MAX_TABLE_BYTES: usize = 64 << 20;

/// How the first line of a table begins that a stopped study left. What follows tells how far it came.
pub const PARTIAL_TABLE: &str = "# partial:";

/// All tables of a model together have at most so many rows.
const MAX_ALL_ROWS: usize = 8_000_000;

/// How far a table came that a stopped study left; `None` of any other.
pub fn partial_table(csv: &str) -> Option<&str> {
    let first = csv.trim_start_matches('\u{feff}').lines().next()?;
    first.strip_prefix(PARTIAL_TABLE).map(str::trim)
}

/// Which column is meant.
pub(crate) enum Pick {
    /// By its head.
    Name(String),
    /// By its place.
    Number(usize),
}

/// A column that is asked for.
pub(crate) struct Ask {
    pub pick: Pick,
    /// Where it is asked for.
    pub span: Span,
    pub dimension: Dimension,
}

/// What is said of rows that do not fit.
pub(crate) struct Words {
    /// The first column does not rise.
    pub not_rising: &'static str,
    /// What rows are.
    pub order: &'static str,
    /// There are fewer than two.
    pub few: &'static str,
}

/// Two columns of the file that `file` names, in SI; the first one rises. Columns are parted by a semicolon, a tabulator or a
/// comma; a head may name its unit in brackets, `p [bar]`.
pub(crate) fn columns(
    cx: &mut Context<'_>,
    file: &Node,
    [first, second]: [&Ask; 2],
    words: &Words,
) -> Option<(Vec<f64>, Vec<f64>)> {
    let name = cx
        .text(file, "`table`", "\"measured.csv\"")?
        .content
        .clone();
    let content = match (cx.files)(&name) {
        Ok(content) => content,
        Err(reason) => {
            return cx.refuse(
                "table-unreadable",
                format!("cannot read `{name}`: {reason}"),
                &file.span,
                "a table is a CSV text, its name counts from the folder of the model file",
            );
        }
    };
    if content.len() > MAX_TABLE_BYTES {
        return cx.refuse(
            "too-large",
            format!("`{name}` has {} bytes", content.len()),
            &file.span,
            format!("a table has at most {MAX_TABLE_BYTES} bytes: leave out rows between others"),
        );
    }
    if let Some(how_far) = partial_table(&content) {
        return cx.refuse(
            "table-partial",
            format!("`{name}` is a partial result: {how_far}"),
            &file.span,
            "run its study to the end; to use the rows it has, take away its first line",
        );
    }
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
    if header.trim().is_empty() {
        return cx.refuse(
            "table-column",
            format!("`{name}` is empty"),
            &file.span,
            "its first line names the columns, with their units: t [s], angle [deg]",
        );
    }
    let heads: Vec<&str> = header.split(separator).map(unquoted).collect();
    if heads.iter().all(|head| head.parse::<f64>().is_ok()) {
        cx.push(
            Diagnostic::error(
                "table-column",
                format!("the columns of `{name}` have no heads"),
            )
            .at(file.span.clone(), "its first line is all numbers")
            .help("name the columns in the first line, with their units: angle [deg], force [N]"),
        );
        return None;
    }
    let first = find_column(cx, &heads, &name, first);
    let second = find_column(cx, &heads, &name, second);
    let ((first, first_unit), (second, second_unit)) = (first?, second?);
    let (mut abscissas, mut values) = (Vec::new(), Vec::new());
    for (number, line) in lines {
        let cells: Vec<&str> = line.split(separator).map(unquoted).collect();
        let filled = cells.len() - cells.iter().rev().take_while(|c| c.is_empty()).count();
        let room = abscissas.len() < MAX_ROWS && cx.table_rows < MAX_ALL_ROWS;
        let read = |i: usize, unit: &Unit| cell(cells.get(i).copied().unwrap_or(""), unit);
        let (trouble, help) = match (read(first, &first_unit), read(second, &second_unit)) {
            _ if filled > heads.len() => {
                let help = match separator {
                    ',' => "a decimal point is written `.`; or part the columns by a semicolon",
                    _ => "each row has as many cells as the first line has heads",
                };
                (cells_and_heads(filled, heads.len()), help.to_owned())
            }
            _ if filled <= first.max(second) => (
                cells_and_heads(filled, heads.len()),
                "each row has a cell under each head".to_owned(),
            ),
            (Err((trouble, help)), _) => (in_column(&heads, first, &trouble), help),
            (_, Err((trouble, help))) => (in_column(&heads, second, &trouble), help),
            _ if !room => (
                "one row too many".to_owned(),
                format!("{}, at most {MAX_ROWS} of them", words.order),
            ),
            (Ok(t), Ok(x)) => {
                if abscissas.last().is_none_or(|last| t - last > NEAREST) {
                    abscissas.push(t);
                    values.push(x);
                    cx.table_rows += 1;
                    continue;
                }
                let trouble = in_column(&heads, first, words.not_rising);
                (
                    trouble,
                    format!("{}, at most {MAX_ROWS} of them", words.order),
                )
            }
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
            .help(help),
        );
        return None;
    }
    if abscissas.len() < 2 {
        return cx.refuse(
            "table-values",
            format!("`{name}` has {} rows of data", abscissas.len()),
            &file.span,
            words.few,
        );
    }
    Some((abscissas, values))
}

/// Places nearer to each other than this, in SI, are one: no slope between them is a number.
const NEAREST: f64 = 1e-30;

/// A cell in SI, or what is wrong with it and what to do about it.
fn cell(text: &str, unit: &Unit) -> Result<f64, (String, String)> {
    let number = "each cell is a number, written like 20 or 0.5 or 1e-3".to_owned();
    let x: f64 = match text.parse() {
        Ok(x) => x,
        Err(_) if text.is_empty() => {
            return Err((
                "the cell is empty".to_owned(),
                "write its number, or leave the whole row out".to_owned(),
            ));
        }
        Err(_) => {
            let pointed = text.replace(',', ".");
            let help = match text.contains(',') && pointed.parse::<f64>().is_ok() {
                true => format!("decimals have a point: {pointed}"),
                false => number,
            };
            return Err((format!("`{text}` is not a number"), help));
        }
    };
    if x.is_nan() {
        let help = "write its number, or leave the whole row out".to_owned();
        return Err((format!("`{text}` is no value"), help));
    }
    let value = unit.to_si(x);
    match beyond(value, unit.dimension()) {
        _ if !x.is_finite() => Err((format!("`{text}` is not finite"), number)),
        Some("too large") => Err((
            format!("`{text}` is too large to be computed with"),
            remedy(unit.dimension()),
        )),
        _ => Ok(value),
    }
}

/// Trouble with a cell, and the head of its column.
fn in_column(heads: &[&str], column: usize, trouble: &str) -> String {
    let head = heads.get(column).copied().unwrap_or("");
    format!("column `{head}`: {trouble}")
}

fn cells_and_heads(cells: usize, heads: usize) -> String {
    let plural = |n: usize| if n == 1 { "" } else { "s" };
    format!(
        "{cells} cell{} under {heads} head{}",
        plural(cells),
        plural(heads)
    )
}

fn unquoted(cell: &str) -> &str {
    let cell = cell.trim();
    cell.strip_prefix('"')
        .and_then(|c| c.strip_suffix('"'))
        .unwrap_or(cell)
        .trim()
}

/// The column that is meant, with the unit in its head: `angle [deg]`, or the file's unit.
fn find_column(
    cx: &mut Context<'_>,
    heads: &[&str],
    file: &str,
    ask: &Ask,
) -> Option<(usize, Unit)> {
    let (dimension, span) = (ask.dimension, ask.span.clone());
    let split = |head: &str| match head.split_once('[') {
        Some((name, unit)) => (
            name.trim().to_owned(),
            Some(unit.trim_end_matches(']').trim().to_owned()),
        ),
        None => (head.trim().to_owned(), None),
    };
    let names: Vec<(String, Option<String>)> = heads.iter().map(|h| split(h)).collect();
    let place = match &ask.pick {
        Pick::Name(name) => heads
            .iter()
            .position(|h| *h == name)
            .or(names.iter().position(|(n, _)| n == name)),
        Pick::Number(i) => (*i < heads.len()).then_some(*i),
    };
    if let (Some(i), Pick::Name(wanted)) = (place, &ask.pick) {
        let exact = heads.get(i).is_some_and(|head| head == wanted);
        let same = match exact {
            true => heads.iter().filter(|head| *head == wanted).count(),
            false => names.iter().filter(|(name, _)| name == wanted).count(),
        };
        if same > 1 {
            let help = match exact {
                true => "give the columns of the table different names".to_owned(),
                false => format!(
                    "give them different names, or ask with the unit: \"{}\"",
                    heads.get(i).copied().unwrap_or("")
                ),
            };
            cx.push(
                Diagnostic::error(
                    "table-column",
                    format!("`{file}` has {same} columns `{wanted}`"),
                )
                .at(span, "which one?")
                .help(help),
            );
            return None;
        }
    }
    let name = match &ask.pick {
        Pick::Name(name) => name.as_str(),
        Pick::Number(i) => names.get(*i).map_or("2", |(name, _)| name.as_str()),
    };
    let Some(i) = place else {
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
