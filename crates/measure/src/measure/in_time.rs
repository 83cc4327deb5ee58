//! Measures of the motion in time: speeds, accelerations, lengths of path.

use kempe_mechanism::pose::dot;
use kempe_model::{PointId, PoseMeasure};
use kempe_number::Number;

use super::{Moment, Series, undefined};

impl<B: Number> Moment<'_, B> {
    /// Measures of the motion in time.
    pub(super) fn motion_measure(&self, measure: &PoseMeasure) -> Series<B> {
        let velocity = |p: PointId| {
            // Of a moving point at rest the speed has no derivatives; of one that cannot move all are zero.
            if self.state.mechanism().is_fixed(p) {
                return None;
            }
            let at = self.point(&self.state.poses, p);
            Some([
                at[0].compose(&self.state.abscissa.clock).differentiate(),
                at[1].compose(&self.state.abscissa.clock).differentiate(),
            ])
        };
        let size = |v: Option<[Series<B>; 2]>| v.map_or(Series::zero(), size_of);
        match measure {
            PoseMeasure::Speed(p) => size(velocity(*p)),
            PoseMeasure::Acceleration(p) => {
                size(velocity(*p).map(|v| [v[0].differentiate(), v[1].differentiate()]))
            }
            PoseMeasure::AngularSpeed(link) => self
                .angle(&self.state.poses, *link)
                .compose(&self.state.abscissa.clock)
                .differentiate(),
            PoseMeasure::AngularAcceleration(link) => self
                .angle(&self.state.poses, *link)
                .compose(&self.state.abscissa.clock)
                .differentiate()
                .differentiate(),
            PoseMeasure::PathLength(p) => {
                let start = self
                    .history
                    .lengths
                    .iter()
                    .find(|(q, _)| q == p)
                    .map_or(B::from_f64(f64::NAN), |(_, length)| *length);
                size(velocity(*p)).integrate(start)
            }
            _ => undefined(),
        }
    }
}

/// Size of a vector. A root has no derivatives at zero; that of what stays nothing, as in a dwell, stays nothing.
fn size_of<B: Number>(v: [Series<B>; 2]) -> Series<B> {
    let size = dot(v, v).sqrt();
    let [x, y] = v.map(|v| v.coefficient(0).abs());
    if (-(x + y)).nonnegative() != Some(true) {
        return size;
    }
    let mut coefficients = *size.coefficients();
    coefficients[0] = x + y;
    Series::from_coefficients(coefficients)
}
