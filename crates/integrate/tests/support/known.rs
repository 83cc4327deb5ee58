//! Benchmarks of multibody dynamics: solutions found apart from Kempe.
#![allow(dead_code, clippy::excessive_precision)]

/// `examples/benchmarks/pendulum.toml`, 1 kg on 1 m without mass, from rest at x = -1 m: time, x, y and the rate of the angle but for
/// its sign; Jacobi's functions, from 40 digits.
pub const PENDULUM: [(f64, f64, f64, f64); 4] = [
    (
        1.0,
        0.98629175113187531936,
        -0.16501085312554116875,
        -1.79930901690707862,
    ),
    (
        2.0,
        -0.79356619534332174699,
        -0.60848393044379151463,
        3.45520689905932978,
    ),
    (
        5.0,
        -0.9423054350437573355,
        -0.33475433841400058079,
        -2.56278756819262946,
    ),
    (
        10.0,
        -0.27508746257611686005,
        -0.96141920509912506427,
        -4.34316069286468305,
    ),
];

/// `andrews.toml`: time, beta and its rate; at 0.03 s a solution in quadruple precision.
pub const ANDREWS: [(f64, f64, f64); 3] = [
    (0.01, 2.160_113_131_531_526_5, 711.923_152_831_103_9),
    (0.02, 8.184_905_889_667_561, 726.558_342_609_127_7),
    (0.03, 15.810_771_195_153_707, 1_139.920_302_259_106_1),
];

/// `crank-rocker.toml` at 30 rad/s from 90 degrees: time, angle and rate of the crank; another integrator, with an energy drift below
/// 4e-12.
pub const CRANK_ROCKER: [(f64, f64, f64); 3] = [
    (0.1, 5.552026524037504, 29.04393968614691),
    (0.5, 20.25304488137455, 31.07100123095598),
    (1.0, 38.92717954011124, 33.02780516330781),
];

/// A contact of a pin in its bore: when it begins, approach speed, until when, deepest (m) and largest force (N).
pub type Contact = [f64; 5];

/// The first contacts of P. Flores et al.'s slider-crank at 5000 rpm without friction: DOP853 at 1e-12, by equations written by hand.
pub const SMOOTH: [Contact; 3] = [
    [
        2.272860320398e-4,
        4.3857831453,
        2.807232580788e-4,
        7.7952e-5,
        45872.2,
    ],
    [
        6.3705643017e-4,
        2.756949153,
        6.9089059194e-4,
        4.6121e-5,
        20869.0,
    ],
    [
        7.497002798e-4,
        1.82669907,
        8.151504404e-4,
        5.3015e-5,
        25926.0,
    ],
];

/// The same with a coefficient of friction of 0.03.
pub const ROUGH: [Contact; 3] = [
    [
        2.272860320398e-4,
        4.3857831453,
        2.808068769966e-4,
        7.7900e-5,
        45825.5,
    ],
    [
        5.7337150538e-4,
        2.267401295,
        6.2266535261e-4,
        3.5968e-5,
        14373.0,
    ],
    [7.19152359e-4, 2.11913999, 7.87767349e-4, 5.4595e-5, 26976.0],
];
