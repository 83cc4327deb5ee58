//! Where the label of an arrow stands: beyond its tip or beside it, the same over the whole motion.

use super::Shape;
use crate::scene::{Align, Point, Text};
use crate::text::width;

/// Font size, mm.
pub(crate) const SIZE: f64 = 2.8;
/// Longest label, mm.
pub(super) const LONGEST: f64 = 26.0;
/// Directions to stand off a tip, turned from the arrow's own, as cosine and sine.
pub(crate) const SIDES: [Point; 5] = [
    [1.0, 0.0],
    [0.5, 0.866],
    [0.5, -0.866],
    [-0.2, 0.98],
    [-0.2, -0.98],
];

/// A box on paper: lower left and upper right corner.
pub(super) type Box2 = [Point; 2];

/// Middle of a label of a width at a shape.
pub(super) fn middle(shape: &Shape, side: usize, wide: f64) -> Point {
    let (tip, along) = shape.tip();
    let [c, s] = SIDES.get(side).copied().unwrap_or(SIDES[0]);
    let away = [along[0] * c - along[1] * s, along[0] * s + along[1] * c];
    [
        tip[0] + away[0] * (wide / 2.0 + 1.0),
        tip[1] + away[1] * (SIZE / 2.0 + 1.0),
    ]
}

/// The room that a label takes.
pub(super) fn room(label: &str, shape: &Shape, side: usize) -> Box2 {
    let wide = width(label, SIZE);
    let [x, y] = middle(shape, side, wide);
    [
        [x - wide / 2.0, y - SIZE / 2.0],
        [x + wide / 2.0, y + SIZE / 2.0],
    ]
}

/// The label itself.
pub(super) fn text(label: &str, shape: &Shape, side: usize) -> Text {
    let [x, y] = middle(shape, side, width(label, SIZE));
    Text {
        halo: true,
        ..Text::new([x, y - SIZE * 0.36], SIZE, label).aligned(Align::Middle)
    }
}

/// Area that two boxes share, mm².
pub(super) fn overlap(a: &Box2, b: &Box2) -> f64 {
    let along = |k: usize| (a[1][k].min(b[1][k]) - a[0][k].max(b[0][k])).max(0.0);
    along(0) * along(1)
}

/// About how much of a line from `from` to `to` runs through a box, mm.
pub(super) fn crossing(a: &Box2, from: Point, to: Point) -> f64 {
    let steps = 12;
    let inside = |k: &i32| {
        let t = f64::from(*k) / f64::from(steps);
        (0..2).all(|i| {
            let v = from[i] + t * (to[i] - from[i]);
            v > a[0][i] && v < a[1][i]
        })
    };
    let length = crate::scene::distance(from, to);
    (0..=steps).filter(inside).count() as f64 / f64::from(steps + 1) * length
}
