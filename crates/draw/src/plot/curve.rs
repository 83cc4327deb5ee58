//! Curves: gaps, thinning without losing peaks, clipping to the axes.

use super::axis::Scale;
use super::frame::Frame;
use crate::scene::{Path, Point, distance};
use crate::tokens::Token;

/// Samples closer than this on paper (mm) are drawn as one.
const FINEST: f64 = 0.03;
/// Curves with more rows than this are thinned to about so many.
const MOST_ROWS: usize = 4000;

/// A curve through pairs of values. Where one of a pair is not finite, the curve has a gap.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// Name in the legend.
    pub label: String,
    /// Abscissae, in the unit of the x axis.
    pub x: Vec<f64>,
    /// Ordinates, in the unit of the y axis.
    pub y: Vec<f64>,
    /// Dashed.
    pub dashed: bool,
    /// Its values are dots that nothing joins.
    pub dots: bool,
    /// The number of its colour; its place among the curves when `None`.
    pub color: Option<usize>,
    /// Of a curve of another design: what a reader is told of it at the rows of the motion.
    pub told: Option<Told>,
}

impl Curve {
    /// The colour of the curve that stands at a place among others.
    pub(crate) fn token(&self, index: usize) -> Token {
        Token::Series(self.color.unwrap_or(index))
    }
}

/// What a reader is told of a curve that has other rows than the motion beside it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Told {
    /// What it is called.
    pub name: String,
    /// Its abscissa at each row of the motion, in the unit of the x axis; NaN where it has none.
    pub x: Vec<f64>,
    /// Its ordinate there, in the unit of the y axis.
    pub y: Vec<f64>,
}

/// The rows to draw: all, or of each short run its ends, its extremes and its gaps, so that no peak is lost.
pub(crate) fn thinned(curve: &Curve) -> Vec<usize> {
    let rows = curve.x.len().min(curve.y.len());
    if rows <= MOST_ROWS {
        return (0..rows).collect();
    }
    let run = rows.div_ceil(MOST_ROWS / 4).max(5);
    let mut kept = Vec::with_capacity(MOST_ROWS + 8);
    for first in (0..rows).step_by(run) {
        let last = (first + run).min(rows) - 1;
        let finite = || (first..=last).filter(|&k| curve.y[k].is_finite());
        let low = finite().min_by(|&a, &b| curve.y[a].total_cmp(&curve.y[b]));
        let high = finite().max_by(|&a, &b| curve.y[a].total_cmp(&curve.y[b]));
        let gap = (first..=last).find(|&k| !curve.y[k].is_finite());
        let mut some: Vec<usize> = [Some(first), low, high, gap, Some(last)]
            .into_iter()
            .flatten()
            .collect();
        some.sort_unstable();
        some.dedup();
        kept.extend(some);
    }
    kept
}

/// The pieces of a curve that lie inside the axes.
pub(super) fn curve_paths(curve: &Curve, frame: Frame, x: &Scale, y: &Scale) -> Vec<Path> {
    let mut pieces: Vec<Vec<Point>> = vec![Vec::new()];
    let mut last: Option<Point> = None;
    for row in thinned(curve) {
        let (vx, vy) = (curve.x[row], curve.y[row]);
        let here = x.at(vx).zip(y.at(vy)).map(|(a, b)| [a, b]);
        if let (Some(a), Some(b)) = (last, here) {
            if distance(a, b) < FINEST {
                continue;
            }
            match clip(a, b, frame) {
                Some((p, q)) => {
                    let joined = pieces
                        .last()
                        .and_then(|piece| piece.last())
                        .is_some_and(|end| *end == p);
                    if !joined {
                        pieces.push(vec![p]);
                    }
                    pieces
                        .last_mut()
                        .into_iter()
                        .for_each(|piece| piece.push(q));
                }
                None => pieces.push(Vec::new()),
            }
        } else {
            pieces.push(Vec::new());
        }
        last = here;
    }
    pieces
        .iter()
        .filter(|piece| piece.len() > 1)
        .map(|piece| Path::polyline(piece))
        .collect()
}

/// The values of a curve that lie inside the axes.
pub(super) fn curve_dots(curve: &Curve, frame: Frame, x: &Scale, y: &Scale) -> Vec<Point> {
    let places = curve.x.iter().zip(&curve.y);
    let inside = |p: &Point| (0..2).all(|k| p[k] >= frame[k] && p[k] <= frame[k + 2]);
    places
        .filter_map(|(vx, vy)| x.at(*vx).zip(y.at(*vy)).map(|(a, b)| [a, b]))
        .filter(inside)
        .collect()
}

/// The part of a line inside the axes (Liang and Barsky 1984).
fn clip(a: Point, b: Point, frame: Frame) -> Option<(Point, Point)> {
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    let delta = [b[0] - a[0], b[1] - a[1]];
    for k in 0..2 {
        for (p, q) in [
            (-delta[k], a[k] - frame[k]),
            (delta[k], frame[k + 2] - a[k]),
        ] {
            if p == 0.0 {
                if q < 0.0 {
                    return None;
                }
            } else if p < 0.0 {
                enter = enter.max(q / p);
            } else {
                leave = leave.min(q / p);
            }
        }
    }
    let at = |t: f64| [a[0] + t * delta[0], a[1] + t * delta[1]];
    let start = if enter == 0.0 { a } else { at(enter) };
    let end = if leave == 1.0 { b } else { at(leave) };
    (enter <= leave).then_some((start, end))
}
