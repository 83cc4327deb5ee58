//! Rows of a motion: measures, poses and evidence at any place or time.
//!
//! What the measures need is found first (`prepare.rs`). Then a row is its place on the path, the state there, the measures of
//! that moment (`moment`) and a note where there is something to say (`note`).

mod between;
mod counted;
mod moment;
mod note;
mod rates;

pub(crate) use self::between::{Between, Kept};
pub(crate) use self::counted::CountedForces;
pub(crate) use self::moment::Asked;
pub use self::rates::PointRates;

use std::sync::Arc;

use kempe_mechanism::bordered::Bordered;
use kempe_mechanism::evidence::evidence;
use kempe_mechanism::{Geometry, Mechanism, Pose};
use kempe_model::{Leaf, Measure, PointId, Statistic};
use kempe_motion::motion::{Motion, Solver};

use crate::clock::Clock;
use crate::extremes::{At, Extremes};
use crate::force_source::{ForceSource, NoForces};
use crate::measure::visit_leaves;
use crate::measurer::Measurer;
use crate::path_length::Swept;
use crate::row_note::RowNote;
use crate::state::State;
use crate::states_along::PathPlace;
use crate::statistic_note::StatisticNote;

/// A closure residual (in mechanism sizes) above which a row is marked.
pub const CLOSURE_LIMIT: f64 = 1e-9;

/// One row of a motion.
#[derive(Clone, Debug)]
#[non_exhaustive]
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
    /// How every point of the model moves; NaN where the row was not reached, or where it has no rate.
    pub rates: Vec<PointRates>,
    /// Largest closure residual, in mechanism sizes (directions in rad).
    pub closure: f64,
    /// Smallest singular value of the scaled constraint Jacobian.
    pub smallest_singular_value: f64,
    /// What a careful engineer would want to be told about this row, such as why it could not be reached.
    pub note: Option<RowNote>,
}

/// Evaluates measures along a motion; those of forces too where it is given their source.
pub struct Sampler<F = NoForces> {
    pub(crate) measurer: Measurer<f64, F>,
    pub(crate) measures: Vec<Measure>,
    /// Lengths of path that are asked for.
    pub(crate) lengths: Vec<Swept>,
    /// Moving points whose curvature is asked for.
    pub(crate) curved: Vec<PointId>,
    pub(crate) plain: Solver<f64>,
    /// Times at which rows will be asked for, rising: statistics look there too.
    pub(crate) rows: Vec<f64>,
    /// What the statistics found of their measures.
    pub(crate) known: Vec<Extremes>,
    /// What is to be told of numbers over the motion.
    pub(crate) notes: Vec<(Statistic, Measure, StatisticNote)>,
    /// Times, rising, at which numbers over the motion had to be looked at closely.
    pub(crate) closely: Vec<f64>,
    pub(crate) system: Bordered,
    /// Where directions of forces are on the motion that this one is counted as.
    pub(crate) counted: Option<Box<CountedForces<F>>>,
}

impl<F: ForceSource> Sampler<F> {
    /// The source of forces, as it stands after the row last asked for.
    pub fn forces(&self) -> &F {
        &self.measurer.forces
    }

    /// Times at which rows will be asked for, rising.
    pub(crate) fn rows(&self) -> &[f64] {
        &self.rows
    }

    /// Smallest and largest value, each with its time, of a measure that a statistic asks for; `None` where it has no value
    /// somewhere on the motion.
    pub(crate) fn extremes(&self, measure: &Measure) -> Option<(At, At)> {
        let known = self.known.iter().find(|known| known.measure == *measure);
        known.and_then(|known| known.found)
    }

    /// When a measure is smallest, and largest, as its time ratio counts, where a statistic asks for that.
    pub(crate) fn strokes(&self, measure: &Measure) -> Option<[f64; 2]> {
        let known = self.known.iter().find(|known| known.measure == *measure);
        known.and_then(|known| known.strokes)
    }

    /// Times at which a measure that a statistic asks for is smallest, and largest, but for rounding.
    pub(crate) fn rivals(&self, measure: &Measure) -> [Vec<f64>; 2] {
        let known = self.known.iter().find(|known| known.measure == *measure);
        known.map_or_else(Default::default, |known| known.rivals.clone())
    }

    /// A number over the motion; NaN where it has no value, or is not known.
    pub(crate) fn over_motion(&self, statistic: Statistic, measure: &Measure) -> f64 {
        let known = self.measurer.statistics.iter();
        let mut known = known.filter(|(s, m, _)| *s == statistic && m == measure);
        known.next().map_or(f64::NAN, |(.., value)| *value)
    }

    /// What is to be told of the numbers over the motion that a measure contains.
    pub fn notes_of(&self, measure: &Measure) -> Vec<StatisticNote> {
        let mut notes = Vec::new();
        visit_leaves(self.motion().mechanism(), measure, &mut |leaf| {
            if let Leaf::Over(statistic, inner) = leaf {
                let own = self.notes.iter();
                let own = own.filter(|(s, m, _)| s == statistic && *m == **inner);
                notes.extend(own.map(|(.., note)| *note));
            }
        });
        notes
    }

    /// Values of the parameters, SI, in the model's order.
    pub fn parameters(&self) -> &[f64] {
        &self.motion().design.parameters
    }

    /// The motion.
    pub fn motion(&self) -> &Arc<Motion> {
        self.measurer.states.motion()
    }

    /// Where the motion is at a time.
    pub(crate) fn clock(&self) -> &Clock {
        self.measurer.states.clock()
    }

    /// When the motion passes a path parameter first, s; NaN where it does not.
    pub fn time_at(&self, p: f64) -> f64 {
        self.clock().time_at(p)
    }

    /// The row at a path parameter: the first time the motion passes it.
    pub fn at_parameter(&mut self, p: f64) -> Sample {
        self.row(p, self.clock().time_at(p))
    }

    /// The row at a time, s.
    pub fn at_time(&mut self, t: f64) -> Sample {
        self.row(self.clock().parameter_at(t), t)
    }

    /// The row at a path parameter, without time: measures of speed are NaN.
    pub fn without_time(&mut self, p: f64) -> Sample {
        self.row(p, f64::NAN)
    }

    /// The measures (SI) of the row at a path parameter alone, without its poses and evidence; NaN where it is not reached.
    pub fn values_at_parameter(&mut self, p: f64) -> Vec<f64> {
        self.values(p, self.clock().time_at(p))
    }

    /// The measures (SI) of the row at a time, s, alone, without its poses and evidence; NaN where it is not reached.
    pub fn values_at_time(&mut self, t: f64) -> Vec<f64> {
        self.values(self.clock().parameter_at(t), t)
    }

    fn values(&mut self, p: f64, time: f64) -> Vec<f64> {
        let place = PathPlace { time, path: p };
        let mut values = vec![f64::NAN; self.measures.len()];
        if self.measurer.find(place) {
            self.measure(place, &mut values);
        }
        values
    }

    /// Measures the state last found, at this place. Returns the points that stand still of those whose curvature is asked
    /// for.
    fn measure(&mut self, place: PathPlace<f64>, values: &mut [f64]) -> Vec<PointId> {
        let measures = std::mem::take(&mut self.measures);
        let curved = std::mem::take(&mut self.curved);
        let lengths: Vec<PointId> = self.lengths.iter().map(Swept::point).collect();
        let mut still = Vec::new();
        self.with_moment(place, true, &lengths, |moment| {
            still.extend(curved.iter().filter(|p| moment.stands_still(**p)));
            for (value, measure) in values.iter_mut().zip(&measures) {
                *value = moment.value(measure);
            }
        });
        (self.measures, self.curved) = (measures, curved);
        still
    }

    fn row(&mut self, p: f64, time: f64) -> Sample {
        let motion = &*self.motion().clone();
        let model = &motion.mechanism().model;
        let mut sample = Sample {
            parameter: p,
            time,
            coordinates: vec![f64::NAN; model.drives.len()],
            values: vec![f64::NAN; self.measures.len()],
            links: vec![[f64::NAN; 3]; model.links.len()],
            points: vec![[f64::NAN; 2]; model.points.len()],
            rates: vec![PointRates::NONE; model.points.len()],
            closure: f64::NAN,
            smallest_singular_value: f64::NAN,
            note: None,
        };
        motion.path.coordinates(p, &mut sample.coordinates);
        if !motion.reaches(p) {
            sample.note = Some(self.why_unreached(p));
            return sample;
        }
        let place = PathPlace { time, path: p };
        if !self.measurer.find(place) {
            sample.note = Some(RowNote::NoPose);
            return sample;
        }
        let still = self.measure(place, &mut sample.values);
        rates::fill(self.measurer.state(), &mut sample.rates);

        let found = self.measurer.state();
        for (pose, series) in self.plain.state.poses.iter_mut().zip(&found.poses) {
            *pose = series.value();
        }
        self.plain.branch.near.clone_from(&found.near);
        motion.path.coordinates(p, &mut self.plain.coordinates);
        self.plain
            .state
            .set_inputs(motion.mechanism(), &self.plain.coordinates);
        let (branch, state) = (&self.plain.branch, &self.plain.state);
        let found = evidence(
            &motion.design,
            branch,
            state,
            motion.size(),
            &mut self.system,
        );
        sample.closure = found.closure;
        sample.smallest_singular_value = found.smallest_singular_value;
        let plain = &self.plain;
        sample.place(
            motion.mechanism(),
            &motion.design.geometry,
            &plain.state.poses,
            &plain.branch.near,
        );
        sample.note = self.note(p, &sample, still);
        sample
    }
}

impl Sample {
    /// Puts links and points where a state has them, moving as they do in it; nothing else of the row changes.
    pub fn put(&mut self, state: &State<f64>) {
        let poses: Vec<Pose<f64>> = state.poses.iter().map(Pose::value).collect();
        let geometry = state.design.geometry.value();
        self.place(state.mechanism(), &geometry, &poses, &state.near);
        rates::fill(state, &mut self.rates);
    }

    /// Fills in where links and points are.
    fn place(
        &mut self,
        mechanism: &Mechanism,
        geometry: &Geometry<f64>,
        poses: &[Pose<f64>],
        near: &[f64],
    ) {
        for (index, place) in self.links.iter_mut().enumerate() {
            let body = mechanism.seats[index].body.index();
            let (pose, seat) = (&poses[body], &geometry.seats[index]);
            let [x, y] = pose.place([seat.x, seat.y]);
            let angle = pose.angle_near(near[body]) + geometry.seat_angles[index];
            *place = [x, y, angle];
        }
        for (index, place) in self.points.iter_mut().enumerate() {
            if let Some(marker) = mechanism.any_marker(PointId(index as u32)) {
                *place = poses[marker.body.index()].place(geometry.marker(marker));
            }
        }
    }
}
