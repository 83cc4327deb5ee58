//! A motion: the branch through the chosen assembly, known all along the drives' path.

use std::ops::ControlFlow;

use crate::assemble::{Assemblies, find_assemblies};
use crate::drive_path::DrivePath;
use crate::events::{Event, EventKind, locate_change_point, locate_limit};
use crate::mechanism::Mechanism;
use crate::newton::PlanNumber;
use crate::plan::{Plan, Step};
use crate::state::{Branch, Design, State};
use crate::trace::{Cubic, Follower, Node, hermite, interval};
use crate::watch::{Stage, Unwatched, Watch};

/// Sizes of mechanisms, m, whose lengths can be squared and multiplied with room to spare.
pub const SIZES: (f64, f64) = (1e-100, 1e100);
/// Steps after which a trace is given up.
pub const STEP_LIMIT: usize = 200_000;
/// A motion may end this close to a limit (in path scales) and still count as reaching it.
pub const AT_LIMIT: f64 = 1e-12;
/// A part this far out, in mechanism sizes, is taken to run away to infinity.
pub const FAR: f64 = 1e3;
/// A body that turns on by this much, rad, while the drive all but stands still is taken to run away too.
pub const WHIRLING: f64 = 300.0;
/// Rate of the scaled path parameter along the arc below which the drive all but stands still.
const STANDING: f64 = 1e-4;
/// Pivot ratio of the bordered Jacobian below which branches are taken to cross.
pub const CROSSING: f64 = 1e-7;
/// Branches meet where both lie within this residual (in mechanism sizes and rad); where they keep farther apart the trace
/// has gone from one to the other, and is repeated with care.
pub const MEETING: f64 = 1e-11;
/// How often a trace is repeated with care at one place more.
const REPEATS: usize = 64;
/// Width, as a part of the whole time, between the near and the far side of a place where the drives' rates jump.
const SIDES: f64 = 1e-12;
/// Where a motion starts at a singular pose, its branch is looked for at these parts of the range instead.
const ANCHORS: [f64; 6] = [0.0, 0.0137, 0.0411, 0.1234, 0.3719, 0.7183];

/// Why there is no motion.
#[derive(Clone, Debug)]
pub enum MotionError {
    /// No drive moves anything.
    NoDrive,
    /// Freedoms that no drive determines.
    Undetermined {
        /// Bodies that stay free.
        bodies: Vec<crate::mechanism::BodyId>,
    },
    /// The mechanism cannot be assembled at the start.
    CannotAssemble {
        /// Path parameter of the start.
        at: f64,
        /// What was found.
        assemblies: Box<Assemblies>,
    },
    /// Every pose tried near the start is singular: there is no direction in which the drive moves the mechanism.
    Locked {
        /// Path parameter of the start.
        at: f64,
    },
    /// The mechanism is too large or too small for numbers: squares of its lengths would overflow or vanish.
    Scale {
        /// Its size, m.
        size: f64,
    },
    /// Branches come so near each other that the trace could not be kept on one of them.
    Entangled {
        /// Path parameter there.
        at: f64,
    },
    /// It was told to stop before the motion was known.
    Stopped {
        /// What it was at.
        stage: Stage,
    },
}

/// Why the motion ends before the demanded range does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EndReason {
    /// The demanded range, or a whole turn, is covered.
    Covered,
    /// The drive can go no further: a limit (for this drive a dead point).
    Limit,
    /// The trace got stuck: no regular continuation was found.
    Stuck,
    /// A part runs away to infinity as the drive nears a value, as where two crossing slots become parallel.
    Runaway,
    /// The range is longer than [`STEP_LIMIT`] steps of the trace.
    TooLong,
}

/// What is asked of a motion.
#[derive(Clone, Debug)]
pub struct Demand {
    /// The drives' path.
    pub path: DrivePath,
    /// Range of the path parameter to cover.
    pub range: (f64, f64),
    /// Where it starts.
    pub start: f64,
    /// All assemblies at the start, where they are known already: finding them can take long.
    pub assemblies: Option<Assemblies>,
}

/// One stretch of the motion on which every assembly mode stays the same.
#[derive(Clone, Debug)]
pub(crate) struct Patch {
    pub from: usize,
    pub signs: usize,
}

/// The branch of a motion, all along the path: what every row of a table is computed from.
#[derive(Clone, Debug)]
pub struct Motion<'m> {
    /// The mechanism.
    pub mechanism: &'m Mechanism,
    /// Its plan.
    pub plan: &'m Plan,
    /// The design.
    pub design: &'m Design<f64>,
    /// The drives' path.
    pub path: DrivePath,
    /// All assemblies at the anchor, the chosen one first.
    pub assemblies: Assemblies,
    /// Path parameter where the assembly was chosen: the start, or near it when the start is singular.
    pub anchor: f64,
    /// Path parameter where the motion starts.
    pub start: f64,
    /// Demanded range of the path parameter.
    pub demanded: (f64, f64),
    /// Why the trace ended at its low and its high end.
    pub ends: (EndReason, EndReason),
    /// Dead points, change points and limits met, in order of the path parameter.
    pub events: Vec<Event>,
    nodes: Vec<Node>,
    parameters: Vec<f64>,
    patches: Vec<Patch>,
    signs: Vec<Vec<f64>>,
    scale: f64,
    size: f64,
}

impl<'m> Motion<'m> {
    /// Finds the assembly at the start and follows it over the demanded range of the drives.
    ///
    /// # Errors
    /// When it cannot start. A range that is cut short by a limit is not an error here: see [`Motion::ends`].
    pub fn new(
        mechanism: &'m Mechanism,
        plan: &'m Plan,
        design: &'m Design<f64>,
        parameters: &[f64],
    ) -> Result<Self, MotionError> {
        Self::watched(mechanism, plan, design, parameters, &mut Unwatched)
    }

    /// As [`Motion::new`]; `watch` hears how far it has come and may stop it.
    ///
    /// # Errors
    /// As [`Motion::new`], and [`MotionError::Stopped`].
    pub fn watched(
        mechanism: &'m Mechanism,
        plan: &'m Plan,
        design: &'m Design<f64>,
        parameters: &[f64],
        watch: &mut dyn Watch,
    ) -> Result<Self, MotionError> {
        let size = design.geometry.size(mechanism);
        let model = &mechanism.model;
        let path = DrivePath::new(model, parameters, size);
        let demanded = path.range(model, parameters);
        let start = path.start(model, parameters);
        let stretch = Demand {
            path,
            range: demanded,
            start,
            assemblies: None,
        };
        Self::along(mechanism, plan, design, stretch, watch)
    }

    /// Follows the branch through the assembly meant by the file's hints over a demanded range.
    ///
    /// # Errors
    /// As [`Motion::watched`].
    pub fn along(
        mechanism: &'m Mechanism,
        plan: &'m Plan,
        design: &'m Design<f64>,
        demand: Demand,
        watch: &mut dyn Watch,
    ) -> Result<Self, MotionError> {
        let Demand {
            path,
            range: demanded,
            start,
            assemblies: mut known,
        } = demand;
        if mechanism.model.drives.is_empty() {
            return Err(MotionError::NoDrive);
        }
        if !plan.decomposition.undetermined.is_empty() {
            let mut bodies: Vec<_> = plan
                .decomposition
                .undetermined
                .iter()
                .map(|u| u.body())
                .collect();
            bodies.dedup();
            return Err(MotionError::Undetermined { bodies });
        }
        let size = design.geometry.size(mechanism);
        if !(SIZES.0..=SIZES.1).contains(&size) {
            return Err(MotionError::Scale { size });
        }
        let scale = crate::trace::Path::scale(&path);
        let mut follower = Follower::new(mechanism, plan, &design.geometry, &path);

        let far = if (start - demanded.0).abs() > (demanded.1 - start).abs() {
            demanded.0
        } else {
            demanded.1
        };
        let mut coordinates = vec![0.0; mechanism.model.drives.len()];
        let mut nothing: Option<Assemblies> = None;
        for part in ANCHORS {
            let anchor = start + part * (far - start);
            path.coordinates(anchor, &mut coordinates);
            let assemblies = match known.take().filter(|_| anchor == start) {
                Some(known) => known,
                None => find_assemblies(mechanism, plan, design, &coordinates, watch).ok_or(
                    MotionError::Stopped {
                        stage: Stage::Assembling,
                    },
                )?,
            };
            let Some(chosen) = assemblies.list.first() else {
                nothing.get_or_insert(assemblies);
                // A start right at a limit may miss closure by a rounding error: look a little inside.
                if part > ANCHORS[1] {
                    break;
                } else {
                    continue;
                }
            };
            let z = follower.scaled(&chosen.poses, &chosen.branch.near, anchor);
            let (Some(up), Some(down)) = (follower.start(z.clone(), 1.0), follower.start(z, -1.0))
            else {
                continue;
            };
            // The finished part of the whole range, of which the upper part is followed first.
            let whole = (demanded.1 - demanded.0).max(f64::MIN_POSITIVE);
            let share = ((demanded.1 - anchor) / whole).clamp(0.0, 1.0);
            return with_care(&mut follower, |follower| {
                let mut told = |before: f64, part: f64| {
                    watch.reached(Stage::Following, Some((before + part).clamp(0.0, 1.0)))
                };
                let stopped = || Unlocated::Stopped(Stage::Following);
                let mut up_told = |part| told(0.0, part * share);
                let (high, end_high) =
                    follow(follower, up.clone(), demanded.1 / scale, &mut up_told)
                        .ok_or_else(stopped)?;
                let mut down_told = |part| told(share, part * (1.0 - share));
                let (low, end_low) =
                    follow(follower, down.clone(), demanded.0 / scale, &mut down_told)
                        .ok_or_else(stopped)?;
                // From the low end to the high one; the tangents of the lower half turned round.
                let turned = low.into_iter().skip(1).map(|mut node| {
                    node.tangent.iter_mut().for_each(|t| *t = -*t);
                    node
                });
                let mut nodes: Vec<Node> = turned.rev().collect();
                nodes.extend(high);
                let assemblies = assemblies.clone();
                let mut motion =
                    Self::of_nodes(mechanism, plan, design, path.clone(), assemblies, nodes);
                motion.anchor = anchor;
                motion.start = start;
                motion.demanded = demanded;
                motion.ends = (end_low, end_high);
                motion.find_events(follower, watch)?;
                Ok(motion)
            });
        }
        match nothing {
            Some(assemblies) => Err(MotionError::CannotAssemble {
                at: start,
                assemblies: Box::new(assemblies),
            }),
            None => Err(MotionError::Locked { at: start }),
        }
    }

    /// A motion over given nodes, rising in the path parameter; it covers just them.
    pub(crate) fn of_nodes(
        mechanism: &'m Mechanism,
        plan: &'m Plan,
        design: &'m Design<f64>,
        path: DrivePath,
        assemblies: Assemblies,
        nodes: Vec<Node>,
    ) -> Self {
        let scale = crate::trace::Path::scale(&path);
        let at = |node: Option<&Node>| {
            node.and_then(|n| n.z.last())
                .map_or(f64::NAN, |z| z * scale)
        };
        let demanded = (at(nodes.first()), at(nodes.last()));
        Self {
            mechanism,
            plan,
            design,
            assemblies,
            anchor: demanded.0,
            start: demanded.0,
            demanded,
            ends: (EndReason::Covered, EndReason::Covered),
            events: Vec::new(),
            parameters: Vec::new(),
            patches: Vec::new(),
            signs: Vec::new(),
            nodes,
            scale,
            size: design.geometry.size(mechanism),
            path,
        }
    }

    /// The range that was reached of the demanded one.
    pub fn reached(&self) -> (f64, f64) {
        let (first, last) = (self.parameters.first(), self.parameters.last());
        let (first, last) = (
            first.copied().unwrap_or(self.start),
            last.copied().unwrap_or(self.start),
        );
        (self.demanded.0.max(first), self.demanded.1.min(last))
    }

    /// How far beyond its ends the motion still counts as reaching.
    pub(crate) fn margin(&self) -> f64 {
        AT_LIMIT * self.scale
    }

    /// Whether a path parameter lies on the motion.
    pub fn reaches(&self, p: f64) -> bool {
        let tolerance = self.margin();
        let (Some(first), Some(last)) = (self.parameters.first(), self.parameters.last()) else {
            return false;
        };
        p >= first - tolerance && p <= last + tolerance
    }

    /// Size of the mechanism, m: the scale of closure residuals.
    pub fn size(&self) -> f64 {
        self.size
    }

    /// Path parameter and poses of a node of the trace, with unwrapped body angles.
    pub(crate) fn node(&self, index: usize) -> (f64, Vec<crate::pose::Pose<f64>>, Vec<f64>) {
        let mut poses = vec![crate::pose::Pose::identity(); self.mechanism.bodies];
        let mut near = vec![0.0; self.mechanism.bodies];
        for (body, part) in self.nodes[index]
            .z
            .chunks_exact(3)
            .enumerate()
            .take(self.mechanism.bodies - 1)
        {
            poses[body + 1] =
                crate::pose::Pose::from_angle(part[0] * self.size, part[1] * self.size, part[2]);
            near[body + 1] = part[2];
        }
        (self.parameters[index], poses, near)
    }

    /// Path parameters of all nodes, rising.
    pub fn node_parameters(&self) -> &[f64] {
        &self.parameters
    }

    /// How many nodes the trace needed.
    pub fn nodes(&self) -> usize {
        self.nodes.len()
    }

    /// The node at a limit, when `p` is one to within [`AT_LIMIT`]. There the closed forms may miss the pose by a
    /// rounding error; the trace does not.
    pub(crate) fn limit_at(&self, p: f64) -> Option<usize> {
        [0, self.nodes.len().saturating_sub(1)]
            .into_iter()
            .find(|&index| {
                let (Some(node), Some(at)) = (self.nodes.get(index), self.parameters.get(index))
                else {
                    return false;
                };
                node.parameter_rate() == 0.0 && (p - at).abs() <= AT_LIMIT * self.scale
            })
    }

    /// The change point within whose bridge `p` lies, if any.
    pub fn bridge(&self, p: f64) -> Option<&Event> {
        self.events
            .iter()
            .find(|e| e.kind != EventKind::Limit && (p - e.at).abs() < 0.5 * e.bridge)
    }

    /// Fills the branch for a path parameter: modes, guesses and turn counts.
    pub fn branch_at(&self, p: f64, branch: &mut Branch) {
        let node = interval(&self.parameters, p);
        let patch = self
            .patches
            .partition_point(|patch| patch.from <= node)
            .max(1)
            - 1;
        if let Some(patch) = self.patches.get(patch) {
            branch.signs.clone_from(&self.signs[patch.signs]);
        }
        let (Some(from), Some(to)) = (self.nodes.get(node), self.nodes.get(node + 1)) else {
            return;
        };
        // Where on the cubic the path parameter is p: it is monotonic between nodes.
        let wanted = p / self.scale;
        let last = from.z.len() - 1;
        let cubic = Cubic::new(from, to);
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..30 {
            let middle = 0.5 * (low + high);
            if cubic.at(middle).part(last) <= wanted {
                low = middle
            } else {
                high = middle
            }
        }
        let place = cubic.at(0.5 * (low + high));
        for body in 1..self.mechanism.bodies {
            let [x, y, angle] = [0, 1, 2].map(|k| place.part(3 * (body - 1) + k));
            branch.guess[body] = crate::pose::Pose::from_angle(x * self.size, y * self.size, angle);
            branch.near[body] = angle;
        }
    }

    /// The stretches on which every assembly mode stays the same: where each begins, and the modes; rising.
    pub(crate) fn stretches(&self) -> impl Iterator<Item = (f64, &[f64])> {
        (self.patches.iter()).map(|patch| {
            (
                self.parameters[patch.from],
                self.signs[patch.signs].as_slice(),
            )
        })
    }

    /// Storage for solving poses of this motion on the number `T`.
    pub fn solver<T: PlanNumber>(&self) -> Solver<T> {
        Solver {
            branch: Branch::neutral(self.mechanism, self.plan),
            state: State::new(self.mechanism, self.plan),
            coordinates: vec![T::zero(); self.mechanism.model.drives.len()],
        }
    }

    /// Solves the pose at a path parameter. The series' direction, if `T` has one, is the path's.
    pub fn solve<T: PlanNumber>(&self, design: &Design<T>, p: T, solver: &mut Solver<T>) {
        self.branch_at(p.value(), &mut solver.branch);
        self.path.coordinates(p, &mut solver.coordinates);
        solver.run(self, design);
    }

    /// Finds where modes change between nodes, splits the motion there and records what was met.
    pub(crate) fn find_events(
        &mut self,
        follower: &mut Follower<'_, DrivePath>,
        watch: &mut dyn Watch,
    ) -> Result<(), Unlocated> {
        let mut modes: Vec<Vec<f64>> = Vec::with_capacity(self.nodes.len());
        for (done, node) in self.nodes.iter().enumerate() {
            let part = done as f64 / self.nodes.len() as f64;
            if watch.reached(Stage::Locating, Some(part)).is_break() {
                return Err(Unlocated::Stopped(Stage::Locating));
            }
            modes.push(self.determinants(follower, node));
        }
        let mut nodes: Vec<Node> = Vec::with_capacity(self.nodes.len());
        let mut signs: Vec<Vec<f64>> = Vec::new();
        let old = std::mem::take(&mut self.nodes);
        for (index, node) in old.iter().enumerate() {
            nodes.push(node.clone());
            let at_limit = node.parameter_rate().abs() < 1e-9;
            if at_limit {
                self.events.push(Event {
                    kind: EventKind::Limit,
                    at: follower.parameter(&node.z),
                    steps: vanishing(&modes[index], index.checked_sub(1).map(|i| &modes[i])),
                    bridge: 0.0,
                });
            }
            let Some(next) = old.get(index + 1) else {
                break;
            };
            let next_limit = next.parameter_rate().abs() < 1e-9;
            // Next to a limit the sign of the regular end counts.
            let here = if at_limit {
                &modes[index + 1]
            } else {
                &modes[index]
            };
            let there = if next_limit {
                &modes[index]
            } else {
                &modes[index + 1]
            };
            signs.push(here.iter().map(|d| d.signum()).collect());
            let flipped: Vec<usize> = (0..here.len())
                .filter(|&k| here[k] * there[k] < 0.0)
                .collect();
            if at_limit || next_limit || flipped.is_empty() {
                continue;
            }
            let mut found: Vec<(f64, Node, usize)> = Vec::new();
            for &step in &flipped {
                let measure = |follower: &mut Follower<'_, DrivePath>, node: &Node| {
                    self.determinants(follower, node)[step]
                };
                let located = locate_change_point(follower, node, next, measure);
                // Where nothing is located the middle of the step stands for it: a sign does not change without a place.
                let z = match &located {
                    Some((_, at)) => at.z.clone(),
                    None => hermite(node, next, 0.5),
                };
                let residual = follower.residual(&z);
                if !(residual <= MEETING) {
                    return Err(Unlocated::Missed { z, residual });
                }
                found.extend(located.map(|(s, at)| (s, at, step)));
            }
            found.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut current: Vec<f64> = here.iter().map(|d| d.signum()).collect();
            let spacing = (follower.parameter(&next.z) - follower.parameter(&node.z)).abs();
            let mut last_s = f64::NEG_INFINITY;
            for (s, at, step) in found {
                current[step] = -current[step];
                if s - last_s < 1e-7 {
                    // Several groups change at one pose.
                    if let (Some(event), Some(now)) = (self.events.last_mut(), signs.last_mut()) {
                        event.steps.push(step);
                        now.clone_from(&current);
                    }
                    continue;
                }
                last_s = s;
                // Where redundant constraints keep the tangent determined nothing crosses.
                let crossing = follower.tangent(&at.z, &at.tangent).is_none()
                    || follower.conditioning() < CROSSING;
                self.events.push(Event {
                    kind: if crossing {
                        EventKind::ChangePoint
                    } else {
                        EventKind::ModeChange
                    },
                    at: follower.parameter(&at.z),
                    steps: vec![step],
                    bridge: 0.15 * spacing,
                });
                nodes.push(at);
                signs.push(current.clone());
            }
        }
        self.nodes = nodes;
        self.parameters = self
            .nodes
            .iter()
            .map(|n| follower.parameter(&n.z))
            .collect();
        for (index, now) in signs.into_iter().enumerate() {
            if self.signs.last() != Some(&now) {
                self.signs.push(now);
                self.patches.push(Patch {
                    from: index,
                    signs: self.signs.len() - 1,
                });
            }
        }
        Ok(())
    }

    /// The determinant of every step at a node, with the sign of its assembly mode.
    fn determinants(&self, follower: &mut Follower<'_, DrivePath>, node: &Node) -> Vec<f64> {
        let mut branch = Branch::neutral(self.mechanism, self.plan);
        let mut state: State<f64> = State::new(self.mechanism, self.plan);
        follower.unscaled(&node.z, &mut state.poses, &mut branch.near);
        branch.guess.clone_from(&state.poses);
        let mut coordinates = vec![0.0; self.mechanism.model.drives.len()];
        self.path
            .coordinates(follower.parameter(&node.z), &mut coordinates);
        state.set_inputs(self.mechanism, &coordinates);
        let truth = state.poses.clone();
        let mut list = Vec::with_capacity(self.plan.steps.len());
        for (index, step) in self.plan.steps.iter().enumerate() {
            let unknowns = &self.plan.blocks[index].unknowns;
            let mut best = (f64::INFINITY, 1.0);
            let trials: &[f64] = if step.has_modes() {
                &[1.0, -1.0]
            } else {
                &[1.0]
            };
            for &sign in trials {
                self.plan.solve_step(
                    index,
                    sign,
                    self.mechanism,
                    self.design,
                    &branch,
                    &mut state,
                );
                let gap: f64 = unknowns
                    .iter()
                    .map(|u| {
                        let (a, b) = (&state.poses[u.body().index()], &truth[u.body().index()]);
                        ((a.x - b.x).abs() + (a.y - b.y).abs()) / self.size
                            + (a.c - b.c).abs()
                            + (a.s - b.s).abs()
                    })
                    .sum();
                if gap < best.0 {
                    best = (gap, state.determinants[index]);
                }
            }
            // The next steps build on the true pose.
            for unknown in unknowns {
                state.poses[unknown.body().index()] = truth[unknown.body().index()];
            }
            let relevant =
                step.has_modes() || matches!(step, Step::Newton { .. } | Step::Cross { .. });
            list.push(if relevant && best.0.is_finite() {
                best.1
            } else if relevant {
                0.0
            } else {
                1.0
            });
        }
        list
    }
}

/// Why the events of a motion are not known.
pub(crate) enum Unlocated {
    /// The work was stopped at this.
    Stopped(Stage),
    /// The trace went from one branch to another that does not meet it: they only come near each other at this place.
    Missed {
        /// Scaled unknowns, between the branches.
        z: Vec<f64>,
        /// Largest residual there, in mechanism sizes and rad.
        residual: f64,
    },
}

/// Traces until the trace stays on its branch: with care at one place more each time that it went to another.
pub(crate) fn with_care<R>(
    follower: &mut Follower<'_, DrivePath>,
    mut trace: impl FnMut(&mut Follower<'_, DrivePath>) -> Result<R, Unlocated>,
) -> Result<R, MotionError> {
    let mut repeats = 0;
    loop {
        match trace(follower) {
            Ok(found) => return Ok(found),
            Err(Unlocated::Stopped(stage)) => return Err(MotionError::Stopped { stage }),
            Err(Unlocated::Missed { z, .. }) if repeats == REPEATS => {
                let at = follower.parameter(&z);
                return Err(MotionError::Entangled { at });
            }
            Err(Unlocated::Missed { z, residual }) => {
                follower.beware(z, residual);
                repeats += 1;
            }
        }
    }
}

/// Steps whose determinant is all but zero, compared with a regular neighbour.
fn vanishing(at: &[f64], regular: Option<&Vec<f64>>) -> Vec<usize> {
    let Some(regular) = regular else {
        return Vec::new();
    };
    (0..at.len())
        .filter(|&k| !(at[k].abs() > 1e-3 * regular[k].abs()))
        .collect()
}

/// Follows one direction until the scaled parameter `target` is passed, a limit is met, or the trace is stuck. `told`
/// hears the finished part; `None` when it stops the work.
fn follow(
    follower: &mut Follower<'_, DrivePath>,
    start: Node,
    target: f64,
    told: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Option<(Vec<Node>, EndReason)> {
    let last = start.z.len() - 1;
    let direction = start.tangent[last].signum();
    let mut nodes = vec![start];
    let mut step = 0.02;
    let stops = stops(follower, direction, nodes[0].z[last], target);
    let mut stops = stops.iter().peekable();
    for _ in 0..STEP_LIMIT {
        let from = &nodes[nodes.len() - 1];
        let whole = (target - nodes[0].z[last]).abs().max(f64::MIN_POSITIVE);
        told((from.z[last] - nodes[0].z[last]).abs() / whole).continue_value()?;
        // A margin beyond the target, so that it lies inside a patch and not at the rim.
        if (from.z[last] - target) * direction > 1e-9 {
            return Some((nodes, EndReason::Covered));
        }
        // Where the drives' rates jump the trace stops on the near side and goes on from the far side.
        if let Some((near, far)) = stops.peek()
            && (from.z[last] + 1.5 * step * from.tangent[last] - near) * direction >= 0.0
        {
            let far_side = *far;
            if let Some(on) = follower.land_smoothly(from, *near, &mut step) {
                let Some(over) = follower.land(&on, far_side) else {
                    return Some((nodes, EndReason::Stuck));
                };
                nodes.push(on);
                nodes.push(over);
                stops.next();
                step = 0.02;
                if (far_side - target) * direction >= 0.0 {
                    return Some((nodes, EndReason::Covered));
                }
                continue;
            }
        }
        let Some(next) = follower.advance(from, &mut step) else {
            return Some((nodes, EndReason::Stuck));
        };
        if next.parameter_rate() * direction <= 0.0 {
            let limit = locate_limit(follower, from, &next);
            let covered = (limit.z[last] - target) * direction > 0.0;
            nodes.push(limit);
            let end = if covered {
                EndReason::Covered
            } else {
                EndReason::Limit
            };
            return Some((nodes, end));
        }
        let standing = next.parameter_rate().abs() < STANDING;
        let away = next.z[..last]
            .chunks_exact(3)
            .zip(nodes[0].z.chunks_exact(3))
            .any(|(p, q)| {
                (p[0] - q[0]).abs() > FAR
                    || (p[1] - q[1]).abs() > FAR
                    || (standing && (p[2] - q[2]).abs() > WHIRLING)
            });
        nodes.push(next);
        if away {
            return Some((nodes, EndReason::Runaway));
        }
    }
    Some((nodes, EndReason::TooLong))
}

/// The places ahead where the drives' rates jump, as near and far sides in scaled parameters. Between the two lies less
/// than any row can tell apart.
fn stops(
    follower: &Follower<'_, DrivePath>,
    direction: f64,
    start: f64,
    target: f64,
) -> Vec<(f64, f64)> {
    let (breaks, scale) = follower.breaks();
    let width = breaks.last().map_or(0.0, |end| SIDES * end / scale);
    let mut stops: Vec<(f64, f64)> = breaks
        .iter()
        .map(|b| b / scale)
        // A trace that starts on a break is on its far side already.
        .filter(|b| (b - start) * direction > width && (b - target) * direction <= 2.0 * width)
        .map(|b| (b - width * direction, b + width * direction))
        .collect();
    if direction < 0.0 {
        stops.reverse();
    }
    stops
}

/// Storage for solving poses of a motion, reused from row to row.
#[derive(Clone, Debug)]
pub struct Solver<T> {
    /// The branch last used.
    pub branch: Branch,
    /// The state last solved.
    pub state: State<T>,
    /// Drive coordinates last used.
    pub coordinates: Vec<T>,
}

impl<T: PlanNumber> Solver<T> {
    /// Solves with the branch and coordinates set.
    pub fn run(&mut self, motion: &Motion<'_>, design: &Design<T>) {
        self.state.set_inputs(motion.mechanism, &self.coordinates);
        motion
            .plan
            .solve(motion.mechanism, design, &self.branch, &mut self.state);
    }
}
