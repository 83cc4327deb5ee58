//! Length of path that a point has swept.

use kempe_mechanism::pose::dot;
use kempe_mechanism::state::Design;
use kempe_mechanism::structure::Marker;
use kempe_model::{LawPiece, PointId};
use kempe_motion::bridge::{Side, across};
use kempe_motion::drive_path::DrivePath;
use kempe_motion::events::EventKind;
use kempe_motion::motion::{Motion, Solver};
use kempe_motion::progress::{Stage, Watch};
use kempe_motion::trace::interval;
use kempe_number::Jet;

use crate::quadrature::integrate;

/// Parts of a step of the trace, or of a segment of a table, in which a change of sign is looked for.
const PARTS: usize = 8;
/// Bisections that close in on a change of sign to its last bit.
const BISECTIONS: usize = 60;
/// A speed that changes by less than this part over a step of the trace has no zero there.
const STEADY: f64 = 1e-9;
/// A length, in mechanism sizes, of which no more digits are asked for.
const SHORTEST: f64 = 1e-3;

/// Place, and its first two derivatives to the path parameter.
type Line = Jet<f64, 3>;

/// The swept length of one point, cumulated along the trace and in time.
#[derive(Clone, Debug)]
pub struct Swept {
    point: PointId,
    /// Path parameters, rising: the nodes of the trace, and where the point is slowest: it may turn back there, and its
    /// speed has a kink.
    marks: Vec<f64>,
    /// Length from the first mark to each.
    cumulated: Vec<f64>,
    /// Where the motion in time may turn back: time, length from the first mark, length swept since the start.
    turns: Vec<[f64; 3]>,
}

impl Swept {
    /// Integrates over a motion; `None` when stopped.
    pub fn watched(motion: &Motion, point: PointId, watch: &mut dyn Watch) -> Option<Self> {
        let mut it = Self {
            point,
            marks: Vec::new(),
            cumulated: vec![0.0],
            turns: Vec::new(),
        };
        let mut runner = Runner::new(motion, point);
        for pair in motion.node_parameters().windows(2) {
            it.marks.push(pair[0]);
            if let Some(runner) = &mut runner {
                it.marks.extend(runner.slowest(pair[0], pair[1]));
            }
        }
        it.marks.extend(motion.node_parameters().last());
        for index in 1..it.marks.len() {
            let part = index as f64 / it.marks.len() as f64;
            watch
                .reached(Stage::Measuring, Some(part))
                .continue_value()?;
            let length = it.stretch(motion, &mut runner, index - 1, it.marks[index]);
            it.cumulated.push(it.cumulated[index - 1] + length);
        }
        let parameters = motion.design.parameters.clone();
        let (low, high) = motion.reached();
        for (time, p) in turns(motion, &parameters) {
            let until = it.until(motion, &mut runner, p.clamp(low.min(high), high));
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
    pub fn at_time(&self, motion: &Motion, parameters: &[f64], time: f64) -> f64 {
        let passed = self.turns.partition_point(|[t, ..]| *t <= time).max(1) - 1;
        let Some([_, last, swept]) = self.turns.get(passed).filter(|_| time.is_finite()) else {
            return f64::NAN;
        };
        let model = &motion.mechanism().model;
        let now = motion.path.parameter_at(model, time, parameters);
        let mut runner = Runner::new(motion, self.point);
        swept + (self.until(motion, &mut runner, now) - last).abs()
    }

    /// Length from the first mark to a path parameter.
    fn until(&self, motion: &Motion, runner: &mut Option<Runner<'_>>, p: f64) -> f64 {
        let mark = interval(&self.marks, p);
        match self.marks.get(mark) {
            Some(_) => self.cumulated[mark] + self.stretch(motion, runner, mark, p),
            None => 0.0,
        }
    }

    /// Length from a mark to a path parameter before the next one. Towards a limit the speed along the path grows like one
    /// over a root, which the substitution p = limit -+ w^2 takes away.
    fn stretch(
        &self,
        motion: &Motion,
        runner: &mut Option<Runner<'_>>,
        mark: usize,
        to: f64,
    ) -> f64 {
        let (Some(runner), Some(&from)) = (runner, self.marks.get(mark)) else {
            return 0.0;
        };
        let limit_at = |p: Option<&f64>| {
            let at = |p: &f64| {
                let mut places = motion.places.iter();
                places.any(|e| e.kind == EventKind::Limit && e.at == *p)
            };
            p.copied().filter(at)
        };
        let floor = SHORTEST * motion.size();
        let over = |[a, b]: [f64; 2], f: &mut dyn FnMut(f64) -> f64| {
            let sign = if b < a { -1.0 } else { 1.0 };
            let found = integrate(&[[a.min(b), a.max(b)]], floor, &mut |x| Some([f(x)]));
            found.map_or(f64::NAN, |[length]| sign * length)
        };
        let mut speed = |p: f64| runner.speed(p);
        if let Some(limit) = limit_at(self.marks.get(mark + 1)) {
            let root = |p: f64| (limit - p).max(0.0).sqrt();
            return over([root(to), root(from)], &mut |w| {
                2.0 * w * speed(limit - w * w)
            });
        }
        if let Some(limit) = limit_at(Some(&from)) {
            let root = |p: f64| (p - limit).max(0.0).sqrt();
            return over([root(from), root(to)], &mut |w| {
                2.0 * w * speed(limit + w * w)
            });
        }
        over([from, to], &mut speed)
    }
}

/// A point on its way along the path, with the storage to solve it.
struct Runner<'a> {
    motion: &'a Motion,
    marker: Marker,
    design: Design<Line>,
    side_design: Design<Side>,
    solver: Solver<Line>,
    side: Solver<Side>,
}

impl<'a> Runner<'a> {
    fn new(motion: &'a Motion, point: PointId) -> Option<Self> {
        Some(Self {
            marker: motion.mechanism().any_marker(point)?,
            design: motion.design_on(),
            side_design: motion.design_on(),
            solver: motion.solver(),
            side: motion.solver(),
            motion,
        })
    }

    /// First and second derivative of its place to the path parameter.
    fn derivatives(&mut self, p: f64) -> [[f64; 2]; 2] {
        let motion = self.motion;
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

    fn speed(&mut self, p: f64) -> f64 {
        let [v, _] = self.derivatives(p);
        dot(v, v).sqrt()
    }

    /// Where between two path parameters the speed is smallest: zeros of `v . a` from below.
    fn slowest(&mut self, from: f64, to: f64) -> Vec<f64> {
        let width = (to - from) / PARTS as f64;
        let mut found = Vec::new();
        let mut slope = |p: f64| {
            let [v, a] = self.derivatives(p);
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
        let rich: Vec<Line> = parameters.iter().map(|x| Line::constant(*x)).collect();
        let rate = |t: f64| drive.law.at(Line::variable(t), &rich).coefficient(1);
        let starts = drive.law.breaks(parameters);
        for (piece, start) in drive.law.pieces.iter().zip(&starts) {
            // All other laws go one way from beginning to end.
            if let LawPiece::Table { times: knots, .. } = piece {
                for pair in knots.windows(2) {
                    let width = (pair[1] - pair[0]) / PARTS as f64;
                    let fine = (0..PARTS).map(|k| start + pair[0] + width * k as f64);
                    times.extend(fine.filter_map(|t| zero(&rate, t, t + width)));
                }
            }
        }
        times.extend(starts.iter().skip(1));
    }
    let at = |t: f64| (t, motion.path.parameter_at(model, t, parameters));
    times.into_iter().map(at).collect()
}

/// Where a function changes its sign, if it does.
fn zero(f: &impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> Option<f64> {
    let sign = f(low);
    if !(sign * f(high) <= 0.0) || sign == 0.0 {
        return None;
    }
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if f(middle) * sign > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(low)
}
