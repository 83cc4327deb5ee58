//! Names of points, on the side where the fewest bars pass over all poses.

use super::Part;
use crate::context::{Anchor, Context};
use crate::scene::{Align, Item, Layer, Point, Text, distance};
use crate::text::{shortened, width};
use crate::tokens::Token;
use crate::view::Frame;

/// Font size, mm.
const SIZE: f64 = 3.6;
/// Poses looked at.
const SAMPLES: usize = 16;
/// With more points or links than this, labels get their places without a search.
const SEARCHED: usize = 120;
/// Where a label may stand: direction of its middle from the point.
const SIDES: [Point; 8] = [
    [0.7, 0.7],
    [-0.7, 0.7],
    [0.0, 1.0],
    [1.0, 0.0],
    [-1.0, 0.0],
    [0.7, -0.7],
    [-0.7, -0.7],
    [0.0, -1.0],
];

pub(super) fn parts(context: &Context) -> Vec<Part> {
    let poses = sampled(context);
    let mut taken: Vec<Point> = Vec::new();
    let mut parts = Vec::new();
    let searched = context.view.points.len() <= SEARCHED && context.view.links.len() <= SEARCHED;
    for (index, name) in context.view.points.iter().enumerate() {
        let role = context.roles.point(index);
        if name.is_empty() || role.carriers.is_empty() || role.only_guides() {
            continue;
        }
        let name = shortened(name, SIZE, 30.0);
        // a block is wider than a pin
        let clear = if role.slides { [4.6, 3.4] } else { [1.9, 2.3] };
        let reach = [width(&name, SIZE) / 2.0 + clear[0], SIZE / 2.0 + clear[1]];
        let middle = |side: Point| [side[0] * reach[0], side[1] * reach[1]];
        let cost = |side: &Point| {
            let down = if role.grounded() && side[1] < 0.1 {
                40.0
            } else {
                0.0
            };
            down + poses
                .iter()
                .map(|pose| crowding(context, pose, index, middle(*side), &taken))
                .sum::<f64>()
        };
        let best = if !searched {
            SIDES[0]
        } else {
            let mut best = (f64::INFINITY, SIDES[0]);
            for side in SIDES {
                let c = cost(&side);
                if c < best.0 - 1e-9 {
                    best = (c, side);
                }
            }
            best.1
        };
        let [x, y] = middle(best);
        if let Some(p) = context.reference.and_then(|f| context.paper(f, index)) {
            taken.push([p[0] + x, p[1] + y]);
        }
        let text = Text {
            halo: true,
            ..Text::new([x, y - SIZE * 0.36], SIZE, name).aligned(Align::Middle)
        };
        let text = if role.carriers == [0] {
            text.colored(Token::Muted)
        } else {
            text
        };
        parts.push(Part::new(
            Layer::Label,
            Anchor::Point(index),
            vec![Item::Text(text)],
        ));
    }
    parts
}

fn sampled<'a>(context: &'a Context) -> Vec<&'a Frame> {
    let step = context.frames.len().div_ceil(SAMPLES).max(1);
    context.frames.iter().step_by(step).collect()
}

/// How much a label at this offset is in the way of bars, pins and earlier labels.
fn crowding(context: &Context, pose: &Frame, index: usize, offset: Point, taken: &[Point]) -> f64 {
    let Some(p) = context.paper(pose, index) else {
        return 0.0;
    };
    let at = [p[0] + offset[0], p[1] + offset[1]];
    let mut cost = 0.0;
    for link in context.view.links.iter().skip(1) {
        let points: Vec<Point> = link
            .points
            .iter()
            .take(8)
            .filter_map(|&q| context.paper(pose, q))
            .collect();
        for (k, &a) in points.iter().enumerate() {
            for &b in &points[k + 1..] {
                cost += (4.0 - to_segment(at, a, b)).max(0.0);
            }
        }
    }
    let pins = (0..context.view.points.len())
        .filter(|&q| q != index)
        .filter_map(|q| context.paper(pose, q));
    cost += pins.map(|q| (4.0 - distance(at, q)).max(0.0)).sum::<f64>();
    cost + taken
        .iter()
        .map(|q| (5.0 - distance(at, *q)).max(0.0))
        .sum::<f64>()
        / SAMPLES as f64
        * 4.0
}

fn to_segment(p: Point, a: Point, b: Point) -> f64 {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let square = dx * dx + dy * dy;
    let t = if square > 0.0 {
        (((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    distance(p, [a[0] + t * dx, a[1] + t * dy])
}
