//! Between time and the path parameter.

use std::sync::Arc;

use kempe_model::{DriveId, SAME_END};
use kempe_motion::Motion;
use kempe_motion::drive_path::{DrivePath, duration, law_knots};
use kempe_units::Dimension;

/// A rate at which less than this part of the motion is covered in its duration counts as rest.
const AT_REST: f64 = 1e-9;
/// A drive that is so near to a place at an end of the motion, in rad or sizes of the mechanism, is there.
const BESIDE: f64 = 1e-12;

/// Where a motion is at a time, and when it passes a place.
#[derive(Clone, Debug)]
pub(crate) struct Clock {
    motion: Arc<Motion>,
    /// Duration of the motion, s: every state found asks for it.
    duration: f64,
}

impl Clock {
    /// The clock of a motion.
    pub fn new(motion: Arc<Motion>) -> Self {
        let duration = duration(&motion.mechanism().model, &motion.design.parameters);
        Self { motion, duration }
    }

    /// The motion.
    pub fn motion(&self) -> &Arc<Motion> {
        &self.motion
    }

    fn parameters(&self) -> &[f64] {
        &self.motion.design.parameters
    }

    /// Duration of the motion, s.
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// Times at which some drive's law goes from one piece to the next, both ends of the motion included.
    pub fn breaks(&self) -> Vec<f64> {
        let knots = law_knots(&self.motion.mechanism().model, self.parameters(), true);
        knots.into_iter().map(|[_, last]| last).collect()
    }

    /// Which way the motion runs along its path at a time, by the rate of the path parameter there: 1 or -1. Where it is at
    /// rest, the way it goes on; the way it came where it does not go on.
    pub fn heading(&self, time: f64, rate: f64) -> f64 {
        if !rate.is_finite() {
            return 1.0;
        }
        let (low, high) = self.motion.demanded;
        let least = AT_REST * (high - low);
        if rate.abs() * self.duration() > least {
            return rate.signum();
        }
        let here = self.parameter_at(time);
        let away = |t: f64| Some(self.parameter_at(t) - here).filter(|d| d.abs() > least);
        let knots = law_knots(&self.motion.mechanism().model, self.parameters(), false);
        let (after, before): (Vec<f64>, Vec<f64>) =
            knots.iter().map(|[t, _]| *t).partition(|t| *t > time);
        let onward = after.iter().find_map(|t| away(*t));
        let back = || before.iter().rev().find_map(|t| away(*t));
        onward
            .or_else(|| back().map(|d| -d))
            .map_or(1.0, f64::signum)
    }

    /// The first time at which a drive's coordinate takes a value, s; an end of the motion where rounding keeps it from that there.
    pub fn time_of(&self, drive: DriveId, value: f64) -> Option<f64> {
        let drive = self.motion.mechanism().model.drives.get(drive.index())?;
        let (law, parameters) = (&drive.law, self.parameters());
        law.first_time(value, parameters).or_else(|| {
            let size = match drive.dimension {
                Dimension::ANGLE => 1.0,
                _ => self.motion.size(),
            }
            .max(value.abs());
            let beside = |time: &f64| (law.at(*time, parameters) - value).abs() <= BESIDE * size;
            [0.0, self.duration()].into_iter().find(beside)
        })
    }

    /// The times, s, at which a drive's coordinate comes to a value again after it was there at `first`.
    pub fn times_after(&self, first: f64, drive: DriveId, value: f64) -> impl Iterator<Item = f64> {
        let duration = self.duration();
        let drive = self.motion.mechanism().model.drives.get(drive.index());
        let times = drive.map(|drive| drive.law.times(value, self.parameters()));
        let behind = move |time: &f64| *time > first + SAME_END * duration;
        times.into_iter().flatten().filter(behind)
    }

    /// A time, s, where the motion lasts so long.
    pub fn within(&self, time: f64) -> Option<f64> {
        let duration = self.duration();
        let off = (time - time.clamp(0.0, duration)).abs();
        (off <= SAME_END * duration).then(|| time.clamp(0.0, duration))
    }

    /// The drive whose coordinate is the path parameter.
    pub fn path_drive(&self) -> Option<DriveId> {
        match self.motion.path {
            DrivePath::Coordinate { drive, .. } => Some(DriveId(drive as u32)),
            DrivePath::Time { .. } => None,
        }
    }

    /// The first time at which the motion passes a path parameter, s; NaN when it never does.
    pub fn time_at(&self, p: f64) -> f64 {
        match self.path_drive() {
            Some(drive) => self.time_of(drive, p).map_or(f64::NAN, |time| {
                let duration = self.duration();
                let at_end = (time - duration).abs() <= SAME_END * duration;
                if at_end { duration } else { time }
            }),
            None => p,
        }
    }

    /// The path parameter at a time, s.
    pub fn parameter_at(&self, t: f64) -> f64 {
        let model = &self.motion.mechanism().model;
        self.motion.path.parameter_at(model, t, self.parameters())
    }
}
