//! One design over a sweep of its motion.

use kempe_mechanism::Mechanism;
use kempe_mechanism::PlanNumber;
use kempe_mechanism::plan::Step;
use kempe_mechanism::{Branch, Configuration, Design, configuration::input_of};
use kempe_number::{InstructionSet, Jet, Lanes, Number, multiversion};

use crate::batch::{Batch, PARTS};
use crate::columns::{Target, check_length, closes, parts, split_columns, write_places};
use crate::error::BatchError;
use crate::executor::{Executor, Serial, Task};
use crate::mask::all_lanes;
use crate::stretch::{find_stretch, stretches};
use crate::wide::{Single, Wide};
use kempe_motion::Motion;
use kempe_motion::drive_path::DrivePath;

/// Poses of a sweep handed to an executor at a time.
const POSES_PER_TASK: usize = 8192;
/// How many plain states take every step of the plan together.
const PLAIN_STATES: usize = 16;

impl Batch {
    /// Places of the points at every one of these path parameters of the motion, on the motion's branch: columns of
    /// `parameters.len()` values. Beyond the motion's ends, and where the mechanism does not close, they are NaN.
    /// Returns how many poses do close.
    ///
    /// Redundant constraints are not looked at, and nothing is smoothed at change points: see
    /// `Sampler` of `kempe-measure` for rows with evidence. Rising or falling parameters are the fastest. Mechanisms
    /// with Newton groups, gears or racks run pose by pose.
    ///
    /// # Errors
    /// [`BatchError::Length`] when `out` does not hold [`Batch::columns`] columns.
    #[inline]
    pub fn sweep(&self, parameters: &[f64], out: &mut [f64]) -> Result<usize, BatchError> {
        self.sweep_on(&Serial, parameters, out)
    }

    /// [`Batch::sweep`] in pieces on an executor.
    ///
    /// # Errors
    /// As there.
    pub fn sweep_on(
        &self,
        executor: &impl Executor,
        parameters: &[f64],
        out: &mut [f64],
    ) -> Result<usize, BatchError> {
        let pieces = [sweep_positions, sweep_one_by_one::<f64>];
        self.sweep_orders(executor, parameters, out, 1, pieces)
    }

    /// Places with their first and second derivatives to the path parameter: the columns of [`Batch::sweep`], then as
    /// many for the first derivatives, then for the second.
    ///
    /// # Errors
    /// [`BatchError::Length`] when `out` does not hold three times [`Batch::columns`] columns.
    #[inline]
    pub fn sweep_rates(&self, parameters: &[f64], out: &mut [f64]) -> Result<usize, BatchError> {
        self.sweep_rates_on(&Serial, parameters, out)
    }

    /// [`Batch::sweep_rates`] in pieces on an executor.
    ///
    /// # Errors
    /// As there.
    pub fn sweep_rates_on(
        &self,
        executor: &impl Executor,
        parameters: &[f64],
        out: &mut [f64],
    ) -> Result<usize, BatchError> {
        let pieces = [sweep_rates, sweep_one_by_one::<Jet<f64, 3>>];
        self.sweep_orders(executor, parameters, out, 3, pieces)
    }

    fn sweep_orders(
        &self,
        executor: &impl Executor,
        parameters: &[f64],
        out: &mut [f64],
        orders: usize,
        [lanes, one_by_one]: [SweepPiece; 2],
    ) -> Result<usize, BatchError> {
        let columns = orders * self.columns();
        let piece = match self.needs_guess || !self.determinants.is_empty() {
            true => one_by_one,
            false => lanes,
        };
        check_length("out", parameters.len() * columns, out.len())?;
        let mut closed = vec![0; parameters.len().div_ceil(POSES_PER_TASK)];
        let tasks = (parameters.chunks(POSES_PER_TASK))
            .zip(split_columns(out, parameters.len(), POSES_PER_TASK))
            .zip(&mut closed)
            .map(|((parameters, mut out), closed)| -> Task<'_> {
                Box::new(move || *closed = piece(self.set, self, parameters, &mut out))
            })
            .collect();
        executor.run(tasks);
        Ok(closed.iter().sum())
    }
}

/// Sweeps some parameters into the columns' parts for them; returns how many poses close.
type SweepPiece = fn(InstructionSet, &Batch, &[f64], &mut [&mut [f64]]) -> usize;

multiversion! {
    /// Sweeps positions in lanes; returns how many poses close. Two of the widest registers
    /// side by side, fewer lanes where all are narrow, and as many states together as the nearest cache holds. Compiled where it is called.
    #[inline]
    pub(super) fn sweep_positions(
        set: InstructionSet,
        batch: &Batch,
        parameters: &[f64],
        columns: &mut [&mut [f64]],
    ) -> usize = sweep_lanes::<Lanes<16>, 16, 4>, baseline = sweep_lanes::<Lanes<8>, 8, 8>;
}

multiversion! {
    /// Sweeps positions with their first and second derivatives in lanes; returns how many poses close. One of the
    /// widest registers for every order. Compiled where it is called.
    #[inline]
    pub(super) fn sweep_rates(
        set: InstructionSet,
        batch: &Batch,
        parameters: &[f64],
        columns: &mut [&mut [f64]],
    ) -> usize = sweep_lanes::<Jet<Lanes<8>, 3>, 8, 4>;
}

/// Sweeps the motion's own design, lanes over the parameter, `M` states with `W` lanes at a time.
#[cfg_attr(not(debug_assertions), inline(always))]
fn sweep_lanes<T: Wide<W>, const W: usize, const M: usize>(
    batch: &Batch,
    parameters: &[f64],
    columns: &mut [&mut [f64]],
) -> usize {
    let motion = &*batch.motion;
    let (mechanism, design) = (motion.mechanism(), &motion.design.lift(T::from_f64));
    let order = &batch.order;
    let mut states = held_states::<T>(motion, M);
    order.solve_once(&order.fixed, design, &mut states);
    let mut padded = [[0.0; W]; M];
    let (mut cursor, mut closed) = (0, 0);
    for (block, part) in parameters.chunks(M * W).enumerate() {
        let states = &mut states[..part.len().div_ceil(W)];
        let at = match part.as_chunks() {
            (whole, []) => whole,
            _ => {
                // The last block repeats its last parameter.
                for (k, p) in padded.as_flattened_mut().iter_mut().enumerate() {
                    *p = part[k.min(part.len() - 1)];
                }
                &padded[..states.len()]
            }
        };
        for (state, at) in states.iter_mut().zip(at) {
            match &motion.path {
                DrivePath::Coordinate { drive, .. } => {
                    set_moving(mechanism, *drive, T::seed(Lanes(*at)), state);
                }
                path => set_at_times(path, mechanism, at, state),
            }
        }
        let mut wanted = [Target::default(); M];
        for (m, target) in wanted.iter_mut().enumerate().take(states.len()) {
            target.row = (block * M + m) * W;
            target.wanted = all_lanes(W.min(parameters.len() - target.row));
        }
        while let Some(targets) = next_stretch(batch, at, &mut wanted, &mut cursor, columns) {
            let branch = &batch.stretches[cursor].branch;
            let steps = order.moving.iter().copied();
            (order.plan).solve_all::<T, false>(steps, design, branch, states);
            closed += write_places(batch, design, branch, &[], states, &targets, columns);
        }
    }
    closed
}

/// Finds a stretch for `cursor` in which wanted lanes lie, and takes them from those wanted; lanes that lie in none
/// become NaN. Nearly always one stretch holds them all.
#[inline(never)]
fn next_stretch<const W: usize, const M: usize>(
    batch: &Batch,
    at: &[[f64; W]],
    wanted: &mut [Target; M],
    cursor: &mut usize,
    columns: &mut [&mut [f64]],
) -> Option<[Target; M]> {
    while let Some(m) = wanted.iter().position(|target| target.wanted != 0) {
        let lane = wanted[m].wanted.trailing_zeros() as usize;
        if !find_stretch(&batch.stretches, at[m][lane], cursor) {
            let row = wanted[m].row + lane;
            columns.iter_mut().for_each(|c| c[row] = f64::NAN);
            wanted[m].wanted &= !(1 << lane);
            continue;
        }
        let stretch = &batch.stretches[*cursor];
        let mut mine = *wanted;
        if !stretch.holds_all(at.as_flattened()) {
            for (mine, at) in mine.iter_mut().zip(at) {
                mine.wanted &= stretch.lanes(at);
            }
        }
        for (rest, mine) in wanted.iter_mut().zip(&mine) {
            rest.wanted &= !mine.wanted;
        }
        return Some(mine);
    }
    None
}

/// Sweeps mechanisms whose branch is more than signs: one pose after the other.
pub(super) fn sweep_one_by_one<T: Single>(
    _: InstructionSet,
    batch: &Batch,
    parameters: &[f64],
    out: &mut [&mut [f64]],
) -> usize {
    let motion = &*batch.motion;
    let design = motion.design.lift(T::from_f64);
    let mut closed = 0;
    sweep_states(motion, &design, parameters, T::seed, |row, state| {
        closed += usize::from(state.is_some());
        for (index, column) in out.iter_mut().enumerate() {
            let (order, rest) = (index / batch.columns(), index % batch.columns());
            column[row] = state.map_or(f64::NAN, |state| {
                let beyond = rest.checked_sub(2 * batch.markers.len());
                let told = match beyond {
                    None => state.place(&design, batch.markers[rest / 2])[rest % 2],
                    Some(part) => match batch.bodies.get(part / PARTS) {
                        Some(body) => parts(&state.poses[*body])[part % PARTS],
                        None => {
                            let which = part - PARTS * batch.bodies.len();
                            state.determinants[batch.determinants[which]]
                        }
                    },
                };
                told.order(order)
            });
        }
    });
    closed
}

/// States with all drives where they are at the start of the motion.
#[inline(never)]
fn held_states<T: Number>(motion: &Motion, count: usize) -> Vec<Configuration<T>> {
    let mut coordinates = vec![T::zero(); motion.mechanism().model.drives.len()];
    (motion.path).coordinates(T::from_f64(motion.start), &mut coordinates);
    let mut state = Configuration::new(motion.mechanism()).without_determinants();
    state.set_inputs(motion.mechanism(), &coordinates);
    vec![state; count]
}

/// Sets the moving drive.
#[cfg_attr(not(debug_assertions), inline(always))]
fn set_moving<T: Number>(mechanism: &Mechanism, drive: usize, p: T, state: &mut Configuration<T>) {
    if let (Some(input), Some(drive)) = (
        state.inputs.get_mut(drive),
        mechanism.model.drives.get(drive),
    ) {
        *input = input_of(drive, p);
    }
}

/// Motion laws branch on time, so every lane is asked for on its own.
#[cold]
#[inline(never)]
fn set_at_times<T: Wide<W>, const W: usize>(
    path: &DrivePath,
    mechanism: &Mechanism,
    times: &[f64; W],
    state: &mut Configuration<T>,
) {
    let drives = state.inputs.len();
    let mut values = vec![T::zero(); drives];
    let mut one = vec![T::Lane::zero(); drives];
    for (lane, time) in times.iter().enumerate() {
        path.coordinates(T::Lane::seed(*time), &mut one);
        for (value, q) in values.iter_mut().zip(&one) {
            value.set_lane(lane, *q);
        }
    }
    state.set_inputs(mechanism, &values);
}

/// Solves the poses at path parameters of a motion one by one, on any number, and hands each state to `each`
/// with the row's index; `None` where the parameter is beyond the motion's ends or the pose does not close.
///
/// `seed` makes the number from the path parameter: itself for positions, `Jet::variable` for rates along the path.
/// The same solves as [`Motion::solve`], without looking up the branch anew for every row; the states hold no determinants
/// of Newton groups.
///
/// # Example
/// Speeds and accelerations, per rad of the drive: `sweep_states(&motion, &design, &angles, Jet::<f64, 3>::variable,
/// |row, state| ...)` with a `Design<Jet<f64, 3>>`.
#[inline]
pub fn sweep_states<T: PlanNumber>(
    motion: &Motion,
    design: &Design<T>,
    parameters: &[f64],
    seed: impl Fn(f64) -> T,
    mut each: impl FnMut(usize, Option<&Configuration<T>>),
) {
    let mechanism = motion.mechanism();
    let plan = &mechanism.plan;
    let needs_guess = plan.steps.iter().any(Step::needs_guess);
    let together = if needs_guess { 1 } else { PLAIN_STATES };
    let stretches = stretches(motion);
    let mut guessed = Branch::neutral(mechanism);
    let mut states = held_states::<T>(motion, together);
    let mut coordinates = vec![T::zero(); mechanism.model.drives.len()];
    let (mut cursor, mut row) = (0, 0);
    while let Some(&p) = parameters.get(row) {
        if !find_stretch(&stretches, p, &mut cursor) {
            each(row, None);
            row += 1;
            continue;
        }
        let stretch = &stretches[cursor];
        let mut count = 0;
        for (state, &p) in states.iter_mut().zip(&parameters[row..]) {
            if !stretch.holds(p) {
                break;
            }
            match &motion.path {
                DrivePath::Coordinate { drive, .. } => {
                    set_moving(mechanism, *drive, seed(p), state)
                }
                path => {
                    path.coordinates(seed(p), &mut coordinates);
                    state.set_inputs(mechanism, &coordinates);
                }
            }
            count += 1;
        }
        let branch = if needs_guess {
            motion.branch_at(p, &mut guessed);
            &guessed
        } else {
            &stretch.branch
        };
        let steps = 0..plan.steps.len();
        plan.solve_all::<T, true>(steps, design, branch, &mut states[..count]);
        for state in &states[..count] {
            each(row, closes(state).then_some(state));
            row += 1;
        }
    }
}
