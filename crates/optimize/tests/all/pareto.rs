//! Fronts of E. Zitzler, K. Deb and L. Thiele's problems (ZDT, 2000) and of K. Deb, L. Thiele, M. Laumanns and E. Zitzler's (DTLZ, 2002) beside the
//! analytic ones.

use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::ControlFlow;

use crate::support::zdt::{several, zdt1, zdt2, zdt3, zdt4, zdt6};
use crate::support::{Case, D, cube};
use kempe_number::{Number, Random, math, powi};
use kempe_optimize::{
    Alone, Candidate, Ended, EndsFrom, Evaluation, Further, Generations, Nsga2, Nsga2Options,
    Problem, Refined, RefinedFront, SqpOptions, Widening, evaluate_all, hypervolume, nsga2, refine,
    silent, undominated, widen,
};

fn dtlz1() -> Case<7> {
    several(cube(7, 0.0, 1.0), 3, |x| {
        let term = |x: &D<7>| (*x - 0.5).square() - ((*x - 0.5) * (20.0 * PI)).sin_cos().1;
        let g = (x[2..].iter().fold(D::constant(5.0), |sum, x| sum + term(x))) * 100.0 + 1.0;
        let one = |x: D<7>| -x + 1.0;
        vec![
            x[0] * x[1] * g * 0.5,
            x[0] * one(x[1]) * g * 0.5,
            one(x[0]) * g * 0.5,
        ]
    })
}

fn dtlz2() -> Case<12> {
    several(cube(12, 0.0, 1.0), 3, |x| {
        let g = x[2..]
            .iter()
            .fold(D::constant(1.0), |sum, x| sum + (*x - 0.5).square());
        let ((s0, c0), (s1, c1)) = ((x[0] * FRAC_PI_2).sin_cos(), (x[1] * FRAC_PI_2).sin_cos());
        vec![c0 * c1 * g, c0 * s1 * g, s0 * g]
    })
}

fn objectives(members: &[Candidate]) -> Vec<Vec<f64>> {
    members
        .iter()
        .map(|c| c.evaluation.objectives.clone())
        .collect()
}

fn refined_objectives(front: &RefinedFront) -> Vec<Vec<f64>> {
    front
        .members
        .iter()
        .map(|m| m.candidate.evaluation.objectives.clone())
        .collect()
}

/// The front before and after refining: its part of the analytic volume, and how far refined designs are from the analytic front.
fn compare<const N: usize>(
    name: &str,
    case: impl Fn() -> Case<N>,
    options: &Nsga2Options,
    reference: &[f64],
    analytic: f64,
    miss: impl Fn(&[f64]) -> f64,
) -> [f64; 3] {
    let own = case();
    let front = nsga2(&own, options, &Alone, &mut silent);
    let before = hypervolume(&objectives(&front.members), reference) / analytic;
    let refined = refine(
        &own,
        &front.members,
        (&SqpOptions::default(), usize::MAX),
        &Alone,
        &mut silent,
    );
    let points = refined_objectives(&refined);
    let after = hypervolume(&points, reference) / analytic;
    // Where steps ended at an optimum, the designs are on the front.
    let optimal = refined.members.iter().filter(|m| m.ended.is_optimal());
    let optimal = optimal.map(|m| miss(&m.candidate.evaluation.objectives).abs());
    let misses: Vec<f64> = optimal.collect();
    assert!(misses.len() + 2 >= points.len(), "{name}");
    let worst = misses.iter().copied().fold(0.0, f64::max);
    let mean = misses.iter().sum::<f64>() / misses.len() as f64;
    println!(
        "{name}: volume {before:.5} -> {after:.5}, {} -> {} designs, evaluations {} + {}, miss {worst:.1e} (mean {mean:.1e}) residual {:.1e}",
        front.members.len(),
        points.len(),
        front.evaluations,
        refined.evaluations,
        refined.residual
    );
    let mut ends: Vec<(Ended, usize)> = Vec::new();
    for m in &refined.members {
        match ends.iter_mut().find(|e| e.0 == m.ended) {
            Some(e) => e.1 += 1,
            None => ends.push((m.ended, 1)),
        }
    }
    println!("  {ends:?}");
    [before, after, worst]
}

/// How far off the front a design is that is off its end, where a root's slope has no bound.
fn off_end(f: f64, miss: f64) -> f64 {
    if f < 1e-9 { 0.0 } else { miss }
}

fn check(name: &str, [before, after, worst]: [f64; 3], least: [f64; 3]) {
    assert!(before > least[0] && before < 1.0 + 1e-9, "{name}: {before}");
    assert!(after > least[1] && after < 1.0 + 1e-9, "{name}: {after}");
    assert!(worst < least[2], "{name}: {worst}");
}

fn options(evaluations: usize) -> Nsga2Options {
    Nsga2Options {
        evaluations,
        ..Nsga2Options::default()
    }
}

/// Volume below a front of f2 over f1 from zero to one, up to a reference, by Simpson's rule in the root of f1.
fn volume_of(f2: impl Fn(f64) -> f64, from: f64, reference: f64) -> f64 {
    let steps = 20_000;
    let (a, b) = (from.sqrt(), 1.0);
    let h: f64 = (b - a) / f64::from(steps);
    let at = |k: i32| {
        let root = a + h * f64::from(k);
        (reference - f2(root * root)) * 2.0 * root
    };
    let inner: f64 = (1..steps)
        .map(|k| at(k) * if k % 2 == 1 { 4.0 } else { 2.0 })
        .sum();
    (at(0) + at(steps) + inner) * h / 3.0 + (reference - 1.0) * (reference - f2(1.0))
}

#[test]
fn zdt1_and_2() {
    let convex = |f: f64| 1.0 - f.sqrt();
    let got = compare(
        "ZDT1",
        zdt1,
        &options(15_000),
        &[1.1; 2],
        volume_of(convex, 0.0, 1.1),
        |p| off_end(p[0], p[1] - convex(p[0])),
    );
    check("ZDT1", got, [0.97, 0.99, 1e-6]);
    let hollow = |f: f64| 1.0 - f * f;
    let got = compare(
        "ZDT2",
        zdt2,
        &options(15_000),
        &[1.1; 2],
        volume_of(hollow, 0.0, 1.1),
        |p| p[1] - hollow(p[0]),
    );
    check("ZDT2", got, [0.95, 0.985, 1e-6]);
}

#[test]
fn zdt3_has_a_front_in_pieces() {
    let curve = |f: f64| 1.0 - f.sqrt() - f * math::sin(10.0 * PI * f);
    // What dominates up to a place: the least of the curve so far.
    let steps = 200_000;
    let mut least = f64::INFINITY;
    let mut volume = 0.0;
    for k in 0..steps {
        let f = (f64::from(k) + 0.5) / f64::from(steps);
        least = least.min(curve(f));
        volume += (1.1 - least) / f64::from(steps);
    }
    volume += 0.1 * (1.1 - least);
    let got = compare("ZDT3", zdt3, &options(15_000), &[1.1; 2], volume, |p| {
        off_end(p[0], p[1] - curve(p[0]))
    });
    check("ZDT3", got, [0.97, 0.985, 1e-6]);
}

#[test]
fn zdt4_has_many_local_fronts() {
    let convex = |f: f64| 1.0 - f.sqrt();
    let got = compare(
        "ZDT4",
        zdt4,
        &options(30_000),
        &[1.1; 2],
        volume_of(convex, 0.0, 1.1),
        |p| off_end(p[0], p[1] - convex(p[0])),
    );
    check("ZDT4", got, [0.95, 0.985, 1e-6]);
}

#[test]
fn zdt6_is_uneven() {
    let hollow = |f: f64| 1.0 - f * f;
    let from = 0.280_775_318_8;
    let got = compare(
        "ZDT6",
        zdt6,
        &options(20_000),
        &[1.1; 2],
        volume_of(hollow, from, 1.1),
        |p| p[1] - hollow(p[0]),
    );
    // All along the front a fourth root rises without bound: derivatives lead near it, not onto it.
    check("ZDT6", got, [0.95, 0.97, 0.05]);
}

#[test]
fn dtlz_fronts_of_three_objectives() {
    let volume = 0.6_f64 * 0.6 * 0.6 - 0.125 / 6.0;
    let got = compare("DTLZ1", dtlz1, &options(40_000), &[0.6; 3], volume, |p| {
        p.iter().sum::<f64>() - 0.5
    });
    check("DTLZ1", got, [0.9, 0.95, 1e-6]);
    let volume = 1.1_f64 * 1.1 * 1.1 - PI / 6.0;
    let got = compare("DTLZ2", dtlz2, &options(15_000), &[1.1; 3], volume, |p| {
        p.iter().map(|x| x * x).sum::<f64>().sqrt() - 1.0
    });
    check("DTLZ2", got, [0.85, 0.87, 1e-6]);
}

/// Squares of distances to two centres, and a quarter of a circle, which is hollow.
fn bulging() -> Case<2> {
    several(cube(2, -2.0, 2.0), 2, |[x, y]| {
        vec![x.square() + y.square(), (*x - 1.0).square() + y.square()]
    })
}

fn hollow() -> Case<2> {
    several(vec![[0.0, 1.0], [-1.0, 1.0]], 2, |[x, y]| {
        let (sin, cos) = (*x * FRAC_PI_2).sin_cos();
        let far = y.square() + 1.0;
        vec![sin * far, cos * far]
    })
}

fn candidates(case: &Case<2>, designs: &[[f64; 2]]) -> Vec<Candidate> {
    let all = designs.iter().map(|design| Candidate {
        design: design.to_vec(),
        evaluation: case.evaluate(design),
    });
    all.collect()
}

/// Fronts of which only designs near the middle are known, led to their ends and filled.
#[test]
fn a_front_reaches_its_ends_and_has_no_gaps() {
    // On the one roots sum to one, on the other squares.
    for (case, power) in [(bulging(), 0.5), (hollow(), 2.0)] {
        let off = |f: &[f64]| f.iter().map(|x| math::powf(*x, power)).sum::<f64>() - 1.0;
        let known = candidates(&case, &[[0.45, 0.3], [0.5, -0.2], [0.6, 0.1]]);
        let options = SqpOptions::default();
        let refined = refine(&case, &known, (&options, usize::MAX), &Alone, &mut silent);
        assert!(refined.members.len() <= 3);
        let with = (&options, usize::MAX);
        let widened = widen(
            &case,
            refined.members.clone(),
            21,
            with,
            &Alone,
            &mut silent,
        );
        println!("{} evaluations", widened.evaluations);
        let all = refined_objectives(&widened);
        assert!(all.len() >= 15 && all.len() <= 21, "{}", all.len());
        assert!(
            widened.residual < 1e-6 && widened.evaluations < 800,
            "{} {}",
            widened.residual,
            widened.evaluations
        );
        for (end, wanted) in [(0, [0.0, 1.0]), (all.len() - 1, [1.0, 0.0])] {
            let misses = all[end].iter().zip(wanted).map(|(f, w)| (f - w).abs());
            assert!(misses.fold(0.0, f64::max) < 1e-6, "{:?}", all[end]);
        }
        assert!(all.iter().all(|f| off(f).abs() < 1e-6), "{all:?}");
        let gaps = all.windows(2).map(|pair| {
            let both = pair[0].iter().zip(&pair[1]);
            both.map(|(a, b)| (b - a).abs()).sum::<f64>()
        });
        assert!(gaps.fold(0.0, f64::max) < 0.25);
        // What may not be asked is not asked.
        let with = (&options, 0);
        let none = widen(
            &case,
            refined.members.clone(),
            21,
            with,
            &Alone,
            &mut silent,
        );
        assert!(none.evaluations <= 4, "{}", none.evaluations);
        // Stopped, it has what it had.
        let mut stop = |_: &kempe_optimize::Progress| ControlFlow::Break(());
        let with = (&options, usize::MAX);
        let stopped = widen(&case, refined.members.clone(), 21, with, &Alone, &mut stop);
        assert_eq!(stopped.ended, Ended::Stopped);
        assert_eq!(stopped.members, refined.members);
    }
}

/// A front that is known in one valley alone, from whose ends ways down lead to what is least there, has its ends in the other one, which is lower.
#[test]
fn ends_are_sought_from_elsewhere_too() {
    let case = several(vec![[0.0, 1.0], [0.0, 1.0]], 2, |[x, y]| {
        let wall = (*y * PI).sin_cos().0.square() + (-*y + 1.0) * 0.1;
        vec![-*x + 1.0 + wall, *x + wall]
    });
    let known = candidates(&case, &[[0.2, 0.01], [0.5, 0.0], [0.8, 0.02]]);
    let options = SqpOptions::default();
    let refined = refine(&case, &known, (&options, usize::MAX), &Alone, &mut silent);
    let with = (&options, usize::MAX);
    let widened = widen(&case, refined.members, 11, with, &Alone, &mut silent);
    let all = refined_objectives(&widened);
    let (first, last) = (&all[0], &all[all.len() - 1]);
    assert!(
        first[0].abs() < 1e-6 && (first[1] - 1.0).abs() < 1e-6,
        "{first:?}"
    );
    assert!(
        last[1].abs() < 1e-6 && (last[0] - 1.0).abs() < 1e-6,
        "{last:?}"
    );
}

/// A front along two valleys, of which each is the lower for half of it: designs that are known in the wrong one, and that none in the other betters yet, come
/// over from their neighbours.
#[test]
fn designs_in_the_wrong_valley_come_over() {
    let case = several(vec![[0.0, 1.0], [-1.5, 1.5]], 2, |[x, y]| {
        let walls = (y.square() - 1.0).square();
        vec![*x, -*x + 1.0 + walls + (*x - 0.5) * *y * 0.02]
    });
    let wrong = [5, 13, 14, 15, 16, 17, 18, 19];
    let known: Vec<[f64; 2]> = (0..=20)
        .map(|k| {
            let lower = if k < 10 { 1.0 } else { -1.0 };
            let y = if wrong.contains(&k) { -lower } else { lower };
            [f64::from(k) / 20.0, y]
        })
        .collect();
    let options = SqpOptions::default();
    let with = (&options, usize::MAX);
    let known = candidates(&case, &known);
    let refined = refine(&case, &known, with, &Alone, &mut silent);
    let above = |f: &[f64]| f[1] - (1.0 - f[0] - 0.02 * (f[0] - 0.5).abs());
    let before = refined_objectives(&refined);
    assert_eq!(
        before.iter().filter(|f| above(f) > 5e-3).count(),
        wrong.len()
    );
    let widened = widen(&case, refined.members, 21, with, &Alone, &mut silent);
    let all = refined_objectives(&widened);
    assert!(
        all.len() >= 15 && all.iter().all(|f| above(f) < 1e-4),
        "{all:?}"
    );
}

/// Limits part the box into islands. On another than that of all known designs, and of both ends, there is a lower piece of the front.
#[test]
fn a_piece_of_the_front_on_another_island_is_found() {
    let case = Case::<2> {
        bounds: vec![[0.0, 1.0], [-0.3, 3.3]],
        objectives: 2,
        constraints: 1,
        functions: Box::new(|[x, y]| {
            let near = ((*x - 0.5) * 10.0).square() + 1.0;
            let other = (*y - 2.0).square() * 4.0 + 1.0;
            let lower = D::constant(0.3) / (near.square() * other);
            let (_, cos) = (*y * (2.0 * PI)).sin_cos();
            let f2 = -*x + 1.0 - lower + *y * 0.05;
            Some((vec![vec![*x], vec![f2]], vec![vec![-cos + 0.5]]))
        }),
        asked: Default::default(),
    };
    let options = SqpOptions::default();
    let with = (&options, 4_000);
    let known = candidates(&case, &[[0.1, 0.0], [0.3, 0.0], [0.7, 0.0], [0.9, 0.0]]);
    let refined = refine(&case, &known, with, &Alone, &mut silent);
    let widened = widen(&case, refined.members, 21, with, &Alone, &mut silent);
    let lowest = (refined_objectives(&widened).iter())
        .map(|f| f[0] + f[1])
        .fold(f64::INFINITY, f64::min);
    let on = (widened.members.iter()).filter(|m| m.candidate.design[1] > 1.5);
    let on = on.count();
    println!("{lowest}, {on}, {} evaluations", widened.evaluations);
    assert!((0.79..0.81).contains(&lowest) && on >= 3, "{lowest}, {on}");
}

/// On the way to the least of one objective lies a valley that is lower in both: its other end is found, too.
#[test]
fn the_other_end_of_a_lower_valley_is_found() {
    let case = several(vec![[0.0, 1.0], [-0.3, 3.3]], 2, |[x, y]| {
        let other = ((*y - 3.0) * 3.0).square().square();
        let there = D::constant(1.0) / (other + 1.0);
        let hollow = *x * -2.0 + x.square() * (-*x + 1.0) * 40.0 + x.square().square() * 3.0 + 0.2;
        let here = -*x + 1.3 + y.square();
        vec![*x - there, here * (-there + 1.0) + hollow * there]
    });
    let options = SqpOptions::default();
    let front: Vec<[f64; 2]> = (1..10).map(|k| [f64::from(k) / 10.0, 0.0]).collect();
    let front = candidates(&case, &front);
    let known = [&front[..], &candidates(&case, &[[0.3, 3.1]])].concat();
    let with = (&options, 330);
    let refined = refine(&case, &front, with, &Alone, &mut silent);
    let widening = Widening {
        even: known.len(),
        known,
        ..Widening::from(21)
    };
    let widened = widen(&case, refined.members, widening, with, &Alone, &mut silent);
    let all = refined_objectives(&widened);
    let [first, last] = [&all[0], &all[all.len() - 1]];
    println!("{} evaluations, {all:?}", widened.evaluations);
    assert!(all.len() > 1 && (first[0] + 1.0).abs() < 1e-6, "{first:?}");
    assert!((last[1] - 0.174_7).abs() < 1e-3, "{last:?}");
}

/// Where too few designs may be tried for samples, an end is sought from what is known elsewhere.
#[test]
fn an_end_in_another_valley_is_found_from_what_is_known() {
    let case = several(vec![[-1.5, 1.5], [0.0, 1.0]], 2, |[x, y]| {
        let wells = (x.square() - 1.0).square() * 5.0 + *x * 0.3;
        vec![
            wells + y.square(),
            (*x - 1.2).square() + (*y - 0.5).square(),
        ]
    });
    let options = SqpOptions::default();
    let begun = candidates(&case, &[[0.9, 0.2], [1.1, 0.4]]);
    let known: Vec<[f64; 2]> = (0..20)
        .map(|k| [f64::from(k % 5) * 0.7 - 1.4, f64::from(k / 5) * 0.3])
        .collect();
    for known in [Vec::new(), candidates(&case, &known)] {
        let with = (&options, 600);
        let refined = refine(&case, &begun, with, &Alone, &mut silent);
        let has_known = !known.is_empty();
        let widening = Widening {
            samples: 100,
            even: known.len(),
            known,
            ..Widening::from(20)
        };
        let widened = widen(&case, refined.members, widening, with, &Alone, &mut silent);
        let all = refined_objectives(&widened);
        let end = all.iter().map(|f| f[0]).fold(f64::INFINITY, f64::min);
        let from = match has_known {
            true => EndsFrom::Known,
            false => EndsFrom::Own,
        };
        assert_eq!(widened.ends_from, from);
        assert_eq!(end < -0.2, has_known, "{end}");
    }
}

/// ZDT3's front is in five pieces: what lies between two of them is found empty, once.
#[test]
fn gaps_of_a_front_in_pieces_stay_open() {
    let front = nsga2(&zdt3(), &options(4_000), &Alone, &mut silent);
    let case = zdt3();
    let options = SqpOptions::default();
    let refined = refine(
        &case,
        &front.members,
        (&options, 1_500),
        &Alone,
        &mut silent,
    );
    let before = hypervolume(&refined_objectives(&refined), &[1.1; 2]);
    let widened = widen(
        &case,
        refined.members,
        120,
        (&options, 1_500),
        &Alone,
        &mut silent,
    );
    let after = hypervolume(&refined_objectives(&widened), &[1.1; 2]);
    println!(
        "ZDT3 {before} -> {after}, {} evaluations",
        widened.evaluations
    );
    assert!(after >= before && widened.evaluations < 2_500);
}

/// Where an end's objective has its least value along a way, the front ends where the other is least on it.
#[test]
fn an_end_along_a_valley_is_where_the_other_is_least() {
    let valley = |kinked: bool| Case::<2> {
        bounds: vec![[0.0, 2.0], [0.2, 1.0]],
        objectives: 2,
        constraints: 0,
        functions: Box::new(move |x| {
            let off = x[0] * x[1] - 0.5;
            let rises = match kinked {
                true => vec![off + 3.0, -off + 3.0],
                false => vec![off.square() + 3.0],
            };
            Some((vec![rises, vec![x[0] * 7.0]], vec![]))
        }),
        asked: Default::default(),
    };
    let options = SqpOptions::default();
    for kinked in [false, true] {
        let case = valley(kinked);
        let known: Vec<Candidate> = [[0.9, 0.5], [0.2, 0.6], [1.8, 0.3]]
            .iter()
            .map(|design| Candidate {
                design: design.to_vec(),
                evaluation: Problem::evaluate(&case, design),
            })
            .collect();
        let with = (&options, usize::MAX);
        let refined = refine(&case, &known, with, &Alone, &mut silent);
        let widened = widen(&case, refined.members, 21, with, &Alone, &mut silent);
        let all = refined_objectives(&widened);
        println!("{} evaluations, {all:?}", widened.evaluations);
        let end = &all[0];
        assert!((end[0] - 3.0).abs() < 1e-7, "{kinked}: {end:?}");
        // The square is less than 1e-7 of its range where the product misses by 1e-4.
        assert!((end[1] - 3.5).abs() < 1e-2, "{kinked}: {end:?}");
        for pair in all.windows(2) {
            assert!(pair[1][0] > pair[0][0] + 1e-9, "{pair:?}");
        }
    }
}

#[test]
fn three_objectives_get_their_ends() {
    let front = nsga2(&dtlz2(), &options(2_000), &Alone, &mut silent);
    let case = dtlz2();
    let options = SqpOptions::default();
    let refined = refine(
        &case,
        &front.members,
        (&options, 4_000),
        &Alone,
        &mut silent,
    );
    let widened = widen(
        &case,
        refined.members,
        100,
        (&options, 4_000),
        &Alone,
        &mut silent,
    );
    for k in 0..3 {
        let of = refined_objectives(&widened);
        let least = of.iter().map(|p| p[k]).fold(f64::INFINITY, f64::min);
        assert!(least < 1e-7, "{k}: {least}");
    }
}

/// Where two of three objectives are the least that they can be, the third is so only for what they do not hold: whichever of them falls last, none is left
/// that falls alone. On the front squares sum to one.
#[test]
fn no_weak_end_of_three_objectives_is_left() {
    let case = several(cube(5, 0.0, 1.0), 3, |x: &[D<5>; 5]| {
        let far = x[2..].iter().map(|x| (*x - 0.5).square());
        let g = far.fold(D::constant(1.0), |sum, x| sum + x);
        let ((s0, c0), (s1, c1)) = ((x[0] * FRAC_PI_2).sin_cos(), (x[1] * FRAC_PI_2).sin_cos());
        vec![c0 * c1 * g, c0 * s1 * g, s0 * g]
    });
    let sqp = SqpOptions::default();
    for seed in 1..11 {
        let few = Nsga2Options {
            population: 40,
            seed,
            ..options(1_000)
        };
        let front = nsga2(&case, &few, &Alone, &mut silent);
        let with = (&sqp, usize::MAX);
        let refined = refine(&case, &front.members, with, &Alone, &mut silent);
        let optimal = refined.members.iter().filter(|it| it.ended.is_optimal());
        for it in optimal {
            let f = &it.candidate.evaluation.objectives;
            let square: f64 = f.iter().map(|x| x * x).sum();
            assert!((square - 1.0).abs() < 1e-5, "{seed}: {f:?}");
        }
    }
}

/// What gains a billionth in one objective and loses the whole range of another is no point of a front worth having.
#[test]
fn what_gains_next_to_nothing_is_left_out() {
    let member = |objectives: [f64; 3]| Refined {
        candidate: Candidate {
            design: vec![0.0],
            evaluation: Evaluation {
                objectives: objectives.to_vec(),
                constraints: Vec::new(),
                lack: 0.0,
            },
        },
        residual: 0.0,
        shares: vec![1.0; 3],
        ended: Ended::Converged,
    };
    let told = |all: &[[f64; 3]]| undominated(all.iter().map(|f| member(*f)).collect()).len();
    let front = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    assert_eq!(told(&front), 3);
    let [a, b, c] = front;
    let endless = [20.0, -5e-10, 0.0];
    assert_eq!(told(&[a, b, c, endless]), 3);
    // What gains more is one.
    assert_eq!(told(&[a, b, c, [20.0, -1e-3, 0.0]]), 4);
}

/// N. Srinivas and K. Deb (1994): the front is where x = -2.5.
#[test]
fn constraints_bound_a_front() {
    let case = Case::<2> {
        bounds: cube(2, -20.0, 20.0),
        objectives: 2,
        constraints: 2,
        functions: Box::new(|[x, y]| {
            let f1 = (*x - 2.0).square() + (*y - 1.0).square() + 2.0;
            let f2 = *x * 9.0 - (*y - 1.0).square();
            let rows = vec![
                vec![x.square() + y.square() - 225.0],
                vec![*x - *y * 3.0 + 10.0],
            ];
            Some((vec![vec![f1], vec![f2]], rows))
        }),
        asked: Default::default(),
    };
    let front = nsga2(&case, &options(8_000), &Alone, &mut silent);
    assert!(
        front
            .members
            .iter()
            .all(|c| c.evaluation.constraints.iter().all(|g| *g <= 0.0))
    );
    let refined = refine(
        &case,
        &front.members,
        (&SqpOptions::default(), usize::MAX),
        &Alone,
        &mut silent,
    );
    println!(
        "SRN: {} -> {} residual {:.1e} evaluations {}",
        front.members.len(),
        refined.members.len(),
        refined.residual,
        refined.evaluations
    );
    assert!(refined.members.len() > 50 && refined.residual < 1e-6);
    for member in &refined.members {
        let x = &member.candidate.design;
        // On x = -2.5 inside, on a constraint at the front's end.
        let ends = (x[0] * x[0] + x[1] * x[1] - 225.0)
            .abs()
            .min((x[0] - 3.0 * x[1] + 10.0).abs());
        assert!((x[0] + 2.5).abs() < 1e-4 || ends < 1e-5, "{x:?}");
    }
}

#[test]
fn volumes_are_those_of_closed_forms() {
    assert_eq!(hypervolume(&[], &[1.0, 1.0]), 0.0);
    assert_eq!(hypervolume(&[vec![2.0, 0.0]], &[1.0, 1.0]), 0.0);
    assert_eq!(hypervolume(&[vec![0.25]], &[1.0]), 0.75);
    assert_eq!(
        hypervolume(
            &[vec![0.0, 0.5], vec![0.5, 0.0], vec![0.5, 0.5]],
            &[1.0, 1.0]
        ),
        0.75
    );
    // Corners of a simplex: of m boxes of one side half, 1 - the part that all leave.
    for m in 2..6 {
        let points: Vec<Vec<f64>> = (0..m)
            .map(|k| (0..m).map(|j| if j == k { 0.5 } else { 0.0 }).collect())
            .collect();
        let wanted = 1.0 - powi(0.5, m);
        let found = hypervolume(&points, &vec![1.0; m as usize]);
        assert!((found - wanted).abs() < 1e-14, "{m} {found} {wanted}");
    }
}

#[test]
fn volumes_are_those_of_counted_points() {
    let mut random = Random(5);
    for m in 2..6 {
        let points: Vec<Vec<f64>> = (0..12)
            .map(|_| (0..m).map(|_| random.uniform()).collect())
            .collect();
        let found = hypervolume(&points, &vec![1.0; m]);
        let throws = 60_000;
        let hits = (0..throws).filter(|_| {
            let at: Vec<f64> = (0..m).map(|_| random.uniform()).collect();
            points
                .iter()
                .any(|p| p.iter().zip(&at).all(|(p, x)| p <= x))
        });
        let counted = hits.count() as f64 / f64::from(throws);
        assert!((found - counted).abs() < 0.008, "{m}: {found} {counted}");
        let mut turned = points.clone();
        turned.reverse();
        assert!((hypervolume(&turned, &vec![1.0; m]) - found).abs() < 1e-12);
    }
}

#[test]
fn the_same_seed_gives_the_same_front() {
    let options = options(2_000);
    let mut one = Nsga2::new(&zdt1(), &options);
    let mut two = one.clone();
    for (state, part) in [(&mut one, 1), (&mut two, 33)] {
        let case = zdt1();
        while state.evaluations() < state.budget() {
            let designs = state.ask();
            let evaluations = designs
                .chunks(part)
                .flat_map(|some| evaluate_all(&case, some, &Alone))
                .collect();
            state.tell(evaluations);
        }
    }
    assert_eq!(one, two);
    assert_eq!(
        one.front(),
        nsga2(&zdt1(), &options, &Alone, &mut silent).members
    );
}

#[test]
fn a_front_is_kept_when_stopped() {
    let mut stop = |p: &kempe_optimize::Progress| match p.evaluations > 3_000 {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    };
    let front = nsga2(&zdt1(), &options(10_000), &Alone, &mut stop);
    assert_eq!(front.ended, Ended::Stopped);
    assert!(front.evaluations < 3_200 && front.members.len() > 5);
    let mut told = 0;
    let mut stop = |_: &kempe_optimize::Progress| {
        told += 1;
        if told > 40 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    let refined = refine(
        &zdt1(),
        &front.members,
        (&SqpOptions::default(), usize::MAX),
        &Alone,
        &mut stop,
    );
    assert_eq!(refined.ended, Ended::Stopped);
    assert!(!refined.members.is_empty());
}

/// The end of a front in the deepest of ten valleys, to which starts lead where they go on as long as they may lead elsewhere.
#[test]
fn ends_are_sought_as_long_as_starts_may_lead_elsewhere() {
    let at = [
        [8.6, 9.3],
        [1.0, 1.0],
        [8.0, 8.0],
        [3.0, 7.0],
        [7.0, 3.5],
        [2.0, 9.0],
        [5.0, 3.0],
        [9.0, 1.0],
        [6.0, 6.0],
        [1.5, 4.0],
        [4.2, 9.5],
    ];
    let case = several(cube(2, 0.0, 10.0), 2, move |[x, y]| {
        let hole = |(k, [a, b]): (usize, &[f64; 2])| {
            let far = (*x - *a).square() + (*y - *b).square();
            -(far * 0.0 + 1.0) / (far + 0.1 + 0.05 * k as f64)
        };
        let holes = at.iter().enumerate().map(hole);
        let sum = holes.reduce(|sum, hole| sum + hole).unwrap();
        vec![sum, *x + *y]
    });
    let options = SqpOptions::default();
    let with = (&options, usize::MAX);
    let known = candidates(&case, &[[1.4, 4.1], [1.6, 3.9]]);
    let front = refine(&case, &known, with, &Alone, &mut silent).members;
    let mut missed = 0;
    for seed in 1..7 {
        let reaches = |further: Option<Further>| {
            let widening = Widening {
                samples: 12,
                further,
                seed,
                ..Widening::from(21)
            };
            let widened = widen(&case, front.clone(), widening, with, &Alone, &mut silent);
            let end = refined_objectives(&widened)[0][0];
            ((end + 10.68154).abs() < 1e-5, widened.ends_from)
        };
        missed += usize::from(!reaches(None).0);
        let [some, many] = [100, 2000].map(|evaluations| {
            reaches(Some(Further {
                unseen: 0.05,
                evaluations,
            }))
        });
        assert_eq!(some.1, EndsFrom::SomeSamples);
        assert_eq!(many, (true, EndsFrom::Samples));
    }
    assert!(missed > 0);
}

/// Stopped while the second end is sought, a front has the first.
#[test]
fn an_end_that_was_found_is_kept_when_stopped() {
    let case = bulging();
    let options = SqpOptions::default();
    let with = (&options, usize::MAX);
    let known = candidates(&case, &[[0.45, 0.3], [0.5, -0.2], [0.6, 0.1]]);
    let front = refine(&case, &known, with, &Alone, &mut silent).members;
    let ends = |after: usize| {
        let mut stop = |told: &kempe_optimize::Progress| match told.evaluations >= after {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        };
        let found = widen(&case, front.clone(), 21, with, &Alone, &mut stop);
        assert_eq!(found.ended, Ended::Stopped);
        let all = refined_objectives(&found);
        [all[0][0], all[all.len() - 1][1]]
    };
    let reached = (50..150).step_by(5).map(ends);
    let is_half = |[first, second]: [f64; 2]| first < 1e-9 && second > 0.1;
    assert!(reached.filter(|ends| is_half(*ends)).count() > 0);
}
