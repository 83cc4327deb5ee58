//! Lines that a curve should not cross, and the part beyond them.

use super::axis::Scale;
use super::curve::{Curve, curve_paths, thinned};
use super::frame::Frame;
use crate::scene::{Group, Item, Layer, Path, Point, Style, Text, distance};
use crate::text::{shortened, width as text_width};
use crate::tokens::Token;

/// Font size of a label, mm.
const SIZE: f64 = 2.7;

/// Where a limit lies.
#[derive(Clone, Debug, PartialEq)]
pub enum LimitLine {
    /// At one value of the y axis.
    At(f64),
    /// Through pairs of values, ascending in x, in the units of the axes.
    Along {
        /// Abscissae.
        x: Vec<f64>,
        /// Ordinates.
        y: Vec<f64>,
    },
}

/// Which side of a limit is beyond it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beyond {
    /// Larger values.
    Above,
    /// Smaller values.
    Below,
}

/// A line to compare curves with, drawn dashed: a capacity, a clearance, a rating.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// What it is, such as `relief valve`.
    pub label: String,
    /// Where it lies.
    pub line: LimitLine,
    /// The side on which curves are shaded; none when `None`.
    pub beyond: Option<Beyond>,
}

impl Limit {
    /// A limit at one value; what lies above it is shaded.
    pub fn above(label: impl Into<String>, value: f64) -> Limit {
        Limit {
            label: label.into(),
            line: LimitLine::At(value),
            beyond: Some(Beyond::Above),
        }
    }

    /// A limit at one value; what lies below it is shaded.
    pub fn below(label: impl Into<String>, value: f64) -> Limit {
        Limit {
            beyond: Some(Beyond::Below),
            ..Limit::above(label, value)
        }
    }

    /// A limit through pairs of values; what lies above it is shaded.
    pub fn along(label: impl Into<String>, x: Vec<f64>, y: Vec<f64>) -> Limit {
        Limit {
            line: LimitLine::Along { x, y },
            ..Limit::above(label, 0.0)
        }
    }

    /// The values that an axis has to show.
    pub(super) fn values(&self) -> &[f64] {
        match &self.line {
            LimitLine::At(value) => std::slice::from_ref(value),
            LimitLine::Along { y, .. } => y,
        }
    }

    /// The line as a curve over the shown range.
    fn curve(&self, x: &Scale) -> Curve {
        match &self.line {
            LimitLine::At(value) => Curve {
                x: vec![x.low, x.high],
                y: vec![*value; 2],
                ..Curve::default()
            },
            LimitLine::Along { x, y } => Curve {
                x: x.clone(),
                y: y.clone(),
                ..Curve::default()
            },
        }
    }

    /// Its height on paper above a place.
    fn height(&self, at: f64, x: &Scale, y: &Scale) -> Option<f64> {
        match &self.line {
            LimitLine::At(value) => y.at(*value),
            LimitLine::Along { x: xs, y: ys } => {
                let count = xs.len().min(ys.len());
                let after = xs[..count].partition_point(|v| *v < at);
                let place = |k: usize| Some([x.at(*xs[..count].get(k)?)?, y.at(ys[k])?]);
                let b = place(after)?;
                if xs[after] == at {
                    return Some(b[1]);
                }
                let a = place(after.checked_sub(1)?)?;
                let share = (x.at(at)? - a[0]) / (b[0] - a[0]);
                Some(a[1] + share * (b[1] - a[1]))
            }
        }
    }

    /// The areas between a curve and the limit, on the side beyond.
    pub(super) fn areas(&self, curve: &Curve, frame: Frame, x: &Scale, y: &Scale) -> Vec<Path> {
        let Some(beyond) = self.beyond else {
            return Vec::new();
        };
        let sense = match beyond {
            Beyond::Above => 1.0,
            Beyond::Below => -1.0,
        };
        let [left, bottom, right, top] = frame;
        let inside = |p: Point| [p[0].clamp(left, right), p[1].clamp(bottom, top)];
        let mut areas = Vec::new();
        // the curve's side forth, the limit's side back
        let (mut forth, mut back): (Vec<Point>, Vec<Point>) = (Vec::new(), Vec::new());
        let mut close = |forth: &mut Vec<Point>, back: &mut Vec<Point>| {
            if forth.len() > 1 {
                let around = forth.iter().chain(back.iter().rev());
                areas.push(Path::polygon(
                    &around.map(|p| inside(*p)).collect::<Vec<_>>(),
                ));
            }
            forth.clear();
            back.clear();
        };
        let mut last: Option<(Point, f64)> = None;
        for row in thinned(curve) {
            let at = x.at(curve.x[row]).zip(y.at(curve.y[row]));
            let here = at
                .zip(self.height(curve.x[row], x, y))
                .map(|((px, py), limit)| ([px, py], limit));
            let over = |(p, limit): (Point, f64)| sense * (p[1] - limit);
            if let (Some(a), Some(b)) = (last, here)
                && (over(a) > 0.0) != (over(b) > 0.0)
            {
                let t = over(a) / (over(a) - over(b));
                let cross = [
                    a.0[0] + t * (b.0[0] - a.0[0]),
                    a.0[1] + t * (b.0[1] - a.0[1]),
                ];
                forth.push(cross);
                back.push(cross);
            }
            match here {
                Some((p, limit)) if over((p, limit)) > 0.0 => {
                    forth.push(p);
                    back.push([p[0], limit]);
                }
                _ => close(&mut forth, &mut back),
            }
            last = here;
        }
        close(&mut forth, &mut back);
        areas
    }

    /// The shaded parts of all curves.
    pub(super) fn shading(&self, curves: &[Curve], frame: Frame, x: &Scale, y: &Scale) -> Group {
        let area = |curve| {
            let paths = self.areas(curve, frame, x, y);
            let style = Style::default().filled(Token::Error, 0.22);
            (!paths.is_empty()).then_some(Item::Shape { paths, style })
        };
        Group::new(Layer::Furniture, curves.iter().filter_map(area).collect())
    }

    /// The line with its label, at the end and on the side where it covers least of the curves.
    pub(super) fn group(&self, curves: &[Curve], frame: Frame, x: &Scale, y: &Scale) -> Group {
        let [left, bottom, right, top] = frame;
        let paths = curve_paths(&self.curve(x), frame, x, y);
        let ends: Vec<Point> = [paths.first(), paths.last()]
            .into_iter()
            .zip([true, false])
            .filter_map(|(path, first)| {
                let corners = &path?.vertices;
                if first {
                    corners.first()
                } else {
                    corners.last()
                }
            })
            .map(|v| v.at)
            .collect();
        let drawn = curves.iter().flat_map(|c| curve_paths(c, frame, x, y));
        let lines: Vec<Path> = drawn.chain(paths.iter().cloned()).collect();
        let mut items = vec![Item::Shape {
            paths,
            style: Style::stroke(Token::Error, 0.4).dashed(&[2.4, 1.2]),
        }];
        let label = shortened(&self.label, SIZE, (right - left - 2.0).max(10.0));
        let wide = text_width(&label, SIZE);
        let mut best: Option<(f64, Point)> = None;
        for (number, end) in ends.iter().rev().enumerate() {
            let from = if number == 0 {
                end[0] - 0.8 - wide
            } else {
                end[0] + 0.8
            };
            let from = from.clamp(left + 0.8, (right - 0.8 - wide).max(left + 0.8));
            for low in [end[1] + 1.0, end[1] - SIZE - 0.4] {
                let room = [[from, low - 0.4], [from + wide, low + 0.8 * SIZE]];
                if room[0][1] < bottom || room[1][1] > top {
                    continue;
                }
                let cost = lines.iter().map(|line| covered(line, &room)).sum();
                if best.is_none_or(|(least, _)| cost < least - 0.5) {
                    best = Some((cost, [from, low]));
                }
            }
        }
        if let (Some((_, at)), false) = (best, label.is_empty()) {
            items.push(Item::Text(Text {
                halo: true,
                ..Text::new(at, SIZE, label).colored(Token::Error)
            }));
        }
        Group::new(Layer::Limit, items)
    }
}

/// About how much of a line lies in a box, mm.
fn covered(line: &Path, room: &[Point; 2]) -> f64 {
    let pieces = line.segments().map(|(a, b, _)| {
        let long = distance(a, b);
        let steps = (long / 0.4).ceil().clamp(1.0, 400.0) as usize;
        let inside = |k: &usize| {
            let t = (*k as f64 + 0.5) / steps as f64;
            (0..2).all(|i| {
                let v = a[i] + t * (b[i] - a[i]);
                v > room[0][i] && v < room[1][i]
            })
        };
        (0..steps).filter(inside).count() as f64 * long / steps as f64
    });
    pieces.sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scale(high: f64) -> Scale {
        Scale {
            low: 0.0,
            high,
            from: 0.0,
            to: 100.0,
            log: false,
        }
    }

    #[test]
    fn the_area_beyond_starts_and_ends_where_the_curve_crosses() {
        let curve = Curve {
            x: vec![0.0, 1.0, 2.0, 3.0, 4.0],
            y: vec![0.0, 4.0, 8.0, 4.0, 0.0],
            ..Curve::default()
        };
        let (x, y) = (scale(4.0), scale(10.0));
        let frame = [0.0, 0.0, 100.0, 100.0];
        let places = |limit: Limit| -> Vec<Vec<Point>> {
            let areas = limit.areas(&curve, frame, &x, &y);
            areas
                .iter()
                .map(|p| p.vertices.iter().map(|v| v.at).collect())
                .collect()
        };
        let above = places(Limit::above("", 6.0));
        assert_eq!(above.len(), 1);
        for corner in [[37.5, 60.0], [50.0, 80.0], [62.5, 60.0]] {
            assert!(above[0].contains(&corner), "{above:?}");
        }
        assert_eq!(places(Limit::below("", 6.0)).len(), 2);
        assert!(places(Limit::above("", 9.0)).is_empty());
        let sloped = Limit::along("", vec![0.0, 4.0], vec![10.0, 0.0]);
        assert_eq!(places(sloped).len(), 1);
        assert!(places(Limit::above("", f64::NAN)).is_empty());
    }
}
