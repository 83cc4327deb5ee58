//! Where the name of a point or of an arrow may stand: around it, the nearer the better, with a leader from further away.

use super::room::Room;
use super::wanted::{Choice, Spot};
use crate::scene::{Point, distance};
use kempe_number::math::sin_cos;

/// Directions of the middle of a label from its point, deg, in order of preference.
const SIDES: [f64; 16] = [
    45.0, 135.0, 90.0, 0.0, 180.0, -45.0, -135.0, -90.0, 22.5, 157.5, 67.5, 112.5, -22.5, -157.5,
    -67.5, -112.5,
];
/// Gaps between a label and its point, mm, each with how much worse it is; a leader bridges the larger ones.
const GAPS: [(f64, f64); 8] = [
    (0.0, 0.0),
    (1.6, 2.0),
    (4.0, 11.0),
    (6.5, 14.0),
    (9.5, 18.0),
    (13.0, 23.0),
    (17.0, 29.0),
    (23.0, 38.0),
];
/// From this gap on there is a leader, mm.
const LED: f64 = 3.0;
/// How much worse each side is than the one before.
const SIDE: f64 = 0.12;

/// A box of the given half size around a point, clear of a disc of that radius around it, in a direction.
pub(crate) fn beside(point: Point, clear: f64, half: Point, direction: f64) -> Room {
    let (s, c) = sin_cos(direction);
    // along the edges first, then around the corners: every side touches the disc
    let edge = |v: f64| v.signum() * (v.abs() / 0.7).min(1.0);
    Room::upright(
        [
            point[0] + half[0] * edge(c) + clear * c,
            point[1] + half[1] * edge(s) + clear * s,
        ],
        half,
    )
}

/// The line from a label to the rim of the disc around its point.
fn leader(room: &Room, point: Point, clear: f64) -> Option<[Point; 2]> {
    let from = room.nearest(point);
    let long = distance(from, point);
    let to = [0, 1].map(|k: usize| point[k] + (from[k] - point[k]) * clear / long);
    (long > clear).then_some([from, to])
}

/// The choices for a label of a point that lies elsewhere in every pose: clear of one disc around it, with leaders to the rim
/// of another.
pub(crate) fn around_disc(
    points: &[Option<Point>],
    [clear, rim]: [f64; 2],
    half: Point,
) -> impl Iterator<Item = Choice> {
    let choice = move |(gap, worse): (f64, f64), (number, side): (usize, f64)| {
        let spot = |point: &Option<Point>| {
            let point = (*point)?;
            let room = beside(point, clear + gap, half, side.to_radians());
            let led = (gap > LED).then(|| leader(&room, point, rim)).flatten();
            Some(Spot {
                room,
                lines: led.into_iter().collect(),
            })
        };
        Choice {
            dislike: worse + SIDE * number as f64,
            spots: points.iter().map(spot).collect(),
        }
    };
    let sides = || SIDES.into_iter().enumerate();
    let ways = GAPS
        .into_iter()
        .flat_map(move |gap| sides().map(move |side| (gap, side)));
    ways.map(move |(gap, side)| choice(gap, side))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_clear_of_their_points() {
        for half in [[1.0, 1.4], [12.0, 1.0]] {
            for choice in around_disc(&[Some([5.0, -3.0])], [2.0; 2], half) {
                let room = choice.spots[0].as_ref().unwrap().room;
                let far = distance(room.nearest([5.0, -3.0]), [5.0, -3.0]);
                assert!(far > 1.8, "{far} {room:?}");
            }
        }
    }
}
