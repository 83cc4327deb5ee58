//! What tolerances do where everything is linear.

use super::spread::Deviation;

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
    /// By parameter: its part of the variance.
    pub parts: Vec<f64>,
}

impl Linear {
    /// By a number's derivatives; parameters differ independently.
    pub fn new(own: f64, slope: Vec<f64>, deviations: &[Deviation]) -> Self {
        let pairs = || slope.iter().zip(deviations);
        let mean = pairs().fold(own, |sum, (slope, d)| sum + slope * d.mean());
        let alone: Vec<f64> = pairs().map(|(slope, d)| slope * d.deviation()).collect();
        let variance: f64 = alone.iter().map(|x| x * x).sum();
        let worst = pairs().fold([own; 2], |[low, high], (slope, d)| {
            let ends = d.ends.map(|end| slope * end);
            [low + ends[0].min(ends[1]), high + ends[0].max(ends[1])]
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

    /// Parameters by their part, the largest first.
    pub fn ranked(&self) -> Vec<usize> {
        let mut all: Vec<usize> = (0..self.parts.len()).collect();
        all.sort_by(|a, b| self.parts[*b].total_cmp(&self.parts[*a]));
        all
    }
}
