//! What counts as moving: how fast a motion usually is, and which part of that is none.

/// Speeds below this part of the fastest count as rest where friction is concerned.
pub const STILL: f64 = 1e-12;
/// Accelerations below this part of those that the fastest speed would have over the whole motion count as none.
pub const UNMOVED: f64 = 1e-9;

/// How fast a motion usually is, so that rest can be told from a slow moment.
#[derive(Clone, Debug, Default)]
pub struct Pace {
    /// Mean speed of every drive, rad/s or m/s.
    pub speeds: Vec<f64>,
    /// How often the motion would fit into a second, 1/s.
    pub frequency: f64,
}
