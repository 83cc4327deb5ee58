//! Between two nodes of a trace: the cubic with their tangents.

use super::{Node, norm};

/// The cubic through two nodes with their tangents.
pub struct Cubic<'a> {
    from: &'a Node,
    to: &'a Node,
    /// Length of the chord.
    h: f64,
}

/// A place on a cubic.
pub struct Place<'a> {
    cubic: &'a Cubic<'a>,
    weights: [f64; 4],
}

impl<'a> Cubic<'a> {
    /// The cubic from one node to another.
    pub fn new(from: &'a Node, to: &'a Node) -> Self {
        Self {
            from,
            to,
            h: distance(&from.z, &to.z),
        }
    }

    /// The place at a part `s` of the step.
    pub fn at(&self, s: f64) -> Place<'_> {
        Place {
            cubic: self,
            weights: [
                (1.0 + 2.0 * s) * (1.0 - s) * (1.0 - s),
                s * s * (3.0 - 2.0 * s),
                s * (1.0 - s) * (1.0 - s) * self.h,
                s * s * (s - 1.0) * self.h,
            ],
        }
    }
}

impl Place<'_> {
    /// The `i`-th unknown there.
    pub fn part(&self, i: usize) -> f64 {
        let ([a, b, c, d], Cubic { from, to, .. }) = (self.weights, self.cubic);
        a * from.z[i] + b * to.z[i] + c * from.tangent[i] + d * to.tangent[i]
    }
}

/// The cubic through two nodes with their tangents, at a part `s` of the step.
pub fn hermite(from: &Node, to: &Node, s: f64) -> Vec<f64> {
    let cubic = Cubic::new(from, to);
    let place = cubic.at(s);
    (0..from.z.len()).map(|i| place.part(i)).collect()
}

/// Unit vector from one node to the next.
pub fn chord(from: &Node, to: &Node) -> Vec<f64> {
    let mut v: Vec<f64> = from.z.iter().zip(&to.z).map(|(a, b)| b - a).collect();
    let length = norm(&v);
    v.iter_mut().for_each(|x| *x /= length);
    v
}

/// Distance of two lists of scaled unknowns.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (b - a) * (b - a));
    squares.sum::<f64>().sqrt()
}

/// Which two of the rising `places` enclose `p`: the index of the first; beyond the ends the first or last two.
pub fn interval(places: &[f64], p: f64) -> usize {
    places
        .partition_point(|&place| place <= p)
        .clamp(1, places.len().max(2) - 1)
        - 1
}
