//! `[links]`: points by coordinates, by distances and by names alone, mass properties.

use kempe_units::Dimension;

use crate::diagnostic::Diagnostic;
use crate::ids::{FRAME, LinkId, PointId, Span};
use crate::key_table::LINKS;
use crate::link::Center;
use crate::node::{Key, Node, Table, Value};
use crate::read::context::Context;
use crate::read::draft::{Coordinates, Distance, Draft, SideOf};
use crate::read::entry::Entry;
use crate::read::masses::{mass_of_frame, read_inertia};
use crate::read::names::{LISTED, is_point_name, pair_of};
use crate::read::place::place_points;
use crate::read::places;

/// Reads all links, of which the entries begin with the link `first`; without `whole` the section itself could not be read, and is
/// not to be missed.
pub(crate) fn read(cx: &mut Context<'_>, entries: &[&(Key, Node)], first: usize, whole: bool) {
    if whole && entries.first().is_none_or(|(key, _)| key.name != "frame") {
        let d = Diagnostic::error("no-frame", "the file has no link `frame`");
        let d = match entries.first() {
            Some((key, _)) if first == 0 => d.at(key.span.clone(), "perhaps this is meant"),
            Some((key, _)) => d.at(key.span.clone(), "the first link"),
            None => d,
        };
        cx.push(d.help("the link that stands still is called frame: frame = { A = [0, 0], D = [60, 0] } under [links]"));
    }
    for (i, (key, node)) in entries.iter().enumerate() {
        read_link(cx, LinkId((first + i) as u32), key, node);
    }
}

fn read_link(cx: &mut Context<'_>, id: LinkId, key: &Key, node: &Node) {
    let place = format!("link `{}`", key.name);
    let empty = Table::default();
    let (table, list) = match &node.value {
        Value::Array(_) => (&empty, Some(node)),
        _ => {
            let Some(table) = cx.table(node, &place, LINKS.example) else {
                return;
            };
            (table, table.get(LISTED))
        }
    };
    let mut draft = Draft::default();
    let listed = list.and_then(|list| places::listed(cx, list, &place));
    draft.broken = list.is_some() && listed.is_none();
    let listed = listed.unwrap_or_default();
    for (point, span) in &listed {
        note_point(&mut draft, *point, span);
    }
    let mut distances = Vec::new();
    for (key, value) in &table.entries {
        match places::given(cx, &listed, key, value) {
            Some(Some(distance)) => distances.push(distance),
            Some(None) => draft.broken = true,
            None => read_entry(cx, &mut draft, &place, &listed, key, value),
        }
    }
    if !listed.is_empty() {
        places::lay(cx, &mut draft, id, &place, &listed, distances);
    }
    if draft.points.is_empty() && !draft.broken {
        cx.push(
            Diagnostic::error("empty-link", format!("{place} has no points"))
                .at(key.span.clone(), "")
                .help("a link is its points: give their coordinates, A = [0, 0], their distances, A-B = 20, or the names of points that [places] draws, [\"A\", \"B\"]"),
        );
    }
    let points = place_points(cx, &draft, &place, &key.span);
    let entry = Entry::of(table, &key.span, place.clone(), &LINKS);
    if id == FRAME {
        mass_of_frame(cx, &entry);
    }
    let inertia = read_inertia(cx, &entry, (&draft, &points), |cx, node| {
        read_center(cx, node, &draft, &place)
    });
    if points.len() < draft.points.len() {
        cx.broken.lose_points();
    }
    if let Some(link) = cx.model.links.get_mut(id.index()) {
        link.points = points;
        link.inertia = inertia;
    }
}

fn read_entry(
    cx: &mut Context<'_>,
    draft: &mut Draft,
    place: &str,
    listed: &[(PointId, Span)],
    key: &Key,
    value: &Node,
) {
    let name = key.name.as_str();
    if LINKS.key(name).is_some() {
        return;
    }
    let known = |cx: &Context<'_>, name: &str| cx.points.get(name).copied();
    if let Some((a, b)) = pair_of(name) {
        if a == b {
            draft.broken = true;
            cx.push(
                Diagnostic::error("bad-size", format!("the distance of {a} to itself"))
                    .at(key.span.clone(), "")
                    .help("a distance is between two points: A-B = 20"),
            );
            return;
        }
        let (Some(a_id), Some(b_id)) = (known(cx, a), known(cx, b)) else {
            return;
        };
        note_point(draft, a_id, &key.span);
        note_point(draft, b_id, &key.span);
        match cx.positive(
            value,
            Dimension::LENGTH,
            &format!("the distance {a}-{b}"),
            false,
        ) {
            Some(length) => draft.distances.push(Distance {
                a: a_id,
                b: b_id,
                length,
                key: key.span.clone(),
                span: value.span.clone(),
            }),
            None => draft.broken = true,
        }
    } else if is_point_name(name) {
        let Some(point) = known(cx, name) else { return };
        if let Some((_, list)) = listed.iter().find(|(listed, _)| *listed == point) {
            draft.broken = true;
            let message = format!("{place}: {name} is listed, and so placed as it is drawn");
            cx.push(
                Diagnostic::error("over-specified", message)
                    .at(key.span.clone(), "one thing too many")
                    .see(list.clone(), "listed here")
                    .help("leave this out, or take the point out of the list"),
            );
            return;
        }
        note_point(draft, point, &key.span);
        let read = match &value.value {
            Value::Text(text) => cx.side_phrase(text).map(|(side, line)| {
                draft.sides.push(SideOf {
                    point,
                    side,
                    from: line.from,
                    to: line.to,
                    span: value.span.clone(),
                });
            }),
            _ => cx
                .place(value, &format!("the place of {name}"))
                .map(|place| {
                    draft.coordinates.push(Coordinates {
                        point,
                        place,
                        span: key.span.clone(),
                    });
                }),
        };
        draft.broken |= read.is_none();
    } else {
        draft.broken = true;
        let capital = capitalised(name);
        if matches!(value.value, Value::Array(_))
            || (name.contains('-') && pair_of(&capital).is_some())
        {
            cx.push(
                Diagnostic::error("bad-name", format!("`{name}` cannot name a point"))
                    .at(key.span.clone(), "points start with a capital letter")
                    .help(format!("write `{capital}`")),
            );
        } else {
            cx.unknown_key(key, place, &LINKS.names());
        }
    }
}

/// The name with a capital at the start of each of its points.
fn capitalised(name: &str) -> String {
    let upper = |part: &str| {
        let mut letters = part.chars();
        letters
            .next()
            .map_or(String::new(), |c| c.to_uppercase().chain(letters).collect())
    };
    name.split('-')
        .map(|part| upper(part.trim()))
        .collect::<Vec<_>>()
        .join("-")
}

fn note_point(draft: &mut Draft, point: PointId, span: &Span) {
    if draft.known.insert(point) {
        draft.points.push((point, span.clone()));
    }
}

fn read_center(cx: &mut Context<'_>, node: &Node, draft: &Draft, place: &str) -> Option<Center> {
    let Value::Text(text) = &node.value else {
        return cx
            .place(node, &format!("the center of {place}"))
            .map(Center::Place);
    };
    if text.content.trim() == "centroid" {
        return Some(Center::Centroid);
    }
    if !is_point_name(text.content.trim()) {
        return cx.refuse(
            "wrong-type",
            format!("the center of {place} is not known"),
            &node.span,
            "write center = \"centroid\", the name of one of the link's points, or [x, y]",
        );
    }
    let point = cx.point_text(text)?;
    if !draft.known.contains(&point) {
        let name = cx.point_name(point).to_owned();
        return cx.refuse("point-not-on-link", format!("{name} is not a point of {place}"), &node.span, format!(
                "name a point of the link itself, or write the center as a place on it, [x, y]; {name} is on other links"
            ));
    }
    Some(Center::Point(point))
}
