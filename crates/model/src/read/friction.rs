//! `[friction]`: at pins by the name of the point, at sliders, slots and teeth by the name of the joint, and for `all`.
//!
//! ```toml
//! [friction]
//! B    = { coefficient = 0.1, radius = "10 mm" }
//! bore = { coefficient = 0.08, static = 0.12, stribeck = "1 mm/s", viscous = "50 N s/m" }
//! all  = { coefficient = 0.1, radius = "8 mm" }         # every pin and slider that has no entry of its own
//! ```
//!
//! `coefficient` is Coulomb's, at speed; `static` the one at rest, from which it falls over the speed `stribeck`. A viscous
//! part and a drag are told of a pin or a slider, not of all, because they measure something else at each.

use kempe_units::{Dimension, Expr};

use crate::bound::Keeps;
use crate::diagnostic::Diagnostic;
use crate::ids::{JointId, PointId, Span};
use crate::joint::{JointKind, Teeth, ToothSize};
use crate::key_table::{FRICTION_OF_ALL, FRICTION_OF_JOINT, FRICTION_OF_PIN};
use crate::load::{Friction, FrictionAt};
use crate::node::{Key, Node};
use crate::read::context::{Context, Meaning};
use crate::read::entry::Entry;
use crate::read::holder;
use crate::read::names::is_point_name;

/// A file has at most so many.
const MAX: usize = 100_000;

/// Reads all friction.
pub(crate) fn read(cx: &mut Context<'_>, entries: &[&(Key, Node)]) {
    for entry in cx.limited(entries, MAX, "entries of friction") {
        let friction = read_one(cx, entry, entries);
        cx.model.actions.friction.extend(friction);
    }
    for point in 0..cx.model.points.len() {
        let point = PointId(point as u32);
        let rubs = |at| cx.model.actions.friction.iter().find(|f| f.at == at);
        let rubs = rubs(FrictionAt::Pin(point)).or_else(|| rubs(FrictionAt::All));
        let warning = rubs.and_then(|rubs| holder::not_named(cx, point, &rubs.span));
        cx.found.extend(warning);
    }
}

fn read_one(
    cx: &mut Context<'_>,
    entry: &(Key, Node),
    entries: &[&(Key, Node)],
) -> Option<Friction> {
    let (key, _) = entry;
    let at = place(cx, key)?;
    let kind = match at {
        FrictionAt::Pin(_) => &FRICTION_OF_PIN,
        FrictionAt::Joint(_) => &FRICTION_OF_JOINT,
        FrictionAt::All => &FRICTION_OF_ALL,
    };
    let mut entry = Entry::new(cx, entry, kind)?;
    if let FrictionAt::Pin(point) = at {
        holder::read(cx, &entry, point)?;
    }
    if let FrictionAt::Joint(joint) = at {
        needs_teeth(cx, joint, &key.span)?;
    }
    entry.turning = matches!(at, FrictionAt::Pin(_));
    let known = |key: &str| kind.key(key).is_some();
    let viscous = match known("viscous") {
        true => entry.value(cx, "viscous"),
        false => Some(None),
    };
    let drag = match known("drag") {
        true => entry.value(cx, "drag"),
        false => Some(None),
    };
    let mut apart = ["viscous", "drag"].iter().filter(|key| known(key));
    let apart_from_load = apart.any(|key| entry.has(key)) && !entry.has("coefficient");
    let coefficient = if apart_from_load {
        Some(Expr::Const(0.0))
    } else {
        entry.needed(cx, "coefficient")
    };
    let at_rest = entry.value(cx, "static");
    let stribeck = entry.value(cx, "stribeck");
    entry.idle(cx, &["stribeck"], "static");
    entry.idle(cx, &["static"], "stribeck");
    let radius = match known("radius") {
        true => entry.value(cx, "radius"),
        false => Some(None),
    };
    let dry = coefficient.as_ref().is_some_and(|c| cx.number(c) > 0.0) || entry.has("static");
    if dry && needs_radius(cx, at, entries) {
        entry.required_like(cx, "radius", "\"10 mm\", that of the pin")?;
    }
    let (coefficient, at_rest) = (coefficient?, at_rest?);
    if let Some(rest) = &at_rest
        && cx.number(rest) < cx.number(&coefficient)
    {
        entry.contradiction(
            cx,
            &["static", "coefficient"],
            "the coefficient at rest is below that at speed",
            "`static` is the coefficient at rest, the larger one",
        );
        return None;
    }
    if let (Some(rest), Some(node)) = (&at_rest, entry.get("static")) {
        let what = format!("{}: `static` less `coefficient`", entry.place);
        cx.apart(
            [&coefficient, rest],
            &node.span,
            &what,
            Dimension::NONE,
            Keeps::NotNegative,
        );
    }
    Some(Friction {
        at,
        coefficient,
        static_coefficient: at_rest,
        stribeck_speed: stribeck?,
        viscous: viscous?,
        drag: drag?,
        radius: radius?,
        span: key.span.clone(),
    })
}

/// Whether there is a pin to which the entry applies.
fn needs_radius(cx: &Context<'_>, at: FrictionAt, entries: &[&(Key, Node)]) -> bool {
    match at {
        FrictionAt::Pin(_) => true,
        FrictionAt::Joint(_) => false,
        FrictionAt::All => {
            let own: std::collections::BTreeSet<&str> =
                entries.iter().map(|(k, _)| k.name.as_str()).collect();
            cx.model
                .points
                .iter()
                .any(|p| p.links.len() > 1 && !own.contains(p.name.as_str()))
        }
    }
}

/// Refuses friction at teeth of which too little is known.
fn needs_teeth(cx: &mut Context<'_>, joint: JointId, span: &Span) -> Option<()> {
    let joint = cx.model.joints.get(joint.index())?;
    let Some(teeth) = joint.kind.teeth() else {
        return Some(());
    };
    let (missing, example, why) = match teeth {
        Teeth {
            pressure_angle: None,
            ..
        } => (
            "pressure_angle",
            "\"20 deg\"",
            "friction goes with the normal force of the teeth",
        ),
        Teeth {
            size: ToothSize::Module(None),
            ..
        } => (
            "module",
            "\"2 mm\"",
            "friction goes with the path along which teeth slide, and radii do not tell how large they are",
        ),
        _ => return Some(()),
    };
    let (name, at) = (joint.name.clone(), joint.span.clone());
    let told = format!("friction at the teeth of `{name}` needs its `{missing}`");
    cx.push(
        Diagnostic::error("missing-key", told)
            .at(span.clone(), "")
            .see(at, format!("`{name}` has no `{missing}`"))
            .note(why)
            .help(format!("add {missing} = {example} to the joint `{name}`")),
    );
    None
}

fn place(cx: &mut Context<'_>, key: &Key) -> Option<FrictionAt> {
    let name = key.name.as_str();
    if name == "all" {
        return Some(FrictionAt::All);
    }
    if is_point_name(name) {
        let point = cx.point(name, key.span.clone())?;
        return pin(cx, point, key);
    }
    if let Some((Meaning::Joint(i), _)) = cx.names.get(name) {
        let id = cx.joints.get(*i).copied().flatten()?;
        let what = match cx.model.joints.get(id.index()).map(|j| &j.kind) {
            Some(JointKind::Weld { .. }) => Some("a weld: nothing rubs there"),
            Some(JointKind::Belt { .. }) => {
                Some("a belt, whose friction this version does not know")
            }
            _ => None,
        };
        if let Some(what) = what {
            return cx.refuse(
                "not-a-slider",
                format!("`{name}` is {what}"),
                &key.span,
                "friction acts at pins, sliders, slots and the teeth of gears and racks",
            );
        }
        return Some(FrictionAt::Joint(id));
    }
    let known: Vec<String> = cx
        .names
        .iter()
        .filter(|(_, (m, _))| matches!(m, Meaning::Joint(i) if slides(cx, *i)))
        .map(|(n, _)| n.clone())
        .chain(
            cx.model
                .points
                .iter()
                .filter(|p| p.links.len() > 1)
                .map(|p| p.name.clone()),
        )
        .chain(["all".to_owned()])
        .collect();
    let mut d = cx.no_such(
        "pin or joint",
        name,
        key.span.clone(),
        known.iter().map(String::as_str),
    );
    if let Some((meaning, declared)) = cx.names.get(name) {
        d = d.see(declared.clone(), format!("`{name}` is {}", meaning.what()));
    }
    cx.push(
        d.note("friction is told of pins by their point, of sliders and teeth by their joint, and of `all`"),
    );
    None
}

/// Whether a joint, by file order, is one that friction may be told of; a broken one may be.
fn slides(cx: &Context<'_>, joint: usize) -> bool {
    let Some(id) = cx.joints.get(joint).copied().flatten() else {
        return true;
    };
    matches!(
        cx.model.joints.get(id.index()).map(|j| &j.kind),
        Some(
            JointKind::Slider { .. }
                | JointKind::Slot { .. }
                | JointKind::ArcSlot { .. }
                | JointKind::CurveSlot { .. }
                | JointKind::Gears { .. }
                | JointKind::Rack { .. }
        )
    )
}

fn pin(cx: &mut Context<'_>, point: PointId, key: &Key) -> Option<FrictionAt> {
    if cx.carriers(point).len() > 1 {
        return Some(FrictionAt::Pin(point));
    }
    let name = key.name.as_str();
    cx.push(
        Diagnostic::error("not-a-pin", format!("{name} is no pin"))
            .at(key.span.clone(), "only one link carries it")
            .help("a point that two links carry is a pin; of a slider or a pin in a slot, name the joint"),
    );
    None
}
