//! `[joints]`: what a shared point name does not say.

use kempe_units::{Dimension, Expr};

use crate::diagnostic::Diagnostic;
use crate::document::{Key, Node};
use crate::model::{FRAME, Joint, JointId, JointKind, LinkId, LinkPointRef, PointId, Side};
use crate::read::context::Context;
use crate::read::entry::{Entry, link_of, on_link};

/// What makes a table a joint of a kind, with the keys that go with it.
pub(crate) const JOINT_KEYS: &[(&str, &[&str], &str)] = &[
    (
        "slider",
        &["slider", "at", "on", "angle"],
        "bore = { slider = \"piston\", at = \"C\", on = \"E -> F\" }",
    ),
    (
        "pin",
        &["pin", "on"],
        "slot = { pin = \"B\", on = \"O -> P\" }",
    ),
    (
        "weld",
        &["weld", "at", "angle"],
        "rigid = { weld = [\"leg\", \"foot\"], angle = \"30 deg\" }",
    ),
    (
        "gears",
        &["gears", "arm", "teeth", "internal", "phase"],
        "mesh = { gears = [\"sun\", \"planet\"], arm = \"carrier\", teeth = [20, 40] }",
    ),
    (
        "rack",
        &["rack", "pinion", "center", "radius", "side", "offset"],
        "rack = { rack = \"bar\", pinion = \"wheel\", radius = \"20 mm\" }",
    ),
];

/// A file has at most so many joints of its own.
const MAX_JOINTS: usize = 10_000;

/// Reads all joints.
pub(crate) fn read(cx: &mut Context<'_>, entries: &[&(Key, Node)]) {
    for (key, node) in cx.limited(entries, MAX_JOINTS, "joints") {
        let kind = read_joint(cx, key, node);
        let id = JointId(cx.model.joints.len() as u32);
        cx.joints.push(kind.is_some().then_some(id));
        if let Some(kind) = kind {
            cx.model.joints.push(Joint {
                name: key.name.clone(),
                kind,
                span: key.span.clone(),
            });
        }
    }
}

fn read_joint(cx: &mut Context<'_>, key: &Key, node: &Node) -> Option<JointKind> {
    let place = format!("joint `{}`", key.name);
    let table = cx.table(node, &place, JOINT_KEYS[0].2)?;
    let Some((kind, keys, example)) = JOINT_KEYS
        .iter()
        .find(|(kind, ..)| table.get(kind).is_some())
    else {
        let kinds: Vec<&str> = JOINT_KEYS.iter().map(|(kind, ..)| *kind).collect();
        let near = table
            .entries
            .iter()
            .find_map(|(k, _)| kempe_units::nearest(&k.name, kinds.iter().copied()));
        let help = match near {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!(
                "a joint has one of the keys {}, as in {}",
                kinds.join(", "),
                JOINT_KEYS[0].2
            ),
        };
        cx.push(
            Diagnostic::error("missing-key", format!("{place}: what kind of joint is it?"))
                .at(key.span.clone(), "")
                .help(help),
        );
        return None;
    };
    cx.unknown_keys(table, &place, keys);
    let entry = Entry {
        key,
        table,
        place,
        example,
    };
    match *kind {
        "slider" => slider(cx, &entry),
        "pin" => slot(cx, &entry),
        "weld" => weld(cx, &entry),
        "gears" => gears(cx, &entry),
        _ => rack(cx, &entry),
    }
}

impl Entry<'_> {
    fn angle(&self, cx: &mut Context<'_>, key: &str) -> Option<crate::model::Scalar> {
        self.scalar(cx, key, Dimension::ANGLE)
            .map(|angle| angle.unwrap_or(Expr::Const(0.0)))
    }

    fn different(&self, cx: &mut Context<'_>, a: LinkId, b: LinkId) -> Option<()> {
        if a != b {
            return Some(());
        }
        let name = cx.link_name(a).to_owned();
        cx.push(
            Diagnostic::error(
                "same-link",
                format!("{} joins link `{name}` to itself", self.place),
            )
            .at(self.key.span.clone(), "")
            .help("a joint is between two different links"),
        );
        None
    }
}

fn slider(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<JointKind> {
    let slider = entry.link(cx, "slider");
    let at = entry.required(cx, "at").and_then(|node| {
        let text = cx.text(node, "`at`", "\"C\"")?;
        Some((cx.point_text(text)?, node))
    });
    let on = entry.required(cx, "on").and_then(|node| {
        let text = cx.text(node, "`on`", "\"E -> F\"")?;
        cx.line(text, slider)
    });
    let angle = entry.angle(cx, "angle");
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
    let pin = entry.required(cx, "pin").and_then(|node| {
        let text = cx.text(node, "`pin`", "\"B\"")?;
        Some((cx.point_text(text)?, node))
    });
    let on = entry.required(cx, "on").and_then(|node| {
        let text = cx.text(node, "`on`", "\"O -> P\"")?;
        cx.line(text, None)
    });
    let ((pin, node), on) = (pin?, on?);
    let link = cx.carriers(pin).iter().copied().find(|l| *l != on.link);
    let Some(link) = link else {
        let (name, slot) = (
            cx.point_name(pin).to_owned(),
            cx.link_name(on.link).to_owned(),
        );
        cx.push(
            Diagnostic::error(
                "same-link",
                format!(
                    "{}: the pin {name} is on `{slot}`, the link with the slot",
                    entry.place
                ),
            )
            .at(node.span.clone(), "")
            .help("the pin is a point of another link than the slot"),
        );
        return None;
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
    let angle = entry.angle(cx, "angle");
    let at = match entry.table.get("at") {
        Some(node) => {
            let text = cx.text(node, "`at`", "\"C\"")?;
            let point = cx.point_text(text)?;
            on_link(cx, point, a, node)?;
            on_link(cx, point, b, node)?;
            point
        }
        None => {
            let Some(at) = shared_point(cx, a, b) else {
                let (a, b) = (cx.link_name(a).to_owned(), cx.link_name(b).to_owned());
                cx.push(
                    Diagnostic::error(
                        "no-common-point",
                        format!("{}: `{a}` and `{b}` share no point", entry.place),
                    )
                    .at(entry.key.span.clone(), "")
                    .help("welded links meet in a point that both of them name"),
                );
                return None;
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
    let (a, b) = entry.pair(cx, key)?;
    let place = format!("`{key}` of {}", entry.place);
    let (a, b) = (link_of(cx, a, &place), link_of(cx, b, &place));
    let (a, b) = (a?, b?);
    entry.different(cx, a, b)?;
    Some((a, b))
}

fn gears(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<JointKind> {
    let links = two_links(cx, entry, "gears");
    let arm = match entry.table.get("arm") {
        Some(node) => link_of(cx, node, &format!("`arm` of {}", entry.place)),
        None => Some(FRAME),
    };
    let teeth = entry.pair(cx, "teeth").and_then(|(a, b)| {
        // teeth are numbers, radii are lengths; both of a kind
        let what = format!("`teeth` of {}", entry.place);
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
    let internal = match entry.table.get("internal") {
        Some(node) => cx.flag(node, "`internal`"),
        None => Some(false),
    };
    let phase = entry.angle(cx, "phase");
    let ((a, b), arm, (teeth_a, teeth_b)) = (links?, arm?, teeth?);
    for gear in [a, b] {
        entry.different(cx, gear, arm)?;
        if shared_point(cx, gear, arm).is_none() {
            let (gear, arm) = (cx.link_name(gear).to_owned(), cx.link_name(arm).to_owned());
            cx.push(
                Diagnostic::warning("no-common-point", format!("{}: gear `{gear}` has no axis on the arm `{arm}`", entry.place))
                    .at(entry.key.span.clone(), format!("`{gear}` and `{arm}` share no point"))
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
    let radius = entry.required(cx, "radius").and_then(|node| {
        cx.positive(
            node,
            Dimension::LENGTH,
            &format!("the radius of {}", entry.place),
            false,
        )
    });
    let side = match entry.table.get("side") {
        None => Some(Side::Left),
        Some(node) => rack_side(cx, node),
    };
    let offset = match entry.table.get("offset") {
        None => Some(Expr::Const(0.0)),
        Some(node) => cx.scalar(node, Dimension::LENGTH),
    };
    let (rack, pinion) = (rack?, pinion?);
    entry.different(cx, rack, pinion)?;
    let center = match entry.table.get("center") {
        None => cx.model.links.get(pinion.index())?.points.first()?.point,
        Some(node) => {
            let text = cx.text(node, "`center`", "\"C\"")?;
            let point = cx.point_text(text)?;
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

fn rack_side(cx: &mut Context<'_>, node: &Node) -> Option<Side> {
    let text = cx.text(node, "`side`", "\"left\"")?;
    match text.content.trim().trim_end_matches(" of") {
        "left" => Some(Side::Left),
        "right" => Some(Side::Right),
        _ => {
            cx.push(
                Diagnostic::error("bad-side", "`left` or `right` expected")
                    .at(node.span.clone(), "")
                    .help("side = \"left\": the pinion lies on the left of the rack's x axis, or side = \"right\""),
            );
            None
        }
    }
}
