//! A vector over a motion: its tail at the origin, its tip along a curve, some tips named by the drive.

use super::axis::Scale;
use super::curve::{Curve, curve_paths};
use super::frame::Frame;
use super::spec::{Hodograph, PlotSpec};
use crate::labels::{Choice, Spot, Surroundings, Wanted, Words, beside, place};
use crate::loads::Quantity;
use crate::scene::{Align, Group, Item, Layer, Path, Point, Style, Text, distance};
use crate::tokens::Token;
use kempe_number::math::atan2;
use kempe_number::text::significant;

/// Into how many intervals the named tips divide the motion.
const INTERVALS: usize = 8;
/// Font size, mm.
const SIZE: f64 = 2.6;
/// Width of the curves, mm.
const WIDTH: f64 = 0.55;
/// Length of an arrow's head and half its width, mm.
const HEAD: Point = [2.4, 0.95];

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
    sheet: Point,
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
    if let Some(largest) = largest {
        let text = format!("up to {} {}", significant(largest, 3), plot.x.unit);
        let text = format!("{} outside", text.trim_end());
        let text = Text::new([right - 1.0, bottom + 1.2], SIZE, text);
        names.push(Item::Text(Text {
            halo: true,
            ..text.aligned(Align::End).colored(Token::Muted)
        }));
    }
    let (mut words, mut wanted) = (Vec::new(), Vec::new());
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
            let text = Words::new(text.trim_end(), SIZE);
            wanted.push(Wanted {
                choices: places(middle, tip, &text, &inside),
                optional: true,
            });
            words.push(text);
        }
    }
    let curves = plot.curves.iter().enumerate().map(|(index, curve)| {
        let paths = curve_paths(curve, frame, x, y);
        let style = Style::stroke(Token::Series(index), WIDTH);
        Group::new(Layer::Curve(index), vec![Item::Shape { paths, style }])
    });
    let mut drawn: Vec<Group> = curves.collect();
    let heads = arrows.iter().flatten().cloned().collect();
    drawn.push(Group::new(Layer::Vector, heads));
    drawn.push(Group::new(Layer::Joint, names.clone()));
    let around = Surroundings::new(sheet, &drawn);
    for ((words, wanted), choice) in words.iter().zip(&wanted).zip(place(&wanted, &[around])) {
        let spots = choice.and_then(|choice| wanted.choices.get(choice));
        let spot = spots.and_then(|c| c.spots.first()?.as_ref());
        names.extend(spot.map(|s| Item::Text(words.text(&s.room).colored(Token::Muted))));
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

/// Where the name of a tip may stand: beyond it as seen from the middle, then all around it, inside of the plot.
fn places(
    middle: Point,
    tip: Point,
    words: &Words,
    inside: &impl Fn(&Point) -> bool,
) -> Vec<Choice> {
    let beyond = atan2(tip[1] - middle[1], tip[0] - middle[0]);
    let sides = (0..12).map(|k| f64::from((k + 1) / 2) * if k % 2 == 0 { 0.5 } else { -0.5 });
    let gaps = [(1.5, 0.0), (3.2, 3.0)];
    let ways = gaps
        .iter()
        .flat_map(|gap| sides.clone().map(move |side| (gap, side)));
    let choices = ways.filter_map(|((gap, worse), side)| {
        let room = beside(tip, *gap, words.half, beyond + side);
        let reach = room.reach();
        let corner = |sign: f64| [0, 1].map(|k: usize| room.middle[k] + sign * reach[k]);
        let lines = Vec::new();
        (inside(&corner(1.0)) && inside(&corner(-1.0))).then(|| Choice {
            dislike: worse + side.abs(),
            spots: vec![Some(Spot { room, lines })],
        })
    });
    choices.collect()
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
