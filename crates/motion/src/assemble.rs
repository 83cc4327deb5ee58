//! All assemblies of a mechanism at given drive coordinates, and the one that the user means.
//!
//! The steps of the plan are solved in every way there is (`search`): a closed form in both of its modes, a block without
//! one (`blocks`) by the complete homotopy, as linear equations where it is a train of gears (`gear_train`), or by cutting
//! it open at its gear (`open_loop`). The file's hints choose among them (`hints`) and say from where angles are counted
//! (`turns`).

mod along_curve;
mod blocks;
mod equations;
mod gear_train;
mod hints;
mod open_loop;
mod polynomial;
mod search;
mod turns;

pub use self::hints::{Found, Standing, found_near, standings};
pub use self::polynomial::{Solutions, all_real_solutions};
pub use self::search::{ASSEMBLY_LIMIT, CLOSED};

use std::borrow::Cow;

use kempe_homotopy::PathReport;
use kempe_mechanism::pose::Pose;
use kempe_mechanism::{Branch, Design};

use self::search::Search;
use self::turns::counted_turns;
use crate::progress::{Progress, Silent};

/// How often the turns of links may change those of links further on.
const TURNS_SETTLE: usize = 8;

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
    /// Those, up to [`ASSEMBLY_LIMIT`].
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

/// Finds all assemblies at the drive coordinates (SI).
pub fn all_assemblies(design: &Design<f64>, coordinates: &[f64]) -> Assemblies {
    // Silent, it is never stopped.
    find_assemblies(design, coordinates, &mut Silent).unwrap_or_default()
}

/// As [`all_assemblies`]; `progress` hears how far it has come. `None` when it stops the search: a part of the list could
/// lack the assembly that is meant.
pub fn find_assemblies(
    design: &Design<f64>,
    coordinates: &[f64],
    progress: &mut dyn Progress,
) -> Option<Assemblies> {
    find_assemblies_after(design, coordinates, Earlier::default(), progress)
}

/// What is known of a design that is much like the one to assemble.
#[derive(Clone, Copy, Default)]
pub(crate) struct Earlier<'a> {
    /// What the homotopies did for it: assemblies are found the sooner.
    pub paths: &'a [PathReport],
    /// How it stands itself: what its assembly has to say of which one is meant.
    pub like: Option<Like<'a>>,
}

/// The assembly of a design like which another is put together.
#[derive(Clone, Copy)]
pub(crate) struct Like<'a> {
    pub design: &'a Design<f64>,
    pub assembly: &'a Assembly,
    /// Whether the assembly nearest to it is meant, whatever `near` hints say; else it tells whole turns alone.
    pub nearest: bool,
}

impl Like<'_> {
    /// Angle of a link, rad.
    fn angle(&self, link: usize) -> f64 {
        let body = self.design.mechanism.seats[link].body.index();
        self.body_angle(body) + self.design.geometry.seat_angles[link]
    }

    /// Angle of a body, rad.
    fn body_angle(&self, body: usize) -> f64 {
        let Assembly { poses, branch, .. } = self.assembly;
        poses[body].angle_near(branch.near[body])
    }
}

/// As [`find_assemblies`], with what is known of much the same dimensions: the list is the same, but for what
/// [`Earlier::like`] says.
pub(crate) fn find_assemblies_after(
    design: &Design<f64>,
    coordinates: &[f64],
    earlier: Earlier<'_>,
    progress: &mut dyn Progress,
) -> Option<Assemblies> {
    // A gear meshes by the angle of its own link: where links of one body count from different turns, which shows in an
    // assembly, what hangs on such gears is found with these turns.
    let mut design = Cow::Borrowed(design);
    let search = Search::new(&design, coordinates, earlier, progress);
    let mut found = search.run()?;
    for _ in 0..TURNS_SETTLE {
        let Some(chosen) = found.list.first() else {
            break;
        };
        let turns = counted_turns(&design, coordinates, chosen, earlier.like);
        if turns == design.geometry.turns {
            break;
        }
        design.to_mut().count_turns(&turns);
        let search = Search::new(&design, coordinates, earlier, progress);
        found = search.run()?;
    }
    Some(found)
}
