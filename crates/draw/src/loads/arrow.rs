//! Arrows of forces and arcs of moments, in mm on paper. Heads keep their size; the length, or the angle, is the value.

use std::f64::consts::PI;

use kempe_number::math::sin_cos;

use super::LoadRole;
use crate::scene::{Item, Path, Point, Style, distance};
use crate::tokens::Token;

/// Length of a head and half its width, mm.
pub(crate) const HEAD: f64 = 2.5;
pub(crate) const HALF_HEAD: f64 = 1.0;
/// An arrow starts so far from its point (mm), so that the joint stays to be seen.
pub(crate) const RIM: f64 = 1.8;
/// Half the gap of a broken shaft, mm.
pub(crate) const BREAK: f64 = 0.7;
/// The angle of the largest moment, rad.
pub(crate) const TURN: f64 = 1.6 * PI;

/// How the lines of a role are drawn, so that roles differ without colour, too.
pub(crate) struct Stroke {
    /// Width, mm.
    pub width: f64,
    /// Dashes and gaps, mm.
    pub dash: &'static [f64],
    /// The head is an outline.
    pub open: bool,
}

impl Stroke {
    pub fn of(role: LoadRole) -> Stroke {
        let (width, dash, open): (f64, &'static [f64], bool) = match role {
            LoadRole::Reaction => (0.7, &[], false),
            LoadRole::Load => (1.2, &[], false),
            LoadRole::Weight => (0.4, &[], true),
            LoadRole::Drive => (0.8, &[2.6, 1.1, 0.3, 1.1], false),
            LoadRole::Spring => (0.7, &[1.7, 1.3], false),
            LoadRole::Friction => (0.7, &[0.1, 1.2], true),
        };
        Stroke { width, dash, open }
    }
}

/// Radius of the arc of a moment, mm: moments of different roles at one point stand beside each other.
pub(crate) fn moment_radius(role: LoadRole) -> f64 {
    4.8 + 0.9 * role.index() as f64
}

/// A force or a moment as it lies on paper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Shape {
    /// An arrow from its tail over a vector.
    Force {
        tail: Point,
        vector: Point,
        broken: bool,
    },
    /// An arc around a point from straight above, counter-clockwise when positive.
    Moment {
        center: Point,
        radius: f64,
        sweep: f64,
        broken: bool,
    },
}

impl Shape {
    /// The items that draw it.
    pub fn items(&self, role: LoadRole) -> Vec<Item> {
        let stroke = Stroke::of(role);
        let line = |paths| Item::Shape {
            paths,
            style: Style::stroke(Token::Load(role), stroke.width).dashed(stroke.dash),
        };
        let ticks = |paths| Item::Shape {
            paths,
            style: Style::stroke(Token::Load(role), 0.35),
        };
        match *self {
            Shape::Force {
                tail,
                vector,
                broken,
            } => {
                let length = distance([0.0; 2], vector);
                let (c, s) = (vector[0] / length, vector[1] / length);
                let at = |x: f64, y: f64| [tail[0] + c * x - s * y, tail[1] + s * x + c * y];
                let end = length - 0.8 * HEAD;
                let mut items = Vec::new();
                if broken {
                    let middle = length / 2.0;
                    let (a, b) = (middle - BREAK, middle + BREAK);
                    items.push(line(vec![
                        Path::polyline(&[at(0.0, 0.0), at(a, 0.0)]),
                        Path::polyline(&[at(b, 0.0), at(end, 0.0)]),
                    ]));
                    let tick = |x: f64| Path::polyline(&[at(x - 0.5, -1.4), at(x + 0.5, 1.4)]);
                    items.push(ticks(vec![tick(a), tick(b)]));
                } else {
                    items.push(line(vec![Path::polyline(&[at(0.0, 0.0), at(end, 0.0)])]));
                }
                items.push(head(at(length, 0.0), [c, s], role));
                items
            }
            Shape::Moment {
                center,
                radius,
                sweep,
                broken,
            } => {
                let sense = sweep.signum();
                let start = PI / 2.0;
                let arc = |from: f64, to: f64| Path::arc(center, radius, start + from, to - from);
                let end = sweep - sense * 0.8 * HEAD / radius;
                let on = |angle: f64, radius: f64| {
                    let (s, c) = sin_cos(start + angle);
                    [center[0] + radius * c, center[1] + radius * s]
                };
                let mut items = Vec::new();
                if broken {
                    let half = sense * BREAK / radius;
                    let (a, b) = (sweep / 2.0 - half, sweep / 2.0 + half);
                    items.push(line(vec![arc(0.0, a), arc(b, end)]));
                    let tick =
                        |angle| Path::polyline(&[on(angle, radius - 1.3), on(angle, radius + 1.3)]);
                    items.push(ticks(vec![tick(a), tick(b)]));
                } else {
                    items.push(line(vec![arc(0.0, end)]));
                }
                // the head looks along the chord of its own length
                let (tip, tail) = (on(sweep, radius), on(sweep - sense * HEAD / radius, radius));
                let chord = distance(tail, tip);
                let along = [(tip[0] - tail[0]) / chord, (tip[1] - tail[1]) / chord];
                items.push(head(tip, along, role));
                items
            }
        }
    }

    /// Where a label stands off, and in which direction.
    pub fn tip(&self) -> (Point, Point) {
        match *self {
            Shape::Force { tail, vector, .. } => {
                let length = distance([0.0; 2], vector);
                let along = [vector[0] / length, vector[1] / length];
                ([tail[0] + vector[0], tail[1] + vector[1]], along)
            }
            Shape::Moment { center, radius, .. } => {
                ([center[0], center[1] + radius + 0.6], [0.0, 1.0])
            }
        }
    }
}

fn head(tip: Point, along: Point, role: LoadRole) -> Item {
    let [c, s] = along;
    let at = |x: f64, y: f64| [tip[0] + c * x - s * y, tip[1] + s * x + c * y];
    let outline = Path::polygon(&[at(0.0, 0.0), at(-HEAD, HALF_HEAD), at(-HEAD, -HALF_HEAD)]);
    let style = if Stroke::of(role).open {
        Style::stroke(Token::Load(role), 0.4).filled(Token::Background, 1.0)
    } else {
        Style::fill(Token::Load(role))
    };
    Item::path(outline, style)
}
