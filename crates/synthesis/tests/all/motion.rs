//! Dyads of poses: references, linkages recovered, other units, special poses.

use crate::support::{RandomFourBar, between, moved, nearest, place};
use kempe_number::Random;
use kempe_synthesis::{
    C, Dyad, DyadCondition, Line, Pose, SliderCondition, SynthesisError, dyads, fixed_guides,
    image_pole, moving_guides, pole, timed_dyad,
};

fn degrees(poses: &[(f64, f64, f64)]) -> Vec<Pose> {
    (poses.iter())
        .map(|(x, y, a)| Pose::new(*x, *y, a.to_radians()))
        .collect()
}

fn rr(found: &[kempe_synthesis::DyadSolution]) -> Vec<(C, C, f64)> {
    (found.iter())
        .map(|d| match d.dyad {
            Dyad::Rr {
                fixed,
                moving,
                length,
            } => (fixed, moving, length),
            other => panic!("{other:?}"),
        })
        .collect()
}

#[test]
fn five_poses_with_four_dyads() {
    // Twelve decimals of a program apart from this one.
    let poses = degrees(&[
        (0.0, 0.0, 0.0),
        (2.9, -2.0, 15.0),
        (2.6, 1.6, -35.0),
        (0.4, 1.3, -55.0),
        (1.3, -0.3, 20.0),
    ]);
    let known = [
        (
            3.988054813938,
            -0.119677324797,
            2.769402697444,
            0.717189984025,
            1.478330096294,
        ),
        (
            -0.709469969568,
            2.745005040524,
            -4.333930507949,
            2.539061872961,
            3.630306706402,
        ),
        (
            3.826546335007,
            -0.467135687309,
            2.622267987346,
            0.480552934737,
            1.532449040914,
        ),
        (
            3.914742482989,
            4.104389802928,
            1.748642471474,
            3.550376032588,
            2.235826584870,
        ),
    ];
    let found = dyads(&poses, &[]).unwrap();
    assert_eq!(found.len(), 4);
    for (gx, gy, zx, zy, length) in known {
        let near = (rr(&found).into_iter())
            .map(|(g, z, l)| {
                (g - C::new(gx, gy))
                    .norm()
                    .max((z - C::new(zx, zy)).norm())
                    .max((l - length).abs())
            })
            .fold(f64::INFINITY, f64::min);
        assert!(near < 2e-12, "{near:e}");
    }
    assert!(
        found
            .iter()
            .all(|d| d.multiplicity == 1 && d.residual < 1e-13)
    );
}

#[test]
fn five_poses_of_a_known_linkage() {
    let poses = degrees(&[
        (0.0, 0.0, 0.0),
        (3.609884889775, 1.551905931908, 5.392391106860),
        (7.619850334647, 2.496465372013, 10.732234782727),
        (12.236443287997, 2.680673359965, 17.255026647706),
        (17.445059122559, 1.814199506687, 26.900360045044),
    ]);
    let found = dyads(&poses, &[]).unwrap();
    assert_eq!(found.len(), 4);
    for (g, z) in [
        (C::new(3.0, -8.0), C::new(-4.0, 6.0)),
        (C::new(30.0, -5.0), C::new(14.0, 8.0)),
        (
            C::new(29.36329017, -6.17178155),
            C::new(13.4625131, 7.31249606),
        ),
        (
            C::new(0.91010556, 17.41475418),
            C::new(-2.76078057, 20.76094834),
        ),
    ] {
        // The poses hold 12 decimals, which the third dyad, near to the second, magnifies.
        assert!(nearest(&found, g, z) < 3e-8, "{:e}", nearest(&found, g, z));
    }
}

#[test]
fn three_poses_with_a_pivot_and_their_poles() {
    let poses = degrees(&[(0.0, 0.0, 0.0), (12.0, 6.0, 20.0), (20.0, 18.0, 55.0)]);
    let close = |a: C, b: C| assert!((a - b).norm() < 1e-11, "{a:?} {b:?}");
    let moving = [
        (
            C::new(-10.0, 5.0),
            C::new(-11.463732405799, 39.178719688102),
            34.210048115629,
        ),
        (
            C::new(15.0, 10.0),
            C::new(4.420969946282, 25.774481233343),
            18.993423468626,
        ),
    ];
    let mut ground = Vec::new();
    for (z, g, length) in moving {
        let found = dyads(&poses, &[DyadCondition::MovingAt(z)]).unwrap();
        let [(fixed, at, l)] = rr(&found)[..] else {
            panic!()
        };
        close(fixed, g);
        close(at, z);
        assert!((l - length).abs() < 1e-11);
        ground.push(fixed);
        let back = dyads(&poses, &[DyadCondition::FixedAt(fixed)]).unwrap();
        close(rr(&back)[0].1, z);
    }
    assert!(((ground[1] - ground[0]).norm() - 20.784546599968).abs() < 1e-11);
    for (g, z) in [
        (
            C::new(-10.0, -20.0),
            C::new(-14.262489469491, 16.473598989745),
        ),
        (
            C::new(40.0, -15.0),
            C::new(-9.939601269947, 35.460925617984),
        ),
    ] {
        let found = dyads(&poses, &[DyadCondition::FixedAt(g)]).unwrap();
        close(rr(&found)[0].1, z);
    }
    let p = |j: usize, k: usize| pole(&poses[j], &poses[k]).unwrap();
    close(p(0, 1), C::new(-11.013845458853, 37.027690917706));
    close(p(0, 2), C::new(-7.288839142740, 28.209821269712));
    close(p(1, 2), C::new(-3.029568814179, 24.686379209453));
    // The image pole lies as the pole mirrored in the line of the other two.
    let image = image_pole(&poses[0], &poses[1], &poses[2]).unwrap();
    let side = Line::through(p(0, 1), p(0, 2)).unwrap();
    let mirrored = p(1, 2) - (C::i() * side.direction).scale(2.0 * side.distance(p(1, 2)));
    close(image, mirrored);
}

/// Norton's examples 5-1 and 5-2, in standard form W (e^(i beta) - 1) + Z (e^(i alpha) - 1) = P.
#[test]
fn textbook_dyads_with_given_turns() {
    let polar = |r: f64, a: f64| C::from_polar(r, a.to_radians());
    let poses = |shifts: &[C], alphas: &[f64]| -> Vec<Pose> {
        let later = shifts.iter().zip(alphas).map(|(p, a)| Pose {
            origin: *p,
            angle: a.to_radians(),
        });
        [Pose::new(0.0, 0.0, 0.0)]
            .into_iter()
            .chain(later)
            .collect()
    };
    let turns =
        |betas: &[f64]| -> Vec<f64> { [0.0].iter().chain(betas).map(|b| b.to_radians()).collect() };
    // The link W from the fixed to the moving pivot, Z from there to the body's origin, at the first pose.
    let solved = |poses: &[Pose], betas: &[f64], conditions: &[DyadCondition]| {
        let found = timed_dyad(poses, &turns(betas), conditions).unwrap();
        assert!(found.residual < 1e-13);
        let Dyad::Rr { fixed, moving, .. } = found.dyad else {
            panic!()
        };
        // The link has turned as asked.
        for (pose, beta) in poses.iter().zip(turns(betas)) {
            let link = pose.place(moving) - fixed;
            let turned = (moving - fixed) * C::from_polar(1.0, beta);
            assert!((link - turned).norm() < 1e-12);
        }
        (moving - fixed, -moving)
    };
    let near = |v: C, length: f64, angle: f64, digits: f64| {
        let off = (v.norm() - length).abs() + (v * polar(1.0, -angle)).arg().to_degrees().abs();
        assert!(
            off < digits,
            "{} {} {length} {angle}",
            v.norm(),
            v.arg().to_degrees()
        );
    };
    let two = poses(&[polar(2.416, 165.2)], &[43.3]);
    let at = |z: C| [DyadCondition::MovingAt(-z)];
    near(
        solved(&two, &[38.4], &at(polar(1.298, 26.5))).0,
        2.4669,
        71.571,
        1e-3,
    );
    near(
        solved(&two, &[85.6], &at(polar(1.035, 104.1))).0,
        1.48563,
        15.416,
        1e-3,
    );
    let three = poses(&[polar(2.798, -31.19), polar(3.919, -16.34)], &[-45.0, 9.3]);
    let (w, z) = solved(&three, &[342.3, 324.8], &[]);
    near(w, 6.831999, 89.541, 6e-4);
    near(z, 1.507734, 38.551, 6e-4);
    let (u, s) = solved(&three, &[30.9, 80.6], &[]);
    near(u, 3.199670, -145.217, 6e-4);
    near(s, 1.490764, 94.185, 6e-4);
    // The same links come without their turns from the moving pivot alone, and each turn back from its link.
    let found = dyads(&three, &at(z)).unwrap();
    assert!(nearest(&found, -z - w, -z) < 1e-12);
    let again = timed_dyad(
        &three[..2],
        &turns(&[342.3]),
        &[DyadCondition::FixedAt(-z - w)],
    );
    assert!(nearest(&[again.unwrap()], -z - w, -z) < 1e-12);
    // A link that turns as the body does may be anywhere.
    assert!(matches!(
        timed_dyad(&three, &turns(&[-45.0, 9.3]), &[]),
        Err(SynthesisError::Dependent { .. })
    ));
}

#[test]
fn random_linkages_are_among_the_dyads_of_five_poses() {
    let mut random = Random(5);
    let (mut cases, mut worst, mut missed) = (0, 0.0_f64, Vec::new());
    while cases < 10_000 {
        let bar = RandomFourBar::new(&mut random);
        let Some((poses, _)) = bar.poses(&mut random, 5, 0.1) else {
            continue;
        };
        cases += 1;
        let found = dyads(&poses, &[]).unwrap();
        for k in 0..2 {
            let near = nearest(&found, bar.fixed[k], bar.moving[k]);
            if near > 1e-5 {
                missed.push((cases, k, near));
            } else {
                worst = worst.max(near);
            }
        }
        for d in &found {
            let size = match d.dyad {
                Dyad::Rr { fixed, moving, .. } => 10.0 + fixed.norm() + moving.norm(),
                _ => 10.0,
            };
            assert!(d.residual < 1e-10 * size, "{d:?}");
        }
    }
    println!("missed {missed:?}, worst of the others {worst:e}");
    assert!(missed.len() <= 10, "{missed:?}");
}

#[test]
fn random_linkages_with_conditions() {
    let mut random = Random(6);
    let mut missed = [0; 7];
    let mut cases = 0;
    while cases < 10_000 {
        let bar = RandomFourBar::new(&mut random);
        let Some((poses, angles)) = bar.poses(&mut random, 4, 0.1) else {
            continue;
        };
        cases += 1;
        let (g, z) = (bar.fixed[0], bar.moving[0]);
        let angle = between(&mut random, 0.0, 3.0);
        let (on_g, on_z) = (Line::at_angle(g, angle), Line::at_angle(z, 2.0 * angle));
        let asked: [(usize, Vec<DyadCondition>); 6] = [
            (4, vec![DyadCondition::FixedOn(on_g)]),
            (4, vec![DyadCondition::MovingOn(on_z)]),
            (3, vec![DyadCondition::FixedAt(g)]),
            (3, vec![DyadCondition::MovingAt(z)]),
            (
                3,
                vec![DyadCondition::FixedOn(on_g), DyadCondition::MovingOn(on_z)],
            ),
            (
                2,
                vec![DyadCondition::FixedAt(g), DyadCondition::MovingOn(on_z)],
            ),
        ];
        for (k, (count, conditions)) in asked.iter().enumerate() {
            let found = dyads(&poses[..*count], conditions).unwrap();
            if nearest(&found, g, z) > 1e-6 {
                missed[k] += 1;
            }
        }
        let timed = timed_dyad(&poses[..3], &angles[..3], &[]);
        missed[6] += usize::from(!timed.is_ok_and(|d| nearest(&[d], g, z) < 1e-6));
    }
    println!("{missed:?}");
    assert!(missed.iter().all(|m| *m <= 10), "{missed:?}");
}

#[test]
fn random_sliders_are_recovered() {
    let mut random = Random(8);
    let mut missed = 0;
    for _ in 0..10_000 {
        let guide = Line::at_angle(place(&mut random, 2.0), between(&mut random, -3.0, 3.0));
        let pin = place(&mut random, 2.0);
        let poses: Vec<Pose> = (0..5)
            .map(|_| {
                let angle = between(&mut random, -3.0, 3.0);
                let at = guide.point + guide.direction.scale(between(&mut random, -3.0, 3.0));
                Pose {
                    origin: at - C::from_polar(1.0, angle) * pin,
                    angle,
                }
            })
            .collect();
        let hit = |found: &[kempe_synthesis::DyadSolution]| {
            found.iter().any(|d| match d.dyad {
                Dyad::Pr { guide: g, moving } => {
                    (moving - pin).norm() < 1e-7 && g.distance(guide.point).abs() < 1e-7
                }
                _ => false,
            })
        };
        let four = fixed_guides(&poses[..4], &[]).unwrap();
        let on = SliderCondition::PinOn(Line::at_angle(pin, 0.3));
        let three = fixed_guides(&poses[..3], &[on]).unwrap();
        let along = SliderCondition::Along(guide.direction.arg());
        let with_direction = fixed_guides(&poses[..3], &[along]).unwrap();
        let two = fixed_guides(&poses[..2], &[SliderCondition::PinAt(pin)]).unwrap();
        // Five poses that a slider keeps are so special that it is one of the four dyads.
        let five = dyads(&poses, &[]).unwrap();
        let all = [&four, &three, &with_direction, &two, &five];
        let inverse: Vec<Pose> = poses.iter().map(Pose::inverse).collect();
        let moving = moving_guides(&inverse[..4], &[]).unwrap();
        let inverted = moving.iter().any(|d| match d.dyad {
            Dyad::Rp { fixed, .. } => (fixed - pin).norm() < 1e-7,
            _ => false,
        });
        if !all.iter().all(|found| hit(found)) || !inverted {
            missed += 1;
        }
    }
    println!("{missed}");
    assert!(missed <= 10, "{missed}");
}

#[test]
fn other_units_places_and_directions_change_nothing() {
    let mut random = Random(11);
    for _ in 0..300 {
        let bar = RandomFourBar::new(&mut random);
        let Some((poses, _)) = bar.poses(&mut random, 5, 0.3) else {
            continue;
        };
        let plain = rr(&dyads(&poses, &[]).unwrap());
        for (scale, turn, shift) in [
            (1e-6, 0.0, C::zero()),
            (1e6, 1.0, C::zero()),
            (1.0, 2.5, C::new(300.0, -700.0)),
            (1.0, -0.7, C::new(-1e6, 3e5)),
        ] {
            let other = moved(&poses, scale, turn, shift);
            let found = rr(&dyads(&other, &[]).unwrap());
            assert_eq!(found.len(), plain.len());
            for (g, z, _) in &plain {
                let (g, z) = (shift + C::from_polar(scale, turn) * *g, z.scale(scale));
                let near = (found.iter())
                    .map(|(f, m, _)| (*f - g).norm().max((*m - z).norm()))
                    .fold(f64::INFINITY, f64::min);
                // What the shift leaves of the data's digits.
                let digits = 1e-6 + 1e-9 * shift.norm() / scale;
                let size = scale + z.norm();
                assert!(near < digits * size, "{near:e} {scale}");
            }
        }
    }
}

#[test]
fn five_poses_of_a_guide_on_the_body() {
    let mut random = Random(12);
    for _ in 0..2000 {
        let pivot = place(&mut random, 2.0);
        let guide = Line::at_angle(place(&mut random, 2.0), between(&mut random, -3.0, 3.0));
        // The guide's point at the pivot is another in every pose.
        let poses: Vec<Pose> = (0..5)
            .map(|_| {
                let angle = between(&mut random, -3.0, 3.0);
                let on = guide.point + guide.direction.scale(between(&mut random, -3.0, 3.0));
                Pose {
                    origin: pivot - C::from_polar(1.0, angle) * on,
                    angle,
                }
            })
            .collect();
        let hit = |found: &[kempe_synthesis::DyadSolution]| {
            found.iter().any(|d| match d.dyad {
                Dyad::Rp { fixed, guide: g } => {
                    (fixed - pivot).norm() < 1e-6 && g.distance(guide.point).abs() < 1e-6
                }
                _ => false,
            })
        };
        assert!(hit(&dyads(&poses, &[]).unwrap()));
        // Given the pivot and three poses: also the guide, since no circle does it.
        assert!(hit(
            &dyads(&poses[..3], &[DyadCondition::FixedAt(pivot)]).unwrap()
        ));
    }
}

/// Complex solutions of real equations come in pairs, so the real ones of four are even in number, wherever the points lie.
#[test]
fn five_poses_have_an_even_number_of_dyads() {
    let mut random = Random(14);
    let mut counts = [0; 5];
    for case in 0..20_000 {
        let line = Line::at_angle(place(&mut random, 2.0), between(&mut random, -3.0, 3.0));
        let poses: Vec<Pose> = (0..5)
            .map(|_| Pose {
                origin: if case % 2 == 0 {
                    line.point + line.direction.scale(between(&mut random, -3.0, 3.0))
                } else {
                    place(&mut random, 2.0)
                },
                angle: between(&mut random, -3.0, 3.0),
            })
            .collect();
        let found = dyads(&poses, &[]).unwrap();
        counts[found.iter().map(|d| d.multiplicity).sum::<usize>()] += 1;
    }
    println!("{counts:?}");
    assert!(counts[1] + counts[3] <= 2, "{counts:?}");
    assert!(counts[0] > 100 && counts[2] > 1000 && counts[4] > 100);
}

#[test]
fn small_displacements_and_far_origins_keep_their_dyads() {
    let mut random = Random(13);
    let (mut cases, mut worst, mut missed) = (0, [0.0_f64; 2], 0);
    while cases < 1000 {
        let bar = RandomFourBar::new(&mut random);
        let start = between(&mut random, -3.0, 3.0);
        // Five poses within a hundredth of a turn: pivots are known to what is left of the digits.
        let angles = [0.0, 0.02, 0.035, 0.05, 0.06].map(|a| start + a);
        let poses: Vec<Pose> = angles.iter().filter_map(|a| bar.pose(*a)).collect();
        if poses.len() < 5 {
            continue;
        }
        cases += 1;
        let Ok(found) = dyads(&poses, &[]) else {
            continue;
        };
        for k in 0..2 {
            let near = nearest(&found, bar.fixed[k], bar.moving[k]);
            if near < 0.01 {
                worst[0] = worst[0].max(near);
            } else {
                missed += 1;
            }
        }
        // The body's origin a thousand lengths away.
        let Some((poses, _)) = bar.poses(&mut random, 5, 0.3) else {
            continue;
        };
        let away = C::new(1200.0, -700.0);
        let far: Vec<Pose> = (poses.iter())
            .map(|p| Pose {
                origin: p.place(away),
                ..*p
            })
            .collect();
        let found = dyads(&far, &[]).unwrap();
        for k in 0..2 {
            worst[1] = worst[1].max(nearest(&found, bar.fixed[k], bar.moving[k] - away));
        }
    }
    println!("{worst:?}, {missed} missed of {}", 2 * cases);
    assert!(worst[1] < 1e-5 && missed <= 2);
}

#[test]
fn special_poses_are_told() {
    let poses = degrees(&[
        (0.0, 0.0, 0.0),
        (1.0, 0.3, 20.0),
        (2.0, 0.1, 35.0),
        (3.0, 1.0, 60.0),
        (3.5, 2.0, 90.0),
    ]);
    let mut repeated = poses.clone();
    repeated[3] = Pose {
        angle: poses[1].angle + std::f64::consts::TAU,
        ..poses[1]
    };
    assert_eq!(
        dyads(&repeated, &[]),
        Err(SynthesisError::Repeated {
            first: 1,
            second: 3
        })
    );
    let slid: Vec<Pose> = poses.iter().map(|p| Pose { angle: 0.4, ..*p }).collect();
    assert_eq!(dyads(&slid, &[]), Err(SynthesisError::Translations));
    let centre = C::new(3.0, -2.0);
    let turned: Vec<Pose> = (poses.iter())
        .map(|p| Pose {
            origin: centre + p.turn() * C::new(1.0, 5.0),
            ..*p
        })
        .collect();
    match dyads(&turned, &[]) {
        Err(SynthesisError::OnePole { pole }) => assert!((pole - centre).norm() < 1e-13),
        other => panic!("{other:?}"),
    }
    let mut infinite = poses.clone();
    infinite[2].angle = f64::NAN;
    assert_eq!(
        dyads(&infinite, &[]),
        Err(SynthesisError::NotFinite { datum: 2 })
    );
    assert_eq!(
        dyads(&poses[..4], &[]),
        Err(SynthesisError::TooFew {
            equations: 3,
            unknowns: 4
        })
    );
    let at = DyadCondition::FixedAt(C::zero());
    assert_eq!(
        dyads(&poses, &[at]),
        Err(SynthesisError::TooMany {
            equations: 6,
            unknowns: 4
        })
    );
    // A pivot in a pole turns with the body: any link will do.
    let in_pole = DyadCondition::FixedAt(pole(&poses[0], &poses[1]).unwrap());
    assert!(matches!(
        dyads(&poses[..3], &[in_pole]),
        Err(SynthesisError::Dependent { .. })
    ));
    // A parallelogram carries its coupler along without turning it: any of its like does. Given a pivot there is one.
    let parallel: Vec<Pose> = (0..5)
        .map(|k| Pose {
            origin: C::from_polar(1.0, 0.4 * k as f64),
            angle: 0.1,
        })
        .collect();
    assert_eq!(dyads(&parallel, &[]), Err(SynthesisError::Translations));
    let pivot = C::new(2.0, 3.0);
    let found = rr(&dyads(&parallel[..3], &[DyadCondition::FixedAt(pivot)]).unwrap());
    assert!((found[0].2 - 1.0).abs() < 1e-13);
    assert!((parallel[0].place(found[0].1) - pivot - parallel[0].origin).norm() < 1e-13);
    let back = rr(&dyads(&parallel[..3], &[DyadCondition::MovingAt(found[0].1)]).unwrap());
    assert!((back[0].0 - pivot).norm() < 1e-13);
    // Shifts along a line: no circle.
    let along = [0.0, 1.0, 3.0].map(|x| Pose::new(x, 0.0, 0.2));
    let found = dyads(&along, &[DyadCondition::FixedAt(pivot)]);
    assert!(
        found
            .as_ref()
            .is_ok_and(|f| f.iter().all(|d| !matches!(d.dyad, Dyad::Rr { .. }))),
        "{found:?}"
    );
}

/// Poses for which a dyad is a double one: the turn of its link in the last is where the equations' derivative is singular.
#[test]
fn a_double_dyad_counts_twice() {
    let mut random = Random(21);
    let mut seen = 0;
    while seen < 200 {
        let (g, z) = (place(&mut random, 2.0), place(&mut random, 2.0));
        let length = between(&mut random, 0.5, 2.0);
        let angles: Vec<[f64; 2]> = (0..5)
            .map(|_| [0, 1].map(|_| between(&mut random, -3.0, 3.0)))
            .collect();
        let poses = |last: f64| -> Vec<Pose> {
            (angles.iter().enumerate())
                .map(|(k, [link, body])| {
                    let link = if k == 4 { last } else { *link };
                    let at = g + C::from_polar(length, link);
                    Pose {
                        origin: at - C::from_polar(1.0, *body) * z,
                        angle: *body,
                    }
                })
                .collect()
        };
        // The rows of the derivative: by the moving and the fixed pivot, less those of the first pose.
        let singular = |last: f64| {
            let poses = poses(last);
            let of = |p: &Pose| {
                let link = p.place(z) - g;
                let by_moving = p.turn().conj() * link;
                [by_moving.re, by_moving.im, -link.re, -link.im]
            };
            let first = of(&poses[0]);
            let rows: Vec<[f64; 4]> = (poses[1..].iter())
                .map(|p| std::array::from_fn(|k| of(p)[k] - first[k]))
                .collect();
            determinant(&rows)
        };
        let (mut low, mut high) = (
            between(&mut random, -3.0, 0.0),
            between(&mut random, 0.0, 3.0),
        );
        if singular(low) * singular(high) > 0.0 {
            continue;
        }
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if singular(low) * singular(middle) <= 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        let Ok(found) = dyads(&poses(low), &[]) else {
            continue;
        };
        if angles[..4]
            .iter()
            .any(|a| kempe_number::math::sin(a[0] - low).abs() < 1e-6)
        {
            continue;
        }
        seen += 1;
        let hit: usize = (found.iter())
            .filter(|d| match d.dyad {
                Dyad::Rr { fixed, moving, .. } => {
                    (fixed - g).norm().max((moving - z).norm()) < 3e-5
                }
                _ => false,
            })
            .map(|d| d.multiplicity)
            .sum();
        assert_eq!(hit, 2, "{seen} {found:?} {g:?} {z:?}");
    }
}

fn determinant(rows: &[[f64; 4]]) -> f64 {
    let minor = |skip: usize| {
        let c: Vec<usize> = (0..4).filter(|k| *k != skip).collect();
        let at = |r: usize, k: usize| rows[r][c[k]];
        at(1, 0) * (at(2, 1) * at(3, 2) - at(2, 2) * at(3, 1))
            - at(1, 1) * (at(2, 0) * at(3, 2) - at(2, 2) * at(3, 0))
            + at(1, 2) * (at(2, 0) * at(3, 1) - at(2, 1) * at(3, 0))
    };
    (0..4)
        .map(|k| if k % 2 == 0 { 1.0 } else { -1.0 } * rows[0][k] * minor(k))
        .sum()
}
