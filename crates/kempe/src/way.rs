//! Which way the mechanism moves, and the motion that covers it.

use std::sync::Arc;

use kempe_mechanism::Design;
use kempe_model::{Diagnostic, Law};
use kempe_motion::drive_path::{DrivePath, duration};
use kempe_motion::trace::Path as _;
use kempe_motion::{Demand, Motion};
use kempe_study::{Progress, RowPlace, cannot_move};
use kempe_units::Dimension;

use crate::{Compiled, Error};

/// What moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Way {
    /// Every drive by its law.
    Time,
    /// One drive, the others held.
    Drive(usize),
}

/// A place this near (in path scales) beyond a range still lies in it.
const SAME_PLACE: f64 = 1e-9;

/// A time this near beyond the end, in parts of the duration, is still the end.
const SAME_TIME: f64 = 1e-9;

impl Way {
    /// The way that a name means: a drive, or `time`.
    pub fn named(compiled: &Compiled, name: &str) -> Result<Self, Error> {
        match compiled.drive(name) {
            Ok(drive) => Ok(Self::Drive(drive.index())),
            Err(_) if name == "time" => Ok(Self::Time),
            Err(error) => Err(error),
        }
    }

    /// Rows at places along it.
    pub fn rows(self, places: &[f64]) -> Vec<RowPlace> {
        let places = places.iter().copied();
        match self {
            Self::Drive(_) => places.map(RowPlace::Drive).collect(),
            Self::Time => places.map(RowPlace::Time).collect(),
        }
    }

    /// Name and dimension of the places along it.
    pub fn places(self, compiled: &Compiled) -> (&str, Dimension) {
        let drives = &compiled.data().drives;
        match self {
            Self::Drive(drive) => (&drives[drive].name, drives[drive].dimension),
            Self::Time => ("time", Dimension::TIME),
        }
    }
}

/// Least and largest of some places.
///
/// # Errors
///
/// `not-finite`.
pub(crate) fn extent(compiled: &Compiled, places: &[f64]) -> Result<(f64, f64), Error> {
    let mut range = (f64::INFINITY, f64::NEG_INFINITY);
    for (index, place) in places.iter().enumerate() {
        if !place.is_finite() {
            let diagnostic = Diagnostic::error("not-finite", format!("place {index} is {place}"));
            return Err(compiled.error(diagnostic.help("give finite places, in SI")));
        }
        range = (range.0.min(*place), range.1.max(*place));
    }
    Ok(range)
}

/// Whether a time lies on the motion of a design.
pub(crate) fn on_the_motion(design: &Design<f64>, time: f64) -> Result<(), Diagnostic> {
    let duration = duration(&design.mechanism.model, &design.parameters);
    if (0.0..=duration * (1.0 + SAME_TIME)).contains(&time) {
        return Ok(());
    }
    let message = format!("the motion does not pass {time} s: it goes from 0 s to {duration} s");
    let diagnostic = Diagnostic::error("not-on-the-motion", message);
    Err(diagnostic.help(format!("give a time from 0 s to {duration} s")))
}

/// Whether a motion comes to all places of a range along its way.
pub(crate) fn reaches(motion: &Motion, (low, high): (f64, f64)) -> bool {
    let parameter = |place: f64| match motion.path {
        DrivePath::Coordinate { .. } => Ok(place),
        DrivePath::Time { .. } => on_the_motion(&motion.design, place).map(|()| {
            let model = &motion.design.mechanism.model;
            let parameters = &motion.design.parameters;
            motion.path.parameter_at(model, place, parameters)
        }),
    };
    let slack = SAME_PLACE * motion.path.scale();
    let (from, to) = motion.reached();
    let mut ends = [low, high].into_iter().map(parameter);
    ends.all(|at| at.is_ok_and(|at| from - slack <= at && at <= to + slack))
}

/// Whether a motion is one of the drive and was asked to cover the range.
pub(crate) fn covers(motion: &Motion, drive: usize, (low, high): (f64, f64)) -> bool {
    let own = matches!(motion.path, DrivePath::Coordinate { drive: own, .. } if own == drive);
    let slack = SAME_PLACE * motion.path.scale();
    own && motion.demanded.0 - slack <= low && high <= motion.demanded.1 + slack
}

/// The motion of one drive alone from where its law starts, over its law and a range besides.
pub(crate) fn alone(
    design: &Design<f64>,
    drive: usize,
    (low, high): (f64, f64),
    progress: &mut dyn Progress,
) -> Result<Arc<Motion>, Diagnostic> {
    let model = &design.mechanism.model;
    let drives = model.drives.iter();
    let held: Vec<f64> = drives.map(|d| d.law.at(0.0, &design.parameters)).collect();
    let law = &model.drives[drive].law;
    let (from, to) = law.extent(&design.parameters);
    let own = design.with_laws(|index| (index != drive).then(|| Law::standing(held[index])));
    let start = held[drive];
    let demand = Demand {
        path: DrivePath::of_drive(model, own.size(), drive, held),
        range: (from.min(low), to.max(high)),
        start,
        assemblies: None,
    };
    Motion::along(&own, demand, progress)
        .map(Arc::new)
        .map_err(|error| cannot_move(&own, &error))
}

/// The motion of a design along a way, over a range of places.
pub(crate) fn motion_over(
    design: &Design<f64>,
    way: Way,
    range: (f64, f64),
    progress: &mut dyn Progress,
) -> Result<Arc<Motion>, Diagnostic> {
    match way {
        Way::Drive(drive) if !laws_cover(design, drive, range) => {
            alone(design, drive, range, progress)
        }
        _ => Motion::with_progress(design, progress).map_err(|error| cannot_move(design, &error)),
    }
}

/// Whether the file's laws move this drive alone, over the range.
pub(crate) fn laws_cover(design: &Design<f64>, drive: usize, (low, high): (f64, f64)) -> bool {
    let (model, parameters) = (&design.mechanism.model, &design.parameters);
    let path = DrivePath::new(model, parameters, design.size());
    let own = matches!(path, DrivePath::Coordinate { drive: own, .. } if own == drive);
    let slack = SAME_PLACE * path.scale();
    let (from, to) = path.range(model, parameters);
    own && from - slack <= low && high <= to + slack
}
