//! Drives that are let go and follow: their coordinate is what the pose makes of it.

use std::f64::consts::TAU;

use kempe_mechanism::Pose;
use kempe_model::{Drive, DriveId, DriveKind, PoseMeasure, StandIn};
use kempe_number::Number;

use super::{Along, History, Moment, ORDER, Series, undefined};
use crate::state::State;

/// Whether a drive follows.
pub(crate) fn is_following(drives: &[Drive], drive: usize) -> bool {
    (drives.get(drive))
        .is_some_and(|d| matches!(d.kind, DriveKind::StandIn(StandIn::Follows { .. })))
}

/// What tells the place of the mechanism for a drive that follows, where that is one coordinate alone.
pub(crate) fn pilot_of(drives: &[Drive], drive: DriveId) -> Option<DriveId> {
    if !is_following(drives, drive.index()) {
        return None;
    }
    let is_pilot = |d: &Drive| matches!(d.kind, DriveKind::StandIn(StandIn::Pilot { .. }));
    let mut pilots = (0..drives.len()).filter(|index| is_pilot(&drives[*index]));
    let only = pilots.next()?;
    pilots.next().is_none().then_some(DriveId(only as u32))
}

/// The poses along a drive that follows, as series in its own coordinate: those along the pilot, whose coordinate is a series in
/// that of the drive. At a dead point of the drive they have no finite rates.
pub(crate) fn alone_following<B: Number>(
    state: &State<B>,
    drive: DriveId,
    pilot: DriveId,
) -> Vec<Pose<Series<B>>> {
    let history = History::default();
    let moment = Moment::new(state, &history, &[], None);
    let along = Along::Drive(pilot);
    let inverse = reverted(&moment.following(drive, along));
    let poses = moment.poses(along).iter();
    poses
        .map(|pose| pose.map(|x| x.compose(&inverse)))
        .collect()
}

/// The series by which the argument of this one goes with its value: one more coefficient is right after every round.
fn reverted<B: Number>(series: &Series<B>) -> Series<B> {
    let step = Series::variable(B::zero());
    let first = Series::constant(series.coefficient(1));
    let mut bent = *series.coefficients();
    (bent[0], bent[1]) = (B::zero(), B::zero());
    let bent = Series::from_coefficients(bent);
    let mut found = step / first;
    for _ in 2..ORDER {
        found = (step - bent.compose(&found)) / first;
    }
    found
}

impl<B: Number> Moment<'_, B> {
    /// What a drive that follows is as a measure of the pose; `None` for drives that hold something.
    pub(super) fn followed(&self, drive: DriveId) -> Option<PoseMeasure> {
        let model = &self.state.mechanism().model;
        let DriveKind::StandIn(StandIn::Follows { of, .. }) =
            &model.drives.get(drive.index())?.kind
        else {
            return None;
        };
        match **of {
            DriveKind::Turn { link, relative_to } => {
                Some(PoseMeasure::AngleBetween(link, relative_to))
            }
            DriveKind::Cylinder { a, b } => Some(PoseMeasure::Distance(a.point, b.point)),
            DriveKind::Slide { joint } => {
                let (at, on) = model.joints.get(joint.index())?.kind.guide()?;
                Some(PoseMeasure::Travel(at, on))
            }
            _ => None,
        }
    }

    /// The coordinate of a drive that follows. Of the whole turns of an angle the state's own coordinate tells.
    pub(super) fn following(&self, drive: DriveId, along: Along) -> Series<B> {
        let Some(measure) = self.followed(drive) else {
            return undefined();
        };
        let found = self.geometric(&measure, self.poses(along), along);
        let about = self.state.coordinates[drive.index()].value();
        let turns = match measure {
            PoseMeasure::AngleBetween(..) => ((about - found.value()) / TAU).round(),
            _ => 0.0,
        };
        self.along_time(found + turns * TAU, along)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_series_is_reverted() {
        // tan and arc tangent: x + x^3/3 and x - x^3/3.
        let tangent = Series::from_coefficients([7.0, 1.0, 0.0, 1.0 / 3.0, 0.0]);
        let found = reverted(&tangent);
        assert_eq!(*found.coefficients(), [0.0, 1.0, 0.0, -1.0 / 3.0, 0.0]);
        // x + x^2: x - x^2 + 2 x^3 - 5 x^4, with Catalan's numbers.
        let square = Series::from_coefficients([0.0, 1.0, 1.0, 0.0, 0.0]);
        assert_eq!(
            *reverted(&square).coefficients(),
            [0.0, 1.0, -1.0, 2.0, -5.0]
        );
    }
}
