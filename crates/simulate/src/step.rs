//! A step that was made, to be looked into.

use kempe_integrate::Integrator;

use crate::plant::Plant;

/// A step that was made, however it was.
pub(crate) trait Step {
    /// When it began, s.
    fn before(&self) -> f64;
    /// When it ended, s.
    fn time(&self) -> f64;
    /// The state there.
    fn state(&self) -> &[f64];
    /// The rates there.
    fn rates(&self) -> &[f64];
    /// The state at a time within it. `false` where it is not known.
    fn between(&mut self, plant: &mut Plant, time: f64, state: &mut [f64]) -> bool;
    /// The rates at a time within it, as the step itself has them. `false` where those of the states serve better.
    fn slopes(&self, time: f64, rates: &mut [f64]) -> bool;
}

impl Step for Integrator {
    fn before(&self) -> f64 {
        self.before()
    }

    fn time(&self) -> f64 {
        self.time()
    }

    fn state(&self) -> &[f64] {
        self.state()
    }

    fn rates(&self) -> &[f64] {
        self.rates()
    }

    fn between(&mut self, plant: &mut Plant, time: f64, state: &mut [f64]) -> bool {
        self.between(plant, time, state)
    }

    fn slopes(&self, time: f64, rates: &mut [f64]) -> bool {
        self.slopes(time, rates)
    }
}
