//! Dimension lines as drawing offices draw them (after ISO 129-1): thin lines with arrowheads, the value above its line and
//! read from below or from the right.

mod angular;
mod linear;
mod radial;
mod way;

use way::{HEAD, Way, direction};

use crate::context::Context;
use crate::labels::{Choice, Spot, Wanted, Words};
use crate::scene::{Item, Path, Point, Style, distance};
use crate::tokens::Token;
use crate::view::{DimensionKind, DimensionView, Frame, Guide};
use kempe_number::math::atan2;

/// Font size, mm.
const SIZE: f64 = 2.9;
/// Width of the lines, mm.
const LINE: f64 = 0.2;

/// A dimension in one pose: the ways to draw it.
pub(crate) struct Dimension {
    words: Words,
    ways: Vec<Way>,
}

impl Dimension {
    /// The dimensions that can be drawn in a pose.
    pub fn all(context: &Context, frame: &Frame) -> Vec<Dimension> {
        let one = |view: &DimensionView| {
            let words = Words::new(view.text.as_str(), SIZE);
            let ways = ways(context, frame, view, &words)?;
            (!ways.is_empty()).then_some(Dimension { words, ways })
        };
        context.view.dimensions.iter().filter_map(one).collect()
    }

    /// Where it may stand: at most so many ways.
    pub fn wanted(&self, most: usize) -> Wanted {
        let choice = |way: &Way| Choice {
            dislike: way.dislike,
            spots: vec![Some(Spot {
                room: way.room,
                lines: way.lines.clone(),
            })],
        };
        Wanted {
            choices: self.ways.iter().take(most).map(choice).collect(),
            optional: false,
        }
    }

    /// One of the ways, drawn.
    pub fn drawn(&self, choice: usize) -> Option<Vec<Item>> {
        let way = self.ways.get(choice)?;
        let stroke = || Style::stroke(Token::Muted, LINE);
        let mut items: Vec<Item> = way
            .lines
            .iter()
            .map(|line| Item::path(Path::polyline(line), stroke()))
            .collect();
        // the lines of an arc are there to keep others away
        if let Some(arc) = &way.arc {
            items.truncate(1);
            items.push(Item::path(arc.clone(), stroke()));
        }
        items.extend(way.heads.iter().map(|(tip, along)| head(*tip, *along)));
        items.push(Item::Text(self.words.text(&way.room)));
        Some(items)
    }
}

fn ways(context: &Context, frame: &Frame, view: &DimensionView, words: &Words) -> Option<Vec<Way>> {
    let at = |point: usize| context.paper(frame, point);
    let line = |guide: Guide| Some([at(guide.from)?, at(guide.to)?]);
    match view.kind {
        DimensionKind::Length { a, b } => linear::ways([at(a)?, at(b)?], None, words),
        DimensionKind::Across { a, b } => linear::ways([at(a)?, at(b)?], Some([1.0, 0.0]), words),
        DimensionKind::Up { a, b } => linear::ways([at(a)?, at(b)?], Some([0.0, 1.0]), words),
        DimensionKind::Offset { point, guide } => {
            let (p, [from, to]) = (at(point)?, line(guide)?);
            let along = direction(from, to)?;
            let far = (p[0] - from[0]) * along[0] + (p[1] - from[1]) * along[1];
            let foot = [0, 1].map(|k: usize| from[k] + far * along[k]);
            linear::ways([p, foot], None, words)
        }
        DimensionKind::Angle { guide } => {
            let [from, to] = line(guide)?;
            let along = direction(from, to)?;
            Some(angular::ways(
                from,
                atan2(along[1], along[0]),
                view.value,
                words,
            ))
        }
        DimensionKind::Wheel(wheel) => {
            let radius = wheel.radius.abs() * context.fit.scale;
            Some(radial::ways(at(wheel.center)?, radius, None, words))
        }
        DimensionKind::Arc(arc) => {
            let (from, to) = (at(arc.from)?, at(arc.to)?);
            let radius = arc.radius.abs() * context.fit.scale;
            let along = direction(from, to)?;
            let half = distance(from, to) / 2.0;
            let off = arc.side * (radius * radius - half * half).max(0.0).sqrt();
            let center = [
                (from[0] + to[0]) / 2.0 - off * along[1],
                (from[1] + to[1]) / 2.0 + off * along[0],
            ];
            // the middle of the slot lies across the chord from its centre
            let middle = atan2(-arc.side * along[0], arc.side * along[1]);
            let middle = (!arc.closed).then_some(middle);
            Some(radial::ways(center, radius, middle, words))
        }
    }
}

fn head(tip: Point, [c, s]: Point) -> Item {
    let at = |x: f64, y: f64| [tip[0] + c * x - s * y, tip[1] + s * x + c * y];
    let outline = Path::polygon(&[at(0.0, 0.0), at(-HEAD[0], HEAD[1]), at(-HEAD[0], -HEAD[1])]);
    Item::path(outline, Style::fill(Token::Muted))
}
