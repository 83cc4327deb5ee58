//! `[joints]`: what a shared point name does not say.

use kempe_units::{Dimension, Expr};

use crate::diagnostic::Diagnostic;
use crate::ids::{JointId, Line, LinkId, LinkPointRef, PointId, Scalar};
use crate::joint::{Joint, JointKind, Teeth, ToothSize};
use crate::key_table::{JOINTS, SIDES};
use crate::link::{CircularArc, Side, SmoothCurve};
use crate::node::{Key, Node};
use crate::read::algebra::{minus, over, plus, times, turn};
use crate::read::context::Context;
use crate::read::drawn;
use crate::read::entry::{Entry, on_link};

/// A radius this little, in parts of it, below half the distance of an arc's ends is that half: a semicircle.
const FLAT: f64 = 1e-12;
/// Points this near each other, in parts of their coordinates, are at one place but for rounding.
const ROUNDING: f64 = 1e-12;
/// A smooth curve goes through at least so many points; two are a line.
const LEAST_POINTS: usize = 3;
/// A smooth curve goes through at most so many points.
const MOST_POINTS: usize = 1000;
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
        "belt" => belt(cx, &entry),
        _ => rack(cx, &entry),
    }
}

impl Entry<'_> {
    /// A value, or where the entry leaves it out the one that the drawing has.
    fn or_drawn(&self, key: &str, value: Scalar, drawn: impl FnOnce() -> Option<Scalar>) -> Scalar {
        match self.has(key) {
            true => value,
            false => drawn().unwrap_or(value),
        }
    }

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
    let as_drawn = || {
        let guide = drawn::line_angle(cx, &on)?;
        Some(turn(&guide, &drawn::listed_angle(cx, slider)?))
    };
    Some(JointKind::Slider {
        at,
        on,
        angle: entry.or_drawn("angle", angle?, as_drawn),
    })
}

fn slot(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<JointKind> {
    let pin = entry.point(cx, "pin");
    let ways: Vec<&str> = ["through", "arc", "on"]
        .into_iter()
        .filter(|key| entry.has(key))
        .collect();
    if ways.len() > 1 {
        let message = "a pin lies on a line, on an arc or on a smooth curve, not on several";
        let help = "keep `on` for a straight slot, `arc` for one on an arc, `through` for one along a smooth curve";
        entry.contradiction(cx, &ways, message, help);
        return None;
    }
    entry.idle(cx, &["radius", "side"], "arc");
    let key = ways.first().copied().unwrap_or("on");
    if key == "through" {
        let on = smooth_curve(cx, entry);
        let (pin, on) = (pin?, on?);
        let pin = pin_in_slot(cx, entry, pin, on.link)?;
        return Some(JointKind::CurveSlot { pin, on });
    }
    entry.idle(cx, &["closed"], "arc");
    let on = entry.required(cx, key).and_then(|node| {
        let text = entry.text(cx, key, node)?;
        Some((cx.line(text, None)?, node))
    });
    let (pin, (on, node)) = (pin?, on?);
    let pin = pin_in_slot(cx, entry, pin, on.link)?;
    Some(match key {
        "on" => JointKind::Slot { pin, on },
        _ => JointKind::ArcSlot {
            pin,
            on: arc(cx, entry, node, on)?,
        },
    })
}

/// A pin, told at a node, as the point of another link than the one with its slot.
fn pin_in_slot(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    (pin, node): (PointId, &Node),
    slot: LinkId,
) -> Option<LinkPointRef> {
    let link = cx.carriers(pin).iter().copied().find(|l| *l != slot);
    let (name, on) = (cx.point_name(pin).to_owned(), cx.link_name(slot).to_owned());
    let Some(link) = link else {
        return cx.refuse(
            "same-link",
            format!(
                "{}: the pin {name} is on `{on}`, the link with the slot",
                entry.place
            ),
            &node.span,
            "the pin is a point of another link than the slot",
        );
    };
    if cx.carriers(pin).binary_search(&slot).is_ok() {
        cx.push(
            Diagnostic::error(
                "same-link",
                format!(
                    "{}: {name} is also a point of `{on}`, so it cannot move along its slot",
                    entry.place
                ),
            )
            .at(node.span.clone(), "pinned to the slot's link by its name")
            .help("give the point on one of the two links another name"),
        );
        return None;
    }
    Some(LinkPointRef { link, point: pin })
}

/// The curve through the points that `through` lists.
fn smooth_curve(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<SmoothCurve> {
    let list = entry.required(cx, "through")?;
    let place = entry.place_of("through");
    let example = entry.example_of("through");
    let nodes = cx.array(list, &place, example)?;
    if !(LEAST_POINTS..=MOST_POINTS).contains(&nodes.len()) {
        return cx.refuse(
            "wrong-type",
            format!(
                "{place} has {LEAST_POINTS} to {MOST_POINTS} points, found {}",
                nodes.len()
            ),
            &list.span,
            "two points are a straight slot: write on = \"O -> P\"",
        );
    }
    let mut through = Vec::with_capacity(nodes.len());
    for node in nodes {
        let text = cx.text(node, &place, example)?;
        through.push(cx.point_text(text)?);
    }
    let carried = |link: &LinkId| {
        let mut points = through.iter();
        points.all(|p| cx.carriers(*p).binary_search(link).is_ok())
    };
    let link = cx.carriers(through[0]).iter().copied().find(carried);
    let Some(link) = link else {
        return cx.refuse(
            "no-common-link",
            format!("no link carries all points of {place}"),
            &list.span,
            "name points of one link, in their order along the slot",
        );
    };
    let closed = entry.flag(cx, "closed")?;
    let follows = |k: usize| match (k + 1 < through.len(), closed) {
        (true, _) => Some(k + 1),
        (false, true) => Some(0),
        (false, false) => None,
    };
    for (k, node) in nodes.iter().enumerate() {
        let Some(next) = follows(k) else { continue };
        if !(distance_on(cx, link, through[k], through[next])? > 0.0) {
            let [a, b] = [k, next].map(|k| cx.point_name(through[k]).to_owned());
            return cx.refuse(
                "contradictory-values",
                format!("{place}: the curve goes from {a} to {b}, which lie on one spot"),
                &node.span,
                "leave one of them out, or set them apart; a closed curve names its first point once",
            );
        }
    }
    Some(SmoothCurve {
        link,
        through,
        closed,
    })
}

/// The arc over a line between two points, told at `node`.
fn arc(cx: &mut Context<'_>, entry: &Entry<'_>, node: &Node, on: Line) -> Option<CircularArc> {
    let radius = entry.needed(cx, "radius");
    let side = match entry.get("side") {
        None => Some(Side::Left),
        Some(node) => side_word(
            cx,
            entry,
            node,
            "side = \"left\": the centre lies on the left of the way along the arc's ends, or side = \"right\"",
        ),
    };
    let closed = entry.flag(cx, "closed");
    let (radius, side, closed) = (radius?, side?, closed?);
    let least = 0.5 * distance_on(cx, on.link, on.from, on.to)?;
    let given = cx.number(&radius);
    if !(least > 0.0 && given >= least * (1.0 - FLAT)) {
        let (least, given) = (
            cx.show(least, Dimension::LENGTH),
            cx.show(given, Dimension::LENGTH),
        );
        cx.push(
            Diagnostic::error(
                "contradictory-values",
                format!("{}: no arc with this radius joins these points", entry.place),
            )
            .at(
                node.span.clone(),
                format!("half their distance is {least}, the radius is {given}"),
            )
            .help("give two points apart from each other and a radius of at least half their distance"),
        );
        return None;
    }
    Some(CircularArc {
        link: on.link,
        from: on.from,
        to: on.to,
        radius,
        side,
        closed,
    })
}

/// Distance of two points of a link with the parameters' values, m.
fn distance_on(cx: &Context<'_>, link: LinkId, a: PointId, b: PointId) -> Option<f64> {
    let link = cx.model.links.get(link.index())?;
    let places: Vec<[f64; 2]> = link.evaluate(&cx.values);
    let at = |point: PointId| {
        let index = link.points.iter().position(|p| p.point == point)?;
        places.get(index).copied()
    };
    let (a, b) = (at(a)?, at(b)?);
    let apart = kempe_number::math::hypot(a[0] - b[0], a[1] - b[1]);
    let size = [a, b].as_flattened().iter().map(|x| x.abs()).sum::<f64>();
    Some(if apart > ROUNDING * size { apart } else { 0.0 })
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
        angle: entry.or_drawn("angle", angle?, || drawn::angle_between(cx, a, b)),
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
    let sizes = entry.required(cx, "teeth").and_then(|node| {
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
        Some((a?, b?, dimension == Dimension::NONE))
    });
    let internal = entry.flag(cx, "internal");
    let phase = entry.value_or(cx, "phase", 0.0);
    let ((a, b), arm, (teeth_a, teeth_b, counted)) = (links?, arm?, sizes?);
    let form = teeth(cx, entry, counted);
    let mut axes = Vec::new();
    for gear in [a, b] {
        entry.different(cx, gear, arm)?;
        let axis = shared_point(cx, gear, arm);
        axes.extend(axis);
        if axis.is_none() {
            let (gear, arm) = (cx.link_name(gear).to_owned(), cx.link_name(arm).to_owned());
            cx.push(
                Diagnostic::warning("no-common-point", format!("{}: gear `{gear}` has no axis on the arm `{arm}`", entry.place))
                    .at(entry.span.clone(), format!("`{gear}` and `{arm}` share no point"))
                    .help("the arm carries both axes: name each gear's centre on the arm too, or say which link the arm is"),
            );
        }
    }
    let (internal, form) = (internal?, form?);
    if let [a, b] = axes.as_slice() {
        let alike = internal && cx.number(&teeth_a) == cx.number(&teeth_b);
        let apart = distance_on(cx, arm, *a, *b)?;
        if alike && apart > 0.0 {
            let apart = cx.show(apart, Dimension::LENGTH);
            let message = format!(
                "a wheel in a ring of its own size has the ring's axis, and their axes are {apart} apart"
            );
            let help =
                "give the ring more teeth than its wheel, or pin both at one point of the arm";
            entry.contradiction(cx, &["teeth", "internal"], &message, help);
            return None;
        }
        if entry.has("pressure_angle") && (alike || !(apart > 0.0)) {
            let message = "wheels on one axis have no pressure angle: their teeth do not meet";
            let help = "leave `pressure_angle` out, or set the axes apart on the arm and give wheels of different size";
            entry.contradiction(cx, &["pressure_angle", "teeth"], message, help);
            return None;
        }
    }
    let ratio = over(teeth_b.clone(), teeth_a.clone());
    let phase = entry.or_drawn("phase", phase?, || {
        drawn::phase(cx, [a, b, arm], ratio, !internal)
    });
    Some(JointKind::Gears {
        a,
        b,
        arm,
        teeth_a,
        teeth_b,
        internal,
        phase,
        teeth: form,
    })
}

/// What an entry tells of its teeth, which are counted where its wheels are not told by their radii.
fn teeth(cx: &mut Context<'_>, entry: &Entry<'_>, counted: bool) -> Option<Teeth> {
    if !counted {
        entry.idle(cx, &["module"], "pressure_angle");
    }
    let angle = entry.value(cx, "pressure_angle");
    let module = entry.value(cx, "module");
    let (pressure_angle, module) = (angle?, module?);
    if let (Some(angle), Some(node)) = (&pressure_angle, entry.get("pressure_angle")) {
        cx.pressure_angle(angle, node, &entry.place_of("pressure_angle"))?;
    }
    if counted && module.is_some() {
        let message = "numbers of teeth and the distance of the axes tell the module";
        let help = match pressure_angle {
            Some(_) => "leave `module` out, or give radii: teeth = [\"20 mm\", \"40 mm\"]",
            None => "leave `module` out",
        };
        entry.contradiction(cx, &["module", "teeth"], message, help);
        return None;
    }
    let size = match counted {
        true => ToothSize::Counted,
        false => ToothSize::Module(module),
    };
    Some(Teeth {
        pressure_angle,
        size,
    })
}

fn belt(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<JointKind> {
    let links = two_links(cx, entry, "belt");
    let arm = entry.link_or_frame(cx, "arm");
    entry.idle(cx, &["pitch"], "teeth");
    let chain = entry.get("teeth");
    if chain.is_some() && entry.has("radii") {
        let message = "the wheels have radii or teeth, not both";
        let help = "keep `radii` for a belt, `teeth` and `pitch` for a chain or a toothed belt";
        entry.contradiction(cx, &["teeth", "radii"], message, help);
        return None;
    }
    let both = |cx: &mut Context<'_>, key: &str, dimension| {
        let node = entry.required(cx, key)?;
        let (a, b) = entry.two(cx, node, key)?;
        let what = entry.place_of(key);
        let (a, b) = (
            cx.positive(a, dimension, &what, false),
            cx.positive(b, dimension, &what, false),
        );
        Some((a?, b?))
    };
    let radii = match chain {
        None => both(cx, "radii", Dimension::LENGTH),
        Some(_) => {
            let pitch = entry.needed(cx, "pitch");
            let teeth = both(cx, "teeth", Dimension::NONE);
            // So many pitches are the way round, whatever the corners of a chain.
            let radius = |teeth, pitch: &Scalar| {
                let round = Expr::Mul(Box::new(teeth), Box::new(pitch.clone()));
                Expr::Div(
                    Box::new(round),
                    Box::new(Expr::Const(std::f64::consts::TAU)),
                )
            };
            pitch
                .zip(teeth)
                .map(|(pitch, (a, b))| (radius(a, &pitch), radius(b, &pitch)))
        }
    };
    let crossed = entry.flag(cx, "crossed");
    let phase = entry.value_or(cx, "phase", 0.0);
    let ((a, b), arm, (radius_a, radius_b)) = (links?, arm?, radii?);
    let mut axes = Vec::new();
    for wheel in [a, b] {
        entry.different(cx, wheel, arm)?;
        let Some(axis) = shared_point(cx, wheel, arm) else {
            let (wheel, arm) = (cx.link_name(wheel).to_owned(), cx.link_name(arm).to_owned());
            cx.push(
                Diagnostic::error("no-common-point", format!("{}: wheel `{wheel}` has no axis on the arm `{arm}`", entry.place))
                    .at(entry.span.clone(), format!("`{wheel}` and `{arm}` share no point"))
                    .help("one link carries both axes, so that the belt keeps its length: name each wheel's centre on it, and the link as `arm`"),
            );
            return None;
        };
        axes.push(axis);
    }
    let apart = distance_on(cx, arm, axes[0], axes[1])?;
    let sum = cx.number(&radius_a) + cx.number(&radius_b);
    if !(apart > sum) {
        let (apart, sum) = (
            cx.show(apart, Dimension::LENGTH),
            cx.show(sum, Dimension::LENGTH),
        );
        cx.push(
            Diagnostic::error(
                "contradictory-values",
                format!("{}: the wheels overlap", entry.place),
            )
            .at(
                entry.span.clone(),
                format!("their axes are {apart} apart, their radii are {sum} together"),
            )
            .help("a belt runs over two wheels beside each other: smaller wheels, or axes further apart"),
        );
        return None;
    }
    let crossed = crossed?;
    let ratio = over(radius_b.clone(), radius_a.clone());
    let phase = entry.or_drawn("phase", phase?, || {
        drawn::phase(cx, [a, b, arm], ratio, crossed)
    });
    Some(JointKind::Belt {
        a,
        b,
        arm,
        radius_a,
        radius_b,
        crossed,
        chain: chain.is_some(),
        phase,
    })
}

fn rack(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<JointKind> {
    let rack = entry.link(cx, "rack");
    let pinion = entry.link(cx, "pinion");
    let radius = entry.needed(cx, "radius");
    let side = match entry.get("side") {
        None => Some(Side::Left),
        Some(node) => side_word(
            cx,
            entry,
            node,
            "side = \"left\": the pinion lies on the left of the rack's x axis, or side = \"right\"",
        ),
    };
    let offset = entry.value_or(cx, "offset", 0.0);
    let teeth = teeth(cx, entry, false);
    let (rack, pinion) = (rack?, pinion?);
    entry.different(cx, rack, pinion)?;
    let center = match entry.has("center") {
        false => cx.model.links.get(pinion.index())?.points.first()?.point,
        true => {
            let (point, node) = entry.point(cx, "center")?;
            on_link(cx, point, pinion, node)?.point
        }
    };
    let (radius, side, teeth) = (radius?, side?, teeth?);
    let offset = entry.or_drawn("offset", offset?, || {
        let rolled = times(radius.clone(), drawn::angle_between(cx, rack, pinion)?);
        let travel = drawn::travel(cx, rack, center)?;
        let offset = match side {
            Side::Left => plus(travel, rolled),
            Side::Right => minus(&travel, &rolled),
        };
        Some(offset.fold())
    });
    Some(JointKind::Rack {
        rack,
        pinion,
        center,
        radius,
        side,
        offset,
        teeth,
    })
}

fn side_word<'d>(
    cx: &mut Context<'_>,
    entry: &Entry<'d>,
    node: &'d Node,
    help: &str,
) -> Option<Side> {
    let text = entry.text(cx, "side", node)?;
    let word = text.content.trim().trim_end_matches(" of");
    let side = SIDES.iter().find(|(name, _)| *name == word).map(|w| w.1);
    if side.is_none() {
        cx.push(
            Diagnostic::error("bad-side", "`left` or `right` expected")
                .at(node.span.clone(), "")
                .help(help),
        );
    }
    side
}
