//! All assemblies of a mechanism at given drive coordinates, and the one that the user means.

use std::ops::ControlFlow;

use kempe_model::HintKind;
use kempe_number::math;

use crate::blocks::Unknown;
use crate::evidence::closure;
use crate::homotopy::{PathReport, Random, Solutions, WORK_LIMIT, all_real_solutions};
use crate::mechanism::{BodyId, Constraint, Mechanism};
use crate::newton::PlanNumber;
use crate::open_loop;
use crate::plan::{NewtonBlock, Plan, Step};
use crate::pose::{Pose, cross, sub};
use crate::qr::Qr;
use crate::solve::gear;
use crate::state::{Branch, Design, State};
use crate::watch::{Stage, Unwatched, Watch};

/// Most assemblies that are listed; a file with many dyads and no hints can have more than anyone wants to see.
pub const ASSEMBLY_LIMIT: usize = 512;
/// Most partial assemblies that are tried while looking for them.
const TRIAL_LIMIT: usize = 200_000;
/// Random starts for a block to which the complete method does not apply.
const SEARCH_STARTS: usize = 400;
/// Two poses of a block closer than this (in sizes of the mechanism, and rad) are one.
const SAME_POSE: f64 = 1e-7;
/// A wheel may stand this far, rad, beyond half a turn from where its angle is counted: rounding decides no assembly.
const HALF_TURN: f64 = 1e-9;
/// A pose read off a trace may miss the bodies placed before by this much (in sizes of the mechanism, and rad).
const SAME_BEFORE: f64 = 1e-2;
/// Closure residual (in sizes of the mechanism, and rad) up to which an assembly with redundant constraints closes.
pub const CLOSED: f64 = 1e-9;
/// Side hints are not held against a point closer to the line than this, in sizes of the mechanism.
const ON_THE_LINE: f64 = 1e-9;

/// One way to put the mechanism together.
#[derive(Clone, Debug)]
pub struct Assembly {
    /// The branch that leads to it.
    pub branch: Branch,
    /// Where the bodies are.
    pub poses: Vec<Pose<f64>>,
    /// Root mean square distance of the points of `near` hints from where they should be, m (angles in rad count as
    /// lengths of one mechanism size).
    pub distance: f64,
}

/// Why assemblies may be missing from a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shortfall {
    /// A block was searched from random starts: the complete method does not apply to it.
    Searched,
    /// A block with a gear or rack was cut open there, and its curves were followed: one between two cuts can be missed.
    Scanned,
    /// The complete method lost a path: two assemblies meet, or all but.
    LostPath,
    /// The complete method has more to do than [`WORK_LIMIT`] allows.
    Exhausted,
    /// There are more than [`ASSEMBLY_LIMIT`], or too many ways to try.
    TooMany,
}

/// All ways to put the mechanism together, the one meant first.
#[derive(Clone, Debug, Default)]
pub struct Assemblies {
    /// The assemblies that agree with the file's sides, nearest to its `near` hints first.
    pub list: Vec<Assembly>,
    /// How many more there are when the sides are not asked for.
    pub rejected: usize,
    /// Whether every assembly was found: all blocks were solved in closed form or by the complete method, no path was
    /// lost and no limit was met.
    pub complete: bool,
    /// Why it is not known that every assembly was found; the first reason met.
    pub shortfall: Option<Shortfall>,
    /// What the homotopies did, one entry for each block solved.
    pub paths: Vec<PathReport>,
    /// The step that could not be closed when there is no assembly at all.
    pub open_step: Option<usize>,
}

/// A side that can be checked once its points are placed.
struct SideCheck {
    points: [crate::mechanism::Marker; 3],
    sign: f64,
    after_step: usize,
}

struct Search<'a> {
    mechanism: &'a Mechanism,
    plan: &'a Plan,
    design: &'a Design<f64>,
    size: f64,
    checks: Vec<SideCheck>,
    found: Vec<Assembly>,
    rejected: usize,
    trials: usize,
    shortfall: Option<Shortfall>,
    paths: Vec<PathReport>,
    furthest: usize,
    watch: &'a mut dyn Watch,
    stopped: bool,
    work: f64,
    coordinates: &'a [f64],
    /// Angles of the bodies by the file's hints, zero without: angles count within half a turn of these.
    meant: Vec<f64>,
    /// What was found by cutting the mechanism open at a gear (its constraint): the same for every branch before it.
    opened: Vec<(usize, Vec<Vec<Pose<f64>>>)>,
}

/// Finds all assemblies at the drive coordinates (SI).
pub fn all_assemblies(
    mechanism: &Mechanism,
    plan: &Plan,
    design: &Design<f64>,
    coordinates: &[f64],
) -> Assemblies {
    // Unwatched, it is never stopped.
    find_assemblies(mechanism, plan, design, coordinates, &mut Unwatched).unwrap_or_default()
}

/// As [`all_assemblies`]; `watch` hears how far it has come. `None` when it stops the search: a part of the list could
/// lack the assembly that is meant.
pub fn find_assemblies(
    mechanism: &Mechanism,
    plan: &Plan,
    design: &Design<f64>,
    coordinates: &[f64],
    watch: &mut dyn Watch,
) -> Option<Assemblies> {
    let size = design.geometry.size(mechanism);
    let mut search = Search {
        mechanism,
        plan,
        design,
        size,
        checks: side_checks(mechanism, plan),
        found: Vec::new(),
        rejected: 0,
        trials: 0,
        shortfall: None,
        paths: Vec::new(),
        furthest: 0,
        watch,
        stopped: false,
        work: WORK_LIMIT,
        coordinates,
        meant: meant_angles(mechanism, design),
        opened: Vec::new(),
    };
    let mut state = State::new(mechanism, plan);
    state.set_inputs(mechanism, coordinates);
    let branch = Branch::neutral(mechanism, plan);
    search.descend(0, state, branch, true);
    if search.stopped {
        return None;
    }

    for assembly in &mut search.found {
        assembly.distance = hint_distance(mechanism, design, assembly, size);
    }
    // A stable sort: where the hints say nothing, the order of the search decides, left before right.
    search
        .found
        .sort_by(|a, b| a.distance.total_cmp(&b.distance));
    let open_step = search.found.is_empty().then_some(search.furthest);
    Some(Assemblies {
        list: search.found,
        rejected: search.rejected,
        complete: search.shortfall.is_none(),
        shortfall: search.shortfall,
        paths: search.paths,
        open_step,
    })
}

impl Search<'_> {
    /// Solves the steps from `step` on, in every way there is. `wanted` is false once a side hint failed: such
    /// assemblies are only counted.
    fn descend(
        &mut self,
        mut step: usize,
        mut state: State<f64>,
        mut branch: Branch,
        wanted: bool,
    ) {
        let mut wanted = wanted;
        loop {
            self.trials += 1;
            if self.found.len() >= ASSEMBLY_LIMIT || self.trials > TRIAL_LIMIT {
                self.shortfall.get_or_insert(Shortfall::TooMany);
                return;
            }
            if self.stopped || self.told(None).is_break() {
                return;
            }
            let Some(kind) = self.plan.steps.get(step) else {
                break;
            };
            if let Step::Newton { block } = kind {
                return self.descend_newton(step, *block, state, branch, wanted);
            }
            if kind.has_modes() {
                return self.descend_modes(step, state, branch, wanted);
            }
            if !self.solve(step, 1.0, &mut state, &mut branch) {
                return;
            }
            wanted &= self.sides_hold(step, &state);
            step += 1;
        }
        // Redundant constraints are in no closed form: they hold here, or this is no assembly.
        if !self.plan.decomposition.surplus.is_empty() {
            let residual = closure(self.mechanism, self.design, &branch, &state, self.size);
            if !(residual <= CLOSED) {
                self.furthest = self.furthest.max(step.saturating_sub(1));
                return;
            }
        }
        if wanted {
            let distance = 0.0;
            self.found.push(Assembly {
                branch,
                poses: state.poses,
                distance,
            });
        } else {
            self.rejected += 1;
        }
    }

    /// Says how far the search has come; how many branches there are to try is not known beforehand.
    fn told(&mut self, part: Option<f64>) -> ControlFlow<()> {
        let flow = self.watch.reached(Stage::Assembling, part);
        self.stopped |= flow.is_break();
        flow
    }

    fn descend_modes(&mut self, step: usize, state: State<f64>, branch: Branch, wanted: bool) {
        let mut first: Option<Vec<Pose<f64>>> = None;
        for sign in [1.0, -1.0] {
            let (mut state, mut branch) = (state.clone(), branch.clone());
            branch.signs[step] = sign;
            if !self.solve(step, sign, &mut state, &mut branch) {
                continue;
            }
            // At a dead point both modes are one assembly.
            if let Some(first) = &first
                && self.same(first, &state.poses)
            {
                continue;
            }
            first = Some(state.poses.clone());
            let wanted = wanted && self.sides_hold(step, &state);
            if !wanted && self.rejected >= ASSEMBLY_LIMIT {
                self.shortfall.get_or_insert(Shortfall::TooMany);
                continue;
            }
            self.descend(step + 1, state, branch, wanted);
        }
    }

    fn descend_newton(
        &mut self,
        step: usize,
        block: usize,
        state: State<f64>,
        mut branch: Branch,
        wanted: bool,
    ) {
        let block = &self.plan.newton_blocks[block];
        if let Some(poses) = self.gear_train(block, &state, &mut branch) {
            branch.guess.clone_from(&poses);
            let mut state = state;
            if self.solve(step, 1.0, &mut state, &mut branch) {
                self.descend(step + 1, state, branch, wanted);
            }
            return;
        }
        let situation = state.situation(self.design, &branch);
        // The pose that the file tells is tried as well: no path may lose it.
        let hinted = self.hinted_start(&state);
        let meant = self.meant.clone();
        let mut candidates = vec![hinted];
        let (mechanism, size) = (self.mechanism, self.size);
        let mut work = self.work;
        let told = &mut |part| self.told(Some(part));
        let solutions = all_real_solutions(block, mechanism, &situation, size, &mut work, told);
        self.work = work;
        match solutions {
            Solutions::Stopped => return,
            Solutions::Found(poses, report) => {
                if report.exhausted {
                    self.shortfall.get_or_insert(Shortfall::Exhausted);
                } else if report.lost > 0 {
                    self.shortfall.get_or_insert(Shortfall::LostPath);
                }
                self.paths.push(report);
                candidates.extend(poses);
            }
            Solutions::NotAlgebraic => {
                let Some(opened) = self.opened_at_gear(block, step, &state, &meant) else {
                    self.stopped = true;
                    return;
                };
                self.shortfall.get_or_insert(if opened.is_empty() {
                    Shortfall::Searched
                } else {
                    Shortfall::Scanned
                });
                if opened.is_empty() {
                    candidates.extend(self.random_starts(block, &state));
                }
                candidates.extend(opened);
            }
        }
        let mut found: Vec<(State<f64>, Branch)> = Vec::new();
        for candidate in candidates {
            let (mut state, mut branch) = (state.clone(), branch.clone());
            branch.guess.clone_from(&candidate);
            for unknown in &block.unknowns {
                let body = unknown.body().index();
                branch.near[body] = candidate[body].angle_near(meant[body]);
            }
            if self.solve(step, 1.0, &mut state, &mut branch)
                && self.closes(block, &state, &branch)
                && self.counts_from(block, &state, &branch, &meant)
                && found
                    .iter()
                    .all(|(other, _)| !self.same(&other.poses, &state.poses))
            {
                branch.guess.clone_from(&state.poses);
                found.push((state, branch));
            }
        }
        // In a fixed order: by the angles of the block's bodies.
        found.sort_by(|(a, _), (b, _)| {
            let angles = |s: &State<f64>| -> Vec<f64> {
                block
                    .unknowns
                    .iter()
                    .map(|u| s.poses[u.body().index()].angle_near(0.0))
                    .collect()
            };
            let (a, b) = (angles(a), angles(b));
            a.iter()
                .zip(&b)
                .map(|(x, y)| x.total_cmp(y))
                .find(|o| o.is_ne())
                .unwrap_or(std::cmp::Ordering::Equal)
        });
        for (state, branch) in found {
            let wanted = wanted && self.sides_hold(step, &state);
            self.descend(step + 1, state, branch, wanted);
        }
    }

    /// Solves one step; false when it does not close. Keeps the branch's turn counts and guesses up to date.
    fn solve(
        &mut self,
        step: usize,
        sign: f64,
        state: &mut State<f64>,
        branch: &mut Branch,
    ) -> bool {
        self.plan
            .solve_step(step, sign, self.mechanism, self.design, branch, state);
        for unknown in &self.plan.blocks[step].unknowns {
            let body = unknown.body().index();
            let pose = state.poses[body];
            if !(pose.c.is_finite()
                && pose.s.is_finite()
                && pose.x.is_finite()
                && pose.y.is_finite())
            {
                self.furthest = self.furthest.max(step);
                return false;
            }
            if matches!(unknown, Unknown::Angle(_))
                && !matches!(self.plan.steps[step], Step::Newton { .. })
            {
                branch.near[body] = pose.angle_near(self.meant[body]);
            }
            branch.guess[body] = pose;
        }
        if let Step::Turn {
            body,
            from,
            offset,
            input: Some(drive),
            reversed,
        } = self.plan.steps[step]
        {
            // A driven angle counts its turns.
            let constant = self.design.geometry.angles[offset as usize];
            let turn = state.inputs[drive.index()].value + math::atan2(constant[1], constant[0]);
            branch.near[body.index()] =
                branch.near[from.index()] + if reversed { -turn } else { turn };
        }
        let geared = match self.plan.steps[step] {
            Step::Gear { body, constraint } => Some((body, constraint)),
            Step::Roll {
                own, constraint, ..
            } => Some((own.body, constraint)),
            _ => None,
        };
        if let Some((body, constraint)) = geared {
            let situation = state.situation(self.design, branch);
            if let Some(angle) = gear(&situation, self.mechanism, body, constraint) {
                branch.near[body.index()] = angle;
            }
        }
        true
    }

    /// Angles of a block of gears and angle drives alone: linear equations, one solution.
    fn gear_train(
        &self,
        block: &NewtonBlock,
        state: &State<f64>,
        branch: &mut Branch,
    ) -> Option<Vec<Pose<f64>>> {
        let column = |body: BodyId| {
            block
                .unknowns
                .iter()
                .position(|u| *u == Unknown::Angle(body))
        };
        if block
            .unknowns
            .iter()
            .any(|u| matches!(u, Unknown::Place(_)))
            || block.rows.len() != block.size
        {
            return None;
        }
        let mut qr = Qr::with_capacity(block.size, block.size);
        qr.reset(block.size, block.size);
        let mut rhs = vec![0.0; block.size];
        for (row, entry) in block.rows.iter().enumerate() {
            let (terms, constant) = match self.mechanism.constraints[entry.constraint].0 {
                Constraint::Gears {
                    a,
                    b,
                    arm,
                    constants,
                } => {
                    let k = &self.design.geometry.gears[constants as usize];
                    (
                        [(a, k.first), (b, k.second), (arm, -k.first - k.second)],
                        k.constant,
                    )
                }
                Constraint::Direction {
                    a,
                    b,
                    offset,
                    input,
                } => {
                    let by = self.design.geometry.angles[offset as usize];
                    let drive = input.map_or(0.0, |d| state.inputs[d.index()].value);
                    (
                        [(a, 1.0), (b, -1.0), (b, 0.0)],
                        math::atan2(by[1], by[0]) + drive,
                    )
                }
                _ => return None,
            };
            rhs[row] = constant;
            for (body, factor) in terms {
                match column(body) {
                    Some(column) => qr.add(row, column, factor),
                    None => rhs[row] -= factor * branch.near[body.index()],
                }
            }
        }
        qr.factor();
        qr.solve(&mut rhs);
        let mut poses = state.poses.clone();
        for (unknown, angle) in block.unknowns.iter().zip(&rhs) {
            let body = unknown.body().index();
            poses[body] = Pose::from_angle(poses[body].x, poses[body].y, *angle);
            branch.near[body] = *angle;
        }
        rhs.iter().all(|a| a.is_finite()).then_some(poses)
    }

    fn closes(&self, block: &NewtonBlock, state: &State<f64>, branch: &Branch) -> bool {
        let situation = state.situation(self.design, branch);
        block.rows.iter().all(|row| {
            let residual =
                situation.residual(&self.mechanism.constraints[row.constraint].0)[row.row];
            let constraint = &self.mechanism.constraints[row.constraint].0;
            (residual.abs() <= 1e-9 * self.size.max(f64::MIN_POSITIVE) || residual.abs() <= 1e-12)
                && !situation.is_reversed(constraint)
        })
    }

    /// Whether the wheels of the block's gears and racks stand within half a turn of the angles they are counted from.
    fn counts_from(
        &self,
        block: &NewtonBlock,
        state: &State<f64>,
        branch: &Branch,
        meant: &[f64],
    ) -> bool {
        let constraints = block
            .rows
            .iter()
            .map(|row| &self.mechanism.constraints[row.constraint].0);
        constraints
            .filter(|c| is_gear(c))
            .flat_map(Constraint::bodies)
            .all(|body| {
                let index = body.index();
                let angle = state.poses[index].angle_near(branch.near[index]);
                (angle - meant[index]).abs() <= std::f64::consts::PI + HALF_TURN
            })
    }

    fn sides_hold(&self, step: usize, state: &State<f64>) -> bool {
        self.checks
            .iter()
            .filter(|c| c.after_step == step)
            .all(|check| {
                let [from, to, p] = check
                    .points
                    .map(|m| state.poses[m.body.index()].place(self.design.geometry.marker(m)));
                let line = sub(to, from);
                let side = cross(line, sub(p, from)) * check.sign;
                side >= -ON_THE_LINE * self.size * math::hypot(line[0], line[1])
            })
    }

    fn same(&self, a: &[Pose<f64>], b: &[Pose<f64>]) -> bool {
        a.iter().zip(b).all(|(a, b)| {
            let length = (a.x - b.x).abs().max((a.y - b.y).abs());
            let angle = (a.c - b.c).abs().max((a.s - b.s).abs());
            length <= SAME_POSE * self.size && angle <= SAME_POSE
        })
    }

    /// The pose that the file's `near` hints tell; what they leave open stays.
    fn hinted_start(&self, state: &State<f64>) -> Vec<Pose<f64>> {
        let (mechanism, geometry) = (self.mechanism, &self.design.geometry);
        let parameters = mechanism.model.parameter_values::<f64>();
        let value = |expr: &kempe_model::Scalar| expr.eval(&mut |id| parameters[id.index()]);
        let mut poses = state.poses.clone();
        for hint in &mechanism.model.assembly {
            if let HintKind::NearAngle { link, .. } = &hint.kind {
                let body = mechanism.body_of(*link).index();
                let pose = &mut poses[body];
                *pose = Pose::from_angle(pose.x, pose.y, self.meant[body]);
            }
        }
        for hint in &mechanism.model.assembly {
            let HintKind::NearPlace { point, x, y } = &hint.kind else {
                continue;
            };
            for &link in &mechanism.model.points[point.index()].links {
                let at = kempe_model::LinkPointRef {
                    link,
                    point: *point,
                };
                if let Some(marker) = mechanism.marker(at) {
                    let pose = &mut poses[marker.body.index()];
                    let world = [value(x), value(y)];
                    *pose = Pose::pinned(pose.c, pose.s, geometry.marker(marker), world);
                }
            }
        }
        poses
    }

    /// Poses near those of a block that holds one gear pair or rack, for the poses found so far; none where it holds
    /// more, or cannot be opened. `None` when stopped.
    fn opened_at_gear(
        &mut self,
        block: &NewtonBlock,
        step: usize,
        state: &State<f64>,
        meant: &[f64],
    ) -> Option<Vec<Vec<Pose<f64>>>> {
        let mut gears = (block.rows.iter().map(|row| row.constraint))
            .filter(|index| is_gear(&self.mechanism.constraints[*index].0));
        let (Some(gear), None) = (gears.next(), gears.next()) else {
            return Some(Vec::new());
        };
        if self.opened.iter().all(|(index, _)| *index != gear) {
            let found = open_loop::candidates(
                self.mechanism,
                self.plan,
                self.design,
                self.coordinates,
                (gear, meant),
                self.watch,
            )?;
            self.opened.push((gear, found));
        }
        let before = &self.plan.blocks[..step];
        let fits = |poses: &Vec<Pose<f64>>| {
            before.iter().flat_map(|b| &b.unknowns).all(|unknown| {
                let body = unknown.body().index();
                let (a, b) = (&poses[body], &state.poses[body]);
                match unknown {
                    Unknown::Angle(_) => (a.c - b.c).abs().max((a.s - b.s).abs()) <= SAME_BEFORE,
                    Unknown::Place(_) => {
                        (a.x - b.x).abs().max((a.y - b.y).abs()) <= SAME_BEFORE * self.size
                    }
                }
            })
        };
        let found = self.opened.iter().filter(|(index, _)| *index == gear);
        Some(
            found
                .flat_map(|(_, list)| list)
                .filter(|p| fits(p))
                .cloned()
                .collect(),
        )
    }

    /// Starts spread over the mechanism's surroundings, for blocks with gears or too many paths.
    fn random_starts(&self, block: &NewtonBlock, state: &State<f64>) -> Vec<Vec<Pose<f64>>> {
        let mut random = Random(0x005e_ed0f_ba11);
        let reach = 4.0 * self.size;
        let mut starts = Vec::with_capacity(SEARCH_STARTS);
        for _ in 0..SEARCH_STARTS {
            let mut poses = state.poses.clone();
            for unknown in &block.unknowns {
                let pose = &mut poses[unknown.body().index()];
                match unknown {
                    Unknown::Angle(_) => {
                        (pose.s, pose.c) = math::sin_cos(random.next() * std::f64::consts::TAU);
                    }
                    Unknown::Place(_) => {
                        pose.x = (random.next() - 0.5) * reach;
                        pose.y = (random.next() - 0.5) * reach;
                    }
                }
            }
            starts.push(poses);
        }
        starts
    }
}

/// Angles of the bodies by the file's hints; zero where there is none.
fn meant_angles(mechanism: &Mechanism, design: &Design<f64>) -> Vec<f64> {
    let parameters = mechanism.model.parameter_values::<f64>();
    let mut meant = vec![0.0; mechanism.bodies];
    for hint in &mechanism.model.assembly {
        if let HintKind::NearAngle { link, angle } = &hint.kind {
            let value = angle.eval(&mut |id| parameters[id.index()]);
            meant[mechanism.body_of(*link).index()] =
                value - design.geometry.seat_angles[link.index()];
        }
    }
    meant
}

fn is_gear(constraint: &Constraint) -> bool {
    matches!(
        constraint,
        Constraint::Gears { .. } | Constraint::Rack { .. }
    )
}

fn side_checks(mechanism: &Mechanism, plan: &Plan) -> Vec<SideCheck> {
    // A body is placed once the last step that seeks anything of it is done.
    let mut placed_after = vec![0; mechanism.bodies];
    for (step, block) in plan.blocks.iter().enumerate() {
        for unknown in &block.unknowns {
            placed_after[unknown.body().index()] = step;
        }
    }
    mechanism
        .model
        .assembly
        .iter()
        .filter_map(|hint| match hint.kind {
            HintKind::Side {
                point,
                side,
                from,
                to,
            } => {
                let points = [from, to, point].map(|p| mechanism.any_marker(p));
                let points = [points[0]?, points[1]?, points[2]?];
                let after_step = points
                    .iter()
                    .map(|m| placed_after[m.body.index()])
                    .max()
                    .unwrap_or(0);
                Some(SideCheck {
                    points,
                    sign: side.sign(),
                    after_step,
                })
            }
            _ => None,
        })
        .collect()
}

/// How far an assembly is from the file's `near` hints.
fn hint_distance(
    mechanism: &Mechanism,
    design: &Design<f64>,
    assembly: &Assembly,
    size: f64,
) -> f64 {
    let parameters = mechanism.model.parameter_values::<f64>();
    let value = |expr: &kempe_model::Scalar| expr.eval(&mut |id| parameters[id.index()]);
    let (mut sum, mut count) = (0.0, 0);
    for hint in &mechanism.model.assembly {
        match &hint.kind {
            HintKind::NearPlace { point, x, y } => {
                let Some(marker) = mechanism.any_marker(*point) else {
                    continue;
                };
                let p = assembly.poses[marker.body.index()].place(design.geometry.marker(marker));
                let (dx, dy) = (p[0] - value(x), p[1] - value(y));
                sum += dx * dx + dy * dy;
                count += 1;
            }
            HintKind::NearAngle { link, angle } => {
                let seat = design.geometry.seat_angles[link.index()];
                let body = mechanism.body_of(*link);
                let wanted = value(angle);
                let off =
                    (assembly.poses[body.index()].angle_near(wanted - seat) + seat - wanted) * size;
                sum += off * off;
                count += 1;
            }
            HintKind::Side { .. } => {}
        }
    }
    if count == 0 {
        0.0
    } else {
        (sum / count as f64).sqrt()
    }
}

/// Runs the whole plan on plain numbers from a branch; `None` when it does not close.
pub fn solve_plain(
    mechanism: &Mechanism,
    plan: &Plan,
    design: &Design<f64>,
    branch: &Branch,
    coordinates: &[f64],
) -> Option<State<f64>>
where
    f64: PlanNumber,
{
    let mut state = State::new(mechanism, plan);
    state.set_inputs(mechanism, coordinates);
    plan.solve(mechanism, design, branch, &mut state);
    let finite =
        |p: &Pose<f64>| p.x.is_finite() && p.y.is_finite() && p.c.is_finite() && p.s.is_finite();
    (1..mechanism.bodies)
        .all(|b| finite(&state.poses[BodyId(b as u32).index()]))
        .then_some(state)
}
