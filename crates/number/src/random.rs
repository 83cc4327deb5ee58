//! Numbers that are generic and the same everywhere.

use crate::{Complex, math};

/// A small reproducible generator (splitmix64): what it serves must be generic, not secret.
pub struct Random(pub u64);

impl Random {
    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// The next number, even between 0 and 1.
    pub fn uniform(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A complex number of size between 1/2 and 3/2.
    pub fn complex(&mut self) -> Complex<f64> {
        let (s, c) = math::sin_cos(self.uniform() * std::f64::consts::TAU);
        let size = 0.5 + self.uniform();
        Complex::new(c * size, s * size)
    }
}
