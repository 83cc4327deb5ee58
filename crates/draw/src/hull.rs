//! Rounded convex hulls: the body of a link around its points.

use kempe_number::math::{atan2, sin_cos};

use crate::scene::{Path, Point, Vertex, distance};

/// Points closer than this on paper (mm) count as one.
const SAME_PLACE: f64 = 1e-6;

/// Convex hull, counter-clockwise, without points on its edges. One or two points when they are all on one spot or line.
pub fn convex_hull(points: &[Point]) -> Vec<Point> {
    let mut sorted: Vec<Point> = points
        .iter()
        .copied()
        .filter(|p| p[0].is_finite() && p[1].is_finite())
        .collect();
    // On an upright line rounding of x decides nothing.
    let (low, high) = (sorted.iter()).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
        (low.min(p[0]), high.max(p[0]))
    });
    let upright = high - low < SAME_PLACE;
    sorted.sort_by(|a, b| {
        let by_x = if upright {
            std::cmp::Ordering::Equal
        } else {
            a[0].total_cmp(&b[0])
        };
        by_x.then(a[1].total_cmp(&b[1]))
    });
    sorted.dedup_by(|a, b| distance(*a, *b) < SAME_PLACE);
    if sorted.len() < 3 {
        return sorted;
    }
    let half = |points: &mut dyn Iterator<Item = Point>| {
        let mut chain: Vec<Point> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..] {
                // the middle point stays only where it stands out of the chord by more than nothing
                let cross = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
                if cross > SAME_PLACE * distance(a, p).max(SAME_PLACE) {
                    break;
                }
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut hull = half(&mut sorted.iter().copied());
    hull.extend(half(&mut sorted.iter().rev().copied()));
    hull
}

/// The outline at the distance `radius` around the convex hull of the points; `None` without any finite point.
pub fn rounded_hull(points: &[Point], radius: f64) -> Option<Path> {
    let hull = convex_hull(points);
    let n = hull.len();
    match n {
        0 => None,
        1 => {
            let ([x, y], r) = (hull[0], radius);
            let vertices = vec![
                Vertex {
                    at: [x + r, y],
                    bulge: 1.0,
                },
                Vertex {
                    at: [x - r, y],
                    bulge: 1.0,
                },
            ];
            Some(Path {
                vertices,
                closed: true,
            })
        }
        _ => {
            let outward = |i: usize| {
                let (a, b) = (hull[i % n], hull[(i + 1) % n]);
                let length = distance(a, b).max(SAME_PLACE);
                [(b[1] - a[1]) / length, (a[0] - b[0]) / length]
            };
            let mut vertices = Vec::with_capacity(2 * n);
            for (i, corner) in hull.iter().enumerate() {
                let (before, after) = (outward(i + n - 1), outward(i));
                let cross = before[0] * after[1] - before[1] * after[0];
                let dot = before[0] * after[0] + before[1] * after[1];
                let turn = if n == 2 {
                    std::f64::consts::PI
                } else {
                    atan2(cross, dot).abs()
                };
                let (s, c) = sin_cos(turn / 4.0);
                let at = |normal: [f64; 2]| {
                    [
                        corner[0] + radius * normal[0],
                        corner[1] + radius * normal[1],
                    ]
                };
                vertices.push(Vertex {
                    at: at(before),
                    bulge: s / c,
                });
                vertices.push(Vertex {
                    at: at(after),
                    bulge: 0.0,
                });
            }
            Some(Path {
                vertices,
                closed: true,
            })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_inside_or_on_an_edge_is_no_corner() {
        let triangle = [
            [0.0, 0.0],
            [10.0, 0.0],
            [0.0, 10.0],
            [2.0, 2.0],
            [5.0, 0.0],
            [0.0, 0.0],
        ];
        assert_eq!(
            convex_hull(&triangle),
            [[0.0, 0.0], [10.0, 0.0], [0.0, 10.0]]
        );
        let line = [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [7.0, 7.0]];
        assert_eq!(convex_hull(&line), [[0.0, 0.0], [7.0, 7.0]]);
        let upright = [[1e-15, 0.0], [0.0, -7.0], [-1e-15, 5.0], [2e-15, 1.0]];
        assert_eq!(convex_hull(&upright), [[0.0, -7.0], [-1e-15, 5.0]]);
        assert_eq!(convex_hull(&[[f64::NAN, 0.0]]), Vec::<Point>::new());
    }

    #[test]
    fn a_bar_has_half_turns_at_its_ends() {
        let bar = rounded_hull(&[[0.0, 0.0], [10.0, 0.0]], 2.0).unwrap();
        assert_eq!(bar.vertices.len(), 4);
        assert!((bar.vertices[0].bulge - 1.0).abs() < 1e-15);
        assert!(
            bar.vertices
                .iter()
                .all(|v| (v.at[1].abs() - 2.0).abs() < 1e-12)
        );
    }
}
