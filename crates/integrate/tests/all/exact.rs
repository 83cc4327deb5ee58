//! Steps of both methods against solutions that are known: elliptic functions, polynomials, and the methods' own orders.
#![allow(clippy::unwrap_used, clippy::excessive_precision)]

use crate::known;
use crate::support::{pendulum, run, tolerance};
use kempe_integrate::{Integrator, Method, Stopped, Tolerance, crossing};
use kempe_number::math::{cos, exp, ln, sin};

const BOTH: [Method; 2] = [Method::Explicit, Method::Implicit];

#[test]
fn a_pendulum_is_where_elliptic_functions_say() {
    let start = [-std::f64::consts::FRAC_PI_2, 0.0];
    let asked = [
        (Method::Explicit, 1e-14, 1e-11),
        (Method::Implicit, 1e-11, 5e-10),
    ];
    for ((time, x, y, rate), (method, relative, least)) in
        (known::PENDULUM.iter()).flat_map(|known| asked.map(|asked| (*known, asked)))
    {
        let it = run(
            method,
            &mut pendulum,
            (0.0, time),
            &start,
            tolerance(relative),
        );
        let state = it.state();
        let (own_x, own_y) = (sin(state[0]), -cos(state[0]));
        // the sign of x follows from where the angle is counted
        let off = (own_x - x)
            .abs()
            .min((own_x + x).abs())
            .max((own_y - y).abs());
        assert!(off < least, "{method:?} {time}: {own_x} {own_y}");
        let off = (state[1].abs() - rate.abs()).abs();
        assert!(off < 10.0 * least, "{method:?} {time}: {}", state[1]);
    }
}

#[test]
fn rates_that_depend_on_time_alone_are_integrated() {
    let mut rates = |t, _: &[f64], rates: &mut [f64]| {
        rates[0] = 7.0 * kempe_number::powi(t, 6);
        true
    };
    for (method, relative) in [(Method::Explicit, 1e-10), (Method::Implicit, 1e-11)] {
        let it = run(method, &mut rates, (0.0, 2.0), &[0.0], tolerance(relative));
        let off = it.state()[0] - 128.0;
        assert!(off.abs() < 1e-11, "{method:?}: {off}");
    }
}

#[test]
fn the_error_follows_the_tolerance_and_time_turns_back() {
    let ahead = |method, relative| {
        let it = run(
            method,
            &mut pendulum,
            (0.0, 7.0),
            &[1.2, 0.3],
            tolerance(relative),
        );
        it.state().to_vec()
    };
    let exact = ahead(Method::Explicit, 1e-15);
    for method in BOTH {
        let mut last = f64::INFINITY;
        for digits in [4, 6, 8, 10, 12] {
            let relative = kempe_number::powi(0.1, digits);
            let there = ahead(method, relative);
            let error = (there[0] - exact[0]).abs();
            assert!(
                error < 100.0 * relative && error < last,
                "{method:?} {digits}: {error}"
            );
            last = error.max(1e-12);
            let back = run(
                method,
                &mut pendulum,
                (7.0, 0.0),
                &there,
                tolerance(relative),
            );
            let off = (back.state()[0] - 1.2).abs();
            assert!(off < 200.0 * relative, "{method:?} {digits}: {off}");
        }
    }
}

/// How the largest error at the ends of steps, and between them, falls with the number of steps: its power.
fn orders(method: Method, end: f64, tolerances: [f64; 2]) -> [f64; 2] {
    let mut rates = |t: f64, y: &[f64], r: &mut [f64]| {
        (r[0], r[1]) = (y[1] + 0.1 * cos(t), -y[0] + 0.1 * sin(2.0 * t));
        true
    };
    let reference = 1e-14;
    let [coarse, fine] = tolerances.map(|relative| {
        let mut it = Integrator::with(
            method,
            &mut rates,
            0.0,
            &[1.0, 0.0],
            1.0,
            tolerance(relative),
        )
        .unwrap();
        let mut exact = Integrator::with(
            Method::Explicit,
            &mut rates,
            0.0,
            &[1.0, 0.0],
            1.0,
            tolerance(reference),
        )
        .unwrap();
        let (mut steps, mut ends, mut between) = (0.0, 0.0_f64, 0.0_f64);
        let mut state = [0.0; 2];
        while it.time() < end {
            it.step(&mut rates, end).unwrap();
            steps += 1.0;
            for part in [0.3, 0.5, 0.8, 1.0] {
                let time = it.before() + part * (it.time() - it.before());
                while exact.time() < time {
                    exact.step(&mut rates, time).unwrap();
                }
                assert!(it.between(&mut rates, time, &mut state));
                let off = (state[0] - exact.state()[0]).abs();
                let most = if part == 1.0 { &mut ends } else { &mut between };
                *most = most.max(off);
            }
        }
        [steps, ends, between]
    });
    [1, 2].map(|k| ln(coarse[k] / fine[k]) / ln(fine[0] / coarse[0]))
}

#[test]
fn errors_fall_with_the_order_of_the_method() {
    for (method, end, tolerances, at_ends, between) in [
        (Method::Explicit, 60.0, [1e-5, 1e-10], 8.0, 8.0),
        (Method::Implicit, 10.0, [1e-5, 1e-9], 5.0, 4.0),
    ] {
        let [ends, inside] = orders(method, end, tolerances);
        assert!((ends - at_ends).abs() < 0.9, "{method:?}: {ends}");
        assert!((inside - between).abs() < 0.9, "{method:?}: {inside}");
    }
}

#[test]
fn between_the_ends_of_a_step_the_solution_is_as_good() {
    let mut rates = |t: f64, y: &[f64], r: &mut [f64]| {
        r[0] = -y[0] + sin(t);
        true
    };
    // y = (3 exp(-t) + sin t - cos t) / 2
    let exact = |t: f64| 0.5 * (3.0 * exp(-t) + sin(t) - cos(t));
    for method in BOTH {
        let mut it =
            Integrator::with(method, &mut rates, 0.0, &[1.0], 1.0, tolerance(1e-10)).unwrap();
        let mut state = [0.0];
        while it.time() < 20.0 {
            it.step(&mut rates, 20.0).unwrap();
            let (a, b) = (it.before(), it.time());
            for k in 0..=10 {
                let t = a + (b - a) * f64::from(k) / 10.0;
                assert!(it.between(&mut rates, t, &mut state));
                let off = state[0] - exact(t);
                assert!(off.abs() < 3e-9, "{method:?} {t}: {off}");
            }
            assert_eq!(it.state(), &state, "the end itself");
        }
        let here = it.state()[0];
        assert!((it.rates()[0] - (sin(20.0) - here)).abs() < 1e-15);
    }
}

#[test]
fn a_pendulum_keeps_its_energy() {
    let energy = |y: &[f64]| 0.5 * y[1] * y[1] - 9.81 * cos(y[0]);
    let start = [2.0, 0.0];
    for (method, relative, least) in [
        (Method::Explicit, 1e-12, 1e-9),
        (Method::Implicit, 1e-10, 1e-9),
        (Method::Choose, 1e-12, 1e-9),
    ] {
        let it = run(
            method,
            &mut pendulum,
            (0.0, 60.0),
            &start,
            tolerance(relative),
        );
        let off = energy(it.state()) - energy(&start);
        assert!(off.abs() < least, "{method:?}: {off}");
    }
}

#[test]
fn a_ball_bounces_when_it_should() {
    // From a height, with restitution: impact n at sqrt(2 h / g) (1 + 2 (e + ... + e^(n - 1))).
    let (height, gravity, restitution) = (0.7, 9.81, 0.8);
    let mut fall = |_: f64, y: &[f64], r: &mut [f64]| {
        (r[0], r[1]) = (y[1], -gravity);
        true
    };
    let first = (2.0 * height / gravity).sqrt();
    for method in [Method::Explicit, Method::Implicit, Method::Choose] {
        let start = [height, 0.0];
        let mut it =
            Integrator::with(method, &mut fall, 0.0, &start, 1.0, tolerance(1e-10)).unwrap();
        let mut state = [0.0; 2];
        let (mut sum, mut power) = (1.0, 1.0);
        for impact in 0..6 {
            let time = loop {
                it.step(&mut fall, 100.0).unwrap();
                let (before, now) = (it.before(), it.time());
                let mut y = [0.0; 2];
                let height_at = |t| {
                    it.between(&mut fall, t, &mut y);
                    // It starts on the ground: what is there is not the next impact.
                    if t == before { 1.0 } else { y[0] }
                };
                if let Some(time) = crossing(height_at, before, now) {
                    break time;
                }
            };
            assert!(
                (time - first * sum).abs() < 1e-12,
                "{method:?} {impact}: {time}"
            );
            assert!(it.between(&mut fall, time, &mut state));
            assert!(it.restart(&mut fall, time, &[0.0, -restitution * state[1]]));
            power *= restitution;
            sum += 2.0 * power;
        }
    }
}

#[test]
fn what_cannot_be_followed_stops_where_it_is() {
    // y' = y^2 runs away at t = 1
    let mut rates = |_: f64, y: &[f64], r: &mut [f64]| {
        r[0] = y[0] * y[0];
        true
    };
    // no rates beyond 3: a wall
    let mut wall = |t: f64, _: &[f64], r: &mut [f64]| {
        r[0] = 1.0;
        t <= 3.0
    };
    let mut none = |_: f64, _: &[f64], _: &mut [f64]| false;
    for method in [Method::Explicit, Method::Implicit, Method::Choose] {
        let mut it =
            Integrator::with(method, &mut rates, 0.0, &[1.0], 1.0, tolerance(1e-10)).unwrap();
        let stopped = (0..100_000).find_map(|_| it.step(&mut rates, 2.0).err());
        assert!(
            stopped.is_some() && it.time() <= 1.0 + 1e-9 && it.time() > 0.999,
            "{method:?} {}",
            it.time()
        );
        assert!(it.state()[0].is_finite());
        let mut it =
            Integrator::with(method, &mut wall, 0.0, &[0.0], 1.0, tolerance(1e-8)).unwrap();
        let stopped = (0..10_000).find_map(|_| it.step(&mut wall, 5.0).err());
        assert_eq!(stopped, Some(Stopped::NoRates), "{method:?}");
        assert!(
            (it.time() - 3.0).abs() < 1e-12 && it.time() <= 3.0,
            "{method:?} {}",
            it.time()
        );
        assert!(Integrator::with(method, &mut none, 0.0, &[0.0], 1.0, tolerance(1e-8)).is_none());
        assert!(Integrator::with(method, &mut none, 0.0, &[], 1.0, tolerance(1e-8)).is_none());
    }
}

#[test]
fn many_short_steps_lose_nothing() {
    let mut rates = |_: f64, _: &[f64], r: &mut [f64]| {
        r[0] = 0.1;
        true
    };
    let start = 1e6;
    for method in BOTH {
        let mut it =
            Integrator::with(method, &mut rates, 0.0, &[start], 1.0, tolerance(1e-8)).unwrap();
        for k in 1..=20_000 {
            let end = f64::from(k) * 1e-4;
            while it.time() < end {
                it.step(&mut rates, end).unwrap();
            }
        }
        let off = it.state()[0] - (start + 0.2);
        assert!(off.abs() < 3e-10, "{method:?}: {off}");
    }
}

#[test]
fn a_state_at_the_edge_of_where_rates_are_is_followed() {
    let mut rates = |_: f64, y: &[f64], r: &mut [f64]| {
        (r[0], r[1]) = (1.0 - y[0], y[0] - y[1]);
        y[0] <= 1.0
    };
    for method in BOTH {
        let it = run(method, &mut rates, (0.0, 2.0), &[1.0, 0.0], tolerance(1e-8));
        let known = 1.0 - exp(-2.0);
        assert!((it.state()[1] - known).abs() < 1e-7, "{method:?}");
    }
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

#[test]
fn what_goes_as_time_goes_stays_with_it() {
    // Late, so that the ends of steps are rounded by far more than what a step adds; something that swings keeps them short.
    let start = 1e6;
    let mut rates = |t: f64, y: &[f64], r: &mut [f64]| {
        (r[0], r[1]) = (1.0, -50.0 * (y[1] - sin(37.0 * t)));
        true
    };
    for method in BOTH {
        let tolerance = Tolerance {
            relative: 1e-10,
            absolute: vec![1e-10],
        };
        let it = run(
            method,
            &mut rates,
            (start, start + 50.0),
            &[start, 0.0],
            tolerance,
        );
        let off = it.state()[0] - it.time();
        assert!(
            off.abs() <= 2.0 * f64::EPSILON * start,
            "{method:?}: {off} off, {:?}",
            it.used()
        );
    }
}

#[test]
fn an_error_that_is_no_number_is_no_good_step() {
    // Rates that jump by so much that the squares of errors are not finite.
    let mut jump = |t: f64, _: &[f64], r: &mut [f64]| {
        r[0] = if t > 0.5 { 1e160 * sin(1e3 * t) } else { 1.0 };
        true
    };
    for method in BOTH {
        let tolerance = Tolerance {
            relative: 0.0,
            absolute: vec![1e-9],
        };
        let mut it = Integrator::with(method, &mut jump, 0.0, &[0.0], 1.0, tolerance).unwrap();
        while it.step(&mut jump, 1.0).is_ok() {
            assert!(it.time() < 1.0, "{method:?} {:?}", it.state());
        }
        assert!((it.time() - 0.5).abs() < 1e-12, "{method:?} {}", it.time());
        assert!((it.state()[0] - 0.5).abs() < 1e-9, "{method:?}");
    }
}

#[test]
fn a_component_that_stays_zero_needs_no_tolerance_of_its_own() {
    let mut rates = |_: f64, y: &[f64], r: &mut [f64]| {
        (r[0], r[1], r[2]) = (-y[0], y[0] - y[1], 0.0);
        true
    };
    for method in BOTH {
        let tolerance = Tolerance {
            relative: 1e-9,
            absolute: vec![0.0],
        };
        let it = run(method, &mut rates, (0.0, 10.0), &[1.0, 0.5, 0.0], tolerance);
        let off = it.state()[1] / (10.5 * exp(-10.0)) - 1.0;
        assert!(off.abs() < 1e-7, "{method:?}: {off}");
        assert_eq!(it.state()[2], 0.0);
    }
}

#[test]
fn a_component_that_may_be_anything_is_asked_for_finite_states_only() {
    // The second component is nobody's concern and acts on the first.
    for method in BOTH {
        let mut unknown = 0;
        let mut rates = |_: f64, y: &[f64], r: &mut [f64]| {
            unknown += usize::from(!y.iter().all(|y| y.is_finite()));
            (r[0], r[1]) = (-y[0] - 1e-3 * y[1], y[0]);
            true
        };
        let tolerance = Tolerance {
            relative: 1e-9,
            absolute: vec![1e-9, f64::INFINITY],
        };
        let mut it =
            Integrator::with(method, &mut rates, 0.0, &[1.0, 0.0], 1.0, tolerance).unwrap();
        while it.time() < 1.0 {
            it.step(&mut rates, 1.0).unwrap();
        }
        // y" + y' + 0.001 y = 0
        let root = (0.25 - 1e-3_f64).sqrt();
        let (slow, fast) = (root - 0.5, -root - 0.5);
        let known = (slow * exp(slow) - fast * exp(fast)) / (slow - fast);
        let off = it.state()[0] - known;
        assert!(off.abs() < 1e-8, "{method:?}: {off}");
        assert_eq!(unknown, 0, "{method:?}");
    }
}

/// A step that would end a rounding before the end goes there: what is left is no step, and nobody integrates it.
#[test]
fn nothing_is_left_between_the_last_step_and_the_end() {
    for method in BOTH {
        // Steps of a hundred times the blind first one, 1e-6, end beside these ends by a rounding or not at all.
        for end in [1e-4, 2e-4, 3e-4, 1e-3] {
            let mut rates = |_: f64, y: &[f64], r: &mut [f64]| {
                (r[0], r[1]) = (y[1], -9.81);
                true
            };
            let tolerance = Tolerance {
                relative: 1e-13,
                absolute: vec![1e-13, 1e-13],
            };
            let start = [0.0, 0.0];
            let mut it = Integrator::with(method, &mut rates, 0.0, &start, 1.0, tolerance).unwrap();
            while it.time() < end {
                let before = it.time();
                it.step(&mut rates, end).unwrap();
                assert!(it.time() - before > 1e-10, "{method:?} {end}: {before:e}");
                assert_eq!(it.before(), before, "{method:?} {end}");
            }
            assert!((it.state()[0] + 0.5 * 9.81 * end * end).abs() < 1e-18);
        }
    }
}
