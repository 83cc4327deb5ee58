//! What is asked of a simulation.

use kempe_integrate::Method;
use kempe_model::{Contact, DriveId, Measure};

/// What is asked.
#[derive(Clone, Debug)]
pub struct Question {
    /// Drives that are let go; the others keep their laws.
    pub free: Vec<DriveId>,
    /// Where every drive that is let go starts, and how fast, SI.
    pub start: Vec<[f64; 2]>,
    /// How long, s.
    pub until: f64,
    /// Error of a step, in parts of what moves.
    pub tolerance: f64,
    /// How steps are made.
    pub method: Method,
    /// Which coordinates tell the place on the way.
    pub coordinates: Coordinates,
    /// What stops the motion.
    pub stops: Vec<Stop>,
    /// It ends when one of these becomes positive or zero.
    pub end_when: Vec<Measure>,
    /// Joints with play, which are let go too.
    pub contacts: Vec<Contact>,
}

/// Which coordinates tell the place of a mechanism in a simulation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Coordinates {
    /// As many as it has freedoms: those of the drives that are let go, or of links in their stead. Loops are closed exactly.
    #[default]
    Minimal,
    /// Those of a spanning tree: loops are cut, and what was cut is tied by forces.
    SpanningTree,
}

/// Something that stops the motion: a measure of the pose that cannot become negative.
#[derive(Clone, Debug)]
pub struct Stop {
    /// How far it is open, in the measure's unit.
    pub gap: Measure,
    /// How it resists.
    pub resistance: Resistance,
}

/// How a stop resists.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Resistance {
    /// At once: the speed after an impact is this part of that before, back.
    Rigid {
        /// Coefficient of restitution, from 0 to 1.
        restitution: f64,
    },
    /// As a spring with a damper, which never pull.
    Soft {
        /// Force over depth.
        stiffness: f64,
        /// Force over speed.
        damping: f64,
    },
}
