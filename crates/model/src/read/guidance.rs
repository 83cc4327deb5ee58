//! Studies that ask for linkages that guide a body.
//!
//! ```toml
//! [studies.guide]
//! kind   = "synthesize"
//! task   = "motion"
//! poses  = [[0, 0, "0 deg"], [12, 6, "20 deg"], [20, 18, "55 deg"]]
//! crank  = { moving = [-10, 5] }
//! rocker = { moving = [8, 5] }
//! ```

use kempe_units::Dimension;

use crate::diagnostic::Diagnostic;
use crate::ids::Scalar;
use crate::key_table::synthesis::{DYAD, LINKAGES};
use crate::node::Node;
use crate::read::algebra::place_in_xy;
use crate::read::context::Context;
use crate::read::entry::Entry;
use crate::synthesis::{DyadGiven, GuidanceTask, LinkageKind, WantedPose};

/// The fewest poses between which there is a motion.
const FEWEST: usize = 2;

pub(crate) fn read(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<GuidanceTask> {
    let linkage = entry.choice(cx, "linkage", &LINKAGES);
    let kind = linkage.flatten();
    // Which keys mean nothing, and why.
    let crank = dyad(cx, entry, "crank", (&["along"], "a crank has two pins"));
    let of_rocker: (&[&str], &str) = match kind {
        Some(LinkageKind::FourBar) => (&["along"], "a four-bar has no guide"),
        Some(LinkageKind::SliderCrank) => (&["fixed", "fixed_on"], "a slider has no fixed pivot"),
        Some(LinkageKind::InvertedSliderCrank) => {
            (&["moving", "moving_on"], "a slot has no moving pivot")
        }
        None => (&[], ""),
    };
    let rocker = dyad(cx, entry, "rocker", of_rocker);
    let pivots_in = corners(cx, entry, "pivots_in");
    let pins_in = corners(cx, entry, "pins_in");
    let node = entry.required(cx, "poses")?;
    let poses = poses(cx, entry, node);
    Some(GuidanceTask {
        poses: poses?,
        linkage: linkage?,
        dyads: [crank?, rocker?],
        pivots_in: pivots_in?,
        pins_in: pins_in?,
        span: node.span.clone(),
    })
}

fn poses(cx: &mut Context<'_>, entry: &Entry<'_>, node: &Node) -> Option<Vec<WantedPose>> {
    let place = entry.place_of("poses");
    let mut found = Vec::new();
    let items = cx.array(node, &place, entry.example_of("poses"))?;
    for pose in items {
        let values = cx.array(pose, "a pose", "[12, 6, \"20 deg\"]")?;
        let [x, y, angle] = values else {
            let message = format!("a pose of {place} has {} values", values.len());
            let help = "write [x, y, angle]: the place of the body's origin, and its angle";
            return cx.refuse("wrong-type", message, &pose.span, help);
        };
        let (x, y) = (
            cx.scalar(x, Dimension::LENGTH),
            cx.scalar(y, Dimension::LENGTH),
        );
        let angle = cx.scalar(angle, Dimension::ANGLE);
        if let (Some(x), Some(y), Some(angle)) = (x, y, angle) {
            found.push(WantedPose {
                origin: [x, y],
                angle,
                span: pose.span.clone(),
            });
        }
    }
    if items.len() < FEWEST {
        return cx.refuse(
            "missing-key",
            format!(
                "{place} are {}: there is no way from one to another",
                items.len()
            ),
            &node.span,
            format!("write poses = {}", entry.example_of("poses")),
        );
    }
    (found.len() == items.len()).then_some(found)
}

/// What is given of a dyad; nothing where its key is not there.
pub(crate) fn dyad(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    key: &str,
    (idle, why): (&[&str], &str),
) -> Option<DyadGiven> {
    let Some((name, node)) = entry.entry(key) else {
        return Some(DyadGiven::default());
    };
    let inner = Entry::inner(cx, node, &name.span, entry.place_of(key), &DYAD)?;
    let fixed = point(cx, &inner, "fixed");
    let fixed_on = line(cx, &inner, "fixed_on");
    let moving = point(cx, &inner, "moving");
    let moving_on = line(cx, &inner, "moving_on");
    let along = inner.value(cx, "along");
    if let Some((idle, _)) = idle.iter().find_map(|key| inner.entry(key)) {
        return cx.refuse(
            "bad-choice",
            format!("{why}: `{}` of {} can be nothing", idle.name, inner.place),
            &idle.span,
            "leave it out, or ask for another `linkage`",
        );
    }
    for [point, line] in [["fixed", "fixed_on"], ["moving", "moving_on"]] {
        if inner.has(point) && inner.has(line) {
            inner.contradiction(
                cx,
                &[point, line],
                "a pivot has a place, or lies anywhere on a line",
                "leave one of them out",
            );
            return None;
        }
    }
    Some(DyadGiven {
        fixed: fixed?,
        fixed_on: fixed_on?,
        moving: moving?,
        moving_on: moving_on?,
        along: along?,
        span: node.span.clone(),
    })
}

fn place(cx: &mut Context<'_>, node: &Node, what: &str) -> Option<[Scalar; 2]> {
    place_in_xy(&cx.place(node, what)?)
}

/// A point that may be given; the outer `None` where it is wrong.
fn point(cx: &mut Context<'_>, entry: &Entry<'_>, key: &str) -> Option<Option<[Scalar; 2]>> {
    let Some(node) = entry.get(key) else {
        return Some(None);
    };
    place(cx, node, &entry.place_of(key)).map(Some)
}

/// Two points that may be given; the outer `None` where they are wrong.
pub(crate) fn corners(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    key: &str,
) -> Option<Option<[[Scalar; 2]; 2]>> {
    let Some(node) = entry.get(key) else {
        return Some(None);
    };
    let (first, second) = entry.two(cx, node, key)?;
    let what = entry.place_of(key);
    let (first, second) = (place(cx, first, &what), place(cx, second, &what));
    Some(Some([first?, second?]))
}

/// Two points of a line that may be given; the outer `None` where they are wrong.
fn line(cx: &mut Context<'_>, entry: &Entry<'_>, key: &str) -> Option<Option<[[Scalar; 2]; 2]>> {
    let both = corners(cx, entry, key)?;
    if let (Some([first, second]), Some(node)) = (&both, entry.get(key)) {
        let apart = |k: usize| cx.number(&first[k]) != cx.number(&second[k]);
        if !apart(0) && !apart(1) {
            cx.push(
                Diagnostic::error("bad-size", "both points of a line are the same")
                    .at(node.span.clone(), "")
                    .help(format!("write {key} = {}", entry.example_of(key))),
            );
            return None;
        }
    }
    Some(both)
}
