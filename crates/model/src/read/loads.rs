//! `[loads]`: forces and torques from outside.
//!
//! ```toml
//! [loads]
//! hook  = { force = [0, "-100 kN"], at = "E" }
//! wind  = { force = ["50 N", "30 deg"], at = "E", on = "jib" }          # size and direction
//! tool  = { force = ["-20 N * sign", 0], at = "T", axes = "ram" }       # along the axes of a link
//! brake = { torque = "-0.2 N m s * angular_speed(drum)", on = "drum", against = "arm" }
//! gas   = { force = [0, { table = "card.csv", over = "angle(crank)", value = "p", factor = "-area", period = "720 deg" }], at = "C" }
//! ```
//!
//! An entry is a value, a measure of the motion (of a drive, of time, of any pose or speed), or a table beside the model. A
//! table goes by the measure `over`; its columns are the first and second, or those that `argument` and `value` name; their
//! heads may hold units; `factor` turns its values into forces. With `period` it repeats.
//!
//! A force acts on the link `on`; without it on the slider whose pin the point is, or else on the first-named moving link that
//! carries the point, with a warning where there are several.

use kempe_units::{Builtin, Dimension, Expr, Issue, check, check_as, parse};

use crate::amount::Amount;
use crate::diagnostic::Diagnostic;
use crate::ids::{FRAME, Span};
use crate::key_table::{CARD, FORCE, TORQUE};
use crate::load::{Load, LoadKind};
use crate::measure::{Leaf, Measure};
use crate::node::{Key, Node, Value};
use crate::read::carrier::moving_carrier;
use crate::read::context::Context;
use crate::read::csv::{Ask, Pick, Words, columns};
use crate::read::entry::{Entry, on_link};
use crate::read::law_table::column_name;
use crate::read::masses::on_the_frame;
use crate::read::measure_names::Measures;
use crate::read::nature::{as_scalar, nature};
use crate::read::springs::plain_name;

const WORDS: Words = Words {
    not_rising: Some("its argument is not larger than that of the row before"),
    least: 2,
    order: "rows are numbers in order of increasing argument",
    few: "a curve needs at least two rows",
};

/// A file has at most so many loads.
const MAX: usize = 10_000;

/// Makes the loads known to measures, before they are read.
pub(crate) fn declare(cx: &mut Context<'_>, entries: &[&(Key, Node)]) {
    for (index, (key, node)) in entries.iter().enumerate() {
        let torque = matches!(&node.value, Value::Table(t) if t.get("torque").is_some());
        let dimension = if torque {
            Dimension::TORQUE
        } else {
            Dimension::FORCE
        };
        cx.loads.insert(key.name.clone(), Some((index, dimension)));
    }
}

/// Reads all loads.
pub(crate) fn read(cx: &mut Context<'_>, entries: &[&(Key, Node)]) {
    for entry in cx.limited(entries, MAX, "loads") {
        plain_name(cx, &entry.0, "a load");
        let kind = read_load(cx, entry);
        cx.model.actions.loads.extend(kind.map(|kind| Load {
            name: entry.0.name.clone(),
            kind,
            span: entry.0.span.clone(),
        }));
    }
}

fn read_load(cx: &mut Context<'_>, entry: &(Key, Node)) -> Option<LoadKind> {
    let place = format!("load `{}`", entry.0.name);
    let table = cx.table(&entry.1, &place, FORCE.example)?;
    match (table.get("force"), table.entry("torque")) {
        (Some(_), Some((key, _))) => cx.refuse(
            "over-specified",
            format!("{place} has both `force` and `torque`"),
            &key.span,
            "make two loads of it",
        ),
        (None, None) => {
            let near = table
                .entries
                .iter()
                .find_map(|(k, _)| kempe_units::nearest(&k.name, ["force", "torque"]));
            let help = match near {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!(
                    "a load is a force or a torque: {} or {}",
                    FORCE.example, TORQUE.example
                ),
            };
            cx.refuse(
                "missing-key",
                format!("{place}: what kind of load is it?"),
                &entry.0.span,
                help,
            )
        }
        (Some(node), None) => {
            let entry = Entry::new(cx, entry, &FORCE)?;
            force(cx, &entry, node)
        }
        (None, Some((_, node))) => {
            let entry = Entry::new(cx, entry, &TORQUE)?;
            torque(cx, &entry, node)
        }
    }
}

fn force<'d>(cx: &mut Context<'_>, entry: &Entry<'d>, node: &'d Node) -> Option<LoadKind> {
    let components = components(cx, entry, node);
    let axes = entry.link_or_frame(cx, "axes");
    let (point, at) = entry.point(cx, "at")?;
    let on = match entry.has("on") {
        true => entry.link(cx, "on")?,
        false => moving_carrier(cx, point, &entry.place, entry.span)?,
    };
    let at = on_link(cx, point, on, at)?;
    on_the_frame(cx, on, &entry.place, entry.span);
    Some(LoadKind::Force {
        at,
        components: components?,
        axes: axes?,
    })
}

fn torque(cx: &mut Context<'_>, entry: &Entry<'_>, node: &Node) -> Option<LoadKind> {
    let amount = amount(cx, entry, node, Dimension::TORQUE);
    let on = entry.link(cx, "on");
    let against = entry.link_or_frame(cx, "against");
    let (on, against) = (on?, against?);
    if on == against && on == FRAME {
        on_the_frame(cx, on, &entry.place, entry.span);
    } else if on == against {
        let name = cx.link_name(on).to_owned();
        return cx.refuse(
            "same-link",
            format!("{} turns `{name}` against itself", entry.place),
            entry.span,
            "`against` names the link that takes the reaction: another one",
        );
    }
    Some(LoadKind::Torque {
        on,
        against,
        amount: amount?,
    })
}

/// `[x, y]`, or `[size, direction]` when the second is an angle.
fn components<'d>(cx: &mut Context<'_>, entry: &Entry<'d>, node: &'d Node) -> Option<[Amount; 2]> {
    let (first, second) = entry.two(cx, node, "force")?;
    if let Some(direction) = direction(cx, second)? {
        let size = amount(cx, entry, first, Dimension::FORCE)?;
        return polar(cx, size, &direction, second);
    }
    let x = amount(cx, entry, first, Dimension::FORCE);
    let y = amount(cx, entry, second, Dimension::FORCE);
    Some([x?, y?])
}

/// The direction of a force, when the second value of its pair is an angle.
fn direction(cx: &mut Context<'_>, node: &Node) -> Option<Option<Measure>> {
    let Value::Text(text) = &node.value else {
        return Some(None);
    };
    // what is wrong with it is told where it is read as a force
    let Ok(tree) = parse(&text.content) else {
        return Some(None);
    };
    match check(&tree, &mut Measures(cx)) {
        Ok((angle, Dimension::ANGLE)) => {
            instant(cx, &angle, &node.span, "a load")?;
            Some(Some(angle))
        }
        _ => Some(None),
    }
}

fn polar(
    cx: &mut Context<'_>,
    size: Amount,
    direction: &Measure,
    node: &Node,
) -> Option<[Amount; 2]> {
    let part = |function: Builtin| Expr::Call(function, vec![direction.clone()]);
    match size {
        Amount::Measure(size) => {
            let times = |function| {
                Amount::Measure(Expr::Mul(Box::new(size.clone()), Box::new(part(function))))
            };
            Some([times(Builtin::Cos), times(Builtin::Sin)])
        }
        table @ Amount::Table { .. } => {
            let Some(direction) = as_scalar(direction) else {
                let message = "the direction of a table's force cannot move";
                let help = "give the components along the axes of the link that it turns with: axes = \"rod\"";
                return cx.refuse("bad-choice", message, &node.span, help);
            };
            let scaled = |function| {
                let mut table = table.clone();
                if let Amount::Table { factor, .. } = &mut table {
                    let part = Expr::Call(function, vec![direction.clone()]);
                    *factor = Expr::Mul(Box::new(factor.clone()), Box::new(part));
                }
                table
            };
            Some([scaled(Builtin::Cos), scaled(Builtin::Sin)])
        }
    }
}

/// A value, a measure or a table.
pub(crate) fn amount(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    node: &Node,
    dimension: Dimension,
) -> Option<Amount> {
    match &node.value {
        Value::Table(_) => {
            let place = format!("the table of {}", entry.place);
            let table = Entry::inner(cx, node, &node.span, place, &CARD)?;
            card(cx, &table, dimension)
        }
        Value::Text(text) => {
            let unit = cx.bare_unit(dimension);
            let checked = parse(&text.content)
                .and_then(|tree| check_as(&tree, &mut Measures(cx), dimension, &unit));
            match checked {
                Ok((measure, _)) => {
                    instant(cx, &measure, &node.span, what(entry))?;
                    if let Some(scalar) = as_scalar(&measure) {
                        cx.finite(&scalar, &node.span, dimension)?;
                    }
                    Some(Amount::Measure(measure))
                }
                Err(issues) => {
                    cx.issues(text, issues);
                    None
                }
            }
        }
        _ => {
            let scalar = cx.scalar(node, dimension)?;
            Some(Amount::Measure(
                scalar.map_leaves(&mut |id| Leaf::Parameter(*id)),
            ))
        }
    }
}

/// What an entry says the size of.
fn what(entry: &Entry<'_>) -> &'static str {
    match entry.kind.name {
        "oil" => "the opening of a valve",
        "motor" => "the throttle of a motor",
        _ => "a load",
    }
}

/// Whether a measure is known at every instant, before the forces are.
fn instant(cx: &mut Context<'_>, measure: &Measure, span: &Span, what: &str) -> Option<()> {
    let asks = nature(measure, &cx.natures);
    let d = if asks.forces {
        Diagnostic::error(
            "force-depends-on-force",
            format!("{what} cannot depend on a force that depends on it"),
        )
        .at(span.clone(), "asks for a force")
        .help("let it depend on the motion, or write what rubs under [friction] and what yields under [springs]")
    } else if asks.motion {
        Diagnostic::error(
            "not-at-one-instant",
            format!("{what} is a value at every instant, not one over the whole motion"),
        )
        .at(span.clone(), "a number over the whole motion")
        .help("min, max, mean, range, stroke, at and time_ratio of a motion have no place here")
    } else if asks.inner_rate {
        Diagnostic::error(
            "not-at-one-instant",
            "the rate of a pressure or a switch is not known while the motion is being found",
        )
        .at(span.clone(), "asks for such a rate")
        .help("go by the pressure itself, or by speeds")
    } else {
        return Some(());
    };
    cx.push(d);
    None
}

/// A table from a file beside the model.
fn card(cx: &mut Context<'_>, table: &Entry<'_>, dimension: Dimension) -> Option<Amount> {
    let place = &table.place;
    let file = table.required_like(cx, "table", table.example_of("table"));
    let over = table
        .required_like(cx, "over", table.example_of("over"))
        .and_then(|node| over(cx, table, node));
    let (factor, factor_is) = match table.get("factor") {
        None => (Expr::Const(1.0), Dimension::NONE),
        Some(node) => cx.inferred(node, Dimension::NONE)?,
    };
    let (file, (over, over_dimension)) = (file?, over?);
    let period = match table.get("period") {
        None => None,
        Some(node) => {
            let period = cx.positive(node, over_dimension, "the period", false)?;
            Some((cx.settle(&period), node))
        }
    };
    let mut ask = |key: &str, number: usize, dimension: Dimension| {
        let (pick, span) = column_name(cx, table, key)?
            .unwrap_or_else(|| (Pick::Number(number), file.span.clone()));
        Some(Ask {
            pick,
            span,
            dimension,
        })
    };
    let argument = ask("argument", 0, over_dimension);
    let value = ask("value", 1, (dimension / factor_is).without_idle_angle());
    let (at, values) = columns(cx, file, [&argument?, &value?], &WORDS)?;
    let span = at.last().unwrap_or(&0.0) - at.first().unwrap_or(&0.0);
    if let Some((period, node)) = period
        && span > period * (1.0 + 1e-9)
    {
        let (span, period) = (
            cx.show(span, over_dimension),
            cx.show(period, over_dimension),
        );
        cx.push(
            Diagnostic::error(
                "contradictory-values",
                format!("{place} is longer than its period"),
            )
            .at(node.span.clone(), format!("a period of {period}"))
            .see(file.span.clone(), format!("goes over {span}"))
            .help("the table holds one period: leave the rest out, or give the longer period"),
        );
        return None;
    }
    Some(Amount::Table {
        over: Box::new(over),
        over_dimension,
        at,
        values,
        period: period.map(|(period, _)| period),
        factor,
    })
}

/// What a table goes by.
fn over<'d>(
    cx: &mut Context<'_>,
    table: &Entry<'d>,
    node: &'d Node,
) -> Option<(Measure, Dimension)> {
    let text = table.text(cx, "over", node)?;
    let checked: Result<_, Vec<Issue>> =
        parse(&text.content).and_then(|tree| check(&tree, &mut Measures(cx)));
    match checked {
        Ok((measure, dimension)) => {
            instant(cx, &measure, &node.span, "what a table goes by")?;
            Some((measure, dimension))
        }
        Err(issues) => {
            cx.issues(text, issues);
            None
        }
    }
}
