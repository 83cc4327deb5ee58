//! Bodies of links: a rounded bar between two points, a translucent rounded plate around three and more.

use super::part::{BAR, Part, link_token};
use crate::context::{Anchor, Context};
use crate::hull::{convex_hull, rounded_hull};
use crate::scene::{Item, Layer, Point, Style};

/// Opacity of a bar and of a plate.
const FILL: [f64; 2] = [0.32, 0.16];

pub(super) fn parts(context: &Context) -> Vec<Part> {
    (1..context.view.links.len())
        .filter_map(|link| body(context, link))
        .collect()
}

fn body(context: &Context, link: usize) -> Option<Part> {
    let points = &context.view.links[link].points;
    let first = *points.first()?;
    let local: Vec<Point> = points
        .iter()
        .filter_map(|&p| context.local(link, first, p))
        .collect();
    let corners = convex_hull(&local).len();
    if corners < 2 && context.roles.has_body(link) {
        return None;
    }
    let outline = rounded_hull(&local, BAR)?;
    let token = link_token(link);
    let style = Style::stroke(token, 0.5).filled(token, FILL[usize::from(corners > 2)]);
    Some(Part::new(
        Layer::Link(link),
        Anchor::On(first, link, 0.0),
        vec![Item::path(outline, style)],
    ))
}
