//! Studies that adjust.
//!
//! ```toml
//! [studies.set]
//! kind       = "adjust"
//! unknown    = ["a", "b"]
//! match      = [{ lever = "30 deg", box = "100.248 deg" }, { lever = "50 deg", box = "67.321 deg" }]
//! deviations = { box = "0.3 deg" }          # of what was measured
//! bounds     = { a = ["20 mm", "200 mm"] }  # between which values it is looked for
//! ```

use kempe_units::{Dimension, Expr};

use crate::adjust::{AdjustStudy, Matched, MatchedRow};
use crate::bound::Keeps;
use crate::diagnostic::Diagnostic;
use crate::ids::{ParameterId, Scalar, Span};
use crate::key_table::adjust::{MAX_UNKNOWN, TABLE};
use crate::measure::{Leaf, Measure, PoseMeasure};
use crate::motion_study::{Column, MotionStudy, Rows};
use crate::node::{Key, Node, Value};
use crate::read::context::{Context, Meaning, MeasureState};
use crate::read::csv::{Ask, Pick, Words, all_columns, names_of_columns};
use crate::read::entry::{Entry, bounds_of};
use crate::read::nature::nature;
use crate::read::simulate::coordinate;
use crate::study::StudyKind;

const WORDS: Words = Words {
    not_rising: None,
    order: "rows are what was measured together",
    least: 1,
    few: "give what was measured, row by row",
};

/// So many heads that are left aside are told by name.
const MAX_HEADS_TOLD: usize = 6;

pub(crate) fn read(cx: &mut Context<'_>, entry: &Entry<'_>, name: &Key) -> Option<StudyKind> {
    let unknown = unknown(cx, entry);
    let mut measures = Vec::new();
    let rows = rows(cx, entry, &mut measures);
    let (unknown, rows) = (unknown?, rows?);
    let known = data_are_known(cx, entry, &unknown, &rows);
    let deviations = deviations(cx, entry, &mut measures, &rows);
    let bounds = bounds(cx, entry, &unknown);
    known?;
    Some(StudyKind::Adjust(Box::new(AdjustStudy {
        along: MotionStudy {
            rows: Rows::Count(rows.len()),
            columns: Vec::new(),
            plots: Vec::new(),
            circuit: false,
        },
        unknown,
        measures,
        rows,
        deviations: deviations?,
        bounds: bounds?,
        span: name.span.clone(),
    })))
}

/// The parameters that are looked for.
fn unknown(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<Vec<ParameterId>> {
    let node = entry.required(cx, "unknown")?;
    let place = entry.place_of("unknown");
    let items = cx.array(node, &place, entry.example_of("unknown"))?;
    if items.is_empty() || items.len() > MAX_UNKNOWN {
        let message = format!("{place} names {} parameters", items.len());
        let help = format!("name 1 to {MAX_UNKNOWN} of [parameters]");
        return cx.refuse("wrong-type", message, &node.span, help);
    }
    let mut found: Vec<ParameterId> = Vec::new();
    let mut whole = true;
    for item in items {
        match unknown_parameter(cx, item, &place) {
            Some(id) if found.contains(&id) => {
                let message = format!("{place} names a parameter twice");
                cx.push(
                    Diagnostic::error("duplicate-name", message)
                        .at(item.span.clone(), "")
                        .help("name each once"),
                );
                whole = false;
            }
            Some(id) => found.push(id),
            None => whole = false,
        }
    }
    whole.then_some(found)
}

/// A parameter by its name in a string.
fn unknown_parameter(cx: &mut Context<'_>, node: &Node, place: &str) -> Option<ParameterId> {
    let text = cx.text(node, place, "\"a\"")?;
    let (name, span) = (
        text.content.trim().to_owned(),
        text.span(0..text.content.len()),
    );
    free_parameter(cx, &name, &span)
}

/// A parameter that can take other values: a number of the file, not a formula, that nothing has taken up.
pub(crate) fn free_parameter(cx: &mut Context<'_>, name: &str, span: &Span) -> Option<ParameterId> {
    let id = parameter(cx, name, span)?;
    let refused = |message: String, why: &str, help: &str| {
        Diagnostic::error("bad-choice", message)
            .at(span.clone(), why.to_owned())
            .help(help)
    };
    let value = &cx.model.parameters[id.index()].value;
    let diagnostic = if value.leaves().next().is_some() {
        refused(
            format!("`{name}` is a formula of other parameters"),
            "it follows those",
            "name those instead, or give it a number",
        )
    } else if cx.model.settled_by(id).is_some() {
        refused(
            format!("`{name}` went into a plain number"),
            "the period of a table depends on it",
            "name another parameter",
        )
    } else {
        return Some(id);
    };
    cx.push(diagnostic);
    None
}

fn parameter(cx: &mut Context<'_>, name: &str, span: &Span) -> Option<ParameterId> {
    if let Some(Meaning::Parameter(id)) = cx.names.get(name).map(|(meaning, _)| *meaning) {
        let sound = cx.sound.get(id.index()).copied().unwrap_or(false);
        return sound.then_some(id);
    }
    let known = cx.model.parameters.iter().map(|p| p.name.as_str());
    let d = cx.no_such("parameter", name, span.clone(), known);
    cx.push(d);
    None
}

/// What a name of a row means, with its dimension; measures join those of the study.
fn matched(
    cx: &mut Context<'_>,
    key: &Key,
    measures: &mut Vec<Column>,
) -> Option<(Matched, Dimension)> {
    let of_link = |link| Expr::Leaf(Leaf::Pose(PoseMeasure::Angle(link)));
    let (measure, dimension): (Measure, Dimension) =
        match cx.names.get(&key.name).map(|(meaning, _)| *meaning) {
            Some(Meaning::Drive(i)) => {
                let drive = cx.drives.get(i).copied().flatten()?;
                let dimension = cx.model.drives.get(drive.index())?.dimension;
                return Some((Matched::Drive(drive), dimension));
            }
            Some(Meaning::Link(link)) => (of_link(link), Dimension::ANGLE),
            Some(Meaning::Measure(i)) => match cx.measures.get(i) {
                Some(MeasureState::Sound(index, dimension)) => {
                    (Expr::Leaf(Leaf::Named(*index)), *dimension)
                }
                _ => return None,
            },
            _ => {
                let links = cx.model.links.iter().skip(1).map(|l| l.name.as_str());
                let drives = cx.model.drives.iter().map(|d| d.name.as_str());
                let named = cx.model.measures.iter().map(|m| m.name.as_str());
                let names = drives.chain(links).chain(named);
                let what = "drive, link or measure";
                let d = cx.no_such(what, &key.name, key.span.clone(), names);
                cx.push(d);
                return None;
            }
        };
    let known = measures.iter().position(|m| m.name == key.name);
    let index = known.unwrap_or_else(|| {
        measures.push(Column {
            name: key.name.clone(),
            measure,
            dimension,
        });
        measures.len() - 1
    });
    Some((Matched::Measure(index), dimension))
}

fn rows(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    measures: &mut Vec<Column>,
) -> Option<Vec<MatchedRow>> {
    let node = entry.required(cx, "match")?;
    if let Value::Table(_) = &node.value {
        return rows_of_table(cx, entry, node, measures);
    }
    let place = entry.place_of("match");
    let items = cx.array(node, &place, entry.example_of("match"))?;
    if items.is_empty() {
        let help = "give what was measured, row by row";
        return cx.refuse("wrong-type", format!("{place} is empty"), &node.span, help);
    }
    let rows: Vec<Option<MatchedRow>> = items
        .iter()
        .map(|item| row(cx, item, &place, measures))
        .collect();
    rows.into_iter().collect()
}

fn row(
    cx: &mut Context<'_>,
    node: &Node,
    place: &str,
    measures: &mut Vec<Column>,
) -> Option<MatchedRow> {
    let table = cx.table(node, place, "{ lever = \"30 deg\", box = \"100 deg\" }")?;
    let mut values = Vec::new();
    let mut whole = true;
    for (key, node) in &table.entries {
        let value = matched(cx, key, measures).and_then(|(what, dimension)| {
            let value = match what {
                Matched::Drive(drive) => coordinate(cx, drive, &key.name, node),
                Matched::Measure(_) => cx.scalar(node, dimension),
            };
            Some((what, value?))
        });
        whole &= value.is_some();
        values.extend(value);
    }
    whole.then_some(())?;
    sound_row(cx, values, node.span.clone(), measures)
}

/// A row in its order, where it can be one.
fn sound_row(
    cx: &mut Context<'_>,
    mut values: Vec<(Matched, Scalar)>,
    span: Span,
    measures: &[Column],
) -> Option<MatchedRow> {
    values.sort_by_key(|(what, _)| match what {
        Matched::Drive(drive) => (0, drive.index()),
        Matched::Measure(index) => (1, *index),
    });
    let row = MatchedRow { values, span };
    if row.measures().next().is_none() {
        return cx.refuse(
            "missing-key",
            "a row says what drives are, but nothing that was measured there",
            &row.span,
            "give the angle of a link, or the value of a measure of [measures]",
        );
    }
    if row.drives().next().is_some() {
        for (index, _) in row.measures() {
            if nature(&measures[index].measure, &cx.natures).motion {
                let name = &measures[index].name;
                return cx.refuse(
                    "not-at-one-instant",
                    format!(
                        "`{name}` is a number over the whole motion, and this row is of one pose"
                    ),
                    &row.span,
                    "give it in a row of its own that names no drive",
                );
            }
        }
    }
    Some(row)
}

/// Rows of a table beside the file.
fn rows_of_table(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    node: &Node,
    measures: &mut Vec<Column>,
) -> Option<Vec<MatchedRow>> {
    let table = Entry::inner(cx, node, &node.span, entry.place_of("match"), &TABLE)?;
    let file = table.required(cx, "table")?;
    let named: Vec<(Key, Pick)> = match table.get("columns") {
        Some(node) => {
            let place = table.place_of("columns");
            let list = cx.table(node, &place, table.example_of("columns"))?;
            let columns = list.entries.iter().map(|(key, node)| {
                let head = cx.text(node, &place, "\"box\"")?;
                Some((key.clone(), Pick::Name(head.content.trim().to_owned())))
            });
            columns.collect::<Option<_>>()?
        }
        None => {
            let names = names_of_columns(cx, file)?.into_iter().enumerate();
            let (known, aside): (Vec<_>, Vec<_>) = names.partition(|(_, name)| {
                let meaning = cx.names.get(name).map(|(meaning, _)| *meaning);
                !matches!(
                    meaning,
                    None | Some(Meaning::Parameter(_) | Meaning::Joint(_))
                )
            });
            if !known.is_empty() {
                tell_left_aside(cx, file, &aside);
            }
            let key = |name| Key {
                name,
                span: file.span.clone(),
            };
            known
                .into_iter()
                .map(|(i, name)| (key(name), Pick::Number(i)))
                .collect()
        }
    };
    if named.is_empty() {
        return cx.refuse(
            "table-column",
            "no column of the table is called as a drive, a link or a measure",
            &file.span,
            format!(
                "say whose values they are: columns = {}",
                table.example_of("columns")
            ),
        );
    }
    let mut asks = Vec::new();
    for (key, pick) in named {
        let (what, dimension) = matched(cx, &key, measures)?;
        asks.push((
            what,
            Ask {
                pick,
                span: key.span.clone(),
                dimension,
            },
        ));
    }
    let wanted: Vec<&Ask> = asks.iter().map(|(_, ask)| ask).collect();
    let columns = all_columns(cx, file, &wanted, &WORDS)?;
    let count = columns.first().map_or(0, Vec::len);
    let rows = (0..count).map(|i| {
        let values = asks.iter().zip(&columns);
        let values = values.map(|((what, _), column)| (*what, Expr::Const(column[i])));
        sound_row(cx, values.collect(), file.span.clone(), measures)
    });
    rows.collect()
}

/// Tells the columns that are taken for nothing: such a head may be the misspelt or former name of a part.
fn tell_left_aside(cx: &mut Context<'_>, file: &Node, aside: &[(usize, String)]) {
    let heads = aside.iter().map(|(_, head)| head.as_str());
    let heads: Vec<&str> = heads.filter(|head| !head.is_empty()).collect();
    if heads.is_empty() {
        return;
    }
    let shown = heads.iter().take(MAX_HEADS_TOLD);
    let shown: Vec<String> = shown.map(|head| format!("`{head}`")).collect();
    let more = match heads.len() - shown.len() {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let (shown, example) = (shown.join(", "), TABLE.example_of("columns"));
    cx.push(
        Diagnostic::warning(
            "head-left-aside",
            format!("left aside, as no drive, link or measure is called so: {shown}{more}"),
        )
        .at(file.span.clone(), "")
        .help(format!(
            "say which columns are meant, and of what: columns = {example}"
        )),
    );
}

/// What was measured cannot hang on what is looked for.
fn data_are_known(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    unknown: &[ParameterId],
    rows: &[MatchedRow],
) -> Option<()> {
    // A parameter depends on earlier ones only.
    let mut hangs = vec![false; cx.model.parameters.len()];
    for (index, parameter) in cx.model.parameters.iter().enumerate() {
        hangs[index] = unknown.iter().any(|id| id.index() == index)
            || parameter.value.leaves().any(|id| hangs[id.index()]);
    }
    let depends = |value: &Scalar| value.leaves().any(|id| hangs[id.index()]);
    let row = rows
        .iter()
        .find(|row| row.values.iter().any(|(_, value)| depends(value)));
    match row {
        None => Some(()),
        Some(row) => cx.refuse(
            "bad-choice",
            format!(
                "what was measured depends on a parameter that {} is to find",
                entry.place
            ),
            &row.span.clone(),
            "write the number that was measured",
        ),
    }
}

fn deviations(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    measures: &mut Vec<Column>,
    rows: &[MatchedRow],
) -> Option<Vec<(Matched, Scalar)>> {
    let Some(node) = entry.get("deviations") else {
        return Some(Vec::new());
    };
    let place = entry.place_of("deviations");
    let table = cx.table(node, &place, entry.example_of("deviations"))?;
    let mut found = Vec::new();
    for (key, node) in &table.entries {
        let (what, dimension) = matched(cx, key, measures)?;
        let given = rows.iter().flat_map(|row| &row.values);
        if !given.into_iter().any(|(other, _)| *other == what) {
            return cx.refuse(
                "unknown-name",
                format!("no row gives a value of `{}`", key.name),
                &key.span,
                "deviations are of what is measured: leave it out",
            );
        }
        let name = format!("the deviation of `{}`", key.name);
        found.push((what, cx.positive(node, dimension, &name, false)?));
    }
    Some(found)
}

fn bounds(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    unknown: &[ParameterId],
) -> Option<Vec<(ParameterId, [Option<Scalar>; 2])>> {
    let Some(node) = entry.get("bounds") else {
        return Some(Vec::new());
    };
    let place = entry.place_of("bounds");
    let example = entry.example_of("bounds");
    let table = cx.table(node, &place, example)?;
    let mut found = Vec::new();
    for (key, node) in &table.entries {
        let id = parameter(cx, &key.name, &key.span)?;
        if !unknown.contains(&id) {
            return cx.refuse(
                "unknown-name",
                format!("`{}` is not among the unknown parameters", key.name),
                &key.span,
                "leave it out, or name it under `unknown`",
            );
        }
        let dimension = cx.model.parameters[id.index()].dimension;
        let ends = bounds_of(cx, node, dimension, &place, example)?;
        let value = cx.values[id.index()];
        let [low, high] = [&ends[0], &ends[1]].map(|end| end.as_ref().map(|e| cx.number(e)));
        let wrong = match (low, high) {
            (Some(low), Some(high)) if !(low < high) => {
                Some("the lower bound is not below the upper one")
            }
            _ if low.is_some_and(|low| value < low) || high.is_some_and(|high| value > high) => {
                Some("the file's own value is not between them")
            }
            _ => None,
        };
        if let Some(wrong) = wrong {
            return cx.refuse(
                "contradictory-values",
                format!("the bounds of `{}`: {wrong}", key.name),
                &node.span,
                "the search begins at the file's value: write [least, largest] around it",
            );
        }
        if let [Some(low), Some(high)] = &ends {
            let what = format!("the room between the bounds of `{}`", key.name);
            cx.apart([low, high], &node.span, &what, dimension, Keeps::Positive);
        }
        found.push((id, ends));
    }
    Some(found)
}
