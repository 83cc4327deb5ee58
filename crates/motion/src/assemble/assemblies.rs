//! Ways to put a mechanism together, and why some may be missing.

use kempe_homotopy::PathReport;
use kempe_mechanism::pose::Pose;
use kempe_mechanism::{Branch, Design};

/// One way to put the mechanism together.
#[derive(Clone, Debug)]
pub struct Assembly {
    /// The branch that leads to it.
    pub branch: Branch,
    /// Where the bodies are.
    pub poses: Vec<Pose<f64>>,
    /// Root mean square distance of the points of `near` hints from where they should be, m (angles in rad count as
    /// lengths of one mechanism size).
    pub distance: f64,
    /// Whole turns, rad, by which every link's angle is counted further than its weld says: links of one body each count
    /// from their own drive or hint.
    pub turns: Vec<f64>,
}

impl Assembly {
    /// The design with the angles of its links counted as this assembly has them.
    pub(crate) fn count_in(&self, design: &Design<f64>) -> Design<f64> {
        let mut design = design.clone();
        if design.geometry.turns != self.turns {
            design.count_turns(&self.turns);
        }
        design
    }
}

/// Why assemblies may be missing from a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shortfall {
    /// A block was searched from random starts: the complete method does not apply to it.
    Searched,
    /// A block with a gear or rack was cut open there, and its curves were followed: one between two cuts can be missed.
    Scanned,
    /// The complete method lost a path: two assemblies meet, or all but.
    LostPath,
    /// The complete method has more to do than [`WORK_LIMIT`](kempe_homotopy::WORK_LIMIT) allows.
    Exhausted,
    /// There are more than [`ASSEMBLY_LIMIT`](super::ASSEMBLY_LIMIT), or too many ways to try.
    TooMany,
}

/// All ways to put the mechanism together, the one meant first.
#[derive(Clone, Debug, Default)]
pub struct Assemblies {
    /// The assemblies that agree with the file's sides, nearest to its `near` hints first.
    pub list: Vec<Assembly>,
    /// How many more there are when the sides are not asked for.
    pub rejected: usize,
    /// Those, up to [`ASSEMBLY_LIMIT`](super::ASSEMBLY_LIMIT).
    pub others: Vec<Assembly>,
    /// Whether every assembly was found: all blocks were solved in closed form or by the complete method, no path was
    /// lost and no limit was met.
    pub complete: bool,
    /// Why it is not known that every assembly was found; the first reason met.
    pub shortfall: Option<Shortfall>,
    /// What the homotopies did, one entry for each block solved.
    pub paths: Vec<PathReport>,
    /// What could not be closed where no assembly agrees with the sides.
    pub open: Option<OpenStep>,
}

/// A step of the plan that does not close.
#[derive(Clone, Debug)]
pub struct OpenStep {
    /// The step.
    pub step: usize,
    /// The branch that leads there.
    pub branch: Branch,
    /// Whether what is placed before it agrees with the file's sides.
    pub agrees: bool,
}
