//! Two links made one: a filled square.

use super::ground;
use super::part::Part;
use crate::context::{Anchor, Context};
use crate::scene::{Item, Layer, Path, Style};
use crate::tokens::Token;

/// Half the side of the square, mm.
const HALF: f64 = 1.5;

pub(super) fn parts(context: &Context, at: usize, links: [usize; 2]) -> Vec<Part> {
    let [a, b] = links;
    if a >= context.view.links.len() || b >= context.view.links.len() {
        return Vec::new();
    }
    let square = Path::rectangle([-HALF, -HALF], [HALF, HALF], 0.4);
    let style = Style::stroke(Token::Background, 0.25).filled(Token::Ink, 1.0);
    let mut parts = vec![Part::new(
        Layer::Joint,
        Anchor::On(at, a.max(b), 0.0),
        vec![Item::path(square, style)],
    )];
    if a == 0 || b == 0 {
        parts.push(Part::new(
            Layer::Ground,
            Anchor::Point(at),
            ground::hatched_line(-3.7, 3.7, -HALF, true),
        ));
    }
    parts
}
