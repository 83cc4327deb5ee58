//! `[joints]`: what a shared point name does not say.

use kempe_units::Dimension;

use crate::diagnostic::Diagnostic;
use crate::document::{Key, Node};
use crate::key_table::{JOINTS, SIDES};
use crate::model::{Joint, JointId, JointKind, LinkId, LinkPointRef, PointId, Side};
use crate::read::context::Context;
use crate::read::entry::{Entry, on_link};

/// A file has at most so many joints of its own.
const MAX_JOINTS: usize = 10_000;

/// Reads all joints.
pub(crate) fn read(cx: &mut Context<'_>, entries: &[&(Key, Node)]) {
    for entry in cx.limited(entries, MAX_JOINTS, "joints") {
        let kind = read_joint(cx, entry);
        let id = JointId(cx.model.joints.len() as u32);
        cx.joints.push(kind.is_some().then_some(id));
        if let Some(kind) = kind {
            cx.model.joints.push(Joint {
                name: entry.0.name.clone(),
                kind,
                span: entry.0.span.clone(),
            });
        }
    }
}

fn read_joint(cx: &mut Context<'_>, entry: &(Key, Node)) -> Option<JointKind> {
    let (key, node) = entry;
    let place = format!("joint `{}`", key.name);
    let example = JOINTS[0].example;
    let table = cx.table(node, &place, example)?;
    let Some(kind) = JOINTS.iter().find(|kind| table.get(kind.name).is_some()) else {
        let kinds = JOINTS.map(|kind| kind.name);
        let near = table
            .entries
            .iter()
            .find_map(|(k, _)| kempe_units::nearest(&k.name, kinds));
        let help = match near {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!(
                "a joint has one of the keys {}, as in {example}",
                kinds.join(", ")
            ),
        };
        return cx.refuse(
            "missing-key",
            format!("{place}: what kind of joint is it?"),
            &key.span,
            help,
        );
    };
    let entry = Entry::new(cx, entry, kind)?;
    match kind.name {
        "slider" => slider(cx, &entry),
        "pin" => slot(cx, &entry),
        "weld" => weld(cx, &entry),
        "gears" => gears(cx, &entry),
        _ => rack(cx, &entry),
    }
}

impl Entry<'_> {
    fn different(&self, cx: &mut Context<'_>, a: LinkId, b: LinkId) -> Option<()> {
        if a != b {
            return Some(());
        }
        let name = cx.link_name(a).to_owned();
        cx.refuse(
            "same-link",
            format!("{} joins link `{name}` to itself", self.place),
            self.span,
            "a joint is between two different links",
        )
    }
}

fn slider(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<JointKind> {
    let slider = entry.link(cx, "slider");
    let at = entry.point(cx, "at");
    let on = entry.required(cx, "on").and_then(|node| {
        let text = entry.text(cx, "on", node)?;
        cx.line(text, slider)
    });
    let angle = entry.value_or(cx, "angle", 0.0);
    let (slider, (at, at_node), on) = (slider?, at?, on?);
    let at = on_link(cx, at, slider, at_node)?;
    entry.different(cx, slider, on.link)?;
    Some(JointKind::Slider {
        at,
        on,
        angle: angle?,
    })
}

fn slot(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<JointKind> {
    let pin = entry.point(cx, "pin");
    let on = entry.required(cx, "on").and_then(|node| {
        let text = entry.text(cx, "on", node)?;
        cx.line(text, None)
    });
    let ((pin, node), on) = (pin?, on?);
    let link = cx.carriers(pin).iter().copied().find(|l| *l != on.link);
    let Some(link) = link else {
        let (name, slot) = (
            cx.point_name(pin).to_owned(),
            cx.link_name(on.link).to_owned(),
        );
        return cx.refuse(
            "same-link",
            format!(
                "{}: the pin {name} is on `{slot}`, the link with the slot",
                entry.place
            ),
            &node.span,
            "the pin is a point of another link than the slot",
        );
    };
    if cx.carriers(pin).binary_search(&on.link).is_ok() {
        let (name, slot) = (
            cx.point_name(pin).to_owned(),
            cx.link_name(on.link).to_owned(),
        );
        cx.push(
            Diagnostic::error(
                "same-link",
                format!(
                    "{}: {name} is also a point of `{slot}`, so it cannot move along its slot",
                    entry.place
                ),
            )
            .at(node.span.clone(), "pinned to the slot's link by its name")
            .help("give the point on one of the two links another name"),
        );
        return None;
    }
    Some(JointKind::Slot {
        pin: LinkPointRef { link, point: pin },
        on,
    })
}

fn weld(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<JointKind> {
    let (a, b) = two_links(cx, entry, "weld")?;
    let angle = entry.value_or(cx, "angle", 0.0);
    let at = match entry.has("at") {
        true => {
            let (point, node) = entry.point(cx, "at")?;
            on_link(cx, point, a, node)?;
            on_link(cx, point, b, node)?;
            point
        }
        false => {
            let Some(at) = shared_point(cx, a, b) else {
                let (a, b) = (cx.link_name(a).to_owned(), cx.link_name(b).to_owned());
                return cx.refuse(
                    "no-common-point",
                    format!("{}: `{a}` and `{b}` share no point", entry.place),
                    entry.span,
                    "welded links meet in a point that both of them name",
                );
            };
            at
        }
    };
    Some(JointKind::Weld {
        a,
        b,
        at,
        angle: angle?,
    })
}

/// The first point that both links carry.
fn shared_point(cx: &Context<'_>, a: LinkId, b: LinkId) -> Option<PointId> {
    let points = &cx.model.links.get(a.index())?.points;
    points
        .iter()
        .map(|p| p.point)
        .find(|p| cx.carriers(*p).binary_search(&b).is_ok())
}

fn two_links(cx: &mut Context<'_>, entry: &Entry<'_>, key: &str) -> Option<(LinkId, LinkId)> {
    let ((a, b), _) = entry.two_links(cx, key)?;
    entry.different(cx, a, b)?;
    Some((a, b))
}

fn gears(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<JointKind> {
    let links = two_links(cx, entry, "gears");
    let arm = entry.link_or_frame(cx, "arm");
    let teeth = entry.required(cx, "teeth").and_then(|node| {
        // teeth are numbers, radii are lengths; both of a kind
        let (a, b) = entry.two(cx, node, "teeth")?;
        let what = entry.place_of("teeth");
        let (_, first) = cx.inferred(a, Dimension::NONE)?;
        let dimension = if first == Dimension::NONE {
            first
        } else {
            Dimension::LENGTH
        };
        let (a, b) = (
            cx.positive(a, dimension, &what, false),
            cx.positive(b, dimension, &what, false),
        );
        Some((a?, b?))
    });
    let internal = entry.flag(cx, "internal");
    let phase = entry.value_or(cx, "phase", 0.0);
    let ((a, b), arm, (teeth_a, teeth_b)) = (links?, arm?, teeth?);
    for gear in [a, b] {
        entry.different(cx, gear, arm)?;
        if shared_point(cx, gear, arm).is_none() {
            let (gear, arm) = (cx.link_name(gear).to_owned(), cx.link_name(arm).to_owned());
            cx.push(
                Diagnostic::warning("no-common-point", format!("{}: gear `{gear}` has no axis on the arm `{arm}`", entry.place))
                    .at(entry.span.clone(), format!("`{gear}` and `{arm}` share no point"))
                    .help("the arm carries both axes: name each gear's centre on the arm too, or say which link the arm is"),
            );
        }
    }
    Some(JointKind::Gears {
        a,
        b,
        arm,
        teeth_a,
        teeth_b,
        internal: internal?,
        phase: phase?,
    })
}

fn rack(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<JointKind> {
    let rack = entry.link(cx, "rack");
    let pinion = entry.link(cx, "pinion");
    let radius = entry.needed(cx, "radius");
    let side = match entry.get("side") {
        None => Some(Side::Left),
        Some(node) => rack_side(cx, entry, node),
    };
    let offset = entry.value_or(cx, "offset", 0.0);
    let (rack, pinion) = (rack?, pinion?);
    entry.different(cx, rack, pinion)?;
    let center = match entry.has("center") {
        false => cx.model.links.get(pinion.index())?.points.first()?.point,
        true => {
            let (point, node) = entry.point(cx, "center")?;
            on_link(cx, point, pinion, node)?.point
        }
    };
    Some(JointKind::Rack {
        rack,
        pinion,
        center,
        radius: radius?,
        side: side?,
        offset: offset?,
    })
}

fn rack_side<'d>(cx: &mut Context<'_>, entry: &Entry<'d>, node: &'d Node) -> Option<Side> {
    let text = entry.text(cx, "side", node)?;
    let word = text.content.trim();
    let side = SIDES.iter().find(|(name, _)| *name == word).map(|w| w.1);
    if side.is_none() {
        cx.push(
            Diagnostic::error("bad-side", "`left` or `right` expected")
                .at(node.span.clone(), "")
                .help("side = \"left\": the pinion lies on the left of the rack's x axis, or side = \"right\""),
        );
    }
    side
}
