//! The edge of what can be evaluated, as where linkages cease to assemble: beyond it there are no values, so that no slope leads along it.
//!
//! `seek` finds where it is.

mod seek;

use super::vector::dot;

/// Steps keep so far inside of it.
const INSIDE: f64 = 1e-6;

/// The edge near a design, as a half space in parts of the box.
#[derive(Clone, Debug)]
pub(super) struct Edge {
    /// Leads out, of length one.
    pub normal: Vec<f64>,
    /// A place on it that can be evaluated.
    pub at: Vec<f64>,
}

impl Edge {
    /// How far a place is beyond where steps may go; less than zero inside.
    pub fn passed(&self, place: &[f64]) -> f64 {
        let away: Vec<f64> = place.iter().zip(&self.at).map(|(x, a)| x - a).collect();
        dot(&self.normal, &away) + INSIDE
    }
}
