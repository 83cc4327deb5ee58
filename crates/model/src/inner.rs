//! States besides the drives: what only a simulation follows.

use crate::ids::DriveId;

/// A side of a hydraulic cylinder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Chamber {
    /// That of the whole bore, whose oil pushes the rod out.
    Bore,
    /// That of the ring round the rod.
    Ring,
}

impl Chamber {
    /// Both, in the order in which values of both stand.
    pub const BOTH: [Self; 2] = [Self::Bore, Self::Ring];
}

/// A state of its own that a mechanism has besides the coordinates of its drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InnerState {
    /// The pressure in a chamber of a drive's cylinder, Pa.
    Pressure(DriveId, Chamber),
    /// Which part of the greatest friction acts in a place where something rubs, positive where it resists sliding forwards: -1 to 1.
    Friction(usize),
    /// Whether a switch is on: 1 or 0.
    Switch(usize),
}
