//! `[assembly]`: which of several assemblies is meant, at the start of the drives.

use kempe_units::Dimension;

use crate::diagnostic::Diagnostic;
use crate::drive::{Drive, DriveKind};
use crate::hint::{AssemblyHint, HintKind};
use crate::ids::{FRAME, LinkId, PointId};
use crate::key_table::HINT;
use crate::link::Place;
use crate::node::{Key, Node, Value};
use crate::read::context::{Context, Meaning};
use crate::read::entry::Entry;
use crate::read::names::is_point_name;

/// Reads all hints.
pub(crate) fn read(cx: &mut Context<'_>, entries: &[&(Key, Node)]) {
    for (key, node) in entries {
        let kind = if is_point_name(&key.name) {
            point_hint(cx, key, node)
        } else {
            link_hint(cx, key, node)
        };
        if let Some(kind) = kind {
            cx.model.assembly.push(AssemblyHint {
                kind,
                span: key.span.clone(),
            });
        }
    }
}

fn point_hint(cx: &mut Context<'_>, key: &Key, node: &Node) -> Option<HintKind> {
    let point = cx.point(&key.name, key.span.clone())?;
    if let Value::Text(text) = &node.value {
        let (side, line) = cx.side_phrase(text)?;
        if point == line.from || point == line.to {
            cx.push(
                Diagnostic::error(
                    "bad-side",
                    format!(
                        "{} is an end of this line and lies on neither side of it",
                        key.name
                    ),
                )
                .at(line.span, "")
                .help("name two other points"),
            );
            return None;
        }
        idle_hint(cx, key, &[point, line.from, line.to]);
        return Some(HintKind::Side {
            point,
            side,
            from: line.from,
            to: line.to,
        });
    }
    let near = near(cx, key, node, "\"left of B -> D\" or { near = [173, 151] }")?;
    match cx.place(near, &format!("`near` of {}", key.name))? {
        Place::Cartesian { x, y } => {
            idle_hint(cx, key, &[point]);
            Some(HintKind::NearPlace { point, x, y })
        }
        _ => cx.refuse(
            "wrong-type",
            format!("`near` of {} is a place in the frame, [x, y]", key.name),
            &near.span,
            "write { near = [173, 151] }",
        ),
    }
}

fn link_hint(cx: &mut Context<'_>, key: &Key, node: &Node) -> Option<HintKind> {
    if !matches!(cx.names.get(&key.name), Some((Meaning::Link(_), _))) {
        let known: Vec<String> = cx
            .points
            .keys()
            .chain(cx.model.links.iter().map(|l| &l.name))
            .cloned()
            .collect();
        let d = cx.no_such(
            "point or link",
            &key.name,
            key.span.clone(),
            known.iter().map(String::as_str),
        );
        cx.push(d);
        return None;
    }
    let link = cx.link(&key.name, key.span.clone())?;
    let near = near(cx, key, node, "{ near = \"30 deg\" }")?;
    let angle = cx.scalar(near, Dimension::ANGLE)?;
    if link == FRAME {
        cx.push(
            Diagnostic::warning("idle-hint", "the frame stands still whatever is said of it")
                .at(key.span.clone(), "")
                .help("leave this out"),
        );
    }
    driven_angle(cx, key, link);
    Some(HintKind::NearAngle { link, angle })
}

/// Warns of the angle of a link that a drive turns against the frame.
fn driven_angle(cx: &mut Context<'_>, key: &Key, link: LinkId) {
    let turns = |d: &&Drive| matches!(d.kind, DriveKind::Turn { link: turned, relative_to: FRAME } if turned == link);
    let Some((drive, span)) = cx
        .model
        .drives
        .iter()
        .find(turns)
        .map(|d| (d.name.clone(), d.span.clone()))
    else {
        return;
    };
    cx.push(
        Diagnostic::warning(
            "idle-hint",
            format!(
                "this says nothing about the assembly: drive `{drive}` says the angle of `{}`",
                key.name
            ),
        )
        .at(key.span.clone(), "")
        .see(span, "turns it")
        .help("leave this out: the motion starts where the drive does"),
    );
}

fn near<'n>(
    cx: &mut Context<'_>,
    key: &'n Key,
    node: &'n Node,
    example: &'static str,
) -> Option<&'n Node> {
    let place = format!("the assembly of {}", key.name);
    cx.table(node, &place, example)?;
    let entry = Entry::inner(cx, node, &key.span, place, &HINT)?;
    entry.required_like(cx, "near", "[173, 151], or an angle for a link")
}

/// Warns when all points are on one link (or the frame): then nothing is left to choose.
fn idle_hint(cx: &mut Context<'_>, key: &Key, points: &[PointId]) {
    let Some((first, rest)) = points.split_first() else {
        return;
    };
    let common = cx.carriers(*first).iter().copied().find(|l| {
        (*l == FRAME || !rest.is_empty())
            && rest
                .iter()
                .all(|p| cx.carriers(*p).binary_search(l).is_ok())
    });
    let Some(link) = common else { return };
    let points: Vec<&str> = points.iter().map(|p| cx.point_name(*p)).collect();
    let why = match (link == FRAME, points.as_slice()) {
        (true, [one]) => format!("{one} is a point of the frame, which stands still"),
        (_, many) => format!(
            "{} are points of link `{}`, however it lies",
            many.join(", "),
            cx.link_name(link)
        ),
    };
    cx.push(
        Diagnostic::warning(
            "idle-hint",
            format!("this says nothing about the assembly: {why}"),
        )
        .at(key.span.clone(), "")
        .help("name points of different links, or leave this out"),
    );
}
