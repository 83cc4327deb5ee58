//! The search through every way to solve the plan's steps one after the other.

use std::ops::ControlFlow;

use kempe_homotopy::{PathReport, WORK_LIMIT};
use kempe_mechanism::Mechanism;
use kempe_mechanism::blocks::Unknown;
use kempe_mechanism::constraint::Joint;
use kempe_mechanism::evidence::{closure, is_finite};
use kempe_mechanism::plan::{Plan, Step};
use kempe_mechanism::pose::Pose;
use kempe_mechanism::{Branch, Configuration, Design};
use kempe_model::LinkId;

use super::assemblies::{Assemblies, Assembly, OpenStep, Shortfall};
use super::earlier::Earlier;
use super::hints::Hints;
use crate::progress::{Done, Progress, Stage};

/// Most assemblies that are listed; a file with many dyads and no hints can have more than anyone wants to see.
pub const ASSEMBLY_LIMIT: usize = 512;
/// Most partial assemblies that are tried while looking for them.
const TRIAL_LIMIT: usize = 200_000;
/// Two poses of a block closer than this (in sizes of the mechanism, and rad) are one.
const SAME_POSE: f64 = 1e-7;
/// Closure residual (in sizes of the mechanism, and rad) up to which an assembly with redundant constraints closes.
pub const CLOSED: f64 = 1e-9;

pub(super) struct Search<'a> {
    pub mechanism: &'a Mechanism,
    pub plan: &'a Plan,
    pub design: &'a Design<f64>,
    pub coordinates: &'a [f64],
    pub size: f64,
    pub hints: Hints<'a>,
    pub progress: &'a mut dyn Progress,
    pub stopped: bool,
    /// Why assemblies may be missing; the first reason met.
    pub shortfall: Option<Shortfall>,
    pub paths: Vec<PathReport>,
    /// What they did for much the same dimensions, if that is known.
    pub earlier: &'a [PathReport],
    /// What the homotopies may still cost.
    pub work: f64,
    /// What was found by cutting the mechanism open at a gear (its constraint): the same for every branch before it.
    pub opened: Vec<(usize, Vec<Vec<Pose<f64>>>)>,
    found: Vec<Assembly>,
    rejected: usize,
    others: Vec<Assembly>,
    trials: usize,
    open: Option<OpenStep>,
    /// Whether more than are listed, or than are tried, there may be.
    truncated: bool,
    /// Whether of every step the way nearest to the hints is gone first.
    nearest_first: bool,
}

impl<'a> Search<'a> {
    pub fn new(
        design: &'a Design<f64>,
        coordinates: &'a [f64],
        earlier: Earlier<'a>,
        progress: &'a mut dyn Progress,
    ) -> Self {
        let mechanism = &*design.mechanism;
        let plan = &mechanism.plan;
        let size = design.size();
        Self {
            mechanism,
            plan,
            design,
            coordinates,
            size,
            hints: Hints::new(design, size, earlier.like),
            progress,
            stopped: false,
            shortfall: None,
            paths: Vec::new(),
            earlier: earlier.paths,
            work: WORK_LIMIT,
            opened: Vec::new(),
            found: Vec::new(),
            rejected: 0,
            others: Vec::new(),
            trials: 0,
            open: None,
            truncated: false,
            nearest_first: false,
        }
    }

    /// Finds all assemblies, the one meant first; `None` when stopped.
    pub fn run(mut self) -> Option<Assemblies> {
        self.find();
        // Where not all can be listed, the one that is meant is sought step by step.
        if self.truncated && !self.stopped && self.hints.has_near() {
            let first = std::mem::take(&mut self.found);
            let (others, rejected) = (std::mem::take(&mut self.others), self.rejected);
            (self.rejected, self.trials, self.nearest_first) = (0, 0, true);
            self.find();
            let nearest = |list: &[Assembly]| list.first().map_or(f64::INFINITY, |it| it.distance);
            if nearest(&first) <= nearest(&self.found) {
                (self.found, self.others, self.rejected) = (first, others, rejected);
            }
        }
        if self.stopped {
            return None;
        }
        let open = self.open.filter(|_| self.found.is_empty());
        Some(Assemblies {
            list: self.found,
            rejected: self.rejected,
            others: self.others,
            complete: self.shortfall.is_none(),
            shortfall: self.shortfall,
            paths: self.paths,
            open,
        })
    }

    /// Goes all ways from the first step on; the nearest to the hints comes first.
    fn find(&mut self) {
        let mut state = Configuration::new(self.mechanism);
        state.set_inputs(self.mechanism, self.coordinates);
        let branch = Branch::neutral(self.mechanism);
        self.descend(0, state, branch, true);
        // A stable sort: where the hints say nothing, the order of the search decides, left before right.
        self.found.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    }

    fn too_many(&mut self) {
        self.truncated = true;
        self.shortfall.get_or_insert(Shortfall::TooMany);
    }

    /// Puts ways to solve a step into the order in which they are gone.
    pub(super) fn order(&self, step: usize, ways: &mut [(Configuration<f64>, Branch)]) {
        if self.nearest_first {
            let off = |state: &Configuration<f64>| self.hints.distance_after(step, &state.poses);
            ways.sort_by(|(a, _), (b, _)| off(a).total_cmp(&off(b)));
        }
    }

    /// Solves the steps from `step` on, in every way there is. `wanted` is false once a side hint failed: such
    /// assemblies are only counted.
    pub(super) fn descend(
        &mut self,
        mut step: usize,
        mut state: Configuration<f64>,
        mut branch: Branch,
        mut wanted: bool,
    ) {
        loop {
            self.trials += 1;
            if self.found.len() >= ASSEMBLY_LIMIT || self.trials > TRIAL_LIMIT {
                self.too_many();
                return;
            }
            if self.stopped || self.tell(None).is_break() {
                return;
            }
            let Some(kind) = self.plan.steps.get(step) else {
                break;
            };
            if let Step::Newton { block } = kind {
                return self.descend_block(step, *block, state, branch, wanted);
            }
            if kind.has_modes() {
                return self.descend_modes(step, state, branch, wanted);
            }
            if !self.solve(step, 1.0, &mut state, &mut branch) {
                self.left_open(step, &branch, wanted);
                return;
            }
            wanted &= self.hints.sides_hold(step, &state.poses);
            step += 1;
        }
        // Redundant constraints are in no closed form: they hold here, or this is no assembly.
        if !self.plan.decomposition.surplus.is_empty() {
            let residual = closure(self.design, &branch, &state, self.size);
            if !(residual <= CLOSED) {
                self.left_open(step.saturating_sub(1), &branch, wanted);
                return;
            }
        }
        let assembly = Assembly {
            branch,
            distance: self.hints.distance(&state.poses),
            poses: state.poses,
            turns: self.design.geometry.turns.clone(),
        };
        if wanted {
            self.found.push(assembly);
        } else {
            self.rejected += 1;
            if self.others.len() < ASSEMBLY_LIMIT {
                self.others.push(assembly);
            }
        }
    }

    fn descend_modes(
        &mut self,
        step: usize,
        state: Configuration<f64>,
        branch: Branch,
        wanted: bool,
    ) {
        let mut ways: Vec<(Configuration<f64>, Branch)> = Vec::with_capacity(2);
        for sign in [1.0, -1.0] {
            let (mut state, mut branch) = (state.clone(), branch.clone());
            branch.signs[step] = sign;
            if !self.solve(step, sign, &mut state, &mut branch) {
                self.left_open(step, &branch, wanted);
                continue;
            }
            // At a dead point both modes are one assembly.
            if let Some((first, _)) = ways.first()
                && self.same(&first.poses, &state.poses)
            {
                continue;
            }
            ways.push((state, branch));
        }
        self.order(step, &mut ways);
        for (state, branch) in ways {
            let wanted = wanted && self.hints.sides_hold(step, &state.poses);
            if !wanted && self.rejected >= ASSEMBLY_LIMIT {
                self.too_many();
                continue;
            }
            self.descend(step + 1, state, branch, wanted);
        }
    }

    /// Takes note of a step that does not close: that of the sides' own way counts, the furthest of those.
    pub(super) fn left_open(&mut self, step: usize, branch: &Branch, agrees: bool) {
        let known = self.open.as_ref().map(|it| (it.agrees, it.step));
        if known.is_none_or(|known| known < (agrees, step)) {
            let branch = branch.clone();
            self.open = Some(OpenStep {
                step,
                branch,
                agrees,
            });
        }
    }

    /// Solves one step; false when it does not close. Keeps the branch's turn counts and guesses up to date.
    pub(super) fn solve(
        &mut self,
        step: usize,
        sign: f64,
        state: &mut Configuration<f64>,
        branch: &mut Branch,
    ) -> bool {
        self.plan.solve_step(step, sign, self.design, branch, state);
        for unknown in &self.plan.blocks[step].unknowns {
            let body = unknown.body().index();
            let pose = state.poses[body];
            if !is_finite(&pose) {
                return false;
            }
            if matches!(unknown, Unknown::Angle(_))
                && !matches!(self.plan.steps[step], Step::Newton { .. })
            {
                branch.near[body] = pose.angle_near(self.hints.meant[body]);
            }
            branch.guess[body] = pose;
        }
        self.count_turns(step, state, branch);
        true
    }

    /// Sets the angles that count turns: those of driven bodies and of wheels.
    fn count_turns(&self, step: usize, state: &Configuration<f64>, branch: &mut Branch) {
        let (body, constraint) = match self.plan.steps[step] {
            Step::Turn {
                body,
                from,
                offset,
                input: Some(drive),
                reversed,
            } => {
                // The angle of the driven link, turns and all, not that of its body.
                let driven = &self.mechanism.angles[offset as usize];
                let seat = |link: LinkId| self.design.geometry.seat_angles[link.index()];
                let turn = state.inputs[drive.index()].value + seat(driven.b) - seat(driven.a);
                branch.near[body.index()] =
                    branch.near[from.index()] + if reversed { -turn } else { turn };
                return;
            }
            Step::Gear { body, constraint } => (body, constraint),
            Step::Roll {
                own, constraint, ..
            } => (own.body, constraint),
            _ => return,
        };
        let situation = state.situation(self.design, branch);
        if let Some(angle) = self.mechanism.constraints[constraint]
            .0
            .angle(&situation, body)
        {
            branch.near[body.index()] = angle;
        }
    }

    /// Says how far the search has come; how many branches there are to try is not known beforehand.
    pub(super) fn tell(&mut self, part: Option<f64>) -> ControlFlow<()> {
        let flow = self.progress.reached(Stage::Assembling, Done::from(part));
        self.stopped |= flow.is_break();
        flow
    }

    /// Whether two assemblies are one.
    pub(super) fn same(&self, a: &[Pose<f64>], b: &[Pose<f64>]) -> bool {
        a.iter().zip(b).all(|(a, b)| {
            let length = (a.x - b.x).abs().max((a.y - b.y).abs());
            let angle = (a.c - b.c).abs().max((a.s - b.s).abs());
            length <= SAME_POSE * self.size && angle <= SAME_POSE
        })
    }
}
