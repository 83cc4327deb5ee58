//! Hydraulic cylinders and dampers: a barrel at the foot, a rod to the eye.

use super::part::{LINE, Part};
use crate::context::{Anchor, Context};
use crate::scene::{Item, Layer, Path, Style};
use crate::tokens::Token;

/// Share of the shortest length that the barrel takes.
const BARREL: f64 = 0.82;

pub(super) fn cylinder(context: &Context, a: usize, b: usize) -> Vec<Part> {
    let Some((shortest, _)) = context.span(a, b) else {
        return Vec::new();
    };
    let length = (shortest * BARREL).max(shortest - 6.0).max(1.0);
    let half = (length / 6.0).clamp(1.2, 2.3);
    let steel = Style::stroke(Token::Ink, LINE);
    let start = 1.2_f64.min(length / 2.0);
    let gland = (length - 1.6).max(start);
    let barrel = vec![
        Item::path(
            Path::rectangle([start, -half], [length, half], 0.5),
            steel.clone().filled(Token::Panel, 1.0),
        ),
        Item::path(
            Path::rectangle([gland, -half], [length, half], 0.3),
            steel.filled(Token::Ground, 0.5),
        ),
        Item::path(
            Path::polyline(&[[0.0, 0.0], [start, 0.0]]),
            Style::stroke(Token::Ink, 1.0),
        ),
    ];
    vec![
        rod(a, b, half * 0.42, Token::Ground),
        Part::new(Layer::Body, Anchor::Toward(a, b), barrel),
    ]
}

pub(super) fn damper(context: &Context, a: usize, b: usize) -> Vec<Part> {
    let Some((shortest, longest)) = context.span(a, b) else {
        return Vec::new();
    };
    let line = Style::stroke(Token::Ink, LINE);
    let (x0, x2) = (shortest * 0.2, shortest * 0.9);
    // the piston stays in the pot over the stroke where that is possible
    let rod = (longest - 0.85 * shortest).clamp(0.15 * shortest, 0.75 * shortest);
    let pot = Path::polyline(&[[x2, 1.9], [x0, 1.9], [x0, -1.9], [x2, -1.9]]);
    let body = vec![
        Item::path(
            Path::rectangle([x0, -1.9], [x2, 1.9], 0.0),
            Style::fill(Token::Background),
        ),
        Item::path(pot, line.clone()),
        Item::path(Path::polyline(&[[0.0, 0.0], [x0, 0.0]]), line.clone()),
    ];
    let piston = vec![
        Item::path(Path::polyline(&[[0.0, 0.0], [rod, 0.0]]), line.clone()),
        Item::path(
            Path::polyline(&[[rod, -1.5], [rod, 1.5]]),
            Style::stroke(Token::Ink, 0.8),
        ),
    ];
    vec![
        Part::new(Layer::Body, Anchor::Toward(a, b), body),
        Part::new(Layer::Body, Anchor::Toward(b, a), piston),
    ]
}

/// A straight rod from the first point to the second.
fn rod(a: usize, b: usize, half: f64, token: Token) -> Part {
    let shape = Path::rectangle([0.0, -half], [1.0, half], 0.0);
    let style = Style::fill(token);
    Part::new(
        Layer::Body,
        Anchor::Between(a, b),
        vec![Item::path(shape, style)],
    )
}
