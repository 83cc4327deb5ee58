//! `[clearance]`: at pins by the name of the point, at sliders and slots by the name of the joint, and for `all`; and the
//! studies of it.
//!
//! ```toml
//! [clearance]
//! all  = { radial = "10 um" }                  # every pin, slider and slot that has no entry of its own
//! B    = { radial = "50 um" }
//! C    = { radial = "50 um", on = "rocker" }   # of the links that share the pin C, with the first of them
//! bore = { radial = "play" }                   # to either side of the slider's line
//!
//! [studies.play]
//! kind  = "clearance"
//! model = "continuous"
//! rates = "frozen"                             # or "turning"
//! ```

use kempe_units::Dimension;

use crate::clearance::{Clearance, ClearanceAt, ClearanceModel, ClearanceRates, ClearanceStudy};
use crate::contact::{ContactProperties, ContactStates, ContactStudy, FrictionOnset};
use crate::diagnostic::Diagnostic;
use crate::ids::{LinkId, PointId, Scalar};
use crate::joint::JointKind;
use crate::key_table::clearance::{LAWS, MODELS, OF_ALL, OF_JOINT, OF_PIN, RATES};
use crate::motion_study::MotionStudy;
use crate::node::{Key, Node, Value};
use crate::read::context::{Context, Meaning};
use crate::read::entry::{Entry, link_of};
use crate::read::holder;
use crate::read::names::is_point_name;
use crate::read::simulate::{self, restitution};
use crate::study::StudyKind;

/// A file has at most so many.
const MAX: usize = 100_000;

/// Reads all clearances.
pub(crate) fn read(cx: &mut Context<'_>, entries: &[&(Key, Node)]) {
    cx.clearances_given = !entries.is_empty();
    for entry in cx.limited(entries, MAX, "clearances") {
        let clearance = read_one(cx, entry, entries);
        cx.model.clearances.extend(clearance);
    }
    for diagnostic in cx.model.clearances_too_large(&cx.values) {
        cx.push(diagnostic);
    }
}

/// Whether another entry tells of a key, with which what this one says beside it means something: that of `all`, or for `all` any.
fn told_by_others(entries: &[&(Key, Node)], own: &Key, key: &str) -> bool {
    let of_all = |it: &Key| it.name == OF_ALL.name;
    entries.iter().any(|(other, node)| {
        let tells = match &node.value {
            Value::Table(keys) => keys.get(key).is_some(),
            _ => false,
        };
        tells && of_all(other) != of_all(own)
    })
}

fn read_one(cx: &mut Context<'_>, entry: &(Key, Node), all: &[&(Key, Node)]) -> Option<Clearance> {
    let (key, _) = entry;
    let mut at = place(cx, key)?;
    let kind = match at {
        ClearanceAt::Pin { .. } => &OF_PIN,
        ClearanceAt::Joint(_) => &OF_JOINT,
        ClearanceAt::All => &OF_ALL,
    };
    let entry = Entry::new(cx, entry, kind)?;
    let radial = entry.needed(cx, "radial");
    if let ClearanceAt::Pin { point, on } = &mut at {
        holder::read(cx, &entry, *point)?;
        *on = links(cx, &entry, *point)?;
    }
    for (keys, without) in [
        (["damping"].as_slice(), "spring"),
        (&["stiction", "friction_speeds"], "friction"),
    ] {
        if !told_by_others(all, key, without) {
            entry.idle(cx, keys, without);
        }
    }
    let contact = contact(cx, &entry);
    Some(Clearance {
        at,
        radial: radial?,
        contact: contact?,
        span: key.span.clone(),
    })
}

/// The links that have play on a pin; none where the file names none.
fn links(cx: &mut Context<'_>, entry: &Entry<'_>, pin: PointId) -> Option<Vec<LinkId>> {
    let Some(node) = entry.get("on") else {
        return Some(Vec::new());
    };
    let place = entry.place_of("on");
    let nodes: Vec<&Node> = match &node.value {
        Value::Array(_) => cx
            .array(node, &place, entry.example_of("on"))?
            .iter()
            .collect(),
        _ => vec![node],
    };
    let mut found = Vec::new();
    for node in nodes {
        let link = link_of(cx, node, &place)?;
        let carriers: Vec<LinkId> = (cx.model.points.get(pin.index()).into_iter())
            .flat_map(crate::link::Point::holder_first)
            .collect();
        let (name, point) = (cx.link_name(link).to_owned(), cx.point_name(pin).to_owned());
        if !carriers.contains(&link) {
            return cx.refuse(
                "no-common-point",
                format!("{point} is no point of link `{name}`"),
                &node.span,
                format!("name links that share the pin {point}"),
            );
        }
        // Of two links it is the same pair, whichever is named.
        match carriers.as_slice() {
            [_, later] => found.push(*later),
            [first, ..] if *first == link => {
                return cx.refuse(
                    "not-a-pin",
                    format!("the pin {point} sits fast in link `{name}`"),
                    &node.span,
                    "name the links that have play on the pin: the others; or another `holder` than the first link of the file",
                );
            }
            _ => found.push(link),
        }
    }
    Some(found)
}

fn place(cx: &mut Context<'_>, key: &Key) -> Option<ClearanceAt> {
    let name = key.name.as_str();
    if name == OF_ALL.name {
        return Some(ClearanceAt::All);
    }
    if is_point_name(name) {
        let point = cx.point(name, key.span.clone())?;
        if cx.carriers(point).len() > 1 {
            let on = Vec::new();
            return Some(ClearanceAt::Pin { point, on });
        }
        cx.push(
            Diagnostic::error("not-a-pin", format!("{name} is no pin"))
                .at(key.span.clone(), "only one link carries it")
                .help("a point that two links carry is a pin; of a slider or a pin in a slot, name the joint"),
        );
        return None;
    }
    if let Some((Meaning::Joint(i), _)) = cx.names.get(name) {
        let id = cx.joints.get(*i).copied().flatten()?;
        let kind = cx.model.joints.get(id.index()).map(|j| &j.kind);
        let what = match kind? {
            JointKind::Slider { .. } | JointKind::Slot { .. } | JointKind::ArcSlot { .. } => {
                return Some(ClearanceAt::Joint(id));
            }
            JointKind::CurveSlot { .. } => "a slot along a smooth curve",
            JointKind::Weld { .. } => "a weld",
            JointKind::Belt { .. } => "a belt",
            JointKind::Gears { .. } | JointKind::Rack { .. } => "teeth in mesh",
        };
        return cx.refuse(
            "not-a-slider",
            format!("`{name}` is {what}, whose play this version does not know"),
            &key.span,
            "there may be play at pins, sliders, straight slots and slots along an arc",
        );
    }
    let joints = (cx.names.iter()).filter(|(_, (m, _))| matches!(m, Meaning::Joint(_)));
    let pins = cx.model.points.iter().filter(|p| p.links.len() > 1);
    let known: Vec<String> = (joints.map(|(n, _)| n.clone()))
        .chain(pins.map(|p| p.name.clone()))
        .chain([OF_ALL.name.to_owned()])
        .collect();
    let known = known.iter().map(String::as_str);
    let mut d = cx.no_such("pin or joint", name, key.span.clone(), known);
    if let Some((meaning, declared)) = cx.names.get(name) {
        d = d.see(declared.clone(), format!("`{name}` is {}", meaning.what()));
    }
    cx.push(
        d.note("clearance is told of pins by their point, of sliders by their joint, and of `all`"),
    );
    None
}

/// What an entry says of the bodies that touch.
fn contact(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<ContactProperties> {
    let law = entry.choice(cx, "law", &LAWS);
    let onset = onset(cx, entry);
    let restitution = restitution(cx, entry);
    // A pin has no length and a slider no radius.
    let mut value = |key: &str| match entry.kind.key(key).is_some() {
        true => entry.value(cx, key),
        false => Some(None),
    };
    let (radius, length, height) = (value("radius"), value("length"), value("height"));
    let (stiffness, modulus, poisson) = (value("stiffness"), value("modulus"), value("poisson"));
    let (spring, damping, friction) = (value("spring"), value("damping"), value("friction"));
    Some(ContactProperties {
        radius: radius?,
        length: length?,
        height: height?,
        law: law?,
        restitution: restitution?,
        stiffness: stiffness?,
        modulus: modulus?,
        poisson: poisson?,
        spring: spring?,
        damping: damping?,
        friction: friction?,
        onset: onset?,
    })
}

/// How friction sets in; nothing where the file does not say.
fn onset(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<Option<FrictionOnset>> {
    let sticks = entry.flag(cx, "stiction");
    let speeds = match entry.get("friction_speeds") {
        None => None,
        Some(node) => Some(friction_speeds(cx, entry, node)?),
    };
    let sticks = sticks?;
    if sticks && speeds.is_some() {
        entry.contradiction(
            cx,
            &["stiction", "friction_speeds"],
            "friction that holds at rest sets in at once",
            "leave `friction_speeds` out, or `stiction`",
        );
        return None;
    }
    Some(match (sticks, speeds) {
        (true, _) => Some(FrictionOnset::Sticks),
        (false, Some(speeds)) => Some(FrictionOnset::Ramp(Some(speeds))),
        (false, None) => entry.has("stiction").then_some(FrictionOnset::Ramp(None)),
    })
}

fn friction_speeds(cx: &mut Context<'_>, entry: &Entry<'_>, node: &Node) -> Option<[Scalar; 2]> {
    let key = "friction_speeds";
    let place = entry.place_of(key);
    let (from, to) = entry.two(cx, node, key)?;
    let from = cx.positive(from, Dimension::SPEED, &place, true);
    let to = cx.positive(to, Dimension::SPEED, &place, true);
    let (from, to) = (from?, to?);
    if cx.number(&from) >= cx.number(&to) {
        return cx.refuse(
            "contradictory-values",
            format!("{place} do not rise"),
            &node.span,
            "the speed below which there is no friction stands first, then the one from which on there is all",
        );
    }
    Some([from, to])
}

/// A study of what play does.
pub(crate) fn study(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    along: MotionStudy,
) -> Option<StudyKind> {
    let model = model(cx, entry);
    let rates = entry.choice(cx, "rates", &RATES);
    let states = match model {
        Some(ClearanceModel::TwoState) => Some(ContactStates::Two),
        Some(ClearanceModel::ThreeState) => Some(ContactStates::Three),
        Some(ClearanceModel::Continuous) => {
            means_nothing(cx, entry, &IN_TIME, "where contact is never lost");
            None
        }
        None => None,
    };
    let motion = states.map(|states| {
        means_nothing(cx, entry, &["rates"], "where contact may be lost");
        let motion = simulate::in_time(cx, entry, along.clone(), false)?;
        Some(StudyKind::Contact(ContactStudy { states, motion }))
    });
    if cx.model.clearances.is_empty() && !cx.clearances_given {
        let message = format!("{} has no clearance to look at", entry.place);
        let help = format!("say where there is play: [clearance] {}", OF_ALL.example);
        return cx.refuse("missing-key", message, entry.span, help);
    }
    let (_, rates) = (model?, rates?);
    motion.unwrap_or_else(|| {
        let rates = rates.unwrap_or(ClearanceRates::Frozen);
        Some(StudyKind::Clearance(ClearanceStudy { along, rates }))
    })
}

/// Keys of a study in which contact may be lost.
const IN_TIME: [&str; 7] = [
    "until",
    "release",
    "start",
    "stops",
    "end_when",
    "tolerance",
    "method",
];

/// Warns of keys that mean nothing in this model.
fn means_nothing(cx: &mut Context<'_>, entry: &Entry<'_>, keys: &[&str], here: &str) {
    for (key, _) in keys.iter().filter_map(|key| entry.entry(key)) {
        let message = format!("`{}` of {} means nothing {here}", key.name, entry.place);
        cx.push(
            Diagnostic::warning("idle-key", message)
                .at(key.span.clone(), "")
                .help("leave it out, or ask for another `model`"),
        );
    }
}

/// Whether a study's contact may be lost: then its rows stand in time.
pub(crate) fn loses_contact(entry: &Entry<'_>) -> bool {
    let word = entry.get("model").map(|node| &node.value);
    matches!(word, Some(Value::Text(text)) if MODELS.iter().any(|(name, model)| {
        *name == text.content.trim() && *model != ClearanceModel::Continuous
    }))
}

fn model(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<ClearanceModel> {
    let model = entry.choice(cx, "model", &MODELS)?;
    Some(model.unwrap_or(ClearanceModel::Continuous))
}
