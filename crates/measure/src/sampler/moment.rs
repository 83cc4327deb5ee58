//! The moment last found, as measures see it, and places by time.

use kempe_model::{DriveId, Measure, PointId};

use super::Sampler;
use crate::force_source::ForceSource;
use crate::measure::{Along, Moment};
use crate::measurer::asks_forces;
use crate::states_along::Place;

impl<F: ForceSource> Sampler<F> {
    /// Hands the moment last found to `ask`, with its forces where they are wanted.
    pub(super) fn with_moment<R>(
        &mut self,
        place: Place<f64>,
        with_forces: bool,
        ask: impl FnOnce(&Moment<'_, f64>) -> R,
    ) -> R {
        let motion = self.motion();
        let lengths: Vec<(PointId, f64)> = (self.lengths.iter())
            .map(|s| (s.point(), s.at_time(motion, self.parameters(), place.time)))
            .collect();
        (self.measurer).with_moment(place.path, lengths, with_forces, ask)
    }

    /// Value and time derivative of a measure at a time; NaN where the motion does not reach.
    pub(crate) fn value_and_rate(&mut self, measure: &Measure, time: f64) -> [f64; 2] {
        let place = self.measurer.states.at_time(time);
        if !self.measurer.find(place) {
            return [f64::NAN; 2];
        }
        let with_forces = asks_forces(self.motion(), measure);
        let series = self.with_moment(place, with_forces, |moment| {
            moment.series(measure, Along::Time)
        });
        [series.derivative(0), series.derivative(1)]
    }

    /// Duration of the motion, s.
    pub fn duration(&self) -> f64 {
        self.clock().duration()
    }

    /// Times at which some drive's law goes from one piece to the next, both ends of the motion included.
    pub fn breaks(&self) -> Vec<f64> {
        self.clock().breaks()
    }

    /// The first time at which a drive's coordinate takes a value, s.
    pub fn time_of(&self, drive: DriveId, value: f64) -> Option<f64> {
        self.clock().time_of(drive, value)
    }

    /// The drive whose coordinate is the path parameter.
    pub fn path_drive(&self) -> Option<DriveId> {
        self.clock().path_drive()
    }
}
