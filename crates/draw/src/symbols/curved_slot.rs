//! Pins in curved slots.

use std::f64::consts::PI;

use kempe_number::math::{atan2, sin_cos, within_half_a_turn};

use super::ground;
use super::part::{LINE, Part, link_token};
use crate::context::{Anchor, Context};
use crate::scene::{Item, Layer, Path, Point, Style, Vertex, distance};
use crate::tokens::Token;
use crate::view::ArcGuide;

/// Half the width of a slot, mm.
const SLOT: f64 = 1.75;
/// How far a link reaches around its slot, mm.
const CHEEK: f64 = 1.6;
/// Where the hatched walls of a slot in the frame stand, from its middle, mm.
pub(super) const WALL: f64 = SLOT + 0.6;

/// A slot in the axes of its link, mm: centre, radius, angle of its start and the way to its end.
#[derive(Clone, Copy)]
struct Slot {
    center: Point,
    radius: f64,
    start: f64,
    sweep: f64,
    closed: bool,
}

pub(super) fn parts(context: &Context, arc: ArcGuide) -> Vec<Part> {
    let Some(slot) = placed(context, arc) else {
        return Vec::new();
    };
    let walls = || {
        let walls = [WALL, -WALL].map(|off| {
            let end = if slot.closed { 0.0 } else { 0.4 };
            ground::hatched_arc(
                slot.center,
                slot.radius + off,
                slot.start,
                slot.sweep,
                end,
                off > 0.0,
            )
        });
        walls.concat()
    };
    channel(arc.link, arc.from, walls, |off| slot.outline(off))
}

/// A slot by its outline at a distance around it, the outermost path first, in the axes of its link about a point; `walls`
/// are those in the frame.
pub(super) fn channel(
    link: usize,
    origin: usize,
    walls: impl FnOnce() -> Vec<Item>,
    outline: impl Fn(f64) -> Vec<Path>,
) -> Vec<Part> {
    let token = link_token(link);
    let anchor = Anchor::On(origin, link, 0.0);
    let (layer, around) = if link == 0 {
        (Layer::Ground, walls())
    } else {
        // The link reaches around its slot, wherever its named points are; a slot all the way round is a groove in a disc.
        let style = Style::stroke(token, 0.5).filled(token, 0.2);
        let mut paths = outline(SLOT + CHEEK);
        paths.truncate(1);
        (Layer::Link(link), vec![Item::Shape { paths, style }])
    };
    let style = Style::stroke(token, LINE).filled(Token::Background, 1.0);
    let channel = Item::Shape {
        paths: outline(SLOT),
        style,
    };
    vec![
        Part::new(layer, anchor, around),
        Part::new(layer, anchor, vec![channel]),
    ]
}

fn placed(context: &Context, arc: ArcGuide) -> Option<Slot> {
    let to = context.local(arc.link, arc.from, arc.to)?;
    let radius = arc.radius * context.fit.scale;
    let half = distance([0.0; 2], to) / 2.0;
    if !(half > 0.0 && radius.is_finite() && radius >= half * (1.0 - 1e-9)) {
        return None;
    }
    let rise = (radius * radius - half * half).max(0.0).sqrt() * arc.side.signum() / (2.0 * half);
    let center = [to[0] / 2.0 - to[1] * rise, to[1] / 2.0 + to[0] * rise];
    let angle = |p: Point| atan2(p[1] - center[1], p[0] - center[0]);
    let start = angle([0.0; 2]);
    // The shorter way, on the side away from the centre.
    let mut sweep = within_half_a_turn(angle(to) - start);
    if sweep.abs() > PI - 1e-6 {
        sweep = PI * arc.side.signum();
    }
    Some(Slot {
        center,
        radius,
        start,
        sweep,
        closed: arc.closed,
    })
}

impl Slot {
    /// The outline at a distance around it.
    fn outline(&self, off: f64) -> Vec<Path> {
        let Self {
            center,
            radius,
            start,
            sweep,
            closed,
        } = *self;
        let (outer, inner) = (radius + off, radius - off);
        let on = |r: f64, angle: f64| {
            let (s, c) = sin_cos(angle);
            [center[0] + r * c, center[1] + r * s]
        };
        let vertex = |at, bulge| Vertex { at, bulge };
        let circle = |r: f64| Path {
            vertices: vec![vertex(on(r, 0.0), 1.0), vertex(on(r, PI), 1.0)],
            closed: true,
        };
        if closed {
            return [outer, inner]
                .into_iter()
                .filter(|r| *r > 0.0)
                .map(circle)
                .collect();
        }
        let (s, c) = sin_cos(sweep / 4.0);
        let (bulge, cap, end) = (s / c, sweep.signum(), start + sweep);
        vec![Path {
            vertices: vec![
                vertex(on(outer, start), bulge),
                vertex(on(outer, end), cap),
                vertex(on(inner, end), -bulge),
                vertex(on(inner, start), cap),
            ],
            closed: true,
        }]
    }
}
