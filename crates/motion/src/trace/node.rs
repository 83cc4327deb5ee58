//! A point of the motion, with the direction in which it goes on, and lengths of what is between two.

/// A point of the motion: scaled unknowns (x and y over the mechanism's size, angle, for every body; last the path
/// parameter over its scale) and the unit tangent.
#[derive(Clone, Debug)]
pub struct Node {
    /// Unknowns.
    pub z: Vec<f64>,
    /// Unit tangent, in the direction of travel.
    pub tangent: Vec<f64>,
    /// Determinant of every step of the plan, where they are known.
    pub(crate) determinants: Vec<f64>,
}

impl Node {
    /// A node.
    pub(crate) fn new(z: Vec<f64>, tangent: Vec<f64>) -> Self {
        Self {
            z,
            tangent,
            determinants: Vec::new(),
        }
    }

    /// Rate of the path parameter along the arc; zero at a limit.
    pub fn parameter_rate(&self) -> f64 {
        self.tangent[self.tangent.len() - 1]
    }

    /// The same point, travelled the other way.
    pub(crate) fn turned(mut self) -> Self {
        self.tangent.iter_mut().for_each(|t| *t = -*t);
        self
    }

    /// Scaled unknowns along the tangent, where the path parameter over its scale is this.
    pub(crate) fn toward(&self, parameter: f64) -> impl Iterator<Item = f64> {
        let h = (parameter - self.z[self.z.len() - 1]) / self.parameter_rate();
        self.z
            .iter()
            .zip(&self.tangent)
            .map(move |(z, t)| z + h * t)
    }

    /// Scaled unknowns at a length `h` along the tangent.
    pub(super) fn ahead(&self, h: f64) -> Vec<f64> {
        let unknowns = self.z.iter().zip(&self.tangent);
        unknowns.map(|(z, t)| z + h * t).collect()
    }
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

pub(super) fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}
