//! The moment last solved, as measures and forces see it.

use kempe_model::{Leaf, Measure, PointId, PoseMeasure};
use kempe_motion::trace::Path;
use kempe_number::Number;

use super::Sampler;
use crate::force_source::ForceSource;
use crate::measure::{Along, Moment, NamedSeries, Series, visit_leaves};

impl<F: ForceSource> Sampler<F> {
    /// Hands the moment last solved to `ask`: with its forces where they are wanted, and with the lengths of the paths of
    /// some points.
    pub(super) fn with_moment<R>(
        &mut self,
        p: f64,
        time: f64,
        with_forces: bool,
        lengths: &[PointId],
        ask: impl FnOnce(&Moment<'_, f64>) -> R,
    ) -> R {
        let mut forces = self.forces.take();
        let swept = self.lengths(lengths, time);
        let moment = self.moment(p, time, swept);
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

    /// Lengths of the paths of some points at a time.
    fn lengths(&mut self, points: &[PointId], time: f64) -> Vec<(PointId, f64)> {
        let motion = self.motion.clone();
        let swept = self.swept.iter_mut();
        swept
            .filter(|s| points.contains(&s.point()))
            .map(|s| (s.point(), s.at_time(&motion, time)))
            .collect()
    }

    /// The moment last solved, without forces.
    fn moment(&self, p: f64, time: f64, swept: Vec<(PointId, f64)>) -> Moment<'_, f64> {
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
            swept,
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

    /// What measures ask of a moment.
    pub(crate) fn asked(&self, measures: &[&Measure]) -> Asked {
        let mut asked = Asked {
            measures: measures.iter().map(|m| (*m).clone()).collect(),
            forces: false,
            lengths: Vec::new(),
        };
        let mechanism = self.motion.mechanism();
        let look = |asked: &mut Asked, measure: &Measure| {
            visit_leaves(mechanism, measure, &mut |leaf| match leaf {
                Leaf::Force(_) => asked.forces = true,
                Leaf::Pose(PoseMeasure::PathLength(point)) if !asked.lengths.contains(point) => {
                    asked.lengths.push(*point);
                }
                _ => {}
            });
        };
        for measure in measures {
            look(&mut asked, measure);
        }
        if let Some(forces) = self.forces.as_ref().filter(|_| asked.forces) {
            forces.measures().iter().for_each(|m| look(&mut asked, m));
        }
        asked
    }

    /// What is asked for as series in time, at a time; NaN where the motion does not reach.
    pub(crate) fn series_at(&mut self, asked: &Asked, time: f64) -> Vec<Series<f64>> {
        let p = self.parameter_at(time);
        if !self.motion.reaches(p) || !self.solve(p) {
            return vec![Series::from_f64(f64::NAN); asked.measures.len()];
        }
        self.with_moment(p, time, asked.forces, &asked.lengths, |moment| {
            let measures = asked.measures.iter();
            measures.map(|m| moment.series(m, Along::Time)).collect()
        })
    }
}

/// Measures with what they ask of a moment beside its poses.
pub(crate) struct Asked {
    measures: Vec<Measure>,
    forces: bool,
    /// Points whose length of path is asked for.
    lengths: Vec<PointId>,
}

impl Asked {
    /// Whether any of them asks for forces.
    pub(crate) fn forces(&self) -> bool {
        self.forces
    }
}
