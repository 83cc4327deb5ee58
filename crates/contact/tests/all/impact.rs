//! What impacts deliver, against tables, closed forms and impacts followed in time.
#![allow(clippy::unwrap_used, clippy::excessive_precision)]

use crate::support;
use crate::support::follow;
use kempe_contact::{
    Damping, Dissipation, Fit, Impact, Material, Normal, Unfit, delivered, delivered_by_factor,
    factor, stiffness,
};
use kempe_integrate::Method;
use kempe_number::math::{acos, exp};
use kempe_number::{Dual, Number};

const WANTED: [f64; 7] = [0.1, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95];

/// The restitution that each law delivers for those wanted, found apart from Kempe.
const DELIVERED: [(Dissipation, [f64; 7]); 8] = [
    (
        Dissipation::HuntCrossley,
        [
            0.51583262, 0.58128804, 0.66296220, 0.76799979, 0.83286979, 0.90901574, 0.95237015,
        ],
    ),
    (
        Dissipation::LankaraniNikravesh,
        [
            0.66526541, 0.68422461, 0.72524111, 0.79597260, 0.84710228, 0.91317668, 0.95350605,
        ],
    ),
    (
        Dissipation::HerbertMcWhannell,
        [
            0.49069766, 0.51996655, 0.59362426, 0.72268265, 0.80698007, 0.90089299, 0.95011228,
        ],
    ),
    (
        Dissipation::LeeWang,
        [
            0.68666344, 0.73899532, 0.79919878, 0.86934311, 0.90901574, 0.95237015, 0.97560831,
        ],
    ),
    (
        Dissipation::ZhiyingQishao,
        [
            0.21746934, 0.32669740, 0.48260802, 0.67956651, 0.78736492, 0.89591819, 0.94886390,
        ],
    ),
    (
        Dissipation::Flores,
        [
            0.06944423, 0.25620791, 0.47044478, 0.68318420, 0.78853913, 0.89392069, 0.94682883,
        ],
    ),
    (
        Dissipation::Gonthier,
        [
            0.10098977, 0.30422486, 0.48774126, 0.66958132, 0.76799979, 0.87643542, 0.93593432,
        ],
    ),
    (
        Dissipation::HuGuo,
        [
            0.07407353, 0.27065846, 0.48774126, 0.69729697, 0.79919878, 0.89989994, 0.94998750,
        ],
    ),
];

#[test]
fn laws_deliver_the_restitution_of_the_table() {
    for (law, known) in DELIVERED {
        for (wanted, known) in WANTED.into_iter().zip(known) {
            let own = delivered(law, wanted).unwrap();
            assert!((own - known).abs() < 6e-9, "{law:?} {wanted}: {own}");
            let normal = Normal::dissipating(6.61e10, wanted, law).unwrap();
            let followed = follow(&normal, 0.14, 0.3, Method::Explicit, 1e-12);
            let off = followed.restitution - known;
            assert!(off.abs() < 1e-8, "{law:?} {wanted}: {off}");
        }
    }
}

#[test]
fn the_exact_factor_delivers_what_is_wanted() {
    let known = [
        9.998159397,
        3.087081981,
        1.432750533,
        0.6348282813,
        0.3731462034,
        0.1664819507,
        0.07892660529,
    ];
    for (wanted, chi) in WANTED.into_iter().zip(known) {
        let own = factor(Dissipation::Exact, wanted).unwrap();
        assert!((own / chi - 1.0).abs() < 1e-9, "{wanted}: {own}");
        let normal = Normal::dissipating(6.61e10, wanted, Dissipation::Exact).unwrap();
        let energy = 0.5 * 0.14 * 0.09;
        // Whatever the exponent.
        for exponent in [1.0, 1.5, 2.2] {
            let normal = Normal { exponent, ..normal };
            let followed = follow(&normal, 0.14, 0.3, Method::Explicit, 1e-13);
            let off = followed.restitution - wanted;
            assert!(off.abs() < 1e-10, "{wanted}, {exponent}: {off}");
            let lost = followed.lost / energy - (1.0 - wanted * wanted);
            assert!(lost.abs() < 1e-10, "{wanted}, {exponent}: {lost}");
        }
    }
    // To and fro, to the ends of what is possible.
    for e in [
        1e-6,
        1e-3,
        0.01,
        0.2,
        0.43,
        0.99,
        0.999_999,
        1.0 - 1e-12,
        1.0,
    ] {
        let chi = factor(Dissipation::Exact, e).unwrap();
        assert!(chi >= 0.0 && chi * e < 1.0 + 1e-15);
        let back = delivered_by_factor(chi);
        assert!((back - e).abs() < 4e-16 + 1e-15 * e, "{e}: {back}");
    }
    let mut last = f64::INFINITY;
    for k in 1..=1000 {
        let chi = factor(Dissipation::Exact, f64::from(k) / 1000.0).unwrap();
        assert!(chi < last);
        last = chi;
    }
}

#[test]
fn depth_and_force_are_those_known() {
    let (stiffness, mass, speed) = (6.6073e10, 0.14, 0.3);
    let chi = factor(Dissipation::Exact, 0.9).unwrap();
    let exact = Impact::new(stiffness, 1.5, chi, mass, speed).unwrap();
    assert!((exact.indentation / 8.5672305937859e-6 - 1.0).abs() < 1e-12);
    assert!((exact.force / 1673.9269623852 - 1.0).abs() < 1e-12);
    assert!((exact.speed_at_force - 0.12296515).abs() < 1e-8);
    assert!((exact.restitution - 0.9).abs() < 1e-15);
    let chi = factor(Dissipation::LankaraniNikravesh, 0.9).unwrap();
    assert!((chi - 0.1425).abs() < 1e-15);
    let other = Impact::new(stiffness, 1.5, chi, mass, speed).unwrap();
    assert!((other.indentation / 8.6159575900299e-6 - 1.0).abs() < 1e-12);
    assert!((other.force / 1683.8378606507 - 1.0).abs() < 1e-12);
}

#[test]
fn durations_are_those_of_impacts_followed_in_time() {
    let (stiffness, mass, speed) = (6.6073e10, 0.14, 0.3);
    // Hertz: sqrt(pi) Gamma(2/5) / Gamma(9/10) * 4/5 times depth over speed. A spring: half a period.
    let hertz = Impact::new(stiffness, 1.5, 0.0, mass, speed).unwrap();
    let known = 2.9432750_f64 * hertz.indentation / speed;
    assert!((hertz.duration / known - 1.0).abs() < 1e-7);
    let spring = Impact::new(stiffness, 1.0, 0.0, mass, speed).unwrap();
    let half = std::f64::consts::PI * (mass / stiffness).sqrt();
    assert!((spring.duration / half - 1.0).abs() < 1e-13);
    assert!((spring.force / (speed * (mass * stiffness).sqrt()) - 1.0).abs() < 1e-13);
    // Integrals with 60 digits, over depth by speed. So slow a rebound is lost in time in the rounding of the speed.
    for (exponent, e, known) in [
        (1.0, 0.02, 53.34149145418829),
        (1.5, 0.02, 52.90712720039258),
        (1.5, 0.1, 12.54561088138617),
        (1.5, 0.9, 3.10392092636472),
    ] {
        let chi = factor(Dissipation::Exact, e).unwrap();
        let impact = Impact::new(stiffness, exponent, chi, mass, speed).unwrap();
        let own = impact.duration / impact.indentation * speed;
        assert!((own / known - 1.0).abs() < 1e-12, "{exponent} {e}: {own}");
    }
    for exponent in [1.0, 1.5, 3.0] {
        for e in [0.1, 0.3, 0.9, 0.999] {
            let chi = factor(Dissipation::Exact, e).unwrap();
            let impact = Impact::new(stiffness, exponent, chi, mass, speed).unwrap();
            let law = Normal {
                stiffness,
                exponent,
                damping: Damping::Factor(chi),
            };
            let followed = follow(&law, mass, speed, Method::Explicit, 1e-12);
            let off = followed.duration / impact.duration - 1.0;
            assert!(off.abs() < 1e-8, "{exponent} {e}: {off}");
            let lost = followed.lost / impact.energy_lost - 1.0;
            assert!(lost.abs() < 1e-8, "{exponent} {e}: {lost}");
            // Those that were looked at are nearly the extremes.
            for (seen, most) in [
                (followed.indentation, impact.indentation),
                (followed.force, impact.force),
            ] {
                assert!(
                    seen <= most * (1.0 + 1e-9) && seen > 0.98 * most,
                    "{exponent} {e}"
                );
            }
        }
    }
}

#[test]
fn implicit_steps_find_the_same_impact() {
    let law = Normal::dissipating(6.61e10, 0.4, Dissipation::Exact).unwrap();
    let followed = follow(&law, 0.14, 0.3, Method::Implicit, 1e-10);
    assert!(
        (followed.restitution - 0.4).abs() < 1e-8,
        "{}",
        followed.restitution
    );
}

#[test]
fn a_spring_with_a_damper_parts_where_it_would_pull() {
    let (stiffness, mass, speed) = (2e6, 0.3, 1.2);
    for part in [0.0, 0.016, 0.11, 0.4, 0.9] {
        // T. Schwager and T. Pöschel, Granular Matter 9, 2007, for this part of the critical damping.
        let e = exp(-2.0 * part * acos(part) / (1.0 - part * part).sqrt());
        let damping = 2.0 * part * (stiffness * mass).sqrt();
        let law = Normal::kelvin_voigt(stiffness, damping).unwrap();
        // It ends where the spring's and the damper's forces cancel, which is before the indentation is gone.
        let rate = (stiffness / mass).sqrt();
        let mut system = |_: f64, y: &[f64], r: &mut [f64]| {
            r[0] = y[1];
            r[1] = -(stiffness * y[0] + damping * y[1]) / mass;
            true
        };
        let tolerance = kempe_integrate::Tolerance {
            relative: 1e-13,
            absolute: vec![1e-15 * speed / rate, 1e-15 * speed],
        };
        let start = [0.0, speed];
        let mut it = kempe_integrate::Integrator::with(
            Method::Explicit,
            &mut system,
            0.0,
            &start,
            1.0,
            tolerance,
        )
        .unwrap();
        let pulls = |y: &[f64]| stiffness * y[0] + damping * y[1] + 1e-9 * (1.0 - e);
        let (_, state) = support::until(&mut it, &mut system, 1.0, pulls, |_| {});
        assert!(
            (-state[1] / speed - e).abs() < 1e-8,
            "{e}: {}",
            -state[1] / speed
        );
        // From there on it would pull.
        if e < 1.0 {
            assert!(law.force(state[0] * 1.01, state[1], speed) > 0.0);
            assert_eq!(law.force(state[0] * 0.99, state[1], speed), 0.0);
        }
    }
}

#[test]
fn forces_never_pull_and_know_no_touch_without_indentation() {
    let law = Normal::dissipating(1e9, 0.2, Dissipation::Exact).unwrap();
    assert_eq!(law.force(-1e-6, 3.0, 1.0), 0.0);
    assert_eq!(law.force(0.0, 3.0, 1.0), 0.0);
    assert_eq!(law.force(1e-5, -10.0, 1.0), 0.0, "torn apart");
    assert!(law.force(1e-5, 10.0, 1.0) > law.force(1e-5, 0.0, 1.0));
    // An approach from rest is none of infinite damping: it has nothing to lose.
    let elastic = Normal::hertz(1e9).unwrap();
    assert_eq!(law.force(1e-5, 1e-3, 0.0), elastic.force(1e-5, 1e-3, 0.0));
    // The slowest impact dissipates as the fastest does: forces go with the speed over that of the approach.
    let [slow, fast] = [1e-9, 1e3].map(|v| law.force(1e-5, 0.5 * v, v));
    assert!((slow / fast - 1.0).abs() < 1e-14);
    let voigt = Normal::kelvin_voigt(1e6, 1e3).unwrap();
    assert_eq!(voigt.force(1e-5, -1.0, 1.0), 0.0);
    assert_eq!(voigt.force(1e-5, 1.0, 1.0), 1010.0);
    assert_eq!(voigt.force(-1e-5, 1.0, 1.0), 0.0);
    let hertz = Normal::hertz(1e9).unwrap().force(1e-4, -5.0, 1.0);
    assert!((hertz - 1e3).abs() < 1e-12);
}

#[test]
fn derivatives_of_forces_are_those_of_differences() {
    type D = Dual<f64, 2>;
    for (exponent, damping) in [
        (1.5, Damping::Factor(0.7)),
        (1.3, Damping::None),
        (1.0, Damping::Viscous(4e3)),
    ] {
        let law = Normal {
            stiffness: 1e9,
            exponent,
            damping,
        };
        let rich = Normal {
            stiffness: D::from_f64(1e9),
            exponent,
            damping: match damping {
                Damping::None => Damping::None,
                Damping::Factor(chi) => Damping::Factor(D::from_f64(chi)),
                Damping::Viscous(d) => Damping::Viscous(D::from_f64(d)),
            },
        };
        let (d, v) = (3e-5, 0.4);
        let force = rich.force(D::variable(d, 0), D::variable(v, 1), D::from_f64(1.0));
        assert_eq!(force.re, law.force(d, v, 1.0));
        let by_d = (law.force(d + 1e-9, v, 1.0) - law.force(d - 1e-9, v, 1.0)) / 2e-9;
        let by_v = (law.force(d, v + 1e-5, 1.0) - law.force(d, v - 1e-5, 1.0)) / 2e-5;
        assert!((force.eps[0] / by_d - 1.0).abs() < 1e-6, "{exponent}");
        assert!(
            (force.eps[1] - by_v).abs() < 1e-6 * (1.0 + by_v.abs()),
            "{exponent}"
        );
        // Where nothing touches, nothing changes.
        let apart = rich.force(D::variable(0.0, 0), D::variable(v, 1), D::from_f64(1.0));
        assert_eq!((apart.re, apart.eps), (0.0, [0.0, 0.0]));
    }
}

const STEEL: Material<f64> = Material {
    modulus: 207e9,
    poisson: 0.3,
};

#[test]
fn stiffness_follows_from_materials_and_radii() {
    let inside = stiffness([STEEL; 2], [0.010, 0.0095], Fit::Inside).unwrap();
    assert!((inside / 66_101_983_978.97 - 1.0).abs() < 1e-12, "{inside}");
    let outside = stiffness([STEEL; 2], [0.010, 0.0095], Fit::Outside).unwrap();
    assert!(
        (outside / 10_584_788_657.4 - 1.0).abs() < 1e-11,
        "{outside}"
    );
    // Against a rigid body only one gives way: twice as stiff.
    let rigid = Material {
        modulus: 1e30,
        poisson: 0.0,
    };
    let one = stiffness([STEEL, rigid], [0.010, 0.0095], Fit::Inside).unwrap();
    assert!((one / inside - 2.0).abs() < 1e-12);
}

#[test]
fn what_is_no_contact_is_refused_with_a_sentence() {
    for e in [0.0, -0.1, 1.1, f64::NAN, f64::INFINITY] {
        for law in Dissipation::ALL {
            let refused = factor(law, e).unwrap_err();
            assert!(matches!(refused, Unfit::Restitution(_)));
            assert!(
                refused.to_string().contains(&format!("is {e};")),
                "{refused}"
            );
        }
    }
    let too_large = stiffness([STEEL; 2], [0.0095, 0.010], Fit::Inside).unwrap_err();
    assert_eq!(
        too_large,
        Unfit::NoRoom {
            around: 0.0095,
            inside: 0.010
        }
    );
    assert!(
        too_large
            .to_string()
            .starts_with("0.01 m do not fit into 0.0095 m"),
        "{too_large}"
    );
    let tight = stiffness([STEEL; 2], [0.01, 0.01], Fit::Inside).unwrap_err();
    assert_eq!(tight, Unfit::NoClearance(0.01));
    assert!(stiffness([STEEL; 2], [0.0, 0.01], Fit::Outside).is_err());
    let rubber = Material {
        poisson: 0.6,
        ..STEEL
    };
    assert_eq!(
        stiffness([STEEL, rubber], [0.02, 0.01], Fit::Inside),
        Err(Unfit::Poisson(0.6))
    );
    let void = Material {
        modulus: 0.0,
        ..STEEL
    };
    let refused = stiffness([STEEL, void], [0.02, 0.01], Fit::Inside).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "the modulus of elasticity is 0; it must be finite and above 0"
    );
    assert!(Normal::hertz(f64::NAN).is_err() && Normal::kelvin_voigt(1.0, -1.0).is_err());
    for bad in [
        [0.0, 1.5, 0.1, 1.0, 1.0],
        [1.0, 0.0, 0.1, 1.0, 1.0],
        [1.0, 1.5, -0.1, 1.0, 1.0],
        [1.0, 1.5, 0.1, 0.0, 1.0],
        [1.0, 1.5, 0.1, 1.0, 0.0],
    ] {
        let [k, n, chi, m, v] = bad;
        assert!(Impact::new(k, n, chi, m, v).is_err(), "{bad:?}");
    }
    assert_eq!(Dissipation::default(), Dissipation::Exact);
}
