//! How the points of a mechanism move in a state.

use kempe_model::PointId;

use crate::state::State;

/// Velocity and acceleration of a point in the frame.
///
/// In a state that has time they are in m/s and m/s². Where time does not run, as along a circuit, they are the first and the
/// second derivative to the coordinate of the drive that the rows go by: m/rad and m/rad², or 1 and 1/m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointRates {
    /// First derivative of the place.
    pub velocity: [f64; 2],
    /// Second derivative of the place.
    pub acceleration: [f64; 2],
}

impl PointRates {
    /// Of a point of which it is not known how it moves.
    pub(super) const NONE: Self = Self {
        velocity: [f64::NAN; 2],
        acceleration: [f64::NAN; 2],
    };
}

/// Reads the rates of all points from the series of a state.
pub(super) fn fill(state: &State<f64>, rates: &mut [PointRates]) {
    let timed = !state.time.is_nan();
    for (index, rates) in rates.iter_mut().enumerate() {
        let Some(marker) = state.mechanism().any_marker(PointId(index as u32)) else {
            continue;
        };
        let pose = match timed {
            true => state.pose(marker.body),
            false => state.poses[marker.body.index()],
        };
        let place = pose.place(state.design.geometry.marker(marker));
        rates.velocity = place.map(|x| x.coefficient(1));
        rates.acceleration = place.map(|x| 2.0 * x.coefficient(2));
    }
}
