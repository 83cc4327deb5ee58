//! Springs: linear ones between points, torsion springs between links, with preload, stops and one-sided ones.

use kempe_mechanism::{Geometry, Mechanism};
use kempe_model::{self as model, Acts};
use kempe_number::Number;

use crate::ends::Ends;
use crate::instant::Instant;
use crate::number::{ForceNumber, PlainNumber};
use crate::problem::Problem;
use crate::wrench::Wrench;

/// A spring's law: tension over length, all in SI.
///
/// `F = preload + stiffness (L - free)`, cut to zero where it acts one way only, and beyond a stop at `L0`
/// `stop_stiffness (L - L0)` more.
#[derive(Clone, Debug)]
pub struct SpringLaw<T> {
    /// Stiffness, N/m or N m/rad.
    pub stiffness: T,
    /// Length or angle at which the tension is the preload.
    pub free: T,
    /// Tension at the free length, N or N m.
    pub preload: T,
    /// Lengths below and above which a stop acts.
    pub stops: [Option<T>; 2],
    /// Stiffness of the stops.
    pub stop_stiffness: T,
    /// In which sense it acts.
    pub acts: Acts,
}

impl<T: Number> SpringLaw<T> {
    /// Evaluates a spring's dimensions.
    pub fn new(spring: &model::Spring, parameters: &[T]) -> Self {
        let of = |scalar: &model::Scalar| model::value(scalar, parameters);
        Self {
            stiffness: of(&spring.stiffness),
            free: of(&spring.free),
            preload: of(&spring.preload),
            stops: [
                spring.stops[0].as_ref().map(of),
                spring.stops[1].as_ref().map(of),
            ],
            stop_stiffness: spring.stop_stiffness.as_ref().map_or(T::zero(), of),
            acts: spring.acts,
        }
    }

    /// `taut` where the spring bears this tension, zero where it goes slack.
    fn unless_slack(&self, tension: T, taut: impl FnOnce() -> T) -> T {
        match self.acts {
            Acts::Both => taut(),
            Acts::Tension => tension.choose_with(taut, T::zero),
            Acts::Compression => (-tension).choose_with(taut, T::zero),
        }
    }

    /// How far a length is beyond a stop; negative below the lower one, zero between them.
    fn beyond(&self, length: T) -> T {
        let above = || {
            self.stops[1].map_or(T::zero(), |high| {
                (high - length).choose_with(T::zero, || length - high)
            })
        };
        match self.stops[0] {
            Some(low) => (length - low).choose_with(above, || length - low),
            None => above(),
        }
    }

    /// Tension at a length, N or N m.
    pub fn tension(&self, length: T) -> T {
        let own = self.preload + self.stiffness * (length - self.free);
        let own = self.unless_slack(own, || own);
        own + self.stop_stiffness * self.beyond(length)
    }

    /// Stored energy at a length, J: the integral of the tension from the free length, or from where it goes slack.
    pub fn energy(&self, length: T) -> T {
        let x = length - self.free;
        let own = match self.acts {
            Acts::Both => self.preload * x + self.stiffness * x.square() / 2.0,
            _ => {
                let tension = self.preload + self.stiffness * x;
                self.unless_slack(tension, || {
                    (-self.stiffness.abs()).choose_with(
                        || self.preload * x,
                        || tension.square() / self.stiffness / 2.0,
                    )
                })
            }
        };
        own + self.stop_stiffness * self.beyond(length).square() / 2.0
    }

    /// Tension over length, regular at no length for a spring whose tension is proportional to its length.
    fn pull(&self, length: T) -> T {
        let rest = self.preload - self.stiffness * self.free;
        if self.acts == Acts::Both && self.stops.iter().all(Option::is_none) {
            return (-length).choose_with(|| self.stiffness, || self.stiffness + rest / length);
        }
        (-length).choose_with(T::zero, || self.tension(length) / length)
    }
}

/// A spring in a mechanism.
#[derive(Clone, Debug)]
pub struct Spring<T: ForceNumber> {
    /// Its ends.
    pub ends: Ends,
    /// Its law.
    pub law: SpringLaw<T>,
    /// Added to the angle of its links, rad: whole turns (see [`Spring::align`]).
    pub turns: T::Plain,
}

impl<T: ForceNumber> Spring<T> {
    /// Compiles the model's springs.
    pub(crate) fn all(
        mechanism: &Mechanism,
        geometry: &Geometry<T>,
        parameters: &[T],
        problems: &mut Vec<Problem>,
    ) -> Vec<Self> {
        let mut list = Vec::new();
        for spring in &mechanism.model.actions.springs {
            let name = &spring.name;
            let named = (
                ["spring-ends", "spring-idle"],
                format!("the spring `{name}`"),
                &spring.span,
            );
            let Some(ends) = Ends::checked(mechanism, geometry, &spring.between, named, problems)
            else {
                continue;
            };
            let law = SpringLaw::new(spring, parameters);
            if law.stiffness.any_lane(|x| x < 0.0) || law.stop_stiffness.any_lane(|x| x < 0.0) {
                problems.push(Problem::new(
                    "negative-stiffness",
                    &spring.span,
                    format!("the stiffness of the spring `{name}` is negative"),
                ));
            }
            if let [Some(low), Some(high)] = &law.stops
                && (0..T::Plain::LANES).any(|lane| low.value_in(lane) > high.value_in(lane))
            {
                problems.push(Problem::new(
                    "stops-crossed",
                    &spring.span,
                    format!("the lower stop of the spring `{name}` lies above the upper one"),
                ));
            }
            list.push(Self {
                ends,
                law,
                turns: T::Plain::zero(),
            });
        }
        list
    }

    /// Counts the turns of a torsion spring so that its angle is within half a turn of its free angle where the bodies
    /// have these angles: at the start of a motion. Otherwise its torque would depend on how the frame is laid.
    pub fn align(&mut self, geometry: &Geometry<T>, angles: &[f64]) {
        if let Ends::Links([(link_a, a), (link_b, b)]) = self.ends {
            let of = |link: kempe_model::LinkId, body: kempe_mechanism::BodyId| {
                geometry.seat_angles[link.index()].plain() + angles[body.index()]
            };
            let apart = self.law.free.plain() - (of(link_b, b) - of(link_a, a));
            self.turns = (apart / std::f64::consts::TAU).rising(f64::round) * std::f64::consts::TAU;
        }
    }

    /// Its length (m) or angle (rad) at an instant.
    pub fn length(&self, geometry: &Geometry<T>, at: &Instant<T>) -> T {
        self.ends.stretch(geometry, at).length.plus(0, self.turns)
    }

    /// Its tension at an instant, N or N m.
    pub fn tension(&self, geometry: &Geometry<T>, at: &Instant<T>) -> T {
        self.law.tension(self.length(geometry, at))
    }

    /// Its stored energy at an instant, J.
    pub fn energy(&self, geometry: &Geometry<T>, at: &Instant<T>) -> T {
        self.law.energy(self.length(geometry, at))
    }

    /// Adds what it does to the links.
    pub(crate) fn act(&self, geometry: &Geometry<T>, at: &Instant<T>, on_links: &mut [Wrench<T>]) {
        let stretch = self.ends.stretch(geometry, at);
        let pull = match self.ends {
            Ends::Points(_) => self.law.pull(stretch.length),
            Ends::Links(_) => self.law.tension(stretch.length.plus(0, self.turns)),
        };
        self.ends.pull(geometry, at, &stretch, pull, on_links);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law(acts: Acts) -> SpringLaw<f64> {
        SpringLaw {
            stiffness: 100.0,
            free: 0.5,
            preload: 10.0,
            stops: [Some(0.2), Some(0.9)],
            stop_stiffness: 1e4,
            acts,
        }
    }

    #[test]
    fn energy_is_the_integral_of_tension() {
        for acts in [Acts::Both, Acts::Tension, Acts::Compression] {
            let law = law(acts);
            for k in 0..100 {
                let x = 0.005 + 0.01 * f64::from(k);
                let h = 1e-6;
                let slope = (law.energy(x + h) - law.energy(x - h)) / (2.0 * h);
                assert!((slope - law.tension(x)).abs() < 1e-4, "{acts:?} {x}");
            }
        }
    }

    #[test]
    fn a_rope_does_not_push() {
        assert_eq!(law(Acts::Tension).tension(0.3), 0.0);
        assert_eq!(law(Acts::Tension).tension(0.5), 10.0);
        assert_eq!(law(Acts::Compression).tension(0.6), 0.0);
        assert_eq!(law(Acts::Compression).tension(0.3), -10.0);
        assert!(law(Acts::Tension).tension(0.1) < -900.0);
    }
}
