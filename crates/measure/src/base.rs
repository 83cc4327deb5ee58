//! Numbers on which the states of a motion are found: plain ones, and such as carry derivatives to parameters.

use kempe_mechanism::{Design, PlanNumber};
use kempe_motion::motion::{Motion, Solver};
use kempe_number::{Dual, Number};

use crate::state::Series;

/// Parameters differentiated to at once.
pub(crate) const CHUNK: usize = 4;

/// A number with its derivatives to some parameters.
pub type Varying = Dual<f64, CHUNK>;

/// A number on which the states of a motion are found.
pub trait Base: Number {
    /// A value of which it is not known how it varies.
    fn unvaried(value: f64) -> Self;

    /// A value that varies as another number does; nothing where this number never varies.
    fn varied(value: f64, as_this: Self) -> Option<Self>;

    /// [`Solver::run`] on series of this number. Implemented for each number by itself, so that it is compiled here and
    /// once, not in every crate that samples a motion.
    fn solve(solver: &mut Solver<Series<Self>>, motion: &Motion, design: &Design<Series<Self>>)
    where
        Series<Self>: PlanNumber;
}

impl Base for f64 {
    fn unvaried(value: f64) -> Self {
        value
    }

    fn varied(_: f64, _: Self) -> Option<Self> {
        None
    }

    #[inline(never)]
    fn solve(solver: &mut Solver<Series<Self>>, motion: &Motion, design: &Design<Series<Self>>) {
        solver.run(motion, design);
    }
}

impl Base for Varying {
    fn unvaried(value: f64) -> Self {
        Self {
            re: value,
            eps: [f64::NAN; _],
        }
    }

    fn varied(value: f64, as_this: Self) -> Option<Self> {
        Some(Self {
            re: value,
            ..as_this
        })
    }

    #[inline(never)]
    fn solve(solver: &mut Solver<Series<Self>>, motion: &Motion, design: &Design<Series<Self>>) {
        solver.run(motion, design);
    }
}
