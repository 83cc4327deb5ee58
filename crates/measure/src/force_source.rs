//! The place where forces come in: measuring asks for them, the crate that knows the physics answers.

use std::sync::Arc;

use kempe_model::{ForceMeasure, Measure};
use kempe_motion::Motion;
use kempe_number::Number;

use crate::state::{Series, State};

/// A curve that is smooth between its knots only, over something that is measured.
#[derive(Clone, Debug)]
pub struct Curve {
    /// What it runs over.
    pub over: Measure,
    /// Its knots, SI, rising.
    pub at: Vec<f64>,
    /// After how much it repeats itself, if it does.
    pub period: Option<f64>,
}

/// Answers questions to the forces of states, on any number.
pub trait ForceSource<B = f64> {
    /// What the forces themselves ask of a state: loads that depend on it.
    fn measures(&self) -> &[Measure];

    /// The curves in what acts: forces are smooth between their knots only.
    fn curves(&self) -> Vec<Curve> {
        Vec::new()
    }

    /// The same for another motion of the mechanism, if it can be had: directions of forces count their turns as those of a motion do that
    /// theirs is [counted as](Motion::counts_as).
    fn of_motion(_: &Arc<Motion>) -> Option<Self>
    where
        Self: Sized,
    {
        None
    }

    /// Whether it needs the motion that every drive gives on its own: virtual power does.
    fn needs_drives(&self) -> bool {
        true
    }

    /// Finds the forces of a state that knows the poses along every drive. `amounts` are its own [measures] there, as series
    /// in time.
    ///
    /// [measures]: ForceSource::measures
    fn solve(&mut self, state: &State<B>, amounts: &[Series<B>]);

    /// Answers from the state last solved: a series in time. Coefficients that are not known are NaN.
    fn answer(&self, measure: &ForceMeasure) -> Series<B>;

    /// How fast what rubs dry slides in the state last solved, as series in time, in an order that stays: where one of these turns back,
    /// forces jump.
    fn sliding(&self) -> Vec<Series<B>> {
        Vec::new()
    }

    /// Takes what rubs dry to slide in these senses from now on, 1 or -1 in the order of [`sliding`](ForceSource::sliding), whatever its speed; where there
    /// is none its speed tells. Which side of a jump is meant can be told so right where it turns back.
    fn slide_as(&mut self, _: &[Option<f64>]) {}
}

/// No forces: questions to them have no value.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoForces;

impl<B: Number> ForceSource<B> for NoForces {
    fn measures(&self) -> &[Measure] {
        &[]
    }

    fn needs_drives(&self) -> bool {
        false
    }

    fn solve(&mut self, _: &State<B>, _: &[Series<B>]) {}

    fn answer(&self, _: &ForceMeasure) -> Series<B> {
        Series::from_f64(f64::NAN)
    }
}

/// Forces that may be lacking: then questions to them have no value.
impl<B: Number, F: ForceSource<B>> ForceSource<B> for Option<F> {
    fn measures(&self) -> &[Measure] {
        self.as_ref().map_or(&[], F::measures)
    }

    fn curves(&self) -> Vec<Curve> {
        self.as_ref().map_or_else(Vec::new, F::curves)
    }

    fn of_motion(motion: &Arc<Motion>) -> Option<Self> {
        F::of_motion(motion).map(Some)
    }

    fn needs_drives(&self) -> bool {
        self.as_ref().is_some_and(F::needs_drives)
    }

    fn solve(&mut self, state: &State<B>, amounts: &[Series<B>]) {
        if let Some(forces) = self {
            forces.solve(state, amounts);
        }
    }

    fn answer(&self, measure: &ForceMeasure) -> Series<B> {
        match self {
            Some(forces) => forces.answer(measure),
            None => NoForces.answer(measure),
        }
    }

    fn sliding(&self) -> Vec<Series<B>> {
        self.as_ref().map_or_else(Vec::new, F::sliding)
    }

    fn slide_as(&mut self, senses: &[Option<f64>]) {
        if let Some(forces) = self {
            forces.slide_as(senses);
        }
    }
}
