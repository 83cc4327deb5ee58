//! `plot = [...]` of a study: curves, paths, hodographs.

use kempe_units::{Kind, parse};

use crate::diagnostic::Diagnostic;
use crate::motion_study::{Column, Hodograph, Plot};
use crate::node::{Node, Text, Value};
use crate::read::column::column;
use crate::read::context::Context;
use crate::read::measure_names::{Call, Measures};

/// A plot: a measure, several of one dimension in brackets, `path(P)` or `hodograph(B)`.
pub(crate) fn plot(cx: &mut Context<'_>, node: &Node, forces: bool) -> Option<Plot> {
    if let Value::Array(together) = &node.value {
        return curves(cx, node, together, forces);
    }
    let example = "\"angle(rocker)\", \"path(P)\" or several measures in brackets";
    let text = cx.text(node, "a plot", example)?;
    if let Ok(tree) = parse(&text.content)
        && let Kind::Call {
            function,
            arguments,
            ..
        } = &tree.kind
    {
        let call = Call {
            function,
            arguments,
            span: tree.span.clone(),
        };
        match function.as_str() {
            "path" => return path(cx, text, &call),
            "hodograph" => return hodograph(cx, text, &call, forces),
            _ => {}
        }
    }
    column(cx, node, forces).map(|column| Plot::Curves(vec![column]))
}

fn path(cx: &mut Context<'_>, text: &Text, call: &Call<'_>) -> Option<Plot> {
    if let [point] = call.arguments
        && let Some(name) = point.as_point()
    {
        return cx
            .point(name, text.span(point.span.clone()))
            .map(Plot::Path);
    }
    cx.push(
        Diagnostic::error("wrong-arguments", "`path` draws the path of one point")
            .at(text.span(call.span.clone()), "")
            .help("write path(P)"),
    );
    None
}

fn hodograph(cx: &mut Context<'_>, text: &Text, call: &Call<'_>, forces: bool) -> Option<Plot> {
    let name = text.content.trim().to_owned();
    if !forces {
        cx.push(
            Diagnostic::error(
                "needs-forces-study",
                format!("a motion study does not know `{name}`"),
            )
            .at(text.span(call.span.clone()), "asks for a force")
            .help("forces belong to a study of their own: kind = \"forces\""),
        );
        return None;
    }
    let (joint, link) = match call.arguments {
        [joint] => (joint, None),
        [joint, link] => (joint, Some(link)),
        _ => {
            cx.push(
                Diagnostic::error(
                    "wrong-arguments",
                    "`hodograph` draws the force of one joint",
                )
                .at(text.span(call.span.clone()), "")
                .help("write hodograph(B), hodograph(B, coupler) or the name of a joint for B"),
            );
            return None;
        }
    };
    match Measures(cx).joint(call, joint, link) {
        Ok(joint) => Some(Plot::Hodograph(Hodograph { name, joint })),
        Err(issues) => {
            cx.issues(text, issues);
            None
        }
    }
}

/// Measures that share a picture, and so an axis.
fn curves(cx: &mut Context<'_>, whole: &Node, together: &[Node], forces: bool) -> Option<Plot> {
    let columns: Vec<Column> = together
        .iter()
        .filter_map(|node| column(cx, node, forces))
        .collect();
    let Some(first) = columns.first() else {
        if together.is_empty() {
            cx.push(
                Diagnostic::error("missing-key", "a picture without a curve")
                    .at(whole.span.clone(), "")
                    .help(
                        "write the measures that share it: [\"force(lift)\", \"capacity(lift)\"]",
                    ),
            );
        }
        return None;
    };
    if let Some(other) = columns
        .iter()
        .find(|c| !c.dimension.compatible(first.dimension))
    {
        cx.push(
            Diagnostic::error(
                "unit-mismatch",
                format!(
                    "one picture for {} and {}",
                    first.dimension.with_article(),
                    other.dimension.with_article()
                ),
            )
            .at(whole.span.clone(), "curves of one picture share its axis")
            .help(format!("plot `{}` by itself", other.name)),
        );
        return None;
    }
    (columns.len() == together.len()).then_some(Plot::Curves(columns))
}
