//! What was proved: of one pose, of a stretch, of a whole motion.

use kempe_mechanism::pose::Pose;
use kempe_motion::events::EventKind;
use kempe_number::Interval;

use crate::not_proved::NotProved;

/// What was proved about a pose, for one path parameter or for every one in an interval.
#[derive(Clone, Debug)]
pub struct Certificate {
    /// The path parameters.
    pub at: Interval,
    /// Proved: there is a pose that satisfies every constraint.
    pub exists: bool,
    /// Proved: there is no other with the branch's assembly modes (closed forms), in the box (Newton blocks).
    pub unique: bool,
    /// Where the bodies are; empty intervals where nothing was proved.
    pub poses: Vec<Pose<Interval>>,
    /// Determinant of every step (a signed length or area): away from zero where its assemblies are told apart.
    pub determinants: Vec<Interval>,
    /// Widest interval: lengths in mechanism sizes, directions as numbers.
    pub widest: f64,
    /// What is missing from a full proof.
    pub reason: Option<NotProved>,
}

/// A stretch of the motion that is proved.
#[derive(Clone, Debug)]
pub struct Cell {
    /// Path parameter at its low end.
    pub from: f64,
    /// Path parameter at its high end.
    pub to: f64,
    /// Where the bodies are during the stretch.
    pub poses: Vec<Pose<Interval>>,
    /// Smallest half width of the tube in which the pose is the only one (mechanism sizes and rad).
    pub tube: f64,
    /// How far from the tangent the pose may be, at most (mechanism sizes and rad).
    pub widest: f64,
    /// Proved to be the same branch as the stretch before, which ends where this one begins.
    pub joined: bool,
}

/// A stretch that is not proved.
#[derive(Clone, Debug, PartialEq)]
pub struct Gap {
    /// Path parameter at its low end.
    pub from: f64,
    /// Path parameter at its high end.
    pub to: f64,
    /// Why the last try failed.
    pub reason: NotProved,
    /// What the motion met in it (ends included), if anything.
    pub event: Option<EventKind>,
}

/// What was proved about a motion.
#[derive(Clone, Debug)]
pub struct CertifiedMotion {
    /// The reached range of the path parameter.
    pub range: (f64, f64),
    /// Proved stretches, in order.
    pub cells: Vec<Cell>,
    /// What is left over, in order.
    pub gaps: Vec<Gap>,
    /// Longest stretches that are proved to be one smooth branch without a break.
    pub runs: Vec<(f64, f64)>,
    /// Proved part of the range.
    pub fraction: f64,
    /// Redundant constraint rows that are left out of the proof.
    pub redundant: usize,
    /// False when it was stopped on the way: the rest is in neither list.
    pub finished: bool,
}

impl CertifiedMotion {
    /// Whether all of the reached range is proved to be one smooth branch.
    pub fn is_whole(&self) -> bool {
        self.finished && self.gaps.is_empty() && self.redundant == 0 && self.runs.len() == 1
    }

    pub(super) fn take_cell(&mut self, cell: Cell) {
        match self.runs.last_mut() {
            Some(run) if cell.joined => run.1 = cell.to,
            _ => self.runs.push((cell.from, cell.to)),
        }
        self.cells.push(cell);
    }

    pub(super) fn take_gap(&mut self, from: f64, to: f64, reason: NotProved) {
        match self.gaps.last_mut() {
            Some(gap) if gap.to == from => {
                gap.to = to;
                gap.reason = reason;
            }
            _ => self.gaps.push(Gap {
                from,
                to,
                reason,
                event: None,
            }),
        }
    }
}
