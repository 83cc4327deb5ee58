//! Upright boxes around what is placed: what lies in none of another's needs no closer look.

use super::room::Room;
use super::wanted::Spot;
use crate::scene::Point;

/// Boxes are larger by this than what lies in them, mm: more than rounding, so that what is left out counts for nothing.
const MARGIN: f64 = 1e-6;

/// From the lower left to the upper right corner, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Extent {
    low: Point,
    high: Point,
}

impl Extent {
    /// Of nothing: it meets nothing.
    pub const NONE: Extent = Extent {
        low: [f64::INFINITY; 2],
        high: [f64::NEG_INFINITY; 2],
    };

    /// Around some points.
    pub fn around(points: impl IntoIterator<Item = Point>) -> Extent {
        let mut extent = Extent::NONE;
        points.into_iter().for_each(|p| extent.add(p));
        extent
    }

    /// Around a box.
    pub fn of_room(room: &Room) -> Extent {
        let reach = room.reach();
        let corner = |sign: f64| [0, 1].map(|k: usize| room.middle[k] + sign * reach[k]);
        Extent::around([corner(-1.0), corner(1.0)])
    }

    /// Around the text of a label and its lines.
    pub fn of_spot(spot: &Spot) -> Extent {
        let mut extent = Extent::of_room(&spot.room);
        spot.lines.iter().flatten().for_each(|p| extent.add(*p));
        extent
    }

    /// Takes in a point.
    pub fn add(&mut self, p: Point) {
        for (k, v) in p.into_iter().enumerate() {
            self.low[k] = self.low[k].min(v - MARGIN);
            self.high[k] = self.high[k].max(v + MARGIN);
        }
    }

    /// The same, larger by `by` mm on every side.
    pub fn grown(self, by: f64) -> Extent {
        Extent {
            low: self.low.map(|v| v - by),
            high: self.high.map(|v| v + by),
        }
    }

    /// Whether it may have a place in common with a box, which may lie askew.
    pub fn meets_room(&self, room: &Room) -> bool {
        let [c, s] = room.along;
        let sides = [([c, s], room.half[0]), ([-s, c], room.half[1])];
        sides.into_iter().all(|([x, y], half)| {
            let middle = [0, 1].map(|k: usize| (self.low[k] + self.high[k]) / 2.0 - room.middle[k]);
            let [wide, high] = [0, 1].map(|k: usize| (self.high[k] - self.low[k]) / 2.0);
            let off = (x * middle[0] + y * middle[1]).abs();
            off <= half + wide * x.abs() + high * y.abs()
        })
    }

    /// Whether two have a place in common.
    pub fn meets(&self, other: &Extent) -> bool {
        (0..2).all(|k| self.low[k] <= other.high[k] && other.low[k] <= self.high[k])
    }
}
