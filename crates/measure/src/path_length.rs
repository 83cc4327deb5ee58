//! Length of path that a point has swept.

use kempe_mechanism::Design;
use kempe_mechanism::pose::dot;
use kempe_mechanism::structure::Marker;
use kempe_model::PointId;
use kempe_motion::bridge::{SideSeries, across};
use kempe_motion::drive_path::DrivePath;
use kempe_motion::events::EventKind;
use kempe_motion::motion::{Motion, Solver};
use kempe_motion::progress::{Done, Progress, Stage};
use kempe_motion::trace::interval;
use kempe_number::Jet;

use crate::quadrature::{Floor, gauss, parts};

/// Parts of a step of the trace in which a change of sign is looked for.
const PARTS: usize = 8;
/// Bisections that close in on a change of sign to its last bit.
const BISECTIONS: usize = 60;
/// A speed that changes by less than this part over a step of the trace has no zero there.
const STEADY: f64 = 1e-9;
/// A length, in mechanism sizes, of which no more digits are asked for.
const SHORTEST: f64 = 1e-3;

/// PathPlace, and its first two derivatives to the path parameter.
type Line = Jet<f64, 3>;

/// The swept length of one point, cumulated along the trace and in time.
#[derive(Clone, Debug)]
pub struct Swept {
    point: PointId,
    /// What solves it along the path; `None` for a point that is on no link.
    runner: Option<Runner>,
    /// Where stretches begin, in path parameters, rising: the nodes of the trace, and where the point is slowest: it may
    /// turn back there, and its speed has a kink.
    starts: Vec<f64>,
    stretches: Vec<SweptPart>,
    /// Where the motion in time may turn back: time, length from the first stretch's start, length swept since the start of
    /// the motion.
    turns: Vec<[f64; 3]>,
}

/// A stretch of the path, in parts on each of which one quadrature is enough.
#[derive(Clone, Debug)]
struct SweptPart {
    by: Variable,
    /// Ends of its parts in that variable, rising.
    marks: Vec<f64>,
    /// Length from the first mark to each.
    cumulated: Vec<f64>,
    /// Length from the first stretch's start to its own.
    before: f64,
}

/// What a stretch is integrated over. Towards a limit the speed along the path grows like one over a root, which the
/// substitution p = limit -+ w^2 takes away.
#[derive(Clone, Copy, Debug)]
enum Variable {
    Path,
    /// The root of what is left to a limit.
    ToLimit(f64),
    /// The root of what has passed since one.
    FromLimit(f64),
}

impl Swept {
    /// Integrates over a motion; `None` when stopped.
    pub fn with_progress(
        motion: &Motion,
        point: PointId,
        progress: &mut dyn Progress,
    ) -> Option<Self> {
        let mut it = Self {
            point,
            runner: Runner::new(motion, point),
            starts: Vec::new(),
            stretches: Vec::new(),
            turns: Vec::new(),
        };
        if let Some(runner) = &mut it.runner {
            let mut marks = Vec::new();
            for pair in motion.node_parameters().windows(2) {
                marks.push(pair[0]);
                marks.extend(runner.slowest(motion, pair[0], pair[1]));
            }
            marks.extend(motion.node_parameters().last());
            let mut before = 0.0;
            for (index, pair) in marks.windows(2).enumerate() {
                let part = index as f64 / marks.len() as f64;
                progress
                    .reached(Stage::Measuring, Done::Part(part))
                    .continue_value()?;
                let stretch = SweptPart::new(motion, runner, [pair[0], pair[1]], before);
                before += stretch.length();
                it.starts.push(pair[0]);
                it.stretches.push(stretch);
            }
        }
        let (low, high) = motion.reached();
        for (time, p) in turns(motion, &motion.design.parameters) {
            let until = it.until(motion, p.clamp(low.min(high), high));
            let last = it.turns.last();
            let swept = last.map_or(0.0, |[_, last, swept]| swept + (until - last).abs());
            it.turns.push([time, until, swept]);
        }
        Some(it)
    }

    /// The point.
    pub fn point(&self) -> PointId {
        self.point
    }

    /// Length swept from the start of the motion until a time, m.
    pub fn at_time(&mut self, motion: &Motion, time: f64) -> f64 {
        let passed = self.turns.partition_point(|[t, ..]| *t <= time).max(1) - 1;
        let turn = self.turns.get(passed).filter(|_| time.is_finite());
        let Some([_, last, swept]) = turn.copied() else {
            return f64::NAN;
        };
        let (model, parameters) = (&motion.mechanism().model, &motion.design.parameters);
        let now = motion.path.parameter_at(model, time, parameters);
        swept + (self.until(motion, now) - last).abs()
    }

    /// Length from the first stretch's start to a path parameter.
    fn until(&mut self, motion: &Motion, p: f64) -> f64 {
        let place = (self.starts.partition_point(|start| *start <= p)).max(1) - 1;
        match (&mut self.runner, self.stretches.get(place)) {
            (Some(runner), Some(stretch)) => stretch.until(motion, runner, p),
            _ => 0.0,
        }
    }
}

impl SweptPart {
    fn new(motion: &Motion, runner: &mut Runner, [from, to]: [f64; 2], before: f64) -> Self {
        let is_limit = |p: f64| {
            let mut places = motion.places.iter();
            places.any(|e| e.kind == EventKind::Limit && e.at == p)
        };
        let by = if is_limit(to) {
            Variable::ToLimit(to)
        } else if is_limit(from) {
            Variable::FromLimit(from)
        } else {
            Variable::Path
        };
        let [a, b] = [by.of(from), by.of(to)];
        let floor = SHORTEST * motion.size();
        let parts = parts(&[[a.min(b), a.max(b)]], Floor::of(floor), &mut |x| {
            Some([by.speed(motion, runner, x)])
        });
        let (mut marks, mut cumulated) = (vec![a.min(b)], vec![0.0]);
        let mut sum = 0.0;
        for part in parts.iter().flatten() {
            let [length] = part.integral();
            sum += length;
            marks.push(part.to);
            cumulated.push(sum);
        }
        Self {
            by,
            marks,
            cumulated,
            before,
        }
    }

    /// Its whole length.
    fn length(&self) -> f64 {
        self.cumulated.last().copied().unwrap_or(0.0)
    }

    /// Length from the first stretch's start to a path parameter of this one.
    fn until(&self, motion: &Motion, runner: &mut Runner, p: f64) -> f64 {
        let x = self.by.of(p);
        let part = interval(&self.marks, x);
        let (Some(&mark), Some(&cumulated)) = (self.marks.get(part), self.cumulated.get(part))
        else {
            return self.before;
        };
        let rest = match x == mark {
            true => Some([0.0]),
            false => gauss(mark, x, &mut |x| Some([self.by.speed(motion, runner, x)])),
        };
        let length = cumulated + rest.map_or(f64::NAN, |[rest]| rest);
        self.before
            + match self.by {
                Variable::ToLimit(_) => self.length() - length,
                _ => length,
            }
    }
}

impl Variable {
    fn of(self, p: f64) -> f64 {
        match self {
            Self::Path => p,
            Self::ToLimit(limit) => (limit - p).max(0.0).sqrt(),
            Self::FromLimit(limit) => (p - limit).max(0.0).sqrt(),
        }
    }

    /// Length of path for each unit of the variable.
    fn speed(self, motion: &Motion, runner: &mut Runner, x: f64) -> f64 {
        match self {
            Self::Path => runner.speed(motion, x),
            Self::ToLimit(limit) => 2.0 * x * runner.speed(motion, limit - x * x),
            Self::FromLimit(limit) => 2.0 * x * runner.speed(motion, limit + x * x),
        }
    }
}

/// A point on its way along the path, with the storage to solve it.
#[derive(Clone, Debug)]
struct Runner {
    marker: Marker,
    design: Design<Line>,
    side_design: Design<SideSeries>,
    solver: Solver<Line>,
    side: Solver<SideSeries>,
}

impl Runner {
    fn new(motion: &Motion, point: PointId) -> Option<Self> {
        Some(Self {
            marker: motion.mechanism().any_marker(point)?,
            design: motion.design_on(),
            side_design: motion.design_on(),
            solver: motion.solver(),
            side: motion.solver(),
        })
    }

    /// First and second derivative of its place to the path parameter.
    fn derivatives(&mut self, motion: &Motion, p: f64) -> [[f64; 2]; 2] {
        let body = self.marker.body.index();
        let pose = match motion.bridge(p) {
            Some(event) => across(motion, &self.side_design, event, p, &mut self.side)[body],
            None => {
                motion.solve(&self.design, Line::variable(p), &mut self.solver);
                self.solver.state.poses[body]
            }
        };
        let at = pose.place(self.design.geometry.marker(self.marker));
        [1, 2].map(|order| at.map(|x| x.derivative(order)))
    }

    fn speed(&mut self, motion: &Motion, p: f64) -> f64 {
        let [v, _] = self.derivatives(motion, p);
        dot(v, v).sqrt()
    }

    /// Where between two path parameters the speed is smallest: zeros of `v . a` from below.
    fn slowest(&mut self, motion: &Motion, from: f64, to: f64) -> Vec<f64> {
        let width = (to - from) / PARTS as f64;
        let mut found = Vec::new();
        let mut slope = |p: f64| {
            let [v, a] = self.derivatives(motion, p);
            let (growth, square) = (dot(v, a), dot(v, v));
            // A turning point of a steady speed is no kink; nor is the rounding of a point that stands still.
            let steady = (growth * width).abs() <= STEADY * square;
            if steady { f64::NAN } else { growth }
        };
        // At a limit there are no derivatives, and nothing compares with them.
        let at = |k: usize| from + width * k as f64;
        let mut last = slope(at(0));
        for k in 1..=PARTS {
            let next = slope(at(k));
            if last < 0.0 && next > 0.0 {
                let (mut low, mut high) = (at(k - 1), at(k));
                for _ in 0..BISECTIONS {
                    let middle = 0.5 * (low + high);
                    if slope(middle) < 0.0 {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
                found.push(high);
            }
            last = next;
        }
        found
    }
}

/// Times, from the start on, between which the path parameter runs one way, with the path parameters there.
fn turns(motion: &Motion, parameters: &[f64]) -> Vec<(f64, f64)> {
    let model = &motion.mechanism().model;
    let mut times = vec![0.0];
    if let DrivePath::Coordinate { drive, .. } = motion.path
        && let Some(drive) = model.drives.get(drive)
    {
        times.extend(drive.law.turns(parameters));
    }
    let at = |t: f64| (t, motion.path.parameter_at(model, t, parameters));
    times.into_iter().map(at).collect()
}
