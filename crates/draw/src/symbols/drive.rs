//! Drives: an arrow that shows what is moved and in which sense.

use std::f64::consts::PI;

use kempe_number::math::{atan2, sin_cos};

use super::part::Part;
use crate::context::{Anchor, Context};
use crate::scene::{Item, Layer, Path, Point, Style, distance};
use crate::tokens::Token;
use crate::view::{DriveKind, DriveView};

/// Radius of the arc, mm.
const RADIUS: f64 = 6.6;
/// Where the arc starts from the link's direction, and how far it goes, rad.
const ARC: [f64; 2] = [0.45, 1.6];

pub(super) fn parts(context: &Context) -> Vec<Part> {
    context
        .view
        .drives
        .iter()
        .filter_map(|drive| part(context, drive))
        .collect()
}

fn part(context: &Context, drive: &DriveView) -> Option<Part> {
    let sense = if drive.forward { 1.0 } else { -1.0 };
    match drive.kind {
        DriveKind::Turn { link, about } => {
            let points = &context.view.links.get(link)?.points;
            let arms = points.iter().filter_map(|&p| context.local(link, about, p));
            let longest =
                arms.max_by(|a, b| distance([0.0; 2], *a).total_cmp(&distance([0.0; 2], *b)))?;
            let along = atan2(longest[1], longest[0]);
            Some(Part::new(
                Layer::Drive,
                Anchor::On(about, link, along),
                arc_arrow(sense),
            ))
        }
        DriveKind::Slide { at, guide } => {
            let angle = context.guide_angle(guide)?;
            let items = arrow([-4.2 * sense, 4.4], [4.2 * sense, 4.4]);
            Some(Part::new(
                Layer::Drive,
                Anchor::On(at, guide.link, angle),
                items,
            ))
        }
        DriveKind::Extend { a, b } => {
            let (shortest, _) = context.span(a, b)?;
            let (x, half) = (shortest / 2.0, (shortest / 4.0).clamp(2.0, 4.5));
            let items = arrow([x - half * sense, 4.0], [x + half * sense, 4.0]);
            Some(Part::new(Layer::Drive, Anchor::Toward(a, b), items))
        }
    }
}

fn arc_arrow(sense: f64) -> Vec<Item> {
    let [start, sweep] = ARC;
    let end = (start + sweep) * sense;
    let (s, c) = sin_cos(end);
    let tip = [RADIUS * c, RADIUS * s];
    let arc = Path::arc([0.0; 2], RADIUS, start * sense, (sweep - 0.12) * sense);
    vec![
        Item::path(arc, Style::stroke(Token::Drive, 0.6)),
        head(tip, end + sense * (PI / 2.0 - 0.16)),
    ]
}

fn arrow(from: Point, to: Point) -> Vec<Item> {
    let direction = atan2(to[1] - from[1], to[0] - from[0]);
    let (s, c) = sin_cos(direction);
    let shaft = Path::polyline(&[from, [to[0] - c, to[1] - s]]);
    vec![
        Item::path(shaft, Style::stroke(Token::Drive, 0.6)),
        head(to, direction),
    ]
}

fn head(tip: Point, direction: f64) -> Item {
    let (s, c) = sin_cos(direction);
    let at = |x: f64, y: f64| [tip[0] + c * x - s * y, tip[1] + s * x + c * y];
    Item::path(
        Path::polygon(&[at(0.9, 0.0), at(-1.6, 1.05), at(-1.1, 0.0), at(-1.6, -1.05)]),
        Style::fill(Token::Drive),
    )
}
