//! Paths of straight lines and circular arcs.

use kempe_number::math::{hypot, sin_cos};

use super::Point;

/// A corner of a path, and how the path goes on to the next one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Where.
    pub at: Point,
    /// Tangent of a quarter of the angle of the arc to the next vertex, positive counter-clockwise; 0 for a straight line.
    pub bulge: f64,
}

/// Straight lines and circular arcs, end to end.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Path {
    /// Corners in order.
    pub vertices: Vec<Vertex>,
    /// The last corner is joined to the first.
    pub closed: bool,
}

impl Path {
    /// Straight lines through the points.
    pub fn polyline(points: &[Point]) -> Path {
        Path {
            vertices: points.iter().map(|&at| Vertex { at, bulge: 0.0 }).collect(),
            closed: false,
        }
    }

    /// Straight lines around the points.
    pub fn polygon(points: &[Point]) -> Path {
        Path {
            closed: true,
            ..Path::polyline(points)
        }
    }

    /// A rectangle between two opposite corners, its own corners rounded.
    pub fn rectangle(low: Point, high: Point, radius: f64) -> Path {
        let ([x0, y0], [x1, y1]) = (low, high);
        if radius <= 0.0 {
            return Path::polygon(&[[x0, y0], [x1, y0], [x1, y1], [x0, y1]]);
        }
        let r = radius.min((x1 - x0) / 2.0).min((y1 - y0) / 2.0);
        let corner = 0.41421356237309503;
        let vertex = |x, y, bulge| Vertex { at: [x, y], bulge };
        let vertices = vec![
            vertex(x0 + r, y0, 0.0),
            vertex(x1 - r, y0, corner),
            vertex(x1, y0 + r, 0.0),
            vertex(x1, y1 - r, corner),
            vertex(x1 - r, y1, 0.0),
            vertex(x0 + r, y1, corner),
            vertex(x0, y1 - r, 0.0),
            vertex(x0, y0 + r, corner),
        ];
        Path {
            vertices,
            closed: true,
        }
    }

    /// An arc of a circle from the angle `start` over `sweep` rad, counter-clockwise when positive, short of a full turn.
    pub fn arc(center: Point, radius: f64, start: f64, sweep: f64) -> Path {
        let on = |angle: f64| {
            let (s, c) = sin_cos(angle);
            [center[0] + radius * c, center[1] + radius * s]
        };
        let (s, c) = sin_cos(sweep / 4.0);
        let vertices = vec![
            Vertex {
                at: on(start),
                bulge: s / c,
            },
            Vertex {
                at: on(start + sweep),
                bulge: 0.0,
            },
        ];
        Path {
            vertices,
            closed: false,
        }
    }

    /// The pieces of the path: start, end, bulge.
    pub fn segments(&self) -> impl Iterator<Item = (Point, Point, f64)> + '_ {
        let n = self.vertices.len();
        let count = if self.closed { n } else { n.saturating_sub(1) };
        (0..count).map(move |i| {
            (
                self.vertices[i].at,
                self.vertices[(i + 1) % n].at,
                self.vertices[i].bulge,
            )
        })
    }
}

/// Distance of two points.
#[inline]
pub(crate) fn distance(a: Point, b: Point) -> f64 {
    hypot(b[0] - a[0], b[1] - a[1])
}
