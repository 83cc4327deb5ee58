//! Play at joints, and the study of what it does.

use crate::contact::ContactProperties;
use crate::ids::{JointId, LinkId, PointId, Scalar, Span};
use crate::motion_study::MotionStudy;

/// Play at a joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Clearance {
    /// Where.
    pub at: ClearanceAt,
    /// How far the centres of a pin and its bore may part, or how far a slider may leave its line to either side, m.
    pub radial: Scalar,
    /// What is known of the bodies that touch there.
    pub contact: ContactProperties,
    /// Where it stands in the file.
    pub span: Span,
}

/// Where there is play.
#[derive(Clone, Debug, PartialEq)]
pub enum ClearanceAt {
    /// At a pin: where several links share it, between these and the first link of the point; all of them where none is named.
    Pin {
        /// The point.
        point: PointId,
        /// The links that have play on the pin.
        on: Vec<LinkId>,
    },
    /// Across the line of a slider or slot.
    Joint(JointId),
    /// At every pin, slider and slot that has none of its own.
    All,
}

/// What play at the joints does to the motion where contact is never lost.
#[derive(Clone, Debug, PartialEq)]
pub struct ClearanceStudy {
    /// Rows, columns and plots.
    pub along: MotionStudy,
    /// How the links in the clearances turn.
    pub rates: ClearanceRates,
}

/// What is assumed of the contact in joints with play.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClearanceModel {
    /// It is never lost: each clearance is a massless link along the reaction of its joint.
    Continuous,
    /// It comes and goes; a spring and a damper press where it is.
    TwoState,
    /// It comes and goes by impacts, and may stay.
    ThreeState,
}

/// How the massless links in the clearances turn, as far as speeds and accelerations go by it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClearanceRates {
    /// Not at all.
    Frozen,
    /// Evenly, as fast as the reaction turns.
    Turning,
}
