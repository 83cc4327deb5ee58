//! Points that fill a box evenly.

use kempe_number::Random;
use kempe_number::math::powf;

/// Points of the unit box of a low discrepancy: multiples of powers of the generalised golden ratio, the root of x^(d+1) = x + 1, each shifted by the
/// same random amount (M. Roberts 2018, after L. Kuipers and H. Niederreiter 1974).
#[derive(Clone, Debug)]
pub struct Even {
    steps: Vec<f64>,
    at: Vec<f64>,
}

impl Even {
    /// Points of so many dimensions.
    pub fn new(dimensions: usize, seed: u64) -> Self {
        let power = dimensions as f64 + 1.0;
        let mut golden = 2.0;
        for _ in 0..60 {
            golden = powf(1.0 + golden, 1.0 / power);
        }
        let mut random = Random(seed);
        Self {
            steps: (1..=dimensions)
                .map(|k| powf(golden, -(k as f64)) % 1.0)
                .collect(),
            at: (0..dimensions).map(|_| random.uniform()).collect(),
        }
    }

    /// The next one.
    pub fn point(&mut self) -> Vec<f64> {
        for (x, step) in self.at.iter_mut().zip(&self.steps) {
            *x = (*x + step) % 1.0;
        }
        self.at.clone()
    }
}
