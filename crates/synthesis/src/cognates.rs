//! S. Roberts's theorem (1875): three four-bars trace one coupler curve.
//!
//! As seen from the coupler point with fixed pivots a, b and moving ones x, y: (x, a, y, b) goes to
//! ((x - a) y / (x - y), (b x - a y) / (x - y), a - x, a), whose first fixed pivot is the third focus; twice to the third four-bar, thrice
//! back.

use kempe_linear::C;

use crate::four_bar::FourBar;
use crate::pose::Pose;

/// A four-bar whose coupler carries a point, at one pose: its pivots, and that point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CouplerCurve {
    /// The fixed pivots.
    pub fixed: [C; 2],
    /// Where the moving pivots are.
    pub moving: [C; 2],
    /// Where the coupler point is.
    pub point: C,
}

impl CouplerCurve {
    /// A four-bar at a pose with a point of its coupler.
    pub fn of(bar: &FourBar, pose: &Pose, point: C) -> Self {
        Self {
            fixed: bar.fixed,
            moving: bar.places(pose),
            point: pose.place(point),
        }
    }

    /// The four-bar; its coupler has its origin in the coupler point and is not turned in this pose.
    pub fn four_bar(&self) -> FourBar {
        let moving = self.moving.map(|m| m - self.point);
        FourBar {
            fixed: self.fixed,
            moving,
            lengths: [0, 1].map(|k| (self.moving[k] - self.fixed[k]).norm()),
        }
    }

    /// The next cognate: from the third focus to this one's first pivot. Its first link turns as this one's second, its second as this
    /// one's coupler, its coupler as this one's first link. `None` where the moving pivots are one.
    pub fn next(&self) -> Option<Self> {
        let [a, b] = self.fixed.map(|p| p - self.point);
        let [x, y] = self.moving.map(|p| p - self.point);
        let inverse = (x - y).recip();
        let next = Self {
            fixed: [self.point + (b * x - a * y) * inverse, self.fixed[0]],
            moving: [self.point + (x - a) * y * inverse, self.point + a - x],
            point: self.point,
        };
        let finite = next.fixed.iter().chain(&next.moving).all(|p| p.is_finite());
        finite.then_some(next)
    }

    /// The other two four-bars that trace the same curve.
    pub fn cognates(&self) -> Option<[Self; 2]> {
        let next = self.next()?;
        Some([next, next.next()?])
    }

    /// The third fixed pivot: with the other two a triangle similar to the coupler's.
    pub fn third_focus(&self) -> Option<C> {
        self.next().map(|next| next.fixed[0])
    }

    /// A link that goes along the coupler curve without turning.
    ///
    /// The cognate from the third focus has a link that turns as this one's second; moved so that both have one pivot, these are one link,
    /// and the two coupler points, always as far and in one direction apart as the pivots were, carry a link that does not turn.
    pub fn parallel_motion(&self) -> Option<ParallelMotion> {
        let next = self.next()?;
        let shift = self.fixed[1] - next.fixed[0];
        Some(ParallelMotion {
            shared: [self.fixed[1], self.moving[1], next.moving[0] + shift],
            coupler: [next.moving[0] + shift, next.point + shift],
            carried: [self.point, self.point + shift],
        })
    }
}

/// What is added to a four-bar so that a link goes along its coupler curve without turning: a six-bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParallelMotion {
    /// The second link made ternary: its fixed pivot, its pivot on the coupler, and a third.
    pub shared: [C; 3],
    /// The added link, from the third pivot of that link to the link carried.
    pub coupler: [C; 2],
    /// The link that does not turn: at the coupler point and at the added link.
    pub carried: [C; 2],
}
