//! Pins in slots along smooth curves.

use kempe_number::math::{sin_cos, within_half_a_turn};

use super::curved_slot::{WALL, channel};
use super::ground;
use super::part::Part;
use crate::context::Context;
use crate::fit::drawable;
use crate::scene::{Path, Point, Vertex};
use crate::view::CurveGuide;

/// Places along a slot's middle in the axes of its link, mm, each with the direction of the slot there.
type Middle = Vec<(Point, f64)>;

pub(super) fn parts(context: &Context, curve: &CurveGuide) -> Vec<Part> {
    let Some(&origin) = curve.through.first() else {
        return Vec::new();
    };
    let scale = context.fit.scale;
    let middle: Middle = (curve.along.iter())
        .map(|(at, angle)| (at.map(|x| x * scale), *angle))
        .collect();
    let is_drawn = |(at, angle): &(Point, f64)| drawable(*at) && angle.is_finite();
    if middle.len() < 2 || !middle.iter().all(is_drawn) {
        return Vec::new();
    }
    let walls = || {
        let walls = [WALL, -WALL].map(|off| {
            let wall = path(offset(&middle, off), curve.closed);
            ground::hatched_path(wall, off)
        });
        walls.concat()
    };
    channel(curve.link, origin, walls, |off| {
        outline(&middle, off, curve.closed)
    })
}

/// The outline at a distance around a slot, the outer of two paths first.
fn outline(middle: &Middle, off: f64, closed: bool) -> Vec<Path> {
    let (right, mut left) = (offset(middle, -off), offset(middle, off));
    if closed {
        let paths = [path(right, true), path(left, true)];
        let [right, left] = paths;
        return if area(middle) > 0.0 {
            vec![right, left]
        } else {
            vec![left, right]
        };
    }
    // Up the right side, round the end, back on the left and round the start.
    let mut there = path(right, false).vertices;
    left.reverse();
    let mut back = path(left, false).vertices;
    for side in [&mut there, &mut back] {
        side.iter_mut()
            .next_back()
            .into_iter()
            .for_each(|v| v.bulge = 1.0);
    }
    vec![Path {
        vertices: [there, back].concat(),
        closed: true,
    }]
}

/// The middle moved to its left.
fn offset(middle: &Middle, off: f64) -> Middle {
    let moved = middle.iter().map(|&([x, y], angle)| {
        let (s, c) = sin_cos(angle);
        ([x - off * s, y + off * c], angle)
    });
    moved.collect()
}

/// Circular arcs through places that turn as the direction of the curve does from one to the next.
fn path(places: Middle, closed: bool) -> Path {
    let next = |k: usize| places.get(k + 1).or(places.first().filter(|_| closed));
    let vertices = places.iter().enumerate().map(|(k, &(at, angle))| {
        let turn = next(k).map_or(0.0, |(_, after)| after - angle);
        let (s, c) = sin_cos(within_half_a_turn(turn) / 4.0);
        Vertex { at, bulge: s / c }
    });
    Path {
        vertices: vertices.collect(),
        closed,
    }
}

/// Twice the area around which the places go counter-clockwise, mm^2.
fn area(places: &Middle) -> f64 {
    let next = places.iter().skip(1).chain(places.first());
    let parts = places.iter().zip(next);
    parts
        .map(|((a, _), (b, _))| a[0] * b[1] - a[1] * b[0])
        .sum()
}
