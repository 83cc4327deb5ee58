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
    pub fn touches_at(
        &self,
        bodies: &[Body<T>; 2],
        off: T,
        [cosine, sine]: [T; 2],
    ) -> [Touch<T>; 4] {
        let [first, second] = bodies;
        let guide_left = left(first.pose.turn(self.along));
        let centre = second.pose.place(self.block);
        let long = second.pose.turn(self.block_along);
        let high = left(long);
        PLACES.map(|(side, end)| {
            let (up, ahead) = (self.half_height * side, self.half_length * end);
            let corner = [
                centre[0] + long[0] * ahead + high[0] * up,
                centre[1] + long[1] * ahead + high[1] * up,
            ];
            let normal = guide_left.map(|x| x * side);
            let gap = self.gap_of(side, ahead * sine + up * cosine, off);
            let on_wall = [corner[0] + normal[0] * gap, corner[1] + normal[1] * gap];
            Touch::new(bodies, [on_wall, corner], normal, gap)
        })
    }

    fn gap_of(&self, side: f64, corner_off_middle: T, off: T) -> T {
        self.half_width - (off + corner_off_middle) * side
    }

    /// How far a corner is open, m, and how fast it opens, m/s, where the block's middle is so far off the middle line, m, and the block so
    /// far turned, rad, and how fast both change.
    pub fn gap(&self, place: usize, [off, angle]: [T; 2], [drifting, turning]: [T; 2]) -> [T; 2] {
        let (side, end) = PLACES[place % PLACES.len()];
        let (up, ahead) = (self.half_height * side, self.half_length * end);
        let (sine, cosine) = angle.sin_cos();
        let gap = self.gap_of(side, ahead * sine + up * cosine, off);
        [
            gap,
            -((drifting + (ahead * cosine - up * sine) * turning) * side),
        ]
    }
}

/// The corners: the side of the wall (1 is left) and the end (1 is the front).
pub const PLACES: [(f64, f64); 4] = [(1.0, -1.0), (1.0, 1.0), (-1.0, -1.0), (-1.0, 1.0)];
