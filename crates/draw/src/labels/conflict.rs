//! What it costs that two labels are in each other's way.

use super::room::Room;
use super::wanted::Spot;
use crate::scene::Point;

/// What it costs that two labels touch, or that a label leaves the sheet; each mm as much again.
pub(super) const OVERLAP: f64 = 300.0;
/// What it costs that a line of one label runs into the text of another; each mm as much again.
const STRUCK: f64 = 40.0;
/// What it costs that a line of one label crosses one of another.
const CROSSED: f64 = 12.0;
/// Between two labels there is at least so much, mm.
pub(super) const APART: f64 = 0.5;
/// Two parallel lines of labels are at least so far from each other, mm.
pub(super) const LINES_APART: f64 = 1.2;

/// What two labels cost each other in one pose.
pub(super) fn conflict(a: &Spot, b: &Spot) -> f64 {
    let struck = |room: &Room, lines: &[[Point; 2]]| -> f64 {
        let room = room.grown(APART / 2.0);
        let each = lines.iter().map(|line| match room.holds(line[0], line[1]) {
            0.0 => 0.0,
            mm => STRUCK * (1.0 + mm),
        });
        each.sum()
    };
    let pairs = a
        .lines
        .iter()
        .flat_map(|p| b.lines.iter().map(move |q| (p, q)));
    let crossed = pairs
        .filter(|(p, q)| Room::of_line(**p, LINES_APART).overlap(&Room::of_line(**q, 0.0)) > 0.0);
    touching(&a.room, &b.room)
        + struck(&a.room, &b.lines)
        + struck(&b.room, &a.lines)
        + CROSSED * crossed.count() as f64
}

/// What it costs that two texts touch.
pub(super) fn touching(a: &Room, b: &Room) -> f64 {
    let (dx, dy) = (b.middle[0] - a.middle[0], b.middle[1] - a.middle[1]);
    let far = a.half[0] + a.half[1] + b.half[0] + b.half[1] + APART;
    if dx.abs() > far || dy.abs() > far {
        return 0.0;
    }
    match a.grown(APART).overlap(b) {
        0.0 => 0.0,
        mm => OVERLAP * (1.0 + mm),
    }
}
