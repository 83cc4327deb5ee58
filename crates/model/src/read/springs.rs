//! `[springs]` and `[dampers]`: forces between two points, torques between two links.
//!
//! ```toml
//! [springs]
//! return = { between = "A-B", stiffness = "2 N/mm", free = "80 mm" }
//! strut  = { between = "A-B", stiffness = 0, preload = "-300 N" }         # a gas spring: a constant push
//! door   = { links = ["frame", "lever"], stiffness = "3 N m/rad", free = "20 deg", preload = "1 N m" }
//! buffer = { between = "A-B", stiffness = "2 N/mm", free = "80 mm", acts = "tension", stops = ["60 mm", "none"], stop_stiffness = "500 N/mm" }
//! [dampers]
//! closer = { between = "A-B", damping = "50 N s/m", closing = "200 N s/m" }
//! ```
//!
//! A spring pulls with `preload + stiffness * (length - free)`; a torsion spring turns its second link back against the
//! first. Below the first stop and above the second `stop_stiffness` acts besides; `"none"` where there is no stop.

use kempe_units::{Dimension, Expr};

use crate::diagnostic::Diagnostic;
use crate::document::{Key, Node, Value};
use crate::load::{Acts, Between, Damper, Spring};
use crate::model::{LinkPointRef, Scalar};
use crate::read::context::Context;
use crate::read::entry::{Entry, link_of};
use crate::read::names::{is_small_name, long_name};

/// Keys of a spring.
pub(crate) const SPRING_KEYS: &[&str] = &[
    "between",
    "links",
    "stiffness",
    "free",
    "preload",
    "acts",
    "stops",
    "stop_stiffness",
];

/// Keys of a damper.
pub(crate) const DAMPER_KEYS: &[&str] = &["between", "links", "damping", "closing"];

/// In which sense a spring may act.
pub(crate) const ACTS: &[(&str, Acts)] = &[
    ("both", Acts::Both),
    ("tension", Acts::Tension),
    ("compression", Acts::Compression),
];

const SPRING: &str = "return = { between = \"A-B\", stiffness = \"2 N/mm\", free = \"80 mm\" }";
const DAMPER: &str = "closer = { between = \"A-B\", damping = \"50 N s/m\" }";

const TORSION_SPRING: &str =
    "door = { links = [\"frame\", \"lever\"], stiffness = \"3 N m/rad\", free = \"20 deg\" }";
const TORSION_DAMPER: &str = "hinge = { links = [\"frame\", \"lever\"], damping = \"0.1 N m s\" }";

/// A file has at most so many of each.
const MAX: usize = 10_000;

/// Reads all springs.
pub(crate) fn read_springs(cx: &mut Context<'_>, entries: &[&(Key, Node)]) {
    for entry in cx.limited(entries, MAX, "springs") {
        plain_name(cx, &entry.0, "a spring");
        let spring = read_spring(cx, entry);
        let place = spring
            .as_ref()
            .map(|spring| (cx.model.actions.springs.len(), tension(&spring.between)));
        cx.springs.insert(entry.0.name.clone(), place);
        cx.model.actions.springs.extend(spring);
    }
}

/// Reads all dampers.
pub(crate) fn read_dampers(cx: &mut Context<'_>, entries: &[&(Key, Node)]) {
    for entry in cx.limited(entries, MAX, "dampers") {
        plain_name(cx, &entry.0, "a damper");
        let damper = read_damper(cx, entry);
        let place =
            (damper.as_ref()).map(|d| (cx.model.actions.dampers.len(), tension(&d.between)));
        cx.dampers.insert(entry.0.name.clone(), place);
        cx.model.actions.dampers.extend(damper);
    }
}

/// What something between two ends gives.
pub(crate) fn tension(between: &Between) -> Dimension {
    match between {
        Between::Points(..) => Dimension::FORCE,
        Between::Links(..) => Dimension::TORQUE,
    }
}

/// Tells a name that only a point may have, or none.
pub(crate) fn plain_name(cx: &mut Context<'_>, key: &Key, what: &str) {
    if long_name(cx, &key.name, &key.span) || is_small_name(&key.name) {
        return;
    }
    cx.push(
        Diagnostic::error("bad-name", format!("`{}` cannot name {what}", key.name))
            .at(key.span.clone(), "")
            .help("a name starts with a small letter and goes on with letters, digits and _"),
    );
}

fn read_spring(cx: &mut Context<'_>, entry: &(Key, Node)) -> Option<Spring> {
    let mut entry = Entry::new(cx, entry, "spring", SPRING, SPRING_KEYS)?;
    let between = between(cx, &entry)?;
    if matches!(between, Between::Links(..)) {
        entry.example = TORSION_SPRING;
    }
    let (travel, per, force) = match between {
        Between::Points(..) => (Dimension::LENGTH, Dimension::STIFFNESS, Dimension::FORCE),
        Between::Links(..) => (
            Dimension::ANGLE,
            Dimension::TORSIONAL_STIFFNESS,
            Dimension::TORQUE,
        ),
    };
    let preload = entry.scalar(cx, "preload", force);
    // without stiffness it is a constant force, but not without any
    let constant = entry.table.get("preload").is_some();
    let stiffness = entry.required_positive(cx, "stiffness", per, constant);
    let no_rate = constant && stiffness.as_ref().is_some_and(|k| cx.number(k) == 0.0);
    let free = if no_rate && entry.table.get("free").is_none() {
        Some(Expr::Const(0.0))
    } else if travel == Dimension::LENGTH {
        entry.required_positive(cx, "free", travel, true)
    } else {
        entry
            .required(cx, "free")
            .and_then(|node| cx.scalar(node, travel))
    };
    let acts = entry.choice(cx, "acts", ACTS);
    let stops = stops(cx, &entry, travel);
    let stop_stiffness = entry.positive(cx, "stop_stiffness", per, false);
    entry.idle(cx, &["stop_stiffness"], "stops");
    if entry.table.get("stops").is_some() {
        let (place, span) = (&entry.place, &entry.key.span);
        let example = match travel == Dimension::LENGTH {
            true => "\"500 N/mm\"",
            false => "\"1 N m/deg\"",
        };
        cx.required(entry.table, "stop_stiffness", place, span, example)?;
    }
    Some(Spring {
        name: entry.key.name.clone(),
        between,
        stiffness: stiffness?,
        free: free?,
        preload: preload?.unwrap_or(Expr::Const(0.0)),
        stops: stops?,
        stop_stiffness: stop_stiffness?,
        acts: acts?.unwrap_or_default(),
        span: entry.key.span.clone(),
    })
}

fn stops(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    travel: Dimension,
) -> Option<[Option<Scalar>; 2]> {
    let Some(node) = entry.table.get("stops") else {
        return Some([None, None]);
    };
    let (low, high) = entry.two(cx, node, "stops")?;
    let mut one = |node: &Node| match &node.value {
        Value::Text(text) if text.content.trim() == "none" => Some(None),
        _ => cx.scalar(node, travel).map(Some),
    };
    let (low, high) = (one(low), one(high));
    let (low, high) = (low?, high?);
    if let (Some(low), Some(high)) = (&low, &high)
        && cx.number(low) >= cx.number(high)
    {
        entry.contradiction(
            cx,
            ["stops", ""],
            "the lower stop is not below the upper one",
            "the first stop is the lower one; where there is none, write \"none\"",
        );
        return None;
    }
    Some([low, high])
}

fn read_damper(cx: &mut Context<'_>, entry: &(Key, Node)) -> Option<Damper> {
    let mut entry = Entry::new(cx, entry, "damper", DAMPER, DAMPER_KEYS)?;
    let between = between(cx, &entry)?;
    if matches!(between, Between::Links(..)) {
        entry.example = TORSION_DAMPER;
    }
    let per = match between {
        Between::Points(..) => Dimension::DAMPING,
        Between::Links(..) => Dimension::TORSIONAL_DAMPING,
    };
    // a closer may damp one way only
    let one_way = entry.table.get("closing").is_some();
    let damping = entry.required_positive(cx, "damping", per, one_way);
    let closing = entry.positive(cx, "closing", per, true);
    Some(Damper {
        name: entry.key.name.clone(),
        between,
        damping: damping?,
        closing: closing?,
        span: entry.key.span.clone(),
    })
}

/// Two points that are not on one link, or two links.
fn between(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<Between> {
    let place = &entry.place;
    match (entry.table.get("between"), entry.table.entry("links")) {
        (None, None) => {
            cx.push(
                Diagnostic::error("missing-key", format!("{place}: between what does it act?"))
                    .at(entry.key.span.clone(), "")
                    .help("between = \"A-B\" names two points; links = [\"frame\", \"lever\"] makes it act between two links, about their pin"),
            );
            None
        }
        (Some(_), Some((key, _))) => {
            cx.push(
                Diagnostic::error(
                    "over-specified",
                    format!("{place} has both `between` and `links`"),
                )
                .at(key.span.clone(), "")
                .help("two points for one that pulls and pushes, two links for one that turns"),
            );
            None
        }
        (Some(node), None) => points(cx, entry, node),
        (None, Some((_, node))) => {
            let (a, b) = entry.two(cx, node, "links")?;
            let what = format!("`links` of {place}");
            let (first, second) = (link_of(cx, a, &what), link_of(cx, b, &what));
            let (first, second) = (first?, second?);
            if first == second {
                let name = cx.link_name(first).to_owned();
                cx.push(
                    Diagnostic::error(
                        "same-link",
                        format!("{place} is between link `{name}` and itself"),
                    )
                    .at(node.span.clone(), "")
                    .help("name two different links; the frame is one too"),
                );
                return None;
            }
            Some(Between::Links(first, second))
        }
    }
}

fn points(cx: &mut Context<'_>, entry: &Entry<'_>, node: &Node) -> Option<Between> {
    let place = &entry.place;
    let text = cx.text(node, &format!("`between` of {place}"), "\"A-B\"")?;
    let (a, b) = cx.pair_phrase(text)?;
    if a == b {
        let name = cx.point_name(a).to_owned();
        cx.push(
            Diagnostic::error("same-link", format!("{place} is between {name} and itself"))
                .at(node.span.clone(), "")
                .help("name two points of different links"),
        );
        return None;
    }
    let common = cx
        .carriers(a)
        .iter()
        .find(|l| cx.carriers(b).binary_search(l).is_ok())
        .copied();
    if let Some(link) = common {
        let (a, b) = (cx.point_name(a).to_owned(), cx.point_name(b).to_owned());
        let link = cx.link_name(link).to_owned();
        cx.push(
            Diagnostic::error(
                "same-link",
                format!(
                    "{place}: {a} and {b} are both on `{link}`, so their distance cannot change"
                ),
            )
            .at(node.span.clone(), "")
            .help("name two points that no link has in common"),
        );
        return None;
    }
    let end = |point| {
        Some(LinkPointRef {
            link: *cx.carriers(point).first()?,
            point,
        })
    };
    Some(Between::Points(end(a)?, end(b)?))
}
