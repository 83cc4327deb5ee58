//! From what a link says of its points to a place for each.

use std::collections::{BTreeMap, BTreeSet};

use kempe_units::{Dimension, Expr};

use crate::diagnostic::Diagnostic;
use crate::geometry::place as evaluate_place;
use crate::ids::{PointId, Span};
use crate::link::{LinkPoint, Place};
use crate::read::context::Context;
use crate::read::draft::{Distance, Draft, SideOf};

/// Places the points of a link: first those with coordinates and the pair that lays the x axis, then, round after round, those with two
/// distances to points already placed.
pub(crate) fn place_points(
    cx: &mut Context<'_>,
    draft: &Draft,
    what: &str,
    link: &Span,
) -> Vec<LinkPoint> {
    let mut maker = Maker {
        placed: Vec::new(),
        values: Vec::new(),
        index: BTreeMap::new(),
        used: vec![false; draft.distances.len()],
    };
    let sided: BTreeMap<PointId, &SideOf> = draft.sides.iter().map(|s| (s.point, s)).collect();
    maker.lay(cx, draft, &sided, what);
    maker.grow(cx, draft, &sided, what);
    maker.leftovers(cx, draft, &sided, what, link);
    maker.placed
}

struct Maker {
    placed: Vec<LinkPoint>,
    /// Their coordinates with the parameters' values.
    values: Vec<[f64; 2]>,
    index: BTreeMap<PointId, usize>,
    /// Distances that have placed something.
    used: Vec<bool>,
}

impl Maker {
    fn put(&mut self, cx: &Context<'_>, point: PointId, place: Place, span: Span) {
        self.values
            .push(evaluate_place(&place, &self.values, &cx.values));
        self.index.insert(point, self.placed.len());
        self.placed.push(LinkPoint { point, place, span });
    }

    /// Coordinates, and the pair that lays the x axis.
    fn lay(
        &mut self,
        cx: &mut Context<'_>,
        draft: &Draft,
        sided: &BTreeMap<PointId, &SideOf>,
        what: &str,
    ) {
        let given: BTreeMap<PointId, usize> = draft
            .coordinates
            .iter()
            .enumerate()
            .map(|(i, c)| (c.point, i))
            .collect();
        let free = |p: PointId| !given.contains_key(&p) && !sided.contains_key(&p);
        let base = draft.distances.iter().position(|d| free(d.a) && free(d.b));
        let zero = || Expr::Const(0.0);
        for (point, span) in &draft.points {
            if let Some(c) = given.get(point).and_then(|i| draft.coordinates.get(*i)) {
                if let Some(side) = sided.get(point) {
                    self.over(cx, *point, what, side.span.clone(), c.span.clone());
                }
                self.put(cx, *point, c.place.clone(), c.span.clone());
            } else if let Some((i, d)) = base.and_then(|i| Some((i, draft.distances.get(i)?))) {
                if d.a == *point {
                    self.put(
                        cx,
                        d.a,
                        Place::Cartesian {
                            x: zero(),
                            y: zero(),
                        },
                        span.clone(),
                    );
                } else if d.b == *point {
                    self.put(
                        cx,
                        d.b,
                        Place::Cartesian {
                            x: d.length.clone(),
                            y: zero(),
                        },
                        span.clone(),
                    );
                }
                if let Some(used) = self.used.get_mut(i) {
                    *used = true;
                }
            }
        }
        // one point by coordinates and another by its distance from it: along the x axis
        let along = draft.distances.iter().enumerate().find(|(_, d)| {
            base.is_none() && draft.coordinates.len() == 1 && given.contains_key(&d.a) && free(d.b)
        });
        if let Some((i, d)) = along
            && let Some(LinkPoint {
                place: Place::Cartesian { x, y },
                ..
            }) = self.placed.first()
        {
            let x = Expr::Add(Box::new(x.clone()), Box::new(d.length.clone()));
            let place = Place::Cartesian { x, y: y.clone() };
            self.put(cx, d.b, place, d.key.clone());
            if let Some(used) = self.used.get_mut(i) {
                *used = true;
            }
        }
    }

    /// Points by two distances, as long as there are any.
    fn grow(
        &mut self,
        cx: &mut Context<'_>,
        draft: &Draft,
        sided: &BTreeMap<PointId, &SideOf>,
        what: &str,
    ) {
        // distances by the point they end in
        let mut touching: BTreeMap<PointId, Vec<usize>> = BTreeMap::new();
        for (i, d) in draft.distances.iter().enumerate() {
            touching.entry(d.a).or_default().push(i);
            touching.entry(d.b).or_default().push(i);
        }
        // distances to placed points, for points that have none yet or one
        let mut waiting: BTreeMap<PointId, Vec<(usize, PointId)>> = BTreeMap::new();
        let spans: BTreeMap<PointId, &Span> =
            draft.points.iter().map(|(p, span)| (*p, span)).collect();
        let mut next = 0;
        while let Some(reached) = self.placed.get(next).map(|p| p.point) {
            next += 1;
            for i in touching.get(&reached).into_iter().flatten() {
                let Some(d) = draft.distances.get(*i) else {
                    continue;
                };
                let point = if d.a == reached { d.b } else { d.a };
                if self.index.contains_key(&point) {
                    continue;
                }
                let ends = waiting.entry(point).or_default();
                ends.push((*i, reached));
                let [(i, from), (j, to)] = ends.as_slice() else {
                    continue;
                };
                let ((i, from), (j, to)) = if i < j {
                    ((*i, *from), (*j, *to))
                } else {
                    ((*j, *to), (*i, *from))
                };
                let (Some(first), Some(second)) = (draft.distances.get(i), draft.distances.get(j))
                else {
                    continue;
                };
                let (Some(from), Some(to)) = (self.index.get(&from), self.index.get(&to)) else {
                    continue;
                };
                let span = spans.get(&point).map_or(0..0, |s| (*s).clone());
                self.corner(
                    cx,
                    (point, span),
                    (first, *from),
                    (second, *to),
                    sided.get(&point).copied(),
                    what,
                );
                for i in [i, j] {
                    if let Some(used) = self.used.get_mut(i) {
                        *used = true;
                    }
                }
            }
        }
    }

    /// Places `point` by its distances to two placed points. It counts as placed even if something is wrong.
    fn corner(
        &mut self,
        cx: &mut Context<'_>,
        (point, span): (PointId, Span),
        (first, from): (&Distance, usize),
        (second, to): (&Distance, usize),
        side: Option<&SideOf>,
        what: &str,
    ) {
        let name = cx.point_name(point).to_owned();
        let end = |i: usize| self.placed.get(i).map(|p| p.point);
        let (Some(a), Some(b)) = (end(from), end(to)) else {
            return;
        };
        let (a_name, b_name) = (cx.point_name(a).to_owned(), cx.point_name(b).to_owned());
        let mut triangle = Place::Triangle {
            from,
            to,
            from_distance: first.length.clone(),
            to_distance: second.length.clone(),
            side: crate::link::Side::Left,
        };
        match side {
            None => cx.push(
                Diagnostic::error("side-missing", format!("{what}: on which side of {a_name} -> {b_name} does {name} lie?"))
                    .at(first.key.clone(), format!("two distances leave two places for {name}"))
                    .see(second.key.clone(), "")
                    .help(format!(
                        "add {name} = \"left of {a_name} -> {b_name}\" or {name} = \"right of {a_name} -> {b_name}\""
                    )),
            ),
            Some(s) => {
                if let Place::Triangle { from: f, to: t, from_distance, to_distance, side } = &mut triangle {
                    *side = s.side;
                    if (s.from, s.to) == (b, a) {
                        std::mem::swap(f, t);
                        std::mem::swap(from_distance, to_distance);
                    } else if (s.from, s.to) != (a, b) {
                        cx.push(
                            Diagnostic::error("side-missing", format!("{what}: the side of {name} is told of another line"))
                                .at(s.span.clone(), format!("{name} has distances to {a_name} and {b_name}"))
                                .help(format!(
                                    "tell it of the line between these two: \"left of {a_name} -> {b_name}\" or \"right of {a_name} -> {b_name}\""
                                )),
                        );
                    }
                }
            }
        }
        self.put(cx, point, triangle, span);
        self.check_closes(
            cx,
            (first, second),
            (from, to),
            (&name, &a_name, &b_name),
            what,
        );
    }

    /// Whether the triangle of the two distances over the placed points `from`, `to` closes with the parameters' values.
    fn check_closes(
        &mut self,
        cx: &mut Context<'_>,
        (first, second): (&Distance, &Distance),
        (from, to): (usize, usize),
        (name, a_name, b_name): (&str, &str, &str),
        what: &str,
    ) {
        let (Some(p), Some(q)) = (self.values.get(from), self.values.get(to)) else {
            return;
        };
        let d = kempe_number::math::hypot(q[0] - p[0], q[1] - p[1]);
        let (ra, rb) = (cx.number(&first.length), cx.number(&second.length));
        let slack = FLAT * (ra + rb + d);
        if !d.is_finite() || (ra + rb >= d - slack && (ra - rb).abs() <= d + slack && d > 0.0) {
            return;
        }
        let show = |x: f64| cx.show(x, Dimension::LENGTH);
        let (message, note, help) = if d == 0.0 {
            (
                format!("{what}: {a_name} and {b_name} are at one place"),
                format!("two distances to one place do not say where {name} lies"),
                "give one of them another place, or give the third point by coordinates",
            )
        } else {
            (
                format!("{what}: the triangle {name}, {a_name}, {b_name} cannot close"),
                format!(
                    "{name}-{a_name} is {}, {name}-{b_name} is {}, {a_name}-{b_name} is {}",
                    show(ra),
                    show(rb),
                    show(d)
                ),
                "each side of a triangle is shorter than the other two together",
            )
        };
        cx.push(
            Diagnostic::error("triangle-open", message)
                .at(first.span.clone(), show(ra))
                .see(second.span.clone(), show(rb))
                .help(help)
                .note(note),
        );
    }

    /// What has not placed anything is too little or too much.
    fn leftovers(
        &mut self,
        cx: &mut Context<'_>,
        draft: &Draft,
        sided: &BTreeMap<PointId, &SideOf>,
        what: &str,
        link: &Span,
    ) {
        if draft.broken {
            return;
        }
        for (d, _) in draft
            .distances
            .iter()
            .zip(&self.used)
            .filter(|(_, used)| !**used)
        {
            let (a, b) = (cx.point_name(d.a).to_owned(), cx.point_name(d.b).to_owned());
            if self.index.contains_key(&d.a) && self.index.contains_key(&d.b) {
                cx.push(
                    Diagnostic::error(
                        "over-specified",
                        format!("{what}: {a} and {b} are placed without this distance"),
                    )
                    .at(d.key.clone(), "one value too many")
                    .help("leave it out, or leave out something else that places one of the two"),
                );
            }
        }
        for (point, span) in &draft.points {
            if self.index.contains_key(point) || cx.full() {
                continue;
            }
            let name = cx.point_name(*point).to_owned();
            let count = draft
                .distances
                .iter()
                .filter(|d| d.a == *point || d.b == *point)
                .count();
            let found = match (count, sided.contains_key(point)) {
                (0, true) => "it has a side but no distances".to_owned(),
                (1, _) => "it has only one distance".to_owned(),
                _ => "its distances go to points that have no place themselves".to_owned(),
            };
            cx.push(
                Diagnostic::error("not-placed", format!("{what}: where is {name}? {found}"))
                    .at(span.clone(), "")
                    .help(format!(
                        "a point is placed by coordinates, {name} = [10, 5], or by its distances to two points that are placed, and its side"
                    )),
            );
        }
        let given: BTreeSet<PointId> = draft.coordinates.iter().map(|c| c.point).collect();
        for s in &draft.sides {
            let corner = self.index.get(&s.point).and_then(|i| self.placed.get(*i));
            if let Some(LinkPoint {
                place: Place::Cartesian { .. } | Place::Polar { .. },
                ..
            }) = corner
                && !given.contains(&s.point)
            {
                self.over(cx, s.point, what, s.span.clone(), link.clone());
            }
        }
    }

    fn over(&self, cx: &mut Context<'_>, point: PointId, what: &str, span: Span, other: Span) {
        let name = cx.point_name(point).to_owned();
        cx.push(
            Diagnostic::error(
                "over-specified",
                format!("{what}: {name} is placed without its side"),
            )
            .at(span, "one thing too many")
            .see(other, "placed here")
            .help("leave the side out, or the coordinates"),
        );
    }
}

/// A triangle may be this much of its size away from closing and still counts as flat: rounding of values like 0.1 + 0.2.
const FLAT: f64 = 1e-12;
