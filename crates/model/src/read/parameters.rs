//! `[parameters]`: dimensions of the design, put in an order in which each depends only on earlier ones.

use std::collections::BTreeMap;

use kempe_units::{Dimension, Expr, Issue, check, nearest, parse};

use crate::diagnostic::{Diagnostic, Label, Source};
use crate::geometry::value;
use crate::ids::{ParameterId, Span};
use crate::model::Parameter;
use crate::node::{Key, Node, Text, Value};
use crate::read::context::{Context, Meaning};
use crate::read::value::{ALREADY_TOLD, Parameters};

/// Where a parameter's text comes from.
enum Origin<'d> {
    /// The file.
    File(&'d Text),
    /// `--set`.
    Given(Source),
    /// A bare number.
    Number,
}

struct Draft<'d> {
    key: &'d Key,
    node: &'d Node,
    origin: Origin<'d>,
    tree: Option<kempe_units::Node>,
    /// File numbers of the parameters it names.
    needs: Vec<usize>,
}

/// Reads the parameters, with `overrides` in place of the file's values.
pub(crate) fn read(cx: &mut Context<'_>, entries: &[&(Key, Node)], overrides: &[(String, String)]) {
    let index: BTreeMap<&str, usize> = entries
        .iter()
        .enumerate()
        .map(|(i, (k, _))| (k.name.as_str(), i))
        .collect();
    for (name, text) in overrides
        .iter()
        .filter(|(name, _)| !index.contains_key(name.as_str()))
    {
        unknown_override(cx, name, text, &index);
    }
    let mut drafts: Vec<Draft<'_>> = Vec::with_capacity(entries.len());
    for (key, node) in entries.iter().map(|e| (&e.0, &e.1)) {
        let given = overrides.iter().rev().find(|(name, _)| *name == key.name);
        let mut draft = Draft {
            key,
            node,
            origin: Origin::Number,
            tree: None,
            needs: Vec::new(),
        };
        let content = match (given, &node.value) {
            (Some((name, text)), _) => {
                draft.origin = Origin::Given(Source {
                    name: format!("--set {name}"),
                    text: text.clone(),
                });
                Some(text.as_str())
            }
            (None, Value::Text(text)) => {
                draft.origin = Origin::File(text);
                Some(text.content.as_str())
            }
            (None, Value::Number(_)) => None,
            _ => {
                cx.wrong_type(
                    node,
                    &format!("parameter `{}`", key.name),
                    "a string",
                    "\"20 mm\", or 3 for a plain number",
                );
                None
            }
        };
        match content.map(parse) {
            Some(Ok(tree)) => {
                draft.needs = tree
                    .names()
                    .iter()
                    .filter_map(|(name, _)| index.get(name).copied())
                    .collect();
                draft.tree = Some(tree);
            }
            Some(Err(issues)) => tell(cx, &draft.origin, issues),
            None => {}
        }
        drafts.push(draft);
    }
    let order = order(cx, &drafts);
    for (new, old) in order.iter().enumerate() {
        if let Some(draft) = drafts.get(*old)
            && let Some((Meaning::Parameter(id), _)) = cx.names.get_mut(&draft.key.name)
        {
            *id = ParameterId(new as u32);
        }
    }
    for old in order {
        if let Some(draft) = drafts.get(old) {
            settle(cx, draft);
        }
    }
}

/// Checks one parameter whose predecessors are settled, and enters it.
fn settle(cx: &mut Context<'_>, draft: &Draft<'_>) {
    let checked = match (&draft.tree, &draft.origin, &draft.node.value) {
        (Some(tree), _, _) => check(tree, &mut Parameters(cx)),
        (None, Origin::Number, Value::Number(x)) => Ok((Expr::Const(*x), Dimension::NONE)),
        _ => Err(vec![Issue::new(ALREADY_TOLD, 0..0, "")]),
    };
    let (scalar, dimension, mut sound) = match checked {
        Ok((scalar, dimension)) => (scalar, dimension, true),
        Err(issues) => {
            tell(cx, &draft.origin, issues);
            (Expr::Const(f64::NAN), Dimension::NONE, false)
        }
    };
    let number = value(&scalar, &cx.values);
    if sound && !number.is_finite() {
        let found = if number.is_nan() {
            "not a number"
        } else {
            "infinite"
        };
        let mut d = Diagnostic::error(
            "not-finite",
            format!("parameter `{}` is {found}", draft.key.name),
        )
        .help("look for a division by zero, the root of a negative number or an overflow");
        d.labels.push(whole_label(
            draft,
            format!("{found} with the parameters' values"),
        ));
        cx.push(d);
        sound = false;
    }
    // what the file says is kept in shape by what is given: another dimension would break it elsewhere
    if sound && let Origin::Given(source) = &draft.origin {
        sound = same_dimension(cx, draft, source, dimension);
    }
    cx.model.parameters.push(Parameter {
        name: draft.key.name.clone(),
        value: scalar,
        dimension,
        span: draft.node.span.clone(),
    });
    cx.values.push(number);
    cx.sound.push(sound);
}

/// Whether an override measures what the file's own value measures.
fn same_dimension(
    cx: &mut Context<'_>,
    draft: &Draft<'_>,
    source: &Source,
    dimension: Dimension,
) -> bool {
    let in_file = match &draft.node.value {
        Value::Number(_) => Some(Dimension::NONE),
        Value::Text(text) => parse(&text.content)
            .and_then(|tree| check(&tree, &mut Parameters(cx)))
            .ok()
            .map(|(_, dimension)| dimension),
        _ => None,
    };
    let Some(wanted) = in_file.filter(|d| !d.compatible(dimension)) else {
        return true;
    };
    let mut d = Diagnostic::error(
        "unit-mismatch",
        format!("{wanted} expected, found {}", dimension.with_article()),
    )
    .help(format!(
        "the file says {}: give it like {}",
        wanted.with_article(),
        cx.example(wanted).trim_matches('"')
    ));
    d.labels.push(given_label(
        source,
        0..source.text.len(),
        format!("this is {}", dimension.with_article()),
    ));
    cx.push(d.see(draft.node.span.clone(), wanted.with_article()));
    false
}

fn tell(cx: &mut Context<'_>, origin: &Origin<'_>, issues: Vec<Issue>) {
    match origin {
        Origin::File(text) => cx.issues(text, issues),
        Origin::Given(source) => {
            for issue in issues.into_iter().filter(|i| i.code != ALREADY_TOLD) {
                let mut d = Diagnostic::error(issue.code, issue.message).maybe_help(issue.help);
                d.labels.push(given_label(source, issue.span, issue.label));
                cx.push(d);
            }
        }
        Origin::Number => {}
    }
}

fn given_label(source: &Source, span: Span, text: String) -> Label {
    Label {
        span,
        text,
        primary: true,
        source: Some(source.clone()),
    }
}

fn whole_label(draft: &Draft<'_>, text: String) -> Label {
    match &draft.origin {
        Origin::Given(source) => given_label(source, 0..source.text.len(), text),
        _ => Label {
            span: draft.node.span.clone(),
            text,
            primary: true,
            source: None,
        },
    }
}

fn unknown_override(cx: &mut Context<'_>, name: &str, text: &str, index: &BTreeMap<&str, usize>) {
    let help = match nearest(name, index.keys().copied()) {
        Some(near) => format!("did you mean `{near}`?"),
        None if index.is_empty() => "the file has no [parameters]".to_owned(),
        None => format!(
            "the parameters are {}",
            index.keys().copied().collect::<Vec<_>>().join(", ")
        ),
    };
    let source = Source {
        name: "--set".to_owned(),
        text: format!("{name}={text}"),
    };
    let mut d =
        Diagnostic::error("unknown-name", format!("there is no parameter `{name}`")).help(help);
    d.labels.push(given_label(
        &source,
        0..name.len(),
        "not declared in the file".to_owned(),
    ));
    cx.push(d);
}

/// The parameters' file numbers, each after those it needs; members of a circle are told and stand where they are.
fn order(cx: &mut Context<'_>, drafts: &[Draft<'_>]) -> Vec<usize> {
    let needs: Vec<&[usize]> = drafts.iter().map(|d| d.needs.as_slice()).collect();
    let (order, circles) = put_in_order(&needs);
    for circle in circles {
        let draft = |i: &usize| drafts.get(*i);
        let names: Vec<&str> = circle
            .iter()
            .filter_map(draft)
            .map(|d| d.key.name.as_str())
            .collect();
        let first = names.first().copied().unwrap_or("");
        let mut d = Diagnostic::error("cyclic-parameter", format!("`{first}` depends on itself"))
            .help("give one of them a value of its own")
            .note(format!("{} -> {first}", chain(&names)));
        for (i, draft) in circle.iter().filter_map(draft).take(8).enumerate() {
            let next = names
                .get((i + 1) % names.len().max(1))
                .copied()
                .unwrap_or(first);
            let label = format!("`{}` needs `{next}`", draft.key.name);
            d = if i == 0 {
                d.at(draft.node.span.clone(), label)
            } else {
                d.see(draft.node.span.clone(), label)
            };
        }
        cx.push(d);
    }
    order
}

/// Names with arrows between them; of very many only the first.
pub(crate) fn chain(names: &[&str]) -> String {
    let shown = names.get(..12).unwrap_or(names).join(" -> ");
    if names.len() > 12 {
        format!("{shown} -> …")
    } else {
        shown
    }
}

/// An order in which each comes after what it needs, and the circles that prevent it. Without recursion, because a file may
/// hold a chain of a hundred thousand.
pub(crate) fn put_in_order(needs: &[&[usize]]) -> (Vec<usize>, Vec<Vec<usize>>) {
    #[derive(Clone, Copy, PartialEq)]
    enum State {
        New,
        Open,
        Done,
    }
    let mut state = vec![State::New; needs.len()];
    let (mut order, mut circles) = (Vec::with_capacity(needs.len()), Vec::new());
    for start in 0..needs.len() {
        let mut path: Vec<(usize, usize)> = Vec::new();
        if state[start] == State::New {
            state[start] = State::Open;
            path.push((start, 0));
        }
        while let Some((node, next)) = path.last_mut() {
            let node = *node;
            match needs[node].get(*next).copied() {
                None => {
                    state[node] = State::Done;
                    order.push(node);
                    path.pop();
                }
                Some(need) => {
                    *next += 1;
                    match state.get(need) {
                        Some(State::New) => {
                            state[need] = State::Open;
                            path.push((need, 0));
                        }
                        Some(State::Open) => {
                            let from = path.iter().position(|(n, _)| *n == need).unwrap_or(0);
                            circles.push(path[from..].iter().map(|(n, _)| *n).collect());
                        }
                        _ => {}
                    }
                }
            }
        }
    }
    (order, circles)
}
