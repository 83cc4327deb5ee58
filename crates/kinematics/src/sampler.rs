//! Rows of a motion: measures, poses and evidence at any place or time.

use kempe_model::{DriveId, Leaf, Measure, PointId, PoseMeasure, Statistic};
use kempe_number::Number;
use kempe_units::{Dimension, Unit, format_digits};

use crate::bordered::Bordered;
use crate::bridge::{Side, across};
use crate::drive_path::DrivePath;
use crate::events::{Event, EventKind};
use crate::evidence::{evidence, is_finite};
use crate::force_source::{ForceSource, NoForces};
use crate::measure::{Moment, ORDER, Series, order_of, plain_direction, visit_leaves};
use crate::motion::{EndReason, Motion, Solver};
use crate::pose::Pose;
use crate::state::Design;
use crate::swept::Swept;
use crate::trace::interval;
use crate::watch::{Unwatched, Watch};

/// A closure residual (in mechanism sizes) above which a row is marked.
pub const CLOSURE_LIMIT: f64 = 1e-9;

/// Digits of a place in a note.
const NOTE_DIGITS: usize = 12;

/// One row of a motion.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Path parameter: the coordinate of the only moving drive, or time.
    pub parameter: f64,
    /// Time, s.
    pub time: f64,
    /// Coordinates of all drives, SI.
    pub coordinates: Vec<f64>,
    /// Values of the measures asked for, SI.
    pub values: Vec<f64>,
    /// x, y and unwrapped angle of every link.
    pub links: Vec<[f64; 3]>,
    /// Place of every point of the model in the frame.
    pub points: Vec<[f64; 2]>,
    /// Largest closure residual, in mechanism sizes (directions in rad).
    pub closure: f64,
    /// Smallest singular value of the scaled constraint Jacobian.
    pub smallest_singular_value: f64,
    /// What a careful engineer would want to be told about this row, such as why it could not be reached.
    pub note: Option<String>,
}

/// A measure that cannot be evaluated.
#[derive(Clone, Debug, PartialEq)]
pub struct Unmeasurable {
    /// Which of the measures asked for.
    pub index: usize,
    /// Why.
    pub reason: String,
}

/// Why a sampler is not ready.
#[derive(Clone, Debug, PartialEq)]
pub enum Unprepared {
    /// Measures that cannot be evaluated.
    Unmeasurable(Vec<Unmeasurable>),
    /// It was told to stop.
    Stopped,
}

/// Evaluates measures along a motion; those of forces too where it is given their source.
pub struct Sampler<'a, F = NoForces> {
    motion: &'a Motion<'a>,
    /// Only ever `None` while its own questions are answered.
    forces: Option<F>,
    measures: Vec<Measure>,
    parameters: Vec<f64>,
    series_design: Design<Series<f64>>,
    side_design: Design<Side>,
    plain: Solver<f64>,
    series: Solver<Series<f64>>,
    side: Solver<Side>,
    drives: Vec<Option<Vec<Pose<Series<f64>>>>>,
    directions: Vec<((PointId, PointId), Vec<f64>)>,
    swept: Vec<Swept>,
    statistics: Vec<(Statistic, Measure, f64)>,
    system: Bordered,
}

impl<'a> Sampler<'a> {
    /// Prepares measures for evaluation along a motion; statistics over the motion are computed here.
    ///
    /// # Errors
    /// All measures that cannot be evaluated, each with its reason.
    pub fn new(motion: &'a Motion<'a>, measures: &[&Measure]) -> Result<Self, Vec<Unmeasurable>> {
        Self::with_forces(motion, measures, NoForces)
    }
}

impl<'a, F: ForceSource> Sampler<'a, F> {
    /// As [`Sampler::new`], with a source of forces.
    ///
    /// # Errors
    /// All measures that cannot be evaluated, each with its reason.
    pub fn with_forces(
        motion: &'a Motion<'a>,
        measures: &[&Measure],
        forces: F,
    ) -> Result<Self, Vec<Unmeasurable>> {
        Self::watched(motion, measures, forces, &mut Unwatched).map_err(|problem| match problem {
            Unprepared::Unmeasurable(list) => list,
            // Unwatched, it is never stopped.
            Unprepared::Stopped => Vec::new(),
        })
    }

    /// As [`Sampler::with_forces`]; `watch` hears how far the statistics over the motion have come.
    ///
    /// # Errors
    /// As [`Sampler::with_forces`], and [`Unprepared::Stopped`].
    pub fn watched(
        motion: &'a Motion<'a>,
        measures: &[&Measure],
        forces: F,
        watch: &mut dyn Watch,
    ) -> Result<Self, Unprepared> {
        let mechanism = motion.mechanism;
        let problems: Vec<Unmeasurable> = (measures.iter().enumerate())
            .filter_map(|(index, m)| {
                order_of(mechanism, m)
                    .err()
                    .map(|reason| Unmeasurable { index, reason })
            })
            .collect();
        if !problems.is_empty() {
            return Err(Unprepared::Unmeasurable(problems));
        }
        let parameters = mechanism.model.parameter_values::<f64>();
        let mut it = Self {
            series_design: lift(motion),
            side_design: lift(motion),
            plain: motion.solver(),
            series: motion.solver(),
            side: motion.solver(),
            drives: vec![None; mechanism.model.drives.len()],
            directions: Vec::new(),
            swept: Vec::new(),
            statistics: Vec::new(),
            system: Bordered::new(motion.mechanism, motion.plan),
            parameters,
            measures: measures.iter().map(|m| (*m).clone()).collect(),
            motion,
            forces: Some(forces),
        };
        it.prepare(watch).ok_or(Unprepared::Stopped)?;
        Ok(it)
    }

    /// The source of forces, as it stands after the row last asked for.
    pub fn forces(&self) -> Option<&F> {
        self.forces.as_ref()
    }

    /// Finds out what the measures need beyond the poses along the path. `None` when stopped.
    fn prepare(&mut self, watch: &mut dyn Watch) -> Option<()> {
        let mut statistics: Vec<(Statistic, Measure)> = Vec::new();
        let mut directions: Vec<(PointId, PointId)> = Vec::new();
        let mut swept: Vec<PointId> = Vec::new();
        let mut drives: Vec<DriveId> = Vec::new();
        let motion = self.motion;
        // What the forces ask for comes last, so that its statistics are found first.
        let inputs = self.forces.as_ref().map_or(&[][..], F::measures);
        for measure in self.measures.iter().chain(inputs) {
            visit_leaves(motion.mechanism, measure, &mut |leaf| match leaf {
                Leaf::Over(statistic, inner) => {
                    let entry = (*statistic, (**inner).clone());
                    if !statistics.contains(&entry) {
                        statistics.push(entry);
                    }
                }
                Leaf::Pose(PoseMeasure::Direction(a, b)) if !directions.contains(&(*a, *b)) => {
                    directions.push((*a, *b));
                }
                Leaf::Pose(PoseMeasure::PathLength(p)) if !swept.contains(p) => swept.push(*p),
                Leaf::Coefficient(_, drive, _)
                | Leaf::Pose(PoseMeasure::MechanicalAdvantage(_, drive)) => {
                    drives.push(*drive);
                }
                _ => {}
            });
        }
        if self.forces.as_ref().is_some_and(F::needs_drives) {
            drives.extend((0..self.drives.len()).map(|d| DriveId(d as u32)));
        }
        for drive in drives {
            if Some(drive) != self.path_drive() {
                self.drives[drive.index()] = Some(Vec::new());
            }
        }
        for pair in directions {
            let nodes = unwrapped_directions(motion, pair);
            self.directions.push((pair, nodes));
        }
        for point in swept {
            self.swept.push(Swept::watched(motion, point, watch)?);
        }
        // Inner statistics first: a measure that contains another is found before it.
        for (statistic, measure) in statistics.into_iter().rev() {
            let value = crate::statistics::over(self, statistic, &measure, watch)?;
            self.statistics.push((statistic, measure, value));
        }
        Some(())
    }

    /// The motion.
    pub fn motion(&self) -> &'a Motion<'a> {
        self.motion
    }

    /// Duration of the motion, s.
    pub fn duration(&self) -> f64 {
        let laws = self.motion.mechanism.model.drives.iter();
        laws.map(|d| d.law.duration(&self.parameters))
            .fold(0.0, f64::max)
    }

    /// Times at which some drive's law goes from one piece to the next, both ends of the motion included.
    pub fn breaks(&self) -> Vec<f64> {
        let mut breaks: Vec<f64> = (self.motion.mechanism.model.drives.iter())
            .flat_map(|d| d.law.breaks(&self.parameters))
            .collect();
        breaks.push(self.duration());
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        breaks
    }

    /// The first time at which a drive's coordinate takes a value, s.
    pub fn time_of(&self, drive: DriveId, value: f64) -> Option<f64> {
        self.motion
            .mechanism
            .model
            .drives
            .get(drive.index())?
            .law
            .first_time(value, &self.parameters)
    }

    /// The drive whose coordinate is the path parameter.
    pub fn path_drive(&self) -> Option<DriveId> {
        match self.motion.path {
            DrivePath::Coordinate { drive, .. } => Some(DriveId(drive as u32)),
            DrivePath::Time { .. } => None,
        }
    }

    /// The row at a path parameter: the first time the motion passes it.
    pub fn at_parameter(&mut self, p: f64) -> Sample {
        self.row(p, self.time_at(p))
    }

    /// The first time at which the motion passes a path parameter, s; NaN when it never does.
    pub(crate) fn time_at(&self, p: f64) -> f64 {
        match self.path_drive() {
            // The last coordinate of a law may be missed by a rounding error.
            Some(drive) => self.time_of(drive, p).unwrap_or_else(|| {
                let duration = self.duration();
                let law = &self.motion.mechanism.model.drives[drive.index()].law;
                let gap = (law.at(duration, &self.parameters) - p).abs();
                if gap <= 1e-12 * p.abs().max(1e-3) {
                    duration
                } else {
                    f64::NAN
                }
            }),
            None => p,
        }
    }

    /// The row at a time, s.
    pub fn at_time(&mut self, t: f64) -> Sample {
        self.row(self.parameter_at(t), t)
    }

    /// The path parameter at a time, s.
    pub(crate) fn parameter_at(&self, t: f64) -> f64 {
        let model = &self.motion.mechanism.model;
        self.motion.path.parameter_at(model, t, &self.parameters)
    }

    /// The row at a path parameter, without time: measures of speed are NaN.
    pub fn without_time(&mut self, p: f64) -> Sample {
        self.row(p, f64::NAN)
    }

    fn row(&mut self, p: f64, time: f64) -> Sample {
        let motion = self.motion;
        let model = &motion.mechanism.model;
        let mut sample = Sample {
            parameter: p,
            time,
            coordinates: vec![f64::NAN; model.drives.len()],
            values: vec![f64::NAN; self.measures.len()],
            links: vec![[f64::NAN; 3]; model.links.len()],
            points: vec![[f64::NAN; 2]; model.points.len()],
            closure: f64::NAN,
            smallest_singular_value: f64::NAN,
            note: None,
        };
        motion.path.coordinates(p, &mut sample.coordinates);
        if !motion.reaches(p) {
            sample.note = Some(self.why_unreached(p));
            return sample;
        }
        if !self.solve(p) {
            sample.note = Some("no pose was found here".into());
            return sample;
        }
        let measures = std::mem::take(&mut self.measures);
        self.with_moment(p, time, true, |moment| {
            for (value, measure) in sample.values.iter_mut().zip(&measures) {
                *value = moment.value(measure);
            }
        });
        self.measures = measures;

        for (pose, plain) in self
            .plain
            .state
            .poses
            .iter_mut()
            .zip(&self.series.state.poses)
        {
            *pose = plain.value();
        }
        self.plain.branch.near.clone_from(&self.series.branch.near);
        motion.path.coordinates(p, &mut self.plain.coordinates);
        self.plain
            .state
            .set_inputs(motion.mechanism, &self.plain.coordinates);
        let (branch, state) = (&self.plain.branch, &self.plain.state);
        let found = evidence(
            motion.mechanism,
            motion.design,
            branch,
            state,
            motion.size(),
            &mut self.system,
        );
        sample.closure = found.closure;
        sample.smallest_singular_value = found.smallest_singular_value;
        self.fill_places(&mut sample);
        sample.note = self.note(p, &sample);
        sample
    }

    /// Solves the series along the path at `p` and along the drives that measures ask for. False without a pose.
    fn solve(&mut self, p: f64) -> bool {
        let motion = self.motion;
        if let Some(index) = motion.limit_at(p) {
            self.solve_at_limit(p, index);
            return true;
        }
        match motion.bridge(p) {
            Some(event) => self.solve_across(p, event),
            None => motion.solve(&self.series_design, Series::variable(p), &mut self.series),
        }
        if !self
            .series
            .state
            .poses
            .iter()
            .all(|pose| is_finite(&pose.value()))
        {
            return false;
        }
        for index in 0..self.drives.len() {
            if self.drives[index].is_none() {
                continue;
            }
            let mut solver: Solver<Series<f64>> = motion.solver();
            motion.branch_at(p, &mut solver.branch);
            motion
                .path
                .coordinates(Series::constant(p), &mut solver.coordinates);
            solver.coordinates[index] = Series::variable(solver.coordinates[index].coefficient(0));
            solver.run(motion, &self.series_design);
            self.drives[index] = Some(solver.state.poses);
        }
        true
    }

    /// Takes the pose of the trace at a limit of the drive; rates are infinite there, or not defined.
    fn solve_at_limit(&mut self, p: f64, index: usize) {
        let motion = self.motion;
        let (_, poses, near) = motion.node(index);
        let constant = |x: f64| {
            let mut coefficients = [f64::NAN; ORDER];
            coefficients[0] = x;
            Series::from_coefficients(coefficients)
        };
        motion
            .path
            .coordinates(Series::variable(p), &mut self.series.coordinates);
        for (series, pose) in self.series.state.poses.iter_mut().zip(&poses).skip(1) {
            *series = Pose {
                x: constant(pose.x),
                y: constant(pose.y),
                c: constant(pose.c),
                s: constant(pose.s),
            };
        }
        self.series.branch.near = near;
        for drive in self.drives.iter_mut().flatten() {
            drive.clone_from(&self.series.state.poses);
        }
    }

    /// Joins the series on both sides of a change point.
    fn solve_across(&mut self, p: f64, event: &Event) {
        let motion = self.motion;
        motion.branch_at(p, &mut self.series.branch);
        motion
            .path
            .coordinates(Series::variable(p), &mut self.series.coordinates);
        self.series.state.poses = across(motion, &self.side_design, event, p, &mut self.side);
    }

    /// Hands the moment last solved to `ask`, with its forces where they are wanted.
    fn with_moment<R>(
        &mut self,
        p: f64,
        time: f64,
        with_forces: bool,
        ask: impl FnOnce(&Moment<'_, f64>) -> R,
    ) -> R {
        let mut forces = self.forces.take();
        let moment = self.moment(p, time);
        if let Some(source) = forces.as_mut().filter(|_| with_forces) {
            source.solve(&moment);
        }
        let answer = |measure: &_| match &forces {
            Some(source) => source.answer(measure),
            None => Series::from_f64(f64::NAN),
        };
        let result = ask(&Moment {
            forces: with_forces.then_some(&answer as &dyn Fn(&_) -> _),
            ..moment
        });
        self.forces = forces;
        result
    }

    /// The moment last solved, without forces.
    fn moment(&self, p: f64, time: f64) -> Moment<'_, f64> {
        let motion = self.motion;
        let clock = if time.is_finite() {
            let rich: Vec<Series<f64>> = self
                .parameters
                .iter()
                .map(|x| Series::constant(*x))
                .collect();
            motion
                .path
                .parameter_at(&motion.mechanism.model, Series::variable(time), &rich)
        } else {
            Series::from_f64(f64::NAN)
        };
        Moment {
            mechanism: motion.mechanism,
            design: &self.series_design,
            parameters: &self.parameters,
            time,
            path: &self.series.state.poses,
            clock,
            drives: &self.drives,
            path_drive: self.path_drive(),
            coordinates: &self.series.coordinates,
            near: &self.series.branch.near,
            directions: self.directions_near(p),
            swept: self
                .swept
                .iter()
                .map(|s| (s.point(), s.at_time(motion, &self.parameters, time)))
                .collect(),
            forces: None,
            statistics: &self.statistics,
        }
    }

    /// Value and time derivative of a measure at a time; NaN where the motion does not reach.
    pub(crate) fn value_and_rate(&mut self, measure: &Measure, time: f64) -> [f64; 2] {
        let p = self
            .motion
            .path
            .parameter_at(&self.motion.mechanism.model, time, &self.parameters);
        if !self.motion.reaches(p) || !self.solve(p) {
            return [f64::NAN; 2];
        }
        let mut asks_forces = false;
        visit_leaves(self.motion.mechanism, measure, &mut |leaf| {
            asks_forces |= matches!(leaf, Leaf::Force(_));
        });
        let series = self.with_moment(p, time, asks_forces, |moment| {
            moment.series(measure, crate::measure::Along::Time)
        });
        [series.derivative(0), series.derivative(1)]
    }

    /// Unwrapped directions near a path parameter.
    pub(crate) fn directions_near(&self, p: f64) -> Vec<((PointId, PointId), f64)> {
        let parameters = self.motion.node_parameters();
        let node = interval(parameters, p);
        (self.directions.iter())
            .map(|(pair, values)| {
                let near = match (parameters.get(node), parameters.get(node + 1)) {
                    (Some(a), Some(b)) if b > a => {
                        let part = ((p - a) / (b - a)).clamp(0.0, 1.0);
                        values[node] + part * (values[node + 1] - values[node])
                    }
                    _ => values.first().copied().unwrap_or(0.0),
                };
                (*pair, near)
            })
            .collect()
    }

    fn fill_places(&self, sample: &mut Sample) {
        let motion = self.motion;
        let geometry = &motion.design.geometry;
        for (index, place) in sample.links.iter_mut().enumerate() {
            let body = motion.mechanism.seats[index].body.index();
            let (pose, seat) = (&self.plain.state.poses[body], &geometry.seats[index]);
            let [x, y] = pose.place([seat.x, seat.y]);
            *place = [
                x,
                y,
                pose.angle_near(self.plain.branch.near[body]) + geometry.seat_angles[index],
            ];
        }
        for (index, place) in sample.points.iter_mut().enumerate() {
            if let Some(marker) = motion.mechanism.any_marker(PointId(index as u32)) {
                *place = self.plain.state.poses[marker.body.index()].place(geometry.marker(marker));
            }
        }
    }

    /// A path parameter with its unit, as the file would say it.
    fn place_text(&self, p: f64) -> String {
        let model = &self.motion.mechanism.model;
        let dimension = match self.path_drive() {
            Some(drive) => model.drives.get(drive.index()).map(|d| d.dimension),
            None => None,
        };
        let unit = match dimension {
            Some(Dimension::ANGLE) => Unit::parse(&model.units.angle.name),
            Some(_) => Unit::parse(&model.units.length.name),
            None => Unit::parse("s"),
        };
        match unit {
            Ok(unit) => format_digits(p, &unit, NOTE_DIGITS),
            // A file's unit is one that was read; in SI at the worst.
            Err(_) => format!("{p} in SI"),
        }
    }

    fn why_unreached(&self, p: f64) -> String {
        let motion = self.motion;
        let (low, high) = motion.reached();
        let (reason, at) = if p > high {
            (motion.ends.1, high)
        } else {
            (motion.ends.0, low)
        };
        let at = self.place_text(at);
        match reason {
            EndReason::Limit => format!("not reached: the drive's limit is at {at}"),
            EndReason::TooLong => {
                format!("beyond {at}: the range is longer than can be followed")
            }
            EndReason::Stuck => {
                format!("not reached: the motion could not be followed beyond {at}")
            }
            EndReason::Runaway => {
                format!("not reached: a part runs away to infinity beyond {at}")
            }
            EndReason::Covered => "not reached: outside the motion".into(),
        }
    }

    fn note(&self, p: f64, sample: &Sample) -> Option<String> {
        if let Some(event) = self
            .motion
            .bridge(p)
            .filter(|e| e.kind == EventKind::ChangePoint)
        {
            return Some(format!(
                "change point at {}: the motion goes on smoothly, interpolated from both sides",
                self.place_text(event.at)
            ));
        }
        if !(sample.closure <= CLOSURE_LIMIT) {
            return Some(format!(
                "does not close: residual {:e} of the mechanism's size",
                sample.closure
            ));
        }
        let singular = self.motion.limit_at(p).is_some() || sample.smallest_singular_value < 1e-9;
        singular.then(|| "limit of the drive: rates are not defined here".into())
    }
}

/// The plain design as constants of a richer number.
fn lift<T: crate::newton::PlanNumber>(motion: &Motion<'_>) -> Design<T> {
    let parameters: Vec<T> = motion.mechanism.model.parameter_values();
    Design::new(motion.mechanism, motion.plan, &parameters)
}

/// The direction between two points at every node of the trace, without jumps.
fn unwrapped_directions(motion: &Motion<'_>, (a, b): (PointId, PointId)) -> Vec<f64> {
    let mut values: Vec<f64> = Vec::with_capacity(motion.nodes());
    for index in 0..motion.nodes() {
        let (_, poses, _) = motion.node(index);
        let mut angle = plain_direction(motion.mechanism, motion.design, &poses, a, b);
        if let Some(last) = values.last() {
            let turns = ((last - angle) / std::f64::consts::TAU).round();
            angle += turns * std::f64::consts::TAU;
        }
        values.push(angle);
    }
    // In the principal range where the motion starts.
    let start = motion
        .node_parameters()
        .partition_point(|&p| p < motion.start)
        .min(values.len().max(1) - 1);
    if let Some(at_start) = values.get(start).copied() {
        let turns = (at_start / std::f64::consts::TAU).round() * std::f64::consts::TAU;
        values.iter_mut().for_each(|v| *v -= turns);
    }
    values
}
