//! Many poses at once: one design over a sweep of its motion, or many designs at the same places of a motion.
//!
//! Several poses run side by side in [`Lanes`], on the best vector instructions that the processor has. Every row has
//! the bits that the plan gives on plain `f64`, whatever the instructions, the executor or the row's neighbours.
//!
//! Output is by columns, as tables are: all `x` of the first point, all its `y`, all `x` of the second point, and so on;
//! m, in the frame.

use std::ops::Range;

use kempe_model::PointId;
use kempe_number::{InstructionSet, Jet, Lanes, Number, multiversion};

use crate::constraint::Input;
use crate::drive_path::DrivePath;
use crate::mechanism::{Marker, Mechanism};
use crate::motion::Motion;
use crate::newton::PlanNumber;
use crate::plan::Step;
use crate::state::{Branch, Design, State, input_of};

/// How many positions run side by side: two of the widest registers, so that one can go on while the other waits.
const WIDTH: usize = 16;
/// How many poses with derivatives run side by side.
const RATES_WIDTH: usize = 8;
/// Poses of a sweep handed to an executor at a time.
const POSES_PER_TASK: usize = 8192;
/// Designs handed to an executor at a time.
const DESIGNS_PER_TASK: usize = 64;

/// Why a batch cannot run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BatchError {
    /// No link carries the point.
    NoSuchPoint(PointId),
    /// A slice has the wrong length.
    Length {
        /// Which slice.
        what: &'static str,
        /// Its right length.
        expected: usize,
        /// Its length.
        got: usize,
    },
}

impl std::fmt::Display for BatchError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoSuchPoint(point) => write!(f, "no link carries point number {}", point.0),
            Self::Length {
                what,
                expected,
                got,
            } => write!(f, "{what}: expected {expected} numbers, got {got}"),
        }
    }
}

impl std::error::Error for BatchError {}

/// Parameter values of many designs (SI, all of the model's parameters in its order).
#[derive(Clone, Copy, Debug)]
pub struct Designs<'a> {
    /// The values.
    pub values: &'a [f64],
    /// How many designs.
    pub count: usize,
    /// How the values lie.
    pub layout: Layout,
}

/// How the values of many designs lie in one slice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// All parameters of the first design, then all of the second.
    ByDesign,
    /// The first parameter of all designs, then the second of all: columns.
    ByParameter,
}

/// A piece of a batch, to be run once; pieces do not depend on each other.
pub type Task<'a> = Box<dyn FnOnce() + Send + 'a>;

/// Runs the pieces of a batch. Results do not depend on the order or the number of threads.
pub trait Executor {
    /// Runs all tasks and returns when the last has ended.
    fn run(&self, tasks: Vec<Task<'_>>);
}

/// Runs one piece after the other.
#[derive(Clone, Copy, Debug, Default)]
pub struct Serial;

impl Executor for Serial {
    fn run(&self, tasks: Vec<Task<'_>>) {
        tasks.into_iter().for_each(|task| task());
    }
}

/// Runs pieces on this many threads of its own.
#[cfg(not(target_family = "wasm"))]
#[derive(Clone, Copy, Debug)]
pub struct Threads(pub usize);

#[cfg(not(target_family = "wasm"))]
impl Executor for Threads {
    fn run(&self, tasks: Vec<Task<'_>>) {
        let helpers = self.0.clamp(1, tasks.len().max(1)) - 1;
        let queue = std::sync::Mutex::new(tasks.into_iter());
        let next = || {
            let mut queue = queue.lock().unwrap_or_else(|held| held.into_inner());
            queue.next()
        };
        let work = || {
            while let Some(task) = next() {
                task();
            }
        };
        std::thread::scope(|scope| {
            for _ in 0..helpers {
                scope.spawn(work);
            }
            work();
        });
    }
}

/// Finds chosen points of a mechanism at many poses.
///
/// # Example
/// ```
/// use kempe_kinematics::batch::{Batch, Designs, Layout};
/// use kempe_kinematics::{Design, Mechanism, Motion, Plan};
///
/// let file = r#"
/// [parameters]
/// a = "20 mm"
/// [links]
/// frame = { A = [0, 0], D = ["60 mm", 0] }
/// crank = { A-B = "a" }
/// coupler = { B-C = "50 mm" }
/// rocker = { D-C = "40 mm" }
/// [drives]
/// motor = { turns = "crank", from = "0 deg", to = "360 deg", speed = "1 rad/s" }
/// "#;
/// let model = kempe_model::Model::from_toml(file, "four-bar", &mut |_| Err("no tables".into())).unwrap().model;
/// let mechanism = Mechanism::new(&model);
/// let plan = Plan::new(&mechanism);
/// let parameters: Vec<f64> = model.parameter_values();
/// let design = Design::new(&mechanism, &plan, &parameters);
/// let motion = Motion::new(&mechanism, &plan, &design, &parameters).unwrap();
///
/// let joint = model.points.iter().position(|p| p.name == "C").unwrap();
/// let batch = Batch::new(&motion, &[kempe_model::PointId(joint as u32)]).unwrap();
/// let mut places = [0.0; 6];
/// assert_eq!(batch.sweep(&[0.0, 1.0, 2.0], &mut places), Ok(3)); // x, x, x, y, y, y
///
/// // Two designs at one place; the second cannot be assembled there.
/// let designs = Designs { values: &[0.025, 0.200], count: 2, layout: Layout::ByParameter };
/// let mut places = [0.0; 4];
/// assert_eq!(batch.designs(designs, &[1.0], &mut places), Ok(1));
/// assert!(places[0].is_finite() && places[1].is_nan());
/// ```
#[derive(Clone, Debug)]
pub struct Batch<'a> {
    motion: &'a Motion<'a>,
    markers: Vec<Marker>,
    set: InstructionSet,
    stretches: Vec<Stretch>,
    needs_guess: bool,
}

/// A stretch of the path parameter with one set of assembly modes.
#[derive(Clone, Debug)]
struct Stretch {
    from: f64,
    /// First parameter beyond it.
    to: f64,
    branch: Branch,
}

impl<'a> Batch<'a> {
    /// Prepares for points of the motion's mechanism.
    ///
    /// # Errors
    /// [`BatchError::NoSuchPoint`].
    pub fn new(motion: &'a Motion<'a>, points: &[PointId]) -> Result<Self, BatchError> {
        let mechanism = motion.mechanism;
        let markers = (points.iter())
            .map(|&p| mechanism.any_marker(p).ok_or(BatchError::NoSuchPoint(p)))
            .collect::<Result<_, _>>()?;
        Ok(Self {
            motion,
            markers,
            set: InstructionSet::detect(),
            stretches: stretches(motion),
            needs_guess: motion.plan.steps.iter().any(Step::needs_guess),
        })
    }

    /// Uses these vector instructions at most. The results are the same.
    pub fn with_instructions(mut self, set: InstructionSet) -> Self {
        self.set = set;
        self
    }

    /// Columns of positions: two for each point.
    pub fn columns(&self) -> usize {
        2 * self.markers.len()
    }

    /// Places of the points at every one of these path parameters of the motion, on the motion's branch: columns of
    /// `parameters.len()` values. Beyond the motion's ends, and where the mechanism does not close, they are NaN.
    /// Returns how many poses do close.
    ///
    /// Redundant constraints are not looked at, and nothing is smoothed at change points: see
    /// [`Sampler`](crate::Sampler) for rows with evidence. Rising or falling parameters are the fastest. Mechanisms
    /// with Newton groups, gears or racks run pose by pose.
    ///
    /// # Errors
    /// [`BatchError::Length`] when `out` does not hold [`Batch::columns`] columns.
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
        self.sweep_orders(executor, parameters, out, 1, &|parameters, out| {
            if self.needs_guess {
                return sweep_one_by_one::<Lanes<WIDTH>, WIDTH>(self, parameters, out);
            }
            sweep_lanes::<Lanes<WIDTH>, WIDTH>(
                self,
                parameters,
                out,
                |design, block, state, rows| run_block(self.set, self, design, block, state, rows),
            )
        })
    }

    /// Places with their first and second derivatives to the path parameter: the columns of [`Batch::sweep`], then as
    /// many for the first derivatives, then for the second.
    ///
    /// # Errors
    /// [`BatchError::Length`] when `out` does not hold three times [`Batch::columns`] columns.
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
        self.sweep_orders(executor, parameters, out, 3, &|parameters, out| {
            if self.needs_guess {
                return sweep_one_by_one::<Rates, RATES_WIDTH>(self, parameters, out);
            }
            sweep_lanes::<Rates, RATES_WIDTH>(
                self,
                parameters,
                out,
                |design, block, state, rows| solve_block(self, design, block, state, rows),
            )
        })
    }

    fn sweep_orders(
        &self,
        executor: &impl Executor,
        parameters: &[f64],
        out: &mut [f64],
        orders: usize,
        piece: &SweepPiece<'_>,
    ) -> Result<usize, BatchError> {
        let columns = orders * self.columns();
        check_length("out", parameters.len() * columns, out.len())?;
        let mut closed = vec![0; parameters.len().div_ceil(POSES_PER_TASK)];
        let tasks = (parameters.chunks(POSES_PER_TASK))
            .zip(split_columns(out, parameters.len(), POSES_PER_TASK))
            .zip(&mut closed)
            .map(|((parameters, mut out), closed)| -> Task<'_> {
                Box::new(move || *closed = piece(parameters, &mut out))
            })
            .collect();
        executor.run(tasks);
        Ok(closed.iter().sum())
    }

    /// Places of the points for every design at every one of these path parameters, with the drive coordinates that
    /// the motion's own design has there: for each parameter in turn [`Batch::columns`] columns, each with one value
    /// per design. Where a design does not close they are NaN. Returns how many poses do close.
    ///
    /// Every design is on the branch that the motion has at that parameter: the same assembly modes, and in Newton
    /// groups the assembly that Newton's method reaches from the motion's pose. That is the branch a designer means as
    /// long as the designs lie close enough to the motion's own for no limit or change point to come between; whether
    /// a design reaches a pose *from its own start* is for its own [`Motion`] to say. Parameters beyond the motion's
    /// ends take the branch at that end.
    ///
    /// # Errors
    /// [`BatchError::Length`].
    pub fn designs(
        &self,
        designs: Designs<'_>,
        at: &[f64],
        out: &mut [f64],
    ) -> Result<usize, BatchError> {
        self.designs_on(&Serial, designs, at, out)
    }

    /// [`Batch::designs`] in pieces on an executor.
    ///
    /// # Errors
    /// As there.
    pub fn designs_on(
        &self,
        executor: &impl Executor,
        designs: Designs<'_>,
        at: &[f64],
        out: &mut [f64],
    ) -> Result<usize, BatchError> {
        let model = &self.motion.mechanism.model;
        check_length(
            "designs",
            designs.count * model.parameters.len(),
            designs.values.len(),
        )?;
        check_length("out", designs.count * at.len() * self.columns(), out.len())?;
        let mut solver = self.motion.solver::<f64>();
        let places: Vec<PlaceOfMotion> = (at.iter())
            .map(|&p| {
                self.motion.branch_at(p, &mut solver.branch);
                self.motion.path.coordinates(p, &mut solver.coordinates);
                PlaceOfMotion {
                    branch: solver.branch.clone(),
                    inputs: (model.drives.iter().zip(&solver.coordinates))
                        .map(|(drive, q)| input_of(drive, Lanes::from_f64(*q)))
                        .collect(),
                }
            })
            .collect();
        let places = places.as_slice();

        let mut closed = vec![0; designs.count.div_ceil(DESIGNS_PER_TASK)];
        let tasks = (split_columns(out, designs.count, DESIGNS_PER_TASK).into_iter())
            .zip(&mut closed)
            .enumerate()
            .map(|(task, (mut out, closed))| -> Task<'_> {
                let first = task * DESIGNS_PER_TASK;
                let count = DESIGNS_PER_TASK.min(designs.count - first);
                Box::new(move || {
                    *closed = design_lanes(self, designs, first..first + count, places, &mut out);
                })
            })
            .collect();
        executor.run(tasks);
        Ok(closed.iter().sum())
    }
}

/// Sweeps some parameters into the columns' parts for them; returns how many poses close.
type SweepPiece<'a> = dyn Fn(&[f64], &mut [&mut [f64]]) -> usize + Sync + 'a;

/// Positions and rates in lanes: values with derivatives of the first and second order.
type Rates = Jet<Lanes<RATES_WIDTH>, 3>;

/// A number with `W` lanes, each of which holds a value and perhaps its derivatives to the path parameter.
trait Wide<const W: usize>: PlanNumber {
    /// What one lane holds.
    type Lane: PlanNumber;

    /// The path parameter itself.
    fn seed(p: Lanes<W>) -> Self;

    /// The path parameter in one lane.
    fn seed_lane(p: f64) -> Self::Lane;

    /// The values (order 0) or derivatives of one order.
    fn order(self, order: usize) -> Lanes<W>;

    /// The same of one lane.
    fn order_of_lane(lane: Self::Lane, order: usize) -> f64;

    /// Puts one lane in its place.
    fn set_lane(&mut self, lane: usize, to: Self::Lane);
}

impl<const W: usize> Wide<W> for Lanes<W> {
    type Lane = f64;

    #[inline(always)]
    fn seed(p: Lanes<W>) -> Self {
        p
    }

    fn seed_lane(p: f64) -> f64 {
        p
    }

    #[inline(always)]
    fn order(self, _: usize) -> Lanes<W> {
        self
    }

    fn order_of_lane(lane: f64, _: usize) -> f64 {
        lane
    }

    fn set_lane(&mut self, lane: usize, to: f64) {
        self.0[lane] = to;
    }
}

impl<const W: usize, const N: usize> Wide<W> for Jet<Lanes<W>, N> {
    type Lane = Jet<f64, N>;

    #[inline(always)]
    fn seed(p: Lanes<W>) -> Self {
        Self::variable(p)
    }

    fn seed_lane(p: f64) -> Jet<f64, N> {
        Jet::variable(p)
    }

    #[inline(always)]
    fn order(self, order: usize) -> Lanes<W> {
        self.derivative(order)
    }

    fn order_of_lane(lane: Jet<f64, N>, order: usize) -> f64 {
        lane.derivative(order)
    }

    fn set_lane(&mut self, lane: usize, to: Jet<f64, N>) {
        *self = Self::from_coefficients(std::array::from_fn(|k| {
            let mut lanes = self.coefficient(k);
            lanes.0[lane] = to.coefficient(k);
            lanes
        }));
    }
}

/// What is solved side by side.
struct Block<'b, const W: usize> {
    branch: &'b Branch,
    /// Coordinates of the motion's moving drive, where they are not set yet.
    moving: Option<&'b [f64; W]>,
}

/// Where the results go: the lanes that are wanted, from `row` on in every column.
struct Rows<'r, 'c> {
    /// One bit for each lane.
    wanted: u32,
    row: usize,
    columns: &'r mut [&'c mut [f64]],
}

multiversion! {
    /// Solves and writes a block of positions; returns how many close.
    fn run_block(
        set: InstructionSet,
        batch: &Batch<'_>,
        design: &Design<Lanes<WIDTH>>,
        block: &Block<'_, WIDTH>,
        state: &mut State<Lanes<WIDTH>>,
        rows: Rows<'_, '_>,
    ) -> usize = solve_block;
}

#[inline(always)]
fn solve_block<T: Wide<W>, const W: usize>(
    batch: &Batch<'_>,
    design: &Design<T>,
    block: &Block<'_, W>,
    state: &mut State<T>,
    rows: Rows<'_, '_>,
) -> usize {
    let (mechanism, plan) = (batch.motion.mechanism, batch.motion.plan);
    if let (Some(p), DrivePath::Coordinate { drive, .. }) = (block.moving, &batch.motion.path) {
        set_moving(mechanism, *drive, T::seed(Lanes(*p)), state);
    }
    plan.solve(mechanism, design, block.branch, state);

    let Rows {
        wanted,
        row,
        columns,
    } = rows;
    let closing = closing(state, |x| x.order(0));
    let closed = count_closed(&closing.0, wanted);
    for (j, marker) in batch.markers.iter().enumerate() {
        let place = state.place(design, *marker);
        for (axis, part) in place.into_iter().enumerate() {
            let mut index = 2 * j + axis;
            for order in 0.. {
                let Some(column) = columns.get_mut(index) else {
                    break;
                };
                let values = part.order(order).0;
                match column.get_mut(row..row + W) {
                    Some(column) if closed == W => column.copy_from_slice(&values),
                    _ => write_some(&values, &closing.0, wanted, &mut column[row..]),
                }
                index += batch.columns();
            }
        }
    }
    closed
}

/// How many lanes are wanted and close. Called, so that the lanes go to memory as whole registers.
#[inline(never)]
fn count_closed(closing: &[f64], wanted: u32) -> usize {
    let mut bits = 0;
    for x in closing {
        bits |= x.to_bits();
    }
    let all = all_lanes(closing.len());
    // Zero has no bits.
    let closes = match bits {
        0 => all,
        _ => lanes_where(|lane| closing[lane] == 0.0, closing.len()),
    };
    (wanted & closes).count_ones() as usize
}

/// The lanes for which something holds, one bit for each.
#[inline(always)]
fn lanes_where(holds: impl Fn(usize) -> bool, lanes: usize) -> u32 {
    let mut mask = 0;
    for lane in 0..lanes {
        mask |= u32::from(holds(lane)) << lane;
    }
    mask
}

/// All of this many lanes.
const fn all_lanes(lanes: usize) -> u32 {
    u32::MAX >> (u32::BITS as usize - lanes)
}

/// Writes the lanes that are wanted, NaN where they do not close.
#[cold]
#[inline(never)]
fn write_some(values: &[f64], closing: &[f64], wanted: u32, out: &mut [f64]) {
    for (lane, out) in out.iter_mut().enumerate().take(values.len()) {
        if wanted >> lane & 1 == 1 {
            *out = if closing[lane] == 0.0 {
                values[lane]
            } else {
                f64::NAN
            };
        }
    }
}

/// Cuts every column of `rows` values into pieces, and gathers the pieces that belong together.
fn split_columns(out: &mut [f64], rows: usize, piece: usize) -> Vec<Vec<&mut [f64]>> {
    let mut pieces: Vec<Vec<&mut [f64]>> = Vec::new();
    pieces.resize_with(rows.div_ceil(piece), Vec::new);
    if rows > 0 {
        for column in out.chunks_mut(rows) {
            for (piece, part) in pieces.iter_mut().zip(column.chunks_mut(piece)) {
                piece.push(part);
            }
        }
    }
    pieces
}

fn check_length(what: &'static str, expected: usize, got: usize) -> Result<(), BatchError> {
    if expected == got {
        return Ok(());
    }
    Err(BatchError::Length {
        what,
        expected,
        got,
    })
}

/// Zero in every lane in which every body has a pose, NaN in the others. `part` takes out of a number what counts.
#[inline(always)]
fn closing<T: Number, U: Number>(state: &State<T>, part: impl Fn(T) -> U) -> U {
    let mut sum = U::zero();
    for pose in &state.poses[1..] {
        sum += (part(pose.x) + part(pose.c)) * 0.0;
    }
    sum
}

/// The motion's stretches with a margin at both ends; together they cover what the motion reaches.
fn stretches(motion: &Motion<'_>) -> Vec<Stretch> {
    let margin = motion.margin();
    let last = motion.node_parameters().last().copied();
    let mut list: Vec<Stretch> = Vec::new();
    for (from, signs) in motion.stretches() {
        let mut branch = Branch::neutral(motion.mechanism, motion.plan);
        branch.signs.copy_from_slice(signs);
        if let Some(before) = list.last_mut() {
            before.to = from;
        }
        list.push(Stretch {
            from,
            to: f64::INFINITY,
            branch,
        });
    }
    if let Some(first) = list.first_mut() {
        first.from -= margin;
    }
    if let (Some(stretch), Some(last)) = (list.last_mut(), last) {
        stretch.to = (last + margin).next_up();
    }
    list
}

impl Stretch {
    #[inline(always)]
    fn holds(&self, p: f64) -> bool {
        (self.from <= p) & (p < self.to)
    }

    /// Which of the lanes it holds, one bit for each.
    #[inline(always)]
    fn lanes<const W: usize>(&self, p: &[f64; W]) -> u32 {
        let mut outside = 0_u64;
        for p in p {
            outside |= u64::from(!self.holds(*p));
        }
        if outside == 0 {
            return all_lanes(W);
        }
        lanes_where(|lane| self.holds(p[lane]), W)
    }
}

/// The stretch in which `p` lies, tried at `cursor` first.
#[inline(always)]
fn find_stretch(stretches: &[Stretch], p: f64, cursor: &mut usize) -> bool {
    let within = |s: &Stretch| s.holds(p);
    if stretches.get(*cursor).is_some_and(within) {
        return true;
    }
    *cursor = stretches.partition_point(|s| s.from <= p).max(1) - 1;
    stretches.get(*cursor).is_some_and(within)
}

/// Sweeps the motion's own design, lanes over the parameter.
fn sweep_lanes<T: Wide<W>, const W: usize>(
    batch: &Batch<'_>,
    parameters: &[f64],
    columns: &mut [&mut [f64]],
    run: impl Fn(&Design<T>, &Block<'_, W>, &mut State<T>, Rows<'_, '_>) -> usize,
) -> usize {
    let (motion, design) = (batch.motion, &batch.motion.design.lift::<T>());
    let mut state: State<T> = State::new(motion.mechanism, motion.plan);
    set_held(motion, &mut state);
    let (mut cursor, mut closed) = (0, 0);
    for (index, part) in parameters.chunks(W).enumerate() {
        let row = index * W;
        let padded: [f64; W];
        let p = match part.first_chunk() {
            Some(whole) => whole,
            None => {
                // The last block repeats its last parameter.
                padded = std::array::from_fn(|lane| part[lane.min(part.len() - 1)]);
                &padded
            }
        };
        if let path @ DrivePath::Time { .. } = &motion.path {
            set_at_times(path, motion.mechanism, p, &mut state);
        }
        let mut wanted = all_lanes(part.len());
        // Nearly always one stretch holds all lanes; otherwise each that is touched is solved in turn.
        while wanted != 0 {
            let lane = wanted.trailing_zeros() as usize;
            if !find_stretch(&batch.stretches, p[lane], &mut cursor) {
                columns.iter_mut().for_each(|c| c[row + lane] = f64::NAN);
                wanted &= !(1 << lane);
                continue;
            }
            let stretch = &batch.stretches[cursor];
            let mine = wanted & stretch.lanes(p);
            let block = Block {
                branch: &stretch.branch,
                moving: Some(p),
            };
            let rows = Rows {
                wanted: mine,
                row,
                columns,
            };
            closed += run(design, &block, &mut state, rows);
            wanted &= !mine;
        }
    }
    closed
}

/// Mechanisms whose branch is more than signs: one pose after the other.
fn sweep_one_by_one<T: Wide<W>, const W: usize>(
    batch: &Batch<'_>,
    parameters: &[f64],
    out: &mut [&mut [f64]],
) -> usize {
    let motion = batch.motion;
    let design = motion.design.lift::<T::Lane>();
    let mut closed = 0;
    sweep_states(motion, &design, parameters, T::seed_lane, |row, state| {
        closed += usize::from(state.is_some());
        for (index, column) in out.iter_mut().enumerate() {
            let (order, rest) = (index / batch.columns(), index % batch.columns());
            column[row] = state.map_or(f64::NAN, |state| {
                let place = state.place(&design, batch.markers[rest / 2]);
                T::order_of_lane(place[rest % 2], order)
            });
        }
    });
    closed
}

/// Sets all drives to where they are at the start of the motion.
fn set_held<T: Number>(motion: &Motion<'_>, state: &mut State<T>) {
    let mut coordinates = vec![T::zero(); state.inputs.len()];
    (motion.path).coordinates(T::from_f64(motion.start), &mut coordinates);
    state.set_inputs(motion.mechanism, &coordinates);
}

/// Sets the moving drive.
#[inline(always)]
fn set_moving<T: Number>(mechanism: &Mechanism, drive: usize, p: T, state: &mut State<T>) {
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
    state: &mut State<T>,
) {
    let drives = state.inputs.len();
    let mut values = vec![T::zero(); drives];
    let mut one = vec![T::Lane::zero(); drives];
    for (lane, time) in times.iter().enumerate() {
        path.coordinates(T::seed_lane(*time), &mut one);
        for (value, q) in values.iter_mut().zip(&one) {
            value.set_lane(lane, *q);
        }
    }
    state.set_inputs(mechanism, &values);
}

/// What designs take from the motion at one path parameter.
struct PlaceOfMotion {
    branch: Branch,
    inputs: Vec<Input<Lanes<WIDTH>>>,
}

/// Solves some of the designs, lanes over the designs.
fn design_lanes(
    batch: &Batch<'_>,
    designs: Designs<'_>,
    range: Range<usize>,
    places: &[PlaceOfMotion],
    out: &mut [&mut [f64]],
) -> usize {
    let (mechanism, plan) = (batch.motion.mechanism, batch.motion.plan);
    let mut state: State<Lanes<WIDTH>> = State::new(mechanism, plan);
    let mut design = batch.motion.design.lift::<Lanes<WIDTH>>();
    let mut parameters = vec![Lanes::zero(); mechanism.model.parameters.len()];
    // Swapped in and out: cheaper than a copy.
    let mut inputs: Vec<_> = places.iter().map(|place| place.inputs.clone()).collect();
    let columns = batch.columns();
    let mut closed = 0;
    for row in (0..range.len()).step_by(WIDTH) {
        let first = range.start + row;
        for (k, parameter) in parameters.iter_mut().enumerate() {
            *parameter = Lanes::from_fn(|lane| designs.value((first + lane).min(range.end - 1), k));
        }
        design.update(mechanism, plan, &parameters);
        if batch.needs_guess {
            // Newton's method wants each of them on its own as well.
            let lane = |lane: usize| move |x: Lanes<WIDTH>| x.lane(lane);
            design.plain = (0..WIDTH).map(|k| design.geometry.map(lane(k))).collect();
        }
        let wanted = all_lanes(WIDTH.min(range.end - first));
        for (k, place) in places.iter().enumerate() {
            std::mem::swap(&mut state.inputs, &mut inputs[k]);
            let block = Block {
                branch: &place.branch,
                moving: None,
            };
            let rows = Rows {
                wanted,
                row,
                columns: &mut out[k * columns..(k + 1) * columns],
            };
            closed += run_block(batch.set, batch, &design, &block, &mut state, rows);
            std::mem::swap(&mut state.inputs, &mut inputs[k]);
        }
    }
    closed
}

impl Designs<'_> {
    /// A parameter of a design.
    #[inline(always)]
    fn value(&self, design: usize, parameter: usize) -> f64 {
        let parameters = self.values.len() / self.count;
        match self.layout {
            Layout::ByDesign => self.values[design * parameters + parameter],
            Layout::ByParameter => self.values[parameter * self.count + design],
        }
    }
}

/// Solves the poses at path parameters of a motion one after the other, on any number, and hands each state to `each`
/// with the row's index; `None` where the parameter is beyond the motion's ends or the pose does not close.
///
/// `seed` makes the number from the path parameter: itself for positions, `Jet::variable` for rates along the path.
/// The same solves as [`Motion::solve`], without looking up the branch anew for every row.
///
/// # Example
/// Speeds and accelerations, per rad of the drive: `sweep_states(&motion, &design, &angles, Jet::<f64, 3>::variable,
/// |row, state| ...)` with a `Design<Jet<f64, 3>>`.
#[inline]
pub fn sweep_states<T: PlanNumber>(
    motion: &Motion<'_>,
    design: &Design<T>,
    parameters: &[f64],
    seed: impl Fn(f64) -> T,
    mut each: impl FnMut(usize, Option<&State<T>>),
) {
    let needs_guess = motion.plan.steps.iter().any(Step::needs_guess);
    let stretches = stretches(motion);
    let mut solver = motion.solver::<T>();
    set_held(motion, &mut solver.state);
    let mut cursor = 0;
    for (row, &p) in parameters.iter().enumerate() {
        if !find_stretch(&stretches, p, &mut cursor) {
            each(row, None);
            continue;
        }
        motion.path.coordinates(seed(p), &mut solver.coordinates);
        solver
            .state
            .set_inputs(motion.mechanism, &solver.coordinates);
        let branch = if needs_guess {
            motion.branch_at(p, &mut solver.branch);
            &solver.branch
        } else {
            &stretches[cursor].branch
        };
        (motion.plan).solve(motion.mechanism, design, branch, &mut solver.state);
        let closes = closing(&solver.state, T::value) == 0.0;
        each(row, closes.then_some(&solver.state));
    }
}
