//! Proofs that poses exist and are the only ones: of one pose, and of a whole motion.
//!
//! A [`Certificate`] is a proof by interval arithmetic about the mechanism whose dimensions are exactly the numbers
//! the model holds in SI (`f64`), at exactly the drive coordinate asked for. Rounding is enclosed, so nothing rests on
//! a tolerance.
//!
//! * [`Certifier::pose`] runs the plan on intervals. A closed form has two assemblies, told apart by the sign of its
//!   determinant: where the radicand's interval is positive the pose on the branch exists and is the only one with that
//!   sign. A Newton block is proved by Krawczyk's operator (module `krawczyk`): its pose is the only one in a box.
//! * [`Certifier::near`] proves the pose next to a given one, all bodies at once, whatever the plan.
//! * [`Certifier::motion`] covers the motion by stretches of the path parameter. For each it proves that in a tube about
//!   the tangent at the stretch's middle there is exactly one pose for every parameter, and that it moves smoothly with
//!   it (the Jacobian is regular in all of the tube). Where the pose at a common end of two stretches is proved to lie
//!   in both tubes, both hold one and the same branch.
//!
//! At change points and limits the Jacobian is singular and nothing can be proved by these means: a neighbourhood is
//! left over and reported as a [`Gap`].
//!
//! Redundant constraints agree on paper and not in floating-point dimensions, so their agreement can not be proved. The
//! proof is then about the other constraints; how many were left out is counted, and that their residuals may vanish is
//! checked.

use std::fmt;
use std::ops::ControlFlow;

use kempe_model::LawPiece;
use kempe_number::{Interval, Jet, Number, math};

use crate::blocks::Row;
use crate::bridge::{SIDE_ORDER, join};
use crate::constraint::Situation;
use crate::drive_path::DrivePath;
use crate::events::EventKind;
use crate::evidence::is_finite;
use crate::geometry::Geometry;
use crate::krawczyk::{Curve, Given, Middle, System, Tube, enclose_block, middle_of};
use crate::mechanism::{BodyId, Mechanism};
use crate::motion::{Motion, Solver};
use crate::plan::Step;
use crate::pose::Pose;
use crate::state::{Design, input_of};

/// The pose proved may differ this much from the one followed (mechanism sizes and rad), or it is another one.
const SAME: f64 = 1e-6;

/// Why a pose is not proved.
#[derive(Clone, Debug, PartialEq)]
pub enum NotProved {
    /// The path parameter lies beyond the motion.
    NotReached,
    /// A drive's law goes from one piece to the next inside the interval.
    Break,
    /// On plain numbers no pose was found that could be proved, or another one than was followed.
    NoPose,
    /// The two assemblies of a step are not told apart: they meet in the interval, or it is too wide.
    Modes {
        /// Index of the step in the plan.
        step: usize,
        /// The bodies that the step places.
        bodies: Vec<BodyId>,
    },
    /// The Jacobian is singular.
    Singular,
    /// No box was found that Krawczyk's operator maps into itself: singular, or the interval is too wide.
    Wide,
    /// The pose is proved but for redundant constraints, whose agreement can not be proved.
    Redundant {
        /// How many rows.
        rows: usize,
    },
    /// A redundant constraint certainly does not hold.
    Contradiction {
        /// Index of the constraint.
        constraint: usize,
    },
}

impl fmt::Display for NotProved {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotReached => write!(f, "the motion does not reach this place"),
            Self::Break => write!(f, "a drive's law changes its piece inside the interval"),
            Self::NoPose => write!(f, "no pose was found that could be proved"),
            Self::Modes { step, .. } => {
                write!(
                    f,
                    "two assemblies of step {step} of the plan are not told apart"
                )
            }
            Self::Singular => write!(f, "the constraint Jacobian is singular"),
            Self::Wide => write!(
                f,
                "Krawczyk's operator does not contract: nearly singular, or the interval is too wide"
            ),
            Self::Redundant { rows } => write!(
                f,
                "{rows} redundant constraint rows are left out of the proof: that they agree can not be proved"
            ),
            Self::Contradiction { constraint } => {
                write!(f, "redundant constraint {constraint} does not hold")
            }
        }
    }
}

impl NotProved {
    /// The reason with the mechanism's own names.
    pub fn describe(&self, mechanism: &Mechanism) -> String {
        match self {
            Self::Modes { bodies, .. } => {
                let names: Vec<String> = bodies.iter().map(|b| mechanism.body_name(*b)).collect();
                format!(
                    "the two assemblies of {} are not told apart",
                    names.join(" and ")
                )
            }
            other => other.to_string(),
        }
    }
}

/// What was proved about a pose, for one path parameter or for every one in an interval.
#[derive(Clone, Debug)]
pub struct Certificate {
    /// The path parameters.
    pub at: Interval,
    /// Proved: there is a pose that satisfies every constraint.
    pub exists: bool,
    /// Proved: there is no other with the branch's assembly modes (closed forms), in the box (Newton blocks).
    pub unique: bool,
    /// Where the bodies are; empty intervals where nothing was proved.
    pub poses: Vec<Pose<Interval>>,
    /// Determinant of every step (a signed length or area): away from zero where its assemblies are told apart.
    pub determinants: Vec<Interval>,
    /// Widest interval: lengths in mechanism sizes, directions as numbers.
    pub widest: f64,
    /// What is missing from a full proof.
    pub reason: Option<NotProved>,
}

/// How finely a motion is cut up for its proof.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Subdivision {
    /// Stretches to begin with, between events.
    pub start: usize,
    /// A stretch that is not wider than this (in path scales: rad for an angle) and not proved becomes a gap.
    pub narrowest: f64,
}

impl Default for Subdivision {
    fn default() -> Self {
        Self {
            start: 8,
            narrowest: 1e-6,
        }
    }
}

/// A stretch of the motion that is proved.
#[derive(Clone, Debug)]
pub struct Cell {
    /// Path parameter at its low end.
    pub from: f64,
    /// Path parameter at its high end.
    pub to: f64,
    /// Where the bodies are during the stretch.
    pub poses: Vec<Pose<Interval>>,
    /// Smallest half width of the tube in which the pose is the only one (mechanism sizes and rad).
    pub tube: f64,
    /// How far from the tangent the pose may be, at most (mechanism sizes and rad).
    pub widest: f64,
    /// Proved to be the same branch as the stretch before, which ends where this one begins.
    pub joined: bool,
}

/// A stretch that is not proved.
#[derive(Clone, Debug, PartialEq)]
pub struct Gap {
    /// Path parameter at its low end.
    pub from: f64,
    /// Path parameter at its high end.
    pub to: f64,
    /// Why the last try failed.
    pub reason: NotProved,
    /// What the motion met in it (ends included), if anything.
    pub event: Option<EventKind>,
}

/// What was proved about a motion.
#[derive(Clone, Debug)]
pub struct CertifiedMotion {
    /// The reached range of the path parameter.
    pub range: (f64, f64),
    /// Proved stretches, in order.
    pub cells: Vec<Cell>,
    /// What is left over, in order.
    pub gaps: Vec<Gap>,
    /// Longest stretches that are proved to be one smooth branch without a break.
    pub runs: Vec<(f64, f64)>,
    /// Proved part of the range.
    pub fraction: f64,
    /// Redundant constraint rows that are left out of the proof.
    pub redundant: usize,
    /// False when it was stopped on the way: the rest is in neither list.
    pub finished: bool,
}

/// Proves poses of a motion.
pub struct Certifier<'a> {
    motion: &'a Motion<'a>,
    design: Design<Interval>,
    rich: Geometry<Curve>,
    side: Design<Jet<f64, SIDE_ORDER>>,
    system: System,
    idle: Vec<BodyId>,
    surplus: Vec<Row>,
    breaks: Vec<f64>,
    plain: Solver<f64>,
    wide: Solver<Interval>,
}

/// Proves the pose of a motion at a path parameter, or says why it can not: see [`Certifier::pose`].
pub fn certify_pose(motion: &Motion<'_>, p: f64) -> Certificate {
    Certifier::new(motion).pose(Interval::from_f64(p))
}

/// Proves a whole motion, stretch by stretch: see [`Certifier::motion`].
pub fn certify_motion(
    motion: &Motion<'_>,
    subdivision: Subdivision,
    progress: impl FnMut(f64) -> ControlFlow<()>,
) -> CertifiedMotion {
    Certifier::new(motion).motion(subdivision, progress)
}

impl<'a> Certifier<'a> {
    /// Prepares the dimensions as intervals.
    pub fn new(motion: &'a Motion<'a>) -> Self {
        let (mechanism, plan) = (motion.mechanism, motion.plan);
        let model = &mechanism.model;
        let decomposition = &plan.decomposition;
        Self {
            design: Design::new(mechanism, plan, &model.parameter_values::<Interval>()),
            rich: Geometry::new(mechanism, &model.parameter_values::<Curve>()),
            side: Design::new(mechanism, plan, &model.parameter_values()),
            system: System::whole(mechanism, plan),
            idle: decomposition.idle.clone(),
            surplus: decomposition.surplus.clone(),
            breaks: breaks(motion),
            plain: motion.solver(),
            wide: motion.solver(),
            motion,
        }
    }

    /// The pose on the motion's branch for every path parameter in `p`, by the plan run on intervals.
    ///
    /// Its boxes grow with the width of `p`; for wide stretches [`Certifier::motion`] is made.
    pub fn pose(&mut self, p: Interval) -> Certificate {
        let outcome = self.run_plan(p);
        self.conclude(p, outcome)
    }

    /// The pose next to `poses` at the path parameter `p`, all bodies at once. What is proved to be unique is the pose
    /// in a box about it, not the branch; a pose that is not one is not proved.
    pub fn near(&mut self, p: f64, poses: &[Pose<f64>]) -> Certificate {
        let at = Interval::from_f64(p);
        self.wide.state.determinants.fill(Interval::EMPTY);
        let outcome = self.prepare(at).and_then(|()| {
            let near: Vec<f64> = poses.iter().map(|q| math::atan2(q.s, q.c)).collect();
            let turns = near.iter().zip(&self.plain.branch.near);
            let near: Vec<f64> = turns
                .map(|(a, b)| a + ((b - a) / std::f64::consts::TAU).round() * std::f64::consts::TAU)
                .collect();
            self.plain.branch.near = near;
            let before = middle_of(poses, &self.plain.branch.near);
            let mut middle = before.clone();
            let size = self.motion.size();
            let given = Given {
                mechanism: self.motion.mechanism,
                geometry: &self.design.geometry,
                plain: &self.design.plain[0],
                inputs: &self.wide.state.inputs,
                near: &self.plain.branch.near,
                size,
            };
            self.system
                .enclose(&given, &mut middle, &mut self.wide.state.poses)?;
            if same(&before, &middle, size) {
                Ok(())
            } else {
                Err(NotProved::NoPose)
            }
        });
        self.conclude(at, outcome)
    }

    /// Covers the motion with proved stretches, cutting in two what can not be proved until it is narrow.
    ///
    /// `progress` is told the finished part after every stretch and may stop the work.
    pub fn motion(
        &mut self,
        subdivision: Subdivision,
        mut progress: impl FnMut(f64) -> ControlFlow<()>,
    ) -> CertifiedMotion {
        let range = self.motion.reached();
        let scale = crate::trace::Path::scale(&self.motion.path);
        let mut it = CertifiedMotion {
            range,
            cells: Vec::new(),
            gaps: Vec::new(),
            runs: Vec::new(),
            fraction: 0.0,
            redundant: self.surplus.len(),
            finished: true,
        };
        let mut ends = vec![range.0, range.1];
        ends.extend(self.motion.events.iter().map(|e| e.at));
        ends.extend(&self.breaks);
        ends.retain(|p| range.0 <= *p && *p <= range.1);
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        let parts = subdivision.start.max(1);
        let mut stack: Vec<(f64, f64)> = Vec::new();
        for pair in ends.windows(2) {
            let at = |k: usize| match k {
                0 => pair[0],
                _ if k == parts => pair[1],
                _ => pair[0] + (pair[1] - pair[0]) * (k as f64 / parts as f64),
            };
            stack.extend((0..parts).map(|k| (at(k), at(k + 1))));
        }
        stack.reverse();
        let mut last: Option<Tube> = None;
        while let Some((from, to)) = stack.pop() {
            let middle = 0.5 * (from + to);
            match self.cell(from, to) {
                Ok((mut cell, tube)) => {
                    cell.joined = last.as_ref().is_some_and(|before| {
                        before.range.hi() == from && self.joins(before, &tube, from)
                    });
                    it.take_cell(cell);
                    last = Some(tube);
                }
                Err(_)
                    if to - from > subdivision.narrowest * scale
                        && from < middle
                        && middle < to =>
                {
                    stack.extend([(middle, to), (from, middle)]);
                    continue;
                }
                Err(reason) => it.take_gap(from, to, reason),
            }
            if progress((to - range.0) / (range.1 - range.0)).is_break() {
                it.finished = stack.is_empty();
                break;
            }
        }
        for gap in &mut it.gaps {
            let events = &self.motion.events;
            let met = events.iter().find(|e| gap.from <= e.at && e.at <= gap.to);
            gap.event = met.map(|e| e.kind);
        }
        let proved: f64 = it.cells.iter().map(|c| c.to - c.from).sum();
        it.fraction = match it.gaps.is_empty() && it.finished {
            true if !it.cells.is_empty() => 1.0,
            _ => proved / (range.1 - range.0),
        };
        it
    }

    /// Fills the branch, the coordinates and the poses that are known beforehand.
    fn prepare(&mut self, p: Interval) -> Result<(), NotProved> {
        let motion = self.motion;
        if !(motion.reaches(p.lo()) && motion.reaches(p.hi())) {
            return Err(NotProved::NotReached);
        }
        if self.breaks.iter().any(|b| p.lo() < *b && *b < p.hi()) {
            return Err(NotProved::Break);
        }
        motion.branch_at(p.midpoint(), &mut self.plain.branch);
        motion.path.coordinates(p, &mut self.wide.coordinates);
        self.wide
            .state
            .set_inputs(motion.mechanism, &self.wide.coordinates);
        self.wide.state.poses.fill(Pose::identity());
        Ok(())
    }

    fn run_plan(&mut self, p: Interval) -> Result<(), NotProved> {
        self.wide.state.determinants.fill(Interval::EMPTY);
        self.prepare(p)?;
        let (mechanism, plan) = (self.motion.mechanism, self.motion.plan);
        let (branch, state) = (&self.plain.branch, &mut self.wide.state);
        for (index, step) in plan.steps.iter().enumerate() {
            if let Step::Newton { block } = step {
                let block = &plan.newton_blocks[*block];
                state.determinants[index] =
                    enclose_block(block, mechanism, &self.design, branch, state)?;
                continue;
            }
            plan.solve_step(
                index,
                branch.signs[index],
                mechanism,
                &self.design,
                branch,
                state,
            );
            let determinant = state.determinants[index];
            let mut bodies: Vec<BodyId> = plan.blocks[index]
                .unknowns
                .iter()
                .map(|u| u.body())
                .collect();
            bodies.dedup();
            let bounded = bodies.iter().all(|b| is_bounded(&state.poses[b.index()]));
            if determinant.is_empty() || determinant.contains_zero() || !bounded {
                return Err(NotProved::Modes {
                    step: index,
                    bodies,
                });
            }
        }
        Ok(())
    }

    /// Puts a certificate together.
    fn conclude(&self, at: Interval, outcome: Result<(), NotProved>) -> Certificate {
        let bodies = self.motion.mechanism.bodies;
        let nothing = Pose {
            x: Interval::EMPTY,
            y: Interval::EMPTY,
            c: Interval::EMPTY,
            s: Interval::EMPTY,
        };
        let unique = outcome.is_ok();
        let redundant = outcome.and_then(|()| self.check_redundant());
        let size = self.motion.size();
        let poses = if unique {
            self.wide.state.poses.clone()
        } else {
            vec![nothing; bodies]
        };
        let widest = poses.iter().map(|q| widest(q, size)).fold(0.0, math::max);
        Certificate {
            at,
            exists: redundant.is_ok(),
            unique,
            poses,
            determinants: self.wide.state.determinants.clone(),
            widest,
            reason: redundant.err(),
        }
    }

    /// Whether there are redundant rows, and whether they may hold.
    fn check_redundant(&self) -> Result<(), NotProved> {
        let mechanism = self.motion.mechanism;
        let state = &self.wide.state;
        let situation = Situation {
            geometry: &self.design.geometry,
            inputs: &state.inputs,
            poses: &state.poses,
            near: &self.plain.branch.near,
        };
        for row in &self.surplus {
            let residual = situation.residual(&mechanism.constraints[row.constraint].0)[row.row];
            // Dimensions that agree on paper miss by a few roundings.
            let slack = 1e-12 * self.motion.size();
            if residual.mig() > slack {
                return Err(NotProved::Contradiction {
                    constraint: row.constraint,
                });
            }
        }
        match self.surplus.len() {
            0 => Ok(()),
            rows => Err(NotProved::Redundant { rows }),
        }
    }

    /// Where the traced branch is at a path parameter, to full accuracy: solved, or joined across a change point.
    fn traced(&mut self, p: f64) -> Result<Middle, NotProved> {
        let motion = self.motion;
        if let Some(event) = motion.bridge(p) {
            let (at, half) = (event.at, event.bridge);
            let mut solver = motion.solver();
            motion.solve(&self.side, Jet::variable(at - half), &mut solver);
            let low = solver.state.poses.clone();
            motion.solve(&self.side, Jet::variable(at + half), &mut solver);
            motion.branch_at(p, &mut self.plain.branch);
            let sides = low.iter().zip(&solver.state.poses);
            for (pose, (low, high)) in self.plain.state.poses.iter_mut().zip(sides) {
                let joined = |a, b| join::<1>(a, b, half, p - at).coefficient(0);
                *pose = Pose {
                    x: joined(&low.x, &high.x),
                    y: joined(&low.y, &high.y),
                    c: joined(&low.c, &high.c),
                    s: joined(&low.s, &high.s),
                };
            }
        } else {
            motion.solve(motion.design, p, &mut self.plain);
        }
        let poses = &self.plain.state.poses;
        if !poses.iter().all(is_finite) {
            return Err(NotProved::NoPose);
        }
        Ok(middle_of(poses, &self.plain.branch.near))
    }

    /// Proves the stretch from one path parameter to another.
    fn cell(&mut self, from: f64, to: f64) -> Result<(Cell, Tube), NotProved> {
        let range = Interval::new(from, to);
        self.prepare(range)?;
        let at = range.midpoint();
        let traced = self.traced(at)?;
        let motion = self.motion;
        let size = motion.size();
        let drives = &motion.mechanism.model.drives;
        let mut coordinates = vec![Curve::zero(); drives.len()];
        let mut curve = |p: Curve| {
            motion.path.coordinates(p, &mut coordinates);
            drives
                .iter()
                .zip(&coordinates)
                .map(|(drive, q)| input_of(drive, *q))
                .collect()
        };
        let given = Given {
            mechanism: motion.mechanism,
            geometry: &self.design.geometry,
            plain: &self.design.plain[0],
            inputs: &self.wide.state.inputs,
            near: &self.plain.branch.near,
            size,
        };
        let poses = &mut self.wide.state.poses;
        let tube = self.system.tube(
            &given,
            &self.rich,
            (at, range),
            traced.clone(),
            poses,
            &mut curve,
        )?;
        if !same_but(&self.idle, &traced, &tube.middle, size) {
            return Err(NotProved::NoPose);
        }
        if let Err(reason @ NotProved::Contradiction { .. }) = self.check_redundant() {
            return Err(reason);
        }
        let cell = Cell {
            from,
            to,
            poses: self.wide.state.poses.clone(),
            tube: self.system.narrowest(&tube.radii, size),
            widest: self.system.widest(&tube.image, size),
            joined: false,
        };
        Ok((cell, tube))
    }

    /// Whether the pose at `p` is proved to be the pose of both tubes.
    fn joins(&mut self, before: &Tube, after: &Tube, p: f64) -> bool {
        let mut attempt = || -> Result<bool, NotProved> {
            self.prepare(Interval::from_f64(p))?;
            let mut middle = self.traced(p)?;
            let size = self.motion.size();
            let given = Given {
                mechanism: self.motion.mechanism,
                geometry: &self.design.geometry,
                plain: &self.design.plain[0],
                inputs: &self.wide.state.inputs,
                near: &self.plain.branch.near,
                size,
            };
            let poses = &mut self.wide.state.poses;
            let (image, _) = self.system.enclose(&given, &mut middle, poses)?;
            Ok([before, after]
                .iter()
                .all(|tube| self.system.is_in_tube(tube, p, &middle, &image)))
        };
        attempt().unwrap_or(false)
    }
}

impl CertifiedMotion {
    fn take_cell(&mut self, cell: Cell) {
        match self.runs.last_mut() {
            Some(run) if cell.joined => run.1 = cell.to,
            _ => self.runs.push((cell.from, cell.to)),
        }
        self.cells.push(cell);
    }

    fn take_gap(&mut self, from: f64, to: f64, reason: NotProved) {
        match self.gaps.last_mut() {
            Some(gap) if gap.to == from => {
                gap.to = to;
                gap.reason = reason;
            }
            _ => self.gaps.push(Gap {
                from,
                to,
                reason,
                event: None,
            }),
        }
    }
}

/// Path parameters at which the drives' coordinates are not smooth.
fn breaks(motion: &Motion<'_>) -> Vec<f64> {
    let DrivePath::Time {
        laws, parameters, ..
    } = &motion.path
    else {
        return Vec::new();
    };
    let mut list = Vec::new();
    for law in laws {
        let starts = law.breaks(parameters);
        for (piece, start) in law.pieces.iter().zip(&starts) {
            if let LawPiece::Table { times, .. } = piece {
                list.extend(times.iter().map(|t| start + t));
            }
        }
        list.extend(starts);
    }
    list
}

fn same(a: &Middle, b: &Middle, size: f64) -> bool {
    same_but(&[], a, b, size)
}

/// Whether two poses are one, but for idle angles.
fn same_but(idle: &[BodyId], a: &Middle, b: &Middle, size: f64) -> bool {
    a.iter().zip(b).enumerate().all(|(body, (a, b))| {
        let turned = idle.iter().any(|i| i.index() == body) || (a[2] - b[2]).abs() < SAME;
        turned && (a[0] - b[0]).abs() < SAME * size && (a[1] - b[1]).abs() < SAME * size
    })
}

fn is_bounded(pose: &Pose<Interval>) -> bool {
    [pose.x, pose.y, pose.c, pose.s]
        .iter()
        .all(|v| v.is_finite() && v.mag() < f64::MAX)
}

fn widest(pose: &Pose<Interval>, size: f64) -> f64 {
    let length = math::max(pose.x.width(), pose.y.width()) / size;
    math::max(length, math::max(pose.c.width(), pose.s.width()))
}
