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
    /// A pin with play: it stands off by all of it, in any direction.
    Round(Play),
    /// A slider or a pin in a slot: it stands off its line by all of its play, to either side.
    Across(Play),
}

/// The play of a joint, which may hang on parameters that differ themselves.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Play {
    /// As a formula of the parameters.
    radial: Scalar,
    /// That of the file's own design, m.
    pub own: f64,
    /// The root of its mean square, and the most that it comes to, m, by its linear changes.
    effective: f64,
    most: f64,
}

impl Play {
    /// One that is the same in all pieces.
    pub fn new(radial: Scalar, own: f64) -> Self {
        Self {
            radial,
            own,
            effective: own,
            most: own,
        }
    }

    /// The same where parameters of values `own` differ; `parameters` makes all parameters of values.
    pub fn among(
        self,
        own: &[f64],
        deviations: &[&Deviation],
        parameters: impl Fn(&[f64]) -> Vec<f64>,
    ) -> Self {
        let changed = |k: usize, by: f64| {
            let mut values = own.to_vec();
            values[k] += by;
            value::<f64>(&self.radial, &parameters(&values)) - self.own
        };
        let (mut mean, mut variance, mut most) = (self.own, 0.0, self.own);
        for (k, deviation) in deviations.iter().enumerate() {
            mean += changed(k, deviation.mean());
            let by =
                changed(k, deviation.mean() + deviation.deviation()) - changed(k, deviation.mean());
            variance += by * by;
            let ends = deviation.ends.map(|end| changed(k, end));
            most += ends[0].max(ends[1]).max(0.0);
        }
        Self {
            effective: match variance == 0.0 {
                true => mean,
                false => (mean * mean + variance).sqrt(),
            },
            most,
            ..self
        }
    }

    /// That of a piece with these parameters, m.
    pub fn at(&self, parameters: &[f64]) -> f64 {
        value(&self.radial, parameters)
    }

    /// Whether a parameter changes it, of the values `own` that differ by one of two ends.
    pub fn hangs_on(
        &self,
        k: usize,
        [low, high]: [f64; 2],
        own: &[f64],
        parameters: impl Fn(&[f64]) -> Vec<f64>,
    ) -> bool {
        [low, high].iter().any(|end| {
            let mut values = own.to_vec();
            values[k] = *end;
            value::<f64>(&self.radial, &parameters(&values)) != self.own
        })
    }
}

impl Source {
    /// How many of the bench's varied parameters it changes.
    pub fn width(&self) -> usize {
        match self.kind {
            Kind::Round(_) => 2,
            _ => 1,
        }
    }

    /// Between what a parameter differs, SI, where its own values are these; none of a joint.
    pub fn between(&self, own: &[f64]) -> Option<[f64; 2]> {
        match &self.kind {
            Kind::Parameter(deviation) => Some(deviation.ends.map(|end| own[self.first] + end)),
            _ => None,
        }
    }

    /// What of a number's derivatives belongs to it, as one: for a pin in the direction that changes the number most.
    pub fn slope(&self, slopes: &[f64]) -> f64 {
        let at = |k: usize| slopes.get(k).copied().unwrap_or(f64::NAN);
        match self.kind {
            Kind::Round(_) => math::hypot(at(self.first), at(self.first + 1)),
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
            Kind::Round(play) => slope * play.effective * 0.5_f64.sqrt(),
            Kind::Across(play) => slope * play.effective,
        }
    }

    /// The least and the greatest that it adds.
    pub fn worst(&self, slopes: &[f64]) -> [f64; 2] {
        let slope = self.slope(slopes);
        let ends = match &self.kind {
            Kind::Parameter(deviation) => deviation.ends.map(|end| slope * end),
            Kind::Round(play) | Kind::Across(play) => [-slope * play.most, slope * play.most],
        };
        [ends[0].min(ends[1]), ends[0].max(ends[1])]
    }

    /// The play of a joint; none of a parameter.
    pub fn play(&self) -> Option<&Play> {
        match &self.kind {
            Kind::Parameter(_) => None,
            Kind::Round(play) | Kind::Across(play) => Some(play),
        }
    }

    /// Puts a piece's values where this source has them, for the number between 0 and 1 that was drawn of it. `parameters` are those of the
    /// piece; sources behind the file's own parameters need them.
    pub fn put(&self, part: f64, parameters: &[f64], values: &mut [f64]) {
        let play = self.play().map_or(0.0, |it| it.at(parameters));
        let mut add = |k: usize, x: f64| {
            if let Some(value) = values.get_mut(self.first + k) {
                *value += x;
            }
        };
        match &self.kind {
            Kind::Parameter(deviation) => add(0, deviation.at(part)),
            Kind::Round(_) => {
                let (sin, cos) = math::sin_cos(std::f64::consts::TAU * part);
                add(0, play * cos);
                add(1, play * sin);
            }
            Kind::Across(_) => add(0, if part < 0.5 { -play } else { play }),
        }
    }
}

/// How parameters differ, without joints.
pub(super) fn deviations(sources: &[Source]) -> impl Iterator<Item = &Deviation> {
    sources.iter().filter_map(|it| match &it.kind {
        Kind::Parameter(deviation) => Some(deviation),
        _ => None,
    })
}
