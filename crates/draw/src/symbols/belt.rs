//! Belts and chains: around both wheels and straight between them, a chain dash-dotted.

use std::f64::consts::PI;

use kempe_number::math::{atan2, sin_cos};

use super::part::Part;
use crate::context::{Anchor, Context};
use crate::scene::{Item, Layer, Path, Point, Style, Vertex, distance};
use crate::tokens::Token;
use crate::view::Wheel;

/// Width of the line, mm.
const WIDTH: f64 = 0.6;
/// Dashes of a chain, mm.
const CHAIN: [f64; 4] = [2.2, 0.8, 0.6, 0.8];

pub(super) fn parts(
    context: &Context,
    [a, b]: [Wheel; 2],
    crossed: bool,
    chain: bool,
) -> Option<Part> {
    let frame = context.reference?;
    let apart = distance(
        context.paper(frame, a.center)?,
        context.paper(frame, b.center)?,
    );
    let radius = |wheel: Wheel| wheel.radius.abs() * context.fit.scale;
    let outline = around(radius(a), radius(b), apart, crossed)?;
    let style = Style::stroke(Token::Ink, WIDTH);
    let style = if chain { style.dashed(&CHAIN) } else { style };
    Some(Part::new(
        Layer::Body,
        Anchor::Toward(a.center, b.center),
        vec![Item::path(outline, style)],
    ))
}

/// The line of a belt around a wheel at the origin and one on the x axis; `None` where they leave no room for its runs.
fn around(first: f64, second: f64, apart: f64, crossed: bool) -> Option<Path> {
    // A crossed belt touches the second wheel on the other side of each run.
    let far = if crossed { -second } else { second };
    let cosine = (first - far) / apart;
    if !(cosine.abs() < 1.0) {
        return None;
    }
    let lean = atan2((1.0 - cosine * cosine).sqrt(), cosine);
    let on = |x: f64, r: f64, angle: f64| -> Point {
        let (s, c) = sin_cos(angle);
        [x + r * c, r * s]
    };
    let bulge = |sweep: f64| {
        let (s, c) = sin_cos(sweep / 4.0);
        s / c
    };
    let back = 2.0 * (PI - lean);
    // Round the back of the first wheel from the upper run to the lower, and round the far side of the second.
    let front = if crossed { -back } else { 2.0 * lean };
    let vertex = |at, bulge| Vertex { at, bulge };
    Some(Path {
        vertices: vec![
            vertex(on(0.0, first, lean), bulge(back)),
            vertex(on(0.0, first, -lean), 0.0),
            vertex(on(apart, far, -lean), bulge(front)),
            vertex(on(apart, far, lean), 0.0),
        ],
        closed: true,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_touch_both_wheels() {
        for (first, second, apart, crossed) in [
            (20.0, 60.0, 150.0, false),
            (20.0, 60.0, 150.0, true),
            (30.0, 30.0, 70.0, false),
        ] {
            let path = around(first, second, apart, crossed).map(|p| p.vertices);
            let v = path.unwrap_or_default();
            assert_eq!(v.len(), 4);
            for (vertex, center, r) in [
                (v[0], 0.0, first),
                (v[1], 0.0, first),
                (v[2], apart, second),
                (v[3], apart, second),
            ] {
                assert!((distance(vertex.at, [center, 0.0]) - r).abs() < 1e-12);
            }
            for (from, to) in [(v[1], v[2]), (v[3], v[0])] {
                let run = [to.at[0] - from.at[0], to.at[1] - from.at[1]];
                for (end, center) in [(v[1], 0.0), (v[0], 0.0), (v[2], apart), (v[3], apart)] {
                    if end == from || end == to {
                        let across = run[0] * (end.at[0] - center) + run[1] * end.at[1];
                        assert!(across.abs() < 1e-9, "a run meets its wheel askew");
                    }
                }
            }
        }
        assert!(around(30.0, 60.0, 80.0, true).is_none());
    }
}
