//! A motion with some parameters varied: places and measures on dual numbers.

use std::sync::Arc;

use kempe_model::{DriveId, Leaf, Measure, ParameterId, PointId, PoseMeasure, Statistic};
use kempe_motion::motion::Motion;
use kempe_motion::trace::Path;
use kempe_number::Number;

use super::corner::Corners;
use super::held::Held;
use super::turn::Turns;
use crate::base::{CHUNK, Varying};
use crate::force_source::ForceSource;
use crate::measure::needs::Needs;
use crate::measure::{Along, History, Moment, visit_leaves};
use crate::measurer::{Measurer, asks_forces};
use crate::sampler::Sampler;
use crate::state::Series;
pub(super) use crate::states_along::PathPlace;

/// The length of path that a point has swept, with its derivatives.
pub(super) struct Cumulated {
    pub point: PointId,
    /// Times, rising, with the length swept until then.
    pub marks: Vec<(Varying, Varying)>,
}

/// A number over the motion that stands at a corner.
pub(super) struct CornerOver {
    statistic: Statistic,
    measure: Measure,
    /// What moves it away from that.
    moved: [bool; CHUNK],
    /// Its derivatives on the other side; not a number where they are not known.
    other: [f64; CHUNK],
}

impl CornerOver {
    fn is_of(&self, statistic: &Statistic, measure: &Measure) -> bool {
        self.statistic == *statistic && self.measure == *measure
    }
}

/// The values of all parameters of a motion's design with their derivatives to some. A varied parameter still follows those it is
/// built on: d/d(each) is the same whatever else is asked for.
pub(super) fn varied_parameters(motion: &Motion, chunk: &[ParameterId]) -> Vec<Varying> {
    let model = &motion.mechanism().model;
    let mut values: Vec<Varying> = Vec::with_capacity(model.parameters.len());
    for (index, parameter) in model.parameters.iter().enumerate() {
        let mut value = kempe_model::value(&parameter.value, &values);
        value.re = motion.design.parameters[index];
        for (eps, id) in value.eps.iter_mut().zip(chunk) {
            if id.index() == index {
                *eps += 1.0;
            }
        }
        values.push(value);
    }
    values
}

/// A motion with some parameters varied. Times of extremes come from the plain motion's sampler.
pub(super) struct Varied<'s, F, G> {
    pub motion: Arc<Motion>,
    pub sampler: &'s mut Sampler<F>,
    pub measurer: Measurer<Varying, G>,
    /// Lengths of path that were asked for.
    pub lengths: Vec<Cumulated>,
    /// Numbers over the motion that stand at a corner.
    pub corners: Vec<CornerOver>,
    /// When what rubs turns back, once that is asked for.
    pub turns: Option<Turns>,
    /// How fast each thing that rubs slides, once that is asked for.
    pub usual_speeds: Option<Vec<f64>>,
}

impl<'s, F: ForceSource, G: ForceSource<Varying>> Varied<'s, F, G> {
    pub(super) fn new(
        motion: &Arc<Motion>,
        sampler: &'s mut Sampler<F>,
        parameters: &[Varying],
        forces: G,
    ) -> Self {
        Self {
            measurer: Measurer::new(motion, parameters, forces),
            motion: motion.clone(),
            sampler,
            lengths: Vec::new(),
            corners: Vec::new(),
            turns: None,
            usual_speeds: None,
        }
    }

    pub(super) fn parameters(&self) -> &[Varying] {
        self.measurer.states.parameters()
    }

    /// The place that is held.
    pub(super) fn place(&self, held: Held) -> PathPlace<Varying> {
        match (held, self.sampler.path_drive()) {
            (Held::Time(t) | Held::Extreme { time: t, .. }, _) | (Held::Path(t), None) => {
                self.at_time(Varying::from_f64(t))
            }
            (Held::Break(t), _) => {
                let apart = |b: &Varying| (b.re - t).abs();
                let breaks = self.breaks().into_iter();
                let near = breaks.min_by(|a, b| apart(a).total_cmp(&apart(b)));
                self.at_time(near.unwrap_or(Varying::from_f64(t)))
            }
            // The first time at which the path drive has this coordinate.
            (Held::Path(p), Some(drive)) => PathPlace {
                time: self.passing(drive, Varying::from_f64(p), self.sampler.clock().time_at(p)),
                path: Varying::from_f64(p),
            },
        }
    }

    /// The place at a time that may move with the parameters.
    pub(super) fn at_time(&self, time: Varying) -> PathPlace<Varying> {
        self.measurer.states.at_time(time)
    }

    /// The time, about `time`, at which a drive's coordinate is at a place that may move itself: dt = (da - dq) / (dq/dt).
    pub(super) fn passing(&self, drive: DriveId, at: Varying, time: f64) -> Varying {
        let law = &self.motion.mechanism().model.drives[drive.index()].law;
        let rich: Vec<Series<Varying>> =
            (self.parameters().iter().map(|x| Series::constant(*x))).collect();
        let q = law.at(Series::variable(Varying::from_f64(time)), &rich);
        let (change, rate) = (at - q.coefficient(0), q.coefficient(1).re);
        Varying {
            re: time,
            // A law that no parameter moves leaves its times, even those at rest.
            eps: change.eps.map(|d| if d == 0.0 { 0.0 } else { d / rate }),
        }
    }

    /// Finds out what the measures need, and evaluates their statistics.
    pub(super) fn prepare(&mut self, measures: &[&Measure]) {
        let inputs = self.measurer.forces.measures().iter();
        let needs = Needs::of(&self.motion, inputs.chain(measures.iter().copied()));
        self.measurer.take_up(&needs);
        for (statistic, measure) in needs.statistics {
            let value = self.over(&statistic, &measure);
            let (moved, other) = self.corner_over(&statistic, &measure, value);
            if moved.contains(&true) {
                self.corners.push(CornerOver {
                    statistic: statistic.clone(),
                    measure: measure.clone(),
                    moved,
                    other,
                });
            }
            self.measurer.statistics.push((statistic, measure, value));
        }
    }

    /// What moves a measure away from corners of the numbers over the motion in it.
    pub(super) fn at_corner_over(&self, measure: &Measure) -> [bool; CHUNK] {
        let mut at = [false; CHUNK];
        if self.corners.is_empty() {
            return at;
        }
        let inputs = self.measurer.forces.measures().iter();
        let inputs = inputs.filter(|_| asks_forces(&self.motion, measure));
        for measure in inputs.chain([measure]) {
            visit_leaves(self.motion.mechanism(), measure, &mut |leaf| {
                let Leaf::Over(statistic, inner) = leaf else {
                    return;
                };
                let mut own = self.corners.iter();
                if let Some(corner) = own.find(|it| it.is_of(statistic, inner)) {
                    (at.iter_mut().zip(corner.moved)).for_each(|(it, moved)| *it |= moved);
                }
            });
        }
        at
    }

    /// The derivatives of a measure on the other side of the corners of the numbers over the motion in it; not a number where they are not known.
    pub(super) fn on_the_other_side(
        &mut self,
        measure: &Measure,
        place: PathPlace<Varying>,
    ) -> [f64; CHUNK] {
        let own = self.measurer.statistics.clone();
        for (statistic, inner, value) in &mut self.measurer.statistics {
            let mut corners = self.corners.iter();
            if let Some(corner) = corners.find(|it| it.is_of(statistic, inner)) {
                value.eps = corner.other;
            }
        }
        let found = self.value_at_corner(measure, place).0;
        self.measurer.statistics = own;
        found.eps
    }

    /// A measure as a series in time at a place.
    pub(super) fn series(
        &mut self,
        measure: &Measure,
        place: PathPlace<Varying>,
    ) -> Series<Varying> {
        self.series_along(measure, place, Along::Time)
    }

    /// A measure as a series at a place.
    pub(super) fn series_along(
        &mut self,
        measure: &Measure,
        place: PathPlace<Varying>,
        along: Along,
    ) -> Series<Varying> {
        let found = self.at(measure, place, |moment| moment.series(measure, along));
        found.unwrap_or(Series::from_f64(f64::NAN))
    }

    /// The value of a measure at a place that is given: at a corner it has no derivatives.
    pub(super) fn value_off_corners(
        &mut self,
        measure: &Measure,
        place: PathPlace<Varying>,
    ) -> Varying {
        let (value, at) = self.value_at_corner(measure, place);
        let eps = std::array::from_fn(|k| if at[k] { f64::NAN } else { value.eps[k] });
        Varying { eps, ..value }
    }

    /// The same with derivatives as if there were one side alone, and which of them move it away from a corner.
    pub(super) fn value_at_corner(
        &mut self,
        measure: &Measure,
        place: PathPlace<Varying>,
    ) -> (Varying, [bool; CHUNK]) {
        let found = self.with_corners(measure, place, |corners| corners.value(measure));
        let Some((value, mut at)) = found else {
            return (Varying::from_f64(f64::NAN), [false; CHUNK]);
        };
        let of_turn = self.corner_of_turn(measure, place);
        (at.iter_mut().zip(of_turn)).for_each(|(it, moved)| *it |= moved);
        (value, at)
    }

    /// The size of what a measure is made of at a place; not a number where the motion is not.
    pub(super) fn size_of(&mut self, measure: &Measure, place: PathPlace<Varying>) -> f64 {
        let found = self.with_corners(measure, place, |corners| corners.size(measure));
        found.unwrap_or(f64::NAN)
    }

    fn with_corners<R>(
        &mut self,
        measure: &Measure,
        place: PathPlace<Varying>,
        ask: impl FnOnce(&mut Corners<'_, '_>) -> R,
    ) -> Option<R> {
        let (size, changes) = (self.motion.size(), self.changes());
        let (low, high) = self.motion.demanded;
        let way = (high - low) / self.motion.path.scale();
        let time = self.sampler.duration() / way.max(f64::MIN_POSITIVE);
        let motion = self.motion.clone();
        self.at(measure, place, |moment| {
            let model = &motion.mechanism().model;
            ask(&mut Corners {
                model,
                moment,
                size,
                time,
                changes,
                looked: Vec::new(),
                sizes: Vec::new(),
            })
        })
    }

    /// Asks what a measure needs at a place; `None` where the motion is not.
    fn at<R>(
        &mut self,
        measure: &Measure,
        place: PathPlace<Varying>,
        ask: impl FnOnce(&Moment<'_, Varying>) -> R,
    ) -> Option<R> {
        let with_forces = asks_forces(&self.motion, measure);
        let inputs = self
            .measurer
            .forces
            .measures()
            .iter()
            .filter(|_| with_forces);
        let points = lengths_of(&self.motion, inputs.chain([measure]));
        let lengths: Vec<(PointId, Varying)> = (points.into_iter())
            .map(|p| (p, self.length(p, place.time)))
            .collect();
        if !self.measurer.find(place) {
            return None;
        }
        let history = History {
            lengths,
            forces: match with_forces {
                true => self.sampler.directions_of_forces(place.time.re),
                false => Vec::new(),
            },
            ..History::default()
        };
        Some((self.measurer).with_moment(place.path.re, history, with_forces, ask))
    }

    pub(super) fn value(&mut self, measure: &Measure, place: PathPlace<Varying>) -> Varying {
        self.series(measure, place).coefficient(0)
    }
}

/// The points of whose path measures ask for the length (and statistics inside them: these have their own).
fn lengths_of<'m>(motion: &Motion, measures: impl Iterator<Item = &'m Measure>) -> Vec<PointId> {
    let mut points = Vec::new();
    for measure in measures {
        visit_leaves(motion.mechanism(), measure, &mut |leaf| {
            if let Leaf::Pose(PoseMeasure::PathLength(point)) = leaf
                && !points.contains(point)
            {
                points.push(*point);
            }
        });
    }
    points
}
