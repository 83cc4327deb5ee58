//! Steps against solutions that are known: elliptic functions, polynomials, and the method's own order.
#![allow(clippy::unwrap_used, clippy::excessive_precision)]

use kempe_integrate::{Dop853, Stopped, Tolerance, crossing};
use kempe_number::math::{exp, sin};

fn tolerance(relative: f64) -> Tolerance {
    Tolerance {
        relative,
        absolute: vec![relative],
    }
}

fn run(
    mut rates: impl FnMut(f64, &[f64], &mut [f64]) -> bool,
    from: f64,
    state: &[f64],
    to: f64,
    relative: f64,
) -> (Vec<f64>, usize) {
    let mut it = Dop853::new(&mut rates, from, state, to - from, tolerance(relative)).unwrap();
    while it.time() != to {
        it.step(&mut rates, to).unwrap();
    }
    (it.state().to_vec(), it.evaluations())
}

/// The library's simple pendulum: 1 kg on 1 m, 9.81 m/s^2, from rest at x = -1 m.
fn pendulum(_: f64, y: &[f64], rates: &mut [f64]) -> bool {
    rates[0] = y[1];
    rates[1] = -9.81 * sin(y[0]);
    true
}

#[test]
fn a_pendulum_is_where_elliptic_functions_say() {
    let start = [-std::f64::consts::FRAC_PI_2, 0.0];
    // t, x, y and rate of Jacobi's functions, from 40 digits
    let known: [(f64, f64, f64, f64); 3] = [
        (
            1.0,
            0.98629175113187531936,
            -0.16501085312554116875,
            -1.79930901690707862,
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
    for (time, x, y, rate) in known {
        let (state, _) = run(pendulum, 0.0, &start, time, 1e-14);
        let (own_x, own_y) = (sin(state[0]), -kempe_number::math::cos(state[0]));
        // the sign of x follows from where the angle is counted
        let off = (own_x - x)
            .abs()
            .min((own_x + x).abs())
            .max((own_y - y).abs());
        assert!(off < 1e-11, "{time}: {own_x} {own_y}");
        assert!(
            (state[1].abs() - rate.abs()).abs() < 1e-10,
            "{time}: {}",
            state[1]
        );
    }
}

#[test]
fn rates_that_depend_on_time_alone_are_integrated() {
    let (state, _) = run(
        |t, _: &[f64], rates: &mut [f64]| {
            rates[0] = 7.0 * kempe_number::powi(t, 6);
            true
        },
        0.0,
        &[0.0],
        2.0,
        1e-10,
    );
    assert!((state[0] - 128.0).abs() < 1e-12, "{}", state[0]);
}

#[test]
fn the_error_follows_the_tolerance_and_time_turns_back() {
    let mut last = f64::INFINITY;
    for digits in [4, 6, 8, 10, 12] {
        let relative = kempe_number::powi(0.1, digits);
        let (there, _) = run(pendulum, 0.0, &[1.2, 0.3], 7.0, relative);
        let (exact, _) = run(pendulum, 0.0, &[1.2, 0.3], 7.0, 1e-15);
        let error = (there[0] - exact[0]).abs();
        assert!(
            error < 100.0 * relative && error < last,
            "{digits}: {error}"
        );
        last = error.max(1e-13);
        let (back, _) = run(pendulum, 7.0, &there, 0.0, relative);
        assert!(
            (back[0] - 1.2).abs() < 200.0 * relative,
            "{digits}: {}",
            back[0]
        );
    }
}

#[test]
fn between_the_ends_of_a_step_the_solution_is_as_good() {
    let mut rates = |t: f64, y: &[f64], r: &mut [f64]| {
        r[0] = -y[0] + sin(t);
        true
    };
    // y = (3 exp(-t) + sin t - cos t) / 2
    let exact = |t: f64| 0.5 * (3.0 * exp(-t) + sin(t) - kempe_number::math::cos(t));
    let mut it = Dop853::new(&mut rates, 0.0, &[1.0], 1.0, tolerance(1e-10)).unwrap();
    let mut state = [0.0];
    while it.time() < 20.0 {
        it.step(&mut rates, 20.0).unwrap();
        let (a, b) = (it.before(), it.time());
        for k in 0..=10 {
            let t = a + (b - a) * f64::from(k) / 10.0;
            assert!(it.between(&mut rates, t, &mut state));
            assert!(
                (state[0] - exact(t)).abs() < 3e-9,
                "{t}: {}",
                state[0] - exact(t)
            );
        }
        assert_eq!(it.state(), &state, "the end itself");
    }
    let here = it.state()[0];
    assert!((it.rates()[0] - (sin(20.0) - here)).abs() < 1e-15);
}

#[test]
fn what_cannot_be_followed_stops_where_it_is() {
    // y' = y^2 runs away at t = 1
    let mut rates = |_: f64, y: &[f64], r: &mut [f64]| {
        r[0] = y[0] * y[0];
        true
    };
    let mut it = Dop853::new(&mut rates, 0.0, &[1.0], 1.0, tolerance(1e-10)).unwrap();
    let stopped = (0..100_000).find_map(|_| it.step(&mut rates, 2.0).err());
    assert!(
        stopped.is_some() && it.time() <= 1.0 + 1e-9 && it.time() > 0.999,
        "{}",
        it.time()
    );
    assert!(it.state()[0].is_finite());
    // no rates beyond 3: a wall
    let mut wall = |t: f64, _: &[f64], r: &mut [f64]| {
        r[0] = 1.0;
        t <= 3.0
    };
    let mut it = Dop853::new(&mut wall, 0.0, &[0.0], 1.0, tolerance(1e-8)).unwrap();
    let stopped = (0..10_000).find_map(|_| it.step(&mut wall, 5.0).err());
    assert_eq!(stopped, Some(Stopped::NoRates));
    assert!(
        (it.time() - 3.0).abs() < 1e-12 && it.time() <= 3.0,
        "{}",
        it.time()
    );
    let mut none = |_: f64, _: &[f64], _: &mut [f64]| false;
    assert!(Dop853::new(&mut none, 0.0, &[0.0], 1.0, tolerance(1e-8)).is_none());
}

#[test]
fn crossings_are_found_to_rounding() {
    let root = crossing(|t| t * t - 2.0, 0.0, 2.0).unwrap();
    assert!((root - 2.0_f64.sqrt()).abs() <= 4.0 * f64::EPSILON);
    assert!(root * root >= 2.0, "on the far side");
    let steep = crossing(|t| if t < 0.3 { -1e-300 } else { 1.0 }, 0.0, 1.0).unwrap();
    assert!((steep - 0.3).abs() < 1e-15);
    let flat = crossing(|t| kempe_number::powi(t - 0.7, 9), 0.0, 1.0).unwrap();
    assert!((flat - 0.7).abs() < 1e-12, "{flat}");
    assert_eq!(crossing(|t| t + 1.0, 0.0, 1.0), None);
}
