//! A block with play: a rectangle of one body between two parallel walls of another.

use kempe_mechanism::pose::{cross, dot, left, sub};
use kempe_number::Number;

use crate::stiffness::room;
use crate::unfit::not_negative;
use crate::{Body, Touch, Unfit};

/// A straight guide in the first body and a block of the second in it, which touches with its corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlockInGuide<T> {
    /// A point on the middle line of the guide in the first body, m.
    pub guide: [T; 2],
    /// The direction of the guide in the first body, a unit vector.
    pub along: [T; 2],
    /// The middle of the block in the second body, m.
    pub block: [T; 2],
    /// The direction of its length in the second body, a unit vector.
    pub block_along: [T; 2],
    /// Half the length of the block, m.
    pub half_length: T,
    /// Half the height of the block, m.
    pub half_height: T,
    /// Half the distance of the walls, m.
    pub half_width: T,
}

impl<T: Number> BlockInGuide<T> {
    /// The guide and the block, if the block fits.
    ///
    /// # Errors
    ///
    /// Where a size is negative, or the block is higher than the guide is wide.
    pub fn checked(self) -> Result<Self, Unfit> {
        not_negative("length of the block", self.half_length.value())?;
        not_negative("height of the block", self.half_height.value())?;
        room(self.half_width, self.half_height)?;
        Ok(self)
    }

    /// The clearance on each side of a block in the middle, m.
    pub fn clearance(&self) -> T {
        self.half_width - self.half_height
    }

    /// Its four corners: the rear and the front one at the left wall, then both at the right wall, seen along the guide with the
    /// block's left side at the guide's left wall.
    pub fn touches(&self, bodies: &[Body<T>; 2]) -> [Touch<T>; 4] {
        let [first, second] = bodies;
        let along = first.pose.turn(self.along);
        let long = second.pose.turn(self.block_along);
        let off = sub(second.pose.place(self.block), first.pose.place(self.guide));
        self.touches_at(
            bodies,
            cross(along, off),
            [dot(along, long), cross(along, long)],
        )
    }

    /// The same where somebody knows better than their poses how far the block's middle stands to the left of the guide's middle line, m, and
    /// the cosine and sine of the angle by which it is turned.
    pub fn touches_at(&self, bodies: &[Body<T>; 2], off: T, turned: [T; 2]) -> [Touch<T>; 4] {
        let [first, second] = bodies;
        let guide_left = left(first.pose.turn(self.along));
        let centre = second.pose.place(self.block);
        let long = second.pose.turn(self.block_along);
        let high = left(long);
        CORNERS.map(|corner| {
            let [ahead, up] = self.place_of(corner);
            let place = [
                centre[0] + long[0] * ahead + high[0] * up,
                centre[1] + long[1] * ahead + high[1] * up,
            ];
            let normal = guide_left.map(|x| x * corner.0);
            let gap = self.gap_at(corner, off, turned);
            let on_wall = [place[0] + normal[0] * gap, place[1] + normal[1] * gap];
            Touch::new(bodies, [on_wall, place], normal, gap)
        })
    }

    /// How far each corner is open, m, in the same order, where the block's middle stands so far to the left of the middle line, m, and it is
    /// turned by the angle of this cosine and sine.
    pub fn gaps(&self, off: T, turned: [T; 2]) -> [T; 4] {
        CORNERS.map(|corner| self.gap_at(corner, off, turned))
    }

    fn gap_at(&self, corner: Corner, off: T, [cosine, sine]: [T; 2]) -> T {
        let [ahead, up] = self.place_of(corner);
        self.half_width - (off + ahead * sine + up * cosine) * corner.0
    }

    /// A corner in the block: ahead of its middle, and to its left, m.
    fn place_of(&self, (side, end): Corner) -> [T; 2] {
        [self.half_length * end, self.half_height * side]
    }
}

impl BlockInGuide<f64> {
    /// The same in other numbers.
    pub fn lift<T: Number>(&self) -> BlockInGuide<T> {
        BlockInGuide {
            guide: self.guide.map(T::from_f64),
            along: self.along.map(T::from_f64),
            block: self.block.map(T::from_f64),
            block_along: self.block_along.map(T::from_f64),
            half_length: T::from_f64(self.half_length),
            half_height: T::from_f64(self.half_height),
            half_width: T::from_f64(self.half_width),
        }
    }
}

/// A corner: the side of its wall (1 is left) and its end (1 is the front).
type Corner = (f64, f64);

const CORNERS: [Corner; 4] = [(1.0, -1.0), (1.0, 1.0), (-1.0, -1.0), (-1.0, 1.0)];
