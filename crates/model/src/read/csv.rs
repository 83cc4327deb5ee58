//! Tables from files beside the model: columns of a CSV file.

use kempe_units::{Dimension, Unit, nearest};

use crate::bound::{beyond, remedy};
use crate::diagnostic::Diagnostic;
use crate::ids::Span;
use crate::node::Node;
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

/// What is asked of rows, and said of those that do not fit.
pub(crate) struct Words {
    /// The first column does not rise; `None` where it need not.
    pub not_rising: Option<&'static str>,
    /// What rows are.
    pub order: &'static str,
    /// So many are needed.
    pub least: usize,
    /// There are fewer.
    pub few: &'static str,
}

/// Two columns of a file, the first of which rises: see [`all_columns`].
pub(crate) fn columns(
    cx: &mut Context<'_>,
    file: &Node,
    asks: [&Ask; 2],
    words: &Words,
) -> Option<(Vec<f64>, Vec<f64>)> {
    let mut found = all_columns(cx, file, &asks, words)?.into_iter();
    Some((found.next()?, found.next()?))
}

/// Columns of the file that `file` names, in SI. They are parted by a semicolon, a tabulator or a
/// comma; a head may name its unit in brackets, `p [bar]`.
pub(crate) fn all_columns(
    cx: &mut Context<'_>,
    file: &Node,
    asks: &[&Ask],
    words: &Words,
) -> Option<Vec<Vec<f64>>> {
    let table = opened(cx, file)?;
    let (name, heads, separator) = (&table.name, &table.heads(), table.separator);
    let lines = table.lines().skip(1);
    let places: Vec<Option<(usize, Unit)>> = asks
        .iter()
        .map(|ask| find_column(cx, heads, name, ask))
        .collect();
    let places: Vec<(usize, Unit)> = places.into_iter().collect::<Option<_>>()?;
    let last = places.iter().map(|(i, _)| *i).max().unwrap_or(0);
    let mut found: Vec<Vec<f64>> = vec![Vec::new(); places.len()];
    let mut rows = 0;
    for (number, line) in lines {
        let cells: Vec<&str> = line.split(separator).map(unquoted).collect();
        let filled = cells.len() - cells.iter().rev().take_while(|c| c.is_empty()).count();
        let room = rows < MAX_ROWS && cx.table_rows < MAX_ALL_ROWS;
        let one_of_many = || format!("{}, at most {MAX_ROWS} of them", words.order);
        let mut values = Vec::with_capacity(places.len());
        let mut trouble = None;
        if filled > heads.len() {
            let help = match separator {
                ',' => "a decimal point is written `.`; or part the columns by a semicolon",
                _ => "each row has as many cells as the first line has heads",
            };
            trouble = Some((cells_and_heads(filled, heads.len()), help.to_owned()));
        } else if filled <= last {
            trouble = Some((
                cells_and_heads(filled, heads.len()),
                "each row has a cell under each head".to_owned(),
            ));
        }
        for (i, unit) in &places {
            match cell(cells.get(*i).copied().unwrap_or(""), unit) {
                Ok(value) => values.push(value),
                Err((wrong, help)) => {
                    trouble = trouble.or_else(|| Some((in_column(heads, *i, &wrong), help)));
                }
            }
        }
        if !room {
            trouble = trouble.or_else(|| Some(("one row too many".to_owned(), one_of_many())));
        }
        if let (Some(not_rising), Some((i, _)), Some(value)) =
            (words.not_rising, places.first(), values.first())
            && let Some(before) = found.first().and_then(|column| column.last())
            && !(value - before > NEAREST)
        {
            let wrong = in_column(heads, *i, not_rising);
            trouble = trouble.or_else(|| Some((wrong, one_of_many())));
        }
        let Some((trouble, help)) = trouble else {
            for (column, value) in found.iter_mut().zip(values) {
                column.push(value);
            }
            rows += 1;
            cx.table_rows += 1;
            continue;
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
    if rows < words.least {
        return cx.refuse(
            "table-values",
            format!("`{name}` has {rows} rows of data"),
            &file.span,
            words.few,
        );
    }
    Some(found)
}

/// A file with its first line read.
struct Table {
    name: String,
    content: String,
    separator: char,
}

impl Table {
    /// Lines that say something, with their numbers.
    fn lines(&self) -> impl Iterator<Item = (usize, &str)> {
        let lines = self.content.lines().enumerate();
        lines.filter(|(_, l)| !l.trim().is_empty() && !l.starts_with('#'))
    }

    fn header(&self) -> &str {
        let first = self.lines().next();
        first.map_or("", |(_, line)| line.trim_start_matches('\u{feff}'))
    }

    fn heads(&self) -> Vec<&str> {
        self.header().split(self.separator).map(unquoted).collect()
    }
}

/// The names of the columns of a file, without their units.
pub(crate) fn names_of_columns(cx: &mut Context<'_>, file: &Node) -> Option<Vec<String>> {
    let table = opened(cx, file)?;
    let heads = table.heads().into_iter();
    Some(heads.map(|head| split_head(head).0).collect())
}

fn opened(cx: &mut Context<'_>, file: &Node) -> Option<Table> {
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
    let mut table = Table {
        name,
        content,
        separator: ',',
    };
    let known = [';', '\t', ','].into_iter();
    let separator = known.into_iter().find(|c| table.header().contains(*c));
    table.separator = separator.unwrap_or(',');
    let (name, header, heads) = (&table.name, table.header(), table.heads());
    if header.trim().is_empty() {
        return cx.refuse(
            "table-column",
            format!("`{name}` is empty"),
            &file.span,
            "its first line names the columns, with their units: t [s], angle [deg]",
        );
    }
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
    Some(table)
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
/// A head as a name and the unit in brackets behind it.
fn split_head(head: &str) -> (String, Option<String>) {
    match head.split_once('[') {
        Some((name, unit)) => (
            name.trim().to_owned(),
            Some(unit.trim_end_matches(']').trim().to_owned()),
        ),
        None => (head.trim().to_owned(), None),
    }
}

fn find_column(
    cx: &mut Context<'_>,
    heads: &[&str],
    file: &str,
    ask: &Ask,
) -> Option<(usize, Unit)> {
    let (dimension, span) = (ask.dimension, ask.span.clone());
    let names: Vec<(String, Option<String>)> = heads.iter().map(|h| split_head(h)).collect();
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
