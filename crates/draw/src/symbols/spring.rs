//! Coil springs: a zigzag that stretches.

use super::part::Part;
use crate::context::{Anchor, Context};
use crate::scene::{Item, Layer, Path, Point, Style};
use crate::tokens::Token;

/// Number of coils.
const COILS: usize = 8;
/// Half the width, mm.
const HALF: f64 = 2.0;

pub(super) fn parts(context: &Context, a: usize, b: usize) -> Option<Part> {
    context.span(a, b)?;
    let mut points: Vec<Point> = vec![[0.0, 0.0], [0.15, 0.0]];
    for k in 0..2 * COILS {
        let x = 0.15 + 0.7 * (k as f64 + 0.5) / (2 * COILS) as f64;
        points.push([x, if k % 2 == 0 { HALF } else { -HALF }]);
    }
    points.extend([[0.85, 0.0], [1.0, 0.0]]);
    let item = Item::path(Path::polyline(&points), Style::stroke(Token::Ink, 0.4));
    Some(Part::new(Layer::Body, Anchor::Between(a, b), vec![item]))
}
