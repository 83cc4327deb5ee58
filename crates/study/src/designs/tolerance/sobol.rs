//! Points that fill a cube more evenly than random ones do.
//!
//! I. M. Sobol's sequence (1967) with the direction numbers of S. Joe and F. Y. Kuo, *Constructing Sobol sequences with better
//! two-dimensional projections*, SIAM J. Sci. Comput. 30 (2008) 2635-2654. It is scrambled as A. B. Owen does (1995), so that every point is
//! evenly distributed by itself and no point stands out, the first one neither: by hashing digits that were reversed, after S. Laine and
//! T. Karras (2011) with the constants of N. Vegdahl, as B. Burley, *Practical hash-based Owen scrambling*, JCGT 9 (2020), describes.

use kempe_number::Random;

use super::direction_numbers::DIRECTION_NUMBERS;

/// Binary digits of a coordinate.
const DIGITS: usize = 32;

/// A scrambled sequence.
#[derive(Clone, Debug)]
pub(super) struct Sobol {
    /// By dimension: what each digit of a point's number adds, with the digits of the coordinate reversed.
    directions: Vec<[u32; DIGITS]>,
    /// What the scrambling of each coordinate begins with.
    seeds: Vec<u32>,
}

impl Sobol {
    /// Coordinates there are direction numbers for.
    pub const MOST: usize = DIRECTION_NUMBERS.len() + 1;

    /// The sequence in so many dimensions, at most [`Sobol::MOST`], under a seed.
    pub fn new(dimensions: usize, seed: u64) -> Self {
        let mut random = Random(seed);
        let directions = (0..dimensions).map(|k| directions(k).map(u32::reverse_bits));
        Self {
            directions: directions.collect(),
            seeds: (0..dimensions).map(|_| random.bits() as u32).collect(),
        }
    }

    /// A coordinate of the point of a number, strictly between 0 and 1.
    pub fn coordinate(&self, number: u32, dimension: usize) -> f64 {
        let (mut reversed, mut rest) = (0, number);
        while rest != 0 {
            reversed ^= self.directions[dimension][rest.trailing_zeros() as usize];
            rest &= rest - 1;
        }
        let digits = scrambled(reversed, self.seeds[dimension]).reverse_bits();
        (f64::from(digits) + 0.5) / (1_u64 << DIGITS) as f64
    }
}

/// Changes every digit as the more significant ones say, which stand below it.
fn scrambled(mut x: u32, seed: u32) -> u32 {
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^= x.wrapping_mul(0x53a2_2864);
    x
}

/// What each digit of a point's number adds to a coordinate.
fn directions(dimension: usize) -> [u32; DIGITS] {
    let mut v = [0_u32; DIGITS];
    let known = dimension
        .checked_sub(1)
        .and_then(|k| DIRECTION_NUMBERS.get(k));
    let Some(&(coefficients, first)) = known else {
        // The first coordinate is van der Corput's sequence.
        for (k, v) in v.iter_mut().enumerate() {
            *v = 1 << (DIGITS - 1 - k);
        }
        return v;
    };
    let degree = first.len();
    for (k, m) in first.iter().enumerate() {
        v[k] = m << (DIGITS - 1 - k);
    }
    for k in degree..DIGITS {
        v[k] = v[k - degree] ^ (v[k - degree] >> degree);
        for j in 1..degree {
            if coefficients >> (degree - 1 - j) & 1 == 1 {
                v[k] ^= v[k - j];
            }
        }
    }
    v
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Any 2^k points lie one in each of 2^k intervals, whatever the seed: scrambling keeps that.
    #[test]
    fn every_coordinate_is_stratified() {
        for seed in [1, 2, 99] {
            let sobol = Sobol::new(Sobol::MOST, seed);
            for dimension in 0..Sobol::MOST {
                let mut seen = [false; 256];
                for number in 0..256 {
                    let x = sobol.coordinate(number, dimension);
                    assert!(x > 0.0 && x < 1.0);
                    seen[(x * 256.0) as usize] = true;
                }
                assert!(seen.iter().all(|it| *it), "{dimension}");
            }
        }
    }

    /// Without scrambling the first points are those of every book; three coordinates of Joe and Kuo's.
    #[test]
    fn the_first_points_are_known() {
        let point = |number: u32| -> Vec<f64> {
            (0..3)
                .map(|k| {
                    let v = directions(k);
                    let own = (0..32).filter(|b| number >> b & 1 == 1);
                    let digits = own.fold(0_u32, |x, b| x ^ v[b]);
                    f64::from(digits) / (1_u64 << DIGITS) as f64
                })
                .collect()
        };
        // In the order of plain numbers, not of Gray's code: the third and the fourth change places.
        assert_eq!(point(1), [0.5, 0.5, 0.5]);
        assert_eq!(point(2), [0.25, 0.75, 0.75]);
        assert_eq!(point(3), [0.75, 0.25, 0.25]);
    }

    /// Pairs of neighbouring coordinates fill their square: 2^10 points, one in each of 32 x 32 squares but for few.
    #[test]
    fn pairs_of_coordinates_fill_their_square() {
        let sobol = Sobol::new(Sobol::MOST, 5);
        for dimension in 1..Sobol::MOST {
            let mut seen = vec![false; 1024];
            for number in 0..4096 {
                let [x, y] = [dimension - 1, dimension]
                    .map(|k| (sobol.coordinate(number, k) * 32.0) as usize);
                seen[32 * x + y] = true;
            }
            let missing = seen.iter().filter(|it| !**it).count();
            assert!(missing < 520, "{dimension}: {missing}");
        }
    }
}
