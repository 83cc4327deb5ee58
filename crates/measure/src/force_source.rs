//! The place where forces come in: kinematics asks for them, the crate that knows the physics answers.

use kempe_model::{ForceMeasure, Measure};

use crate::measure::{Moment, Series};

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

/// Answers questions to the forces along a motion, for a [`Sampler`](crate::Sampler).
pub trait ForceSource {
    /// What the forces themselves ask of the motion: loads that depend on it.
    fn measures(&self) -> &[Measure];

    /// The curves in what acts: forces are smooth between their knots only.
    fn curves(&self) -> Vec<Curve> {
        Vec::new()
    }

    /// Whether it needs the motion that every drive gives on its own: virtual power does.
    fn needs_drives(&self) -> bool {
        true
    }

    /// Finds the forces at a moment. The moment knows the poses along every drive; it knows no forces.
    fn solve(&mut self, moment: &Moment<'_, f64>);

    /// Answers from the moment last solved: a series in time. Coefficients that are not known are NaN.
    fn answer(&self, measure: &ForceMeasure) -> Series<f64>;
}

/// No forces: questions to them have no value.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoForces;

impl ForceSource for NoForces {
    fn measures(&self) -> &[Measure] {
        &[]
    }

    fn needs_drives(&self) -> bool {
        false
    }

    fn solve(&mut self, _: &Moment<'_, f64>) {}

    fn answer(&self, _: &ForceMeasure) -> Series<f64> {
        kempe_number::Number::from_f64(f64::NAN)
    }
}
