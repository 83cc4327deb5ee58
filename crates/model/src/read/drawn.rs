//! What follows from a drawing: how links stand in it, where drives start and which assembly is meant.
//!
//! Every link begins with the angle at which it is drawn, from -180 to 180 degrees. What wheels and racks count with between two
//! links (phases, offsets, welds, drives) is the plain difference of these, which may be half a turn or more.

use std::collections::BTreeSet;

use kempe_units::Expr;

use crate::diagnostic::Diagnostic;
use crate::drive::DriveKind;
use crate::hint::{AssemblyHint, HintKind};
use crate::ids::{DriveId, FRAME, Line, LinkId, PointId, Scalar};
use crate::joint::JointKind;
use crate::link::LinkPoint;
use crate::read::algebra::{
    cross, direction, dot, length, minus, over, place_in_xy, plus, times, turn, way,
};
use crate::read::context::Context;
use crate::read::entry::Entry;
use crate::read::places::world;

/// The angle of a link's x axis as drawn, rad: of the frame zero, of others that of the way between two of their points.
pub(crate) fn angle(cx: &Context<'_>, id: LinkId) -> Option<Scalar> {
    if id == FRAME {
        return Some(Expr::Const(0.0));
    }
    let link = cx.model.links.get(id.index())?;
    let drawn = |p: &LinkPoint| Some((place_in_xy(&p.place)?, world(cx, p.point)?));
    let mut points = link.points.iter().filter_map(drawn);
    let (own, at) = points.next()?;
    let apart = |own_way: &[Scalar; 2], way: &[Scalar; 2]| {
        cx.number(&length(own_way)) > 0.0 && cx.number(&length(way)) > 0.0
    };
    let mut ways = points.map(|(own_next, next)| (way(&own, &own_next), way(&at, &next)));
    let (own, drawn) = ways.find(|(own, drawn)| apart(own, drawn))?;
    // along the link's own x axis
    let along = matches!(own, [_, Expr::Const(y)] if y == 0.0) && cx.number(&own[0]) > 0.0;
    Some(match along {
        true => direction(&drawn),
        false => direction(&[dot(&own, &drawn), cross(&own, &drawn)]),
    })
}

/// The angle of a link that lists its points, of which the drawing alone says where its x axis points; also of the frame.
pub(crate) fn listed_angle(cx: &Context<'_>, id: LinkId) -> Option<Scalar> {
    let listed = id == FRAME || cx.model.drawing.links.binary_search(&id).is_ok();
    let some = !cx.model.drawing.links.is_empty();
    (listed && some).then(|| angle(cx, id)).flatten()
}

/// The direction of a line as drawn, rad.
pub(crate) fn line_angle(cx: &Context<'_>, line: &Line) -> Option<Scalar> {
    let along = way(&world(cx, line.from)?, &world(cx, line.to)?);
    (cx.number(&length(&along)) > 0.0).then(|| direction(&along))
}

/// The coordinate of a drive as drawn.
pub(crate) fn coordinate(cx: &Context<'_>, kind: &DriveKind) -> Option<Scalar> {
    if cx.model.drawing.places.is_empty() {
        return None;
    }
    let found = match *kind {
        DriveKind::Turn { link, relative_to } => {
            let (from, to) = (angle(cx, relative_to)?, angle(cx, link)?);
            match cx.model.counts_turns() {
                true => minus(&to, &from).fold(),
                false => turn(&from, &to),
            }
        }
        DriveKind::Cylinder { a, b } => length(&way(&world(cx, a.point)?, &world(cx, b.point)?)),
        DriveKind::Slide { joint } => {
            let (at, on) = cx.model.joints.get(joint.index())?.kind.guide()?;
            let from = world(cx, on.from)?;
            let along = way(&from, &world(cx, on.to)?);
            let to = way(&from, &world(cx, at.point)?);
            over(dot(&along, &to), length(&along)).fold()
        }
        DriveKind::Release { .. } | DriveKind::StandIn(_) => return None,
    };
    let x = cx.number(&found);
    // a cylinder drawn without length has none
    let sound = x.is_finite() && (x > 0.0 || !matches!(kind, DriveKind::Cylinder { .. }));
    sound.then_some(found)
}

/// Tells links that list one point alone, where nothing but their drawing could say how they stand.
pub(crate) fn single_points(cx: &mut Context<'_>) {
    // a broken joint may hold any of them
    if cx.joints.iter().any(Option::is_none) {
        return;
    }
    let holds = |kind: &JointKind| {
        let slot = matches!(
            kind,
            JointKind::Slot { .. } | JointKind::ArcSlot { .. } | JointKind::CurveSlot { .. }
        );
        let (a, b) = kind.links();
        (!slot).then_some([a, b])
    };
    let joints = cx.model.joints.iter();
    let held: BTreeSet<LinkId> = joints.filter_map(|j| holds(&j.kind)).flatten().collect();
    let mut found = Vec::new();
    for id in &cx.model.drawing.links {
        let Some(link) = cx.model.links.get(id.index()) else {
            continue;
        };
        if *id != FRAME && link.points.len() == 1 && !held.contains(id) {
            found.push((link.name.clone(), link.span.clone()));
        }
    }
    for (name, span) in found {
        cx.push(
            Diagnostic::error("one-point", format!("link `{name}` lists one point: it has no length and no direction"))
                .at(span, "")
                .help("list two points or more, [\"A\", \"B\"]; a link of one point slides, is a wheel or is welded, as a joint under [joints] says"),
        );
    }
}

/// Says which assembly is meant: the one that is drawn, unless the file says so itself.
///
/// Hints of the file are about the start of the drives: where a drive starts elsewhere than drawn, they alone count.
pub(crate) fn assemble(cx: &mut Context<'_>, file: &Entry<'_>) {
    if cx.model.drawing.places.is_empty() {
        return;
    }
    let drives = cx.model.drives.iter().enumerate();
    let drawn = drives.filter_map(|(index, drive)| {
        let drawn = coordinate(cx, &drive.kind)?;
        (drawn.fold() != drive.law.from.fold()).then_some((DriveId(index as u32), drawn))
    });
    cx.model.drawing.coordinates = drawn.collect();
    if file.has("assembly") && !cx.model.starting_elsewhere(&cx.values).is_empty() {
        cx.model.drawing.coordinates.clear();
        return;
    }
    let mut hints = Vec::new();
    // points and links of which something is said or known besides
    let (mut points, mut links) = (BTreeSet::new(), BTreeSet::from([FRAME]));
    for hint in &cx.model.assembly {
        match hint.kind {
            HintKind::Side { point, .. } | HintKind::NearPlace { point, .. } => {
                points.insert(point);
            }
            HintKind::NearAngle { link, .. } => {
                links.insert(link);
            }
        }
    }
    links.extend(cx.model.drives.iter().filter_map(|drive| match drive.kind {
        DriveKind::Turn {
            link,
            relative_to: FRAME,
        } => Some(link),
        _ => None,
    }));
    for (point, place) in &cx.model.drawing.places {
        if cx.carriers(*point).contains(&FRAME) || points.contains(point) {
            continue;
        }
        let [x, y] = place.at.clone();
        let kind = HintKind::NearPlace {
            point: *point,
            x,
            y,
        };
        let span = place.span.clone();
        hints.push(AssemblyHint { kind, span });
    }
    for (index, link) in cx.model.links.iter().enumerate() {
        let id = LinkId(index as u32);
        if !links.contains(&id)
            && let Some(angle) = angle(cx, id)
        {
            let kind = HintKind::NearAngle { link: id, angle };
            let span = link.span.clone();
            hints.push(AssemblyHint { kind, span });
        }
    }
    cx.model.drawing.hints = hints.len();
    cx.model.assembly.extend(hints);
}

/// The angle from one link to another as drawn, where the drawing says how both stand: by how much the one begins with more.
pub(crate) fn angle_between(cx: &Context<'_>, from: LinkId, to: LinkId) -> Option<Scalar> {
    Some(minus(&listed_angle(cx, to)?, &listed_angle(cx, from)?).fold())
}

/// How far a point is drawn along the x axis of a link that lists its points, from its origin.
pub(crate) fn travel(cx: &Context<'_>, link: LinkId, point: PointId) -> Option<Scalar> {
    let at = world(cx, point)?;
    if link == FRAME {
        listed_angle(cx, link)?;
        return Some(at[0].clone());
    }
    cx.model.drawing.links.binary_search(&link).ok()?;
    let mut points = cx.model.links.get(link.index())?.points.iter();
    let origin = world(cx, points.next()?.point)?;
    let along = way(&origin, &world(cx, points.next()?.point)?);
    Some(over(dot(&along, &way(&origin, &at)), length(&along)).fold())
}

/// The phase of two wheels as drawn, rad: where the first stands on the arm when the second is parallel to the arm. For a
/// turn of the second the first makes `ratio` turns, backwards where they turn against each other.
pub(crate) fn phase(
    cx: &Context<'_>,
    [a, b, arm]: [LinkId; 3],
    ratio: Scalar,
    against: bool,
) -> Option<Scalar> {
    let first = angle_between(cx, arm, a)?;
    let second = times(ratio, angle_between(cx, arm, b)?);
    Some(
        match against {
            true => plus(first, second),
            false => minus(&first, &second),
        }
        .fold(),
    )
}
