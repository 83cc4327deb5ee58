//! The states of a motion along its drives' path: anywhere, at a limit, and across a change point.

use std::sync::Arc;

use kempe_mechanism::Design;
use kempe_mechanism::PlanNumber;
use kempe_mechanism::evidence::is_finite;
use kempe_mechanism::pose::Pose;
use kempe_model::{DriveId, Law};
use kempe_motion::bridge::{SideSeries, across, join};
use kempe_motion::drive_path::DrivePath;
use kempe_motion::events::{Event, EventKind};
use kempe_motion::motion::{Motion, Solver};
use kempe_motion::trace::Path;
use kempe_number::{Jet, Number};

use crate::base::Base;
use crate::clock::Clock;
use crate::measure::{alone_following, is_following, only_value, pilots};
use crate::state::{Abscissa, Series, State};

/// A place of a motion: time and path parameter, both as they vary.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PathPlace<B> {
    /// Time, s.
    pub time: B,
    /// The path parameter.
    pub path: B,
}

/// Finds the states of a motion along its path, for parameters that may vary.
pub(crate) struct StatesAlong<B> {
    clock: Clock,
    /// The parameters as constants of series.
    rich: Vec<Series<B>>,
    /// Values of the parameters.
    parameters: Vec<B>,
    solver: Solver<Series<B>>,
    side_design: Design<SideSeries>,
    side: Solver<SideSeries>,
    state: State<B>,
}

impl<B: Base> StatesAlong<B>
where
    Series<B>: PlanNumber,
{
    /// Prepares to find the states of a motion for these parameter values.
    pub fn new(motion: &Arc<Motion>, parameters: &[B]) -> Self {
        let rich: Vec<Series<B>> = parameters.iter().map(|x| Series::constant(*x)).collect();
        let design = motion.design_of(parameters).lift(Series::constant);
        let clock = Clock::new(motion.clone());
        let abscissa = Abscissa {
            drive: clock.path_drive(),
            clock: Series::zero(),
            heading: 1.0,
            unit: motion.path.scale(),
        };
        Self {
            state: State::empty(Arc::new(design), abscissa),
            solver: motion.solver(),
            side_design: motion.design_on(),
            side: motion.solver(),
            parameters: parameters.to_vec(),
            rich,
            clock,
        }
    }

    /// The motion.
    pub fn motion(&self) -> &Arc<Motion> {
        self.clock.motion()
    }

    /// Where the motion is at a time.
    pub fn clock(&self) -> &Clock {
        &self.clock
    }

    /// Values of the parameters, SI, in the model's order.
    pub fn parameters(&self) -> &[B] {
        &self.parameters
    }

    /// The state last found.
    pub fn state(&self) -> &State<B> {
        &self.state
    }

    /// Finds the motion that a drive alone would give, too, from now on.
    pub fn ask_alone(&mut self, drive: DriveId) {
        if self.clock.path_drive() == Some(drive) {
            return;
        }
        self.state.alone[drive.index()] = Some(Vec::new());
        // What follows goes with what tells the place.
        let drives = &self.state.mechanism().model.drives;
        if is_following(drives, drive.index()) {
            for pilot in pilots(drives) {
                self.state.alone[pilot.index()] = Some(Vec::new());
            }
        }
    }

    /// The place at a time that may vary with the parameters.
    pub fn at_time(&self, time: B) -> PathPlace<B> {
        let motion = self.motion();
        let model = &motion.mechanism().model;
        PathPlace {
            time,
            path: motion.path.parameter_at(model, time, &self.parameters),
        }
    }

    /// The rate of the path parameter in time at a place.
    pub fn path_rate(&self, time: B) -> B {
        self.clock_at(time).coefficient(1)
    }

    fn clock_at(&self, time: B) -> Series<B> {
        let motion = self.motion();
        let model = &motion.mechanism().model;
        if time.value().is_finite() {
            (motion.path).parameter_at(model, Series::variable(time), &self.rich)
        } else {
            // Nothing is known of how it runs.
            only_value(B::from_f64(f64::NAN))
        }
    }

    /// Finds the state at a place. False where the motion does not reach, or no pose is found.
    pub fn find(&mut self, place: PathPlace<B>) -> bool {
        let motion = self.motion().clone();
        let p = place.path.value();
        if !motion.reaches(p) {
            return false;
        }
        if let Some(index) = motion.limit_at(p) {
            self.find_at_limit(&motion, place, index);
        } else {
            match motion.bridge(p) {
                Some(event) => self.find_across(&motion, place, event),
                None => self.find_poses(&motion, place),
            }
            if !(self.state.poses.iter()).all(|pose| is_finite(&pose.value().value())) {
                return false;
            }
            self.find_alone(&motion, place);
        }
        let clock = self.clock_at(place.time);
        let heading = self
            .clock
            .heading(place.time.value(), clock.coefficient(1).value());
        self.state.time = place.time;
        self.find_inner(&motion, place.time);
        (self.state.abscissa.clock, self.state.abscissa.heading) = (clock, heading);
        true
    }

    /// Inner states at a time, where a simulation has followed them.
    fn find_inner(&mut self, motion: &Motion, time: B) {
        let laws = &motion.mechanism().model.inner_laws;
        if laws.is_empty() {
            return;
        }
        let (rich, time) = (&self.rich, Series::variable(time));
        let of = |law: &Option<Law>| match law {
            Some(law) => law.at(time, rich),
            None => only_value(B::from_f64(f64::NAN)),
        };
        self.state.inner = laws.iter().map(of).collect();
    }

    /// Drive coordinates at a path parameter. Drives at rest vary as their laws' starts do.
    fn coordinates(&mut self, motion: &Motion, p: Series<B>) {
        let drives = &motion.mechanism().model.drives;
        for (index, (out, drive)) in self.solver.coordinates.iter_mut().zip(drives).enumerate() {
            *out = match &motion.path {
                DrivePath::Coordinate { drive, .. } if *drive == index => p,
                DrivePath::Coordinate { held, .. } => {
                    let start = drive.law.at(Series::zero(), &self.rich).coefficient(0);
                    Series::constant(start + (held[index] - start.value()))
                }
                DrivePath::Time { end, .. } => drive.law.going_on(p, &self.rich, *end),
            };
        }
    }

    fn find_poses(&mut self, motion: &Motion, place: PathPlace<B>) {
        motion.branch_at(place.path.value(), &mut self.solver.branch);
        self.coordinates(motion, Series::variable(place.path));
        B::solve(&mut self.solver, motion, &self.state.design);
        self.state.poses.clone_from(&self.solver.state.poses);
        self.state.near.clone_from(&self.solver.branch.near);
        self.state.coordinates.clone_from(&self.solver.coordinates);
    }

    fn find_alone(&mut self, motion: &Motion, place: PathPlace<B>) {
        for index in 0..self.state.alone.len() {
            let drives = &motion.mechanism().model.drives;
            if self.state.alone[index].is_none() || is_following(drives, index) {
                continue;
            }
            motion.branch_at(place.path.value(), &mut self.solver.branch);
            self.coordinates(motion, Series::constant(place.path));
            let q = self.solver.coordinates[index].coefficient(0);
            self.solver.coordinates[index] = Series::variable(q);
            B::solve(&mut self.solver, motion, &self.state.design);
            self.state.alone[index] = Some(self.solver.state.poses.clone());
        }
        for index in 0..self.state.alone.len() {
            let drives = &motion.mechanism().model.drives;
            if self.state.alone[index].is_some() && is_following(drives, index) {
                let alone = alone_following(&self.state, DriveId(index as u32));
                self.state.alone[index] = Some(alone);
            }
        }
    }

    /// Takes the pose of the trace at a limit of the drive; rates are infinite there, or not defined.
    fn find_at_limit(&mut self, motion: &Motion, place: PathPlace<B>, index: usize) {
        let (_, poses, near) = motion.node(index);
        self.coordinates(motion, Series::variable(place.path));
        self.state.coordinates.clone_from(&self.solver.coordinates);
        for (series, pose) in self.state.poses.iter_mut().zip(&poses).skip(1) {
            *series = pose.map(|x| only_value(B::unvaried(x)));
        }
        self.state.near = near;
        let poses = &self.state.poses;
        for drive in self.state.alone.iter_mut().flatten() {
            drive.clone_from(poses);
        }
    }

    /// Joins the series on both sides of a change point. How they vary is not known: a change of dimensions pulls the
    /// crossing branches apart; but for where other constraints keep the motion determined.
    fn find_across(&mut self, motion: &Motion, place: PathPlace<B>, event: &Event) {
        let p = place.path.value();
        let varied = match event.kind {
            EventKind::ModeChange => self.varied_across(motion, place, event),
            _ => None,
        };
        motion.branch_at(p, &mut self.solver.branch);
        self.coordinates(motion, Series::variable(place.path));
        self.state.coordinates.clone_from(&self.solver.coordinates);
        self.state.near.clone_from(&self.solver.branch.near);
        let joined = across(motion, &self.side_design, event, p, &mut self.side);
        let unvaried =
            |series: Series<f64>| Jet::from_coefficients(series.coefficients().map(B::unvaried));
        for (pose, joined) in self.state.poses.iter_mut().zip(joined) {
            *pose = joined.map(unvaried);
        }
        for (pose, varied) in self
            .state
            .poses
            .iter_mut()
            .zip(varied.into_iter().flatten())
        {
            *pose = Pose {
                x: varied_as(pose.x, varied.x),
                y: varied_as(pose.y, varied.y),
                c: varied_as(pose.c, varied.c),
                s: varied_as(pose.s, varied.s),
            };
        }
    }

    /// The poses joined from series that vary, on both sides; nothing where these never do.
    fn varied_across(
        &mut self,
        motion: &Motion,
        place: PathPlace<B>,
        event: &Event,
    ) -> Option<Vec<Pose<Series<B>>>> {
        B::varied(0.0, B::zero())?;
        let [low, high] = [-1.0, 1.0].map(|side| {
            let path = B::from_f64(event.at + side * event.bridge);
            self.find_poses(motion, PathPlace { path, ..place });
            self.state.poses.clone()
        });
        let from_center = place.path - event.at;
        let joined = |low: Series<B>, high: Series<B>| join(&low, &high, event.bridge, from_center);
        let both = low.iter().zip(&high).map(|(low, high)| Pose {
            x: joined(low.x, high.x),
            y: joined(low.y, high.y),
            c: joined(low.c, high.c),
            s: joined(low.s, high.s),
        });
        Some(both.collect())
    }
}

/// A series with the derivatives of another.
fn varied_as<B: Base>(series: Series<B>, other: Series<B>) -> Series<B> {
    let coefficients = std::array::from_fn(|k| {
        let [own, other] = [series, other].map(|it| it.coefficient(k));
        B::varied(own.value(), other).unwrap_or(own)
    });
    Jet::from_coefficients(coefficients)
}
