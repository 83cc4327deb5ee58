//! A four-bar whose links have given angular velocities and accelerations at one pose (S. S. Bloch).
//!
//! With r1 to r4 round the loop, r1 the frame: r1 + r2 + r3 + r4 = 0, differentiated once, sum w r = 0, and twice,
//! sum (a + i w^2) r = 0, is linear and homogeneous in the vectors.

use kempe_linear::C;

use crate::error::{SynthesisError, all_finite};
use crate::four_bar::FourBar;

/// How a link turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkRates {
    /// Angular velocity, rad/s.
    pub velocity: f64,
    /// Angular acceleration, rad/s^2.
    pub acceleration: f64,
}

/// The vectors of a four-bar round its loop: first link, coupler, second link from coupler to frame, frame from second pivot to first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VectorLoop {
    /// From the first fixed pivot.
    pub first: C,
    /// From the first moving pivot.
    pub coupler: C,
    /// From the second moving pivot to the second fixed pivot.
    pub second: C,
    /// From the second fixed pivot back to the first.
    pub frame: C,
}

impl VectorLoop {
    /// The same, turned and scaled so that its frame is this vector, from the second fixed pivot to the first; `None` where the frame has no
    /// length.
    pub fn with_frame(&self, frame: C) -> Option<Self> {
        let factor = frame * self.frame.recip();
        factor.is_finite().then(|| Self {
            first: self.first * factor,
            coupler: self.coupler * factor,
            second: self.second * factor,
            frame,
        })
    }

    /// Its four-bar, with the first fixed pivot at 0; the coupler has its origin there and is not turned.
    pub fn four_bar(&self) -> FourBar {
        FourBar {
            fixed: [C::zero(), -self.frame],
            moving: [self.first, self.first + self.coupler],
            lengths: [self.first.norm(), self.second.norm()],
        }
    }
}

/// The four-bar, but for its size and direction, whose first link, coupler and second link have these rates at one pose.
///
/// r_first = w_second (a_coupler + i w_coupler^2) - w_coupler (a_second + i w_second^2) and so on round, the frame closes the loop.
///
/// # Errors
/// Rates that are not finite; [`SynthesisError::Dependent`] where two links turn alike, or all by one law: then these conditions leave more
/// free than size and direction.
pub fn bloch(rates: [LinkRates; 3]) -> Result<VectorLoop, SynthesisError> {
    all_finite(rates.map(|r| r.velocity.is_finite() && r.acceleration.is_finite()))?;
    let second_rate =
        |k: usize| C::new(rates[k].acceleration, rates[k].velocity * rates[k].velocity);
    let minor = |i: usize, j: usize| {
        second_rate(i) * rates[j].velocity - second_rate(j) * rates[i].velocity
    };
    let [first, coupler, second] = [minor(1, 2), minor(2, 0), minor(0, 1)];
    let size = (0..3).fold(0.0, |m: f64, k| {
        m.max(rates[k].velocity.abs() * second_rate((k + 1) % 3).norm())
            .max(rates[k].velocity.abs() * second_rate((k + 2) % 3).norm())
    });
    let shortest = [first, coupler, second]
        .map(|r| r.norm())
        .into_iter()
        .fold(f64::INFINITY, f64::min);
    if !(shortest > ALIKE * size) {
        return Err(SynthesisError::Dependent { datum: 2 });
    }
    Ok(VectorLoop {
        first,
        coupler,
        second,
        frame: -(first + coupler + second),
    })
}

/// A vector below this part of the terms it is the difference of is what rounding left of zero.
const ALIKE: f64 = 1e-13;
