//! Many poses at once: one design over a sweep of its motion, or many designs at the same places of a motion.
//!
//! Several poses run side by side in [`Lanes`](kempe_number::Lanes), on the best vector instructions that the processor
//! has. Every row has the bits that the plan gives on plain `f64`, whatever the instructions, the executor or the row's
//! neighbours.
//!
//! Output is by columns, as tables are: all `x` of the first point, all its `y`, all `x` of the second point, and so on;
//! m, in the frame.

mod columns;
mod designs;
mod executor;
mod order;
mod stretch;
mod sweep;
mod wide;
mod workspace;

use std::sync::Arc;

use kempe_model::PointId;
use kempe_number::{InstructionSet, Jet};

pub use self::designs::{Designs, Layout};
#[cfg(not(target_family = "wasm"))]
pub use self::executor::Threads;
pub use self::executor::{Executor, Serial, Task};
pub use self::sweep::sweep_states;

use kempe_mechanism::plan::Step;
use kempe_mechanism::structure::{BodyId, Marker};

use self::columns::{PARTS, check_length, split_columns};
use self::designs::{Places, Work, solve_designs, solve_guessed, solve_trees};
use self::order::Order;
use self::stretch::{ModeStretch, stretches};
use self::sweep::{sweep_one_by_one, sweep_positions, sweep_rates};
use self::workspace::Kept;
use kempe_motion::Motion;

/// Poses of a sweep handed to an executor at a time.
const POSES_PER_TASK: usize = 8192;
/// Designs handed to an executor at a time.
const DESIGNS_PER_TASK: usize = 1024;

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

/// Finds chosen points of a mechanism at many poses. Storage for many designs is kept from call to call; a copy begins without any.
///
/// # Example
/// ```
/// use kempe_batch::{Batch, Designs, Layout};
/// use kempe_mechanism::{Design, Mechanism};
/// use kempe_motion::Motion;
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
/// let parameters: Vec<f64> = model.parameter_values();
/// let design = Design::new(&mechanism, &parameters);
/// let motion = Motion::new(&design).unwrap();
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
pub struct Batch {
    motion: Arc<Motion>,
    markers: Vec<Marker>,
    bodies: Vec<usize>,
    /// Steps of the plan whose determinants are told.
    determinants: Vec<usize>,
    set: InstructionSet,
    stretches: Vec<ModeStretch>,
    needs_guess: bool,
    order: Order,
    kept: Kept,
}

impl Batch {
    /// Prepares for points of the motion's mechanism.
    ///
    /// # Errors
    /// [`BatchError::NoSuchPoint`].
    pub fn new(motion: &Arc<Motion>, points: &[PointId]) -> Result<Self, BatchError> {
        Self::with_bodies(motion, points, &[])
    }

    /// Prepares for points and for whole poses of moving bodies: behind the columns of the points come four for each body, the place of
    /// its origin and its direction as a unit vector.
    ///
    /// # Errors
    /// [`BatchError::NoSuchPoint`].
    pub fn with_bodies(
        motion: &Arc<Motion>,
        points: &[PointId],
        bodies: &[BodyId],
    ) -> Result<Self, BatchError> {
        let bodies: Vec<usize> = bodies.iter().map(|body| body.index()).collect();
        let mechanism = motion.mechanism();
        let markers: Vec<Marker> = (points.iter())
            .map(|&p| mechanism.any_marker(p).ok_or(BatchError::NoSuchPoint(p)))
            .collect::<Result<_, _>>()?;
        Ok(Self {
            motion: motion.clone(),
            set: InstructionSet::detect(),
            stretches: stretches(motion),
            needs_guess: motion.mechanism().plan.steps.iter().any(Step::needs_guess),
            order: Order::new(mechanism, &markers, &bodies),
            markers,
            bodies,
            determinants: Vec::new(),
            kept: Kept::default(),
        })
    }

    /// Tells behind everything else the determinant of every step of the plan that vanishes where assemblies meet, one column each:
    /// a signed length or area, smooth along a motion. Sweeps know none of Newton groups.
    pub fn with_determinants(mut self) -> Self {
        let steps = self.motion.mechanism().plan.steps.iter().enumerate();
        let telling = steps.filter(|(_, step)| step.tells_modes());
        self.determinants = telling.map(|(index, _)| index).collect();
        self.kept = Kept::default();
        self
    }

    /// How many of the columns, the last ones, are determinants.
    pub fn determinants(&self) -> usize {
        self.determinants.len()
    }

    /// Uses these vector instructions at most. The results are the same.
    pub fn with_instructions(mut self, set: InstructionSet) -> Self {
        self.set = set;
        self
    }

    /// Columns of positions: two for each point, four for each body, and the determinants that are told.
    pub fn columns(&self) -> usize {
        2 * self.markers.len() + PARTS * self.bodies.len() + self.determinants.len()
    }

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
        let model = &self.motion.mechanism().model;
        check_length(
            "designs",
            designs.count * model.parameters.len(),
            designs.values.len(),
        )?;
        check_length("out", designs.count * at.len() * self.columns(), out.len())?;
        let places = Places::new(self, at);
        let runs = &places.runs(self);
        let plan = &self.motion.mechanism().plan;
        let in_lanes = |step: &Step| match step {
            Step::Newton { block } => plan.newton_blocks[*block].tree_in_lanes().is_some(),
            step => !step.needs_guess(),
        };
        let piece = if !self.needs_guess && self.determinants.is_empty() {
            solve_designs
        } else if plan.steps.iter().all(in_lanes) {
            solve_trees
        } else {
            solve_guessed
        };
        let mut closed = vec![0; designs.count.div_ceil(DESIGNS_PER_TASK)];
        let tasks = (split_columns(out, designs.count, DESIGNS_PER_TASK).into_iter())
            .zip(&mut closed)
            .enumerate()
            .map(|(task, (mut out, closed))| -> Task<'_> {
                let first = task * DESIGNS_PER_TASK;
                let count = DESIGNS_PER_TASK.min(designs.count - first);
                let work = Work {
                    batch: self,
                    designs,
                    range: first..first + count,
                    runs,
                };
                Box::new(move || *closed = piece(self.set, &work, &mut out))
            })
            .collect();
        executor.run(tasks);
        Ok(closed.iter().sum())
    }
}

/// Sweeps some parameters into the columns' parts for them; returns how many poses close.
type SweepPiece = fn(InstructionSet, &Batch, &[f64], &mut [&mut [f64]]) -> usize;
