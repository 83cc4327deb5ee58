//! Friction laws at the speeds where their definitions can be read off.
#![allow(clippy::unwrap_used)]

use kempe_contact::{Friction, Onset, Unfit};
use kempe_integrate::{Integrator, Tolerance};
use kempe_number::math::{atanh, exp, tanh};
use kempe_number::{Dual, Interval, Number};

const NORMAL: f64 = 50.0;

#[test]
fn each_law_is_its_definition() {
    let at = |law: Friction<f64>, v: f64| -law.force(v, NORMAL) / NORMAL;
    let coulomb = Friction::coulomb(0.3);
    assert_eq!(
        [at(coulomb, 1e-9), at(coulomb, -2.0), at(coulomb, 0.0)],
        [0.3, -0.3, 0.0]
    );
    let ambrosio = Friction::ambrosio(0.3, 1e-3, 1e-2);
    assert_eq!(at(ambrosio, 1e-3), 0.0);
    assert_eq!(at(ambrosio, -5e-4), 0.0);
    assert!((at(ambrosio, 5.5e-3) - 0.15).abs() < 1e-15);
    assert!((at(ambrosio, -5.5e-3) + 0.15).abs() < 1e-15);
    assert_eq!(at(ambrosio, 7.0), 0.3);
    let threlfall = Friction::threlfall(0.3, 0.1);
    assert!((at(threlfall, 0.05) - 0.3 * (1.0 - exp(-1.5)) / 0.95).abs() < 1e-4);
    assert_eq!(at(threlfall, 0.2), 0.3);
    assert!((at(threlfall, 0.1 - 1e-9) - 0.3).abs() < 1e-8, "no jump");
    assert_eq!(at(threlfall, 0.0), 0.0);
    let smooth = Friction::tanh(0.3, 0.1);
    for v in [-3.0, -0.05, 0.0, 1e-6, 0.1, 40.0] {
        assert!((at(smooth, v) - 0.3 * tanh(v / 0.1)).abs() < 1e-16, "{v}");
    }
    let stribeck = Friction::stribeck(0.2, 0.5, 0.1, 3.0);
    let known = (0.2 + 0.3 * exp(-4.0)) + 3.0 * 0.2 / NORMAL;
    assert!((at(stribeck, 0.2) - known).abs() < 1e-15);
    assert!((at(stribeck, -0.2) + known).abs() < 1e-15);
    let soft = stribeck.with(Onset::Tanh(1e-3));
    assert!((at(soft, 0.2) - known).abs() < 1e-15);
    assert_eq!(at(Friction::none(), 3.0), 0.0);
}

#[test]
fn friction_takes_power_and_needs_something_that_presses() {
    let laws = [
        Friction::coulomb(0.4),
        Friction::ambrosio(0.4, 1e-3, 1e-2),
        Friction::threlfall(0.4, 1e-2),
        Friction::tanh(0.4, 1e-2),
        Friction::stribeck(0.2, 0.4, 0.1, 5.0),
    ];
    for law in laws {
        let law = law.checked().unwrap();
        for k in -40..=40 {
            let v = f64::from(k) * 7e-4;
            assert!(law.force(v, NORMAL) * v <= 0.0, "{law:?} {v}");
            assert_eq!(law.force(v, NORMAL), -law.force(-v, NORMAL));
            assert_eq!(law.force(v, 0.0), 0.0);
        }
    }
}

#[test]
fn a_block_that_should_stick_creeps_and_is_followed_with_few_steps() {
    // Slides to rest on the ground and is then drawn with less than what friction can hold.
    let (mass, drawn, speed) = (2.0, 3.0, 1e-6);
    let law = Friction::tanh(0.3, speed);
    let weight = 9.81 * mass;
    let mut system = |_: f64, y: &[f64], r: &mut [f64]| {
        r[0] = y[1];
        r[1] = (drawn + law.force(y[1], weight)) / mass;
        true
    };
    let tolerance = Tolerance {
        relative: 1e-6,
        absolute: vec![1e-9, 1e-9],
    };
    let mut it = Integrator::new(&mut system, 0.0, &[0.0, 1.0], 1.0, tolerance).unwrap();
    while it.time() < 10.0 {
        it.step(&mut system, 10.0).unwrap();
    }
    let creep = speed * atanh(drawn / (0.3 * weight));
    assert!(
        (it.state()[1] / creep - 1.0).abs() < 1e-3,
        "{:?}",
        it.state()
    );
    // Until then a fall in speed that friction less the drawing force gives.
    let way = 0.5 * mass / (0.3 * weight - drawn);
    assert!((it.state()[0] - way).abs() < 2e-5, "{:?}", it.state());
    assert!(
        it.used().implicit > 0 && it.evaluations() < 2000,
        "{}",
        it.evaluations()
    );
}

#[test]
fn laws_run_on_derivatives_and_bounds() {
    type D = Dual<f64, 1>;
    let rich = |law: fn(f64) -> Friction<f64>, v: f64| {
        let slope = (law(0.4).force(v + 1e-7, NORMAL) - law(0.4).force(v - 1e-7, NORMAL)) / 2e-7;
        (law, slope)
    };
    let (_, slope) = rich(|mu| Friction::tanh(mu, 0.1), 0.03);
    let own = Friction::tanh(D::from_f64(0.4), D::from_f64(0.1))
        .force(D::variable(0.03, 0), D::from_f64(NORMAL));
    assert!((own.eps[0] / slope - 1.0).abs() < 1e-6);
    let at_rest = Friction::tanh(D::from_f64(0.4), D::from_f64(0.1))
        .force(D::variable(0.0, 0), D::from_f64(NORMAL));
    assert!((at_rest.eps[0] + 0.4 * NORMAL / 0.1).abs() < 1e-12);
    // Sliding either way: both signs.
    let either = Friction::coulomb(Interval::from_f64(0.4))
        .force(Interval::new(-1.0, 1.0), Interval::from_f64(NORMAL));
    assert!(either.lo() <= -20.0 && either.hi() >= 20.0);
}

#[test]
fn what_is_no_friction_is_refused() {
    let refused = |law: Friction<f64>| law.checked().unwrap_err();
    assert_eq!(
        refused(Friction::coulomb(-0.1)).to_string(),
        "the coefficient of friction is -0.1; it must be finite and not negative"
    );
    assert_eq!(
        refused(Friction::ambrosio(0.1, 0.02, 0.01)),
        Unfit::Onset {
            from: 0.02,
            to: 0.01
        }
    );
    assert!(matches!(
        refused(Friction::tanh(0.1, 0.0)),
        Unfit::NotPositive { .. }
    ));
    assert!(matches!(
        refused(Friction::stribeck(0.1, f64::NAN, 0.1, 0.0)),
        Unfit::Negative { .. }
    ));
}
