//! Exact derivatives of measures to the parameters of the design.
//!
//! The plan runs on `Jet<Dual<f64, K>, N>`: a Taylor series along the motion whose coefficients carry the derivatives to
//! `K` parameters (forward mode; A. Griewank and A. Walther, *Evaluating Derivatives*, 2nd ed. 2008, chapters 3 and 13).
//! Positions, rates and kinematic coefficients alike are then differentiated to rounding, Newton blocks by the implicit
//! function theorem (the iteration is repeated on dual numbers with the plain Jacobian).
//!
//! **What is held.** A parameter may change lengths, angles and the drives' laws. With [`Held::Path`] the path parameter
//! stays where it is: the coordinate of the only moving drive (the time at which it is passed then moves with the
//! laws, and rates are taken at the moved time), or the time when several drives move. With [`Held::Time`] time stays,
//! and coordinates follow the laws. In both, drives that stand still follow the laws' start values, the branch (assembly
//! modes) stays, and parameters built on the one that is varied follow it.
//!
//! **Over a motion.** `min` and `max` change as the measure does at the time of the extreme, held there, because its rate
//! vanishes (envelope theorem; at the ends of a law's piece the time moves with the law, and where it turns back at once, as by a
//! speed that vanishes, both sides say where they meet). `mean` is integrated on dual numbers, `time_ratio` takes the moving of
//! the extremes' times by the implicit function theorem.
//!
//! Where `abs`, `min` and `max` of several, a root or a speed stand right at their corner there is no derivative to what moves them away
//! from it (`corner`), nor where two equally large extremes of a motion change otherwise (`corner_over`). Forces jump where what rubs dry turns back: with a
//! turn right at an end of the motion means change by that, too (`turns`), and what leaps there has no derivative.
//!
//! At a change point a change of dimensions pulls the crossing branches apart: there, and at limits, nothing is
//! differentiable and the results are not finite.

mod corner;
mod corner_over;
mod held;
mod over;
mod turn;
mod turns;
mod varied;

use std::sync::Arc;

use kempe_model::{Measure, ParameterId};
use kempe_motion::motion::Motion;

pub use self::held::Held;
use self::varied::{Varied, varied_parameters};
use crate::base::CHUNK;
pub use crate::base::Varying;
use crate::force_source::{ForceSource, NoForces};
use crate::prepare::Unmeasurable;
use crate::sampler::Sampler;
use crate::statistic_note::StatisticNote;

/// Of a measure that is not asked.
const NO_ANSWER: (Varying, [bool; CHUNK]) = (
    Varying {
        re: f64::NAN,
        eps: [f64::NAN; CHUNK],
    },
    [false; CHUNK],
);

/// Values of measures with their derivatives to parameters, SI.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Sensitivities {
    /// Path parameter at which they were taken.
    pub parameter: f64,
    /// Time at which they were taken, s.
    pub time: f64,
    /// Value of every measure.
    pub values: Vec<f64>,
    /// What is to be told of the numbers over the motion in every measure.
    pub notes: Vec<Vec<StatisticNote>>,
    /// `derivatives[i][j]` is d(measure i)/d(parameter j); not finite where there is none.
    pub derivatives: Vec<Vec<f64>>,
    /// Which derivatives there are none of because the measure stands at a corner.
    pub one_sided: Vec<OneSided>,
}

/// A derivative that there is on either side alone.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct OneSided {
    /// Of which measure.
    pub measure: usize,
    /// To which parameter.
    pub parameter: usize,
    /// What it is on the side that numbers happen to be on; of two equally large extremes that of the first one; of a mean, as the parameter grows.
    pub slope: f64,
    /// What it is on the other side; not a number where that is not known.
    pub other: f64,
    /// Whether the corner is that of a number over the motion.
    pub over_motion: bool,
}

/// The derivatives of measures at a place of a motion to parameters of the model: see the module's text.
///
/// Beyond the motion every result is NaN.
///
/// # Errors
/// All measures that cannot be evaluated, each with its reason.
pub fn sensitivities(
    motion: &Arc<Motion>,
    held: Held,
    measures: &[&Measure],
    parameters: &[ParameterId],
) -> Result<Sensitivities, Vec<Unmeasurable>> {
    sensitivities_with(motion, held, measures, parameters, NoForces, |_| NoForces)
}

/// As [`sensitivities`], of measures of forces too: `plain` answers them for the motion's own design, and what `varying`
/// makes of parameter values for designs whose parameters vary.
///
/// # Errors
/// As [`sensitivities`].
pub fn sensitivities_with<F: ForceSource, G: ForceSource<Varying>>(
    motion: &Arc<Motion>,
    held: Held,
    measures: &[&Measure],
    parameters: &[ParameterId],
    plain: F,
    varying: impl FnMut(&[Varying]) -> G,
) -> Result<Sensitivities, Vec<Unmeasurable>> {
    let found = sensitivities_at(motion, &[held], measures, parameters, plain, varying)?;
    // One place, one answer.
    found.into_iter().next().ok_or_else(Vec::new)
}

/// As [`sensitivities_with`] at several places of the motion, in their order.
///
/// # Errors
/// As [`sensitivities`].
pub fn sensitivities_at<F: ForceSource, G: ForceSource<Varying>>(
    motion: &Arc<Motion>,
    held: &[Held],
    measures: &[&Measure],
    parameters: &[ParameterId],
    plain: F,
    mut varying: impl FnMut(&[Varying]) -> G,
) -> Result<Vec<Sensitivities>, Vec<Unmeasurable>> {
    // Unwrapped directions and the times of extremes come from the plain motion.
    let mut sampler = Sampler::with_forces(motion, measures, plain)?;
    let empty = |held: &Held, sampler: &Sampler<F>| {
        let (parameter, time) = match *held {
            Held::Path(p) => (p, sampler.clock().time_at(p)),
            Held::Time(t) | Held::Break(t) | Held::Extreme { time: t, .. } => {
                (sampler.clock().parameter_at(t), t)
            }
        };
        Sensitivities {
            parameter,
            time,
            values: vec![f64::NAN; measures.len()],
            notes: measures.iter().map(|m| sampler.notes_of(m)).collect(),
            derivatives: vec![Vec::with_capacity(parameters.len()); measures.len()],
            one_sided: Vec::new(),
        }
    };
    let mut all: Vec<Sensitivities> = held.iter().map(|held| empty(held, &sampler)).collect();
    for (part, chunk) in parameters.chunks(CHUNK).enumerate() {
        let values = varied_parameters(motion, chunk);
        let forces = varying(&values);
        let mut varied = Varied::new(motion, &mut sampler, &values, forces);
        varied.prepare(measures);
        for (it, held) in all.iter_mut().zip(held) {
            let place = varied.place(*held);
            for (index, measure) in measures.iter().enumerate() {
                let (result, at_corner) = match *held {
                    Held::Extreme { of, .. } if of != index => NO_ANSWER,
                    Held::Extreme { time, .. } => varied.at_extreme(measure, time),
                    _ => varied.value_at_corner(measure, place),
                };
                let at_corner_over = varied.at_corner_over(measure);
                let other = match at_corner_over.contains(&true) {
                    true => varied.on_the_other_side(measure, place),
                    false => [f64::NAN; CHUNK],
                };
                for (k, slope) in result.eps.iter().take(chunk.len()).enumerate() {
                    // What has no value has no derivatives either.
                    let one_sided = at_corner[k] || at_corner_over[k];
                    let none = result.re.is_nan() || one_sided;
                    it.derivatives[index].push(if none { f64::NAN } else { *slope });
                    if one_sided {
                        it.one_sided.push(OneSided {
                            measure: index,
                            parameter: part * CHUNK + k,
                            slope: *slope,
                            other: if at_corner[k] { f64::NAN } else { other[k] },
                            over_motion: !at_corner[k],
                        });
                    }
                }
            }
        }
    }
    // The values are those that rows have. What is infinite somewhere has no derivatives.
    for (it, held) in all.iter_mut().zip(held) {
        let plain = match *held {
            Held::Path(p) => sampler.values_at_parameter(p),
            Held::Time(t) | Held::Break(t) | Held::Extreme { time: t, .. } => {
                sampler.values_at_time(t)
            }
        };
        for (index, value) in plain.into_iter().enumerate() {
            let infinite = |note: &StatisticNote| matches!(note, StatisticNote::Infinite { .. });
            it.values[index] = value;
            if value.is_infinite() || it.notes[index].iter().any(infinite) {
                it.derivatives[index].fill(f64::NAN);
            }
        }
    }
    Ok(all)
}
