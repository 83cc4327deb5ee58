//! Accuracy of the sine and cosine kernel, and its bit-for-bit agreement between scalar and lanes.

use kempe_number::{InstructionSet, Interval, Lanes, Number, math, multiversion};
use proptest::prelude::*;

/// Units in the last place of `exact` between `x` and `exact`.
fn ulps(x: f64, exact: f64) -> f64 {
    (x - exact).abs() / (exact.abs().next_up() - exact.abs()).abs()
}

/// The table rows: numbers given by their bits.
fn rows<const COLUMNS: usize>(table: &str) -> impl Iterator<Item = [f64; COLUMNS]> {
    let number = |field: &str| f64::from_bits(u64::from_str_radix(field, 16).expect("16 digits"));
    table
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(move |line| {
            let mut fields = line.split(',');
            [(); COLUMNS].map(|()| number(fields.next().expect("a number in every column")))
        })
}

/// Largest error of sine and cosine in units of the last place; half a unit is the rounding of the answer itself.
const LARGEST_ERROR: f64 = 0.8;

#[test]
fn hard_points_are_within_one_ulp() {
    for [x, sin, sin_rest, cos, cos_rest] in rows(include_str!("../data/sin_cos_points.csv")) {
        let (s, c) = math::sin_cos(x);
        let unit = |exact: f64| exact.abs().next_up() - exact.abs();
        let sin_error = ((s - sin) - sin_rest).abs() / unit(sin);
        let cos_error = ((c - cos) - cos_rest).abs() / unit(cos);
        assert!(
            sin_error <= LARGEST_ERROR,
            "sin {x:e} = {s:e}, error {sin_error}"
        );
        assert!(
            cos_error <= LARGEST_ERROR,
            "cos {x:e} = {c:e}, error {cos_error}"
        );
    }
}

/// Whether the interval holds `rounded + rest`, which no single number is.
fn encloses(bounds: Interval, rounded: f64, rest: f64) -> bool {
    bounds.contains(rounded)
        && (rest >= 0.0 || bounds.lo() < rounded)
        && (rest <= 0.0 || bounds.hi() > rounded)
}

#[test]
fn intervals_enclose_what_rounding_leaves() {
    for [x, sin, sin_rest, cos, cos_rest] in rows(include_str!("../data/sin_cos_points.csv")) {
        let (s, c) = Interval::from_f64(x).sin_cos();
        assert!(encloses(s, sin, sin_rest), "sin {x:e} not in {s:?}");
        assert!(encloses(c, cos, cos_rest), "cos {x:e} not in {c:?}");
    }
}

#[test]
fn angles_of_vectors_are_within_one_ulp() {
    for [y, x, angle] in rows(include_str!("../data/atan2_points.csv")) {
        let a = math::atan2(y, x);
        assert!(
            ulps(a, angle) <= 1.0,
            "atan2({y:e}, {x:e}) = {a:e}, exactly {angle:e}"
        );
    }
}

#[test]
fn special_values() {
    assert_eq!(math::sin_cos(0.0), (0.0, 1.0));
    assert_eq!(math::sin(-0.0).to_bits(), (-0.0_f64).to_bits());
    assert_eq!(math::sin_cos(f64::MIN_POSITIVE), (f64::MIN_POSITIVE, 1.0));
    for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let (s, c) = math::sin_cos(x);
        assert!(s.is_nan() && c.is_nan());
    }
}

#[test]
fn min_and_max_keep_nan() {
    assert_eq!((math::min(1.0, 2.0), math::max(1.0, 2.0)), (1.0, 2.0));
    for (a, b) in [(f64::NAN, 1.0), (1.0, f64::NAN)] {
        assert!(math::min(a, b).is_nan() && math::max(a, b).is_nan());
    }
}

/// Every argument a kernel may meet: plain, tiny, next to multiples of pi/4, beyond the limit, not a number.
fn any_angle() -> impl Strategy<Value = f64> {
    let near_multiple = (-140_000_i32..140_000, -4_i64..5).prop_map(|(n, steps)| {
        let x = f64::from(n) * std::f64::consts::FRAC_PI_4;
        f64::from_bits(x.to_bits().wrapping_add_signed(steps))
    });
    prop_oneof![
        4 => -10.0..10.0,
        4 => -1e5..1e5,
        2 => near_multiple,
        1 => prop::num::f64::ANY,
    ]
}

/// Both are within one unit of the exact value, so their answers are neighbours at most.
const AGAINST_LIBM: f64 = 1.0;

#[inline(always)]
fn sin_cos_inner<const W: usize>(x: Lanes<W>) -> (Lanes<W>, Lanes<W>) {
    x.sin_cos()
}

multiversion! {
    fn sin_cos_8(set: InstructionSet, x: Lanes<8>) -> (Lanes<8>, Lanes<8>) = sin_cos_inner;
}
multiversion! {
    fn sin_cos_16(set: InstructionSet, x: Lanes<16>) -> (Lanes<16>, Lanes<16>) = sin_cos_inner;
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4096))]

    #[test]
    fn agrees_with_libm(x in any_angle()) {
        let (s, c) = math::sin_cos(x);
        let (sin, cos) = libm::sincos(x);
        if x.is_finite() {
            prop_assert!(ulps(s, sin) <= AGAINST_LIBM && ulps(c, cos) <= AGAINST_LIBM, "{x:e}: {s:e} {sin:e}");
        } else {
            prop_assert!(s.is_nan() && c.is_nan());
        }
    }

    #[test]
    fn is_odd_and_even(x in any_angle()) {
        let ((s, c), (minus_s, minus_c)) = (math::sin_cos(x), math::sin_cos(-x));
        if x.is_finite() {
            prop_assert_eq!(s.to_bits(), (-minus_s).to_bits());
            prop_assert_eq!(c.to_bits(), minus_c.to_bits());
        }
    }

    #[test]
    fn lanes_have_the_bits_of_the_scalar(xs in prop::collection::vec(any_angle(), 16)) {
        let same = |lane: f64, scalar: f64| lane.to_bits() == scalar.to_bits() || lane.is_nan() && scalar.is_nan();
        for set in InstructionSet::ALL {
            let (s8, c8) = sin_cos_8(set, Lanes::from_fn(|k| xs[k]));
            let (s16, c16) = sin_cos_16(set, Lanes::from_fn(|k| xs[k]));
            for (k, &x) in xs.iter().enumerate() {
                let (s, c) = math::sin_cos(x);
                prop_assert!(same(s16.lane(k), s) && same(c16.lane(k), c), "{set:?} {x}");
                if k < 8 {
                    prop_assert!(same(s8.lane(k), s) && same(c8.lane(k), c), "{set:?} {x}");
                }
            }
        }
    }
}
