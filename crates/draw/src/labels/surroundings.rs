//! What is drawn around labels in one pose, and how much it would suffer from a label on top of it.

use super::conflict::{OVERLAP, touching};
use super::extent::Extent;
use super::room::Room;
use crate::scene::{Group, Item, Layer, Path, Point, Style, distance};

/// Of so many pieces of a cell that follow each other it is known where they are, so that most need not be looked at.
const TOGETHER: usize = 8;
/// Lines are cut into pieces of this length, mm, each kept in the cell of its middle.
const PIECE: f64 = 4.0;
/// Side of a cell, mm.
const CELL: f64 = 8.0;
/// More cells than this along a side are not made.
const MOST_CELLS: usize = 700;
/// More pieces than this are not looked at.
const MOST_PIECES: usize = 60_000;
/// Arcs become polygons so near to them, mm.
const SAGITTA: f64 = 0.15;
/// From a label to the edge of the sheet there is at least so much, mm.
const EDGE: f64 = 1.0;
/// Thin lines, such as hatching, mm.
const THIN: f64 = 0.3;

/// A straight piece of a line.
#[derive(Clone, Copy)]
struct Piece {
    from: Point,
    to: Point,
    weight: f64,
}

/// The pieces of a cell, in the order in which they came.
#[derive(Clone, Default)]
struct Cell {
    pieces: Vec<Piece>,
    /// Where so many of them are that follow each other.
    extents: Vec<Extent>,
}

impl Cell {
    fn push(&mut self, piece: Piece) {
        if self.pieces.len().is_multiple_of(TOGETHER) {
            self.extents.push(Extent::NONE);
        }
        if let Some(extent) = self.extents.last_mut() {
            extent.add(piece.from);
            extent.add(piece.to);
        }
        self.pieces.push(piece);
    }

    /// The pieces that may lie in a box, around which this place is, and some beside it.
    fn near(&self, place: Extent, room: Room) -> impl Iterator<Item = &Piece> {
        let together = self.pieces.chunks(TOGETHER).zip(&self.extents);
        together
            .filter(move |(_, extent)| extent.meets(&place) && extent.meets_room(&room))
            .flat_map(|(pieces, _)| pieces)
    }
}

/// A closed line around a body, and where it is.
struct Body {
    corners: Vec<Point>,
    extent: Extent,
}

/// What a label on a body costs: beside it, it is easier to read.
const ON_BODY: f64 = 2.5;
/// More bodies than this are not looked at.
const MOST_BODIES: usize = 500;

/// One pose without its labels.
pub(crate) struct Surroundings {
    sheet: Point,
    cells: [usize; 2],
    pieces: Vec<Cell>,
    count: usize,
    texts: Vec<Room>,
    bodies: Vec<Body>,
}

/// What a label on top of a line of a layer costs, for each mm of the line.
fn weight(layer: Layer, style: &Style) -> f64 {
    let line = match layer {
        Layer::Joint | Layer::Drive => 12.0,
        // heads of arrows are filled
        Layer::Load(_) | Layer::Vector if style.fill.is_some() => 12.0,
        Layer::Load(_) | Layer::Vector => 5.0,
        Layer::Furniture | Layer::LoadLegend | Layer::Caption => 8.0,
        Layer::Body => 3.0,
        Layer::Link(_) | Layer::Curve(_) | Layer::Limit => 2.5,
        Layer::Ground => 2.0,
        Layer::Gear => 1.2,
        Layer::TracePast => 0.6,
        Layer::TraceRest | Layer::Ghost | Layer::OtherTrace | Layer::Other => 0.4,
        Layer::Dimension | Layer::Label | Layer::LoadLabel(_) => 0.0,
    };
    match style.fill.is_none() && style.width < THIN {
        true => 0.4 * line,
        false => line,
    }
}

impl Surroundings {
    /// Of a sheet of the given width and height, mm, with what is drawn on it.
    pub fn new(sheet: Point, groups: &[Group]) -> Surroundings {
        let cells = sheet.map(|side| ((side / CELL).ceil().max(1.0) as usize).min(MOST_CELLS));
        let mut around = Surroundings {
            sheet,
            cells,
            pieces: vec![Cell::default(); cells[0] * cells[1]],
            count: 0,
            texts: Vec::new(),
            bodies: Vec::new(),
        };
        groups.iter().for_each(|group| around.add(group));
        around
    }

    fn add(&mut self, group: &Group) {
        for item in &group.items {
            match item {
                Item::Shape { paths, style } => {
                    let weight = weight(group.layer, style);
                    let solid = matches!(group.layer, Layer::Link(_) | Layer::Body);
                    for path in paths {
                        let outline = self.path(path, group, weight);
                        let body = solid && style.fill.is_some() && path.closed;
                        if body && self.bodies.len() < MOST_BODIES {
                            let extent = Extent::around(outline.iter().copied());
                            self.bodies.push(Body {
                                corners: outline,
                                extent,
                            });
                        }
                    }
                }
                Item::Circle {
                    center,
                    radius,
                    style,
                } => {
                    let weight = weight(group.layer, style);
                    let half = |start| Path::arc(*center, *radius, start, std::f64::consts::PI);
                    for start in [0.0, std::f64::consts::PI] {
                        self.path(&half(start), group, weight);
                    }
                }
                Item::Text(text) => self.texts.extend(Room::of_text(text, &group.place)),
            }
        }
    }

    /// Takes in a path and returns its corners on paper.
    fn path(&mut self, path: &Path, group: &Group, weight: f64) -> Vec<Point> {
        let mut corners = Vec::new();
        if weight <= 0.0 {
            return corners;
        }
        for (from, to, bulge) in path.segments() {
            let mut last = group.place.apply(from);
            for next in crate::scene::arc_points(from, to, bulge, SAGITTA) {
                let next = group.place.apply(next);
                self.line(last, next, weight);
                corners.push(next);
                last = next;
            }
        }
        corners
    }

    fn line(&mut self, from: Point, to: Point, weight: f64) {
        let long = distance(from, to);
        let count = (long / PIECE).ceil().max(1.0);
        if !(long.is_finite() && count < MOST_PIECES as f64) {
            return;
        }
        let at = |k: f64| [0, 1].map(|i| from[i] + (to[i] - from[i]) * k / count);
        for k in 0..count as usize {
            let (from, to) = (at(k as f64), at(k as f64 + 1.0));
            let middle = [0, 1].map(|i: usize| (from[i] + to[i]) / 2.0);
            let inside = (0..2).all(|i| middle[i] > -PIECE && middle[i] < self.sheet[i] + PIECE);
            if inside && self.count < MOST_PIECES {
                self.count += 1;
                let cell = self.cell(middle);
                self.pieces[cell[0] + self.cells[0] * cell[1]].push(Piece { from, to, weight });
            }
        }
    }

    fn cell(&self, p: Point) -> [usize; 2] {
        [0, 1].map(|i| {
            let along = p[i] / self.sheet[i].max(CELL) * self.cells[i] as f64;
            (along.max(0.0) as usize).min(self.cells[i] - 1)
        })
    }

    fn near(&self, room: &Room) -> impl Iterator<Item = &Piece> {
        let (room, middle, reach) = (*room, room.middle, room.reach());
        let place = Extent::of_room(&room);
        let low = self.cell([0, 1].map(|i| middle[i] - reach[i] - PIECE / 2.0));
        let high = self.cell([0, 1].map(|i| middle[i] + reach[i] + PIECE / 2.0));
        (low[1]..=high[1])
            .flat_map(move |y| (low[0]..=high[0]).map(move |x| x + self.cells[0] * y))
            .flat_map(move |cell| self.pieces[cell].near(place, room))
    }

    /// What lies under a label.
    pub fn covered(&self, room: &Room) -> f64 {
        let under = |p: &Piece| p.weight * room.holds(p.from, p.to);
        let texts = self.texts.iter().map(|text| touching(room, text));
        let middle = Extent::around([room.middle]);
        let on_body = (self.bodies.iter())
            .any(|body| body.extent.meets(&middle) && within(&body.corners, room.middle));
        let body = if on_body { ON_BODY } else { 0.0 };
        body + self.near(room).map(under).sum::<f64>() + texts.sum::<f64>() + self.outside(room)
    }

    /// How often a line of a label, such as a leader, crosses what is drawn.
    pub fn crossed(&self, line: [Point; 2]) -> f64 {
        let thin = Room::of_line(line, 0.2);
        let crossed = |p: &Piece| match thin.holds(p.from, p.to) > 0.0 {
            true => p.weight,
            false => 0.0,
        };
        let texts = self.texts.iter().map(|text| touching(&thin, text));
        self.near(&thin).map(crossed).sum::<f64>() + texts.sum::<f64>() + self.outside(&thin)
    }

    fn outside(&self, room: &Room) -> f64 {
        let reach = room.reach();
        let beyond = |i: usize| {
            let (low, high) = (room.middle[i] - reach[i], room.middle[i] + reach[i]);
            (EDGE - low).max(0.0) + (high - self.sheet[i] + EDGE).max(0.0)
        };
        match beyond(0) + beyond(1) {
            0.0 => 0.0,
            mm => OVERLAP * (1.0 + mm),
        }
    }
}

/// Whether a point lies in a polygon.
fn within(corners: &[Point], [x, y]: Point) -> bool {
    let ends = corners.iter().zip(corners.iter().cycle().skip(1));
    let right = |(a, b): &(&Point, &Point)| {
        (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
    };
    ends.filter(right).count() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tokens::Token;

    /// Every piece of every cell, one by one.
    fn covered_by_all(around: &Surroundings, room: &Room) -> f64 {
        let all = around.pieces.iter().flat_map(|cell| &cell.pieces);
        all.map(|p| p.weight * room.holds(p.from, p.to)).sum()
    }

    #[test]
    fn what_is_not_looked_at_counts_for_nothing() {
        let mut last = 0.3;
        let mut dice = |size: f64| {
            last = (last * 997.0 + 0.123) % 1.0;
            last * size
        };
        let lines = (0..300).map(|_| {
            let from = [dice(150.0), dice(90.0)];
            Path::polyline(&[
                from,
                [from[0] + dice(30.0) - 15.0, from[1] + dice(30.0) - 15.0],
            ])
        });
        let lines: Vec<Path> = lines.collect();
        let style = Style::stroke(Token::Ink, 0.5);
        let item = Item::Shape {
            paths: lines,
            style,
        };
        let around = Surroundings::new([150.0, 90.0], &[Group::new(Layer::Joint, vec![item])]);
        let mut hits = 0;
        for _ in 0..500 {
            let from = [dice(150.0), dice(90.0)];
            let to = [from[0] + dice(40.0) - 20.0, from[1] + dice(40.0) - 20.0];
            for room in [
                Room::of_line([from, to], 0.2),
                Room::upright([75.0, 45.0], to),
            ] {
                let near: f64 = (around.near(&room))
                    .map(|p| p.weight * room.holds(p.from, p.to))
                    .sum();
                let all = covered_by_all(&around, &room);
                hits += usize::from(all > 0.0);
                // the same numbers in the same order
                assert_eq!(near, all, "{room:?}");
            }
        }
        assert!(hits > 300, "{hits}");
    }
}
