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

use std::f64::consts::TAU;

use kempe_units::{Dimension, Expr};

use crate::bound::Keeps;
use crate::diagnostic::Diagnostic;
use crate::ids::Scalar;
use crate::key_table::{ACTS, DAMPER, SPRING};
use crate::keys::Sign;
use crate::load::{Between, Damper, Spring};
use crate::node::{Key, Node};
use crate::read::context::Context;
use crate::read::ends::ends;
use crate::read::entry::Entry;
use crate::read::names::{is_small_name, long_name};

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
    let (key, _) = entry;
    let mut entry = Entry::new(cx, entry, &SPRING)?;
    let between = between(cx, &mut entry, TORSION_SPRING)?;
    let preload = entry.value_or(cx, "preload", 0.0);
    // without stiffness it is a constant force, but not without any
    let constant = entry.has("preload");
    let stiffness = strength(cx, &entry, "stiffness", constant);
    let no_rate = constant && stiffness.as_ref().is_some_and(|k| cx.number(k) == 0.0);
    let free = if no_rate && !entry.has("free") {
        Some(Expr::Const(0.0))
    } else {
        let sign = if entry.turning {
            Sign::Any
        } else {
            Sign::NotNegative
        };
        let node = entry.required(cx, "free");
        node.and_then(|node| {
            let free = entry.signed(cx, "free", node, sign)?;
            match entry.turning {
                true => within_a_turn(cx, &entry, free, node),
                false => Some(free),
            }
        })
    };
    let acts = entry.choice(cx, "acts", &ACTS);
    let stops = stops(cx, &entry);
    let stop_stiffness = entry.value(cx, "stop_stiffness");
    entry.idle(cx, &["stop_stiffness"], "stops");
    if entry.has("stops") {
        let example = match entry.turning {
            false => entry.example_of("stop_stiffness"),
            true => "\"1 N m/deg\"",
        };
        entry.required_like(cx, "stop_stiffness", example)?;
    }
    Some(Spring {
        name: key.name.clone(),
        between,
        stiffness: stiffness?,
        free: free?,
        preload: preload?,
        stops: stops?,
        stop_stiffness: stop_stiffness?,
        acts: acts?.unwrap_or_default(),
        span: key.span.clone(),
    })
}

/// The free angle of a torsion spring: its angle starts within half a turn of it, so that whole turns would tell nothing.
fn within_a_turn(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    free: Scalar,
    node: &Node,
) -> Option<Scalar> {
    let (what, dimension) = (entry.place_of("free"), Dimension::ANGLE);
    cx.bound(&free, &node.span, &what, dimension, Keeps::WithinATurn);
    let x = cx.number(&free);
    if x.abs() < TAU {
        return Some(free);
    }
    let found = cx.show(x, dimension);
    let message = format!("{what} must be less than a whole turn, found {found}");
    let help = "a spring that is wound has `preload`, its torque at `free`: give the stiffness times what it is wound by";
    cx.refuse("wound-spring", message, &node.span, help)
}

/// How strong it is. A plain number that does nothing is a mistake, unless `zero` may be; parameters may lead there.
fn strength(cx: &mut Context<'_>, entry: &Entry<'_>, key: &str, zero: bool) -> Option<Scalar> {
    let node = entry.required(cx, key)?;
    let dimension = entry.dimension(key);
    let strength = cx.scalar(node, dimension)?;
    let zero = zero || strength.leaves().next().is_some();
    cx.sized(strength, &node.span, dimension, &entry.place_of(key), zero)
}

fn stops(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<[Option<Scalar>; 2]> {
    let [low, high] = entry.bounds(cx, "stops")?.unwrap_or([None, None]);
    if let (Some(low), Some(high)) = (&low, &high)
        && cx.number(low) >= cx.number(high)
    {
        entry.contradiction(
            cx,
            &["stops"],
            "the lower stop is not below the upper one",
            "the first stop is the lower one; where there is none, write \"none\"",
        );
        return None;
    }
    Some([low, high])
}

fn read_damper(cx: &mut Context<'_>, entry: &(Key, Node)) -> Option<Damper> {
    let (key, _) = entry;
    let mut entry = Entry::new(cx, entry, &DAMPER)?;
    let between = between(cx, &mut entry, TORSION_DAMPER)?;
    // a closer may damp one way only
    let damping = strength(cx, &entry, "damping", entry.has("closing"));
    let closing = entry.value(cx, "closing");
    Some(Damper {
        name: key.name.clone(),
        between,
        damping: damping?,
        closing: closing?,
        span: key.span.clone(),
    })
}

/// Two points that are not on one link, or two links: then the entry is about what turns, as `torsion` shows.
fn between(cx: &mut Context<'_>, entry: &mut Entry<'_>, torsion: &'static str) -> Option<Between> {
    let place = &entry.place;
    match (entry.get("between"), entry.entry("links")) {
        (None, None) if entry.misspelt("between") || entry.misspelt("links") => None,
        (None, None) => {
            let help = "between = \"A-B\" names two points; links = [\"frame\", \"lever\"] makes it act between two links, about their pin";
            let message = format!("{place}: between what does it act?");
            cx.refuse("missing-key", message, entry.span, help)
        }
        (Some(_), Some((key, _))) => {
            let help = "two points for one that pulls and pushes, two links for one that turns";
            let message = format!("{place} has both `between` and `links`");
            cx.refuse("over-specified", message, &key.span, help)
        }
        (Some(node), None) => points(cx, entry, node),
        (None, Some(_)) => {
            entry.idle(cx, &["on"], "between");
            let ((first, second), node) = entry.two_links(cx, "links")?;
            if first == second {
                let name = cx.link_name(first).to_owned();
                let message = format!("{place} is between link `{name}` and itself");
                let help = "name two different links; the frame is one too";
                return cx.refuse("same-link", message, &node.span, help);
            }
            entry.turning = true;
            entry.example = torsion;
            Some(Between::Links(first, second))
        }
    }
}

fn points<'d>(cx: &mut Context<'_>, entry: &Entry<'d>, node: &'d Node) -> Option<Between> {
    let place = &entry.place;
    let text = entry.text(cx, "between", node)?;
    let (a, b) = cx.pair_phrase(text)?;
    if a == b {
        let name = cx.point_name(a).to_owned();
        return cx.refuse(
            "same-link",
            format!("{place} is between {name} and itself"),
            &node.span,
            "name two points of different links",
        );
    }
    let common = cx
        .carriers(a)
        .iter()
        .find(|l| cx.carriers(b).binary_search(l).is_ok())
        .copied();
    if let Some(link) = common {
        let (a, b) = (cx.point_name(a).to_owned(), cx.point_name(b).to_owned());
        let link = cx.link_name(link).to_owned();
        return cx.refuse(
            "same-link",
            format!("{place}: {a} and {b} are both on `{link}`, so their distance cannot change"),
            &node.span,
            "name two points that no link has in common",
        );
    }
    let ([a, b], warning) = ends(cx, entry, [a, b])?;
    cx.found.extend(warning);
    Some(Between::Points(a, b))
}
