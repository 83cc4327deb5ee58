//! A vector over a motion: its tail at the origin, its tip along a curve, some tips named by the drive.

use super::axis::Scale;
use super::frame::Frame;
use super::{Curve, PlotSpec};
use crate::loads::Quantity;
use crate::scene::{Align, Group, Item, Layer, Path, Point, Style, Text, distance};
use crate::text::width as text_width;
use crate::tokens::Token;
use kempe_number::text::significant;

/// Into how many intervals the named tips divide the motion.
const INTERVALS: usize = 8;
/// Font size, mm.
const SIZE: f64 = 2.6;
/// Length of an arrow's head and half its width, mm.
const HEAD: Point = [2.4, 0.95];

/// Makes a plot's curves the tips of vectors from the origin.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Hodograph {
    /// The drive's coordinate at each value of the curves.
    pub drive: Vec<f64>,
    /// Its unit.
    pub unit: String,
}

impl PlotSpec {
    /// The values to show on the axes: all but outliers, and the origin; and the largest vector when some are left out.
    pub(super) fn vectors(&self) -> ([Vec<f64>; 2], Option<f64>) {
        let pairs = || {
            self.curves
                .iter()
                .flat_map(|c| c.x.iter().copied().zip(c.y.iter().copied()))
        };
        let size = |x: f64, y: f64| kempe_number::math::hypot(x, y);
        let Some(usual) = Quantity::over(pairs().map(|(x, y)| vec![size(x, y)]), 0.0) else {
            return ([vec![0.0], vec![0.0]], None);
        };
        let shown = || pairs().filter(|(x, y)| size(*x, *y) <= usual.full);
        let x = shown().map(|(x, _)| x).chain([0.0]).collect();
        let y = shown().map(|(_, y)| y).chain([0.0]).collect();
        ([x, y], usual.capped().then_some(usual.largest))
    }
}

/// Origin, first vector, named tips, and a word on what leaves the plot.
pub(super) fn groups(
    plot: &PlotSpec,
    hodograph: &Hodograph,
    largest: Option<f64>,
    frame: Frame,
    x: &Scale,
    y: &Scale,
) -> [Group; 3] {
    let [left, bottom, right, top] = frame;
    let Some(origin) = x.at(0.0).zip(y.at(0.0)).map(|(a, b)| [a, b]) else {
        return [Layer::Furniture, Layer::Vector, Layer::Label].map(|l| Group::new(l, Vec::new()));
    };
    let inside = |p: &Point| p[0] >= left && p[0] <= right && p[1] >= bottom && p[1] <= top;
    let cross = Item::path(
        Path::polyline(&[[origin[0], bottom], [origin[0], top]]),
        Style::stroke(Token::Muted, 0.25),
    );
    let (mut arrows, mut names) = (Vec::new(), Vec::new());
    let mut taken: Vec<[Point; 2]> = vec![[
        [origin[0] - 1.0, origin[1] - 1.0],
        [origin[0] + 1.0, origin[1] + 1.0],
    ]];
    if let Some(largest) = largest {
        let text = format!("up to {} {}", significant(largest, 3), plot.x.unit);
        let at = [right - 1.0, bottom + 1.2];
        let wide = text_width(&text, SIZE);
        taken.push([[at[0] - wide, at[1]], [at[0], at[1] + SIZE]]);
        let text = Text::new(at, SIZE, format!("{} outside", text.trim_end()));
        names.push(Item::Text(Text {
            halo: true,
            ..text.aligned(Align::End).colored(Token::Muted)
        }));
    }
    // another design has rows of its own: its tips are of other places
    let own = plot.curves.iter().enumerate();
    for (index, curve) in own.filter(|(_, curve)| curve.told.is_none()) {
        let tips = tips(curve, x, y);
        let first = tips.iter().flatten().find(|p| inside(p));
        arrows.extend(first.map(|tip| arrow(origin, *tip, curve.token(index))));
        let rows = tips.len();
        let mut marked: Vec<Point> = Vec::new();
        let middle = middle(&tips).unwrap_or(origin);
        for k in 0..=INTERVALS {
            let row = k * rows.saturating_sub(1) / INTERVALS;
            let Some(tip) = tips.get(row).copied().flatten().filter(|p| inside(p)) else {
                continue;
            };
            // a motion that closes comes back to its first tip
            if marked.iter().any(|p| distance(*p, tip) < 2.0) {
                continue;
            }
            marked.push(tip);
            names.push(Item::circle(tip, 0.75, Style::fill(curve.token(index))));
            let Some(value) = hodograph.drive.get(row).filter(|v| v.is_finite()) else {
                continue;
            };
            let text = format!("{} {}", significant(*value, 3), hodograph.unit);
            let text = text.trim_end();
            let half = [0.54 * text_width(text, SIZE), SIZE / 2.0];
            let free = places(middle, tip, half).into_iter().find(|p| {
                let room = [
                    [p[0] - half[0], p[1] - half[1]],
                    [p[0] + half[0], p[1] + half[1]],
                ];
                let clear = taken
                    .iter()
                    .all(|b| (0..2).any(|i| room[1][i] < b[0][i] || b[1][i] < room[0][i]));
                clear && room.iter().all(&inside)
            });
            let Some(p) = free else { continue };
            taken.push([
                [p[0] - half[0], p[1] - half[1]],
                [p[0] + half[0], p[1] + half[1]],
            ]);
            names.push(Item::Text(Text {
                halo: true,
                ..Text::new([p[0], p[1] - 0.36 * SIZE], SIZE, text)
                    .aligned(Align::Middle)
                    .colored(Token::Muted)
            }));
        }
    }
    [
        Group::new(Layer::Furniture, vec![cross]),
        Group::new(Layer::Vector, arrows.into_iter().flatten().collect()),
        Group::new(Layer::Label, names),
    ]
}

fn tips(curve: &Curve, x: &Scale, y: &Scale) -> Vec<Option<Point>> {
    let place = |(a, b): (&f64, &f64)| Some([x.at(*a)?, y.at(*b)?]);
    curve.x.iter().zip(&curve.y).map(place).collect()
}

/// The middle of the curve: names stand outside.
fn middle(tips: &[Option<Point>]) -> Option<Point> {
    let count = tips.iter().flatten().count();
    let mean = |k: usize| tips.iter().flatten().map(|p| p[k]).sum::<f64>() / count as f64;
    (count > 0).then(|| [mean(0), mean(1)])
}

/// Where the name of a tip may stand: beyond it as seen from the middle, then beside it.
fn places(middle: Point, tip: Point, half: Point) -> Vec<Point> {
    let long = distance(middle, tip).max(1e-9);
    let along = [(tip[0] - middle[0]) / long, (tip[1] - middle[1]) / long];
    let sides = [
        [1.0, 0.0],
        [0.6, 0.8],
        [0.6, -0.8],
        [0.0, 1.0],
        [0.0, -1.0],
        [-1.0, 0.0],
    ];
    let place = |[c, s]: [f64; 2]| {
        let away = [along[0] * c - along[1] * s, along[0] * s + along[1] * c];
        [
            tip[0] + away[0] * (half[0] + 1.7),
            tip[1] + away[1] * (half[1] + 1.7),
        ]
    };
    sides.into_iter().map(place).collect()
}

fn arrow(tail: Point, tip: Point, token: Token) -> Vec<Item> {
    let long = distance(tail, tip);
    if long < HEAD[0] {
        return Vec::new();
    }
    let (c, s) = ((tip[0] - tail[0]) / long, (tip[1] - tail[1]) / long);
    let at = |x: f64, y: f64| [tip[0] + c * x - s * y, tip[1] + s * x + c * y];
    let head = [at(0.0, 0.0), at(-HEAD[0], HEAD[1]), at(-HEAD[0], -HEAD[1])];
    vec![
        Item::path(
            Path::polyline(&[tail, at(-0.8 * HEAD[0], 0.0)]),
            Style::stroke(token, 0.6),
        ),
        Item::path(Path::polygon(&head), Style::fill(token)),
    ]
}
