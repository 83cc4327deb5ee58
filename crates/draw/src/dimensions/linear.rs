//! Lengths: a line beside what is measured, between extension lines from its ends.

use super::way::{ABOVE, HEAD, Way, direction, readable};
use crate::labels::{Room, Words};
use crate::scene::{Point, distance};

/// From a point to where its extension line begins, and from the dimension line to where that ends, mm.
const EXTENSION: [f64; 2] = [2.4, 1.0];
/// Distances of the dimension line from what it measures, mm.
const OFFSETS: [f64; 8] = [5.5, 9.5, 13.5, 17.5, 22.0, 27.0, 33.0, 40.0];
/// How much worse each distance is than the one before.
const FURTHER: f64 = 1.2;
/// What is shorter than this has its arrowheads outside, mm.
const SHORTEST: f64 = 3.0 * HEAD[0];
/// How far the line goes on past arrowheads outside, mm.
const PAST: f64 = 4.5;
/// How much worse a text beyond the end of its line is than one on it.
const BEYOND: f64 = 2.0;

/// The ways to write the distance of two points along a direction, or that of the points themselves.
pub(super) fn ways(ends: [Point; 2], along: Option<Point>, words: &Words) -> Option<Vec<Way>> {
    let [p, q] = ends;
    let along = match along {
        Some(along) => along,
        None => direction(p, q)?,
    };
    let across = [-along[1], along[0]];
    let dot = |a: Point, b: Point| a[0] * b[0] + a[1] * b[1];
    let mut ends = [p, q].map(|e| (dot(e, along), dot(e, across), e));
    if ends[0].0 > ends[1].0 {
        ends.swap(0, 1);
    }
    let place = |u: f64, v: f64| [0, 1].map(|k: usize| u * along[k] + v * across[k]);
    let mut found = Vec::new();
    for (number, offset) in OFFSETS.into_iter().enumerate() {
        for (side, first) in [(1.0, 0.0), (-1.0, 0.1)] {
            let edge = match side > 0.0 {
                true => ends[0].1.max(ends[1].1),
                false => ends[0].1.min(ends[1].1),
            };
            let v = edge + side * offset;
            let (a, b) = (place(ends[0].0, v), place(ends[1].0, v));
            let extensions = ends.iter().map(|(u, from, _)| {
                let way = (v - from).signum();
                [
                    place(*u, from + way * EXTENSION[0]),
                    place(*u, v + way * EXTENSION[1]),
                ]
            });
            let extensions: Vec<[Point; 2]> = extensions.collect();
            for (room, past, worse) in texts(a, b, along, words) {
                let mut lines = vec![past];
                lines.extend(&extensions);
                let inward = distance(a, b) < SHORTEST;
                let out = if inward { -1.0 } else { 1.0 };
                let heads = vec![(a, along.map(|k| -out * k)), (b, along.map(|k| out * k))];
                found.push(Way {
                    dislike: first + worse + FURTHER * number as f64,
                    room,
                    lines,
                    arc: None,
                    heads,
                });
            }
        }
    }
    Some(found)
}

/// Where the text of a line from `a` to `b` may stand, how long the line is then, and how much worse that is.
fn texts(a: Point, b: Point, along: Point, words: &Words) -> Vec<(Room, [Point; 2], f64)> {
    let read = readable(along);
    let up = [-read[1], read[0]];
    let long = distance(a, b);
    let [wide, high] = words.half;
    let at = |u: f64| [0, 1].map(|k: usize| a[k] + u * along[k]);
    let room = |u: f64| {
        let on = at(u);
        let middle = [0, 1].map(|k: usize| on[k] + (high + ABOVE) * up[k]);
        Room {
            middle,
            half: words.half,
            along: read,
        }
    };
    let past = if long < SHORTEST { PAST } else { 0.0 };
    let line = |from: f64, to: f64| [at(from.min(-past)), at(to.max(long + past))];
    let inner = 2.0 * wide < long - 1.0;
    let mut found = Vec::new();
    if inner {
        for (share, worse) in [(0.5, 0.0), (0.3, 0.5), (0.7, 0.5)] {
            let u = (share * long).clamp(wide + 0.5, long - wide - 0.5);
            found.push((room(u), line(0.0, long), worse));
        }
    } else {
        // across both arrowheads, or past one of them
        let far = past.max(1.0) + wide;
        for (u, worse) in [
            (long / 2.0, if past > 0.0 { 1.0 } else { 0.3 }),
            (long + far, BEYOND),
            (-far, BEYOND),
        ] {
            found.push((
                room(u),
                line((u - wide).min(0.0), (u + wide).max(long)),
                worse,
            ));
        }
    }
    found
}
