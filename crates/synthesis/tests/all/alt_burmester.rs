//! Nine points, and poses with points: linkages recovered, references, bad and special data.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use std::cell::Cell;
use std::ops::ControlFlow;

use crate::support::{RandomFourBar, moved};
use kempe_number::Random;
use kempe_synthesis::{
    C, CouplerCurve, FourBar, FourBarsThrough, Linkage, OnCurve, Pose, SynthesisError,
    four_bars_through,
};

fn go_on(_: usize, _: usize) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

fn bars(found: &FourBarsThrough) -> impl Iterator<Item = (FourBar, &[Pose])> {
    found.four_bars.iter().map(|f| match f.path.linkage {
        Linkage::FourBar(bar) => (bar, f.path.poses.as_slice()),
        _ => panic!("no four-bar"),
    })
}

/// How near one of the linkages comes to a four-bar, beside its size.
fn nearest(found: &FourBarsThrough, fixed: [C; 2], moving: [C; 2]) -> f64 {
    let size = 1.0 + fixed[0].norm() + fixed[1].norm();
    bars(found)
        .flat_map(|(bar, poses)| {
            [bar, bar.exchanged()].map(|bar| {
                let places = bar.places(&poses[0]);
                let off = |k: usize| {
                    (bar.fixed[k] - fixed[k])
                        .norm()
                        .max((places[k] - moving[k]).norm())
                };
                off(0).max(off(1)) / size
            })
        })
        .fold(f64::INFINITY, f64::min)
}

/// Lengths are kept in every pose, given poses are taken and points passed.
fn holds(found: &FourBarsThrough, poses: &[Pose], points: &[C], unit: f64) {
    for (bar, through) in bars(found) {
        let size = unit + bar.lengths[0] + bar.lengths[1] + bar.moving[0].norm();
        assert_eq!(&through[..poses.len()], poses);
        let passed: Vec<C> = through[poses.len()..].iter().map(|p| p.origin).collect();
        assert_eq!(passed, points);
        for pose in through {
            for (k, p) in bar.places(pose).into_iter().enumerate() {
                let off = (p - bar.fixed[k]).norm() - bar.lengths[k];
                assert!(off.abs() < 1e-9 * size, "{off:e} {bar:?}");
            }
        }
    }
}

/// A random four-bar with so many poses of it.
fn made(random: &mut Random, count: usize) -> (RandomFourBar, Vec<Pose>) {
    loop {
        let bar = RandomFourBar::new(random);
        if let Some((poses, _)) = bar.poses(random, count, 0.15) {
            return (bar, poses);
        }
    }
}

fn round_trip(given: usize, seeds: std::ops::Range<u64>) {
    let points = if given == 0 { 9 } else { 10 - 2 * given };
    for seed in seeds {
        let mut random = Random(seed);
        let (bar, all) = made(&mut random, given + points);
        let (poses, rest) = all.split_at(given);
        let points: Vec<C> = rest.iter().map(|p| p.origin).collect();
        let found = four_bars_through(poses, &points, &go_on).unwrap();
        holds(&found, poses, &points, 1.0);
        let moving = bar.moving.map(|m| all[0].place(m));
        let off = nearest(&found, bar.fixed, moving);
        println!(
            "{given} poses, seed {seed}: {} finite, {} infinite, {} singular, {} lost, {} real, {} certified, off {off:.1e}",
            found.finite,
            found.infinite,
            found.singular,
            found.lost,
            found.four_bars.len(),
            found.four_bars.iter().filter(|f| f.certified).count()
        );
        assert!(off < 1e-7, "{off:e}");
        // Five poses are solved in closed form, without a proof.
        assert!(given == 5 || found.four_bars.iter().all(|f| f.certified));
        assert_eq!(found.lost, 0);
        let counted = found.finite + found.infinite + found.singular + found.lost;
        assert!(given == 5 || counted == found.generic);
    }
}

#[test]
fn nine_points_of_a_four_bar_give_it_back() {
    round_trip(0, 1..6);
    // Two of its curves are nearly one: they are proved with twice the digits.
    round_trip(0, 30..31);
}

#[test]
#[ignore = "minutes: cargo nextest run -p kempe-synthesis --run-ignored only --no-capture"]
fn nine_points_of_two_hundred_four_bars_give_them_back() {
    round_trip(0, 1..201);
}

#[test]
fn poses_and_points_of_a_four_bar_give_it_back() {
    round_trip(1, 11..13);
    round_trip(2, 21..26);
    round_trip(3, 31..41);
    round_trip(4, 41..61);
    round_trip(5, 61..71);
}

#[test]
fn three_cognates_trace_each_curve() {
    let mut random = Random(7);
    let (_, all) = made(&mut random, 9);
    let points: Vec<C> = all.iter().map(|p| p.origin).collect();
    let found = four_bars_through(&[], &points, &go_on).unwrap();
    let all: Vec<(FourBar, &[Pose])> = bars(&found).collect();
    assert!(!all.is_empty() && all.len().is_multiple_of(3));
    for (three, of) in all.chunks(3).zip(found.four_bars.chunks(3)) {
        assert!(of.iter().all(|f| f.solution == of[0].solution));
        let curve = |k: usize| CouplerCurve::of(&three[k].0, &three[k].1[0], C::zero());
        for k in 0..3 {
            let (next, same) = (curve(k).next().unwrap(), curve((k + 1) % 3));
            let size = 1.0 + next.fixed[0].norm() + next.fixed[1].norm() + next.moving[0].norm();
            for k in 0..2 {
                assert!((next.fixed[k] - same.fixed[k]).norm() < 1e-7 * size);
                assert!((next.moving[k] - same.moving[k]).norm() < 1e-7 * size);
            }
        }
    }
}

#[test]
fn neither_unit_nor_origin_matter() {
    let mut random = Random(8);
    for given in [0, 2, 4] {
        let (_, all) = made(&mut random, if given == 0 { 9 } else { 10 - given });
        for (scale, shift) in [(1e-150, 0.0), (1e150, 1e150), (1e-3, 1e3)] {
            let all = moved(&all, scale, 0.7, C::new(shift, -shift));
            let (poses, rest) = all.split_at(given);
            let points: Vec<C> = rest.iter().map(|p| p.origin).collect();
            let found = four_bars_through(poses, &points, &go_on).unwrap();
            println!(
                "{given} poses, {scale:e}: {} finite, {} real, {} certified",
                found.finite,
                found.four_bars.len(),
                found.four_bars.iter().filter(|f| f.certified).count()
            );
            assert!(!found.four_bars.is_empty());
            assert_eq!(found.finite, found.generic);
        }
    }
}

#[test]
fn special_points_are_answered() {
    let line = |k: u32| C::new(f64::from(k), 0.0);
    let circle = |k: u32| C::from_polar(1.0, 0.6 * f64::from(k));
    for (curve, made) in [
        (OnCurve::Line, &line as &dyn Fn(u32) -> C),
        (OnCurve::Circle, &circle),
    ] {
        let points: Vec<C> = (0..9).map(made).collect();
        let refused = four_bars_through(&[], &points, &go_on).unwrap_err();
        assert!(
            matches!(refused, SynthesisError::OneCurve { curve: on, count: 9, .. } if on == curve),
            "{refused:?}"
        );
    }
    // As many as a coupler curve can have.
    let six = |made: &dyn Fn(u32) -> C| -> Vec<C> {
        let others = [(1.3, 1.7), (2.4, -1.1), (4.1, 0.9)];
        let others = others.map(|(x, y)| C::new(x, y));
        (0..6).map(made).chain(others).collect()
    };
    let mirrored: Vec<C> = (0..9)
        .map(|k| {
            let t = f64::from(k) - 4.0;
            C::new(t, 0.1 * t * t + 0.05 * t * t * t * t * 0.1)
        })
        .collect();
    for points in [six(&line), six(&circle), mirrored] {
        let begin = std::time::Instant::now();
        let found = four_bars_through(&[], &points, &go_on).unwrap();
        println!(
            "{} finite, {} infinite, {} singular, {} lost, {} real, {} certified, {:.2} s",
            found.finite,
            found.infinite,
            found.singular,
            found.lost,
            found.four_bars.len(),
            found.four_bars.iter().filter(|f| f.certified).count(),
            begin.elapsed().as_secs_f64()
        );
        holds(&found, &[], &points, 10.0);
        let counted = found.finite + found.infinite + found.singular + found.lost;
        assert_eq!(counted, found.generic);
    }
}

#[test]
fn bad_data_are_refused() {
    let mut random = Random(9);
    let (_, all) = made(&mut random, 9);
    let points: Vec<C> = all.iter().map(|p| p.origin).collect();
    let refused = |poses: &[Pose], points: &[C]| four_bars_through(poses, points, &go_on).err();
    let unknowns = 8;
    let too_few = |equations| {
        Some(SynthesisError::TooFew {
            equations,
            unknowns,
        })
    };
    assert_eq!(refused(&[], &[]), too_few(0));
    assert_eq!(refused(&[], &points[..8]), too_few(7));
    assert_eq!(refused(&all[..3], &points[3..6]), too_few(7));
    assert_eq!(
        refused(&all[..1], &points),
        Some(SynthesisError::TooMany {
            equations: 9,
            unknowns
        })
    );
    let mut broken = points.clone();
    broken[4].im = f64::NAN;
    assert_eq!(
        refused(&[], &broken),
        Some(SynthesisError::NotFinite { datum: 4 })
    );
    broken[4] = points[2];
    assert_eq!(
        refused(&[], &broken),
        Some(SynthesisError::Repeated {
            first: 2,
            second: 4
        })
    );
    assert_eq!(
        refused(&[], &[points[0]; 9]),
        Some(SynthesisError::Repeated {
            first: 0,
            second: 1
        })
    );
    let mut poses = all[..2].to_vec();
    poses[1] = poses[0];
    assert_eq!(
        refused(&poses, &points[2..8]),
        Some(SynthesisError::Repeated {
            first: 0,
            second: 1
        })
    );
    let far: Vec<C> = points.iter().map(|p| p.scale(1e308)).collect();
    assert!(four_bars_through(&[], &far, &go_on).is_ok() || refused(&[], &far).is_some());
}

#[test]
fn a_search_can_be_stopped() {
    let mut random = Random(10);
    let (_, all) = made(&mut random, 9);
    let points: Vec<C> = all.iter().map(|p| p.origin).collect();
    let calls = Cell::new(0);
    let stop = |ended: usize, of: usize| {
        assert!(ended <= of);
        calls.set(calls.get() + 1);
        ControlFlow::Break(())
    };
    let stopped = four_bars_through(&[], &points, &stop);
    assert_eq!(stopped.err(), Some(SynthesisError::Stopped));
    assert_eq!(calls.get(), 1);
}
