//! The mechanism as it is drawn: where its points lie in one of its positions.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use kempe_units::Dimension;

use crate::geometry::value;
use crate::ids::{DriveId, LinkId, PointId, Scalar, Span};
use crate::joint::JointKind;
use crate::model::Model;

/// A drive starts as drawn when its coordinate is this near, rad: a drawn angle written with few digits.
const NEAR_ANGLE: f64 = 0.01;
/// The same of a length, in parts of the size of the drawing.
const NEAR_LENGTH: f64 = 0.005;

/// What `[places]` draws. Links, drives and hints already follow from it; it is kept to be told of.
///
/// A model written as a file says what follows and leaves the drawing out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawing {
    /// Where points of links lie in the frame.
    pub places: BTreeMap<PointId, DrawnPlace>,
    /// Links that list their points by name, in file order.
    pub links: Vec<LinkId>,
    /// How many of the model's hints, the last ones, say that the assembly is as drawn.
    pub hints: usize,
    /// Coordinates as drawn of the drives that say themselves where they start. Where one starts elsewhere, the hints of the
    /// drawing are about the drawn coordinates, not about the start.
    pub coordinates: Vec<(DriveId, Scalar)>,
}

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

/// Where a point is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnPlace {
    /// x and y in the frame, m.
    pub at: [Scalar; 2],
    /// Where it stands in the file.
    pub span: Span,
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
