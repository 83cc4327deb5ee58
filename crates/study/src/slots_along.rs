//! Where along a whole motion a pin is beyond the ends of its curved slot, whatever rows are asked for.

use kempe_model::{Diagnostic, Joint, Model, PointId};
use kempe_motion::Motion;

use crate::events::place;
use crate::result::Frame;
use crate::slot_ends::{MOVE_ENDS, has_ends, length, past, pin_of, rows_beyond};
use crate::unit::Units;

/// Places at which every step of the trace is looked at; of long traces fewer, so that they are about so many in all.
const PLACES: usize = 8;
const MANY: usize = 2880;
/// Steps towards where a pin is farthest, each leaving 0.618 of the way.
const TOWARDS_FARTHEST: usize = 32;
/// Halvings of the way on which a pin comes to the end of its slot.
const HALVINGS: usize = 40;

/// A warning for each curved slot that its pin leaves anywhere on a motion, with from where to where; `frames` are those of the rows.
pub(crate) fn slots_left(
    model: &Model,
    name: &str,
    motion: &Motion,
    frames: &[Frame],
) -> Vec<Diagnostic> {
    if !has_ends(model) {
        return Vec::new();
    }
    let (parameters, units) = (&motion.design.parameters, Units::of(model));
    let mut along = Along::new(motion);
    let warnings = model.joints.iter().filter_map(|joint| {
        let Left { stretches, farthest } = along.left(joint)?;
        let point = model.points.get(pin_of(joint)?.index())?;
        let [from, to] = stretches.first()?.map(|at| place(motion, at));
        let more = match stretches.len() - 1 {
            0 => String::new(),
            1 => " and once more".to_owned(),
            count => format!(" and {count} times more"),
        };
        let (at, far) = (place(motion, farthest.0), length(&units, farthest.1));
        let (point, slot) = (&point.name, &joint.name);
        let message = format!(
            "study `{name}`: {point} leaves the curved slot `{slot}` from {from} to {to}{more}, farthest at {at}, by {far}"
        );
        let rows = rows_beyond(joint, parameters, frames);
        Some(
            Diagnostic::warning("leaves-slot", message)
                .at(joint.span.clone(), "")
                .note(format!("in {rows} of {} rows", frames.len()))
                .help(MOVE_ENDS),
        )
    });
    warnings.collect()
}

/// Where a pin is beyond the ends of its slot.
struct Left {
    /// Ends of the stretches, by the path parameter, in the order of the motion.
    stretches: Vec<[f64; 2]>,
    /// Where it is farthest, and how far, m.
    farthest: (f64, f64),
}

/// A motion that is looked along.
struct Along<'m> {
    motion: &'m Motion,
    solver: kempe_motion::Solver<f64>,
    /// Places that are looked at, in the order of the motion, and where the points are there.
    places: Vec<(f64, Vec<[f64; 2]>)>,
}

impl<'m> Along<'m> {
    fn new(motion: &'m Motion) -> Self {
        let (low, high) = motion.reached();
        let nodes = motion.node_parameters().iter().copied();
        let nodes = nodes.filter(|p| low < *p && *p < high);
        let nodes: Vec<f64> = [low].into_iter().chain(nodes).chain([high]).collect();
        let count = (MANY / nodes.len()).clamp(1, PLACES);
        let inside = nodes.windows(2).flat_map(|step| {
            let part = |k: usize| step[0] + (step[1] - step[0]) * k as f64 / count as f64;
            (0..count).map(part)
        });
        let mut at: Vec<f64> = inside.chain([high]).collect();
        at.dedup();
        if (motion.start - low).abs() > (motion.start - high).abs() {
            at.reverse();
        }
        let mut it = Self {
            motion,
            solver: motion.solver(),
            places: Vec::new(),
        };
        it.places = at.into_iter().map(|p| (p, it.points(p))).collect();
        it
    }

    /// Where the points of the model are at a place; nowhere where there is no pose.
    fn points(&mut self, at: f64) -> Vec<[f64; 2]> {
        let (mechanism, geometry) = (self.motion.mechanism(), &self.motion.design.geometry);
        let placed = self.motion.placed(at, &mut self.solver);
        let points = (0..mechanism.model.points.len() as u32).map(PointId);
        let place = |point| {
            let marker = mechanism.any_marker(point)?;
            let pose = placed.as_ref()?.poses.get(marker.body.index())?;
            Some(pose.place(geometry.marker(marker)))
        };
        points.map(|p| place(p).unwrap_or([f64::NAN; 2])).collect()
    }

    /// How far a pin is beyond the ends of its slot, m; without a pose it is not.
    fn past(&mut self, joint: &Joint, at: f64) -> f64 {
        let points = self.points(at);
        past(joint, &self.motion.design.parameters, &points).unwrap_or(f64::NEG_INFINITY)
    }

    /// `None` where its pin stays between the ends, and for a joint that is no curved slot.
    fn left(&mut self, joint: &Joint) -> Option<Left> {
        let parameters = &self.motion.design.parameters;
        let known = self.places.iter().map(|(p, points)| {
            let past = past(joint, parameters, points).unwrap_or(f64::NEG_INFINITY);
            (*p, past)
        });
        let known: Vec<(f64, f64)> = known.collect();
        pin_of(joint)?;
        let most = known
            .iter()
            .map(|it| it.1)
            .fold(f64::NEG_INFINITY, f64::max);
        let mut all: Vec<(f64, f64)> = Vec::with_capacity(known.len());
        all.extend(known.first());
        for three in known.windows(3) {
            let [before, here, after] = [three[0], three[1], three[2]];
            let rise = here.1 - before.1.min(after.1);
            // It may be beyond between these places, or farthest of all.
            let asks = (here.1 <= 0.0 && here.1 + rise > 0.0) || here.1 == most;
            let top = asks && before.1 < here.1 && here.1 >= after.1;
            let top = top.then(|| self.farthest(joint, [before.0, after.0], here));
            let first = top.is_some_and(|top| (top.0 < here.0) == (before.0 < after.0));
            all.extend(top.filter(|_| first));
            all.push(here);
            all.extend(top.filter(|_| !first));
        }
        all.extend(known.last().filter(|_| known.len() > 1));
        let farthest = all.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1))?;
        if !(farthest.1 > 0.0) {
            return None;
        }
        let mut stretches: Vec<[f64; 2]> = Vec::new();
        let mut before: Option<(f64, f64)> = None;
        for here in all {
            let was = before.is_some_and(|before| before.1 > 0.0);
            let is = here.1 > 0.0;
            let at = match before.filter(|_| was != is) {
                Some(before) => self.end(joint, before, here),
                None => here.0,
            };
            match (was, is) {
                (false, true) => stretches.push([at, here.0]),
                (true, _) => stretches.last_mut().into_iter().for_each(|s| s[1] = at),
                (false, false) => {}
            }
            before = Some(here);
        }
        Some(Left {
            stretches,
            farthest,
        })
    }

    /// Where between two places a pin is farthest, near one where it is farther than at both (golden sections).
    fn farthest(
        &mut self,
        joint: &Joint,
        [mut a, mut b]: [f64; 2],
        known: (f64, f64),
    ) -> (f64, f64) {
        let part = 0.5 * (5.0_f64.sqrt() - 1.0);
        let mut best = known;
        let mut inner = [b - part * (b - a), a + part * (b - a)].map(|p| (p, self.past(joint, p)));
        for _ in 0..TOWARDS_FARTHEST {
            for at in inner {
                if at.1 > best.1 {
                    best = at;
                }
            }
            if inner[0].1 >= inner[1].1 {
                (b, inner[1]) = (inner[1].0, inner[0]);
                let p = b - part * (b - a);
                inner[0] = (p, self.past(joint, p));
            } else {
                (a, inner[0]) = (inner[0].0, inner[1]);
                let p = a + part * (b - a);
                inner[1] = (p, self.past(joint, p));
            }
        }
        best
    }

    /// Where between two places a pin comes to the end of its slot.
    fn end(&mut self, joint: &Joint, from: (f64, f64), to: (f64, f64)) -> f64 {
        let (mut a, mut b) = (from.0, to.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (a + b);
            match (self.past(joint, middle) > 0.0) == (from.1 > 0.0) {
                true => a = middle,
                false => b = middle,
            }
        }
        b
    }
}
