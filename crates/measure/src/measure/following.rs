//! Drives that are let go and follow: their coordinate is what the pose makes of it.

use std::f64::consts::TAU;

use kempe_linear::Lu;
use kempe_mechanism::Pose;
use kempe_model::{Drive, DriveId, DriveKind, PoseMeasure, StandIn};
use kempe_number::Number;

use super::{Along, History, Moment, ORDER, Series, undefined};
use crate::base::Base;
use crate::state::State;

/// Whether a drive follows.
pub(crate) fn is_following(drives: &[Drive], drive: usize) -> bool {
    (drives.get(drive))
        .is_some_and(|d| matches!(d.kind, DriveKind::StandIn(StandIn::Follows { .. })))
}

/// What tells the place of the mechanism for the drives that follow, one for each of these.
pub(crate) fn pilots(drives: &[Drive]) -> Vec<DriveId> {
    let is_pilot = |d: &Drive| matches!(d.kind, DriveKind::StandIn(StandIn::Pilot { .. }));
    let pilots = (0..drives.len()).filter(|index| is_pilot(&drives[*index]));
    pilots.map(|index| DriveId(index as u32)).collect()
}

/// The poses along a drive that follows, all others that follow at rest, as series in its own coordinate: those along the pilot, whose
/// coordinate is a series in that of the drive. At a dead point of the drive they have no finite rates. Of several pilots only
/// how fast each goes is known.
pub(crate) fn alone_following<B: Base>(state: &State<B>, drive: DriveId) -> Vec<Pose<Series<B>>> {
    let history = History::default();
    let moment = Moment::new(state, &history, &[], None);
    let drives = &state.mechanism().model.drives;
    let pilots = pilots(drives);
    if let [pilot] = pilots[..] {
        let along = Along::Drive(pilot);
        let inverse = reverted(&moment.following(drive, along));
        let poses = moment.poses(along).iter();
        return poses
            .map(|pose| pose.map(|x| x.compose(&inverse)))
            .collect();
    }
    let follow = (0..drives.len()).filter(|index| is_following(drives, *index));
    let follow: Vec<DriveId> = follow.map(|index| DriveId(index as u32)).collect();
    let mut shares: Vec<f64> = (follow.iter())
        .map(|other| if *other == drive { 1.0 } else { 0.0 })
        .collect();
    let mut factors = Lu::new(pilots.len());
    let rate = |row: usize, column: usize| {
        let along = Along::Drive(pilots[column]);
        let following = moment.following(follow[row], along);
        following.coefficient(1).value()
    };
    if follow.len() == pilots.len() && factors.factor(rate) {
        factors.solve(&mut shares);
    } else {
        shares = vec![f64::NAN; pilots.len()];
    }
    let first = |body: usize, of: fn(&Pose<Series<B>>) -> Series<B>| {
        let parts = pilots.iter().zip(&shares).map(|(pilot, share)| {
            let poses = moment.poses(Along::Drive(*pilot));
            of(&poses[body]).coefficient(1) * B::unvaried(*share)
        });
        let mut coefficients = [B::from_f64(f64::NAN); ORDER];
        coefficients[0] = of(&state.poses[body]).coefficient(0);
        coefficients[1] = parts.fold(B::zero(), |sum, part| sum + part);
        Series::from_coefficients(coefficients)
    };
    let bodies = 0..state.poses.len();
    bodies
        .map(|body| Pose {
            x: first(body, |pose| pose.x),
            y: first(body, |pose| pose.y),
            c: first(body, |pose| pose.c),
            s: first(body, |pose| pose.s),
        })
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
