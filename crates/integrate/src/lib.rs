//! Ordinary differential equations `y' = f(t, y)` on plain numbers, as mechanisms in time ask for them.
//!
//! | file | for |
//! | --- | --- |
//! | `dop853.rs` | explicit steps of order 8 that keep their error below a tolerance, and the solution between their ends |
//! | `radau5.rs` | implicit steps of order 5 for stiff systems, in the same way |
//! | `integrator.rs` | the door: one of both, or whichever suits, chosen as it goes |
//! | `track.rs`, `tolerance.rs` | what the methods share: the solution so far, lengths of steps, the size of an error |
//! | `crossing.rs` | where something becomes zero within a step |
//! | `dip.rs` | where something is below zero within a step at whose ends it is not |

mod crossing;
mod dip;
mod dop853;
mod integrator;
mod radau5;
mod tolerance;
mod track;

pub use crossing::crossing;
pub use dip::dip;
pub use integrator::{Integrator, Method, Used};
pub use tolerance::Tolerance;
pub use track::Stopped;

/// Something whose state changes with time.
pub trait System {
    /// The rates of a state, into `rates`. `false` where there are none, beyond the reach of a mechanism say: then a
    /// shorter step is tried.
    fn rates(&mut self, time: f64, state: &[f64], rates: &mut [f64]) -> bool;

    /// How the rates change with the state, into `jacobian`: row by row, that of a rate over all components. `false` where
    /// nobody knows, as here: then it is found from differences of the rates, one more call for every component.
    fn jacobian(&mut self, time: f64, state: &[f64], jacobian: &mut [f64]) -> bool {
        let _ = (time, state, jacobian);
        false
    }
}

impl<F: FnMut(f64, &[f64], &mut [f64]) -> bool> System for F {
    fn rates(&mut self, time: f64, state: &[f64], rates: &mut [f64]) -> bool {
        self(time, state, rates)
    }
}
