//! Where the rows of a study's table stand: `step` or `rows`.

use kempe_units::{Builtin, Dimension, Expr};

use crate::diagnostic::Diagnostic;
use crate::drive::{Drive, LawPiece};
use crate::ids::Scalar;
use crate::key_table::MAX_ROWS;
use crate::model::Model;
use crate::motion_study::Rows;
use crate::node::{Key, Node, Value};
use crate::read::context::Context;
use crate::read::entry::Entry;

/// Rows of a table by default, when a step is not the thing to say.
const DEFAULT_ROWS: usize = 181;

/// Where the rows stand: `step` or `rows`, or the default.
pub(crate) fn rows(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<Rows> {
    let place = &entry.place;
    match (entry.get("step"), entry.entry("rows")) {
        (None, None) => Some(default_rows(cx)),
        (Some(_), Some((key, _))) => {
            both_ways(cx, key, place);
            None
        }
        (None, Some((_, node))) => count(cx, node, place),
        (Some(node), None) => step(cx, node, place),
    }
}

/// How many rows.
pub(crate) fn count(cx: &mut Context<'_>, node: &Node, place: &str) -> Option<Rows> {
    match node.value {
        Value::Number(n) if n == n.trunc() && n >= 1.0 && n <= MAX_ROWS as f64 => {
            Some(Rows::Count(n as usize))
        }
        Value::Number(n) => {
            let (code, message) = if n > MAX_ROWS as f64 {
                ("too-large", format!("{place}: {n} rows"))
            } else if n < 1.0 {
                ("bad-size", format!("{place}: a table has at least one row"))
            } else {
                ("wrong-type", format!("{place}: {n} is no number of rows"))
            };
            cx.refuse(
                code,
                message,
                &node.span,
                format!("write a whole number from 1 to {MAX_ROWS}: rows = 361"),
            )
        }
        _ => {
            cx.wrong_type(node, "`rows`", "a number, how many rows", "rows = 361");
            None
        }
    }
}

/// Rows are told in two ways at once.
pub(crate) fn both_ways(cx: &mut Context<'_>, key: &Key, place: &str) {
    cx.push(
        Diagnostic::error(
            "over-specified",
            format!("{place} has both `step` and `rows`"),
        )
        .at(key.span.clone(), "one of them is enough")
        .help("leave one of them out"),
    );
}

/// The drive whose coordinate runs one way through the whole motion, when there is only one that moves.
fn running(model: &Model) -> Option<(usize, Scalar, Scalar)> {
    let holds = |d: &Drive| matches!(d.law.pieces.as_slice(), [LawPiece::Dwell { .. }]);
    let mut moving = model.drives.iter().enumerate().filter(|(_, d)| !holds(d));
    let (i, drive) = moving.next()?;
    if moving.next().is_some() {
        return None;
    }
    match drive.law.pieces.as_slice() {
        [
            LawPiece::ConstantSpeed { to, .. }
            | LawPiece::ConstantAcceleration { to, .. }
            | LawPiece::Rise { to, .. },
        ] => Some((i, drive.law.from.clone(), to.clone())),
        _ => None,
    }
}

fn step(cx: &mut Context<'_>, node: &Node, place: &str) -> Option<Rows> {
    let running = running(&cx.model);
    let of_drive = running
        .as_ref()
        .and_then(|(i, ..)| cx.model.drives.get(*i))
        .map(|d| d.dimension);
    // Of no drive, a bare number is a step of nothing: it is not taken for seconds.
    let (step, dimension) = cx.inferred(node, of_drive.unwrap_or(Dimension::NONE))?;
    let size = cx.number(&step);
    if size <= 0.0 {
        return cx.refuse(
            "bad-size",
            format!("{place}: a step must be positive"),
            &node.span,
            "write step = 1: one degree (or one unit of length) of the drive",
        );
    }
    let (rows, count) = if dimension == Dimension::TIME {
        let durations = cx.model.drives.iter().map(|d| d.law.duration(&cx.values));
        (Rows::TimeStep(step), durations.fold(0.0, f64::max) / size)
    } else if let Some((_, from, to)) =
        running.filter(|_| of_drive.is_some_and(|d| d.compatible(dimension)))
    {
        let travel = (cx.number(&to) - cx.number(&from)).abs();
        (Rows::DriveStep(step), travel / size)
    } else {
        // drives that are broken have been told, and a line that is no TOML may be the one that moves
        let lost = of_drive.is_none() && cx.broken.has_lines();
        if cx.drives.iter().all(Option::is_some) && !lost {
            let (message, help) = match of_drive {
                Some(d) => (
                    format!("{d} or time expected, found {}", dimension.with_article()),
                    format!(
                        "a step is a step of the drive, {}, or of time, \"1 ms\"",
                        cx.example(d)
                    ),
                ),
                None => (
                    format!("{}, so this is a step of what?", not_one_way(cx)),
                    "give the step in time, step = \"1 ms\", or the number of rows, rows = 361"
                        .to_owned(),
                ),
            };
            cx.push(
                Diagnostic::error("unit-mismatch", format!("{place}: {message}"))
                    .at(node.span.clone(), "")
                    .help(help),
            );
        }
        return None;
    };
    few_enough(cx, node, place, count).then_some(rows)
}

/// Tells a step that makes too many rows.
pub(crate) fn few_enough(cx: &mut Context<'_>, node: &Node, place: &str, count: f64) -> bool {
    let few = count <= MAX_ROWS as f64;
    if !few {
        cx.push(
            Diagnostic::error("too-large", format!("{place}: {count:.0} rows"))
                .at(node.span.clone(), "this step is too small")
                .help(format!("a table has at most {MAX_ROWS} rows")),
        );
    }
    few
}

/// Why no drive alone runs one way.
fn not_one_way(cx: &Context<'_>) -> String {
    let drives = &cx.model.drives;
    let mut moving = (drives.iter()).filter(|d| d.law.duration(&cx.values) > 0.0);
    match (moving.next(), moving.next()) {
        (Some(_), Some(_)) => "several drives move".to_owned(),
        (Some(one), None) => format!("the law of `{}` has several pieces", one.name),
        _ => "no drive moves".to_owned(),
    }
}

/// One degree of an angle, the 180th part of a length; evenly in time when not one drive alone runs one way.
pub(crate) fn default_rows(cx: &Context<'_>) -> Rows {
    if cx
        .model
        .drives
        .iter()
        .all(|d| d.law.duration(&cx.values) == 0.0)
    {
        return Rows::Count(1);
    }
    let Some((i, from, to)) = running(&cx.model) else {
        return Rows::Count(DEFAULT_ROWS);
    };
    let angle = cx
        .model
        .drives
        .get(i)
        .is_some_and(|d| d.dimension == Dimension::ANGLE);
    let travel = (cx.number(&to) - cx.number(&from)).abs();
    let degree = 1.0f64.to_radians();
    if angle && travel / degree <= MAX_ROWS as f64 {
        return Rows::DriveStep(Expr::Const(degree));
    }
    let parts = (DEFAULT_ROWS - 1) as f64;
    let travel = Expr::Call(Builtin::Abs, vec![Expr::Sub(Box::new(to), Box::new(from))]);
    Rows::DriveStep(Expr::Div(Box::new(travel), Box::new(Expr::Const(parts))))
}
