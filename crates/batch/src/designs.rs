//! Many designs at the same places of a motion.

use std::ops::Range;

use kempe_mechanism::constraint::Input;
use kempe_mechanism::plan::Step;
use kempe_mechanism::{Branch, configuration::input_of};
use kempe_number::{InstructionSet, Lanes, Number, multiversion};

use crate::batch::Batch;
use crate::columns::{Target, check_length, split_columns, write_places};
use crate::error::BatchError;
use crate::executor::{Executor, Serial, Task};
use crate::mask::all_lanes;
use crate::stretch::nearest_stretch;
use crate::workspace::Workspace;

/// Designs handed to an executor at a time.
const DESIGNS_PER_TASK: usize = 1024;
/// How many groups of designs, each in the lanes of one, are prepared before any is solved.
const PREPARED: usize = 8;
/// How many places of a motion take every step of the plan together: as many as the nearest cache holds, in narrow lanes and in wide ones.
const STATES: usize = 18;
const WIDE_STATES: usize = 12;

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

impl Designs<'_> {
    /// One parameter of the designs from `first` on, the last one of the range repeated.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn fill<const W: usize>(
        &self,
        lanes: &mut Lanes<W>,
        parameter: usize,
        first: usize,
        range: &Range<usize>,
    ) {
        if let Layout::ByParameter = self.layout
            && first + W <= range.end
            && let Some(whole) = self.values[parameter * self.count + first..].first_chunk()
        {
            lanes.0 = *whole;
        } else {
            self.gather(&mut lanes.0, parameter, first, range.end - 1);
        }
    }

    /// The same for what does not lie as it is wanted.
    #[inline(never)]
    fn gather(&self, lanes: &mut [f64], parameter: usize, first: usize, last: usize) {
        let (start, stride) = match self.layout {
            Layout::ByDesign => (parameter, self.values.len() / self.count),
            Layout::ByParameter => (parameter * self.count, 1),
        };
        for (lane, value) in lanes.iter_mut().enumerate() {
            *value = self.values[start + stride * (first + lane).min(last)];
        }
    }
}

impl Batch {
    /// Places of the points for every design at every one of these path parameters, with the drive coordinates that
    /// the motion's own design has there: for each parameter in turn [`Batch::columns`] columns, each with one value
    /// per design. Where a design does not close they are NaN. Returns how many poses do close.
    ///
    /// Every design is on the branch that the motion has at that parameter: the same assembly modes, and in Newton
    /// groups the assembly that Newton's method reaches from the motion's pose. That is the branch a designer means as
    /// long as the designs lie close enough to the motion's own for no limit or change point to come between; whether
    /// a design reaches a pose *from its own start* is for its own [`Motion`](kempe_motion::Motion) to say. Parameters beyond the motion's
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

/// What designs take from the motion at one path parameter.
pub(super) struct MotionPlace<'b> {
    /// Its index.
    index: usize,
    branch: &'b Branch,
    /// Coordinates of the drives.
    inputs: &'b [Input<f64>],
}

/// What designs take from the motion.
pub(super) struct Places {
    /// The branch at every place for a plan that needs guesses, else a neutral one.
    branches: Vec<Branch>,
    /// Coordinates of the drives at one place after the other.
    inputs: Vec<Input<f64>>,
    parameters: Vec<f64>,
}

impl Places {
    /// Looks them up at these path parameters.
    pub(super) fn new(batch: &Batch, at: &[f64]) -> Self {
        let motion = &*batch.motion;
        let drives = &motion.mechanism().model.drives;
        let mut it = Self {
            branches: Vec::new(),
            inputs: Vec::with_capacity(at.len() * drives.len()),
            parameters: at.to_vec(),
        };
        let mut solver = motion.solver::<f64>();
        if !batch.needs_guess {
            it.branches.push(solver.branch.clone());
        }
        for &p in at {
            if batch.needs_guess {
                motion.branch_at(p, &mut solver.branch);
                it.branches.push(solver.branch.clone());
            }
            motion.path.coordinates(p, &mut solver.coordinates);
            let inputs = drives.iter().zip(&solver.coordinates);
            (it.inputs).extend(inputs.map(|(drive, q)| input_of(drive, *q)));
        }
        it
    }

    /// Runs of places on one branch, not too long to be solved together.
    pub(super) fn runs<'b>(&'b self, batch: &'b Batch) -> Vec<Vec<MotionPlace<'b>>> {
        let drives = batch.motion.mechanism().model.drives.len();
        let longest = match batch.set {
            InstructionSet::Baseline => STATES,
            _ => WIDE_STATES,
        };
        let mut runs: Vec<Vec<MotionPlace<'b>>> = Vec::new();
        for (index, &p) in self.parameters.iter().enumerate() {
            let guessed = &self.branches[index.min(self.branches.len() - 1)];
            let branch = match nearest_stretch(&batch.stretches, p) {
                Some(stretch) if !batch.needs_guess => &stretch.branch,
                _ => guessed,
            };
            let place = MotionPlace {
                index,
                branch,
                inputs: &self.inputs[index * drives..(index + 1) * drives],
            };
            match runs.last_mut() {
                Some(run) if run.len() < longest && std::ptr::eq(run[0].branch, branch) => {
                    run.push(place);
                }
                _ => runs.push(vec![place]),
            }
        }
        runs
    }
}

/// Some of the designs at runs of places.
pub(super) struct Work<'a> {
    pub batch: &'a Batch,
    pub designs: Designs<'a>,
    /// Which designs.
    pub range: Range<usize>,
    pub runs: &'a [Vec<MotionPlace<'a>>],
}

multiversion! {
    /// Solves designs, lanes over them; returns how many poses close. Sixteen lanes are few enough registers to work in if they are wide.
    pub(super) fn solve_designs(set: InstructionSet, work: &Work<'_>, out: &mut [&mut [f64]]) -> usize
        = in_lanes::<16, false>, baseline = in_lanes::<8, false>;
}

multiversion! {
    /// [`solve_designs`] for mechanisms whose branch is more than signs, but solved in lanes all the same.
    pub(super) fn solve_trees(set: InstructionSet, work: &Work<'_>, out: &mut [&mut [f64]]) -> usize
        = in_lanes::<16, true>, baseline = in_lanes::<8, true>;
}

/// [`solve_designs`] for mechanisms that take longest for what is not done in lanes.
pub(super) fn solve_guessed(_: InstructionSet, work: &Work<'_>, out: &mut [&mut [f64]]) -> usize {
    solve_trees(InstructionSet::Baseline, work, out)
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn in_lanes<const W: usize, const ALL: bool>(work: &Work<'_>, out: &mut [&mut [f64]]) -> usize {
    let Work {
        batch,
        designs,
        range,
        runs,
    } = work;
    let order = &batch.order;
    let plan = &order.plan;
    let (rest, point_steps): (_, &[_]) = match ALL {
        true => (&order.rest, &[]),
        false => (&order.other_steps, &order.point_steps),
    };
    let longest = runs.iter().map(Vec::len).max().unwrap_or(0);
    let groups = PREPARED.min(range.len().div_ceil(W));
    let mut workspace = Workspace::<W, ALL>::of(batch, longest, groups);
    let Workspace {
        states,
        design,
        prepared,
        parameters,
    } = &mut *workspace;
    let columns = batch.columns();
    let mut closed = 0;
    for block in (0..range.len()).step_by(PREPARED * W) {
        let rows = (block..range.len()).step_by(W);
        for (row, design) in rows.clone().zip(&mut *prepared) {
            for (k, parameter) in parameters.iter_mut().enumerate() {
                designs.fill(parameter, k, range.start + row, range);
            }
            design.update(parameters);
        }
        for run in *runs {
            let states = &mut states[..run.len()];
            let targets = &mut [Target::default(); STATES][..run.len()];
            for ((state, target), place) in states.iter_mut().zip(&mut *targets).zip(run) {
                target.column = place.index * columns;
                for (input, at) in state.inputs.iter_mut().zip(place.inputs) {
                    *input = Input {
                        c: Lanes::from_f64(at.c),
                        s: Lanes::from_f64(at.s),
                        value: Lanes::from_f64(at.value),
                    };
                }
            }
            order.solve_once(&order.driven, design, states);
            for (row, design) in rows.clone().zip(&*prepared) {
                for target in &mut *targets {
                    target.row = row;
                    target.wanted = all_lanes(W.min(range.len() - row));
                }
                let branch = run[0].branch;
                plan.solve_all::<_, ALL>(rest.iter().copied(), design, branch, states);
                closed += write_places(batch, design, branch, point_steps, states, targets, out);
            }
        }
    }
    batch.kept.give(workspace);
    closed
}
