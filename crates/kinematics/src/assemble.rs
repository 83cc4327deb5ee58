//! All assemblies of a mechanism at given drive coordinates, and the one that the user means.
//!
//! The steps of the plan are solved in every way there is (`search`): a closed form in both of its modes, a block without
//! one (`blocks`) by the complete homotopy, as linear equations where it is a train of gears (`gear_train`), or by cutting
//! it open at its gear (`open_loop`). The file's hints choose among them (`hints`).

mod blocks;
mod gear_train;
mod hints;
mod open_loop;
mod search;

pub use self::search::{ASSEMBLY_LIMIT, CLOSED};

use self::search::Search;
use crate::evidence::is_finite;
use crate::homotopy::PathReport;
use crate::mechanism::Mechanism;
use crate::plan::Plan;
use crate::pose::Pose;
use crate::state::{Branch, Design, State};
use crate::watch::{Unwatched, Watch};

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
    /// The complete method has more to do than [`WORK_LIMIT`](crate::homotopy::WORK_LIMIT) allows.
    Exhausted,
    /// There are more than [`ASSEMBLY_LIMIT`], or too many ways to try.
    TooMany,
}

/// All ways to put the mechanism together, the one meant first.
#[derive(Clone, Debug, Default)]
pub struct Assemblies {
    /// The assemblies that agree with the file's sides, nearest to its `near` hints first.
    pub list: Vec<Assembly>,
    /// How many more there are when the sides are not asked for.
    pub rejected: usize,
    /// Whether every assembly was found: all blocks were solved in closed form or by the complete method, no path was
    /// lost and no limit was met.
    pub complete: bool,
    /// Why it is not known that every assembly was found; the first reason met.
    pub shortfall: Option<Shortfall>,
    /// What the homotopies did, one entry for each block solved.
    pub paths: Vec<PathReport>,
    /// The step that could not be closed when there is no assembly at all.
    pub open_step: Option<usize>,
}

/// Finds all assemblies at the drive coordinates (SI).
pub fn all_assemblies(
    mechanism: &Mechanism,
    plan: &Plan,
    design: &Design<f64>,
    coordinates: &[f64],
) -> Assemblies {
    // Unwatched, it is never stopped.
    find_assemblies(mechanism, plan, design, coordinates, &mut Unwatched).unwrap_or_default()
}

/// As [`all_assemblies`]; `watch` hears how far it has come. `None` when it stops the search: a part of the list could
/// lack the assembly that is meant.
pub fn find_assemblies(
    mechanism: &Mechanism,
    plan: &Plan,
    design: &Design<f64>,
    coordinates: &[f64],
    watch: &mut dyn Watch,
) -> Option<Assemblies> {
    Search::new(mechanism, plan, design, coordinates, watch).run()
}

/// Runs the whole plan on plain numbers from a branch; `None` when it does not close.
pub fn solve_plain(
    mechanism: &Mechanism,
    plan: &Plan,
    design: &Design<f64>,
    branch: &Branch,
    coordinates: &[f64],
) -> Option<State<f64>> {
    let mut state = State::new(mechanism, plan);
    state.set_inputs(mechanism, coordinates);
    plan.solve(mechanism, design, branch, &mut state);
    state.poses.iter().all(is_finite).then_some(state)
}
