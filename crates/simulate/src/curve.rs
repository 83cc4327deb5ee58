//! Poses along the followed motion of one coordinate, the others at rest: the branch is known, and passes over change points.

use std::f64::consts::TAU;
use std::sync::Arc;

use kempe_dynamics::{Instant, Rates};
use kempe_measure::state::Abscissa;
use kempe_measure::{Series, State};
use kempe_mechanism::evidence::is_finite;
use kempe_mechanism::pose::Pose;
use kempe_mechanism::{BodyId, Design, PlanNumber};
use kempe_model::DriveId;
use kempe_motion::bridge::{SideSeries, across};
use kempe_motion::trace::Path as _;
use kempe_motion::{EndReason, Motion, MotionError, Progress, Solver};
use kempe_number::Jet;
use kempe_units::Dimension;

use crate::start::{Start, along};

/// How far (in path scales: rad, or mechanism sizes) the motion is known to both sides at first.
const FIRST: f64 = TAU;
/// It is followed on where less than this is known ahead.
const AHEAD: f64 = 1.0;
/// Steps towards an end of the motion become too short this near to it (in path scales).
const AT_END: f64 = 1e-3;
/// Poses this near (in mechanism sizes and rad) after a turn of the drive are those before: the curve is closed.
const CLOSED: f64 = 1e-9;

/// The followed motion of one coordinate.
pub(crate) struct Curve {
    start: Start,
    motion: Arc<Motion>,
    drive: usize,
    /// Where the curve is closed: how often every body turns while the drive turns once.
    turns: Option<Vec<f64>>,
    design: Design<Rates>,
    solver: Solver<Rates>,
    rich: Arc<Design<Series<f64>>>,
    rich_solver: Solver<Series<f64>>,
    side_design: Design<SideSeries>,
    side: Solver<SideSeries>,
    near: Vec<f64>,
}

impl Curve {
    pub fn new(
        start: Start,
        drive: DriveId,
        progress: &mut dyn Progress,
    ) -> Result<Self, MotionError> {
        let (drive, at) = (drive.index(), start.coordinates[drive.index()]);
        let model = &start.design.mechanism.model;
        let is_angle = model.drives[drive].dimension == Dimension::ANGLE;
        let scale = if is_angle { 1.0 } else { start.design.size() };
        let motion = along(
            &start,
            drive,
            (at - FIRST * scale, at + FIRST * scale),
            progress,
        )?;
        let mut it = Self {
            design: motion.design_on(),
            solver: motion.solver(),
            rich: Arc::new(motion.design_on()),
            rich_solver: motion.solver(),
            side_design: motion.design_on(),
            side: motion.solver(),
            near: vec![0.0; start.design.mechanism.bodies],
            turns: None,
            start,
            motion,
            drive,
        };
        if is_angle {
            it.turns = it.closed(at, 1.0).or_else(|| it.closed(at, -1.0));
        }
        Ok(it)
    }

    /// Whether branches cross at the start.
    pub fn starts_at_change_point(&self) -> bool {
        self.motion.start_crossing().is_some()
    }

    /// How often every body turns while the drive turns once from its start, where everything is then as before.
    fn closed(&self, at: f64, sense: f64) -> Option<Vec<f64>> {
        let mut solver = self.motion.solver();
        let before = self.motion.placed(at, &mut solver)?;
        let after = self.motion.placed(at + sense * TAU, &mut solver)?;
        let size = self.motion.size();
        let same = |(a, b): (&Pose<f64>, &Pose<f64>)| a.apart(b, size) <= CLOSED;
        let turned = before.near.iter().zip(&after.near);
        (before.poses.iter().zip(&after.poses).all(same)).then(|| {
            turned
                .map(|(a, b)| sense * ((b - a) / TAU).round())
                .collect()
        })
    }

    /// The place on the known motion of a coordinate, and how many turns of the drive lie between.
    fn place(&self, q: f64) -> (f64, f64) {
        if self.turns.is_none() || self.motion.reaches(q) {
            return (q, 0.0);
        }
        let turns = ((q - self.start.coordinates[self.drive]) / TAU).round();
        (q - turns * TAU, turns)
    }

    /// Whether the motion is known to be long enough around a coordinate, or to end there.
    fn is_known_about(&self, q: f64) -> bool {
        let (low, high) = self.motion.reached();
        let ahead = AHEAD * self.motion.path.scale();
        let ends = self.motion.ends;
        self.turns.is_some()
            || ((q - low >= ahead || ends.0 != EndReason::Covered)
                && (high - q >= ahead || ends.1 != EndReason::Covered))
    }

    /// Follows the motion on where it is not known about a coordinate.
    pub fn follow(&mut self, q: f64, progress: &mut dyn Progress) -> Result<(), MotionError> {
        if self.is_known_about(q) {
            return Ok(());
        }
        let (mut low, mut high) = self.motion.reached();
        let more = high - low;
        let ends = self.motion.ends;
        while q < low + 0.5 * more && ends.0 == EndReason::Covered {
            low -= more;
        }
        while q > high - 0.5 * more && ends.1 == EndReason::Covered {
            high += more;
        }
        self.motion = along(&self.start, self.drive, (low, high), progress)?;
        Ok(())
    }

    /// Why the motion goes no farther than a coordinate, where it is at its end.
    pub fn end_at(&self, q: f64) -> Option<EndReason> {
        let (low, high) = self.motion.reached();
        let near = AT_END * self.motion.path.scale();
        let end = |at: f64, reason: EndReason| {
            ((q - at).abs() <= near && reason != EndReason::Covered && self.turns.is_none())
                .then_some(reason)
        };
        end(low, self.motion.ends.0).or_else(|| end(high, self.motion.ends.1))
    }

    /// The instant at a coordinate and its speed, not accelerating; false where no pose is known.
    pub fn instant(&mut self, q: f64, speed: f64, out: &mut Instant<f64>) -> bool {
        let (p, turns) = self.place(q);
        let sides = (&self.side_design, &mut self.side);
        if !solve(&self.motion, &self.design, &mut self.solver, [p, q], sides) {
            return false;
        }
        turn_on(
            &mut self.near,
            &self.solver.branch.near,
            self.turns.as_deref(),
            turns,
        );
        let drive = DriveId(self.drive as u32);
        out.set_along(&self.solver.state, &self.near, drive, [speed, 0.0]);
        true
    }

    /// The state at a time, for measures.
    pub fn state(&mut self, time: f64, [q, v, a]: [f64; 3]) -> Option<State<f64>> {
        let (p, turns) = self.place(q);
        let sides = (&self.side_design, &mut self.side);
        if !solve(
            &self.motion,
            &self.rich,
            &mut self.rich_solver,
            [p, q],
            sides,
        ) {
            return None;
        }
        turn_on(
            &mut self.near,
            &self.rich_solver.branch.near,
            self.turns.as_deref(),
            turns,
        );
        let mut poses = self.rich_solver.state.poses.clone();
        poses[BodyId::GROUND.index()] = Pose::identity();
        Some(State {
            design: self.rich.clone(),
            time,
            abscissa: Abscissa {
                drive: Some(DriveId(self.drive as u32)),
                clock: Series::from_coefficients([q, v, 0.5 * a, 0.0, 0.0]),
                heading: if v < 0.0 { -1.0 } else { 1.0 },
                unit: self.motion.path.scale(),
            },
            coordinates: self.rich_solver.coordinates.clone(),
            near: self.near.clone(),
            alone: vec![None; self.motion.mechanism().model.drives.len()],
            inner: Vec::new(),
            poses,
        })
    }
}

/// Solves the poses along the coordinate at a place of the motion, joined from both sides at a change point; `q` is the coordinate
/// there, so many turns on. False where no pose is known.
fn solve<const N: usize>(
    motion: &Motion,
    design: &Design<Jet<f64, N>>,
    solver: &mut Solver<Jet<f64, N>>,
    [p, q]: [f64; 2],
    (side_design, side): (&Design<SideSeries>, &mut Solver<SideSeries>),
) -> bool
where
    Jet<f64, N>: PlanNumber,
{
    if !motion.reaches(p) || motion.limit_at(p).is_some() {
        return false;
    }
    let known = match motion.bridge(p) {
        Some(event) => {
            motion.branch_at(p, &mut solver.branch);
            solver.state.poses = across(motion, side_design, event, p, side);
            false
        }
        None => {
            motion.solve_alone(design, Jet::variable(p), solver);
            p == q
        }
    };
    if !known {
        let coordinates = &mut solver.coordinates;
        (motion.path).coordinates_for(Jet::variable(q), &[], coordinates);
        solver.state.set_inputs(motion.mechanism(), coordinates);
    }
    solver
        .state
        .poses
        .iter()
        .all(|pose| is_finite(&pose.value()))
}

/// The angles of the bodies so many turns of the drive on, of which each turns every body so often.
fn turn_on(out: &mut [f64], near: &[f64], each: Option<&[f64]>, turns: f64) {
    out.copy_from_slice(near);
    if let Some(each) = each.filter(|_| turns != 0.0) {
        for (angle, each) in out.iter_mut().zip(each) {
            *angle += turns * each * TAU;
        }
    }
}
