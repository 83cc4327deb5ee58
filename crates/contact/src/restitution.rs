//! How much a normal law must dissipate for a wanted restitution, and which restitution it delivers.
//!
//! Laws `F = K d^n (1 + chi v / v0)` deliver the same restitution `e` for every stiffness, exponent, mass and approach speed v0:
//! `m v dv/dd = -K d^n (1 + chi v / v0)` separates, and both halves of an impact meet in the deepest indentation where
//! `chi (1 + e) = ln((1 + chi) / (1 - chi e))`. (Y. Gonthier et al., Multibody System Dynamics 11, 2004, have the same relation as
//! their implicit factor.)
//!
//! With `q = -ln(1 - chi e)` the relation is `chi - ln(1 + chi) = q - (1 - exp(-q))`: both sides without cancellation.

use kempe_model::Dissipation;
use kempe_number::math::{exp, exp_m1, ln_1p};

use crate::Unfit;

/// Below this, differences of functions are taken from their series.
pub(crate) const SMALL: f64 = 0.1;
/// Terms of those series.
const TERMS: i32 = 20;

/// The factor chi of a law for a wanted restitution.
///
/// # Errors
///
/// Where the restitution is not above 0 and at most 1.
pub fn factor(dissipation: Dissipation, restitution: f64) -> Result<f64, Unfit> {
    let e = checked(restitution)?;
    Ok(match dissipation {
        Dissipation::Exact => exact_factor(e),
        Dissipation::HuntCrossley => 1.5 * (1.0 - e),
        Dissipation::HerbertMcWhannell => {
            6.0 * (1.0 - e) / ((2.0 * e - 1.0) * (2.0 * e - 1.0) + 3.0)
        }
        Dissipation::LeeWang => 0.75 * (1.0 - e),
        Dissipation::LankaraniNikravesh => 0.75 * (1.0 - e * e),
        Dissipation::Gonthier => (1.0 - e * e) / e,
        Dissipation::ZhiyingQishao => 0.75 * (1.0 - e * e) * exp(2.0 * (1.0 - e)),
        Dissipation::Flores => 1.6 * (1.0 - e) / e,
        Dissipation::HuGuo => 1.5 * (1.0 - e) / e,
    })
}

/// The restitution that a law's factor for a wanted one delivers.
///
/// # Errors
///
/// As [`factor`].
pub fn delivered(dissipation: Dissipation, restitution: f64) -> Result<f64, Unfit> {
    Ok(delivered_by_factor(factor(dissipation, restitution)?))
}

fn checked(restitution: f64) -> Result<f64, Unfit> {
    match restitution > 0.0 && restitution <= 1.0 {
        true => Ok(restitution),
        false => Err(Unfit::Restitution(restitution)),
    }
}

/// The restitution that a law of this factor chi delivers: 1 for none, less for more.
pub fn delivered_by_factor(chi: f64) -> f64 {
    if !(chi > 0.0) {
        return 1.0;
    }
    -exp_m1(-rebound_exponent(chi)) / chi
}

/// q of a factor chi.
pub(crate) fn rebound_exponent(chi: f64) -> f64 {
    let wanted = beyond_logarithm(chi);
    // The right side of the relation lies between q - 1 and q.
    root(|q| wanted - beyond_exponential(q), wanted + 1.0)
}

/// The factor chi that delivers a restitution.
fn exact_factor(e: f64) -> f64 {
    if e == 1.0 {
        return 0.0;
    }
    let chi = |q: f64| -exp_m1(-q) / e;
    // chi < 1 / e, so that q < (1 + e) / e.
    let most = (1.0 + e) / e;
    chi(root(
        |q| beyond_logarithm(chi(q)) - beyond_exponential(q),
        most,
    ))
}

/// x - ln(1 + x).
pub(crate) fn beyond_logarithm(x: f64) -> f64 {
    if x.abs() < SMALL {
        return x * x * series(-x, |k| f64::from(k + 2));
    }
    x - ln_1p(x)
}

/// x - (1 - exp(-x)).
fn beyond_exponential(x: f64) -> f64 {
    if x.abs() < SMALL {
        let mut term = 0.5 * x * x;
        return (3..TERMS).fold(0.0, |sum, k| {
            let sum = sum + term;
            term *= -x / f64::from(k);
            sum
        });
    }
    x + exp_m1(-x)
}

/// The sum of x^k / divisor(k), from k = 0.
fn series(x: f64, divisor: impl Fn(i32) -> f64) -> f64 {
    (0..TERMS)
        .rev()
        .fold(0.0, |sum, k| sum * x + 1.0 / divisor(k))
}

/// Where something that is positive just above 0 and negative at `high` changes its sign, to rounding.
pub(crate) fn root(value: impl Fn(f64) -> f64, mut high: f64) -> f64 {
    let mut low = 0.0;
    loop {
        let middle = 0.5 * low + 0.5 * high;
        if !(middle > low && middle < high) {
            return high;
        }
        match value(middle) > 0.0 {
            true => low = middle,
            false => high = middle,
        }
    }
}
