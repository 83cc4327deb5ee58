//! Paths of straight lines and circular arcs.

use kempe_number::math::{atan2, hypot, sin_cos};

/// A point on paper, mm, y up.
pub type Point = [f64; 2];

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

/// The sides of an arc's polygon turn by no more than this, rad.
const WIDEST_STEP: f64 = 0.12;

/// Points after the start along a segment: the end alone for a straight line; for an arc the corners of a polygon that stays
/// within `sagitta` of it.
pub(crate) fn arc_points(from: Point, to: Point, bulge: f64, sagitta: f64) -> Vec<Point> {
    let chord = distance(from, to);
    if bulge.abs() < 1e-9 || chord == 0.0 || !bulge.is_finite() {
        return vec![to];
    }
    // centre of the arc: beside the middle of the chord, on its left for a short counter-clockwise arc
    let side = (1.0 - bulge * bulge) / (4.0 * bulge);
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let center = [
        (from[0] + to[0]) / 2.0 - side * dy,
        (from[1] + to[1]) / 2.0 + side * dx,
    ];
    let sweep = 4.0 * atan2(bulge, 1.0);
    let radius = distance(from, center);
    let step = (8.0 * sagitta / radius).sqrt().min(WIDEST_STEP);
    let steps = (sweep.abs() / step).ceil().clamp(1.0, 2048.0) as usize;
    let turned = |k: usize| {
        let (s, c) = sin_cos(sweep * k as f64 / steps as f64);
        let (x, y) = (from[0] - center[0], from[1] - center[1]);
        [center[0] + c * x - s * y, center[1] + s * x + c * y]
    };
    (1..steps).map(turned).chain([to]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polygons_of_arcs_stay_near_to_them() {
        for (radius, sagitta) in [(0.3, 0.01), (40.0, 0.01), (40.0, 0.001), (900.0, 0.01)] {
            let path = Path::arc([3.0, -2.0], radius, 0.4, 2.9);
            let (from, to, bulge) = path.segments().next().unwrap();
            let mut last = from;
            for p in arc_points(from, to, bulge, sagitta) {
                let middle = [(p[0] + last[0]) / 2.0, (p[1] + last[1]) / 2.0];
                let off = radius - distance(middle, [3.0, -2.0]);
                assert!(off > -1e-9 && off < 1.01 * sagitta, "{radius}: {off}");
                assert!((distance(p, [3.0, -2.0]) - radius).abs() < 1e-9 * radius);
                last = p;
            }
        }
    }
}
