//! Path generation: references, linkages recovered, cognates.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use crate::support::{RandomFourBar, between, place};
use kempe_number::Random;
use kempe_synthesis::{
    C, CouplerCurve, DyadCondition, FourBar, Line, Linkage, PathLinkage, SynthesisError,
    paths_with_crank, paths_with_ground_pivots, timed_paths,
};

/// How near one of the linkages comes to a four-bar: its fixed pivots, and its moving ones at the first point.
fn nearest(found: &[PathLinkage], fixed: [C; 2], moving: [C; 2]) -> f64 {
    (found.iter())
        .filter_map(|f| match f.linkage {
            Linkage::FourBar(bar) => {
                let places = bar.places(&f.poses[0]);
                let off = |k: usize| {
                    (bar.fixed[k] - fixed[k])
                        .norm()
                        .max((places[k] - moving[k]).norm())
                };
                Some(off(0).max(off(1)))
            }
            _ => None,
        })
        .fold(f64::INFINITY, f64::min)
}

/// Lengths are kept and the origin is at the points, in every pose.
fn holds(found: &[PathLinkage], points: &[C], tolerance: f64) {
    for f in found {
        let Linkage::FourBar(bar) = f.linkage else {
            continue;
        };
        let size = 1.0 + bar.lengths[0] + bar.lengths[1];
        for (pose, point) in f.poses.iter().zip(points) {
            assert!((pose.origin - *point).norm() < 1e-12 * size);
            for (k, p) in bar.places(pose).into_iter().enumerate() {
                let off = (p - bar.fixed[k]).norm() - bar.lengths[k];
                assert!(off.abs() < tolerance * size, "{off:e} {f:?}");
            }
        }
    }
}

#[test]
fn five_points_in_line_with_ground_pivots() {
    // Morgan and Wampler's problem 7.
    let points = [
        (0.50, 1.06),
        (-0.83, -0.27),
        (-0.34, 0.22),
        (-0.13, 0.43),
        (0.22, 0.78),
    ]
    .map(|(x, y)| C::new(x, y));
    let known = [
        [1.4739209688, -1.7112847482, -0.6546798465, 0.0289071669],
        [-11.0926159017, 0.4508639353, -0.3962073023, -1.0417282129],
        [0.6761786574, -0.6136509530, 0.3560555237, 0.3107945008],
        [-0.1580772611, -0.7937825513, -0.5487617827, 0.2781168297],
        [14.2653066319, -6.5157653090, -0.6217910317, -0.0713939585],
        [-0.5957286288, -0.6170109177, 0.1181713537, -1.8293926756],
        [-1.7917866490, 1.0461320741, -1.4648633840, 1.2167634717],
        [-0.0877960435, -0.8513869075, 0.2358373913, -1.4189920270],
        [-0.1546977093, -0.8126262792, 3.3014571565, -2.3186032305],
        [-1.0856845754, -0.3529984889, 0.3190284751, 0.6878832607],
        [0.0193359268, -0.9377570110, 1.2222666911, -1.0828508774],
        [-0.0801573082, -0.8552752402, -0.2973218626, -2.1841438867],
        [0.1306437556, -0.9425160538, 0.9637297351, -1.0157758723],
        [-0.3587578616, -0.5372304341, 0.0870595124, 1.5543474029],
        [-0.2646409200, -0.6969115278, 0.3703687464, -1.5422117342],
    ];
    let pivots = [C::zero(), C::one()];
    let found = paths_with_ground_pivots(&points, pivots, None).unwrap();
    println!(
        "{} {} {} {}",
        found.generic, found.finite, found.infinite, found.lost
    );
    // Three of the 36 go to infinity, like cube roots: a coupler on endless links that slides along the line without turning. (Counts of 36
    // finite solutions take them for finite; 33 is also what a program with an endgame reports.)
    assert_eq!((found.generic, found.finite, found.infinite), (36, 33, 3));
    assert_eq!(found.linkages.len(), 15);
    holds(&found.linkages, &points, 1e-12);
    for [x, x1, y, y1] in known {
        let moving = [C::new(x, x1) + points[0], C::new(y, y1) + points[0]];
        let near = nearest(&found.linkages, pivots, moving);
        assert!(near < 2e-10 * (1.0 + moving[0].norm()), "{near:e}");
    }
    // The published one with its turns.
    let published = (found.linkages.iter())
        .find(|f| {
            nearest(
                std::slice::from_ref(f),
                pivots,
                [
                    C::new(-0.0877960434509, -0.851386907516) + points[0],
                    C::new(0.235837391307, -1.41899202704) + points[0],
                ],
            ) < 1e-11
        })
        .unwrap();
    for (pose, turn) in published.poses[1..].iter().zip([
        1.44734213756,
        0.928413708131,
        0.751699211109,
        0.387116282208,
    ]) {
        assert!((pose.angle - turn).abs() < 1e-11);
    }
    // In other units, turned and moved.
    let other = |p: C| C::new(3e5, -2e5) + C::from_polar(1e6, 2.0) * p;
    let moved = paths_with_ground_pivots(&points.map(other), pivots.map(other), None).unwrap();
    assert_eq!((moved.finite, moved.linkages.len()), (33, 15));
}

#[test]
fn random_four_bars_are_among_those_with_their_ground_pivots() {
    with_ground_pivots(if cfg!(debug_assertions) { 40 } else { 300 });
}

#[test]
#[ignore = "minutes: cargo nextest run -p kempe-synthesis --run-ignored only --no-capture"]
fn ten_thousand_four_bars_with_their_ground_pivots() {
    with_ground_pivots(10_000);
}

fn with_ground_pivots(count: usize) {
    let mut random = Random(61);
    let (mut cases, mut missed, mut lost, mut whole) = (0, [0; 2], 0, 0);
    while cases < count {
        let bar = RandomFourBar::new(&mut random);
        let Some((poses, _)) = bar.poses(&mut random, 5, 0.3) else {
            continue;
        };
        cases += 1;
        let points: Vec<C> = poses.iter().map(|p| p.origin).collect();
        let moving = bar.moving.map(|m| poses[0].place(m));
        let found = paths_with_ground_pivots(&points, bar.fixed, None).unwrap();
        lost += found.lost;
        whole += usize::from(found.finite == 36);
        holds(&found.linkages, &points, 1e-9);
        missed[0] += usize::from(nearest(&found.linkages, bar.fixed, moving) > 1e-5);
        let line = Line::at_angle(moving[0], between(&mut random, 0.0, 3.0));
        let four = paths_with_ground_pivots(&points[..4], bar.fixed, Some(line)).unwrap();
        missed[1] += usize::from(nearest(&four.linkages, bar.fixed, moving) > 1e-5);
        if cases == 1 {
            println!("with a line: {}", four.generic);
        }
    }
    println!("missed {missed:?} of {cases}; paths lost {lost}; all 36 finite in {whole}");
    assert!(missed.iter().all(|m| *m * 1000 <= cases), "{missed:?}");
}

#[test]
fn random_four_bars_are_among_those_with_their_timing() {
    let mut random = Random(62);
    let (mut cases, mut missed) = (0, [0; 3]);
    while cases < 10_000 {
        let bar = RandomFourBar::new(&mut random);
        let Some((poses, angles)) = bar.poses(&mut random, 5, 0.2) else {
            continue;
        };
        cases += 1;
        let points: Vec<C> = poses.iter().map(|p| p.origin).collect();
        let zero = between(&mut random, -3.0, 3.0);
        let turns: Vec<f64> = angles.iter().map(|a| a - zero).collect();
        let moving = bar.moving.map(|m| poses[0].place(m));
        let on = [0, 1].map(|k| {
            DyadCondition::FixedOn(Line::at_angle(bar.fixed[k], between(&mut random, 0.0, 3.0)))
        });
        let at = bar.fixed.map(DyadCondition::FixedAt);
        let asked = [
            (5, vec![], vec![]),
            (4, vec![on[0]], vec![on[1]]),
            (3, vec![at[0]], vec![at[1]]),
        ];
        for (k, (count, crank, other)) in asked.iter().enumerate() {
            let found = timed_paths(&points[..*count], &turns[..*count], crank, other).unwrap();
            assert!(found.len() <= [12, 9, 1][k]);
            if cases % 10 == 0 {
                holds(&found, &points[..*count], 1e-8);
            }
            missed[k] += usize::from(nearest(&found, bar.fixed, moving) > 1e-5);
        }
    }
    println!("{missed:?}");
    assert!(missed.iter().all(|m| *m <= 10), "{missed:?}");
}

#[test]
fn random_four_bars_are_among_those_with_their_crank() {
    with_crank(10);
}

#[test]
#[ignore = "minutes: cargo nextest run -p kempe-synthesis --run-ignored only --no-capture"]
fn ten_thousand_four_bars_with_their_crank() {
    with_crank(1);
}

/// Ten thousand cases, of five points only each of so many.
fn with_crank(every: usize) {
    let mut random = Random(63);
    let (mut cases, mut missed) = (0, [0; 3]);
    while cases < 10_000 {
        let bar = RandomFourBar::new(&mut random);
        let Some((poses, _)) = bar.poses(&mut random, 5, 0.2) else {
            continue;
        };
        cases += 1;
        let points: Vec<C> = poses.iter().map(|p| p.origin).collect();
        let moving = bar.moving.map(|m| poses[0].place(m));
        let on =
            DyadCondition::FixedOn(Line::at_angle(bar.fixed[1], between(&mut random, 0.0, 3.0)));
        let asked = [
            (5, vec![]),
            (4, vec![on]),
            (3, vec![DyadCondition::FixedAt(bar.fixed[1])]),
        ];
        for (k, (count, other)) in asked.iter().enumerate() {
            if k == 0 && cases % every > 0 {
                continue;
            }
            let found =
                paths_with_crank(&points[..*count], bar.fixed[0], moving[0], other).unwrap();
            missed[k] += usize::from(nearest(&found, bar.fixed, moving) > 1e-5);
        }
    }
    println!("{missed:?}");
    assert!(
        missed[0] * every <= 10 && missed.iter().all(|m| *m <= 10),
        "{missed:?}"
    );
}

#[test]
fn cognates_trace_one_curve_and_the_third_of_the_third_is_the_first() {
    let mut random = Random(64);
    let mut cases = 0;
    while cases < 500 {
        let bar = RandomFourBar::new(&mut random);
        let Some((poses, _)) = bar.poses(&mut random, 6, 0.05) else {
            continue;
        };
        cases += 1;
        let four_bar = FourBar {
            fixed: bar.fixed,
            moving: bar.moving,
            lengths: bar.lengths,
        };
        let point = place(&mut random, 2.0);
        let at = |k: usize| CouplerCurve::of(&four_bar, &poses[k], point);
        let first = at(0);
        let size = 1.0 + 10.0 / (bar.moving[0] - bar.moving[1]).norm();
        let [second, third] = first.cognates().unwrap();
        let back = third.next().unwrap();
        for k in 0..2 {
            assert!((back.fixed[k] - first.fixed[k]).norm() < 1e-10 * size * size);
            assert!((back.moving[k] - first.moving[k]).norm() < 1e-10 * size * size);
        }
        // As the first four-bar moves, the others keep pivots and lengths, and their links turn as told.
        let focus = first.third_focus().unwrap();
        for k in 1..6 {
            let there = at(k);
            let [second_there, third_there] = there.cognates().unwrap();
            assert!((there.third_focus().unwrap() - focus).norm() < 1e-10 * size * size);
            for (one, other) in [(second, second_there), (third, third_there)] {
                let lengths = |c: &CouplerCurve| {
                    [
                        (c.moving[0] - c.fixed[0]).norm(),
                        (c.moving[1] - c.moving[0]).norm(),
                        (c.moving[1] - c.fixed[1]).norm(),
                        (c.moving[0] - c.point).norm(),
                    ]
                };
                for (a, b) in lengths(&one).iter().zip(lengths(&other)) {
                    assert!((a - b).abs() < 1e-10 * size * size);
                }
            }
            // The carried link does not turn, the shared one is rigid, the added one keeps its length.
            let (six, six_there) = (
                first.parallel_motion().unwrap(),
                there.parallel_motion().unwrap(),
            );
            let still = |s: &kempe_synthesis::ParallelMotion| s.carried[1] - s.carried[0];
            assert!((still(&six) - still(&six_there)).norm() < 1e-10 * size * size);
            assert!((six.carried[0] - first.point).norm() == 0.0);
            let [o, b, p] = six.shared;
            let [o2, b2, p2] = six_there.shared;
            assert!((o - o2).norm() < 1e-12);
            let shape = (p - o) * (b - o).recip() - (p2 - o) * (b2 - o).recip();
            assert!(shape.norm() < 1e-9 * size * size, "{shape:?}");
            let link = |s: &kempe_synthesis::ParallelMotion| (s.coupler[1] - s.coupler[0]).norm();
            assert!((link(&six) - link(&six_there)).abs() < 1e-10 * size * size);
            assert!(
                (six.coupler[1] - six.carried[1]).norm() == 0.0
                    && (six.coupler[0] - p).norm() == 0.0
            );
        }
    }
}

#[test]
fn special_data_are_told() {
    let points: Vec<C> = [(0.0, 0.0), (1.0, 0.5), (2.0, 0.2), (2.5, -1.0), (1.0, -1.2)]
        .iter()
        .map(|(x, y)| C::new(*x, *y))
        .collect();
    assert_eq!(
        timed_paths(&points, &[0.0, 1.0], &[], &[]),
        Err(SynthesisError::Lengths {
            first: 5,
            second: 2
        })
    );
    let mut repeated = points.clone();
    repeated[3] = repeated[1];
    let pivots = [C::new(0.0, 1.0), C::new(2.0, 1.0)];
    assert_eq!(
        paths_with_ground_pivots(&repeated, pivots, None),
        Err(SynthesisError::Repeated {
            first: 1,
            second: 3
        })
    );
    assert_eq!(
        paths_with_ground_pivots(&points, [pivots[0]; 2], None),
        Err(SynthesisError::Repeated {
            first: 5,
            second: 6
        })
    );
    assert!(matches!(
        paths_with_ground_pivots(&points[..4], pivots, None),
        Err(SynthesisError::TooFew {
            equations: 3,
            unknowns: 4
        })
    ));
    assert!(matches!(
        paths_with_crank(&points, C::new(0.0, 9.0), C::new(0.0, 8.0), &[]),
        Err(SynthesisError::OutOfRange { .. })
    ));
}
