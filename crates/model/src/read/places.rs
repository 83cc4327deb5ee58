//! `[places]`: where points lie in one position of the mechanism, and links that list their points by name.
//!
//! ```toml
//! [places]
//! A = [0, 0]
//! B = [17, 11]
//! [links]
//! frame = ["A"]
//! crank = ["A", "B"]              # or { points = ["A", "B"], mass = "2 kg" }
//! ```
//!
//! A listed link becomes one with coordinates: its origin is its first point and its x axis points to its second; the frame
//! keeps the places' own coordinates. A distance between two listed points counts instead of the drawn one and moves the
//! later of them along the line from the other; two distances place it by the triangle, on the side that is drawn.

use std::collections::BTreeMap;

use kempe_units::{Builtin, Dimension, Expr};

use crate::bound::Keeps;
use crate::diagnostic::Diagnostic;
use crate::drawing::DrawnPlace;
use crate::geometry::place as evaluate_place;
use crate::ids::{FRAME, LinkId, PointId, Scalar, Span};
use crate::link::{Place, Side};
use crate::node::{Key, Node, Value};
use crate::read::algebra::{cross, dot, length, over, place_in_xy, plus, times, way};
use crate::read::context::Context;
use crate::read::draft::{Coordinates, Distance, Draft, SideOf};
use crate::read::names::{MAX_POINTS, is_point_name, long_name, pair_of};

/// An expression of a place has at most so many bytes: what follows from places repeats it, and must be written and read
/// again as one expression.
const MAX_EXPRESSION: usize = 128;

/// Two points nearer than this, in parts of their distance from the drawing's origin, are at one place: the direction from
/// one to the other would be that of rounding.
const APART: f64 = 1e-12;

/// Reads all places.
pub(crate) fn read(cx: &mut Context<'_>, entries: &[&(Key, Node)]) {
    for (key, node) in cx.limited(entries, MAX_POINTS, "places") {
        let name = key.name.as_str();
        if !is_point_name(name) {
            cx.push(
                Diagnostic::error("bad-name", format!("`{name}` cannot name a point"))
                    .at(key.span.clone(), "")
                    .help("points start with a capital letter and go on with letters, digits and _: A = [0, 0]"),
            );
            continue;
        }
        if long_name(cx, name, &key.span) {
            continue;
        }
        let at = read_place(cx, name, node);
        let Some(point) = cx.points.get(name).copied() else {
            let near = cx.points.keys().map(String::as_str);
            let near = kempe_units::nearest(name, near).map(str::to_owned);
            let d = Diagnostic::warning("idle-place", format!("no link uses the place of {name}"))
                .at(key.span.clone(), "no point of any link");
            cx.push(d.help(match near {
                Some(near) => format!("did you mean `{near}`? or name it in a link under [links]"),
                None => "name it in a link under [links], or leave it out".to_owned(),
            }));
            continue;
        };
        match at {
            Some(at) => {
                let span = key.span.clone();
                let place = DrawnPlace { at, span };
                cx.model.drawing.places.insert(point, place);
            }
            None => {
                cx.broken_places.insert(point);
            }
        }
    }
}

fn read_place(cx: &mut Context<'_>, name: &str, node: &Node) -> Option<[Scalar; 2]> {
    let items = match &node.value {
        Value::Array(items) => items.as_slice(),
        _ => &[],
    };
    for item in items {
        if let Value::Text(text) = &item.value
            && text.content.len() > MAX_EXPRESSION
        {
            let bytes = text.content.len();
            return cx.refuse(
                "too-long",
                format!("an expression of {bytes} bytes in the place of {name}"),
                &item.span,
                format!(
                    "one in [places] has at most {MAX_EXPRESSION}: give it a name under [parameters]"
                ),
            );
        }
    }
    let place = cx.place(node, &format!("the place of {name}"))?;
    place_in_xy(&place)
}

/// The points that a link lists, with the places of their names; `None` where the list is no list of names.
pub(crate) fn listed(
    cx: &mut Context<'_>,
    node: &Node,
    place: &str,
) -> Option<Vec<(PointId, Span)>> {
    let Value::Array(items) = &node.value else {
        let example = "[\"A\", \"B\"]";
        cx.wrong_type(
            node,
            &format!("the points of {place}"),
            "a list of names",
            example,
        );
        return None;
    };
    if items.is_empty() {
        return cx.refuse(
            "empty-link",
            format!("{place} has no points"),
            &node.span,
            "list the names of its points, as [places] has them: [\"A\", \"B\"]",
        );
    }
    let mut points: Vec<(PointId, Span)> = Vec::with_capacity(items.len());
    let mut first: BTreeMap<PointId, Span> = BTreeMap::new();
    let mut sound = true;
    for item in items {
        let Value::Text(text) = &item.value else {
            cx.wrong_type(item, &format!("a point of {place}"), "a name", "\"A\"");
            sound = false;
            continue;
        };
        let Some(point) = cx.point_text(text) else {
            sound = false;
            continue;
        };
        if let Some(other) = first.insert(point, item.span.clone()) {
            let name = cx.point_name(point).to_owned();
            cx.push(
                Diagnostic::error("duplicate-name", format!("{place} lists {name} twice"))
                    .at(item.span.clone(), "the second one")
                    .see(other, "the first one")
                    .help("leave one of them out"),
            );
            sound = false;
            continue;
        }
        points.push((point, item.span.clone()));
    }
    sound.then_some(points)
}

/// A distance that a link gives between two of its listed points.
pub(crate) struct Given {
    pub distance: Distance,
    /// Places of its two points in the list, rising.
    pub ends: [usize; 2],
}

/// The given distance of a key, where both its points are listed.
pub(crate) fn given(
    cx: &mut Context<'_>,
    points: &[(PointId, Span)],
    key: &Key,
    node: &Node,
) -> Option<Option<Given>> {
    let (a, b) = pair_of(&key.name)?;
    let index = |name: &str| {
        let id = cx.points.get(name)?;
        points.iter().position(|(point, _)| point == id)
    };
    let (i, j) = (index(a)?, index(b)?);
    if i == j {
        return None;
    }
    let what = format!("the distance {a}-{b}");
    let Some(length) = cx.positive(node, Dimension::LENGTH, &what, false) else {
        return Some(None);
    };
    let [first, second] = [i.min(j), i.max(j)];
    Some(Some(Given {
        distance: Distance {
            a: points.get(first)?.0,
            b: points.get(second)?.0,
            length,
            key: key.span.clone(),
            span: node.span.clone(),
        },
        ends: [first, second],
    }))
}

/// Enters the listed points of a link with the coordinates that follow from their places.
pub(crate) fn lay(
    cx: &mut Context<'_>,
    draft: &mut Draft,
    id: LinkId,
    what: &str,
    points: &[(PointId, Span)],
    given: Vec<Given>,
) {
    draft.listed = true;
    let mut at = Vec::with_capacity(points.len());
    for (point, span) in points {
        match cx.model.drawing.places.get(point) {
            Some(place) => at.push(place.at.clone()),
            None => {
                draft.broken = true;
                no_place(cx, *point, span, what);
            }
        }
    }
    if draft.broken || (id != FRAME && !apart(cx, what, points, &at)) {
        draft.broken = true;
        return;
    }
    cx.model.drawing.links.push(id);
    let drawn = on_the_link(cx, id, points, &at);
    let mut over: BTreeMap<usize, Vec<Given>> = BTreeMap::new();
    for one in given {
        over.entry(one.ends[1]).or_default().push(one);
    }
    // where the points lie that have coordinates; a corner of a triangle has none
    let mut laid: Vec<Option<[Scalar; 2]>> = Vec::with_capacity(points.len());
    for (i, (point, span)) in points.iter().enumerate() {
        let own = over.remove(&i).unwrap_or_default();
        let Some(here) = drawn.get(i) else { continue };
        let place = match own.as_slice() {
            [] => Some(here.clone()),
            [one] => {
                let from = one.ends[0];
                let (Some(Some(base)), Some(was)) = (laid.get(from), drawn.get(from)) else {
                    let (a, b) = (cx.point_name(one.distance.a), cx.point_name(one.distance.b));
                    let (message, help) = (
                        format!("{what}: in which direction from {a} does {b} lie?"),
                        format!(
                            "{a} is placed by two distances: give {b} two of them too, or list {b} before {a}"
                        ),
                    );
                    draft.broken = true;
                    cx.refuse::<()>("not-placed", message, &one.distance.key, help);
                    return;
                };
                Some(along(base, &way(was, here), &one.distance.length))
            }
            _ => None,
        };
        if let Some([x, y]) = place.clone() {
            draft.coordinates.push(Coordinates {
                point: *point,
                place: Place::Cartesian { x, y },
                span: span.clone(),
            });
        } else if let Some(side) = drawn_side(cx, what, points, &drawn, i, &own) {
            draft.sides.push(side);
            draft
                .distances
                .extend(own.into_iter().map(|one| one.distance));
        } else {
            draft.broken = true;
            return;
        }
        laid.push(place);
    }
}

/// The place at a distance from another in a direction.
fn along(from: &[Scalar; 2], direction: &[Scalar; 2], distance: &Scalar) -> [Scalar; 2] {
    let part = |i: usize, step: Scalar| match &from[i] {
        Expr::Const(0.0) => step,
        from => plus(from.clone(), step).fold(),
    };
    // along the link's own axis nothing is to be divided
    if let [Expr::Call(Builtin::Hypot, _), Expr::Const(0.0)] = direction {
        return [part(0, distance.clone()), from[1].clone()];
    }
    let size = length(direction);
    let step = |i: usize| over(times(distance.clone(), direction[i].clone()), size.clone()).fold();
    [part(0, step(0)), part(1, step(1))]
}

/// Places in the link's own coordinates.
fn on_the_link(
    cx: &mut Context<'_>,
    id: LinkId,
    points: &[(PointId, Span)],
    at: &[[Scalar; 2]],
) -> Vec<[Scalar; 2]> {
    let zero = || Expr::Const(0.0);
    let [origin, rest @ ..] = at else {
        return Vec::new();
    };
    if id == FRAME {
        return at.to_vec();
    }
    let mut own = vec![[zero(), zero()]];
    let Some(second) = rest.first() else {
        return own;
    };
    let axis = way(origin, second);
    let size = length(&axis);
    if let Some((_, span)) = points.get(1) {
        let what = "the drawn distance of the link's first two points";
        cx.bound(&size, span, what, Dimension::LENGTH, Keeps::Positive);
    }
    own.push([size.clone(), zero()]);
    for place in rest.iter().skip(1) {
        let to = way(origin, place);
        let part = |product: Scalar| over(product, size.clone()).fold();
        own.push([part(dot(&axis, &to)), part(cross(&axis, &to))]);
    }
    own
}

/// Whether the points of a link have places of their own; told where two have one.
fn apart(cx: &mut Context<'_>, what: &str, points: &[(PointId, Span)], at: &[[Scalar; 2]]) -> bool {
    let mut known: Vec<(usize, [f64; 2])> = Vec::with_capacity(at.len());
    for (i, [x, y]) in at.iter().enumerate() {
        known.push((i, [cx.number(x), cx.number(y)]));
    }
    // the link's own axis first, whatever lies between
    let mut pairs: Vec<_> = known.get(..2).into_iter().map(<[_]>::to_vec).collect();
    known.sort_by(|(_, p), (_, q)| p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1])));
    pairs.extend(known.windows(2).map(<[_]>::to_vec));
    let size = |p: [f64; 2]| p[0].abs() + p[1].abs();
    let one = pairs.iter().find_map(|pair| match pair.as_slice() {
        [(i, p), (j, q)] => {
            let least = APART * (size(*p) + size(*q));
            let off = (q[0] - p[0]).abs().max((q[1] - p[1]).abs());
            (off <= least).then_some((*i.min(j), *i.max(j)))
        }
        _ => None,
    });
    let Some((first, second)) = one else {
        return true;
    };
    let (Some((a, _)), Some((b, span))) = (points.get(first), points.get(second)) else {
        return true;
    };
    let (a_name, b_name) = (cx.point_name(*a).to_owned(), cx.point_name(*b).to_owned());
    let mut d = Diagnostic::error(
        "same-place",
        format!("{what}: {a_name} and {b_name} are drawn at one place"),
    )
    .at(span.clone(), "no distance and no direction between them");
    for point in [a, b] {
        if let Some(place) = cx.model.drawing.places.get(point) {
            d = d.see(place.span.clone(), "");
        }
    }
    cx.push(d.help("give one of them another place under [places], or list one of them alone"));
    false
}

fn no_place(cx: &mut Context<'_>, point: PointId, span: &Span, what: &str) {
    if cx.broken_places.contains(&point) {
        return;
    }
    let name = cx.point_name(point).to_owned();
    let drawn = cx.model.drawing.places.keys();
    let drawn: Vec<&str> = drawn.map(|p| cx.point_name(*p)).collect();
    let near = kempe_units::nearest(&name, drawn.iter().copied()).map(str::to_owned);
    let mut help = format!("say where it is drawn: {name} = [30, 42] under [places]");
    if let Some(near) = near {
        help += &format!("; or is `{near}` meant?");
    }
    cx.push(
        Diagnostic::error("no-place", format!("{what}: {name} has no place"))
            .at(span.clone(), "listed by name alone, and not drawn")
            .help(help),
    );
}

/// The side on which a point with two given distances is drawn, of the line between their other ends.
fn drawn_side(
    cx: &mut Context<'_>,
    what: &str,
    points: &[(PointId, Span)],
    drawn: &[[Scalar; 2]],
    i: usize,
    own: &[Given],
) -> Option<SideOf> {
    let [first, second, ..] = own else {
        return None;
    };
    let [from, to] = [first.ends[0], second.ends[0]];
    let [a, b, p] = [drawn.get(from)?, drawn.get(to)?, drawn.get(i)?];
    let (point, span) = points.get(i)?;
    if from == to {
        return cx.refuse(
            "over-specified",
            format!("{what}: the same distance twice"),
            &second.distance.key,
            "leave one of them out",
        );
    }
    let area = cross(&way(a, b), &way(a, p));
    let left = cx.number(&area) >= 0.0;
    let (side, signed) = match left {
        true => (Side::Left, area),
        false => (Side::Right, Expr::Neg(Box::new(area))),
    };
    let name = cx.point_name(*point).to_owned();
    let bound = format!("the side on which {name} is drawn");
    cx.bound(&signed, span, &bound, Dimension::AREA, Keeps::NotNegative);
    Some(SideOf {
        point: *point,
        side,
        from: points.get(from)?.0,
        to: points.get(to)?.0,
        span: second.distance.key.clone(),
    })
}

/// Where a point stands in the frame as drawn: a point of the frame where the frame has it, any other where it is drawn.
pub(crate) fn world(cx: &Context<'_>, point: PointId) -> Option<[Scalar; 2]> {
    let frame = cx.model.links.get(FRAME.index())?;
    let fixed = frame.points.iter().find(|p| p.point == point);
    match fixed {
        Some(fixed) => place_in_xy(&fixed.place),
        None => Some(cx.model.drawing.places.get(&point)?.at.clone()),
    }
}

/// Warns of points of the frame that the frame has elsewhere than they are drawn.
pub(crate) fn frame_as_drawn(cx: &mut Context<'_>) {
    let Some(frame) = cx.model.links.get(FRAME.index()) else {
        return;
    };
    if cx.model.drawing.links.first() == Some(&FRAME) {
        return;
    }
    let mut placed: Vec<[f64; 2]> = Vec::with_capacity(frame.points.len());
    let mut found = Vec::new();
    for point in &frame.points {
        let here = evaluate_place(&point.place, &placed, &cx.values);
        placed.push(here);
        let Some(drawn) = cx.model.drawing.places.get(&point.point) else {
            continue;
        };
        let there = [cx.number(&drawn.at[0]), cx.number(&drawn.at[1])];
        let off = kempe_number::math::hypot(there[0] - here[0], there[1] - here[1]);
        let size = here[0].abs() + here[1].abs() + there[0].abs() + there[1].abs();
        if off > ROUNDED * size {
            found.push((point.point, point.span.clone(), drawn.span.clone(), here));
        }
    }
    for (point, span, drawn, here) in found {
        let name = cx.point_name(point).to_owned();
        let [x, y] = here.map(|x| cx.show(x, Dimension::LENGTH));
        cx.push(
            Diagnostic::warning("not-as-drawn", format!("{name} is drawn elsewhere than on the frame"))
                .at(drawn, "drawn here")
                .see(span, format!("the frame has it at [{x}, {y}]"))
                .help("the frame counts: leave its place out, or list the points of the frame by name, frame = [\"A\", \"D\"]"),
        );
    }
}

/// Places this near each other, in parts of their size, are the same but for digits that were left out.
const ROUNDED: f64 = 1e-6;
