//! Exact derivatives of measures to the parameters of the design.
//!
//! The plan runs on `Jet<Dual<f64, K>, N>`: a Taylor series along the motion whose coefficients carry the derivatives to
//! `K` parameters (forward mode; A. Griewank and A. Walther, *Evaluating Derivatives*, 2nd ed. 2008, chapters 3 and 13).
//! Positions, rates and kinematic coefficients alike are then differentiated to rounding, Newton blocks by the implicit
//! function theorem (the iteration is repeated on dual numbers with the plain Jacobian).
//!
//! **What is held.** A parameter may change lengths, angles and the drives' laws. With [`Held::Path`] the path parameter
//! stays where it is: the coordinate of the only moving drive (the time at which it is passed then moves with the
//! laws, and rates are taken at the moved time), or the time when several drives move. With [`Held::Time`] time stays,
//! and coordinates follow the laws. In both, drives that stand still follow the laws' start values, the branch (assembly
//! modes) stays, and parameters built on the one that is varied follow it.
//!
//! **Over a motion.** `min` and `max` change as the measure does at the time of the extreme, held there, because its rate
//! vanishes (envelope theorem; at the ends of a law's piece the time moves with the law). Where two extremes are equally
//! large the derivative is that of the first one. `mean` is integrated on dual numbers, `time_ratio` takes the moving of
//! the extremes' times by the implicit function theorem.
//!
//! At a change point a change of dimensions pulls the crossing branches apart: there, and at limits, nothing is
//! differentiable and the results are not finite.

use kempe_model::{DriveId, Leaf, Measure, ParameterId, PointId, PoseMeasure, Statistic};
use kempe_number::{Dual, Number};

use crate::drive_path::DrivePath;
use crate::measure::{Along, Moment, Series, visit_leaves};
use crate::motion::{Motion, Solver};
use crate::pose::Pose;
use crate::sampler::{Sampler, Unmeasurable};
use crate::state::Design;
use crate::swept::GAUSS;

/// Parameters differentiated to at once.
const CHUNK: usize = 4;
/// Intervals of time over which path lengths and means are integrated, besides the breaks of the laws.
const GRID: usize = 90;

/// A number with its derivatives to some parameters.
type Base = Dual<f64, CHUNK>;

/// What stays while a parameter changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Held {
    /// The path parameter: the coordinate of the only moving drive (SI), or time when several move.
    Path(f64),
    /// Time, s.
    Time(f64),
}

/// Values of measures with their derivatives to parameters, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivities {
    /// Path parameter at which they were taken.
    pub parameter: f64,
    /// Time at which they were taken, s.
    pub time: f64,
    /// Value of every measure.
    pub values: Vec<f64>,
    /// `derivatives[i][j]` is d(measure i)/d(parameter j); not finite where there is none.
    pub derivatives: Vec<Vec<f64>>,
}

/// The derivatives of measures at a place of a motion to parameters of the model: see the module's text.
///
/// Beyond the motion every result is NaN.
///
/// # Errors
/// All measures that cannot be evaluated, each with its reason.
pub fn sensitivities(
    motion: &Motion<'_>,
    held: Held,
    measures: &[&Measure],
    parameters: &[ParameterId],
) -> Result<Sensitivities, Vec<Unmeasurable>> {
    // Unwrapped directions and the times of extremes come from the plain motion.
    let mut sampler = Sampler::new(motion, measures)?;
    let (parameter, time) = match held {
        Held::Path(p) => (p, sampler.time_at(p)),
        Held::Time(t) => (sampler.parameter_at(t), t),
    };
    let mut it = Sensitivities {
        parameter,
        time,
        values: vec![f64::NAN; measures.len()],
        derivatives: vec![Vec::with_capacity(parameters.len()); measures.len()],
    };
    // Without parameters the values are still wanted.
    let chunks = parameters
        .chunks(CHUNK)
        .chain(parameters.is_empty().then_some(parameters));
    for chunk in chunks {
        let mut varied = Varied::new(motion, &mut sampler, chunk);
        let results: Vec<Base> = match varied.clock(held) {
            Some(time) => {
                varied.prepare(measures);
                measures.iter().map(|m| varied.value(m, time)).collect()
            }
            None => vec![Base::from_f64(f64::NAN); measures.len()],
        };
        for (index, result) in results.iter().enumerate() {
            it.values[index] = result.re;
            // What has no value has no derivatives either.
            let slopes = result.eps.iter().take(chunk.len());
            it.derivatives[index]
                .extend(slopes.map(|d| if result.re.is_nan() { f64::NAN } else { *d }));
        }
    }
    Ok(it)
}

/// A time and a path parameter, both as they move with the parameters.
#[derive(Clone, Copy, Debug)]
struct Place {
    time: Base,
    path: Base,
}

/// A motion with some parameters varied.
struct Varied<'s, 'a> {
    motion: &'a Motion<'a>,
    sampler: &'s mut Sampler<'a>,
    parameters: Vec<Base>,
    rich: Vec<Series<Base>>,
    design: Design<Series<Base>>,
    solver: Solver<Series<Base>>,
    drives: Vec<Option<Vec<Pose<Series<Base>>>>>,
    path_drive: Option<DriveId>,
    statistics: Vec<(Statistic, Measure, Base)>,
    swept: Vec<PointId>,
}

impl<'s, 'a> Varied<'s, 'a> {
    fn new(motion: &'a Motion<'a>, sampler: &'s mut Sampler<'a>, chunk: &[ParameterId]) -> Self {
        let model = &motion.mechanism.model;
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
            design: Design::new(motion.mechanism, motion.plan, &rich),
            solver: motion.solver(),
            drives: vec![None; model.drives.len()],
            path_drive: sampler.path_drive(),
            statistics: Vec::new(),
            swept: Vec::new(),
            parameters,
            rich,
            sampler,
            motion,
        }
    }

    /// The place that is held.
    fn clock(&self, held: Held) -> Option<Place> {
        match (held, self.path_drive) {
            (Held::Time(t), _) | (Held::Path(t), None) => Some(self.at_time(Base::from_f64(t))),
            (Held::Path(p), Some(drive)) => Some(self.at_coordinate(drive, p)),
        }
    }

    /// The place at a time that may move with the parameters.
    fn at_time(&self, time: Base) -> Place {
        let model = &self.motion.mechanism.model;
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
    fn passing(&self, drive: DriveId, time: f64) -> Base {
        let law = &self.motion.mechanism.model.drives[drive.index()].law;
        let q = law.at(Series::variable(Base::from_f64(time)), &self.rich);
        let (change, rate) = (q.coefficient(0), q.coefficient(1).re);
        Base {
            re: time,
            // A law that no parameter moves leaves its times, even those at rest.
            eps: change.eps.map(|d| if d == 0.0 { 0.0 } else { -d / rate }),
        }
    }

    /// Finds out what the measures need, and evaluates their statistics.
    fn prepare(&mut self, measures: &[&Measure]) {
        let mut statistics: Vec<(Statistic, Measure)> = Vec::new();
        for measure in measures {
            visit_leaves(self.motion.mechanism, measure, &mut |leaf| match leaf {
                Leaf::Over(statistic, inner) => {
                    let entry = (*statistic, (**inner).clone());
                    if !statistics.contains(&entry) {
                        statistics.push(entry);
                    }
                }
                Leaf::Pose(PoseMeasure::PathLength(p)) if !self.swept.contains(p) => {
                    self.swept.push(*p);
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
        // Inner statistics first.
        for (statistic, measure) in statistics.into_iter().rev() {
            let value = self.over(statistic, &measure);
            self.statistics.push((statistic, measure, value));
        }
    }

    /// Drive coordinates at a path parameter. Drives at rest follow their laws' start.
    fn coordinates(&mut self, p: Series<Base>) {
        let drives = &self.motion.mechanism.model.drives;
        for (index, (out, drive)) in self.solver.coordinates.iter_mut().zip(drives).enumerate() {
            *out = match self.motion.path {
                DrivePath::Coordinate { drive, .. } if drive == index => p,
                DrivePath::Coordinate { .. } => drive.law.at(Series::zero(), &self.rich),
                DrivePath::Time { .. } => drive.law.at(p, &self.rich),
            };
        }
    }

    /// Solves the poses along the path, and along the other drives that are asked for. False beyond the motion.
    fn solve(&mut self, place: Place) -> bool {
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
    fn series(&mut self, measure: &Measure, place: Place) -> Series<Base> {
        let swept: Vec<(PointId, Base)> = match self.swept.clone() {
            points if needs_length(self.motion, measure) => points
                .into_iter()
                .map(|p| (p, self.length(p, place.time)))
                .collect(),
            _ => Vec::new(),
        };
        if !self.solve(place) {
            return Series::from_f64(f64::NAN);
        }
        let motion = self.motion;
        let model = &motion.mechanism.model;
        let clock = if place.time.re.is_finite() {
            motion
                .path
                .parameter_at(model, Series::variable(place.time), &self.rich)
        } else {
            Series::from_f64(f64::NAN)
        };
        let moment = Moment {
            mechanism: motion.mechanism,
            design: &self.design,
            parameters: &self.parameters,
            time: place.time,
            path: &self.solver.state.poses,
            clock,
            drives: &self.drives,
            path_drive: self.path_drive,
            coordinates: &self.solver.coordinates,
            near: &self.solver.branch.near,
            directions: self.sampler.directions_near(place.path.re),
            swept,
            forces: None,
            statistics: &self.statistics,
        };
        moment.series(measure, Along::Time)
    }

    fn value(&mut self, measure: &Measure, place: Place) -> Base {
        self.series(measure, place).coefficient(0)
    }

    /// Length of path swept by a point until a time.
    fn length(&mut self, point: PointId, until: Base) -> Base {
        let Some(marker) = self.motion.mechanism.any_marker(point) else {
            return Base::from_f64(f64::NAN);
        };
        self.integrate(until, &mut |it, place| {
            if !it.solve(place) {
                return Base::from_f64(f64::NAN);
            }
            let model = &it.motion.mechanism.model;
            let rate = it
                .motion
                .path
                .parameter_at(model, Series::variable(place.time), &it.rich)
                .coefficient(1);
            let local = it.design.geometry.marker(marker);
            let at = it.solver.state.poses[marker.body.index()].place(local);
            let (dx, dy) = (at[0].coefficient(1), at[1].coefficient(1));
            ((dx.square() + dy.square()) * rate.square()).sqrt()
        })
    }

    /// Gauss quadrature over time from the start, between the breaks of the laws and the times of an even grid.
    fn integrate(&mut self, until: Base, f: &mut dyn FnMut(&mut Self, Place) -> Base) -> Base {
        let mut times: Vec<Base> = (0..=GRID)
            .map(|k| until * (k as f64 / GRID as f64))
            .collect();
        times.extend(
            self.breaks()
                .into_iter()
                .filter(|t| 0.0 < t.re && t.re < until.re),
        );
        times.sort_by(|a, b| a.re.total_cmp(&b.re));
        let mut sum = Base::zero();
        for pair in times.windows(2) {
            let (middle, half) = ((pair[0] + pair[1]) * 0.5, (pair[1] - pair[0]) * 0.5);
            if half.re <= 0.0 {
                continue;
            }
            for (x, w) in GAUSS {
                let place = self.at_time(middle + half * x);
                sum += f(self, place) * half * w;
            }
        }
        sum
    }

    fn duration(&self) -> Base {
        let laws = self.motion.mechanism.model.drives.iter();
        laws.map(|d| d.law.duration(&self.parameters))
            .fold(Base::zero(), Base::max)
    }

    /// Times at which some law goes from one piece to the next, as they move with the parameters.
    fn breaks(&self) -> Vec<Base> {
        let mut list = vec![Base::zero(), self.duration()];
        for drive in &self.motion.mechanism.model.drives {
            let mut law = drive.law.clone();
            while !law.pieces.is_empty() {
                list.push(law.duration(&self.parameters));
                law.pieces.pop();
            }
        }
        list
    }

    /// A statistic of a measure over the motion.
    fn over(&mut self, statistic: Statistic, measure: &Measure) -> Base {
        let nothing = Base::from_f64(f64::NAN);
        match statistic {
            Statistic::At { drive: None, value } => {
                let place = self.at_time(Base::from_f64(value));
                self.value(measure, place)
            }
            Statistic::At {
                drive: Some(drive),
                value,
            } => match self.sampler.time_of(drive, value) {
                Some(time) => {
                    let place = self.at_time(self.passing(drive, time));
                    self.value(measure, place)
                }
                None => nothing,
            },
            Statistic::Mean => {
                let duration = self.duration();
                if duration.re <= 0.0 {
                    let place = self.at_time(Base::zero());
                    return self.value(measure, place);
                }
                let sum = self.integrate(duration, &mut |it, place| it.value(measure, place));
                sum / duration
            }
            Statistic::Min | Statistic::Max | Statistic::Range | Statistic::TimeRatio => {
                let Some((low, high)) = crate::statistics::extremes(
                    self.sampler,
                    measure,
                    &mut crate::watch::Unwatched,
                )
                .flatten() else {
                    return nothing;
                };
                let (low, high) = (self.extreme(measure, low.0), self.extreme(measure, high.0));
                match statistic {
                    Statistic::Min => low.1,
                    Statistic::Max => high.1,
                    Statistic::Range => high.1 - low.1,
                    _ => {
                        let duration = self.duration();
                        crate::statistics::time_ratio(self.sampler, high.0 - low.0, duration)
                    }
                }
            }
        }
    }

    /// Time and value of an extreme found at `time`.
    fn extreme(&mut self, measure: &Measure, time: f64) -> (Base, Base) {
        // At an end of a piece the time moves with the law; otherwise with the zero of the rate.
        if let Some(moving) = self.breaks().into_iter().find(|b| b.re == time) {
            let place = self.at_time(moving);
            return (moving, self.value(measure, place));
        }
        let place = self.at_time(Base::from_f64(time));
        let series = self.series(measure, place);
        let (rate, bend) = (series.coefficient(1), series.coefficient(2).re * 2.0);
        (
            Base {
                re: time,
                eps: rate.eps.map(|d| -d / bend),
            },
            series.coefficient(0),
        )
    }
}

/// Whether a measure asks for a swept length (not inside a statistic: that has its own).
fn needs_length(motion: &Motion<'_>, measure: &Measure) -> bool {
    let mut found = false;
    visit_leaves(motion.mechanism, measure, &mut |leaf| {
        found |= matches!(leaf, Leaf::Pose(PoseMeasure::PathLength(_)));
    });
    found
}
