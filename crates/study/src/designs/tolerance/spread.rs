//! How a parameter differs from piece to piece.

use kempe_model::{Change, Spread, value};
use kempe_number::math;

/// A normal parameter counts in the worst case with so many standard deviations.
pub(super) const WORST_NORMAL: f64 = 3.0;

/// How a parameter differs from its value in the file, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Deviation {
    /// The least and the greatest deviation, of a normal one those that the worst case counts with.
    pub ends: [f64; 2],
    /// Whether it is normal, or else even between its ends.
    pub normal: bool,
}

impl Deviation {
    /// By a file's words and the parameters' values, of which one is `own`.
    pub fn new(spread: &Spread, parameters: &[f64], own: f64) -> Self {
        let size = |change: &Change| match change {
            Change::By(amount) => value::<f64>(amount, parameters).abs(),
            Change::Part(part) => (value::<f64>(part, parameters) * own).abs(),
        };
        match spread {
            Spread::Even(change) => Self::to_both(size(change), false),
            Spread::Normal(change) => Self::to_both(WORST_NORMAL * size(change), true),
            Spread::Between([low, high]) => Self {
                ends: [value(low, parameters), value(high, parameters)],
                normal: false,
            },
        }
    }

    fn to_both(most: f64, normal: bool) -> Self {
        Self {
            ends: [-most, most],
            normal,
        }
    }

    /// Its mean.
    pub fn mean(&self) -> f64 {
        0.5 * (self.ends[0] + self.ends[1])
    }

    /// Its standard deviation.
    pub fn deviation(&self) -> f64 {
        let half = 0.5 * (self.ends[1] - self.ends[0]);
        match self.normal {
            true => half / WORST_NORMAL,
            false => half / 3.0_f64.sqrt(),
        }
    }

    /// The deviation that this part of all pieces stays below.
    pub fn at(&self, part: f64) -> f64 {
        match self.normal {
            true => self.mean() + self.deviation() * normal_quantile(part),
            false => self.ends[0] + (self.ends[1] - self.ends[0]) * part,
        }
    }
}

/// The value that this part of a normal distribution of mean 0 and deviation 1 stays below: M. J. Wichura, algorithm AS 241, PPND16,
/// Appl. Statist. 37 (1988) 477-484; about 16 digits.
pub(super) fn normal_quantile(part: f64) -> f64 {
    let q = part - 0.5;
    let ratio = |r: f64, over: &[f64; 8], under: &[f64; 8]| {
        let horner = |c: &[f64; 8]| c.iter().rev().fold(0.0, |sum, c| sum * r + c);
        horner(over) / horner(under)
    };
    if q.abs() <= 0.425 {
        let r = 0.180625 - q * q;
        return q * ratio(r, &A, &B);
    }
    let tail = if q < 0.0 { part } else { 1.0 - part };
    let r = (-math::ln(tail)).sqrt();
    let size = match r <= 5.0 {
        true => ratio(r - 1.6, &C, &D),
        false => ratio(r - 5.0, &E, &F),
    };
    if q < 0.0 { -size } else { size }
}

#[rustfmt::skip]
const A: [f64; 8] = [
    3.387_132_872_796_366_5, 133.141_667_891_784_38, 1_971.590_950_306_551_3, 13_731.693_765_509_46,
    45_921.953_931_549_87, 67_265.770_927_008_7, 33_430.575_583_588_13, 2_509.080_928_730_122_7,
];
#[rustfmt::skip]
const B: [f64; 8] = [
    1.0, 42.313_330_701_600_91, 687.187_007_492_057_9, 5_394.196_021_424_751,
    21_213.794_301_586_597, 39_307.895_800_092_71, 28_729.085_735_721_943, 5_226.495_278_852_854,
];
#[rustfmt::skip]
const C: [f64; 8] = [
    1.423_437_110_749_683_5, 4.630_337_846_156_546, 5.769_497_221_460_691, 3.647_848_324_763_204_5,
    1.270_458_252_452_368_4, 0.241_780_725_177_450_6, 0.022_723_844_989_269_184, 7.745_450_142_783_414e-4,
];
#[rustfmt::skip]
const D: [f64; 8] = [
    1.0, 2.053_191_626_637_759, 1.676_384_830_183_803_8, 0.689_767_334_985_1,
    0.148_103_976_427_480_08, 0.015_198_666_563_616_457, 5.475_938_084_995_345e-4, 1.050_750_071_644_416_9e-9,
];
#[rustfmt::skip]
const E: [f64; 8] = [
    6.657_904_643_501_103, 5.463_784_911_164_114, 1.784_826_539_917_291_3, 0.296_560_571_828_504_87,
    0.026_532_189_526_576_124, 1.242_660_947_388_078_4e-3, 2.711_555_568_743_487_6e-5, 2.010_334_399_292_288_1e-7,
];
#[rustfmt::skip]
const F: [f64; 8] = [
    1.0, 0.599_832_206_555_888, 0.136_929_880_922_735_8, 0.014_875_361_290_850_615,
    7.868_691_311_456_133e-4, 1.846_318_317_510_054_8e-5, 1.421_511_758_316_446e-7, 2.044_263_103_389_939_8e-15,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_tables() {
        let known = [
            (0.5, 0.0),
            (0.975, 1.959_963_984_540_054),
            (0.95, 1.644_853_626_951_472_7),
            (0.001_349_898_031_630_094_5, -3.0),
            (2.866_515_718_791_945e-7, -5.0),
            (6.220_960_574_271_786e-16, -8.0),
            (1e-20, -9.262_340_089_798_408),
        ];
        for (part, quantile) in known {
            let found = normal_quantile(part);
            assert!(
                (found - quantile).abs() < 1e-14 * (1.0 + quantile.abs()),
                "{part}: {found}"
            );
        }
    }

    #[test]
    fn spreads_have_their_moments() {
        let parameters = [2.0];
        let by = |x: f64| kempe_units::Expr::Const(x);
        let even = Deviation::new(&Spread::Even(Change::Part(by(0.01))), &parameters, 2.0);
        assert_eq!(even.ends, [-0.02, 0.02]);
        assert!((even.deviation() - 0.02 / 3.0_f64.sqrt()).abs() < 1e-18);
        let normal = Deviation::new(&Spread::Normal(Change::By(by(0.5))), &parameters, 2.0);
        assert_eq!(
            (normal.ends, normal.deviation(), normal.mean()),
            ([-1.5, 1.5], 0.5, 0.0)
        );
        let between = Deviation::new(&Spread::Between([by(0.0), by(0.3)]), &parameters, 2.0);
        assert_eq!(between.mean(), 0.15);
        assert!((between.at(0.25) - 0.075).abs() < 1e-16);
        // The moments of what is drawn.
        let n = 20_000;
        let drawn = (0..n).map(|i| normal.at((f64::from(i) + 0.5) / f64::from(n)));
        let square: f64 = drawn.map(|x| x * x).sum();
        assert!(((square / f64::from(n)).sqrt() - 0.5).abs() < 1e-3);
    }
}
