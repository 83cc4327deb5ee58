//! Blocks without a closed form: Newton's method on plain numbers, then carried over to richer ones.

use kempe_number::{Dual, Jet, Lanes, Number};

use crate::blocks::{Unknown, for_each_constraint};
use crate::constraint::Situation;
use crate::geometry::Geometry;
use crate::mechanism::Mechanism;
use crate::plan::NewtonBlock;
use crate::pose::Pose;
use crate::qr::Qr;
use crate::state::{Branch, Design, State};

/// A scaled step below this is taken as converged (one more step is made after it).
pub const NEWTON_STEP: f64 = 1e-9;
/// Newton steps before a block is given up.
pub const NEWTON_LIMIT: usize = 30;

/// A number a plan can run on: it knows how to solve a block that has no closed form.
pub trait PlanNumber: Number {
    /// Solves a block from the branch's guess; returns its determinant. What cannot be solved becomes NaN.
    fn solve_newton(
        block: &NewtonBlock,
        mechanism: &Mechanism,
        design: &Design<Self>,
        branch: &Branch,
        state: &mut State<Self>,
    ) -> Self;
}

impl PlanNumber for f64 {
    fn solve_newton(
        block: &NewtonBlock,
        mechanism: &Mechanism,
        design: &Design<f64>,
        branch: &Branch,
        state: &mut State<f64>,
    ) -> f64 {
        start(block, branch, &mut state.poses);
        let scratch = &mut state.scratch;
        plain_newton(
            block,
            mechanism,
            &design.geometry,
            &state.inputs,
            branch,
            &mut state.poses,
            &mut scratch.qr,
            &mut scratch.rhs,
        )
    }
}

/// Numbers whose block is solved elsewhere: `passes` more after the plain solve, or lane by lane.
macro_rules! plan_number {
    ($([$($generics:tt)*] $type:ty = $solve:ident($($more:expr),*);)*) => {$(
        impl<$($generics)*> PlanNumber for $type {
            fn solve_newton(
                block: &NewtonBlock,
                mechanism: &Mechanism,
                design: &Design<Self>,
                branch: &Branch,
                state: &mut State<Self>,
            ) -> Self {
                $solve(block, mechanism, design, branch, state, $($more),*)
            }
        }
    )*};
}

// Every pass makes one more coefficient exact.
plan_number! {
    [const N: usize] Jet<f64, N> = carry_over(N);
    [const K: usize, const N: usize] Jet<Dual<f64, K>, N> = carry_over(N + 1);
    [const K: usize] Dual<f64, K> = carry_over(1);
    [const W: usize] Lanes<W> = lane_by_lane(0);
    [const W: usize, const N: usize] Jet<Lanes<W>, N> = lane_by_lane(N);
}

/// A number whose parts are lanes, so that one lane can be looked at alone.
trait Laned<const W: usize>: Number {
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
fn lane_by_lane<T: Laned<W>, const W: usize>(
    block: &NewtonBlock,
    mechanism: &Mechanism,
    design: &Design<T>,
    branch: &Branch,
    state: &mut State<T>,
    passes: usize,
) -> T {
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
        sharpen(block, mechanism, design, branch, state, passes, only);
    }
    determinant
}

/// Solves on plain numbers, then makes the higher parts exact.
fn carry_over<T: PlanNumber>(
    block: &NewtonBlock,
    mechanism: &Mechanism,
    design: &Design<T>,
    branch: &Branch,
    state: &mut State<T>,
    passes: usize,
) -> T {
    let plain = &design.plain[0];
    let determinant = plain_part(block, mechanism, plain, branch, state, T::value);
    for unknown in &block.unknowns {
        let body = unknown.body().index();
        let (rich, plain) = (&mut state.poses[body], &state.scratch.poses[body]);
        match unknown {
            Unknown::Angle(_) => (rich.c, rich.s) = (T::from_f64(plain.c), T::from_f64(plain.s)),
            Unknown::Place(_) => (rich.x, rich.y) = (T::from_f64(plain.x), T::from_f64(plain.y)),
        }
    }
    sharpen(block, mechanism, design, branch, state, passes, |row| row);
    T::from_f64(determinant)
}

/// Solves on the plain numbers that `part` takes out, into the plain poses of the scratch; returns the determinant.
fn plain_part<T: Number>(
    block: &NewtonBlock,
    mechanism: &Mechanism,
    geometry: &Geometry<f64>,
    branch: &Branch,
    state: &mut State<T>,
    part: impl Fn(T) -> f64,
) -> f64 {
    let State {
        inputs,
        poses,
        scratch,
        ..
    } = state;
    for (plain, rich) in scratch.poses.iter_mut().zip(poses.iter()) {
        *plain = Pose {
            x: part(rich.x),
            y: part(rich.y),
            c: part(rich.c),
            s: part(rich.s),
        };
    }
    for (plain, rich) in scratch.inputs.iter_mut().zip(inputs.iter()) {
        (plain.value, plain.c, plain.s) = (part(rich.value), part(rich.c), part(rich.s));
    }
    start(block, branch, &mut scratch.poses);
    plain_newton(
        block,
        mechanism,
        geometry,
        &scratch.inputs,
        branch,
        &mut scratch.poses,
        &mut scratch.qr,
        &mut scratch.rhs,
    )
}

/// Makes higher parts exact: with the inverse of the plain Jacobian last factored every pass of the simplified Newton
/// iteration x <- x - J0^-1 F(x) corrects one more order of a nilpotent number. `take` is what counts of a row.
fn sharpen<T: Number>(
    block: &NewtonBlock,
    mechanism: &Mechanism,
    design: &Design<T>,
    branch: &Branch,
    state: &mut State<T>,
    passes: usize,
    take: impl Fn(T) -> T,
) {
    let State {
        inputs,
        poses,
        scratch,
        ..
    } = state;
    let rhs = &mut scratch.wide_rhs[..block.rows.len()];
    for _ in 0..passes {
        let situation = Situation {
            geometry: &design.geometry,
            inputs,
            poses,
            near: &branch.near,
        };
        fill_residuals(block, mechanism, &situation, rhs);
        rhs.iter_mut().for_each(|row| *row = take(*row));
        scratch.qr.solve(rhs);
        apply_step(block, poses, &rhs[..block.size]);
    }
}

fn start(block: &NewtonBlock, branch: &Branch, poses: &mut [Pose<f64>]) {
    for unknown in &block.unknowns {
        let body = unknown.body().index();
        let (pose, guess) = (&mut poses[body], &branch.guess[body]);
        match unknown {
            Unknown::Angle(_) => (pose.c, pose.s) = (guess.c, guess.s),
            Unknown::Place(_) => (pose.x, pose.y) = (guess.x, guess.y),
        }
    }
}

/// Fills the block's Jacobian into `qr` and factors it.
pub(crate) fn factor_block(
    block: &NewtonBlock,
    mechanism: &Mechanism,
    situation: &Situation<'_, f64>,
    qr: &mut Qr,
) {
    qr.reset(block.rows.len(), block.size);
    for_each_constraint(&block.rows, |constraint, at| {
        situation.gradients(&mechanism.constraints[constraint].0, |gradient| {
            let Some(row) = at[gradient.row] else { return };
            for (unknown, &column) in block.unknowns.iter().zip(&block.columns) {
                if unknown.body() != gradient.body {
                    continue;
                }
                match unknown {
                    Unknown::Angle(_) => qr.add(row, column, gradient.to[2]),
                    Unknown::Place(_) => {
                        qr.add(row, column, gradient.to[0]);
                        qr.add(row, column + 1, gradient.to[1]);
                    }
                }
            }
        });
    });
    qr.factor();
}

fn fill_residuals<T: Number>(
    block: &NewtonBlock,
    mechanism: &Mechanism,
    situation: &Situation<'_, T>,
    rhs: &mut [T],
) {
    for_each_constraint(&block.rows, |constraint, at| {
        let rows = situation.residual(&mechanism.constraints[constraint].0);
        for k in 0..2 {
            if let Some(place) = at[k] {
                rhs[place] = rows[k];
            }
        }
    });
}

fn apply_step<T: Number>(block: &NewtonBlock, poses: &mut [Pose<T>], step: &[T]) {
    for (unknown, &column) in block.unknowns.iter().zip(&block.columns) {
        let pose = &mut poses[unknown.body().index()];
        *pose = match unknown {
            Unknown::Angle(_) => pose.moved(T::zero(), T::zero(), -step[column]),
            Unknown::Place(_) => Pose {
                x: pose.x - step[column],
                y: pose.y - step[column + 1],
                ..*pose
            },
        };
    }
}

/// Keeps the direction a unit vector against rounding.
fn normalise(block: &NewtonBlock, poses: &mut [Pose<f64>]) {
    for unknown in &block.unknowns {
        if let Unknown::Angle(body) = unknown {
            let pose = &mut poses[body.index()];
            let size = (pose.c * pose.c + pose.s * pose.s).sqrt();
            (pose.c, pose.s) = (pose.c / size, pose.s / size);
        }
    }
}

#[allow(
    clippy::too_many_arguments,
    reason = "the parts of a state, borrowed apart"
)]
fn plain_newton(
    block: &NewtonBlock,
    mechanism: &Mechanism,
    geometry: &Geometry<f64>,
    inputs: &[crate::constraint::Input<f64>],
    branch: &Branch,
    poses: &mut [Pose<f64>],
    qr: &mut Qr,
    rhs: &mut [f64],
) -> f64 {
    let rhs = &mut rhs[..block.rows.len()];
    let mut converged = false;
    for _ in 0..NEWTON_LIMIT {
        let situation = Situation {
            geometry,
            inputs,
            poses,
            near: &branch.near,
        };
        fill_residuals(block, mechanism, &situation, rhs);
        factor_block(block, mechanism, &situation, qr);
        qr.solve(rhs);
        let size = scaled_size(block, poses, &rhs[..block.size]);
        if !size.is_finite() {
            break;
        }
        apply_step(block, poses, &rhs[..block.size]);
        normalise(block, poses);
        if converged {
            return qr.determinant();
        }
        converged = size <= NEWTON_STEP;
    }
    for unknown in &block.unknowns {
        poses[unknown.body().index()] = Pose {
            x: f64::NAN,
            y: f64::NAN,
            c: f64::NAN,
            s: f64::NAN,
        };
    }
    f64::NAN
}

/// Largest part of a step: angles in rad, lengths against the largest coordinate.
fn scaled_size(block: &NewtonBlock, poses: &[Pose<f64>], step: &[f64]) -> f64 {
    let mut length = 0.0_f64;
    let mut reach = f64::MIN_POSITIVE;
    let mut angle = 0.0_f64;
    let mut bad = false;
    for (unknown, &column) in block.unknowns.iter().zip(&block.columns) {
        match unknown {
            Unknown::Angle(_) => {
                bad |= !step[column].is_finite();
                angle = angle.max(step[column].abs());
            }
            Unknown::Place(body) => {
                let pose = &poses[body.index()];
                bad |= !(step[column].is_finite() && step[column + 1].is_finite());
                length = length.max(step[column].abs()).max(step[column + 1].abs());
                reach = reach.max(pose.x.abs()).max(pose.y.abs());
            }
        }
    }
    if bad {
        f64::NAN
    } else {
        angle.max(length / reach)
    }
}
