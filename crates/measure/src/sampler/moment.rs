//! The moment last solved, as measures and forces see it.

use kempe_model::{Leaf, Measure, PointId};
use kempe_motion::trace::Path;
use kempe_number::Number;

use super::Sampler;
use crate::force_source::ForceSource;
use crate::measure::{Along, Moment, NamedSeries, Series, visit_leaves};

impl<F: ForceSource> Sampler<F> {
    /// Hands the moment last solved to `ask`, with its forces where they are wanted.
    pub(super) fn with_moment<R>(
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
            // What was evaluated before knew no forces.
            named: NamedSeries::default(),
            ..moment
        });
        self.forces = forces;
        result
    }

    /// The moment last solved, without forces.
    fn moment(&self, p: f64, time: f64) -> Moment<'_, f64> {
        let motion = &*self.motion;
        let clock = if time.is_finite() {
            let rich: Vec<Series<f64>> = self
                .parameters()
                .iter()
                .map(|x| Series::constant(*x))
                .collect();
            motion
                .path
                .parameter_at(&motion.mechanism().model, Series::variable(time), &rich)
        } else {
            Series::from_f64(f64::NAN)
        };
        Moment {
            mechanism: motion.mechanism(),
            design: &self.series_design,
            parameters: self.parameters(),
            time,
            path: &self.series.state.poses,
            clock,
            heading: self.heading(time, clock.coefficient(1)),
            unit: motion.path.scale(),
            drives: &self.drives,
            path_drive: self.path_drive(),
            coordinates: &self.series.coordinates,
            near: &self.series.branch.near,
            directions: self.directions_near(p),
            swept: self
                .swept
                .iter()
                .map(|s| (s.point(), s.at_time(motion, self.parameters(), time)))
                .collect(),
            forces: None,
            statistics: &self.statistics,
            named: NamedSeries::default(),
        }
    }

    /// Unwrapped directions near a path parameter.
    pub(crate) fn directions_near(&self, p: f64) -> Vec<((PointId, PointId), f64)> {
        let directions = self.directions.iter();
        directions
            .map(|d| (d.points(), d.near(&self.motion, p)))
            .collect()
    }

    /// Value and time derivative of a measure at a time; NaN where the motion does not reach.
    pub(crate) fn value_and_rate(&mut self, measure: &Measure, time: f64) -> [f64; 2] {
        let p = self.parameter_at(time);
        if !self.motion.reaches(p) || !self.solve(p) {
            return [f64::NAN; 2];
        }
        let mut asks_forces = false;
        visit_leaves(self.motion.mechanism(), measure, &mut |leaf| {
            asks_forces |= matches!(leaf, Leaf::Force(_));
        });
        let series = self.with_moment(p, time, asks_forces, |moment| {
            moment.series(measure, Along::Time)
        });
        [series.derivative(0), series.derivative(1)]
    }
}
