//! Hatching: what stands still.

use kempe_number::math::sin_cos;

use super::part::LINE;
use crate::scene::{Item, Path, Point, Style, distance};
use crate::tokens::Token;

/// Distance of hatch lines, mm.
const STEP: f64 = 1.3;
/// Depth of the hatching, mm.
const DEPTH: f64 = 1.5;

/// A line at height `y` from `x0` to `x1` with hatching below (`down`) or above.
pub(super) fn hatched_line(x0: f64, x1: f64, y: f64, down: bool) -> Vec<Item> {
    let depth = if down { -DEPTH } else { DEPTH };
    let count = (((x1 - x0) / STEP).floor().max(0.0) as usize).min(2000);
    let slack = (x1 - x0) - count as f64 * STEP;
    let hatch = |k: usize| {
        let x = x0 + slack / 2.0 + (k as f64 + 0.5) * STEP;
        Path::polyline(&[[x + 0.5, y], [x - 0.7, y + depth]])
    };
    vec![
        Item::Shape {
            paths: (0..count).map(hatch).collect(),
            style: Style::stroke(Token::Ground, 0.22),
        },
        Item::path(
            Path::polyline(&[[x0, y], [x1, y]]),
            Style::stroke(Token::Ground, LINE),
        ),
    ]
}

/// An arc about `center` from the angle `start` over `sweep`, `beyond` mm longer at both ends, with hatching outside or
/// inside.
pub(super) fn hatched_arc(
    center: Point,
    radius: f64,
    start: f64,
    sweep: f64,
    beyond: f64,
    outside: bool,
) -> Vec<Item> {
    if !(radius > DEPTH) {
        return Vec::new();
    }
    let longer = beyond / radius * sweep.signum();
    let (start, sweep) = (start - longer, sweep + 2.0 * longer);
    let on = |r: f64, angle: f64| {
        let (s, c) = sin_cos(angle);
        [center[0] + r * c, center[1] + r * s]
    };
    let depth = if outside { DEPTH } else { -DEPTH };
    let count = ((sweep.abs() * radius / STEP).floor().max(0.0) as usize).min(2000);
    let hatch = |k: usize| {
        let angle = start + sweep * (k as f64 + 0.5) / count as f64;
        Path::polyline(&[
            on(radius, angle + 0.5 / radius),
            on(radius + depth, angle - 0.7 / radius),
        ])
    };
    vec![
        Item::Shape {
            paths: (0..count).map(hatch).collect(),
            style: Style::stroke(Token::Ground, 0.22),
        },
        Item::path(
            Path::arc(center, radius, start, sweep),
            Style::stroke(Token::Ground, LINE),
        ),
    ]
}

/// A wall along a path of many short arcs, hatched away from where the path is moved from: to its left for a positive `off`.
pub(super) fn hatched_path(wall: Path, off: f64) -> Vec<Item> {
    let side = off.signum();
    let ends = wall.vertices.iter().zip(wall.vertices.iter().skip(1));
    let mut hatches = Vec::new();
    let mut left = STEP / 2.0;
    for (a, b) in ends.map(|(a, b)| (a.at, b.at)) {
        let length = distance(a, b);
        let along = [0, 1].map(|k| (b[k] - a[k]) / length);
        while left < length && hatches.len() < 2000 {
            let at = |forth: f64, out: f64| {
                let (x, y) = (left + forth, out * side);
                [
                    a[0] + along[0] * x - along[1] * y,
                    a[1] + along[1] * x + along[0] * y,
                ]
            };
            hatches.push(Path::polyline(&[at(0.5, 0.0), at(-0.7, DEPTH)]));
            left += STEP;
        }
        left -= length;
    }
    vec![
        Item::Shape {
            paths: hatches,
            style: Style::stroke(Token::Ground, 0.22),
        },
        Item::path(wall, Style::stroke(Token::Ground, LINE)),
    ]
}

/// The foot of a ground pivot whose pin is at the origin.
pub(super) fn pedestal() -> Vec<Item> {
    let triangle = Path::polygon(&[[0.0, 0.0], [-2.7, -4.3], [2.7, -4.3]]);
    let style = Style::stroke(Token::Ground, LINE).filled(Token::Panel, 1.0);
    let mut items = vec![Item::path(triangle, style)];
    items.extend(hatched_line(-3.7, 3.7, -4.3, true));
    items
}
