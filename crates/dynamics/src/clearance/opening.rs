//! The coordinates of joints with play, and where contacts are in them.

use std::f64::consts::PI;

use kempe_measure::Series;
use kempe_mechanism::Mechanism;
use kempe_mechanism::constraint::{Joint as _, Source as Of};
use kempe_model::{DriveId, DriveKind};
use kempe_number::{Number, math};
use kempe_units::Dimension;

use crate::instant::Rates;

/// Play at a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Play {
    /// The joint.
    pub joint: Of,
    /// The clearance, m.
    pub radial: f64,
}

impl Play {
    /// Whether it is across a line or an arc, to two sides alone; at a pin it is all round.
    pub fn is_across(&self) -> bool {
        matches!(self.joint, Of::Joint(_))
    }
}

/// A joint with play, let go.
pub(super) struct Opening {
    /// The clearance, m.
    pub radial: f64,
    /// The coordinates along which it stands open: those that are lengths.
    pub along: Vec<DriveId>,
    /// The constraints that these coordinates are of.
    pub rows: Vec<usize>,
    /// Whether a force is to hold it open.
    pub held: bool,
    /// Whether others repeat it, so that it opens only as they let it.
    pub undetermined: bool,
}

impl Opening {
    /// Of a mechanism in which the joint is let go.
    pub fn new(open: &Mechanism, play: &Play) -> Self {
        let is_own = |drive: &DriveId| {
            let drive = &open.model.drives[drive.index()];
            let is_of =
                matches!(drive.kind, DriveKind::Release { of, .. } if Of::from(of) == play.joint);
            is_of && drive.dimension == Dimension::LENGTH
        };
        let along: Vec<DriveId> = open.released.iter().copied().filter(is_own).collect();
        let constraints = open.constraints.iter().enumerate();
        let rows = constraints.filter(|(_, (c, _))| c.drive().is_some_and(|d| along.contains(&d)));
        Self {
            radial: play.radial,
            rows: rows.map(|(index, _)| index).collect(),
            along,
            held: true,
            undetermined: false,
        }
    }
}

/// Where the contact is under a force, m, in time: off by the clearance, against the force.
pub(super) fn contact(force: &[Rates], radial: f64, turning: bool) -> Vec<Series<f64>> {
    if let ([x, y], true) = (force, turning) {
        let angle = y.atan2(*x) + PI;
        let coefficients = [angle.value(), angle.coefficient(1), 0.0, 0.0, 0.0];
        let (s, c) = Series::from_coefficients(coefficients).sin_cos();
        return vec![c * radial, s * radial];
    }
    let size = size_of(force);
    let places = force.iter().map(|f| -radial * f.value() / size);
    places.map(Series::constant).collect()
}

/// The size of a force, N.
pub(super) fn size_of(force: &[Rates]) -> f64 {
    force.iter().fold(0.0, |sum, f| math::hypot(sum, f.value()))
}
