//! `[measures]`: named measures, and those written in a study.

use std::collections::BTreeMap;

use kempe_units::{Dimension, check, parse};

use crate::diagnostic::Diagnostic;
use crate::measure::Measure;
use crate::measure::NamedMeasure;
use crate::node::{Key, Node, Text};
use crate::read::context::{Context, MeasureState};
use crate::read::measure_names::Measures;
use crate::read::nature::{Nature, nature};
use crate::read::parameters::{chain, put_in_order};

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
    cx.natures = vec![Nature::default(); entries.len()];
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
    let mut read: Vec<Option<NamedMeasure>> = (0..entries.len()).map(|_| None).collect();
    for i in order {
        let (Some(Some((text, tree))), Some((key, _))) = (texts.get(i), entries.get(i)) else {
            continue;
        };
        match check(tree, &mut Measures(cx)) {
            Ok((measure, dimension)) => {
                let nature = nature(&measure, &cx.natures);
                if let Some(slot) = cx.natures.get_mut(i) {
                    *slot = nature;
                }
                if let (Some(state), Some(slot)) = (cx.measures.get_mut(i), read.get_mut(i)) {
                    // with a broken one among them there is no model: places are those of the file
                    *state = MeasureState::Sound(i, dimension);
                    *slot = Some(NamedMeasure {
                        needs_forces: nature.forces,
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

/// A measure written in a study: the name of one, or an expression. `None` when it is broken.
pub(crate) fn measure_text(cx: &mut Context<'_>, text: &Text) -> Option<(Measure, Dimension)> {
    match parse(&text.content).and_then(|tree| check(&tree, &mut Measures(cx))) {
        Ok(found) => Some(found),
        Err(issues) => {
            cx.issues(text, issues);
            None
        }
    }
}
