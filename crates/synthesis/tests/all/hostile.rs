//! Data as special as they get: nothing panics, and what is found is finite and keeps what was asked.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use crate::support;
use kempe_number::Random;
use kempe_synthesis::{
    BurmesterCurve, C, CurveDrawing, DialZeros, Driver, Dyad, DyadCondition, DyadSolution, Line,
    LinkRates, Pose, PrecisionPoint, SliderCondition, SliderPoint, bloch, crank_rockers, dyads,
    fit_function, fixed_guides, functions, inverted_slider_functions, moving_guides, pairs,
    passage, paths_with_crank, paths_with_ground_pivots, slider_functions, timed_paths,
    two_lengths,
};

/// A number of a few, so that data repeat, lie in line, are symmetric.
fn few(random: &mut Random) -> f64 {
    [-2.0, -1.0, 0.0, 0.0, 1.0, 2.0, 0.5][(random.uniform() * 7.0) as usize]
}

fn point(random: &mut Random) -> C {
    C::new(few(random), few(random))
}

fn angle(random: &mut Random) -> f64 {
    few(random) * std::f64::consts::FRAC_PI_4
}

fn held(found: &[DyadSolution], poses: &[Pose], what: &str) {
    for d in found {
        let (size, finite) = match d.dyad {
            Dyad::Rr {
                fixed,
                moving,
                length,
            } => (
                fixed.norm() + moving.norm(),
                fixed.is_finite() && moving.is_finite() && length.is_finite(),
            ),
            Dyad::Pr { guide, moving } => (moving.norm(), guide.is_finite() && moving.is_finite()),
            Dyad::Rp { fixed, guide } => (fixed.norm(), guide.is_finite() && fixed.is_finite()),
        };
        assert!(finite, "{what} {d:?}");
        for pose in poses {
            let off = d.dyad.residual(pose).abs();
            assert!(off <= 1e-7 * (1.0 + size), "{what} {off:e} {d:?} {poses:?}");
        }
    }
}

#[test]
fn special_poses() {
    let mut random = Random(81);
    let (mut answered, mut told) = (0, 0);
    for _ in 0..20_000 {
        let mut poses: Vec<Pose> = (0..5)
            .map(|_| Pose {
                origin: point(&mut random),
                angle: angle(&mut random),
            })
            .collect();
        if random.uniform() < 0.3 {
            // A little off, as data from elsewhere are.
            let size = [1e-15, 1e-12, 1e-9, 1e-6][(random.uniform() * 4.0) as usize];
            for p in &mut poses {
                p.origin += support::place(&mut random, size);
                p.angle += size * random.uniform();
            }
        }
        let line = Line::at_angle(point(&mut random), angle(&mut random));
        let (g, z) = (point(&mut random), point(&mut random));
        let asked: [(usize, Vec<DyadCondition>); 6] = [
            (5, vec![]),
            (4, vec![DyadCondition::FixedOn(line)]),
            (4, vec![DyadCondition::MovingOn(line)]),
            (3, vec![DyadCondition::FixedAt(g)]),
            (3, vec![DyadCondition::MovingAt(z)]),
            (
                2,
                vec![DyadCondition::FixedAt(g), DyadCondition::MovingOn(line)],
            ),
        ];
        for (count, conditions) in &asked {
            match dyads(&poses[..*count], conditions) {
                Ok(found) => {
                    held(&found, &poses[..*count], &format!("{conditions:?}"));
                    answered += 1;
                    let list: Vec<Dyad> = found.iter().map(|d| d.dyad).collect();
                    for linkage in pairs(&list) {
                        for driver in [Driver::First, Driver::Second] {
                            let known = passage(&linkage, &poses[..*count], driver);
                            if let Some(known) = known {
                                assert!(known.driver.iter().all(|a| a.is_finite()));
                                let ranges = known.transmission.unwrap_or_default();
                                assert!(
                                    ranges.as_flattened().iter().all(|a| a.is_finite()),
                                    "{linkage:?} {ranges:?}"
                                );
                            }
                        }
                    }
                }
                Err(error) => {
                    assert!(!error.to_string().is_empty());
                    told += 1;
                }
            }
        }
        for conditions in [
            vec![],
            vec![SliderCondition::Along(angle(&mut random))],
            vec![SliderCondition::PinOn(line)],
        ] {
            let count = 4 - conditions.len();
            for guides in [fixed_guides, moving_guides] {
                if let Ok(found) = guides(&poses[..count], &conditions) {
                    held(&found, &poses[..count], "guide");
                }
            }
        }
        if let Ok(curve) = BurmesterCurve::new(&[poses[0], poses[1], poses[2], poses[3]]) {
            for piece in curve.drawn(CurveDrawing::default()) {
                for p in &piece.points {
                    assert!(p.fixed.is_finite() && p.moving.is_finite());
                    let dyad = Dyad::rr(p.fixed, p.moving, &poses[0]);
                    let size = 1.0 + p.fixed.norm() + p.moving.norm();
                    let off = poses[..4]
                        .iter()
                        .map(|q| dyad.residual(q).abs())
                        .fold(0.0, f64::max);
                    assert!(off <= 1e-5 * size, "{off:e} {p:?} {poses:?}");
                }
            }
        }
    }
    println!("{answered} answered, {told} told");
}

#[test]
fn special_pairs() {
    let mut random = Random(82);
    for _ in 0..20_000 {
        let pairs: Vec<PrecisionPoint> = (0..5)
            .map(|_| PrecisionPoint::new(angle(&mut random), angle(&mut random) * 0.7))
            .collect();
        let zero = |random: &mut Random| (random.uniform() < 0.3).then(|| angle(random));
        let zeros = DialZeros {
            input: zero(&mut random),
            output: zero(&mut random),
        };
        let count = 5 - usize::from(zeros.input.is_some()) - usize::from(zeros.output.is_some());
        if let Ok(found) = functions(&pairs[..count], zeros) {
            for f in &found {
                let size = 1.0 + f.input.norm() + f.output.norm();
                for p in &pairs[..count] {
                    let off = f.coupler_at(p.input, p.output).norm() - f.coupler;
                    assert!(off.abs() < 1e-6 * size * size, "{off:e} {f:?} {pairs:?}");
                }
            }
        }
        if let Ok(found) = inverted_slider_functions(&pairs[..count - 1], zeros) {
            for f in &found {
                for p in &pairs[..count - 1] {
                    assert!(f.residual(p.input, p.output).abs() < 1e-6 * (1.0 + f.crank.norm()));
                }
            }
        }
        let slides: Vec<SliderPoint> = (0..5)
            .map(|_| SliderPoint::new(angle(&mut random), few(&mut random)))
            .collect();
        let slider_zero = zero(&mut random);
        let count = 5 - usize::from(zeros.input.is_some()) - usize::from(slider_zero.is_some());
        if let Ok(found) = slider_functions(&slides[..count], zeros.input, slider_zero) {
            for f in &found {
                for p in &slides[..count] {
                    let branch = f.branch(p.angle, p.place);
                    let height = f.slider.im - (f.crank * C::from_polar(1.0, p.angle)).im;
                    if height.abs() > 0.999_999 * f.coupler {
                        continue;
                    }
                    let off = f.place(p.angle, branch).unwrap() - p.place;
                    assert!(
                        off.abs() < 1e-5 * (1.0 + f.crank.norm() + f.coupler),
                        "{off:e} {f:?} {slides:?}"
                    );
                }
            }
        }
        let _ = two_lengths(few(&mut random), few(&mut random), &pairs);
        let all = [(); 3].map(|()| LinkRates {
            velocity: few(&mut random),
            acceleration: few(&mut random),
        });
        if let Ok(found) = bloch(all) {
            assert!(found.frame.is_finite());
        }
        let _ = crank_rockers(
            few(&mut random).abs(),
            few(&mut random).abs(),
            few(&mut random),
        );
    }
    for _ in 0..200 {
        let pairs: Vec<PrecisionPoint> = (0..8)
            .map(|_| PrecisionPoint::new(angle(&mut random) + random.uniform(), angle(&mut random)))
            .collect();
        if let Ok(fits) = fit_function(&pairs, DialZeros::default()) {
            assert!(fits.iter().all(|f| f.rms().is_finite()));
        }
    }
}

#[test]
fn special_points() {
    let mut random = Random(83);
    for _ in 0..5_000 {
        let points: Vec<C> = (0..5).map(|_| point(&mut random)).collect();
        let angles: Vec<f64> = (0..5).map(|_| angle(&mut random)).collect();
        let (pivot, end) = (point(&mut random), point(&mut random));
        for found in [
            timed_paths(&points, &angles, &[], &[]),
            timed_paths(
                &points[..3],
                &angles[..3],
                &[DyadCondition::FixedAt(pivot)],
                &[DyadCondition::FixedAt(end)],
            ),
            paths_with_crank(
                &points[..3],
                pivot,
                end,
                &[DyadCondition::FixedAt(point(&mut random))],
            ),
            paths_with_crank(&points, pivot, end, &[]),
        ]
        .into_iter()
        .flatten()
        {
            for f in found {
                for driver in [Driver::First, Driver::Second] {
                    let _ = passage(&f.linkage, &f.poses, driver);
                }
                for (pose, point) in f.poses.iter().zip(&points) {
                    assert!((pose.origin - *point).norm() < 1e-12 && pose.angle.is_finite());
                }
            }
        }
    }
}

#[test]
fn special_points_with_ground_pivots() {
    let mut random = Random(84);
    let (mut counts, mut cases) = ([0; 4], 0);
    for _ in 0..if cfg!(debug_assertions) { 60 } else { 600 } {
        let points: Vec<C> = (0..5).map(|_| point(&mut random)).collect();
        let pivots = [point(&mut random), point(&mut random)];
        let line = Line::at_angle(point(&mut random), angle(&mut random));
        for (count, line) in [(5, None), (4, Some(line))] {
            let Ok(found) = paths_with_ground_pivots(&points[..count], pivots, line) else {
                continue;
            };
            cases += 1;
            assert_eq!(found.finite + found.infinite + found.lost, found.generic);
            for (sum, n) in counts.iter_mut().zip([
                found.finite,
                found.infinite,
                found.lost,
                found.linkages.len(),
            ]) {
                *sum += n;
            }
            for f in &found.linkages {
                let kempe_synthesis::Linkage::FourBar(bar) = f.linkage else {
                    continue;
                };
                for (pose, point) in f.poses.iter().zip(&points) {
                    assert!((pose.origin - *point).norm() < 1e-12);
                    for (k, place) in bar.places(pose).into_iter().enumerate() {
                        let off = ((place - bar.fixed[k]).norm() - bar.lengths[k]).abs();
                        assert!(
                            off < 1e-6 * (1.0 + bar.lengths[k]),
                            "{off:e} {bar:?} {points:?}"
                        );
                    }
                }
                if let Some(line) = line {
                    let start = bar.places(&f.poses[0])[0];
                    assert!(line.distance(start).abs() < 1e-7 * (1.0 + start.norm()));
                }
            }
        }
    }
    println!("{cases}: finite, infinite, lost, real {counts:?}");
}

#[test]
fn nothing_given_is_told() {
    let both = [
        DyadCondition::FixedAt(C::one()),
        DyadCondition::MovingAt(C::i()),
    ];
    assert!(dyads(&[], &both).is_err());
    assert!(dyads(&[], &[]).is_err());
    let one = dyads(&[Pose::new(1.0, 2.0, 0.5)], &both).unwrap();
    assert_eq!(one.len(), 1);
    let pin = [
        SliderCondition::PinAt(C::one()),
        SliderCondition::Along(0.3),
    ];
    for guides in [fixed_guides, moving_guides] {
        assert!(guides(&[], &pin).is_err() && guides(&[], &[]).is_err());
        let one = guides(&[Pose::new(1.0, 2.0, 0.5)], &pin).unwrap();
        assert!(one.len() == 1 && one[0].residual < 1e-15);
    }
    assert!(paths_with_crank(&[], C::zero(), C::one(), &both).is_err());
    assert!(timed_paths(&[], &[], &both, &both).is_err());
    assert!(paths_with_ground_pivots(&[], [C::zero(), C::one()], None).is_err());
    assert!(functions(&[], DialZeros::default()).is_err());
    assert!(slider_functions(&[], None, None).is_err());
    assert!(inverted_slider_functions(&[], DialZeros::default()).is_err());
    assert!(fit_function(&[], DialZeros::default()).is_err());
    assert!(two_lengths(1.0, 1.0, &[]).is_err());
    assert!(pairs(&[]).is_empty());
}
