//! What an impact of a law `F = K d^n (1 + chi d' / v0)` comes to.
//!
//! With u = v / v0, `K d^(n+1) / (n+1) = m v0^2 G(u)`, where `G(u)` is the integral of `s / (1 + chi s)` from u to 1. The rebound is
//! the approach of a law of factor `-chi e` from `e v0`, backwards in time.

use kempe_number::math::{cosh, exp, exp_m1, ln, ln_1p, powf, sinh};

use crate::restitution::{SMALL, beyond_logarithm, rebound_exponent, root};
use crate::unfit::{not_negative, positive};
use crate::{Unfit, delivered_by_factor};

/// Half the nodes of the quadrature of a duration, and the distance between them (tanh-sinh). Errors are at rounding also
/// for restitutions of a hundredth, whose rebound is nearly a singularity.
const NODES: i32 = 448;
const SPACING: f64 = 1.0 / 128.0;

/// An impact between two bodies, one of which may be the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// The part of the speed that is given back.
    pub restitution: f64,
    /// Deepest indentation, m.
    pub indentation: f64,
    /// Largest force, N.
    pub force: f64,
    /// The part of the approach speed that is left where the force is largest.
    pub speed_at_force: f64,
    /// How long it takes, s.
    pub duration: f64,
    /// Energy that is lost, J.
    pub energy_lost: f64,
}

impl Impact {
    /// That of a law with this stiffness K (N/m^n), exponent n and factor chi, between bodies of a reduced mass (kg) that
    /// approach with this speed (m/s).
    ///
    /// # Errors
    ///
    /// Where one of them is not positive; chi may be zero.
    pub fn new(
        stiffness: f64,
        exponent: f64,
        chi: f64,
        reduced_mass: f64,
        approach: f64,
    ) -> Result<Self, Unfit> {
        let stiffness = positive("stiffness of the contact", stiffness)?;
        let n = positive("exponent of the contact's law", exponent)?;
        let chi = not_negative("factor of dissipation", chi)?;
        let mass = positive("reduced mass", reduced_mass)?;
        let speed = positive("approach speed", approach)?;
        let restitution = delivered_by_factor(chi);
        let approaching = Half::approach(chi);
        let whole = approaching.travelled(1.0);
        let to_depth = 1.0 / (n + 1.0);
        let energy = mass * speed * speed;
        let indentation = powf((n + 1.0) * energy * whole / stiffness, to_depth);
        // dF = 0: n / (n + 1) u = chi G(u); both sides meet once.
        let share = n * to_depth;
        let u = match chi > 0.0 {
            true => root(|u| chi * approaching.travelled(1.0 - u) - share * u, 1.0),
            false => 0.0,
        };
        let there = indentation * powf(approaching.travelled(1.0 - u) / whole, to_depth);
        let approach_time = approaching.duration(n) / speed;
        let rebound_time = Half::rebound(chi).duration(n) / (restitution * speed);
        Ok(Self {
            restitution,
            indentation,
            force: stiffness * powf(there, n) * (1.0 + chi * u),
            speed_at_force: u,
            duration: indentation * (approach_time + rebound_time),
            energy_lost: 0.5 * energy * (1.0 - restitution) * (1.0 + restitution),
        })
    }
}

/// One half of an impact, from full speed to rest.
#[derive(Clone, Copy, Debug)]
struct Half {
    /// Its factor.
    chi: f64,
    /// ln(1 + chi), also where chi is -1 but for rounding.
    log: f64,
}

impl Half {
    fn approach(chi: f64) -> Self {
        Self {
            chi,
            log: ln_1p(chi),
        }
    }

    /// The other half of an impact whose approach has this factor, backwards in time.
    fn rebound(chi: f64) -> Self {
        if !(chi > 0.0) {
            return Self::approach(0.0);
        }
        let q = rebound_exponent(chi);
        Self {
            chi: exp_m1(-q),
            log: -q,
        }
    }

    /// 1 + chi u at `u = 1 - fallen`.
    fn resistance(&self, fallen: f64) -> f64 {
        exp(self.log) - self.chi * fallen
    }

    /// G at `u = 1 - fallen`, without cancellation for u >= 0.
    fn travelled(&self, fallen: f64) -> f64 {
        let resistance = self.resistance(fallen);
        let part = fallen / resistance;
        // ln(1 + chi) - ln(1 + chi u) = ln(1 + x)
        let x = self.chi * part;
        let rest = if x == 0.0 {
            0.5
        } else if x.abs() < SMALL {
            beyond_logarithm(x) / (x * x)
        } else {
            (x - (self.log - ln(resistance))) / (x * x)
        };
        part * (1.0 - fallen) + part * part * rest
    }

    /// How long it takes, times its full speed over the deepest indentation.
    fn duration(&self, n: f64) -> f64 {
        let whole = self.travelled(1.0);
        // dt = dd / v, and v falls by y^(n+1) from its full size: then nothing is singular where the bodies touch first.
        let integrand = |y: f64| {
            let fallen = powf(y, n + 1.0).max(f64::MIN_POSITIVE);
            let travelled = self.travelled(fallen) / fallen / whole;
            powf(travelled, -n / (n + 1.0)) / self.resistance(fallen) / whole
        };
        let half_pi = std::f64::consts::FRAC_PI_2;
        let sum: f64 = (-NODES..=NODES)
            .map(|k| {
                let t = f64::from(k) * SPACING;
                let (stretched, slope) = (half_pi * sinh(t), half_pi * cosh(t));
                // y = 1 / (1 + exp(-2 s)), from its nearer end.
                let small = exp(-2.0 * stretched.abs());
                let y = if stretched < 0.0 { small } else { 1.0 } / (1.0 + small);
                let weight = slope * 2.0 * small / ((1.0 + small) * (1.0 + small));
                weight * integrand(y)
            })
            .sum();
        sum * SPACING
    }
}
