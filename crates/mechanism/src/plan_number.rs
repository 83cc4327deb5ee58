//! Numbers a plan can run on.

use kempe_number::Number;

use crate::bound_dyad::BoundDyad;
use crate::branch::Branch;
use crate::configuration::Configuration;
use crate::design::Design;
use crate::plan::NewtonBlock;

/// Size, in bytes, of the largest numbers whose rarer steps are compiled into their caller for its vector instructions.
pub(crate) const IN_PLACE: usize = 128;

/// Whether the rarer steps of a number are compiled into their caller. Larger numbers (series in lanes, long series), and lanes that
/// solve Newton groups, next to which such steps are nothing, have them called, one baseline version for every instruction set: less
/// to compile, and slower in lanes where a mechanism has such steps (how much has not been measured).
pub(crate) const fn in_place<T: Number, const ALL: bool>() -> bool {
    size_of::<T>() <= IN_PLACE && !(ALL && T::IN_LANES)
}

/// A number a plan can run on: it knows how to solve a block that has no closed form.
pub trait PlanNumber: Number {
    /// Solves a block from the branch's guess; returns its determinant. What cannot be solved becomes NaN.
    fn solve_newton(
        block: &NewtonBlock,
        design: &Design<Self>,
        branch: &Branch,
        state: &mut Configuration<Self>,
    ) -> Self;

    /// [`Design::solve`]. Numbers that are solved on in many crates implement it for themselves, so that it is compiled
    /// here and once.
    fn solve_plan(design: &Design<Self>, branch: &Branch, state: &mut Configuration<Self>) {
        design.run_plan(branch, state);
    }

    /// Solves a dyad for several states, without its determinants, in a shorter way, if there is one for this number and this dyad.
    #[doc(hidden)]
    #[inline(always)]
    fn solve_common(_: &BoundDyad<'_, Self>, _: &mut [Configuration<Self>], _: f64) -> bool {
        false
    }
}
