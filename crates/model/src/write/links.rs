//! `[links]`: points by coordinates and distances, in an order in which the reader numbers and places them as they are.

use kempe_units::{Dimension, Expr};

use crate::ids::{LinkId, PointId, Scalar};
use crate::item::{File, Item};
use crate::key_table::{SIDES, word_of};
use crate::link::{Center, Inertia, Link, LinkPoint, Place, Side};
use crate::write::spelling::Writer;

impl Writer<'_> {
    pub fn links(&self, file: &mut File) {
        // A file that asks for linkages alone has a frame that it does not tell.
        if let [frame] = self.model.links.as_slice()
            && frame.points.is_empty()
        {
            return;
        }
        let links = self.model.links.iter().enumerate();
        *file.section("links") = links
            .map(|(i, link)| (link.name.clone(), self.one_link(LinkId(i as u32), link)))
            .collect();
    }

    fn one_link(&self, id: LinkId, link: &Link) -> Item {
        let mut entries = Vec::new();
        let order = self.order(id, link);
        let bar = self.bar(link, &order);
        let along = along(link, &order);
        // the distance that numbers the along point, where one does
        let mut numbering = None;
        if let Some((a, b, length)) = bar {
            entries.push(self.distance(a, b, length));
        }
        let laid = |p: &LinkPoint| bar.is_some_and(|(a, b, _)| p.point == a || p.point == b);
        for point in order.iter().filter(|p| !laid(p)) {
            let item = match &point.place {
                Place::Triangle { from, to, side, .. } => self.side(link, (*from, *to), *side),
                _ if along.is_some_and(|(b, _)| b == point.point) => {
                    numbering = numbered_by(link, &order, point.point);
                    let distance = numbering.map(|(end, d)| self.distance(point.point, end, d));
                    entries.extend(distance);
                    continue;
                }
                place => self.place(place),
            };
            entries.push((self.point(point.point).to_owned(), item));
        }
        if let (Some((b, length)), Some(a)) = (along, link.points.first()) {
            entries.push(self.distance(a.point, b, length));
        }
        for point in &link.points {
            let Place::Triangle {
                from,
                to,
                from_distance,
                to_distance,
                ..
            } = &point.place
            else {
                continue;
            };
            for (end, distance) in [(from, from_distance), (to, to_distance)] {
                let end = link.points.get(*end).map_or(point.point, |p| p.point);
                let diagnostic = (numbering.zip(along))
                    .is_some_and(|((of, _), (b, _))| (of, b) == (point.point, end));
                if !diagnostic {
                    entries.push(self.distance(end, point.point, distance));
                }
            }
        }
        if let Some(inertia) = &link.inertia {
            self.inertia(inertia, &mut entries);
        }
        Item::Table(entries)
    }

    /// The link's points in the order of their keys: points are numbered as their keys come, and those with coordinates are
    /// placed so. A point that the link names first comes in the order of its number, the others where they are placed.
    fn order<'l>(&self, id: LinkId, link: &'l Link) -> Vec<&'l LinkPoint> {
        let is_new = |p: &LinkPoint| {
            let known = self.model.points.get(p.point.index());
            known.and_then(|known| known.links.first()) == Some(&id)
        };
        let mut new: Vec<&LinkPoint> = link.points.iter().filter(|p| is_new(p)).collect();
        new.sort_by_key(|p| p.point);
        let mut new = new.into_iter().peekable();
        let mut order: Vec<&LinkPoint> = Vec::with_capacity(link.points.len());
        for point in &link.points {
            if !is_new(point) {
                order.push(point);
            } else if !matches!(point.place, Place::Triangle { .. }) {
                // those with a smaller number stand before it, if they do not stand already
                while let Some(next) = new.next_if(|next| next.point <= point.point) {
                    order.push(next);
                }
            }
        }
        order.extend(new);
        order
    }

    /// The pair that lays the link's x axis: its first two points, one at the origin and the other on the axis.
    fn bar<'l>(
        &self,
        link: &'l Link,
        order: &[&LinkPoint],
    ) -> Option<(PointId, PointId, &'l Scalar)> {
        let [a, b, ..] = link.points.as_slice() else {
            return None;
        };
        let zero = |scalar: &Scalar| matches!(scalar, Expr::Const(x) if x.to_bits() == 0);
        let (Place::Cartesian { x: ax, y: ay }, Place::Cartesian { x: length, y: by }) =
            (&a.place, &b.place)
        else {
            return None;
        };
        let first = order.iter().map(|p| p.point).take(2);
        let positive = crate::value(length, &self.model.parameter_values::<f64>()) > 0.0;
        (zero(ax) && zero(ay) && zero(by) && positive && first.eq([a.point, b.point]))
            .then_some((a.point, b.point, length))
    }

    fn distance(&self, a: PointId, b: PointId, length: &Scalar) -> (String, Item) {
        let key = format!("{}-{}", self.point(a), self.point(b));
        (key, self.scalar(length, Dimension::LENGTH))
    }

    fn end(&self, link: &Link, index: usize) -> &str {
        link.points.get(index).map_or("?", |p| self.point(p.point))
    }

    /// `left of A -> B`.
    fn side(&self, link: &Link, (from, to): (usize, usize), side: Side) -> Item {
        let (from, to) = (self.end(link, from), self.end(link, to));
        Item::Text(format!("{} of {from} -> {to}", word_of(&SIDES, &side)))
    }

    /// A place by its coordinates; a corner of a triangle has none.
    pub fn place(&self, place: &Place) -> Item {
        let length = |scalar: &Scalar| self.scalar(scalar, Dimension::LENGTH);
        match place {
            Place::Cartesian { x, y } => Item::List(vec![length(x), length(y)]),
            // a bare number would be a length
            Place::Polar { radius, angle } => Item::List(vec![
                length(radius),
                self.expression(angle, Dimension::ANGLE),
            ]),
            Place::Triangle { .. } => Item::List(Vec::new()),
        }
    }

    fn inertia(&self, inertia: &Inertia, entries: &mut Vec<(String, Item)>) {
        let mut given = |key: &str, value: &Option<Scalar>, dimension: Dimension| {
            let item = value.as_ref().map(|v| self.scalar(v, dimension));
            entries.extend(item.map(|item| (key.to_owned(), item)));
        };
        given("mass", &inertia.mass, Dimension::MASS);
        given("inertia", &inertia.moment, Dimension::INERTIA);
        let center = match &inertia.center {
            Center::Centroid => return,
            Center::Point(point) => Item::text(self.point(*point)),
            Center::Place(place) => self.place(place),
        };
        entries.push(("center".to_owned(), center));
    }
}

/// The second point of a link and its distance from the first, along the x axis, where the second has the smaller number:
/// only a distance places a point behind one whose key comes later.
fn along<'l>(link: &'l Link, order: &[&LinkPoint]) -> Option<(PointId, &'l Scalar)> {
    let placed = |p: &&LinkPoint| !matches!(p.place, Place::Triangle { .. });
    let keys = order.iter().copied().filter(placed).map(|p| p.point);
    let in_order = keys.eq(link.points.iter().filter(placed).map(|p| p.point));
    let [_, b, ..] = link.points.as_slice() else {
        return None;
    };
    match &b.place {
        Place::Cartesian {
            x: Expr::Add(_, length),
            ..
        } if !in_order => Some((b.point, length)),
        _ => None,
    }
}

/// A corner with a distance to the point `b`, so that the key of that distance gives `b` its number and no corner another
/// place: the corner has its number already or gets it here, and it is the first over its line.
fn numbered_by<'l>(
    link: &'l Link,
    order: &[&LinkPoint],
    b: PointId,
) -> Option<(PointId, &'l Scalar)> {
    let here = order.iter().position(|p| p.point == b)?;
    let mut first_over_both = true;
    for point in &link.points {
        let Place::Triangle {
            from,
            to,
            from_distance,
            to_distance,
            ..
        } = &point.place
        else {
            continue;
        };
        // the point `b` is the link's second
        let distance = match (*from, *to) {
            (1, _) => from_distance,
            (_, 1) => to_distance,
            _ => continue,
        };
        let over_both = from + to == 1;
        let first = !over_both || std::mem::take(&mut first_over_both);
        let at = order.iter().position(|p| p.point == point.point)?;
        if first && at <= here + 1 {
            return Some((point.point, distance));
        }
    }
    None
}
