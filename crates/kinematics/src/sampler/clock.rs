//! Between time and the path parameter.

use kempe_model::DriveId;

use super::Sampler;
use crate::drive_path::DrivePath;
use crate::force_source::ForceSource;

impl<F: ForceSource> Sampler<'_, F> {
    /// Duration of the motion, s.
    pub fn duration(&self) -> f64 {
        let laws = self.motion.mechanism.model.drives.iter();
        laws.map(|d| d.law.duration(&self.parameters))
            .fold(0.0, f64::max)
    }

    /// Times at which some drive's law goes from one piece to the next, both ends of the motion included.
    pub fn breaks(&self) -> Vec<f64> {
        let mut breaks: Vec<f64> = (self.motion.mechanism.model.drives.iter())
            .flat_map(|d| d.law.breaks(&self.parameters))
            .collect();
        breaks.push(self.duration());
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        breaks
    }

    /// The first time at which a drive's coordinate takes a value, s.
    pub fn time_of(&self, drive: DriveId, value: f64) -> Option<f64> {
        self.motion
            .mechanism
            .model
            .drives
            .get(drive.index())?
            .law
            .first_time(value, &self.parameters)
    }

    /// The drive whose coordinate is the path parameter.
    pub fn path_drive(&self) -> Option<DriveId> {
        match self.motion.path {
            DrivePath::Coordinate { drive, .. } => Some(DriveId(drive as u32)),
            DrivePath::Time { .. } => None,
        }
    }

    /// The first time at which the motion passes a path parameter, s; NaN when it never does.
    pub(crate) fn time_at(&self, p: f64) -> f64 {
        match self.path_drive() {
            // The last coordinate of a law may be missed by a rounding error.
            Some(drive) => self.time_of(drive, p).unwrap_or_else(|| {
                let duration = self.duration();
                let law = &self.motion.mechanism.model.drives[drive.index()].law;
                let gap = (law.at(duration, &self.parameters) - p).abs();
                if gap <= 1e-12 * p.abs().max(1e-3) {
                    duration
                } else {
                    f64::NAN
                }
            }),
            None => p,
        }
    }

    /// The path parameter at a time, s.
    pub(crate) fn parameter_at(&self, t: f64) -> f64 {
        let model = &self.motion.mechanism.model;
        self.motion.path.parameter_at(model, t, &self.parameters)
    }
}
