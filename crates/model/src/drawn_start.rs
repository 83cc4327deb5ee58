//! Which drives start elsewhere than they are drawn.

use std::f64::consts::TAU;

use kempe_units::Dimension;

use crate::geometry::value;
use crate::ids::{DriveId, Scalar};
use crate::joint::JointKind;
use crate::model::Model;

/// A drive starts as drawn when its coordinate is this near, rad: a drawn angle written with few digits.
const NEAR_ANGLE: f64 = 0.01;
/// The same of a length, in parts of the size of the drawing.
const NEAR_LENGTH: f64 = 0.005;

/// A drive that starts elsewhere than it is drawn; coordinates in rad or m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StartsElsewhere {
    /// The drive.
    pub drive: DriveId,
    /// Where its law starts.
    pub start: f64,
    /// Where it is drawn: of an angle the turn that is nearest to the start, but where wheels count turns the drawn one.
    pub drawn: f64,
}

impl Model {
    /// The drives that start elsewhere than drawn for these values of the parameters.
    pub fn starting_elsewhere(&self, parameters: &[f64]) -> Vec<StartsElsewhere> {
        let places = self.drawing.places.values().flat_map(|p| &p.at);
        let (least, most) = places.fold((0.0f64, 0.0f64), |(least, most), x| {
            let x = value(x, parameters);
            (least.min(x), most.max(x))
        });
        let counts = self.counts_turns();
        let of = |(id, drawn): &(DriveId, Scalar)| {
            let drive = self.drives.get(id.index())?;
            let start = value(&drive.law.from, parameters);
            let mut drawn = value(drawn, parameters);
            let near = match drive.dimension {
                Dimension::ANGLE => {
                    if !counts {
                        drawn += TAU * ((start - drawn) / TAU).round();
                    }
                    NEAR_ANGLE
                }
                _ => NEAR_LENGTH * (most - least),
            };
            let drive = *id;
            let elsewhere = StartsElsewhere {
                drive,
                start,
                drawn,
            };
            ((start - drawn).abs() > near).then_some(elsewhere)
        };
        self.drawing.coordinates.iter().filter_map(of).collect()
    }

    /// Whether wheels or racks tell whole turns of a link apart.
    pub fn counts_turns(&self) -> bool {
        let counts = |kind: &JointKind| {
            matches!(
                kind,
                JointKind::Gears { .. } | JointKind::Belt { .. } | JointKind::Rack { .. }
            )
        };
        self.joints.iter().any(|joint| counts(&joint.kind))
    }
}
