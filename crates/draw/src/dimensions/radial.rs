//! Radii: a line from the centre to the circle, its text outside.

use super::way::{ABOVE, Way, readable};
use crate::labels::{Room, Words};
use crate::scene::Point;
use kempe_number::math::sin_cos;
use std::f64::consts::PI;

/// Of a long radius so much is drawn inside of the circle, mm.
const INSIDE: f64 = 16.0;
/// Between the centre and the line, mm.
const CLEAR: f64 = 2.4;
/// How far outside the text begins, mm.
const OUTSIDE: [f64; 3] = [2.0, 7.0, 13.0];

/// The ways to write the radius of a circle; of an arc near its middle only.
pub(super) fn ways(center: Point, radius: f64, middle: Option<f64>, words: &Words) -> Vec<Way> {
    let turns = match middle {
        Some(middle) => [0.0, 0.08, -0.08, 0.16, -0.16]
            .map(|turn| middle + turn)
            .to_vec(),
        None => [2.0, 10.0, 1.0, 11.0, 5.0, 7.0, 4.0, 8.0, 3.0, 9.0]
            .map(|k| k * PI / 6.0 + 0.12)
            .to_vec(),
    };
    let mut found = Vec::new();
    for (further, out) in OUTSIDE.into_iter().enumerate() {
        for (number, turn) in turns.iter().enumerate() {
            let (s, c) = sin_cos(*turn);
            let at = |r: f64| [center[0] + r * c, center[1] + r * s];
            let read = readable([c, s]);
            let up = [-read[1], read[0]];
            let end = radius + out + 2.0 * words.half[0];
            let on = at(radius + out + words.half[0]);
            let rise = words.half[1] + ABOVE;
            let start = match radius > 1.5 * INSIDE {
                true => radius - INSIDE,
                false => CLEAR.min(radius / 2.0),
            };
            found.push(Way {
                dislike: 1.5 * further as f64 + 0.15 * number as f64,
                room: Room {
                    middle: [on[0] + rise * up[0], on[1] + rise * up[1]],
                    half: words.half,
                    along: read,
                },
                lines: vec![[at(start), at(end)]],
                arc: None,
                heads: vec![(at(radius), [c, s])],
            });
        }
    }
    found
}
