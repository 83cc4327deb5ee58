//! Series against closed forms, against each other, and against duals.

use std::f64::consts::PI;

use kempe_number::{Dual, Jet, Lanes, Number, math};
use proptest::prelude::*;

type J = Jet<f64, 8>;

/// A formula with every function in it, smooth where x is within 1 of zero.
fn formula<T: Number>(x: T) -> T {
    let (s, c) = (x * 0.7 + 0.2).sin_cos();
    let root = (x.square() + 1.5 - s * 0.3).sqrt();
    let angle = (s + 0.4 * 0.1).atan2(c * 2.0 - x);
    (root / (c + 3.0)).exp() * angle + (x + 2.5).ln() - (x - 5.0).abs() * 0.01
}

fn near(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance * (1.0 + a.abs().max(b.abs()))
}

fn assert_near(a: &J, b: &J, tolerance: f64) {
    for k in 0..8 {
        let (x, y) = (a.coefficient(k), b.coefficient(k));
        assert!(near(x, y, tolerance), "coefficient {k}: {x} and {y}");
    }
}

#[test]
fn known_series_at_zero() {
    let x = J::variable(0.0);
    let geometric = J::one() / (-x + 1.0);
    assert_eq!(geometric.coefficients(), &[1.0; 8]);
    let exp = x.exp();
    assert!((0..8).all(|k| near(exp.derivative(k), 1.0, 1e-15)));
    let (s, c) = x.sin_cos();
    let expected = [0.0, 1.0, 0.0, -1.0];
    assert!((0..8).all(|k| near(s.derivative(k), expected[k % 4], 1e-15)));
    assert!((0..8).all(|k| near(c.derivative(k), expected[(k + 1) % 4], 1e-15)));
    let ln = (x + 1.0).ln();
    assert!((1..8).all(|k| near(
        ln.coefficient(k),
        if k % 2 == 1 { 1.0 } else { -1.0 } / k as f64,
        1e-15
    )));
    let root = (x + 1.0).sqrt();
    assert_eq!(
        root.coefficients()[..5],
        [1.0, 0.5, -0.125, 0.0625, -0.0390625]
    );
}

#[test]
fn arctangent_series_at_zero() {
    let angle = J::variable(0.0).atan2(J::one());
    let expected = [0.0, 1.0, 0.0, -1.0 / 3.0, 0.0, 0.2, 0.0, -1.0 / 7.0];
    assert!((0..8).all(|k| near(angle.coefficient(k), expected[k], 1e-15)));
}

#[test]
fn kinks_take_the_side_of_the_value() {
    let x = J::variable(-2.0);
    assert_eq!(x.abs(), -x);
    assert_eq!(x.min(J::constant(1.0)), x);
    assert_eq!(x.max(J::constant(1.0)), J::constant(1.0));
    // Lane by lane, not by the first lane.
    let x = Jet::<Lanes<2>, 2>::variable(Lanes([-3.0, 5.0]));
    let a = x.abs();
    assert_eq!(
        (a.coefficient(0), a.coefficient(1)),
        (Lanes([3.0, 5.0]), Lanes([-1.0, 1.0]))
    );
    let m = x.min(Jet::constant(Lanes([0.0, 0.0])));
    assert_eq!(
        (m.coefficient(0), m.coefficient(1)),
        (Lanes([-3.0, 0.0]), Lanes([1.0, 0.0]))
    );
}

#[test]
fn a_single_coefficient_is_the_plain_number() {
    let y = formula(Jet::<f64, 1>::variable(0.3));
    assert_eq!(y.derivative(0), formula(0.3));
}

#[test]
fn derivatives_differentiate_and_integrate() {
    let q = J::from_derivatives([0.5, 2.0, -3.0, 4.0, 0.0, 0.0, 0.0, 7.0]);
    assert_eq!(
        (q.derivative(2), q.coefficient(3), q.derivative(7)),
        (-3.0, 4.0 / 6.0, 7.0)
    );
    assert_eq!(q.differentiate().derivative(1), -3.0);
    assert_near(&q.differentiate().integrate(0.5), &q, 1e-15);
}

#[test]
fn dimensions_derive_accelerations() {
    // x = r cos(w t): the acceleration at t is -r w^2 cos(w t); its derivatives to r and w are exact.
    let (r, w, t) = (1.5, 2.0, 0.4);
    let radius = Jet::<Dual<f64, 2>, 4>::constant(Dual::variable(r, 0));
    let speed = Jet::constant(Dual::variable(w, 1));
    let x = radius * (Jet::variable(Dual::constant(t)) * speed).sin_cos().1;
    let a = x.derivative(2);
    let (s, c) = math::sin_cos(w * t);
    assert!(near(a.re, -r * w * w * c, 1e-14));
    assert!(near(a.eps[0], -w * w * c, 1e-14));
    assert!(near(a.eps[1], -2.0 * r * w * c + r * w * w * t * s, 1e-14));
}

#[test]
fn nested_duals_give_the_second_derivative() {
    for x in [-0.7, 0.0, 0.9] {
        let series = formula(Jet::<f64, 3>::variable(x));
        let mut inner = Dual::<Dual<f64, 1>, 4>::variable(Dual::variable(x, 0), 2);
        inner.eps[2] = Dual::constant(1.0);
        let nested = formula(inner);
        assert!(near(nested.re.re, series.derivative(0), 1e-13));
        assert!(near(nested.eps[2].re, series.derivative(1), 1e-13));
        assert!(near(nested.re.eps[0], series.derivative(1), 1e-13));
        assert!(near(nested.eps[2].eps[0], series.derivative(2), 1e-13));
        assert_eq!(nested.eps[0], Dual::constant(0.0));
    }
}

/// A series with a value in the range, and coefficients up to 2.
fn series(value: std::ops::Range<f64>) -> impl Strategy<Value = J> {
    (value, prop::array::uniform7(-2.0..2.0)).prop_map(|(c0, rest)| {
        J::from_coefficients(std::array::from_fn(
            |k| if k == 0 { c0 } else { rest[k - 1] },
        ))
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn products_and_quotients_invert(a in series(-3.0..3.0), b in series(1.0..3.0)) {
        // Quotient coefficients grow by up to a factor 3 per order.
        assert_near(&(a / b * b), &a, 1e-9);
        assert_near(&a.square(), &(a * a), 1e-13);
        assert_near(&b.sqrt().square(), &b, 1e-9);
    }

    #[test]
    fn exp_and_ln_invert(a in series(-1.0..1.0)) {
        assert_near(&a.exp().ln(), &a, 1e-9);
    }

    #[test]
    fn the_angle_of_a_rotating_vector_is_its_argument(a in series(-3.1..3.1), length in series(1.0..3.0)) {
        let (s, c) = a.sin_cos();
        assert_near(&(length * s).atan2(length * c), &a, 1e-8);
        assert_near(&(s.square() + c.square()), &J::one(), 1e-9);
    }

    #[test]
    fn sine_derives_to_cosine(a in series(-10.0..10.0)) {
        let (s, c) = a.sin_cos();
        let (left, right) = (s.differentiate(), c * a.differentiate());
        for k in 0..7 {
            prop_assert!(near(left.coefficient(k), right.coefficient(k), 1e-11));
        }
    }

    #[test]
    fn substitution_is_evaluation_of_the_series(a in series(-0.5..0.5)) {
        let outer = formula(J::variable(a.value()));
        assert_near(&outer.compose(&a), &formula(a), 1e-9);
    }

    #[test]
    fn a_step_follows_the_function(x in -0.5..0.5, h in -0.02..0.02) {
        let y = formula(Jet::<f64, 8>::variable(x)).evaluate(h);
        prop_assert!(near(y, formula(x + h), 1e-12), "{y} {}", formula(x + h));
    }

    #[test]
    fn duals_agree_with_series(x in -1.0..1.0) {
        let (dual, series) = (formula(Dual::<f64, 3>::variable(x, 1)), formula(Jet::<f64, 4>::variable(x)));
        prop_assert!(near(dual.re, series.derivative(0), 1e-15));
        prop_assert!(near(dual.eps[1], series.derivative(1), 1e-13));
        prop_assert_eq!(dual.eps[0], 0.0);
    }

    #[test]
    fn duals_agree_with_central_differences(x in -1.0..1.0) {
        let h = 1e-5;
        let slope = (formula(x + h) - formula(x - h)) / (2.0 * h);
        prop_assert!(near(formula(Dual::<f64, 1>::variable(x, 0)).eps[0], slope, 1e-8));
    }

    #[test]
    fn lanes_have_the_bits_of_the_scalar_formula(xs in prop::array::uniform8(-1.0..1.0)) {
        let lanes = formula(Jet::<Lanes<8>, 4>::variable(Lanes(xs)));
        for (k, &x) in xs.iter().enumerate() {
            let scalar = formula(Jet::<f64, 4>::variable(x));
            for order in 0..4 {
                let (a, b) = (lanes.coefficient(order).lane(k), scalar.coefficient(order));
                prop_assert_eq!(a.to_bits(), b.to_bits());
            }
        }
    }
}

#[test]
fn a_half_turn_keeps_the_derivatives_across_the_cut() {
    let t = J::variable(PI);
    let (s, c) = t.sin_cos();
    let angle = s.atan2(c);
    assert!(near(angle.derivative(0), PI, 1e-15) && near(angle.derivative(1), 1.0, 1e-15));
    assert!((2..8).all(|k| angle.coefficient(k).abs() < 1e-14));
}

/// At a limit of a motion the value is known and the rates are not.
#[test]
fn composition_keeps_a_known_value_beside_unknown_rates() {
    let outer = Jet::<f64, 3>::from_coefficients([2.5, f64::NAN, f64::NAN]);
    let inner = Jet::<f64, 3>::variable(1.0);
    let composed = outer.compose(&inner);
    assert_eq!(composed.coefficient(0), 2.5);
    assert!(composed.coefficient(1).is_nan());
}
