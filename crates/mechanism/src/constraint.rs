//! The one definition of every joint: what it demands of the bodies it ties.
//!
//! Its residuals over these bodies and their gradients are in `rows`: lengths in m, directions as sines, gears and racks as
//! angles. Everything else (rank, Newton groups, closure evidence, reactions) comes from these rows; the closed forms are
//! held to them.

mod rows;
mod situation;

pub use self::rows::Gradient;
pub use self::situation::{Input, Situation};

use kempe_model::{DriveId, JointId, LinkId, PointId};

use crate::structure::{BodyId, LineRef, Marker};

/// What a constraint comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// A pin made by a shared point name; `link` is the later of the two links.
    Pin {
        /// The point.
        point: PointId,
        /// The later link.
        link: LinkId,
    },
    /// A joint of the file.
    Joint(JointId),
    /// A drive.
    Drive(DriveId),
}

/// One condition between bodies. Its residuals are [`Situation::residual`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Constraint {
    /// Two points coincide: two rows.
    Coincide {
        /// Point of the earlier body.
        a: Marker,
        /// Point of the later body.
        b: Marker,
    },
    /// A point lies on a line.
    OnLine {
        /// The point.
        point: Marker,
        /// The line.
        line: LineRef,
    },
    /// `angle(a) - angle(b) = offset (+ the drive's coordinate)`.
    Direction {
        /// Body whose angle is set.
        a: BodyId,
        /// Body against which.
        b: BodyId,
        /// Index into the geometry's angles.
        offset: u32,
        /// The drive whose coordinate is added.
        input: Option<DriveId>,
    },
    /// The distance of two points is the drive's coordinate.
    Distance {
        /// Foot.
        a: Marker,
        /// Eye.
        b: Marker,
        /// The drive.
        input: DriveId,
    },
    /// A point's coordinate along a line is the drive's coordinate.
    Travel {
        /// The point.
        point: Marker,
        /// The line.
        line: LineRef,
        /// The drive.
        input: DriveId,
    },
    /// `ratio_a (angle_a - angle_arm) + ratio_b (angle_b - angle_arm) = phase`.
    Gears {
        /// First gear.
        a: BodyId,
        /// Second gear.
        b: BodyId,
        /// Arm.
        arm: BodyId,
        /// Index into the geometry's gear constants.
        constants: u32,
    },
    /// `s + radius (angle_pinion - angle_rack) = offset`, `s` along the rack's line.
    Rack {
        /// Pitch line on the rack.
        line: LineRef,
        /// The pinion's centre.
        center: Marker,
        /// Index into the geometry's gear constants.
        constants: u32,
    },
}

impl Constraint {
    /// How many rows it has.
    pub fn rows(&self) -> usize {
        match self {
            Constraint::Coincide { .. } => 2,
            _ => 1,
        }
    }

    /// The drive whose coordinate it holds.
    pub fn drive(&self) -> Option<DriveId> {
        match self {
            Constraint::Direction { input, .. } => *input,
            Constraint::Distance { input, .. } | Constraint::Travel { input, .. } => Some(*input),
            _ => None,
        }
    }

    /// The bodies it ties.
    pub fn bodies(&self) -> impl Iterator<Item = BodyId> {
        let list = match *self {
            Constraint::Coincide { a, b } | Constraint::Distance { a, b, .. } => {
                [Some(a.body), Some(b.body), None]
            }
            Constraint::OnLine { point, line } | Constraint::Travel { point, line, .. } => {
                [Some(point.body), Some(line.body), None]
            }
            Constraint::Direction { a, b, .. } => [Some(a), Some(b), None],
            Constraint::Gears { a, b, arm, .. } => [Some(a), Some(b), Some(arm)],
            Constraint::Rack { line, center, .. } => [Some(line.body), Some(center.body), None],
        };
        list.into_iter().flatten()
    }

    /// The factor that makes its rows comparable with others': lengths count in mechanism sizes, angles as they are.
    pub(crate) fn unit(&self, size: f64) -> f64 {
        match self {
            Constraint::Direction { .. } | Constraint::Gears { .. } => 1.0,
            _ => 1.0 / size,
        }
    }
}
