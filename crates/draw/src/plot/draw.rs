//! Layout of a plot.

use super::axis::{Scale, Ticks, power_text};
use super::curve::{Curve, curve_dots, curve_paths};
use super::frame::Frame;
use super::hodograph;
use super::limit::Limit;
use super::spec::{MarkerKind, PlotSpec};
use crate::scene::{Align, Group, Item, Layer, Path, Point, Scene, Style, Text};
use crate::text::{shortened, width as text_width};
use crate::tokens::Token;

/// Font sizes, mm: ticks and legend, axis titles, title.
const SMALL: f64 = 2.9;
const MEDIUM: f64 = 3.2;
const LARGE: f64 = 3.8;
/// Radius of a dot, mm.
const DOT: f64 = 0.9;

/// A plot laid out: the picture, and how values map to it.
#[derive(Clone, Debug, PartialEq)]
pub struct PlotPicture {
    /// The picture.
    pub scene: Scene,
    /// From values to mm from the left.
    pub x: Scale,
    /// From values to mm from the bottom.
    pub y: Scale,
}

impl PlotSpec {
    /// Draws the plot on a sheet of the given width and height, mm.
    pub fn draw(&self, width: f64, height: f64) -> PlotPicture {
        let side = |v: f64| {
            if v.is_finite() {
                v.clamp(40.0, 2000.0)
            } else {
                100.0
            }
        };
        draw(self, side(width), side(height))
    }
}

fn draw(plot: &PlotSpec, width: f64, height: f64) -> PlotPicture {
    let named: Vec<(usize, &Curve)> = plot
        .curves
        .iter()
        .enumerate()
        .filter(|(_, c)| !c.label.is_empty())
        .collect();
    let mut captions = Vec::new();
    let mut top = height - 3.0;
    if !plot.title.is_empty() {
        top -= LARGE;
        let title = shortened(&plot.title, LARGE, width - 8.0);
        captions.push(Item::Text(Text {
            bold: true,
            ..Text::new([4.0, top], LARGE, title)
        }));
        top -= 2.0;
    }
    if named.len() > 1 {
        top = legend(&named, width, top, height * 0.4, &mut captions);
    }
    let (vectors, largest) = match plot.hodograph {
        Some(_) => plot.vectors(),
        None => ([Vec::new(), Vec::new()], None),
    };
    let ranges = [(&plot.x, 0.0, 0), (&plot.y, 0.05, 1)].map(|(axis, margin, k)| {
        let values = plot
            .curves
            .iter()
            .flat_map(|c| if k == 0 { &c.x } else { &c.y });
        let limits = plot
            .limits
            .iter()
            .filter(|_| k == 1)
            .flat_map(Limit::values);
        let values: Box<dyn Iterator<Item = &f64>> = match plot.hodograph {
            Some(_) => Box::new(vectors[k].iter()),
            None => Box::new(values.chain(limits)),
        };
        let margin = if plot.is_plane() { 0.05 } else { margin };
        let margin = if plot.hodograph.is_some() {
            0.12
        } else {
            margin
        };
        let limits = axis
            .limits
            .filter(|[a, b]| a < b && b - a < 1e290 && (!axis.log || *a > 1e-290));
        limits.unwrap_or_else(|| Scale::range(values.copied(), axis.log, margin))
    });
    let bottom = 12.0;
    let top = (top - 2.0).max(bottom + 10.0);
    let mut y = Scale {
        low: ranges[1][0],
        high: ranges[1][1],
        from: bottom,
        to: top,
        log: plot.y.log,
    };
    let y_ticks = Ticks::new(&y, ((top - bottom) / 6.5).clamp(3.0, 8.0), &plot.y.unit);
    let widest = y_ticks
        .marks
        .iter()
        .map(|(_, t)| text_width(t, SMALL))
        .fold(4.0, f64::max);
    let left = (widest + 9.5).min(width * 0.4);
    let right = width - 5.0;
    let mut x = Scale {
        low: ranges[0][0],
        high: ranges[0][1],
        from: left,
        to: right,
        log: plot.x.log,
    };
    if plot.is_plane() && !x.log && !y.log {
        equalize(&mut x, &mut y);
    }
    let x_ticks = Ticks::new(&x, ((right - left) / 17.0).clamp(2.0, 9.0), &plot.x.unit);
    let y_ticks = Ticks::new(&y, ((top - bottom) / 6.5).clamp(3.0, 8.0), &plot.y.unit);
    let frame = [left, bottom, right, top];
    let mut groups = vec![Group::new(
        Layer::Furniture,
        furniture(frame, &x, &y, &x_ticks, &y_ticks),
    )];
    groups.push(Group::new(Layer::Furniture, markers(plot, frame, &x)));
    let shading = |limit: &Limit| limit.shading(&plot.curves, frame, &x, &y);
    groups.extend(plot.limits.iter().map(shading));
    let [cross, vector, tips] = match &plot.hodograph {
        Some(hodograph) => {
            hodograph::groups(plot, hodograph, largest, [width, height], frame, &x, &y).map(Some)
        }
        None => [None, None, None],
    };
    groups.extend(cross);
    for (index, curve) in plot.curves.iter().enumerate() {
        if curve.dots {
            let items = curve_dots(curve, frame, &x, &y);
            let dot = |at: &Point| Item::circle(*at, DOT, dot_style(curve, index));
            groups.push(Group::new(
                Layer::Curve(index),
                items.iter().map(dot).collect(),
            ));
            continue;
        }
        let paths = curve_paths(curve, frame, &x, &y);
        let style = Style::stroke(curve.token(index), 0.55);
        let style = if curve.dashed {
            style.dashed(&[1.8, 1.2])
        } else {
            style
        };
        groups.push(Group::new(
            Layer::Curve(index),
            vec![Item::Shape { paths, style }],
        ));
    }
    let limit = |limit: &Limit| limit.group(&plot.curves, frame, &x, &y);
    groups.extend(plot.limits.iter().map(limit));
    groups.extend(vector.into_iter().chain(tips));
    let y_title = format!("{}{}", plot.y.title(), power_text(y_ticks.power));
    let x_title = format!("{}{}", plot.x.title(), power_text(x_ticks.power));
    let middle = [(left + right) / 2.0, (bottom + top) / 2.0];
    let x_text = Text::new(
        [middle[0], 2.4],
        MEDIUM,
        shortened(&x_title, MEDIUM, right - left),
    )
    .aligned(Align::Middle);
    let y_text = Text::new(
        [4.6, middle[1]],
        MEDIUM,
        shortened(&y_title, MEDIUM, top - bottom),
    )
    .aligned(Align::Middle);
    captions.push(Item::Text(x_text));
    captions.push(Item::Text(Text {
        turn: 90.0,
        ..y_text
    }));
    groups.push(Group::new(Layer::Caption, captions));
    let title = if plot.title.is_empty() {
        format!("{} over {}", plot.y.title(), plot.x.title())
    } else {
        plot.title.clone()
    };
    PlotPicture {
        scene: Scene {
            width,
            height,
            title,
            groups,
        },
        x,
        y,
    }
}

/// Stretches one range so that a unit is as long on both axes.
fn equalize(x: &mut Scale, y: &mut Scale) {
    let per_mm = |s: &Scale| (s.high - s.low) / (s.to - s.from);
    let coarse = per_mm(x).max(per_mm(y));
    for scale in [x, y] {
        let (middle, half) = (
            (scale.low + scale.high) / 2.0,
            coarse * (scale.to - scale.from) / 2.0,
        );
        (scale.low, scale.high) = (middle - half, middle + half);
    }
}

/// A full dot, or an empty one of what is dashed.
fn dot_style(curve: &Curve, index: usize) -> Style {
    let token = curve.token(index);
    match curve.dashed {
        true => Style::stroke(token, 0.4),
        false => Style::fill(token),
    }
}

/// Writes the legend in rows below `top`, at most so high; returns the height where it ends.
fn legend(
    named: &[(usize, &Curve)],
    width: f64,
    top: f64,
    room: f64,
    items: &mut Vec<Item>,
) -> f64 {
    let (mut x, mut y) = (4.0, top - SMALL);
    for (index, curve) in named {
        let label = shortened(&curve.label, SMALL, width - 20.0);
        let needed = 8.0 + text_width(&label, SMALL) + 4.0;
        if x + needed > width && x > 4.0 {
            (x, y) = (4.0, y - SMALL - 1.4);
            if top - y > room {
                items.push(Item::Text(
                    Text::new([x, y], SMALL, "…").colored(Token::Muted),
                ));
                break;
            }
        }
        let style = Style::stroke(curve.token(*index), 0.7);
        let style = if curve.dashed {
            style.dashed(&[1.8, 1.2])
        } else {
            style
        };
        let middle = y + SMALL * 0.33;
        items.push(match curve.dots {
            true => Item::circle([x + 3.0, middle], DOT, dot_style(curve, *index)),
            false => Item::path(Path::polyline(&[[x, middle], [x + 6.0, middle]]), style),
        });
        items.push(Item::Text(Text::new([x + 7.5, y], SMALL, label)));
        x += needed;
    }
    y - 1.6
}

fn furniture(frame: Frame, x: &Scale, y: &Scale, x_ticks: &Ticks, y_ticks: &Ticks) -> Vec<Item> {
    let [left, bottom, right, top] = frame;
    let mut grid = Vec::new();
    let mut texts = Vec::new();
    for (value, label) in &x_ticks.marks {
        let Some(px) = x.at(*value) else { continue };
        grid.push(Path::polyline(&[[px, bottom], [px, top]]));
        texts.push(
            Text::new([px, bottom - SMALL - 1.0], SMALL, label.clone()).aligned(Align::Middle),
        );
    }
    for (value, label) in &y_ticks.marks {
        let Some(py) = y.at(*value) else { continue };
        grid.push(Path::polyline(&[[left, py], [right, py]]));
        texts.push(
            Text::new([left - 1.4, py - SMALL * 0.35], SMALL, label.clone()).aligned(Align::End),
        );
    }
    let mut items = vec![Item::Shape {
        paths: grid,
        style: Style::stroke(Token::Grid, 0.2),
    }];
    let zero = y.at(0.0).filter(|p| !y.log && *p > bottom && *p < top);
    items.extend(zero.map(|p| {
        Item::path(
            Path::polyline(&[[left, p], [right, p]]),
            Style::stroke(Token::Muted, 0.25),
        )
    }));
    items.push(Item::path(
        Path::polyline(&[[left, top], [left, bottom], [right, bottom]]),
        Style::stroke(Token::Muted, 0.35),
    ));
    items.extend(
        texts
            .into_iter()
            .map(|t| Item::Text(t.colored(Token::Muted))),
    );
    items
}

fn markers(plot: &PlotSpec, frame: Frame, x: &Scale) -> Vec<Item> {
    let [left, bottom, right, top] = frame;
    let mut items = Vec::new();
    let mut free_from = f64::NEG_INFINITY;
    for marker in plot.markers.iter().take(200) {
        let Some(px) = x
            .at(marker.at)
            .filter(|p| *p >= left - 1e-6 && *p <= right + 1e-6)
        else {
            continue;
        };
        let (token, dash): (Token, &[f64]) = match marker.kind {
            MarkerKind::DeadPoint => (Token::Error, &[1.6, 1.0]),
            MarkerKind::ChangePoint => (Token::Warning, &[0.5, 1.0]),
            MarkerKind::Limit => (Token::Error, &[]),
            MarkerKind::Event => (Token::Muted, &[0.5, 1.0]),
        };
        items.push(Item::path(
            Path::polyline(&[[px, bottom], [px, top]]),
            Style::stroke(token, 0.35).dashed(dash),
        ));
        // names stand beside their lines, where they do not run into each other
        if px > free_from {
            let label = shortened(&marker.label, 2.5, top - bottom - 2.0);
            let at = if px + 3.2 > right { px - 0.8 } else { px + 2.9 };
            items.push(Item::Text(Text {
                turn: 90.0,
                halo: true,
                ..Text::new([at, top - 1.0], 2.5, label)
                    .aligned(Align::End)
                    .colored(token)
            }));
            free_from = px + 3.4;
        }
    }
    items
}
