//! A pin with play: a journal of one body in the bearing of another.

use kempe_mechanism::pose::{dot, sub};
use kempe_number::Number;

use crate::stiffness::room;
use crate::unfit::not_negative;
use crate::{Body, Touch, Unfit};

/// A round hole in the first body and a round pin of the second in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PinWithPlay<T> {
    /// Centre of the bearing in the first body, m.
    pub bearing: [T; 2],
    /// Centre of the journal in the second body, m.
    pub journal: [T; 2],
    /// Radii of bearing and journal, m.
    pub radii: [T; 2],
}

impl<T: Number> PinWithPlay<T> {
    /// From centres in their bodies and radii, m.
    ///
    /// # Errors
    ///
    /// Where a radius is negative or the journal does not fit into the bearing.
    pub fn new(bearing: [T; 2], journal: [T; 2], radii: [T; 2]) -> Result<Self, Unfit> {
        not_negative("radius of the bearing", radii[0].value())?;
        not_negative("radius of the journal", radii[1].value())?;
        room(radii[0], radii[1])?;
        Ok(Self {
            bearing,
            journal,
            radii,
        })
    }

    /// The clearance, m: the difference of the radii.
    pub fn clearance(&self) -> T {
        self.radii[0] - self.radii[1]
    }

    /// Where they touch, or would touch next. Where the centres are one the direction is that of the x axis: all are as near.
    pub fn touch(&self, bodies: &[Body<T>; 2]) -> Touch<T> {
        let bearing = bodies[0].pose.place(self.bearing);
        let journal = bodies[1].pose.place(self.journal);
        self.touch_at(bodies, sub(journal, bearing))
    }

    /// The same where somebody knows better than their poses how far the journal stands off the bearing, m along the frame's
    /// axes: an indentation is a small difference of large numbers otherwise.
    pub fn touch_at(&self, bodies: &[Body<T>; 2], apart: [T; 2]) -> Touch<T> {
        let distance = length(apart);
        let along = |k: usize, at_none: f64| {
            (-distance).choose_with(|| T::from_f64(at_none), || apart[k] / distance)
        };
        let normal = [along(0, 1.0), along(1, 0.0)];
        let point = |body: &Body<T>, centre: [T; 2], radius: T| {
            let [x, y] = body.pose.place(centre);
            [x + normal[0] * radius, y + normal[1] * radius]
        };
        let points = [
            point(&bodies[0], self.bearing, self.radii[0]),
            point(&bodies[1], self.journal, self.radii[1]),
        ];
        Touch::new(bodies, points, normal, self.gap(apart))
    }

    /// How far it is open, m, where the journal stands so far off the bearing.
    pub fn gap(&self, apart: [T; 2]) -> T {
        self.clearance() - length(apart)
    }
}

/// The length of a vector; of none it is zero, and so are its derivatives.
fn length<T: Number>(vector: [T; 2]) -> T {
    let square = dot(vector, vector);
    (-square).choose_with(T::zero, || square.sqrt())
}

impl PinWithPlay<f64> {
    /// The same in other numbers.
    pub fn lift<T: Number>(&self) -> PinWithPlay<T> {
        PinWithPlay {
            bearing: self.bearing.map(T::from_f64),
            journal: self.journal.map(T::from_f64),
            radii: self.radii.map(T::from_f64),
        }
    }
}
