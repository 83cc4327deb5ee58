//! What differs from piece to piece: parameters, and the sides to which joints with play are pressed.

use kempe_model::{Scalar, value};
use kempe_number::math;

use super::spread::Deviation;

/// One of the things that differ, each by one number between 0 and 1.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Source {
    /// The first of the bench's varied parameters that it changes; a pin changes the next one, too.
    pub first: usize,
    pub kind: Kind,
}

/// How it differs.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Kind {
    /// As a parameter does.
    Parameter(Deviation),
    /// A pin with play: it stands off by all of it, in any direction. With the play of the file's own design, m.
    Round { radial: Scalar, own: f64 },
    /// A slider or a pin in a slot: it stands off its line by all of its play, to either side.
    Across { radial: Scalar, own: f64 },
}

impl Source {
    /// What of a number's derivatives belongs to it, as one: for a pin in the direction that changes the number most.
    pub fn slope(&self, slopes: &[f64]) -> f64 {
        let at = |k: usize| slopes.get(k).copied().unwrap_or(f64::NAN);
        match self.kind {
            Kind::Round { .. } => math::hypot(at(self.first), at(self.first + 1)),
            _ => at(self.first),
        }
    }

    /// The mean of what it adds to a number with these derivatives.
    pub fn mean(&self, slopes: &[f64]) -> f64 {
        match &self.kind {
            Kind::Parameter(deviation) => self.slope(slopes) * deviation.mean(),
            _ => 0.0,
        }
    }

    /// Its standard deviation. Of a direction that is as likely as any other, the half of its square lies along the derivative.
    pub fn deviation(&self, slopes: &[f64]) -> f64 {
        let slope = self.slope(slopes).abs();
        match &self.kind {
            Kind::Parameter(deviation) => slope * deviation.deviation(),
            Kind::Round { own, .. } => slope * own * 0.5_f64.sqrt(),
            Kind::Across { own, .. } => slope * own,
        }
    }

    /// The least and the greatest that it adds.
    pub fn worst(&self, slopes: &[f64]) -> [f64; 2] {
        let slope = self.slope(slopes);
        let ends = match &self.kind {
            Kind::Parameter(deviation) => deviation.ends.map(|end| slope * end),
            Kind::Round { own, .. } | Kind::Across { own, .. } => [-slope * own, slope * own],
        };
        [ends[0].min(ends[1]), ends[0].max(ends[1])]
    }

    /// The play of a piece with these parameters, m; none of a parameter.
    fn play(&self, parameters: &[f64]) -> Option<f64> {
        match &self.kind {
            Kind::Parameter(_) => None,
            Kind::Round { radial, .. } | Kind::Across { radial, .. } => {
                Some(value(radial, parameters))
            }
        }
    }

    /// Puts a piece's values where this source has them, for the number between 0 and 1 that was drawn of it. `parameters` are those of the
    /// piece; sources behind the file's own parameters need them.
    pub fn put(&self, part: f64, parameters: &[f64], values: &mut [f64]) {
        let play = self.play(parameters).unwrap_or(0.0);
        let mut add = |k: usize, x: f64| {
            if let Some(value) = values.get_mut(self.first + k) {
                *value += x;
            }
        };
        match &self.kind {
            Kind::Parameter(deviation) => add(0, deviation.at(part)),
            Kind::Round { .. } => {
                let (sin, cos) = math::sin_cos(std::f64::consts::TAU * part);
                add(0, play * cos);
                add(1, play * sin);
            }
            Kind::Across { .. } => add(0, if part < 0.5 { -play } else { play }),
        }
    }
}
