//! Points that fill the unit box evenly: J. H. Halton's sequence (1960), with digits permuted at random as by A. B. Owen (A randomized
//! Halton algorithm, 2017), without which its higher variables run in stripes.

use kempe_number::Random;

/// Digits of a coordinate: more would not show.
const LEAST_DIGIT: f64 = f64::EPSILON;

/// The first points of the sequence of a seed.
pub fn halton(seed: u64, points: usize, variables: usize) -> Vec<Vec<f64>> {
    let mut random = Random(seed);
    let mut all = vec![vec![0.0; variables]; points];
    for (variable, base) in primes(variables).into_iter().enumerate() {
        let mut unit = 1.0 / base as f64;
        let mut power = 1_usize;
        while unit > LEAST_DIGIT {
            let permuted = permutation(&mut random, base);
            for (index, point) in all.iter_mut().enumerate() {
                point[variable] += permuted[index / power % base] as f64 * unit;
            }
            unit /= base as f64;
            power = power.saturating_mul(base);
        }
    }
    all
}

/// The first prime numbers.
fn primes(count: usize) -> Vec<usize> {
    let mut primes: Vec<usize> = Vec::with_capacity(count);
    let mut number = 2_usize;
    while primes.len() < count {
        if primes.iter().all(|p| !number.is_multiple_of(*p)) {
            primes.push(number);
        }
        number += 1;
    }
    primes
}

/// The numbers below `n` in a random order (R. A. Fisher and F. Yates, 1938).
fn permutation(random: &mut Random, n: usize) -> Vec<usize> {
    let mut all: Vec<usize> = (0..n).collect();
    for k in (1..n).rev() {
        all.swap(k, random.below(k + 1));
    }
    all
}
