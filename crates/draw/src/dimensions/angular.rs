//! Angles of fixed lines: an arc from a horizontal line to the line itself.

use std::f64::consts::PI;

use super::way::{HEAD, Way};
use crate::labels::{Words, beside};
use crate::scene::{Path, Point};
use kempe_number::math::sin_cos;

/// Radii of the arc, mm.
const RADII: [f64; 5] = [11.0, 15.0, 20.0, 26.0, 33.0];

/// The ways to write an angle between the x axis and a line through a point: on the line's way, and on its way back.
pub(super) fn ways(vertex: Point, direction: f64, angle: f64, words: &Words) -> Vec<Way> {
    let (s, c) = sin_cos(angle);
    let (ds, dc) = sin_cos(direction);
    let back = c * dc + s * ds < 0.0;
    let at = |radius: f64, angle: f64| -> Point {
        let (s, c) = sin_cos(angle);
        [vertex[0] + radius * c, vertex[1] + radius * s]
    };
    let mut found = Vec::new();
    for (number, radius) in RADII.into_iter().enumerate() {
        for turned in [back, !back] {
            let start = if turned { PI } else { 0.0 };
            let room = beside(
                at(radius, start + angle / 2.0),
                1.0,
                words.half,
                start + angle / 2.0,
            );
            let steps = 6;
            let on = |k: i32| at(radius, start + angle * f64::from(k) / f64::from(steps));
            let mut lines = vec![[at(2.4, start), at(radius + 2.0, start)]];
            lines.extend((0..steps).map(|k| [on(k), on(k + 1)]));
            // a head looks along the chord of its own length
            let lean = angle.signum() * (PI / 2.0 - HEAD[0] / radius / 2.0);
            let towards = |angle: f64| {
                let (s, c) = sin_cos(angle);
                [c, s]
            };
            found.push(Way {
                dislike: 1.2 * number as f64 + if turned == back { 0.0 } else { 2.0 },
                room,
                lines,
                arc: Some(Path::arc(vertex, radius, start, angle)),
                heads: vec![
                    (at(radius, start), towards(start - lean)),
                    (at(radius, start + angle), towards(start + angle + lean)),
                ],
            });
        }
    }
    found
}
