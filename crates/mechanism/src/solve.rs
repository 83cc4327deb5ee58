//! Running a plan: from drive coordinates to poses.

use kempe_number::Number;

use crate::bound_dyad::BoundDyad;
use crate::branch::Branch;
use crate::configuration::Configuration;
use crate::constraint::{Input, Joint};
use crate::design::Design;
use crate::ids::{BodyId, Marker};
use crate::local_marker::LocalMarker;
use crate::pinned_group::{cross_loci, pin_twice, swing, swing_line};
use crate::plan::Plan;
use crate::plan_number::{IN_PLACE, PlanNumber, in_place};
use crate::pose::Pose;
use crate::solve_apart::solve_apart;
use crate::step::Step;

/// Solves one step for every state and, in `ALL`, keeps its determinant. A macro, because a closure would not be
/// compiled for the caller's vector instructions.
macro_rules! for_each {
    ($states:ident, $index:ident, |$state:ident| $solve:expr) => {
        for $state in $states.iter_mut() {
            let determinant = $solve;
            if ALL {
                $state.determinants[$index] = determinant;
            }
        }
    };
}

impl<T: PlanNumber> Design<T> {
    /// Finds the pose for the drive coordinates in `state.inputs` on the given branch: fills `state.poses` and
    /// `state.determinants`. Where the mechanism cannot be assembled the poses become NaN (empty for intervals).
    ///
    /// Allocates nothing.
    pub fn solve(&self, branch: &Branch, state: &mut Configuration<T>) {
        T::solve_plan(self, branch, state);
    }

    pub(crate) fn run_plan(&self, branch: &Branch, state: &mut Configuration<T>) {
        let plan = &self.mechanism.plan;
        let states = std::slice::from_mut(state);
        plan.solve_all::<T, true>(0..plan.steps.len(), self, branch, states);
    }
}

impl Plan {
    /// These steps of [`Design::solve`] for several states of one design on one branch. Each is run for all states before
    /// the next: it is taken apart once, and while one state waits for its roots and quotients the processor goes on with
    /// the others.
    ///
    /// Without `ALL` it is compiled without the steps that [need guesses](Step::needs_guess), and keeps no determinants.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn solve_all<T: PlanNumber, const ALL: bool>(
        &self,
        steps: impl IntoIterator<Item = usize>,
        design: &Design<T>,
        branch: &Branch,
        states: &mut [Configuration<T>],
    ) {
        for index in steps {
            let sign = branch.signs[index];
            self.run_step::<T, ALL>(index, sign, design, branch, states);
        }
    }

    /// Solves one step with the given assembly mode; the steps before it must have been solved.
    pub fn solve_step<T: PlanNumber>(
        &self,
        index: usize,
        sign: f64,
        design: &Design<T>,
        branch: &Branch,
        state: &mut Configuration<T>,
    ) {
        let states = std::slice::from_mut(state);
        self.run_step::<T, true>(index, sign, design, branch, states);
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run_step<T: PlanNumber, const ALL: bool>(
        &self,
        index: usize,
        sign: f64,
        design: &Design<T>,
        branch: &Branch,
        states: &mut [Configuration<T>],
    ) {
        match &self.steps[index] {
            Step::Turn { .. } | Step::Pin { .. } => {
                self.run_simple::<T, ALL>(index, design, states);
            }
            Step::Dyad(step) => {
                let step = BoundDyad::new(design, step);
                if !ALL && T::solve_common(&step, states, sign) {
                    return;
                }
                for_each!(states, index, |state| step.solve(state, sign, None));
            }
            &Step::Newton { block } if ALL && size_of::<T>() <= IN_PLACE => {
                self.run_newton(block, index, design, branch, states);
            }
            _ if const { !in_place::<T, ALL>() } => {
                self.call_step::<T, ALL>(index, sign, design, branch, states);
            }
            _ => self.run_rarer::<T, ALL>(index, sign, design, branch, states),
        }
    }

    /// Steps that only turn a body or pin it to a placed one, for several states: others leave no pose standing. Apart from
    /// [`Plan::solve_all`], so that who runs such steps alone is not compiled with all that others do.
    pub fn solve_simple<T: PlanNumber>(
        &self,
        steps: &[usize],
        design: &Design<T>,
        states: &mut [Configuration<T>],
    ) {
        for index in steps {
            self.run_simple::<T, false>(*index, design, states);
        }
    }

    /// Solves dyads for several states, apart from [`Plan::solve_all`] as [`Plan::solve_simple`] is: for the poses where
    /// [`Plan::place_point`] has told no more than a point.
    #[cold]
    #[inline(never)]
    pub fn solve_dyads<T: Number>(
        &self,
        steps: impl IntoIterator<Item = usize>,
        design: &Design<T>,
        branch: &Branch,
        states: &mut [Configuration<T>],
    ) {
        for index in steps {
            if let Step::Dyad(dyad) = &self.steps[index] {
                let dyad = BoundDyad::new(design, dyad);
                for state in &mut *states {
                    dyad.solve(state, branch.signs[index], None);
                }
            }
        }
    }

    /// Turns a body, or pins it.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run_simple<T: PlanNumber, const ALL: bool>(
        &self,
        index: usize,
        design: &Design<T>,
        states: &mut [Configuration<T>],
    ) {
        let mechanism = &*design.mechanism;
        match self.steps[index] {
            Step::Turn {
                body,
                from,
                offset,
                input,
                reversed,
            } => {
                let no_offset = mechanism.is_zero(&mechanism.angles[offset as usize]);
                match (input, from) {
                    (Some(drive), BodyId::GROUND) if no_offset => {
                        for_each!(states, index, |state| {
                            let by = driven(&state.inputs[drive.index()], reversed);
                            point(state, body, by)
                        });
                    }
                    _ => for_each!(states, index, |state| {
                        let by = match input {
                            Some(drive) if no_offset => {
                                driven(&state.inputs[drive.index()], reversed)
                            }
                            _ => state.turn_by(design, offset, input, reversed),
                        };
                        let direction = match from {
                            BodyId::GROUND => by,
                            _ => state.poses[from.index()].turn(by),
                        };
                        point(state, body, direction)
                    }),
                }
            }
            Step::Pin { own, at } => {
                let (pin, at) = (LocalMarker::new(design, own), LocalMarker::new(design, at));
                for_each!(states, index, |state| {
                    let world = at.place(&state.poses);
                    let pose = &mut state.poses[own.body.index()];
                    [pose.x, pose.y] = pin.origin([pose.c, pose.s], world);
                    T::one()
                });
            }
            _ => states.iter_mut().for_each(lose),
        }
    }

    /// Solves a Newton group and keeps its determinant.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run_newton<T: PlanNumber>(
        &self,
        block: usize,
        index: usize,
        design: &Design<T>,
        branch: &Branch,
        states: &mut [Configuration<T>],
    ) {
        for state in states {
            state.determinants[index] =
                T::solve_newton(&self.newton_blocks[block], design, branch, state);
        }
    }

    /// [`Plan::run_rarer`], called.
    #[inline(never)]
    fn call_step<T: PlanNumber, const ALL: bool>(
        &self,
        index: usize,
        sign: f64,
        design: &Design<T>,
        branch: &Branch,
        states: &mut [Configuration<T>],
    ) {
        self.run_rarer::<T, ALL>(index, sign, design, branch, states);
    }

    /// The steps of fewer mechanisms.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run_rarer<T: PlanNumber, const ALL: bool>(
        &self,
        index: usize,
        sign: f64,
        design: &Design<T>,
        branch: &Branch,
        states: &mut [Configuration<T>],
    ) {
        match &self.steps[index] {
            Step::Swing(step) => {
                for_each!(states, index, |state| swing::<T, ALL>(
                    design, branch, state, step, sign, None
                ));
            }
            Step::SwingLine(step) => {
                for_each!(states, index, |state| swing_line::<T, ALL>(
                    design, state, step, sign, None
                ));
            }
            Step::Cross {
                carriers,
                conditions,
            } => for_each!(states, index, |state| {
                cross_loci::<T, ALL>(design, branch, state, (carriers, conditions), sign)
            }),
            &Step::TwoPins { a, at_a, b, at_b } => for_each!(states, index, |state| {
                pin_twice(design, state, [(a, at_a), (b, at_b)], None)
            }),
            &Step::Hold { body } => for_each!(states, index, |state| {
                point(state, body, [T::one(), T::zero()])
            }),
            // Gears and racks count turns, pose by pose: nothing is gained by compiling them in place.
            &Step::Roll {
                own,
                at,
                constraint,
            } if ALL => for_each!(states, index, |state| {
                roll(design, branch, state, (own, at, constraint))
            }),
            &Step::Gear { body, constraint } if ALL => for_each!(states, index, |state| {
                turn_gear(design, branch, state, (body, constraint))
            }),
            Step::Apart(step) if ALL => for_each!(states, index, |state| {
                solve_apart(design, branch, state, step, sign)
            }),
            &Step::Newton { block } if ALL && size_of::<T>() > IN_PLACE => {
                self.run_newton(block, index, design, branch, states);
            }
            // Callers without `ALL` have made sure that there are none, and the common steps are done.
            _ => states.iter_mut().for_each(lose),
        }
    }
}

/// Leaves no pose standing.
#[cold]
#[inline(never)]
fn lose<T: Number>(state: &mut Configuration<T>) {
    let nowhere = T::from_f64(f64::NAN);
    (state.poses.iter_mut()).for_each(|pose| (pose.x, pose.c) = (nowhere, nowhere));
}

/// The turn by a drive alone, as a unit vector.
#[cfg_attr(not(debug_assertions), inline(always))]
fn driven<T: Number>(input: &Input<T>, reversed: bool) -> [T; 2] {
    [input.c, if reversed { -input.s } else { input.s }]
}

/// Turns a body into a direction; its determinant is one.
#[cfg_attr(not(debug_assertions), inline(always))]
fn point<T: Number>(state: &mut Configuration<T>, body: BodyId, [c, s]: [T; 2]) -> T {
    let pose = &mut state.poses[body.index()];
    (pose.c, pose.s) = (c, s);
    T::one()
}

/// Places a pinion by its centre and turns it by its rack.
#[inline(never)]
fn roll<T: Number>(
    design: &Design<T>,
    branch: &Branch,
    state: &mut Configuration<T>,
    (own, at, constraint): (Marker, Marker, usize),
) -> T {
    let mechanism = &*design.mechanism;
    // The centre is in place whatever the angle.
    let world = state.place(design, at);
    let (body, pin) = (own.body, design.geometry.marker(own));
    state.poses[body.index()] = Pose::pinned(T::one(), T::zero(), pin, world);
    let situation = state.situation(design, branch);
    if let Some(angle) = mechanism.constraints[constraint].0.angle(&situation, body) {
        let (s, c) = angle.sin_cos();
        state.poses[body.index()] = Pose::pinned(c, s, pin, world);
    }
    T::one()
}

/// Turns a body by a gear pair or a rack.
#[inline(never)]
fn turn_gear<T: Number>(
    design: &Design<T>,
    branch: &Branch,
    state: &mut Configuration<T>,
    (body, constraint): (BodyId, usize),
) -> T {
    let mechanism = &*design.mechanism;
    let situation = state.situation(design, branch);
    if let Some(angle) = mechanism.constraints[constraint].0.angle(&situation, body) {
        let (s, c) = angle.sin_cos();
        point(state, body, [c, s]);
    }
    T::one()
}
