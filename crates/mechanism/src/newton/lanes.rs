//! Blocks of several designs: solved lane by lane.

use kempe_number::{Jet, Lanes, Number};

use super::{plain_part, sharpen};
use crate::blocks::Unknown;
use crate::plan::NewtonBlock;
use crate::state::{Branch, Design, State};

/// A number whose parts are lanes, so that one lane can be looked at alone.
pub(super) trait Laned<const W: usize>: Number {
    /// The plain value in a lane.
    fn plain(self, lane: usize) -> f64;

    /// The same with a plain constant in one lane.
    fn with_plain(self, lane: usize, value: f64) -> Self;

    /// Zero but for one lane.
    fn only(self, lane: usize) -> Self;
}

impl<const W: usize> Laned<W> for Lanes<W> {
    fn plain(self, lane: usize) -> f64 {
        self.0[lane]
    }

    fn with_plain(mut self, lane: usize, value: f64) -> Self {
        self.0[lane] = value;
        self
    }

    fn only(self, lane: usize) -> Self {
        Self::zero().with_plain(lane, self.0[lane])
    }
}

impl<const W: usize, const N: usize> Laned<W> for Jet<Lanes<W>, N> {
    fn plain(self, lane: usize) -> f64 {
        self.coefficient(0).0[lane]
    }

    fn with_plain(self, lane: usize, value: f64) -> Self {
        let part = |k| if k == 0 { value } else { 0.0 };
        Self::from_coefficients(std::array::from_fn(|k| {
            self.coefficient(k).with_plain(lane, part(k))
        }))
    }

    fn only(self, lane: usize) -> Self {
        Self::from_coefficients(std::array::from_fn(|k| self.coefficient(k).only(lane)))
    }
}

/// Solves one lane after the other, each with as many passes for its higher parts.
pub(super) fn lane_by_lane<T: Laned<W>, const W: usize>(
    block: &NewtonBlock,
    design: &Design<T>,
    branch: &Branch,
    state: &mut State<T>,
    passes: usize,
) -> T {
    let mechanism = &*design.mechanism;
    let mut determinant = T::from_f64(f64::NAN);
    for lane in 0..W {
        let part = |x: T| x.plain(lane);
        let plain = &design.plain[lane.min(design.plain.len() - 1)];
        let found = plain_part(block, mechanism, plain, branch, state, part);
        determinant = determinant.with_plain(lane, found);
        let put = |to: &mut T, from: f64| *to = to.with_plain(lane, from);
        for unknown in &block.unknowns {
            let body = unknown.body().index();
            let (wide, plain) = (&mut state.poses[body], &state.scratch.poses[body]);
            match unknown {
                Unknown::Angle(_) => {
                    put(&mut wide.c, plain.c);
                    put(&mut wide.s, plain.s);
                }
                Unknown::Place(_) => {
                    put(&mut wide.x, plain.x);
                    put(&mut wide.y, plain.y);
                }
            }
        }
        // With this lane's Jacobian; the other lanes stay where they are.
        let only = |row: T| row.only(lane);
        sharpen(block, design, branch, state, passes, only);
    }
    determinant
}
