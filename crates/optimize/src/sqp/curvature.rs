//! The curvature of the Lagrangian, learnt from its slopes: the formula of C. G. Broyden, R. Fletcher, D. Goldfarb and D. F. Shanno
//! (1970), damped by M. J. D. Powell (1978) so that it stays positive.

use crate::problem::largest;
use crate::quadratic::Minimum;
use crate::space::Space;

use super::local::Local;
use super::vector::{diagonal, dot};

/// A first step goes over this part of the box at most.
const FIRST: f64 = 0.25;
/// The curvature along a step is at least this part of what it was.
const DAMPED: f64 = 0.2;
/// The first curvature that is learnt stays within these, in scales of the problem.
const LEARNT: [f64; 2] = [1e-6, 1e6];
/// A slope is at least this for [`FIRST`].
const LEAST_SLOPE: f64 = 1e-3;

/// A positive matrix.
#[derive(Clone, Debug)]
pub(super) struct Curvature {
    n: usize,
    matrix: Vec<f64>,
    fresh: bool,
}

impl Curvature {
    /// Before anything is known of it.
    pub fn first(place: &Local) -> Self {
        let n = place.design.len();
        let top = place
            .parts
            .iter()
            .max_by(|a, b| a.value.total_cmp(&b.value));
        let slope = top.map_or(1.0, |p| {
            let mut slope = p.slope.clone();
            along_edge(place, &mut slope);
            largest(slope.iter().map(|x| x.abs()))
        });
        Self {
            n,
            matrix: diagonal(n, slope.max(LEAST_SLOPE) / FIRST),
            fresh: true,
        }
    }

    /// The unit matrix.
    pub fn unit(n: usize) -> Self {
        Self {
            n,
            matrix: diagonal(n, 1.0),
            fresh: true,
        }
    }

    /// The same of an objective that counts so many times as much.
    pub fn grow(&mut self, factor: f64) {
        self.matrix.iter_mut().for_each(|x| *x *= factor);
    }

    /// Whether nothing is known of it.
    pub fn is_fresh(&self) -> bool {
        self.fresh
    }

    /// The matrix by rows.
    pub fn matrix(&self) -> &[f64] {
        &self.matrix
    }

    /// Times a vector.
    pub fn times(&self, x: &[f64]) -> Vec<f64> {
        self.matrix
            .chunks_exact(self.n.max(1))
            .map(|row| dot(row, x))
            .collect()
    }

    /// Learns from a step: how the slope of the Lagrangian changed, with the multipliers of the step.
    pub fn update(&mut self, from: &Local, to: &Local, minimum: &Minimum, space: &Space) {
        let (there, here) = (space.unit(&to.design), space.unit(&from.design));
        let step: Vec<f64> = there.iter().zip(&here).map(|(a, b)| a - b).collect();
        let mut change = vec![0.0; self.n];
        for (part, multiplier) in from.parts.iter().zip(&minimum.multipliers) {
            if *multiplier > 0.0
                && let Some(k) = part.among(&to.parts, &step)
            {
                let slopes = to.parts[k].slope.iter().zip(&part.slope);
                for (y, (after, before)) in change.iter_mut().zip(slopes) {
                    *y += multiplier * (after - before);
                }
            }
        }
        if from.edge.is_some() {
            along_edge(to, &mut change);
        }
        let along = dot(&step, &change);
        if self.fresh && along > 0.0 {
            // D. F. Shanno and K.-H. Phua (1978): the size of the first curvature from the first step.
            let size = dot(&change, &change) / along;
            self.matrix = diagonal(self.n, size.clamp(LEARNT[0], LEARNT[1]));
        }
        let bent = self.times(&step);
        let was = dot(&step, &bent);
        if !(was > 0.0) || !along.is_finite() {
            return;
        }
        self.fresh = false;
        if along < DAMPED * was {
            let part = (1.0 - DAMPED) * was / (was - along);
            for (y, b) in change.iter_mut().zip(&bent) {
                *y = part * *y + (1.0 - part) * b;
            }
        }
        let along = dot(&step, &change);
        for i in 0..self.n {
            for j in 0..self.n {
                self.matrix[i * self.n + j] +=
                    change[i] * change[j] / along - bent[i] * bent[j] / was;
            }
        }
    }
}

/// What is left of a slope along the edge that a place is at: towards it, goals may be steep without bound.
fn along_edge(place: &Local, slope: &mut [f64]) {
    if let Some(edge) = &place.edge {
        let out = dot(slope, &edge.normal);
        (slope.iter_mut().zip(&edge.normal)).for_each(|(x, n)| *x -= out * n);
    }
}
