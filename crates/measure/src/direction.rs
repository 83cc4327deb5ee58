//! Directions between two points along a motion, without jumps.

use std::f64::consts::{PI, TAU};

use kempe_mechanism::Design;
use kempe_mechanism::pose::{Pose, sub};
use kempe_model::{Measure, PointId};
use kempe_motion::motion::Motion;
use kempe_motion::trace::interval;
use kempe_number::math;

use crate::history::History;
use crate::measure::needs::Needs;

/// An angle this near, rad, to half a turn below zero counts as half a turn above it: rounding decides no turn.
const HALF_TURN: f64 = 1e-9;

/// The directions between points that measures ask for, followed along a motion.
#[derive(Default)]
pub struct Directions(Vec<Direction>);

impl Directions {
    /// Those that these measures ask for.
    pub fn of<'m>(motion: &Motion, measures: impl Iterator<Item = &'m Measure>) -> Self {
        Self::between(motion, &Needs::of(motion, measures).directions)
    }

    /// Those from one point to another each.
    pub(crate) fn between(motion: &Motion, points: &[(PointId, PointId)]) -> Self {
        let directions = points.iter();
        Self(directions.map(|p| Direction::new(motion, *p)).collect())
    }

    /// How often each has turned at a path parameter of the motion, as measures there take it.
    pub fn history<B>(&self, motion: &Motion, p: f64) -> History<B> {
        let directions = self.0.iter();
        History {
            directions: directions.map(|d| (d.points, d.near(motion, p))).collect(),
            ..History::default()
        }
    }
}

/// The direction from one point to another, unwrapped at every node of the trace.
struct Direction {
    points: (PointId, PointId),
    /// rad, at the nodes.
    values: Vec<f64>,
}

impl Direction {
    /// Follows a direction over the whole trace; where the motion starts it is within half a turn of where it is on the motion that this
    /// one is counted as, or of zero.
    fn new(motion: &Motion, points: (PointId, PointId)) -> Self {
        let mut values: Vec<f64> = Vec::with_capacity(motion.nodes());
        for index in 0..motion.nodes() {
            let (_, poses, _) = motion.node(index);
            let (a, b) = points;
            let mut angle = plain_direction(&motion.design, &poses, a, b);
            if let Some(last) = values.last() {
                angle += whole_turns(last - angle);
            }
            values.push(angle);
        }
        if let Some(at_start) = values.get(at_start(motion)).copied() {
            let like = motion.counts_as.as_deref();
            let turns = whole_turns(at_start - like.map_or(0.0, |like| principal(like, points)));
            values.iter_mut().for_each(|v| *v -= turns);
        }
        Self { points, values }
    }

    /// About where it is at a path parameter, rad.
    fn near(&self, motion: &Motion, p: f64) -> f64 {
        let (parameters, values) = (motion.node_parameters(), &self.values);
        let node = interval(parameters, p);
        match (parameters.get(node), parameters.get(node + 1)) {
            (Some(a), Some(b)) if b > a => {
                let part = ((p - a) / (b - a)).clamp(0.0, 1.0);
                values[node] + part * (values[node + 1] - values[node])
            }
            _ => values.first().copied().unwrap_or(0.0),
        }
    }
}

/// The node at which a motion starts, or the one before.
fn at_start(motion: &Motion) -> usize {
    let parameters = motion.node_parameters();
    let start = parameters.partition_point(|&p| p < motion.start);
    start.min(parameters.len().max(1) - 1)
}

/// A direction where a motion starts, within half a turn of zero, rad.
fn principal(motion: &Motion, (a, b): (PointId, PointId)) -> f64 {
    let (_, poses, _) = motion.node(at_start(motion));
    let angle = plain_direction(&motion.design, &poses, a, b);
    angle - whole_turns(angle)
}

/// The whole turns nearest to an angle, rad; what is half a turn, rounding aside, is half a turn and not minus that.
pub(crate) fn whole_turns(angle: f64) -> f64 {
    ((angle - PI - HALF_TURN) / TAU).ceil() * TAU
}

/// The direction from one point to another, principal value, rad.
fn plain_direction(design: &Design<f64>, poses: &[Pose<f64>], a: PointId, b: PointId) -> f64 {
    let mechanism = &*design.mechanism;
    let place = |p: PointId| {
        mechanism.any_marker(p).map_or([f64::NAN; 2], |m| {
            poses[m.body.index()].place(design.geometry.marker(m))
        })
    };
    let v = sub(place(b), place(a));
    math::atan2(v[1], v[0])
}
