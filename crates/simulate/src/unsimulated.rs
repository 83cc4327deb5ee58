//! Why there is no simulation.

use kempe_dynamics::Problem;
use kempe_mechanism::{NotCut, NotReleased};
use kempe_motion::MotionError;

use crate::lack::{Lack, Sought};
use crate::start::NoStart;
use crate::touched::Place;

/// Why there is no simulation.
#[derive(Debug)]
pub enum Unsimulated {
    /// The mechanism does not come to the start.
    Start(NoStart),
    /// It cannot move there.
    Motion(MotionError),
    /// What acts on it makes no sense.
    Problems(Vec<Problem>),
    /// Nothing is known of how what is let go accelerates there.
    Lacks(Lack),
    /// Something that the simulation goes by has no value at the start.
    NoValue(Sought),
    /// What this stop bounds goes by drives that keep their laws, or by time, and by nothing that is let go, and comes to it.
    KeptFromStop(usize),
    /// It starts beyond this stop, by so much.
    BeyondStop(usize, f64),
    /// Branches cross at the start: it may come to any of them.
    AtChangePoint,
    /// A joint with play starts with its bodies in each other, so deep, m.
    BeyondPlay(Place, f64),
    /// A joint cannot have play.
    NoPlay(NotReleased),
    /// There are no coordinates of a spanning tree.
    NoTree(NoTree),
}

/// Why a mechanism is not simulated in coordinates of a spanning tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoTree {
    /// Its joints rub: what they carry is not known there.
    Friction,
    /// Joints have play: they are open already.
    Play,
    /// Something that acts, stops, switches or ends it asks for a derivative along a drive: that is one of a mechanism that is closed.
    Along,
    /// Its loops cannot be cut.
    Cut(NotCut),
}
