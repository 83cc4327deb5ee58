//! The room that a line of text takes on paper: a box, turned with its text.

use crate::scene::{Align, Placement, Point, Text, distance};
use crate::text::{height, width};
use kempe_number::math::sin_cos;

/// A box on paper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Room {
    /// Its middle.
    pub middle: Point,
    /// Half its width and height, mm.
    pub half: Point,
    /// The direction of its width, of length 1.
    pub along: Point,
}

impl Room {
    /// A box with upright text.
    pub fn upright(middle: Point, half: Point) -> Room {
        Room {
            middle,
            half,
            along: [1.0, 0.0],
        }
    }

    /// The room of a line of text in a group that lies somewhere; `None` for text that says nothing.
    pub fn of_text(text: &Text, place: &Placement) -> Option<Room> {
        let wide = width(&text.content, text.size);
        let [below, above] = height(&text.content, text.size);
        if !(wide > 0.0) {
            return None;
        }
        let (s, c) = sin_cos(text.turn.to_radians() + place.angle);
        let x = match text.align {
            Align::Start => wide / 2.0,
            Align::Middle => 0.0,
            Align::End => -wide / 2.0,
        };
        let (y, at) = ((above - below) / 2.0, place.apply(text.at));
        Some(Room {
            middle: [at[0] + c * x - s * y, at[1] + s * x + c * y],
            half: [wide / 2.0, (above + below) / 2.0],
            along: [c, s],
        })
    }

    /// A line as wide as `wide` mm.
    pub fn of_line([a, b]: [Point; 2], wide: f64) -> Room {
        let long = distance(a, b);
        let along = match long > 0.0 {
            true => [(b[0] - a[0]) / long, (b[1] - a[1]) / long],
            false => [1.0, 0.0],
        };
        Room {
            middle: [(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0],
            half: [long / 2.0, wide / 2.0],
            along,
        }
    }

    /// The same, larger by `by` mm on every side.
    pub fn grown(self, by: f64) -> Room {
        let half = self.half.map(|h| h + by);
        Room { half, ..self }
    }

    fn local(&self, p: Point) -> Point {
        let (x, y) = (p[0] - self.middle[0], p[1] - self.middle[1]);
        let [c, s] = self.along;
        [c * x + s * y, c * y - s * x]
    }

    /// Half of what the box takes up along x and along y.
    pub fn reach(&self) -> Point {
        let [c, s] = self.along.map(f64::abs);
        let [w, h] = self.half;
        [c * w + s * h, s * w + c * h]
    }

    /// The place in the box next to a point.
    pub fn nearest(&self, p: Point) -> Point {
        let at = self.local(p);
        let [x, y] = [0, 1].map(|k: usize| at[k].clamp(-self.half[k], self.half[k]));
        let [c, s] = self.along;
        [
            self.middle[0] + c * x - s * y,
            self.middle[1] + s * x + c * y,
        ]
    }

    /// How far one box would have to go to be clear of the other, mm; 0 where they are apart.
    pub fn overlap(&self, other: &Room) -> f64 {
        let to = [
            other.middle[0] - self.middle[0],
            other.middle[1] - self.middle[1],
        ];
        let across = |a: Point| [-a[1], a[0]];
        let dot = |a: Point, b: Point| a[0] * b[0] + a[1] * b[1];
        let extent = |room: &Room, axis: Point| {
            room.half[0] * dot(room.along, axis).abs()
                + room.half[1] * dot(across(room.along), axis).abs()
        };
        let axes = [
            self.along,
            across(self.along),
            other.along,
            across(other.along),
        ];
        let shared = |axis: Point| extent(self, axis) + extent(other, axis) - dot(to, axis).abs();
        axes.into_iter()
            .map(shared)
            .fold(f64::INFINITY, f64::min)
            .max(0.0)
    }

    /// How much of a straight line lies in the box, mm.
    pub fn holds(&self, from: Point, to: Point) -> f64 {
        let (a, b) = (self.local(from), self.local(to));
        let (mut first, mut last) = (0.0_f64, 1.0_f64);
        for k in 0..2 {
            let (way, half) = (b[k] - a[k], self.half[k]);
            // most lines lie beside most boxes
            if a[k].min(b[k]) > half || a[k].max(b[k]) < -half {
                return 0.0;
            }
            if way == 0.0 {
                if a[k].abs() > half {
                    return 0.0;
                }
                continue;
            }
            let (p, q) = ((-half - a[k]) / way, (half - a[k]) / way);
            first = first.max(p.min(q));
            last = last.min(p.max(q));
        }
        (last - first).max(0.0) * distance(from, to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turned_boxes_touch_only_where_they_do() {
        let flat = Room::upright([0.0, 0.0], [4.0, 1.0]);
        let turned = |x: f64, y: f64| Room {
            middle: [x, y],
            half: [4.0, 1.0],
            along: [0.6, 0.8],
        };
        // upright boxes around both would overlap
        assert_eq!(flat.overlap(&turned(5.9, 4.6)), 0.0);
        assert!(flat.overlap(&turned(5.5, 4.6)) > 0.0);
        let shared = flat.overlap(&Room::upright([0.0, 1.5], [1.0, 1.0]));
        assert!((shared - 0.5).abs() < 1e-12);
    }

    #[test]
    fn the_part_of_a_line_in_a_box_is_found() {
        let room = Room {
            middle: [1.0, 1.0],
            half: [2.0, 1.0],
            along: [0.0, 1.0],
        };
        assert!((room.holds([-5.0, 0.0], [5.0, 0.0]) - 2.0).abs() < 1e-12);
        assert!((room.holds([1.0, -9.0], [1.0, 9.0]) - 4.0).abs() < 1e-12);
        assert_eq!(room.holds([3.0, -9.0], [3.0, 9.0]), 0.0);
        assert!((room.holds([1.0, 1.0], [1.0, 1.5]) - 0.5).abs() < 1e-12);
    }

    #[test]
    fn upright_text_stands_where_it_is_drawn() {
        let text = Text::new([10.0, 5.0], 2.0, "Hk").aligned(Align::End);
        let room = Room::of_text(&text, &Placement::PAPER).unwrap();
        let right = room.middle[0] + room.half[0];
        assert!((right - 10.0).abs() < 1e-12);
        assert!(room.middle[1] - room.half[1] <= 5.0 && room.middle[1] > 5.0);
    }
}
