//! A motion with some parameters varied: places, poses and measures on dual numbers.

use kempe_mechanism::pose::Pose;
use kempe_mechanism::state::Design;
use kempe_model::{DriveId, Leaf, Measure, ParameterId, PointId, PoseMeasure, Statistic};
use kempe_motion::drive_path::DrivePath;
use kempe_motion::motion::{Motion, Solver};
use kempe_motion::trace::Path;
use kempe_number::Number;

use super::over::Cumulated;
use super::{Base, Held};
use crate::measure::{Along, Moment, NamedSeries, Series, visit_leaves};
use crate::sampler::Sampler;

/// A time and a path parameter, both as they move with the parameters.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub time: Base,
    pub path: Base,
}

/// A motion with some parameters varied.
pub(super) struct Varied<'s, 'a> {
    pub motion: &'a Motion,
    pub sampler: &'s mut Sampler,
    pub parameters: Vec<Base>,
    pub rich: Vec<Series<Base>>,
    pub design: Design<Series<Base>>,
    pub solver: Solver<Series<Base>>,
    pub drives: Vec<Option<Vec<Pose<Series<Base>>>>>,
    pub path_drive: Option<DriveId>,
    pub statistics: Vec<(Statistic, Measure, Base)>,
    pub lengths: Vec<Cumulated>,
}

impl<'s, 'a> Varied<'s, 'a> {
    pub(super) fn new(motion: &'a Motion, sampler: &'s mut Sampler, chunk: &[ParameterId]) -> Self {
        let model = &motion.mechanism().model;
        // A varied parameter still follows those it is built on: d/d(each) is the same whatever else is asked for.
        let mut parameters: Vec<Base> = Vec::with_capacity(model.parameters.len());
        for (index, parameter) in model.parameters.iter().enumerate() {
            let mut value = kempe_model::value(&parameter.value, &parameters);
            for (eps, id) in value.eps.iter_mut().zip(chunk) {
                if id.index() == index {
                    *eps += 1.0;
                }
            }
            parameters.push(value);
        }
        let rich: Vec<Series<Base>> = parameters.iter().map(|x| Series::constant(*x)).collect();
        Self {
            design: motion.design_of(&rich),
            solver: motion.solver(),
            drives: vec![None; model.drives.len()],
            path_drive: sampler.path_drive(),
            statistics: Vec::new(),
            lengths: Vec::new(),
            parameters,
            rich,
            sampler,
            motion,
        }
    }

    /// The place that is held.
    pub(super) fn clock(&self, held: Held) -> Option<Place> {
        match (held, self.path_drive) {
            (Held::Time(t), _) | (Held::Path(t), None) => Some(self.at_time(Base::from_f64(t))),
            (Held::Path(p), Some(drive)) => Some(self.at_coordinate(drive, p)),
        }
    }

    /// The place at a time that may move with the parameters.
    pub(super) fn at_time(&self, time: Base) -> Place {
        let model = &self.motion.mechanism().model;
        Place {
            time,
            path: self.motion.path.parameter_at(model, time, &self.parameters),
        }
    }

    /// The place at which the path drive has the coordinate `p`, first of all times.
    fn at_coordinate(&self, drive: DriveId, p: f64) -> Place {
        let time = self.sampler.time_at(p);
        Place {
            time: self.passing(drive, time),
            path: Base::from_f64(p),
        }
    }

    /// The time at which a drive's coordinate stays what it is at `time`: dt = -dq / (dq/dt).
    pub(super) fn passing(&self, drive: DriveId, time: f64) -> Base {
        let law = &self.motion.mechanism().model.drives[drive.index()].law;
        let q = law.at(Series::variable(Base::from_f64(time)), &self.rich);
        let (change, rate) = (q.coefficient(0), q.coefficient(1).re);
        Base {
            re: time,
            // A law that no parameter moves leaves its times, even those at rest.
            eps: change.eps.map(|d| if d == 0.0 { 0.0 } else { -d / rate }),
        }
    }

    /// Finds out what the measures need, and evaluates their statistics.
    pub(super) fn prepare(&mut self, measures: &[&Measure]) {
        let mut statistics: Vec<(Statistic, Measure)> = Vec::new();
        for measure in measures {
            visit_leaves(self.motion.mechanism(), measure, &mut |leaf| match leaf {
                Leaf::Over(statistic, inner) => {
                    let entry = (*statistic, (**inner).clone());
                    if !statistics.contains(&entry) {
                        statistics.push(entry);
                    }
                }
                Leaf::Coefficient(_, drive, _)
                | Leaf::Pose(PoseMeasure::MechanicalAdvantage(_, drive))
                    if Some(*drive) != self.path_drive =>
                {
                    self.drives[drive.index()] = Some(Vec::new());
                }
                _ => {}
            });
        }
        // A statistic that another contains is found before it.
        for (statistic, measure) in statistics {
            let value = self.over(statistic, &measure);
            self.statistics.push((statistic, measure, value));
        }
    }

    /// Drive coordinates at a path parameter. Drives at rest follow their laws' start.
    fn coordinates(&mut self, p: Series<Base>) {
        let drives = &self.motion.mechanism().model.drives;
        for (index, (out, drive)) in self.solver.coordinates.iter_mut().zip(drives).enumerate() {
            *out = match self.motion.path {
                DrivePath::Coordinate { drive, .. } if drive == index => p,
                DrivePath::Coordinate { .. } => drive.law.at(Series::zero(), &self.rich),
                DrivePath::Time { .. } => drive.law.at(p, &self.rich),
            };
        }
    }

    /// Solves the poses along the path, and along the other drives that are asked for. False beyond the motion.
    pub(super) fn solve(&mut self, place: Place) -> bool {
        let motion = self.motion;
        let p = place.path.re;
        if !motion.reaches(p) {
            return false;
        }
        for index in 0..self.drives.len() {
            if self.drives[index].is_none() {
                continue;
            }
            motion.branch_at(p, &mut self.solver.branch);
            self.coordinates(Series::constant(place.path));
            let q = self.solver.coordinates[index].coefficient(0);
            self.solver.coordinates[index] = Series::variable(q);
            self.solver.run(motion, &self.design);
            self.drives[index] = Some(self.solver.state.poses.clone());
        }
        motion.branch_at(p, &mut self.solver.branch);
        self.coordinates(Series::variable(place.path));
        self.solver.run(motion, &self.design);
        true
    }

    /// A measure as a series in time at a place.
    pub(super) fn series(&mut self, measure: &Measure, place: Place) -> Series<Base> {
        let swept = lengths_of(self.motion, measure).into_iter();
        let swept = swept.map(|p| (p, self.length(p, place.time))).collect();
        if !self.solve(place) {
            return Series::from_f64(f64::NAN);
        }
        let motion = self.motion;
        let model = &motion.mechanism().model;
        let clock = if place.time.re.is_finite() {
            motion
                .path
                .parameter_at(model, Series::variable(place.time), &self.rich)
        } else {
            Series::from_f64(f64::NAN)
        };
        let moment = Moment {
            mechanism: motion.mechanism(),
            design: &self.design,
            parameters: &self.parameters,
            time: place.time,
            path: &self.solver.state.poses,
            clock,
            heading: self
                .sampler
                .heading(place.time.re, clock.coefficient(1).value()),
            unit: motion.path.scale(),
            drives: &self.drives,
            path_drive: self.path_drive,
            coordinates: &self.solver.coordinates,
            near: &self.solver.branch.near,
            directions: self.sampler.directions_near(place.path.re),
            swept,
            forces: None,
            statistics: &self.statistics,
            named: NamedSeries::default(),
        };
        moment.series(measure, Along::Time)
    }

    pub(super) fn value(&mut self, measure: &Measure, place: Place) -> Base {
        self.series(measure, place).coefficient(0)
    }
}

/// The points of whose path a measure asks for the length (and a statistic inside it: that has its own).
fn lengths_of(motion: &Motion, measure: &Measure) -> Vec<PointId> {
    let mut points = Vec::new();
    visit_leaves(motion.mechanism(), measure, &mut |leaf| {
        if let Leaf::Pose(PoseMeasure::PathLength(point)) = leaf
            && !points.contains(point)
        {
            points.push(*point);
        }
    });
    points
}
