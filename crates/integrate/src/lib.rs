//! Ordinary differential equations `y' = f(t, y)` on plain numbers, as mechanisms in time ask for them.
//!
//! | file | for |
//! | --- | --- |
//! | `dop853.rs` | explicit steps of order 8 that keep their error below a tolerance, and the solution between their ends |
//! | `crossing.rs` | where something becomes zero within a step |

mod crossing;
mod dop853;

pub use crossing::crossing;
pub use dop853::{Dop853, Stopped, Tolerance};

/// Something whose state changes with time.
pub trait System {
    /// The rates of a state, into `rates`. `false` where there are none, beyond the reach of a mechanism say: then a
    /// shorter step is tried.
    fn rates(&mut self, time: f64, state: &[f64], rates: &mut [f64]) -> bool;
}

impl<F: FnMut(f64, &[f64], &mut [f64]) -> bool> System for F {
    fn rates(&mut self, time: f64, state: &[f64], rates: &mut [f64]) -> bool {
        self(time, state, rates)
    }
}
