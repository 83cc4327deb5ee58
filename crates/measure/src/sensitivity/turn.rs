//! What rubs dry and turns back: when, and how that moves with the parameters.

use crate::base::{CHUNK, Varying};

/// When something that rubs dry turns back.
#[derive(Clone, Debug, Default)]
pub(super) struct Turns {
    /// Times between the breaks of the laws.
    pub between: Vec<Varying>,
    /// Right at breaks and at both ends of the motion: where these move otherwise, the turn moves out of the stretch that begins or ends there, or into it.
    pub at_ends: Vec<End>,
}

/// An end of a stretch between breaks of the laws, with what turns back there.
#[derive(Clone, Debug)]
pub(super) struct End {
    pub time: f64,
    /// Whether the stretch begins here.
    pub begins: bool,
    pub turns: Vec<Turn>,
}

/// Something that turns back at an end.
#[derive(Clone, Debug)]
pub(super) struct Turn {
    /// Its place among what slides.
    pub which: usize,
    /// The sense in which it slides behind.
    pub sense: f64,
    /// How much faster than the end its time moves with each parameter.
    pub moves: [f64; CHUNK],
}
