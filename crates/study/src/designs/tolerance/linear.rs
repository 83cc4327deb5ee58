//! What tolerances do where everything is linear.

use super::source::Source;

/// The linear answer for a number, SI.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Linear {
    /// The number of the file's own design.
    pub own: f64,
    /// Its mean over all pieces.
    pub mean: f64,
    /// Its standard deviation.
    pub deviation: f64,
    /// Its least and its greatest value if all parameters differ for the worst.
    pub worst: [f64; 2],
    /// By parameter: the derivative.
    pub slope: Vec<f64>,
    /// By source: its part of the variance.
    pub parts: Vec<f64>,
}

impl Linear {
    /// By a number's derivatives; sources differ independently.
    pub fn new(own: f64, slope: Vec<f64>, sources: &[Source]) -> Self {
        let mean = sources.iter().fold(own, |sum, it| sum + it.mean(&slope));
        let alone: Vec<f64> = sources.iter().map(|it| it.deviation(&slope)).collect();
        let variance: f64 = alone.iter().map(|x| x * x).sum();
        let worst = sources.iter().fold([own; 2], |[low, high], it| {
            let ends = it.worst(&slope);
            [low + ends[0], high + ends[1]]
        });
        let part = |x: &f64| match variance > 0.0 {
            true => x * x / variance,
            false => 0.0,
        };
        Self {
            own,
            mean,
            deviation: variance.sqrt(),
            worst,
            parts: alone.iter().map(part).collect(),
            slope,
        }
    }

    /// Whether there is one: at change points and limits there is not.
    pub fn is_known(&self) -> bool {
        self.deviation.is_finite() && self.own.is_finite()
    }

    /// Sources by their part, the largest first.
    pub fn ranked(&self) -> Vec<usize> {
        let mut all: Vec<usize> = (0..self.parts.len()).collect();
        all.sort_by(|a, b| self.parts[*b].total_cmp(&self.parts[*a]));
        all
    }
}
