//! `[measures]`: named measures, and those written in a study.

use std::collections::BTreeMap;

use kempe_units::{Dimension, Issue, check, parse};

use crate::diagnostic::Diagnostic;
use crate::document::{Key, Node, Text};
use crate::measure::Measure;
use crate::model::NamedMeasure;
use crate::read::context::{Context, MeasureState};
use crate::read::measure_names::{Measures, NOT_AVAILABLE};
use crate::read::parameters::{chain, put_in_order};
use crate::registry::Registry;

/// A file has at most so many measures.
const MAX_MEASURES: usize = 10_000;

/// Reads all named measures.
pub(crate) fn read(cx: &mut Context<'_>, entries: &[&(Key, Node)]) {
    let entries = cx.limited(entries, MAX_MEASURES, "measures");
    let index: BTreeMap<&str, usize> = entries
        .iter()
        .enumerate()
        .map(|(i, (k, _))| (k.name.as_str(), i))
        .collect();
    cx.measures = vec![MeasureState::Broken; entries.len()];
    let mut texts: Vec<Option<(&Text, kempe_units::Node)>> = Vec::with_capacity(entries.len());
    for (key, node) in entries {
        let text = cx.text(
            node,
            &format!("measure `{}`", key.name),
            "\"angle(rocker)\"",
        );
        let tree = text.and_then(|text| match parse(&text.content) {
            Ok(tree) => Some((text, tree)),
            Err(issues) => {
                cx.issues(text, issues);
                None
            }
        });
        texts.push(tree);
    }
    let needs: Vec<Vec<usize>> = texts
        .iter()
        .map(|t| {
            t.iter()
                .flat_map(|(_, tree)| tree.names())
                .filter_map(|(n, _)| index.get(n).copied())
                .collect()
        })
        .collect();
    let needs: Vec<&[usize]> = needs.iter().map(Vec::as_slice).collect();
    let (order, circles) = put_in_order(&needs);
    for circle in &circles {
        tell_circle(cx, entries, circle);
    }
    // what this version has not got is left out, and so is what builds on it
    let mut left_out = vec![false; entries.len()];
    for i in &order {
        let announced = texts
            .get(*i)
            .and_then(Option::as_ref)
            .and_then(|(_, tree)| announced(tree));
        let follows = needs
            .get(*i)
            .is_some_and(|n| n.iter().any(|j| left_out.get(*j) == Some(&true)));
        if announced.is_none() && !follows {
            continue;
        }
        if let (Some(flag), Some(state), Some((key, _))) = (
            left_out.get_mut(*i),
            cx.measures.get_mut(*i),
            entries.get(*i),
        ) {
            *flag = true;
            *state = MeasureState::NotAvailable;
            let because = announced
                .map_or("it builds on a measure that is left out".to_owned(), |f| {
                    format!("this version does not compute `{f}`")
                });
            cx.push(
                Diagnostic::warning(
                    "measure-not-available",
                    format!("measure `{}` is left out", key.name),
                )
                .at(key.span.clone(), because)
                .help("the rest of the file works without it"),
            );
        }
    }
    // places in the model: file order, without those left out
    let mut place = 0;
    let places: Vec<usize> = left_out
        .iter()
        .map(|left_out| {
            let mine = place;
            place += usize::from(!left_out);
            mine
        })
        .collect();
    let mut read: Vec<Option<NamedMeasure>> = (0..entries.len()).map(|_| None).collect();
    for i in order {
        let (Some(Some((text, tree))), Some((key, _))) = (texts.get(i), entries.get(i)) else {
            continue;
        };
        if left_out.get(i) == Some(&true) {
            continue;
        }
        match check(tree, &mut Measures(cx)) {
            Ok((measure, dimension)) => {
                if let (Some(state), Some(slot)) = (cx.measures.get_mut(i), read.get_mut(i)) {
                    *state = MeasureState::Sound(places.get(i).copied().unwrap_or(0), dimension);
                    *slot = Some(NamedMeasure {
                        name: key.name.clone(),
                        measure,
                        dimension,
                        span: key.span.clone(),
                    });
                }
            }
            Err(issues) => cx.issues(text, issues),
        }
    }
    cx.model.measures = read.into_iter().flatten().collect();
}

fn tell_circle(cx: &mut Context<'_>, entries: &[&(Key, Node)], circle: &[usize]) {
    let members: Vec<&(Key, Node)> = circle
        .iter()
        .filter_map(|i| entries.get(*i).copied())
        .collect();
    let names: Vec<&str> = members.iter().map(|(k, _)| k.name.as_str()).collect();
    let Some((first, node)) = members.first().map(|(k, n)| (k.name.as_str(), n)) else {
        return;
    };
    cx.push(
        Diagnostic::error(
            "cyclic-measure",
            format!("measure `{first}` depends on itself"),
        )
        .at(node.span.clone(), "")
        .help("a measure may use other measures, but not in a circle")
        .note(format!("{} -> {first}", chain(&names))),
    );
}

/// The first function of a tree that this version has not got.
fn announced(tree: &kempe_units::Node) -> Option<&'static str> {
    let mut found = None;
    tree.visit(&mut |node| {
        if let kempe_units::Kind::Call { function, .. } = &node.kind {
            found = found.or(Registry::announced()
                .iter()
                .find(|f| *f == function)
                .copied());
        }
    });
    found
}

/// A measure written in a study: the name of one, or an expression. `None` when it is broken or left out.
pub(crate) fn measure_text(cx: &mut Context<'_>, text: &Text) -> Option<(Measure, Dimension)> {
    match parse(&text.content).and_then(|tree| check(&tree, &mut Measures(cx))) {
        Ok(found) => Some(found),
        Err(issues) => {
            let (left_out, wrong): (Vec<Issue>, Vec<Issue>) =
                issues.into_iter().partition(|i| i.code == NOT_AVAILABLE);
            if let Some(issue) = left_out.into_iter().next()
                && wrong.is_empty()
            {
                cx.push(
                    Diagnostic::warning(NOT_AVAILABLE, issue.message)
                        .at(text.span(issue.span), "left out of the study")
                        .help("the rest of the study works without it"),
                );
            }
            cx.issues(text, wrong);
            None
        }
    }
}
