//! Bloch's synthesis and dead centres: references, and linkages led back to what they were made for.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use crate::support::between;
use kempe_number::{Random, math};
use kempe_synthesis::{
    C, FourBar, Grashof, LinkRates, SliderCrankChoice, StrokeSliderCrank, SynthesisError, Turning,
    best_crank_rocker, best_stroke_slider_crank, bloch, crank_rockers, imbalance,
    stroke_slider_crank, time_ratio,
};

fn rates(all: [[f64; 2]; 3]) -> [LinkRates; 3] {
    all.map(|[velocity, acceleration]| LinkRates {
        velocity,
        acceleration,
    })
}

#[test]
fn blochs_synthesis_of_references() {
    let close = |a: C, re: f64, im: f64| {
        assert!(
            (a - C::new(re, im)).norm() <= 1e-12 * (re.abs() + im.abs()),
            "{a:?}"
        );
    };
    let found = bloch(rates([[20.0, 0.0], [8.5, -10.0], [13.0, -160.0]])).unwrap();
    // R1 = 1230 - 497.25 i and so on; the frame R4 closes with the opposite sign.
    close(found.first, 1230.0, -497.25);
    close(found.coupler, -3200.0, -1820.0);
    close(found.second, 200.0, 1955.0);
    close(found.frame, 1770.0, 362.25);
    let sizes = [found.first, found.coupler, found.second, found.frame].map(|r| r.norm());
    for (s, k) in sizes
        .iter()
        .zip([1326.70929841, 3681.35844492, 1965.2035518, 1806.6889778])
    {
        assert!((s - k).abs() < 1e-7);
    }
    for (s, k) in sizes.iter().zip([1.0, 2.77480413, 1.48126161, 1.3617821]) {
        assert!((s / sizes[0] - k).abs() < 1e-8);
    }
    assert_eq!(found.four_bar().grashof(), Grashof::NonGrashof);
    let book = bloch(rates([[200.0, 0.0], [85.0, -1000.0], [130.0, -16000.0]])).unwrap();
    close(book.frame, 1770000.0, 362250.0);
    close(book.first, 1230000.0, -497250.0);
    close(book.coupler, -3200000.0, -1820000.0);
    close(book.second, 200000.0, 1955000.0);
    assert!((book.frame.norm() - 1806688.978).abs() < 1e-3);
    assert!((book.frame.arg().to_degrees() - 11.5665).abs() < 1e-4);
    let sized = found.with_frame(C::new(-2.0, 0.0)).unwrap();
    assert!((sized.first + sized.coupler + sized.second - C::new(2.0, 0.0)).norm() < 1e-15);
}

/// Angles of coupler and second link by the first link's angle, continuing near those given.
fn followed(bar: &FourBar, angle: f64, branch: i8, near: [f64; 2]) -> [f64; 2] {
    let pose = bar.pose(angle, branch).unwrap();
    let places = bar.places(&pose);
    let second = places[1] - bar.fixed[1];
    let on = |x: f64, n: f64| n + math::within_half_a_turn(x - n);
    [on(pose.angle, near[0]), on(second.arg(), near[1])]
}

#[test]
fn random_rates_are_those_of_the_linkage_found() {
    let mut random = Random(71);
    let (mut cases, mut failed) = (0, 0);
    while cases < 10_000 {
        let asked = rates([(); 3].map(|()| {
            [
                between(&mut random, -3.0, 3.0),
                between(&mut random, -5.0, 5.0),
            ]
        }));
        let found = bloch(asked).unwrap();
        let Some(found) = found.with_frame(C::new(-1.0, 0.0)) else {
            continue;
        };
        let bar = found.four_bar();
        let pose = kempe_synthesis::Pose::new(0.0, 0.0, 0.0);
        let branch = bar.branch(&pose);
        let sine = {
            let second = -found.second;
            (second.re * found.coupler.im - second.im * found.coupler.re)
                / (second.norm() * found.coupler.norm())
        };
        // Near a dead centre, or with links of very different size, differences tell nothing.
        if sine.abs() < 0.2 || bar.link_ratio() > 20.0 || asked[0].velocity.abs() < 0.3 {
            continue;
        }
        cases += 1;
        // Differences over a little time of the closed linkage.
        let h = 2e-4;
        let at = |k: f64| {
            let t = k * h;
            let angle = bar.first_angle(&pose)
                + asked[0].velocity * t
                + 0.5 * asked[0].acceleration * t * t;
            followed(&bar, angle, branch, [0.0, (-found.second).arg()])
        };
        let samples: Vec<[f64; 2]> = [-2.0, -1.0, 0.0, 1.0, 2.0].iter().map(|k| at(*k)).collect();
        for link in 0..2 {
            let w: Vec<f64> = samples.iter().map(|s| s[link]).collect();
            let velocity = (w[0] - 8.0 * w[1] + 8.0 * w[3] - w[4]) / (12.0 * h);
            let acceleration =
                (-w[0] + 16.0 * w[1] - 30.0 * w[2] + 16.0 * w[3] - w[4]) / (12.0 * h * h);
            let wanted = asked[link + 1];
            let scale = 1.0 + wanted.acceleration.abs();
            if (velocity - wanted.velocity).abs() > 1e-6 * scale
                || (acceleration - wanted.acceleration).abs() > 1e-4 * scale
            {
                failed += 1;
                println!(
                    "{velocity} {acceleration} {wanted:?} {sine} {}",
                    bar.link_ratio()
                );
            }
        }
    }
    println!("{failed} of {cases}");
    assert!(failed <= 10);
}

#[test]
fn alike_rates_are_told() {
    let alike = rates([[1.0, 2.0], [3.0, 4.0], [3.0, 4.0]]);
    assert_eq!(bloch(alike), Err(SynthesisError::Dependent { datum: 2 }));
    let nothing = rates([[f64::NAN, 0.0], [0.0, 1.0], [1.0, 1.0]]);
    assert_eq!(bloch(nothing), Err(SynthesisError::NotFinite { datum: 0 }));
}

#[test]
fn a_crank_rocker_of_its_swing_and_time_ratio() {
    // a = 20, b = 50, c = 40, d = 60.
    let (swing, theta) = (
        60.032348552120_f64.to_radians(),
        1.564113482665_f64.to_radians(),
    );
    let found = crank_rockers(swing, theta, 50.0 / 40.0).unwrap();
    let near = (found.iter())
        .map(|r| (r.crank - 0.5).abs().max((r.frame - 1.5).abs()))
        .fold(f64::INFINITY, f64::min);
    assert!(near < 1e-11, "{found:?}");
    assert!((time_ratio(theta) - 1.017531377944).abs() < 1e-12);
    assert!((imbalance(1.017531377944) - theta).abs() < 1e-12);
    // An offset slider-crank: crank 57.5, coupler 210, offset 13.
    let (stroke, theta) = (115.2390340889153, imbalance(1.0 / 0.97688580837264));
    for choice in [
        SliderCrankChoice::Coupler(210.0),
        SliderCrankChoice::Offset(13.0),
    ] {
        let s = stroke_slider_crank(stroke, theta, choice).unwrap();
        let off = (s.crank - 57.5)
            .abs()
            .max((s.coupler - 210.0).abs())
            .max((s.offset - 13.0).abs());
        assert!(off < 1e-8, "{s:?}");
    }
}

/// Swing and imbalance of a four-bar from its dead centres.
fn measured(bar: &FourBar) -> Option<[f64; 2]> {
    let [d, a, b, c] = bar.all_lengths();
    if bar.grashof() != Grashof::Grashof || a > d.min(b).min(c) {
        return None;
    }
    let rocker = |reach: f64| math::acos((d * d + c * c - reach * reach) / (2.0 * d * c));
    let crank = |reach: f64| math::acos((d * d + reach * reach - c * c) / (2.0 * d * reach));
    let swing = rocker(b + a) - rocker(b - a);
    Some([swing, (crank(b - a) - crank(b + a)).abs()])
}

#[test]
fn random_crank_rockers_are_recovered() {
    let mut random = Random(72);
    let (mut cases, mut missed, mut extra) = (0, 0, 0);
    while cases < 10_000 {
        let mut next = || between(&mut random, 0.1, 3.0);
        let (d, a, b) = (next(), next(), next());
        let bar = FourBar {
            fixed: [C::zero(), C::from(d)],
            moving: [C::zero(), C::from(b)],
            lengths: [a, 1.0],
        };
        let Some([swing, theta]) = measured(&bar) else {
            continue;
        };
        if bar.turning(0.0) != Turning::Crank {
            continue;
        }
        cases += 1;
        let found = crank_rockers(swing, theta, b).unwrap();
        let hit = found
            .iter()
            .any(|r| (r.frame - d).abs().max((r.crank - a).abs()) < 1e-5);
        if !hit {
            missed += 1;
            println!("{d} {a} {b} {swing} {theta} {found:?}");
        }
        for r in &found {
            let [s, t] = measured(&r.four_bar()).unwrap();
            extra += usize::from((s - swing).abs() > 1e-6 || (t - theta).abs() > 1e-6);
        }
    }
    println!("missed {missed}, wrong {extra}");
    assert!(missed <= 10 && extra <= 10);
}

#[test]
fn random_slider_cranks_are_recovered() {
    let mut random = Random(73);
    let (mut cases, mut missed) = (0, 0);
    while cases < 10_000 {
        let (a, b, h) = (
            between(&mut random, 0.1, 2.0),
            between(&mut random, 0.1, 5.0),
            between(&mut random, 0.01, 2.0),
        );
        if b <= (a + h) * 1.001 {
            continue;
        }
        cases += 1;
        let far = |r: f64| (r * r - h * h).sqrt();
        let stroke = far(b + a) - far(b - a);
        let theta = math::asin(h / (b - a)) - math::asin(h / (b + a));
        for choice in [SliderCrankChoice::Coupler(b), SliderCrankChoice::Offset(h)] {
            let hit =
                stroke_slider_crank(stroke, theta, choice).is_ok_and(|s: StrokeSliderCrank| {
                    (s.crank - a)
                        .abs()
                        .max((s.offset - h).abs())
                        .max((s.coupler - b).abs())
                        < 1e-5
                });
            missed += usize::from(!hit);
            // The slider travels the stroke, the transmission angle stays as far off as told.
            if let Ok(found) = stroke_slider_crank(stroke, theta, choice) {
                let linkage = found.slider_crank();
                assert!((2.0 * linkage.travel(1.0)[1] - stroke).abs() < 1e-7 * (1.0 + b));
                let [low, high] = linkage.transmission_range(0.0, std::f64::consts::TAU);
                let off = low.min(std::f64::consts::PI - high);
                assert!((off - found.transmission()).abs() < 1e-7);
            }
        }
    }
    println!("{missed}");
    assert!(missed <= 10);
}

#[test]
fn the_best_has_no_better_neighbour() {
    for (swing, ratio) in [(60.0_f64, 1.1), (40.0, 1.0), (75.0, 1.3), (30.0, 1.5)] {
        let (swing, theta) = (swing.to_radians(), imbalance(ratio));
        let best = best_crank_rocker(swing, theta).unwrap();
        let [s, t] = measured(&best.four_bar()).unwrap();
        assert!((s - swing).abs() < 1e-9 && (t - theta).abs() < 1e-9);
        for k in 1..2000 {
            let coupler = 0.01 * f64::from(k);
            for other in crank_rockers(swing, theta, coupler).unwrap() {
                assert!(
                    other.transmission() <= best.transmission() + 1e-6,
                    "{other:?} {best:?}"
                );
            }
        }
    }
    let best = best_stroke_slider_crank(100.0, imbalance(1.2)).unwrap();
    for k in 1..3000 {
        let choice = SliderCrankChoice::Coupler(f64::from(k));
        if let Ok(other) = stroke_slider_crank(100.0, imbalance(1.2), choice) {
            assert!(other.transmission() <= best.transmission() + 1e-9);
        }
    }
    assert!(matches!(
        crank_rockers(4.0, 0.1, 1.0),
        Err(SynthesisError::OutOfRange { datum: 0, .. })
    ));
}
