//! Stiff systems of the literature, whose solutions are known, and the choice between the methods.
#![allow(clippy::unwrap_used, clippy::excessive_precision)]

use crate::support::{
    e5, hires, hydraulic_arm, off, pendulum, robertson, run, tolerance, van_der_pol,
};
use kempe_integrate::{Integrator, Method, System, Tolerance};
use kempe_number::math::{cos, ln, sin};

const STIFF: [Method; 2] = [Method::Implicit, Method::Choose];

/// Follows a system from 0 with both ways to stiff steps, at two tolerances: the error falls, and is below the second.
fn follow<S: System>(
    system: impl Fn() -> S,
    end: f64,
    start: &[f64],
    absolute: f64,
    known: &[f64],
    [coarse, fine]: [f64; 2],
) {
    for method in STIFF {
        let error = |relative: f64| {
            let tolerance = Tolerance {
                relative,
                absolute: vec![relative * absolute],
            };
            let it = run(method, &mut system(), (0.0, end), start, tolerance);
            assert!(it.used().implicit > 0);
            off(it.state(), known)
        };
        let (rough, good) = (error(coarse), error(fine));
        assert!(rough < 30.0 * coarse, "{method:?}: {rough} at {coarse}");
        assert!(good < fine && good < rough, "{method:?}: {good} at {fine}");
    }
}

#[test]
fn van_der_pol_of_parameter_1000() {
    // IVP test set (Mazzia, Magherini, "Test set for initial value problem solvers", 2008), with time counted in slow units;
    // another program agrees to 13 digits.
    let known = [1.706167732170483, -0.8928097010247975];
    follow(
        || van_der_pol(1e6),
        2.0,
        &[2.0, 0.0],
        1.0,
        &known,
        [1e-5, 1e-8],
    );
}

#[test]
fn van_der_pol_of_parameter_a_million() {
    // Along the slow curve ln y - y^2/2 falls with time; one period is 3 - 2 ln 2 + 7.01432 mu^(-4/3) - 22/9 ln mu / mu^2
    // (A. A. Dorodnitsyn, 1947).
    let mu = 1e6;
    let period = 3.0 - 2.0 * ln(2.0) + 7.01432 * 1e-8 - 22.0 / 9.0 * ln(mu) / (mu * mu);
    let level = ln(2.0) - 2.0 + (2.0 - period);
    let y = kempe_integrate::crossing(|y| ln(y) - 0.5 * y * y - level, 1.1, 2.0).unwrap();
    let known = [y, y / (1.0 - y * y)];
    follow(
        || van_der_pol(mu * mu),
        2.0,
        &[2.0, -2.0 / 3.0],
        1.0,
        &known,
        [1e-5, 1e-8],
    );
}

#[test]
fn robertson_early_and_late() {
    // 40: computed again with another program at 1e-12. 1e11: IVP test set.
    let known = [0.7158270687193941, 9.185534764557838e-6, 0.2841637457458297];
    let start = [1.0, 0.0, 0.0];
    follow(|| robertson, 40.0, &start, 1e-6, &known, [1e-4, 1e-7]);
    let late = [
        2.083340149701255e-8,
        8.333360770334713e-14,
        0.9999999791665050,
    ];
    follow(|| robertson, 1e11, &start, 1e-10, &late, [1e-4, 1e-7]);
}

#[test]
fn hires_of_eight_reactions() {
    // IVP test set; computed again with another program at 1e-12.
    let known = [
        7.371312573325668e-4,
        1.442485726316185e-4,
        5.888729740967575e-5,
        1.175651343283149e-3,
        2.386356198831331e-3,
        6.238968252742796e-3,
        2.849998395185769e-3,
        2.850001604814231e-3,
    ];
    let start = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0057];
    follow(|| hires, 321.8122, &start, 1e-4, &known, [1e-5, 1e-8]);
}

#[test]
fn e5_over_sixteen_powers_of_ten() {
    // Computed with another program at 1e-10 and 1e-12.
    let known = [
        7.48132082e-6,
        2.373478155e-12,
        2.2123586692e-12,
        1.6111948715e-13,
    ];
    follow(
        || e5,
        1e5,
        &[1.76e-3, 0.0, 0.0, 0.0],
        1e-18,
        &known,
        [1e-5, 1e-8],
    );
}

#[test]
fn a_hydraulic_cylinder_lifts_an_arm() {
    // Found with two other programs at 1e-11.
    let known = [
        (
            0.1,
            [
                0.00231686757313,
                0.0438758808922,
                2226273.97056,
                3211850.89393,
            ],
        ),
        (
            0.25,
            [
                0.00563368466972,
                0.0167796511239,
                2843332.47804,
                4145229.99461,
            ],
        ),
    ];
    for (method, relative) in [
        (Method::Explicit, 1e-11),
        (Method::Implicit, 1e-10),
        (Method::Choose, 1e-11),
    ] {
        for (end, known) in known {
            let tolerance = Tolerance {
                relative,
                absolute: [1e-2, 1e-1, 1e5, 1e5].map(|size| relative * size).to_vec(),
            };
            let it = run(
                method,
                &mut hydraulic_arm,
                (0.0, end),
                &[0.0, 0.0, 2e6, 2e6],
                tolerance,
            );
            let off = off(it.state(), &known);
            assert!(off < 1e-9, "{method:?} {end}: {off}");
        }
    }
}

/// Meets cos t as fast as it is told, at each time.
fn pulled(rate: impl Fn(f64) -> f64) -> impl FnMut(f64, &[f64], &mut [f64]) -> bool {
    move |t, y, r| {
        r[0] = -rate(t) * (y[0] - cos(t)) - sin(t);
        true
    }
}

#[test]
fn methods_change_where_a_system_becomes_stiff_and_back() {
    let mut system = pulled(|t| if sin(t) > 0.0 { 1e5 } else { 1.0 });
    let start = [1.0];
    let mut it = Integrator::new(&mut system, 0.0, &start, 1.0, tolerance(1e-7)).unwrap();
    let (mut last, mut changes) = (it.used(), Vec::new());
    let mut was_implicit = false;
    while it.time() < 12.0 {
        it.step(&mut system, 12.0).unwrap();
        let off = (it.state()[0] - cos(it.time())).abs();
        assert!(off < 5e-6, "{}: {off}", it.time());
        let used = it.used();
        assert_eq!(
            used.explicit + used.implicit,
            last.explicit + last.implicit + 1
        );
        let implicit = used.implicit > last.implicit;
        if implicit != was_implicit {
            changes.push(it.before());
        }
        (last, was_implicit) = (used, implicit);
    }
    assert_eq!(it.used().implicit_from, changes.first().copied());
    // To implicit steps soon after 0 and 2 pi, back to explicit ones after pi and 3 pi.
    assert_eq!(changes.len(), 4, "{changes:?}");
    for (k, change) in changes.iter().enumerate() {
        let half_turns = change / std::f64::consts::PI;
        let after = half_turns - k as f64;
        assert!(after > 0.0 && after < 0.9, "{changes:?}");
    }
    let forced = run(
        Method::Explicit,
        &mut system,
        (0.0, 12.0),
        &start,
        tolerance(1e-7),
    );
    assert!(it.evaluations() < forced.evaluations() / 20);
}

#[test]
fn what_is_not_stiff_is_left_to_explicit_steps() {
    for relative in [1e-4, 1e-7, 1e-10] {
        let it = run(
            Method::Choose,
            &mut pendulum,
            (0.0, 30.0),
            &[2.5, 0.0],
            tolerance(relative),
        );
        assert_eq!(it.used().implicit, 0, "{relative}");
        // A spring that swings fast is followed, not passed over.
        let mut spring = |_: f64, y: &[f64], r: &mut [f64]| {
            (r[0], r[1]) = (y[1], -1e6 * y[0]);
            true
        };
        let tolerance = Tolerance {
            relative,
            absolute: vec![relative * 1e-3, relative],
        };
        let it = run(
            Method::Choose,
            &mut spring,
            (0.0, 0.1),
            &[1e-3, 0.0],
            tolerance,
        );
        let exact = 1e-3 * cos(100.0);
        assert!(
            (it.state()[0] - exact).abs() < 1.0 * relative,
            "{relative}: {:?}",
            it.state()
        );
        assert_eq!(it.used().implicit, 0, "{relative}");
    }
}

#[test]
fn a_restart_goes_on_with_the_method_it_has() {
    let mut system = pulled(|_| 1e6);
    let mut it = Integrator::new(&mut system, 0.0, &[1.0], 1.0, tolerance(1e-7)).unwrap();
    while it.time() < 1.0 {
        it.step(&mut system, 1.0).unwrap();
    }
    let before = it.used();
    assert!(before.implicit > 0);
    let state = [cos(1.0)];
    assert!(it.restart(&mut system, 1.0, &state));
    assert_eq!((it.time(), it.before(), it.state()), (1.0, 1.0, &state[..]));
    while it.time() < 2.0 {
        it.step(&mut system, 2.0).unwrap();
    }
    assert_eq!(it.used().explicit, before.explicit);
    assert!((it.state()[0] - cos(2.0)).abs() < 1e-7);
}

/// Robertson's reactions with their Jacobian.
struct WithJacobian;

impl System for WithJacobian {
    fn rates(&mut self, time: f64, state: &[f64], rates: &mut [f64]) -> bool {
        robertson(time, state, rates)
    }

    fn jacobian(&mut self, _: f64, y: &[f64], jacobian: &mut [f64]) -> bool {
        let (a, b, c) = (1e4 * y[2], 1e4 * y[1], 6e7 * y[1]);
        jacobian.copy_from_slice(&[-0.04, a, b, 0.04, -a - c, -b, 0.0, c, 0.0]);
        true
    }
}

#[test]
fn a_known_jacobian_saves_differences() {
    let start = [1.0, 0.0, 0.0];
    let tolerance = Tolerance {
        relative: 1e-7,
        absolute: vec![1e-13],
    };
    let known = run(
        Method::Implicit,
        &mut WithJacobian,
        (0.0, 40.0),
        &start,
        tolerance.clone(),
    );
    let found = run(
        Method::Implicit,
        &mut robertson,
        (0.0, 40.0),
        &start,
        tolerance,
    );
    assert!(off(known.state(), found.state()) < 1e-8);
    assert!(known.evaluations() < found.evaluations());
    // Nine rates a step, and a Jacobian now and then.
    let steps = found.used().implicit;
    assert!(
        found.evaluations() < 10 * steps,
        "{} in {steps}",
        found.evaluations()
    );
}
