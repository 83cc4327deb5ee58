//! The static equilibrium to which a mechanism sinks from a pose when some of its drives are let go.
//!
//! The way there is that through treacle: `M x' = f(x)`, each step of which is that of the forces made linear, solved exactly. It
//! follows the branch, leaves unstable poses once it is off them, and ends in a stable one; near it the steps are Newton's.
//! (Continuation in pseudo-time: C. T. Kelley and D. E. Keyes, SIAM J. Numer. Anal. 35, 1998.)

use kempe_linear::Qr;
use kempe_mechanism::evidence::NEARLY_SINGULAR;
use kempe_model::DriveId;
use kempe_motion::progress::{Done, Progress};
use kempe_motion::{Stage, Stance};
use kempe_number::math;

use crate::linearised::{Linearised, Lineariser};
use crate::modes::{Mode, NoModes, modes};

/// Forces below this part of their terms balance.
pub const BALANCED: f64 = 1e-12;
/// No coordinate goes farther in one step, rad or mechanism sizes.
const REACH: f64 = 0.1;
/// Steps this small, rad or mechanism sizes, lead nowhere.
const NOWHERE: f64 = 1e-7;
/// Steps at most: a way of many turns.
const STEPS: usize = 1000;

/// Why no equilibrium was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unsettled {
    /// The coordinates come to where the mechanism goes no farther, a limit.
    AtLimit,
    /// The way has no end: something drives the mechanism on and on.
    NoEnd,
    /// The steps become small without an equilibrium: where springs go slack or loads jump.
    NoRest,
    /// It would rest where branches of the mechanism cross, or so near to that place that nothing is known of forces.
    AtChangePoint,
    /// It cannot be made linear.
    NoModes(NoModes),
    /// Stopped by whoever follows the progress.
    Stopped,
}

/// Lets a pose sink to static equilibrium, only the drives in `free` moving; at a time, s. Returns the equations linear about it.
/// A pose that is one of equilibrium already stays, stable or not.
///
/// # Errors
/// Where none is found; the stance is then where the way ended.
pub fn settle(
    stance: &mut Stance,
    lineariser: &mut Lineariser,
    time: f64,
    free: &[DriveId],
    progress: &mut dyn Progress,
) -> Result<Linearised, Unsettled> {
    let mut here = lineariser.at(stance.branch(), stance.coordinates(), time, free);
    let mut reach = REACH;
    let mut best = f64::INFINITY;
    for _ in 0..STEPS {
        if progress.reached(Stage::Settling, Done::Unknown).is_break() {
            return Err(Unsettled::Stopped);
        }
        let known = modes(&here).map_err(Unsettled::NoModes)?;
        let imbalance = here.imbalance();
        // A last step of Newton's method takes what is left to its rounding.
        if imbalance <= BALANCED && !(imbalance < 0.5 * best) || imbalance == 0.0 {
            return Ok(here);
        }
        let polishing = imbalance <= BALANCED;
        best = imbalance;
        let way = newton(&here, &known, stance, free, reach)
            .or_else(|| (!polishing).then(|| sinking(&here, &known, stance, free, reach)));
        let Some(way) = way else {
            return Ok(here);
        };
        let before = (stance.clone(), here.clone());
        if !went(stance, free, &way) {
            if polishing {
                return Ok(here);
            }
            // Every try at a limit costs many steps.
            reach /= 8.0;
            if reach < NOWHERE {
                return Err(Unsettled::AtLimit);
            }
            continue;
        }
        here = lineariser.at(stance.branch(), stance.coordinates(), time, free);
        if polishing {
            if here.imbalance() <= imbalance {
                continue;
            }
            (*stance, here) = before;
            return Ok(here);
        }
        // Behind the lowest place on the way the forces point back.
        let along = |it: &Linearised| dot(&it.force, &way);
        let overshot = along(&here) < -0.5 * along(&before.1).abs();
        if overshot || !here.is_finite() {
            (*stance, here) = before;
            best = f64::INFINITY;
            reach = reach.min(largest(stance, free, &way)) / 2.0;
            if reach < NOWHERE {
                let regular = stance.evidence().smallest_singular_value > NEARLY_SINGULAR;
                return Err(match regular {
                    true => Unsettled::NoRest,
                    false => Unsettled::AtChangePoint,
                });
            }
        } else {
            reach = (1.5 * reach).min(REACH);
        }
    }
    Err(Unsettled::NoEnd)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The change of all coordinates in which the free ones go this way.
fn of_all(stance: &Stance, free: &[DriveId], way: &[f64]) -> Vec<f64> {
    let mut all = vec![0.0; stance.coordinates().len()];
    for (drive, x) in free.iter().zip(way) {
        all[drive.index()] = *x;
    }
    all
}

fn largest(stance: &Stance, free: &[DriveId], way: &[f64]) -> f64 {
    let sizes = stance.in_sizes(&of_all(stance, free, way));
    sizes.iter().fold(0.0_f64, |m, x| {
        if x.abs() > m || x.is_nan() {
            x.abs()
        } else {
            m
        }
    })
}

fn went(stance: &mut Stance, free: &[DriveId], way: &[f64]) -> bool {
    let change = of_all(stance, free, way);
    let to: Vec<f64> = (stance.coordinates().iter().zip(change))
        .map(|(q, x)| q + x)
        .collect();
    stance.go(&to)
}

/// The way to where the forces vanish, made linear; none where that is no stable place, or out of reach.
fn newton(
    here: &Linearised,
    modes: &[Mode],
    stance: &Stance,
    free: &[DriveId],
    reach: f64,
) -> Option<Vec<f64>> {
    if !modes.iter().all(|m| m.square > 0.0) {
        return None;
    }
    let n = here.size;
    let mut qr = Qr::with_capacity(n, n);
    qr.reset(n, n);
    (0..n * n).for_each(|k| qr.add(k / n, k % n, here.stiffness[k]));
    qr.factor();
    let mut way = here.force.clone();
    qr.solve(&mut way);
    (largest(stance, free, &way) <= reach).then_some(way)
}

/// The way through treacle until a coordinate is out of reach.
fn sinking(
    here: &Linearised,
    modes: &[Mode],
    stance: &Stance,
    free: &[DriveId],
    reach: f64,
) -> Vec<f64> {
    let pulls: Vec<f64> = modes.iter().map(|m| dot(&m.shape, &here.force)).collect();
    // After a while `t` in s^2; shapes have unit mass.
    let way = |t: f64| -> Vec<f64> {
        let mut way = vec![0.0; here.size];
        for (mode, pull) in modes.iter().zip(&pulls) {
            let x = mode.square * t;
            let gone = if x == 0.0 {
                t
            } else {
                -math::exp_m1(-x) / mode.square
            };
            for (way, shape) in way.iter_mut().zip(&mode.shape) {
                *way += gone * pull * shape;
            }
        }
        way
    };
    let near = |t: f64| largest(stance, free, &way(t)) <= reach;
    let fastest = modes
        .iter()
        .fold(0.0_f64, |m, mode| m.max(mode.square.abs()));
    let mut low = if fastest > 0.0 { 1.0 / fastest } else { 1.0 };
    while !near(low) && low > f64::MIN_POSITIVE {
        low /= 4.0;
    }
    let mut high = 4.0 * low;
    while near(high) && high < f64::MAX / 8.0 {
        (low, high) = (high, 4.0 * high);
    }
    for _ in 0..20 {
        let middle = (low * high).sqrt();
        match near(middle) {
            true => low = middle,
            false => high = middle,
        }
    }
    way(low)
}
