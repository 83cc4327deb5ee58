//! The moment last found, as measures see it, and places by time.

use kempe_model::{DriveId, Leaf, Measure, PointId, PoseMeasure};
use kempe_number::Number;

use super::Sampler;
use crate::force_source::ForceSource;
use crate::measure::{Along, History, Moment, visit_leaves};
use crate::state::Series;
use crate::states_along::PathPlace;

impl<F: ForceSource> Sampler<F> {
    /// Hands the moment last found to `ask`: with its forces where they are wanted, and with the lengths of the paths of some
    /// points.
    pub(super) fn with_moment<R>(
        &mut self,
        place: PathPlace<f64>,
        with_forces: bool,
        lengths: &[PointId],
        ask: impl FnOnce(&Moment<'_, f64>) -> R,
    ) -> R {
        let history = History {
            lengths: self.lengths_at(lengths, place.time),
            forces: match with_forces {
                true => self.directions_of_forces(place.time),
                false => Vec::new(),
            },
            ..History::default()
        };
        (self.measurer).with_moment(place.path, history, with_forces, ask)
    }

    /// Lengths of the paths of some points at a time.
    pub(super) fn lengths_at(&mut self, points: &[PointId], time: f64) -> Vec<(PointId, f64)> {
        let motion = self.motion().clone();
        let lengths = self.lengths.iter_mut();
        lengths
            .filter(|s| points.contains(&s.point()))
            .map(|s| (s.point(), s.at_time(&motion, time)))
            .collect()
    }

    /// What measures ask of a moment.
    pub(crate) fn asked(&self, measures: &[&Measure]) -> Asked {
        let mut asked = Asked {
            measures: measures.iter().map(|m| (*m).clone()).collect(),
            forces: false,
            lengths: Vec::new(),
        };
        let mechanism = self.motion().mechanism();
        let look = |asked: &mut Asked, measure: &Measure| {
            visit_leaves(mechanism, measure, &mut |leaf| match leaf {
                Leaf::Force(_) => asked.forces = true,
                Leaf::Pose(PoseMeasure::PathLength(point)) if !asked.lengths.contains(point) => {
                    asked.lengths.push(*point);
                }
                _ => {}
            });
        };
        for measure in measures {
            look(&mut asked, measure);
        }
        if asked.forces {
            let inputs = self.measurer.forces.measures();
            inputs.iter().for_each(|m| look(&mut asked, m));
        }
        asked
    }

    /// What is asked for as series in time, at a time; NaN where the motion does not reach.
    pub(crate) fn series_at(&mut self, asked: &Asked, time: f64) -> Vec<Series<f64>> {
        let place = self.measurer.states.at_time(time);
        if !self.measurer.find(place) {
            return vec![Series::from_f64(f64::NAN); asked.measures.len()];
        }
        self.with_moment(place, asked.forces, &asked.lengths, |moment| {
            let measures = asked.measures.iter();
            measures.map(|m| moment.series(m, Along::Time)).collect()
        })
    }

    /// The same where what rubs dry is taken to slide in these senses.
    pub(crate) fn series_sliding(
        &mut self,
        asked: &Asked,
        time: f64,
        senses: &[Option<f64>],
    ) -> Vec<Series<f64>> {
        self.measurer.forces.slide_as(senses);
        let found = self.series_at(asked, time);
        self.measurer.forces.slide_as(&[]);
        found
    }

    /// How fast what rubs dry slides at a time; nothing where the motion does not reach or no forces are asked for.
    pub(crate) fn sliding_at(&mut self, asked: &Asked, time: f64) -> Vec<f64> {
        let place = self.measurer.states.at_time(time);
        if !asked.forces || !self.measurer.find(place) {
            return Vec::new();
        }
        self.with_moment(place, true, &asked.lengths, |_| ());
        let speeds = self.measurer.forces.sliding().into_iter();
        speeds.map(|speed| speed.coefficient(0)).collect()
    }

    /// When one of these turns back between two times at which it slides to different sides: as near as times can be told apart.
    pub(crate) fn turns_back(
        &mut self,
        asked: &Asked,
        which: usize,
        [mut a, mut b]: [(f64, f64); 2],
    ) -> f64 {
        loop {
            let part = a.1 / (a.1 - b.1);
            // Regula falsi tells where, halves that it comes nearer from both sides.
            for part in [part, 0.5] {
                let time = a.0 + (b.0 - a.0) * part;
                if !(a.0 < time && time < b.0) {
                    return if part < 0.5 { a.0 } else { b.0 };
                }
                let speed = self.sliding_at(asked, time).get(which).copied();
                match speed {
                    Some(speed) if speed * a.1 > 0.0 => a = (time, speed),
                    Some(speed) if speed * b.1 > 0.0 => b = (time, speed),
                    _ => return time,
                }
            }
        }
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

    /// The times, s, at which a drive's coordinate comes to a value again after it was there at `first`.
    pub fn times_after(&self, first: f64, drive: DriveId, value: f64) -> Vec<f64> {
        self.clock().times_after(first, drive, value).collect()
    }

    /// A time, s, where the motion lasts so long.
    pub fn within(&self, time: f64) -> Option<f64> {
        self.clock().within(time)
    }

    /// The drive whose coordinate is the path parameter.
    pub fn path_drive(&self) -> Option<DriveId> {
        self.clock().path_drive()
    }
}

/// Measures with what they ask of a moment beside its poses.
pub(crate) struct Asked {
    pub measures: Vec<Measure>,
    /// Whether any of them asks for forces.
    pub forces: bool,
    /// Points whose length of path is asked for.
    pub lengths: Vec<PointId>,
}
