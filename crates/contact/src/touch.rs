//! What two bodies do where they touch or nearly do, and what forces there do to them.

use kempe_mechanism::pose::{Pose, cross, dot, left, sub};
use kempe_number::Number;

use crate::{Friction, Normal};

/// Force components along the frame's axes, N, and the moment about the origin of the body, N m.
pub type Wrench<T> = [T; 3];

/// A body that moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body<T> {
    /// Where it is.
    pub pose: Pose<T>,
    /// Velocity of its origin (m/s) and angular speed (rad/s).
    pub motion: [T; 3],
}

impl<T: Number> Body<T> {
    /// One that rests.
    pub fn at_rest(pose: Pose<T>) -> Self {
        Self {
            pose,
            motion: [T::zero(); 3],
        }
    }

    /// The velocity (m/s) of the place of the frame that moves with it.
    pub fn velocity_at(&self, place: [T; 2]) -> [T; 2] {
        let [x, y, turning] = self.motion;
        let arm = left(sub(place, [self.pose.x, self.pose.y]));
        [x + turning * arm[0], y + turning * arm[1]]
    }

    /// What a force (N) at a place of the frame does to it.
    pub fn wrench(&self, force: [T; 2], place: [T; 2]) -> Wrench<T> {
        let arm = sub(place, [self.pose.x, self.pose.y]);
        [force[0], force[1], cross(arm, force)]
    }
}

/// Two bodies at a place where the second can press on the first: a journal on its bearing, a block's corner on a wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch<T> {
    /// How far they are apart, m; negative where they indent each other.
    pub gap: T,
    /// The direction in which the second presses on the first.
    pub normal: [T; 2],
    /// How fast they near each other, m/s: the rate of the indentation.
    pub approach: T,
    /// How fast the second slides over the first, m/s, along the normal turned a quarter to the left.
    pub slip: T,
    /// The points of the first and of the second that touch, in the frame, m. They are apart by the gap.
    pub points: [[T; 2]; 2],
}

impl<T: Number> Touch<T> {
    /// Between two bodies, at points that lie apart along the normal.
    pub(crate) fn new(bodies: &[Body<T>; 2], points: [[T; 2]; 2], normal: [T; 2], gap: T) -> Self {
        let [first, second] = bodies;
        let relative = sub(second.velocity_at(points[1]), first.velocity_at(points[0]));
        Self {
            gap,
            normal,
            approach: dot(relative, normal),
            slip: dot(relative, left(normal)),
            points,
        }
    }

    /// The normal force (N) that laws give here, and the friction on the second body along the slip (N). `began_with` is the
    /// speed with which this contact began, m/s.
    pub fn forces(&self, normal: &Normal<T>, friction: &Friction<T>, began_with: T) -> [T; 2] {
        let pressing = normal.force(-self.gap, self.approach, began_with);
        [pressing, friction.force(self.slip, pressing)]
    }

    /// What these forces do to both bodies. Forces are opposite; each acts at its body's own point, as in the literature, so that
    /// their power is that of the approach and of the slip.
    pub fn wrenches(&self, bodies: &[Body<T>; 2], [pressing, friction]: [T; 2]) -> [Wrench<T>; 2] {
        let ([n, along], [first, second]) = ([self.normal, left(self.normal)], self.points);
        let on_second = [
            along[0] * friction - n[0] * pressing,
            along[1] * friction - n[1] * pressing,
        ];
        [
            bodies[0].wrench(on_second.map(|x| -x), first),
            bodies[1].wrench(on_second, second),
        ]
    }
}
