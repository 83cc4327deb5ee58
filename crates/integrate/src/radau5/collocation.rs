//! The method's numbers, and the polynomial of a step.

use kempe_linear::C;

/// Stages of a step.
pub(super) const STAGES: usize = 3;

/// At which part of the step each stage is taken: the zeros of d²/dx² [x² (x - 1)³], (4 ± √6) / 10 and 1.
pub(super) const NODES: [f64; STAGES] = [0.155_051_025_721_682_2, 0.644_948_974_278_317_8, 1.0];

// The inverse of the method's matrix has one real eigenvalue and a pair; in the basis of its eigenvectors the stages of a step
// come apart into one real and one complex system of the state's size (Hairer and Wanner, "Solving Ordinary Differential
// Equations II", section IV.8).

/// The real eigenvalue, 3 + 3^(2/3) - 3^(1/3).
pub(super) const REAL: f64 = 3.637_834_252_744_496;

/// The complex one, 3 + (3^(1/3) - 3^(2/3)) / 2 - i (3^(5/6) + 3^(7/6)) / 2.
pub(super) const COMPLEX: C = C {
    re: 2.681_082_873_627_752,
    im: -3.050_430_199_247_410_6,
};

/// From that basis to stages.
const TO_STAGES: [[f64; STAGES]; STAGES] = [
    [
        0.094_438_762_488_975_24,
        -0.141_255_295_020_954_2,
        0.030_029_194_105_147_424,
    ],
    [
        0.250_213_122_965_333_3,
        0.204_129_352_293_799_93,
        -0.382_942_112_757_261_9,
    ],
    [1.0, 1.0, 0.0],
];

/// From stages to that basis.
const FROM_STAGES: [[f64; STAGES]; STAGES] = [
    [
        4.178_718_591_551_904,
        0.327_682_820_761_062_4,
        0.523_376_445_499_449_5,
    ],
    [
        -4.178_718_591_551_904,
        -0.327_682_820_761_062_4,
        0.476_623_554_500_550_45,
    ],
    [
        0.502_872_634_945_786_9,
        -2.571_926_949_855_605,
        0.596_039_204_828_224_9,
    ],
];

/// What the stages add to the rates at the beginning in the estimate of a step's error: -(13 ± 7 √6) / 3 and -1/3.
pub(super) const ERROR: [f64; STAGES] = [
    -10.048_809_399_827_416,
    1.382_142_733_160_749,
    -0.333_333_333_333_333_3,
];

fn times(matrix: &[[f64; STAGES]; STAGES], x: [f64; STAGES]) -> [f64; STAGES] {
    matrix.map(|row| row[0] * x[0] + row[1] * x[1] + row[2] * x[2])
}

/// From the eigenvectors' basis to the stages of a component.
pub(super) fn to_stages(x: [f64; STAGES]) -> [f64; STAGES] {
    times(&TO_STAGES, x)
}

/// From the stages of a component to the eigenvectors' basis.
pub(super) fn from_stages(x: [f64; STAGES]) -> [f64; STAGES] {
    times(&FROM_STAGES, x)
}

/// How far a component has come at a part of the step, from what it is at the stages: the polynomial through these and
/// nothing at the beginning.
pub(super) fn polynomial(stages: [f64; STAGES], part: f64) -> f64 {
    let [_, b, end] = NODES;
    let [last, one, upper, cubic] = differences(stages);
    last + (part - end) * (one + (part - b) * (upper + (part - NODES[0]) * cubic))
}

/// How fast the polynomial goes there.
pub(super) fn slope(stages: [f64; STAGES], part: f64) -> f64 {
    let [a, b, end] = NODES;
    let [_, one, upper, cubic] = differences(stages);
    let (x, y, z) = (part - end, part - b, part - a);
    one + upper * (x + y) + cubic * (x * y + x * z + y * z)
}

/// The polynomial in Newton's form, from the end.
fn differences([first, second, last]: [f64; STAGES]) -> [f64; 4] {
    let [a, b, end] = NODES;
    let slope = |x: f64, y: f64, from: f64, to: f64| (y - x) / (to - from);
    let (one, two, three) = (
        slope(second, last, b, end),
        slope(first, second, a, b),
        slope(0.0, first, 0.0, a),
    );
    let (upper, lower) = (slope(two, one, a, end), slope(three, two, 0.0, b));
    [last, one, upper, slope(lower, upper, 0.0, end)]
}

#[cfg(test)]
mod tests {
    use kempe_number::powi;

    use super::*;

    /// The method's matrix, from what it is defined by: it integrates powers up to 2 exactly to every node.
    fn matrix() -> [[f64; STAGES]; STAGES] {
        let root = 6.0_f64.sqrt();
        let a = [
            [
                (88.0 - 7.0 * root) / 360.0,
                (296.0 - 169.0 * root) / 1800.0,
                (-2.0 + 3.0 * root) / 225.0,
            ],
            [
                (296.0 + 169.0 * root) / 1800.0,
                (88.0 + 7.0 * root) / 360.0,
                (-2.0 - 3.0 * root) / 225.0,
            ],
            [(16.0 - root) / 36.0, (16.0 + root) / 36.0, 1.0 / 9.0],
        ];
        for (row, node) in a.iter().zip(NODES) {
            for power in 0..3 {
                let sum: f64 = (row.iter().zip(NODES))
                    .map(|(a, c)| a * powi(c, power))
                    .sum();
                let exact = powi(node, power + 1) / f64::from(power + 1);
                assert!((sum - exact).abs() < 1e-15);
            }
        }
        a
    }

    #[test]
    fn the_basis_takes_the_methods_matrix_apart() {
        let a = matrix();
        for unit in 0..STAGES {
            let mut x = [0.0; STAGES];
            x[unit] = 1.0;
            // inverse(A) A x = x, with the inverse taken apart
            let [real, re, im] = from_stages(times(&a, x));
            let pair = COMPLEX * C::new(re, im);
            let back = to_stages([REAL * real, pair.re, pair.im]);
            for (one, other) in back.into_iter().zip(x) {
                assert!((one - other).abs() < 1e-14, "{back:?}");
            }
        }
    }

    #[test]
    fn the_polynomial_goes_through_the_stages() {
        let stages = [0.3, -1.7, 2.2];
        assert!(polynomial(stages, 0.0).abs() < 1e-14);
        for (node, value) in NODES.into_iter().zip(stages) {
            assert!((polynomial(stages, node) - value).abs() < 1e-14);
        }
        let cube = NODES.map(|x| powi(x, 3) - 2.0 * x);
        assert!((polynomial(cube, 1.7) - (powi(1.7, 3) - 3.4)).abs() < 1e-13);
        assert!((slope(cube, 1.7) - (3.0 * powi(1.7, 2) - 2.0)).abs() < 1e-13);
    }
}
