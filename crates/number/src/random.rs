//! Numbers that are generic and the same everywhere.

use crate::{Complex, math};

/// A small reproducible generator (splitmix64): what it serves must be generic, not secret.
#[derive(Clone, Debug, PartialEq, Eq)]
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

    /// The next number of the normal distribution of mean 0 and deviation 1 (G. E. P. Box and M. E. Muller, 1958). The second of
    /// their pair is not kept, so that 64 bits are the whole state.
    pub fn normal(&mut self) -> f64 {
        // 1 - u is never zero.
        let size = (-2.0 * math::ln(1.0 - self.uniform())).sqrt();
        size * math::cos(self.uniform() * std::f64::consts::TAU)
    }

    /// A whole number below `n`, each as likely (to within n / 2^64); zero for `n` = 0.
    pub fn below(&mut self, n: usize) -> usize {
        ((u128::from(self.bits()) * n as u128) >> 64) as usize
    }

    /// A complex number of size between 1/2 and 3/2.
    pub fn complex(&mut self) -> Complex<f64> {
        let (s, c) = math::sin_cos(self.uniform() * std::f64::consts::TAU);
        let size = 0.5 + self.uniform();
        Complex::new(c * size, s * size)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_numbers_have_the_moments_of_their_distribution() {
        let mut random = Random(7);
        let n = 40_000;
        let mut moments = [0.0; 4];
        for _ in 0..n {
            let x = random.normal();
            let mut power = 1.0;
            for moment in &mut moments {
                power *= x;
                *moment += power / f64::from(n);
            }
        }
        for (moment, wanted) in moments.iter().zip([0.0, 1.0, 0.0, 3.0]) {
            assert!((moment - wanted).abs() < 0.1, "{moments:?}");
        }
    }

    #[test]
    fn whole_numbers_stay_below() {
        let mut random = Random(3);
        let mut seen = [0; 5];
        (0..1000).for_each(|_| seen[random.below(5)] += 1);
        assert!(seen.iter().all(|n| (150..250).contains(n)), "{seen:?}");
        assert_eq!(random.below(0), 0);
    }
}
