//! Coupler curves: the travelled part solid, the rest faint.

use crate::context::Context;
use crate::scene::{Group, Item, Layer, Path, Point, Style, distance};
use crate::tokens::Token;

/// Neighbouring samples closer than this on paper (mm) are drawn as one.
const FINEST: f64 = 0.05;
/// A path is drawn to this many points: one that is longer has gone round hundreds of times.
const MOST_POINTS: usize = 100_000;
/// Opacity of the part not yet travelled.
const REST: f64 = 0.4;

/// The path of a point on paper.
pub struct TracePath {
    /// Its colour.
    pub token: Token,
    /// Unbroken pieces: pose number and place.
    pub pieces: Vec<Vec<(usize, Point)>>,
}

impl TracePath {
    /// The paths of all traced points over all poses.
    pub fn all(context: &Context) -> Vec<TracePath> {
        let path = |trace: &crate::view::TraceView| {
            let mut pieces: Vec<Vec<(usize, Point)>> = vec![Vec::new()];
            let mut left = MOST_POINTS;
            for (index, frame) in context.frames.iter().enumerate() {
                match (context.paper(frame, trace.point), pieces.last_mut()) {
                    (Some(p), Some(piece)) => {
                        if piece
                            .last()
                            .is_none_or(|(_, last)| distance(*last, p) > FINEST)
                        {
                            piece.push((index, p));
                            left -= 1;
                        }
                    }
                    _ => pieces.push(Vec::new()),
                }
                if left == 0 {
                    break;
                }
            }
            pieces.retain(|piece| piece.len() > 1);
            let carrier = context
                .roles
                .point(trace.point)
                .carriers
                .last()
                .copied()
                .unwrap_or(1);
            TracePath {
                token: Token::Series(carrier.saturating_sub(1)),
                pieces,
            }
        };
        context.view.traces.iter().map(path).collect()
    }

    /// The pieces as paths, up to and with a pose.
    pub fn paths(&self, until: usize) -> Vec<Path> {
        let path = |piece: &Vec<(usize, Point)>| {
            let points: Vec<Point> = piece
                .iter()
                .filter(|(i, _)| *i <= until)
                .map(|(_, p)| *p)
                .collect();
            (points.len() > 1).then(|| Path::polyline(&points))
        };
        self.pieces.iter().filter_map(path).collect()
    }

    /// Both parts, as seen from a pose.
    pub fn groups(&self, index: usize) -> Vec<Group> {
        let group = |layer, paths: Vec<Path>, width, alpha| {
            let style = Style::stroke(self.token, width).faded(alpha);
            (!paths.is_empty()).then(|| Group::new(layer, vec![Item::Shape { paths, style }]))
        };
        [
            group(Layer::TraceRest, self.paths(usize::MAX), 0.35, REST),
            group(Layer::TracePast, self.paths(index), 0.55, 1.0),
        ]
        .into_iter()
        .flatten()
        .collect()
    }
}
