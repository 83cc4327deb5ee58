//! All assemblies of a mechanism at given drive coordinates, and the one that the user means.
//!
//! The steps of the plan are solved in every way there is (`search`): a closed form in both of its modes, a block without
//! one (`blocks`) by the complete homotopy, as linear equations where it is a train of gears (`gear_train`), or by cutting
//! it open at its gear (`open_loop`). The file's hints choose among them (`hints`) and say from where angles are counted
//! (`turns`).

mod along_curve;
mod assemblies;
mod blocks;
mod earlier;
mod equations;
mod gear_train;
mod hints;
mod open_loop;
mod polynomial;
mod search;
mod turns;

pub use self::assemblies::{Assemblies, Assembly, OpenStep, Shortfall};
pub(crate) use self::earlier::{Earlier, Like};
pub use self::hints::{Found, Standing, found_near, standings};
pub use self::polynomial::{Solutions, all_real_solutions};
pub use self::search::{ASSEMBLY_LIMIT, CLOSED};

use std::borrow::Cow;

use kempe_mechanism::Design;

use self::search::Search;
use self::turns::counted_turns;
use crate::progress::{Progress, Silent};

/// How often the turns of links may change those of links further on.
const TURNS_SETTLE: usize = 8;

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
