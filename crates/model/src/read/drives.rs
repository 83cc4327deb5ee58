//! `[drives]`: what is moved from outside.

use crate::diagnostic::Diagnostic;
use crate::drive::{Drive, DriveKind, Released};
use crate::ids::{DriveId, FRAME, JointId, LinkId};
use crate::joint::JointKind;
use crate::key_table::DRIVES;
use crate::keys::Kind;
use crate::node::{Key, Node};
use crate::read::context::{Context, Meaning};
use crate::read::drawn;
use crate::read::ends::ends;
use crate::read::entry::Entry;
use crate::read::laws::read_law;

/// A file has at most so many drives.
const MAX_DRIVES: usize = 1_000;

/// Reads all drives.
pub(crate) fn read(cx: &mut Context<'_>, entries: &[&(Key, Node)]) {
    for entry in cx.limited(entries, MAX_DRIVES, "drives") {
        let drive = read_drive(cx, entry);
        let id = DriveId(cx.model.drives.len() as u32);
        cx.drives.push(drive.is_some().then_some(id));
        if let Some(drive) = drive {
            same_coordinate(cx, &drive);
            cx.model.drives.push(drive);
        }
    }
}

fn read_drive(cx: &mut Context<'_>, (key, node): &(Key, Node)) -> Option<Drive> {
    let place = format!("drive `{}`", key.name);
    let example = DRIVES[0].example;
    let table = cx.table(node, &place, example)?;
    let kinds = DRIVES.iter().filter(|kind| table.get(kind.name).is_some());
    let kind = match kinds.collect::<Vec<_>>().as_slice() {
        [one] => **one,
        [] => {
            let names = DRIVES.map(|kind| kind.name);
            let own = |k: &&(Key, Node)| !how_it_moves(DRIVES[0]).any(|key| key == k.0.name);
            let near = table
                .entries
                .iter()
                .filter(own)
                .find_map(|(k, _)| Some((k, kempe_units::nearest(&k.name, names)?)));
            let help = match near {
                Some((written, near)) => format!("`{}`: did you mean `{near}`?", written.name),
                None => format!(
                    "a drive turns a link, is a cylinder between two points, or slides a slider: {example}"
                ),
            };
            cx.push(
                Diagnostic::error("missing-key", format!("{place}: what does it move?"))
                    .at(key.span.clone(), "")
                    .help(help),
            );
            let meant = near.and_then(|(written, near)| {
                Some((written, DRIVES.iter().find(|kind| kind.name == near)?))
            });
            if let Some((written, kind)) = meant {
                // what it moves is left alone, how it moves is read as meant
                let mut known = kind.names();
                known.retain(|name| *name != kind.name);
                known.insert(0, &written.name);
                cx.unknown_keys(table, &place, &known);
                read_law(cx, &Entry::of(table, &key.span, place, kind).moving(), None);
            }
            return None;
        }
        [first, second, ..] => {
            return cx.refuse(
                "over-specified",
                format!("{place} has both `{}` and `{}`", first.name, second.name),
                &key.span,
                "a drive moves one thing: make two drives of it",
            );
        }
    };
    let entry = Entry::inner(cx, node, &key.span, place, kind)?.moving();
    let kind_read = match kind.name {
        "turns" => turns(cx, &entry),
        "cylinder" => cylinder(cx, &entry),
        _ => slides(cx, &entry),
    };
    let drawn = kind_read.as_ref().map(|kind| drawn::coordinate(cx, kind));
    let law = read_law(cx, &entry, drawn);
    let lasts: Option<f64> = law.as_ref().map(|law| law.duration(&cx.values));
    if lasts.is_some_and(|t| !t.is_finite()) {
        let place = &entry.place;
        cx.push(
            Diagnostic::error("not-finite", format!("{place} never comes to its end"))
                .at(key.span.clone(), "lasts beyond all numbers")
                .help("give it a larger speed or acceleration"),
        );
    }
    Some(Drive {
        name: key.name.clone(),
        kind: kind_read?,
        law: law?,
        dimension: entry.dimension("from"),
        span: key.span.clone(),
    })
}

/// The keys of a kind of drive that say how it moves.
fn how_it_moves(kind: &Kind) -> impl Iterator<Item = &'static str> + use<> {
    let groups = kind.groups.iter().skip(1);
    groups.flat_map(|keys| keys.iter()).map(|key| key.name)
}

impl Entry<'_> {
    /// The entry of a drive: its coordinate is an angle where it turns, a length elsewhere.
    fn moving(mut self) -> Self {
        self.turning = self.kind.name == "turns";
        self
    }
}

fn turns(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<DriveKind> {
    let place = &entry.place;
    let link = entry.link(cx, "turns");
    let relative_to = entry.link_or_frame(cx, "relative_to");
    let (link, relative_to) = (link?, relative_to?);
    if link == relative_to {
        let name = cx.link_name(link).to_owned();
        let d = if link == FRAME {
            Diagnostic::error(
                "same-link",
                format!("{place} turns the frame, which stands still"),
            )
            .help(
                "name the link that turns, or say relative to which link: relative_to = \"plate\"",
            )
        } else {
            Diagnostic::error(
                "same-link",
                format!("{place} turns `{name}` against itself"),
            )
            .help("relative_to names another link")
        };
        cx.push(d.at(entry.span.clone(), ""));
        return None;
    }
    Some(DriveKind::Turn { link, relative_to })
}

fn cylinder(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<DriveKind> {
    let place = &entry.place;
    let node = entry.get("cylinder")?;
    let text = entry.text(cx, "cylinder", node)?;
    let (a, b) = cx.pair_phrase(text)?;
    if a == b {
        return cx.refuse(
            "same-link",
            format!("{place} is between a point and itself"),
            &node.span,
            "a cylinder is between two points of different links",
        );
    }
    if cx
        .carriers(a)
        .iter()
        .any(|l| cx.carriers(b).binary_search(l).is_ok())
    {
        let (a_name, b_name) = (cx.point_name(a).to_owned(), cx.point_name(b).to_owned());
        return cx.refuse(
            "same-link",
            format!(
                "{place}: {a_name} and {b_name} are on one link, so their distance cannot change"
            ),
            &node.span,
            "a cylinder takes the place of a bar: leave that bar out of [links]",
        );
    }
    let ([a, b], warning) = ends(cx, entry, [a, b])?;
    cx.of_forces.extend(warning);
    Some(DriveKind::Cylinder { a, b })
}

fn slides(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<DriveKind> {
    let place = &entry.place;
    let node = entry.get("slides")?;
    let text = entry.text(cx, "slides", node)?;
    let name = text.content.trim().to_owned();
    let span = text.span(0..text.content.len());
    match cx.names.get(&name).map(|(m, _)| *m) {
        Some(Meaning::Joint(i)) => {
            let id = cx.joints.get(i).copied().flatten()?;
            if guided(cx, id).is_some() {
                return Some(DriveKind::Slide { joint: id });
            }
            cx.push(
                Diagnostic::error(
                    "not-a-slider",
                    format!("{place}: joint `{name}` does not slide"),
                )
                .at(span, "")
                .help("name a slider, its joint, or the joint of a pin in a straight slot"),
            );
            None
        }
        Some(Meaning::Link(link)) => joint_of_slider(cx, link, &name, place, span),
        _ => {
            let known: Vec<String> = cx
                .names
                .iter()
                .filter(|(_, (m, _))| matches!(m, Meaning::Joint(_) | Meaning::Link(_)))
                .map(|(n, _)| n.clone())
                .collect();
            let d = cx.no_such("slider", &name, span, known.iter().map(String::as_str));
            cx.push(d);
            None
        }
    }
}

/// The link that a joint guides along a line.
fn guided(cx: &Context<'_>, joint: JointId) -> Option<LinkId> {
    match cx.model.joints.get(joint.index())?.kind {
        JointKind::Slider { at, .. } => Some(at.link),
        JointKind::Slot { pin, .. } => Some(pin.link),
        _ => None,
    }
}

fn joint_of_slider(
    cx: &mut Context<'_>,
    link: LinkId,
    name: &str,
    place: &str,
    span: crate::ids::Span,
) -> Option<DriveKind> {
    let all: Vec<JointId> = (0..cx.model.joints.len())
        .map(|i| JointId(i as u32))
        .filter(|id| guided(cx, *id) == Some(link))
        .collect();
    match all.as_slice() {
        [joint] => Some(DriveKind::Slide { joint: *joint }),
        [] => {
            // a broken joint of its own has been told
            if cx.joints.iter().all(Option::is_some) {
                cx.push(
                    Diagnostic::error("not-a-slider", format!("{place}: link `{name}` does not slide along a line"))
                        .at(span, "")
                        .help(format!("guide it under [joints]: guide = {{ slider = \"{name}\", at = \"C\", on = \"E -> F\" }}")),
                );
            }
            None
        }
        _ => {
            let names: Vec<&str> = all
                .iter()
                .filter_map(|id| cx.model.joints.get(id.index()))
                .map(|j| j.name.as_str())
                .collect();
            let help = format!("name the joint that is meant: {}", names.join(" or "));
            cx.push(
                Diagnostic::error(
                    "not-a-slider",
                    format!("{place}: link `{name}` slides along several lines"),
                )
                .at(span, "")
                .help(help),
            );
            None
        }
    }
}

/// Two drives of one coordinate contradict each other.
fn same_coordinate(cx: &mut Context<'_>, drive: &Drive) {
    let key = |kind: &DriveKind| match *kind {
        DriveKind::Turn { link, relative_to } => {
            (0, link.0.min(relative_to.0), link.0.max(relative_to.0))
        }
        DriveKind::Cylinder { a, b } => (1, a.point.0.min(b.point.0), a.point.0.max(b.point.0)),
        DriveKind::Slide { joint } => (2, joint.0, 0),
        DriveKind::Release {
            of: Released::Joint(joint),
            row,
        } => (3 + row, joint.0, 0),
        DriveKind::Release {
            of: Released::Pin { point, link },
            row,
        } => (5 + row, point.0, link.0),
        // Files cannot say it.
        DriveKind::StandIn(_) => (u8::MAX, 0, 0),
    };
    let Some(other) = cx
        .model
        .drives
        .iter()
        .find(|d| key(&d.kind) == key(&drive.kind))
    else {
        return;
    };
    let (name, span) = (other.name.clone(), other.span.clone());
    cx.push(
        Diagnostic::error(
            "driven-twice",
            format!("drives `{name}` and `{}` move the same thing", drive.name),
        )
        .at(drive.span.clone(), "")
        .see(span, "")
        .help("leave one of them out"),
    );
}
