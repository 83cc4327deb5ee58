//! What is asked of an output that rests, and the way of its point.

use kempe_measure::Sample;
use kempe_model::{DwellTask, Model};
use kempe_synthesis::C;
use kempe_units::Dimension;

use crate::unit::Units;

/// What a stretch comes near to.
#[derive(Clone, Copy, Debug)]
pub(super) enum Near {
    Circle { centre: C, radius: f64 },
    Line { point: C, direction: C },
}

/// What is asked, in numbers, with the point's whole way.
pub(super) struct Asked<'a> {
    pub model: &'a Model,
    pub task: &'a DwellTask,
    pub units: Units,
    /// How far the drive goes during the rest, rad or m.
    pub dwell: f64,
    /// The drive's coordinate over the way.
    pub range: [f64; 2],
    pub closed: bool,
    /// Places of the point over the whole way, evenly.
    pub way: Vec<C>,
    /// How much the output is to move.
    pub stroke: Option<f64>,
    /// Two corners within which a pivot lies.
    pub corners: [C; 2],
    /// The mechanism where the motion starts.
    pub start: Sample,
}

impl Asked<'_> {
    /// What the drive's coordinate measures.
    pub fn coordinate(&self) -> Dimension {
        self.model.drives[self.task.drive.index()].dimension
    }
}

/// A coordinate on a way, which a cycle comes back to.
pub(super) fn wrapped(at: f64, [low, high]: [f64; 2], closed: bool) -> f64 {
    match closed && at >= high {
        true => at - (high - low),
        false => at,
    }
}
