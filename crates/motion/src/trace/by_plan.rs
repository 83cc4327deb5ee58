//! Steps of a trace by the plan, away from where branches meet.
//!
//! With its assembly modes the plan gives the pose at a path parameter and, on series, the tangent there: no system of all
//! constraints is needed. A step is taken this way only while no determinant comes near zero. There, and at limits, where the
//! path parameter leads nowhere, the bordered systems go on.

use kempe_mechanism::Configuration;
use kempe_mechanism::blocks::Unknown;
use kempe_mechanism::pose::Pose;

use super::acceptance::{
    CORRECTION_LIMIT, MIDDLE_TOLERANCE, SHORTEST_STEP, TURN_LIMIT, hides_limits,
};
use super::cubic::{Cubic, distance};
use super::node::{Node, dot, norm};
use super::plan_steps::Series;
use super::{Follower, Path, unscale};

/// How many times as large a determinant may be at one of the ends and the middle of a step as at another. One that goes
/// through zero within the step, and keeps its sign only because the plan is told its sign, falls and rises again: on
/// a straight way that makes it three times as large somewhere, and more on a bent one.
const STEADY: f64 = 2.0;
/// Where a determinant does go through zero within a step, it is at the end and in the middle at least this part of what it is
/// where it is largest: nearer to zero the plan says little ...
const CLEAR: f64 = 0.05;
/// ... and it runs straight, but for this part.
const STRAIGHT: f64 = 0.25;
/// So near to zero, as a part of where it was largest, a determinant is not led by the plan.
const TINY: f64 = 0.02;
/// How far (in mechanism sizes and rad) the plan's pose may lie from a node for the trace to go on by the plan.
const SAME_POSE: f64 = 1e-9;
/// Shorter steps are left to the bordered systems: the path parameter may lead nowhere.
const SHORTEST_BY_PLAN: f64 = 1e3 * SHORTEST_STEP;

/// What the plan makes of a step.
pub(super) enum ByPlan {
    /// The node, and how far the middle lies from the cubic.
    Reached(Node, f64),
    /// The way bends too much for a step of this length.
    Bent,
    /// Branches may meet near here, or the plan does not lead along this curve.
    Unfit,
}

/// How the modes of a pose are known.
#[derive(Clone, Copy, PartialEq)]
enum Modes {
    /// They are those of the node last reached.
    Kept,
    /// Every step of the plan has the one that leads nearer to the pose expected.
    Nearest,
}

impl<P: Path> Follower<'_, P> {
    /// Leaves all steps to the bordered systems from now on.
    pub fn without_plan(mut self) -> Self {
        self.by_plan.whole = false;
        self
    }

    /// The determinant of every step of the plan at scaled unknowns, with the sign of its assembly mode: zero where it has none,
    /// one for a step whose determinant tells nothing.
    pub fn determinants(&mut self, z: &[f64]) -> &[f64] {
        if self.by_plan.at != z {
            let it = &mut self.by_plan;
            it.near.clear();
            it.near.extend_from_slice(z);
            self.by_plan.apart = self.find_modes();
            let it = &mut self.by_plan;
            it.determinants.clone_from(&it.tried);
            it.signs.clone_from(&it.branch.signs);
            it.at.clone_from(&it.near);
            it.note_largest();
        }
        &self.by_plan.determinants
    }

    /// The same at a node, which may know them.
    pub fn determinants_at(&mut self, node: &Node) -> Vec<f64> {
        if node.determinants.is_empty() {
            return self.determinants(&node.z).to_vec();
        }
        node.determinants.clone()
    }

    /// Finds the modes in which the plan comes nearest to the pose expected, and its determinants there. Returns how far from it the
    /// plan is.
    fn find_modes(&mut self) -> f64 {
        let last = self.by_plan.near.len() - 1;
        self.set_coordinates(self.by_plan.near[last] * self.path.scale());
        let (it, mechanism) = (&mut self.by_plan, &*self.design.mechanism);
        unscale(
            &it.near,
            self.size,
            &mut it.branch.guess,
            &mut it.branch.near,
        );
        it.plain.set_inputs(mechanism, &self.coordinates);
        (self.design).find_modes(&mut it.plain, &mut it.branch, self.size, &mut it.tried)
    }

    /// Readies the branch for the pose expected, and the drives' coordinates there.
    fn set_branch(&mut self, modes: Modes) {
        if modes == Modes::Nearest {
            self.find_modes();
            return;
        }
        let last = self.by_plan.near.len() - 1;
        self.set_coordinates(self.by_plan.near[last] * self.path.scale());
        let it = &mut self.by_plan;
        it.branch.signs.clone_from(&it.signs);
        if it.guided {
            unscale(
                &it.near,
                self.size,
                &mut it.branch.guess,
                &mut it.branch.near,
            );
        }
    }

    /// Solves for the pose expected, which the plan's takes the place of; the storage then holds how far they lie apart.
    fn solve_plain(&mut self, modes: Modes) {
        self.set_branch(modes);
        let (it, mechanism) = (&mut self.by_plan, &*self.design.mechanism);
        it.plain.set_inputs(mechanism, &self.coordinates);
        self.design.solve(&it.branch, &mut it.plain);
        it.take(&mechanism.plan, self.size, |it, body| it.plain.poses[body]);
    }

    /// Corrects a point beside a step of length `h` at its path parameter, in the modes nearest to it; returns the determinant of a
    /// step of the plan there. `None`, and the point as it was, where the plan has none so near.
    pub fn correct_by_plan(&mut self, z: &mut [f64], h: f64, step: usize) -> Option<f64> {
        if !self.by_plan.whole {
            return None;
        }
        self.by_plan.near.clear();
        self.by_plan.near.extend_from_slice(z);
        self.solve_plain(Modes::Nearest);
        let it = &self.by_plan;
        (norm(&it.gap) <= MIDDLE_TOLERANCE * h).then(|| {
            z.copy_from_slice(&it.near);
            it.plain.determinants[step]
        })
    }

    /// One step of length `h` along the arc by the plan, held to what holds the steps of the bordered systems.
    pub(super) fn step_by_plan(&mut self, from: &Node, h: f64) -> ByPlan {
        if !self.by_plan.whole || h < SHORTEST_BY_PLAN {
            return ByPlan::Unfit;
        }
        self.determinants(&from.z);
        if !(self.by_plan.apart <= SAME_POSE) {
            return ByPlan::Unfit;
        }
        match self.try_by_plan(from, h, Modes::Kept) {
            // Perhaps over a place where modes change.
            ByPlan::Unfit => self.try_by_plan(from, h, Modes::Nearest),
            tried => tried,
        }
    }

    fn try_by_plan(&mut self, from: &Node, h: f64, modes: Modes) -> ByPlan {
        let near = &mut self.by_plan.near;
        near.clear();
        near.extend(from.z.iter().zip(&from.tangent).map(|(z, t)| z + h * t));
        let Some(to) = self.land_by_plan(from, modes) else {
            return ByPlan::Unfit;
        };
        // Across the way: along it the path parameter decides, which says nothing of how much it bends.
        let first = self.by_plan.gap_across(&from.tangent);
        if !(first <= CORRECTION_LIMIT * h) {
            return ByPlan::Bent;
        }
        self.middle_by_plan(from, to, h, modes)
    }

    /// Holds a step of length `h` by the plan to what its ends and its middle must be like.
    fn middle_by_plan(&mut self, from: &Node, to: Node, h: f64, modes: Modes) -> ByPlan {
        if dot(&to.tangent, &from.tangent) < TURN_LIMIT {
            return ByPlan::Bent;
        }
        let cubic = Cubic::new(from, &to);
        cubic.at(0.5).put(&mut self.by_plan.near);
        self.solve_plain(modes);
        let gap = self.by_plan.gap_beside(&cubic);
        let it = &mut self.by_plan;
        let steps = self.design.mechanism.plan.steps.iter().enumerate();
        let mut telling = steps.filter(|(_, step)| step.tells_modes());
        let clear = telling.all(|(index, _)| {
            let middle = it.plain.determinants[index];
            runs_on(it.determinants[index], middle, to.determinants[index])
        });
        if !clear {
            return ByPlan::Unfit;
        }
        if !(gap <= MIDDLE_TOLERANCE * h) {
            return ByPlan::Bent;
        }
        it.at.clone_from(&to.z);
        it.signs.clone_from(&it.landed);
        it.determinants.clone_from(&to.determinants);
        it.note_largest();
        ByPlan::Reached(to, gap)
    }

    /// The node of a motion at a path parameter from which steps by the plan may begin, the pose being that of scaled unknowns;
    /// `None` where the plan does not lead there.
    pub(crate) fn begin_by_plan(&mut self, z: &[f64], direction: f64) -> Option<Node> {
        if !self.by_plan.whole {
            return None;
        }
        self.determinants(z);
        if !(self.by_plan.apart <= SAME_POSE) {
            return None;
        }
        let near = &mut self.by_plan.near;
        near.clear();
        near.extend_from_slice(z);
        let node = self.land_with(direction, Modes::Kept)?;
        (norm(&self.by_plan.gap) <= SAME_POSE).then_some(node)
    }

    /// Goes on from a node of the motion that the plan led to, in the modes that it led there in.
    pub(crate) fn resume_by_plan(&mut self, at: &Node) {
        let it = &mut self.by_plan;
        it.at.clone_from(&at.z);
        it.determinants.clone_from(&at.determinants);
        it.note_largest();
    }

    /// The step from a node just reached by the plan to the path parameter of scaled unknowns that are expected there, in the
    /// same modes, held to what holds all steps; `None` where it is not fit, and any way over a limit.
    pub(crate) fn step_by_plan_to(&mut self, from: &Node, expected: &[f64]) -> Option<Node> {
        let near = &mut self.by_plan.near;
        near.clear();
        near.extend_from_slice(expected);
        let to = self.land_by_plan(from, Modes::Kept)?;
        let h = distance(&from.z, &to.z);
        match self.middle_by_plan(from, to, h, Modes::Kept) {
            ByPlan::Reached(to, _) if !hides_limits(from, &to) => Some(to),
            _ => None,
        }
    }

    /// The node that the plan has at the path parameter of the pose expected ahead of `from`; see [`Follower::land_with`].
    fn land_by_plan(&mut self, from: &Node, modes: Modes) -> Option<Node> {
        self.land_with(from.parameter_rate().signum(), modes)
    }

    /// The node that the plan has at the path parameter of the pose expected, which then runs in this direction; the storage then
    /// holds how far the one lies from the other. `None` where there is none, or modes change and are to be kept.
    fn land_with(&mut self, direction: f64, modes: Modes) -> Option<Node> {
        self.set_branch(modes);
        let scale = self.path.scale();
        let mechanism = &*self.design.mechanism;
        let it = &mut self.by_plan;
        it.landed.clone_from(&it.branch.signs);
        let (design, state) = it.rich.get_or_insert_with(|| {
            // What the plan does not place stands where the trace begins.
            let mut state: Configuration<Series> = Configuration::new(mechanism);
            for (rich, plain) in state.poses.iter_mut().zip(&it.plain.poses) {
                *rich = plain.map(Series::constant);
            }
            (self.design.lift(Series::constant), state)
        });
        it.inputs.clear();
        for (q, rate) in self.coordinates.iter().zip(&self.rates) {
            (it.inputs).push(Series::from_coefficients([*q, rate * scale, 0.0]));
        }
        state.set_inputs(mechanism, &it.inputs);
        design.solve(&it.branch, state);

        let mut determinants = Vec::with_capacity(mechanism.plan.steps.len());
        for (index, step) in mechanism.plan.steps.iter().enumerate() {
            let (before, now) = (it.determinants[index], &state.determinants[index]);
            let now = if step.tells_modes() {
                now.coefficient(0)
            } else {
                1.0
            };
            let clear = now.abs() >= TINY * it.largest[index];
            let crossed = modes == Modes::Nearest && before * now < 0.0;
            if !(clear && (crossed || is_steady(before, now))) {
                return None;
            }
            determinants.push(now);
        }
        let last = it.near.len() - 1;
        let mut tangent = vec![0.0; last + 1];
        for unknown in mechanism
            .plan
            .blocks
            .iter()
            .flat_map(|block| &block.unknowns)
        {
            let body = unknown.body().index();
            let Pose { x, y, c, s } = &state.poses[body];
            let [place, angle] = [3 * (body - 1), 3 * (body - 1) + 2];
            let rate = |part: &Series| part.coefficient(1);
            match unknown {
                Unknown::Angle(_) => {
                    tangent[angle] = c.coefficient(0) * rate(s) - s.coefficient(0) * rate(c);
                }
                Unknown::Place(_) => {
                    tangent[place] = rate(x) / self.size;
                    tangent[place + 1] = rate(y) / self.size;
                }
            }
        }
        tangent[last] = 1.0;
        let length = norm(&tangent) * direction;
        tangent.iter_mut().for_each(|t| *t /= length);
        it.take(&mechanism.plan, self.size, |it, body| match &it.rich {
            Some((_, state)) => state.poses[body].map(|part| part.coefficient(0)),
            None => Pose::identity(),
        });
        let finite = length.is_finite() && it.gap.iter().all(|gap| gap.is_finite());
        finite.then(|| Node {
            z: it.near.clone(),
            tangent,
            determinants,
        })
    }
}

/// Whether two determinants have one sign and one size, about.
pub(crate) fn is_steady(a: f64, b: f64) -> bool {
    a * b > 0.0 && a.abs() <= STEADY * b.abs() && b.abs() <= STEADY * a.abs()
}

/// Whether a determinant keeps off zero from one end of a step over the middle to the other, or goes through it but once.
fn runs_on(from: f64, middle: f64, to: f64) -> bool {
    if from * to > 0.0 {
        return is_steady(from, middle) && is_steady(middle, to);
    }
    let largest = from.abs().max(to.abs());
    middle.abs().min(to.abs()) >= CLEAR * largest
        && (middle - 0.5 * (from + to)).abs() <= STRAIGHT * largest
}
