//! Largest of pieces, conflicts, degenerate and undefined places, and what multipliers mean.

use std::ops::ControlFlow;
use std::sync::atomic::AtomicUsize;

use crate::support::{Case, D, cube};
use kempe_number::{Number, Random, math, powi};
use kempe_optimize::{Alone, Ended, Evaluation, Optimum, Problem, Slopes, SqpOptions, silent, sqp};

fn solve<const N: usize>(name: &str, case: &Case<N>, start: [f64; N]) -> Optimum {
    let found = sqp(case, &start, &SqpOptions::default(), &Alone, &mut silent);
    println!(
        "{name}: {:.12} residual {:.1e} violation {:.1e} steps {} evaluations {} slopes {} {:?} at {:?} {:?}",
        found.objective(),
        found.residual,
        found.violation,
        found.iterations,
        found.evaluations,
        found.slopes,
        found.ended,
        found.design,
        found.conflicts
    );
    found
}

#[track_caller]
fn is_optimum(found: &Optimum, wanted: f64) {
    assert!(found.ended.is_optimal(), "{found:?}");
    let missed = (found.objective() - wanted).abs() / wanted.abs().max(1.0);
    assert!(missed < 1e-7, "{} {wanted}", found.objective());
    let shares: f64 = found.multipliers.objectives.iter().flatten().sum();
    assert!((shares - 1.0).abs() < 1e-9);
}

/// C. Charalambous and J. W. Bandler (1976), problem 1: optimum 1.9522245.
#[test]
fn minimax_of_charalambous_and_bandler() {
    let case = Case::<2>::pieces(cube(2, -10.0, 10.0), 0, |[x, y]| {
        let pieces = vec![
            x.square() + powi(*y, 4),
            (-*x + 2.0).square() + (-*y + 2.0).square(),
            (*y - *x).exp() * 2.0,
        ];
        (pieces, vec![])
    });
    let found = solve("CB2", &case, [2.0, 2.0]);
    is_optimum(&found, 1.952_224_493_87);
}

/// The same authors' second problem: optimum 2 at (1, 1), where all three pieces meet.
#[test]
fn minimax_where_more_pieces_meet_than_needed() {
    let case = Case::<2>::pieces(cube(2, -10.0, 10.0), 0, |[x, y]| {
        let pieces = vec![
            powi(*x, 4) + y.square(),
            (-*x + 2.0).square() + (-*y + 2.0).square(),
            (*y - *x).exp() * 2.0,
        ];
        (pieces, vec![])
    });
    let found = solve("CB3", &case, [2.0, 2.0]);
    is_optimum(&found, 2.0);
}

/// J. B. Rosen and S. Suzuki (1965) as a minimax: optimum -44.
#[test]
fn minimax_of_rosen_and_suzuki() {
    let case = Case::<4>::pieces(cube(4, -10.0, 10.0), 0, |[a, b, c, d]| {
        let (a2, b2, c2, d2) = (a.square(), b.square(), c.square(), d.square());
        let f = a2 + b2 + c2 * 2.0 + d2 - *a * 5.0 - *b * 5.0 - *c * 21.0 + *d * 7.0;
        let pieces = vec![
            f,
            f + (a2 + b2 + c2 + d2 + *a - *b + *c - *d - 8.0) * 10.0,
            f + (a2 + b2 * 2.0 + c2 + d2 * 2.0 - *a - *d - 10.0) * 10.0,
            f + (a2 * 2.0 + b2 + c2 + *a * 2.0 - *b - *d - 5.0) * 10.0,
        ];
        (pieces, vec![])
    });
    let found = solve("Rosen-Suzuki", &case, [0.0; 4]);
    is_optimum(&found, -44.0);
}

/// E. Polak, D. H. Mayne and J. E. Higgins (1991), in L. Luksan and J. Vlcek's collection (2000) Polak 1 and Polak 6: optima e and -44.
#[test]
fn minimax_of_polak() {
    let case = Case::<2>::pieces(cube(2, -60.0, 60.0), 0, |[x, y]| {
        let size = x.square() * 0.001;
        let piece = |side: f64| (size + (*y + side).square()).exp();
        (vec![piece(-1.0), piece(1.0)], vec![])
    });
    let found = solve("Polak 1", &case, [50.0, 0.05]);
    is_optimum(&found, std::f64::consts::E);
    let case = Case::<4>::pieces(cube(4, -10.0, 10.0), 0, |[a, b, c, d]| {
        let p = *a - powi(*d + 1.0, 4);
        let q = *b - powi(p, 4);
        let (p2, q2, c2, d2) = (p.square(), q.square(), c.square(), d.square());
        let f = p2 + q2 + c2 * 2.0 + d2 - p * 5.0 - q * 5.0 - *c * 21.0 + *d * 7.0;
        let pieces = vec![
            f,
            f + (p2 + q2 + c2 + d2 + p - q + *c - *d - 8.0) * 10.0,
            f + (p2 + q2 * 2.0 + c2 + d2 * 2.0 - p - *d - 10.0) * 10.0,
            f + (p2 + q2 + c2 + p * 2.0 - q - *d - 5.0) * 10.0,
        ];
        (pieces, vec![])
    });
    let found = solve("Polak 6", &case, [0.0; 4]);
    is_optimum(&found, -44.0);
}

/// H. H. Rosenbrock's valley (1960) whose end is beyond a bound.
#[test]
fn a_bound_ends_a_valley() {
    let case = Case::<2>::smooth(vec![[-2.0, 0.5], [-2.0, 2.0]], 0, |[x, y]| {
        (
            (*y - x.square()).square() * 100.0 + (-*x + 1.0).square(),
            vec![],
        )
    });
    let found = solve("boxed Rosenbrock", &case, [-1.2, 1.0]);
    is_optimum(&found, 0.25);
    assert_eq!(found.design[0], 0.5);
    // What a longer range of x is worth there: 2 (1 - x).
    assert!((found.multipliers.bounds[0][1] - 1.0).abs() < 1e-5);
}

/// The largest of a travelling wave's local peaks: their number and order changes on the way.
#[test]
fn peaks_may_come_and_go() {
    let case = Case::<2>::pieces(cube(2, -2.0, 2.0), 0, |[a, b]| {
        // |cos 3t + a cos t + b sin 2t| over half a turn, as its samples' local peaks: the best mix of waves.
        let at = |k: i32| {
            let t = f64::from(k) * std::f64::consts::PI / 2000.0;
            let (s, c) = (kempe_number::math::sin(2.0 * t), kempe_number::math::cos(t));
            let value: D<2> = *a * c
                + *b * s
                + kempe_number::math::cos(3.0 * t)
                + kempe_number::math::cos(5.0 * t) * 0.3;
            value.abs()
        };
        let samples: Vec<D<2>> = (0..=2000).map(at).collect();
        let peaks = (0..samples.len()).filter(|k| {
            let own = samples[*k].re;
            (*k == 0 || samples[k - 1].re <= own)
                && (k + 1 == samples.len() || samples[k + 1].re < own)
        });
        (peaks.map(|k| samples[k]).collect(), vec![])
    });
    let found = solve("peaks", &case, [1.5, 1.0]);
    assert!(found.ended.is_optimal());
    // The problem is convex: no other place near by is better.
    for (da, db) in [
        (1e-3, 0.0),
        (-1e-3, 0.0),
        (0.0, 1e-3),
        (0.0, -1e-3),
        (1e-3, 1e-3),
        (-1e-3, 1e-3),
    ] {
        let near = vec![found.design[0] + da, found.design[1] + db];
        let there = kempe_optimize::Problem::evaluate(&case, &near);
        assert!(there.largest() > found.objective());
    }
}

/// Two discs a gap apart and a third constraint that never matters: the nearest approach is in the middle of the gap.
#[test]
fn a_conflict_is_named() {
    let case = Case::<2>::smooth(cube(2, -10.0, 10.0), 3, |[x, y]| {
        let disc = |at: f64| (*x - at).square() + y.square() - 1.0;
        (*y * 3.0 + *x, vec![disc(-2.0), -*y - 9.0, disc(2.0)])
    });
    let found = solve("conflict", &case, [5.0, 7.0]);
    assert_eq!(found.ended, Ended::Infeasible);
    assert!(
        found.design.iter().all(|x| x.abs() < 1e-4),
        "{:?}",
        found.design
    );
    assert_eq!(found.conflicts.len(), 1);
    let mut names: Vec<usize> = found.conflicts[0]
        .iter()
        .filter(|c| c.1 > 1e-6)
        .map(|c| c.0)
        .collect();
    names.sort_unstable();
    assert_eq!(names, [0, 2]);
    let shares: f64 = found.conflicts[0].iter().map(|c| c.1).sum();
    assert!((shares - 1.0).abs() < 1e-9);
}

/// What can be kept beside a conflict is kept, each conflict is named by itself, and the objective is the least that is left.
#[test]
fn what_need_not_be_missed_is_not() {
    let case = Case::<3>::smooth(cube(3, 0.0, 10.0), 4, |[x, y, z]| {
        let limits = vec![-*x + 12.0, -*y + 7.0, *y - 6.0, *z - 3.0];
        ((*z - 5.0).square() - *x, limits)
    });
    for start in [[5.0, 5.0, 3.0], [0.0, 0.0, 0.0], [9.0, 1.0, 10.0]] {
        let found = solve("two conflicts", &case, start);
        assert_eq!(found.ended, Ended::Infeasible);
        let [x, y, z] = [0, 1, 2].map(|k| found.design[k]);
        assert!((x - 10.0).abs() < 1e-6 && (z - 3.0).abs() < 1e-6, "{x} {z}");
        assert!((6.0..=7.0).contains(&y), "{y}");
        let names: Vec<Vec<usize>> = (found.conflicts.iter())
            .map(|group| group.iter().map(|c| c.0).collect())
            .collect();
        let mut pair = names[1].clone();
        pair.sort_unstable();
        assert_eq!((&names[0][..], &pair[..]), (&[0][..], &[1, 2][..]));
        assert!((found.evaluation.constraints[0] - 2.0).abs() < 1e-6);
    }
}

/// A constraint that the bounds alone keep from being met contradicts no other, though the least of the largest violations weighs both; what is missed of the
/// other is the least that the first then leaves.
#[test]
fn what_bounds_keep_from_being_met_contradicts_nothing_else() {
    let case = Case::<2>::smooth(cube(2, 0.0, 1.0), 3, |[x, y]| {
        // x at most -1; x + y at least 1.5; y at most 9.
        (*x - *y, vec![*x + 1.0, -*x - *y + 1.5, *y - 9.0])
    });
    let found = solve("bounds", &case, [0.5, 0.5]);
    assert_eq!(found.ended, Ended::Infeasible);
    let names = found.conflicts.iter();
    let names: Vec<Vec<usize>> = names
        .map(|group| group.iter().map(|c| c.0).collect())
        .collect();
    assert_eq!(names[0], [0]);
    assert!((found.evaluation.constraints[0] - 1.0).abs() < 1e-6);
    assert!((found.evaluation.constraints[1] - 0.5).abs() < 1e-6);
}

/// Constraints that cannot be kept even by their linear parts.
#[test]
fn rows_that_conflict_are_named() {
    let case = Case::<2>::smooth(cube(2, 0.0, 1.0), 3, |[x, y]| {
        (*x, vec![*x + *y - 0.5, -*x - *y + 0.7, *x - 2.0])
    });
    let found = solve("rows", &case, [0.9, 0.1]);
    assert_eq!(found.ended, Ended::Infeasible);
    let names: Vec<usize> = found.conflicts[0].iter().map(|c| c.0).collect();
    assert_eq!(names.len(), 2);
    assert!(names.contains(&0) && names.contains(&1));
}

/// The same constraint four times, one of them squared: no regular point.
#[test]
fn redundant_constraints_do_no_harm() {
    let case = Case::<2>::smooth(cube(2, -3.0, 3.0), 4, |[x, y]| {
        let row = *x + *y - 1.0;
        (
            (*x - 2.0).square() + (*y - 1.0).square(),
            vec![row, row * 2.0, row * 0.5, *x * 3.0 + *y * 3.0 - 3.0],
        )
    });
    let found = solve("redundant", &case, [-2.0, -2.0]);
    is_optimum(&found, 2.0);
    let paid: f64 = (0..4)
        .zip([1.0, 2.0, 0.5, 3.0])
        .map(|(k, size)| found.multipliers.cost(k) * size)
        .sum();
    assert!((paid - 2.0).abs() < 1e-6, "{paid}");
    // The others hold what one of them lets go.
    for k in 0..4 {
        assert!(found.eased.cost(k) == 0.0, "{:?}", found.eased);
    }
}

/// Where a corner of the objective holds a place, what else does so may be eased for nothing, and what holds it alone costs what it did.
#[test]
fn easing_one_limit_brings_what_the_others_let_it() {
    let case = Case::<3>::pieces(cube(3, -1.0, 1.0), 3, |[x, y, z]| {
        let (goal, at) = (*y * 2.0 + *z, D::from_f64(0.0));
        (
            vec![goal + *x, goal - *x * 3.0],
            // The first ends where the corner is, the second holds y, and the third is what it is everywhere.
            vec![vec![-*x], vec![-*y - 0.5], vec![at]],
        )
    });
    let found = solve("corner", &case, [0.7, 0.3, 0.2]);
    is_optimum(&found, -2.0);
    let eased: Vec<f64> = (0..3).map(|k| found.eased.cost(k)).collect();
    assert!(eased[0] == 0.0 && eased[2] == 0.0, "{eased:?}");
    assert!((eased[1] - 2.0).abs() < 1e-6, "{eased:?}");
    assert!(
        (found.eased.bounds[2][0] - 1.0).abs() < 1e-6,
        "{:?}",
        found.eased
    );
    // And where it is moved away from the corner it costs what its multiplier says.
    let away = Case::<1>::pieces(cube(1, -1.0, 1.0), 1, |[x]| {
        (vec![*x, -*x * 3.0], vec![vec![-*x + 0.25]])
    });
    let found = solve("beside a corner", &away, [0.7]);
    is_optimum(&found, 0.25);
    assert!(
        (found.eased.cost(0) - 1.0).abs() < 1e-9,
        "{:?}",
        found.eased
    );
}

/// Limits from both sides at one value hold it, beside a goal that pays far more for something else: what easing brings is exact all the same.
#[test]
fn what_two_limits_pin_is_eased_exactly() {
    for (pays, widest) in [(1.0, 4.0), (10.0, 4.0), (100.0, 10.0), (1e4, 10.0)] {
        let box_ = vec![[-2.0, 2.0], [-2.0, 2.0], [0.0, widest]];
        let case = Case::<3>::smooth(box_, 4, move |[x, y, n]| {
            let goal = -*x - *y * 2.0 - *n * pays;
            let circle = x.square() + y.square() - 1.0;
            (goal, vec![circle, -*x + 0.8, *x - 0.8, *n - 3.0])
        });
        let found = solve("pinned", &case, [0.3, 0.4, 0.5]);
        is_optimum(&found, -2.0 - 3.0 * pays);
        // y = sqrt(r - x^2) at r = 1, x = 0.8.
        let wanted = [2.0 / (2.0 * 0.6), 2.0 * 0.8 / 0.6 - 1.0, 0.0, pays];
        for (k, wanted) in wanted.into_iter().enumerate() {
            let cost = found.eased.cost(k);
            assert!(
                (cost - wanted).abs() < 1e-5 * wanted.max(1.0),
                "{pays} {k}: {cost} for {wanted}"
            );
        }
    }
}

/// As many equations as variables, each as two limits: their multipliers have no bound, but what easing one brings is known. The slopes are those of a
/// four-bar's angles and places at some instants, a little bent.
#[test]
fn what_equations_pin_is_eased_exactly() {
    const GOAL: [f64; 5] = [0.985, 0.193, 0.020, -0.440, 0.098];
    const ROWS: [[f64; 5]; 5] = [
        [0.576, 1.149, -0.767, 0.0, 0.0],
        [0.422, 1.190, -0.438, 0.0, 0.0],
        [0.108, -1.292, 0.019, 0.0, 0.0],
        [0.234, 0.119, -0.323, 1.072, -0.685],
        [0.380, -0.039, 0.105, 0.685, 1.072],
    ];
    let sum = |row: [f64; 5], x: &[D<5>; 5]| {
        let zero = D::from_f64(0.0);
        row.iter().zip(x).fold(zero, |sum, (a, x)| sum + *x * *a)
    };
    for bent in [0.0, 0.3] {
        let case = Case::<5>::smooth(cube(5, -1.0, 1.0), 10, move |x| {
            let rows = ROWS.map(|row| {
                let by = sum(row, x);
                by + by.square() * bent
            });
            (sum(GOAL, x), rows.iter().flat_map(|c| [*c, -*c]).collect())
        });
        let found = solve("equations", &case, [0.3, -0.2, 0.1, 0.2, -0.3]);
        is_optimum(&found, 0.0);
        // The goal's slope and the sum of costs times rows are nothing together.
        let mut lu = kempe_linear::Lu::new(5);
        assert!(lu.factor(|i, j| ROWS[j][i]));
        let mut costs: Vec<f64> = GOAL.iter().map(|x| -x).collect();
        lu.solve(&mut costs);
        for (k, cost) in costs.iter().enumerate() {
            let both = [cost.max(0.0), (-cost).max(0.0)];
            for (side, wanted) in both.into_iter().enumerate() {
                let told = found.eased.cost(2 * k + side);
                assert!(
                    (told - wanted).abs() < 1e-6,
                    "{bent} {k} {side}: {told} for {wanted}"
                );
            }
        }
    }
}

/// An equation as two constraints: their multipliers have no bound.
#[test]
fn an_equation_may_be_two_constraints() {
    let case = Case::<3>::smooth(cube(3, -5.0, 5.0), 2, |[x, y, z]| {
        let sphere = x.square() + y.square() + z.square() - 4.0;
        (*x + *y * 2.0 - *z, vec![sphere, -sphere])
    });
    let found = solve("sphere", &case, [1.0, 1.0, 1.0]);
    is_optimum(&found, -2.0 * 6.0_f64.sqrt());
}

/// Full steps along a circle raise both the objective and the violation (N. Maratos, 1978).
#[test]
fn full_steps_are_corrected_along_a_curve() {
    let case = Case::<2>::smooth(cube(2, -2.0, 2.0), 2, |[x, y]| {
        let circle = x.square() + y.square() - 1.0;
        (circle * 2.0 - *x, vec![circle, -circle])
    });
    let found = solve("Maratos", &case, [0.0, 1.0]);
    is_optimum(&found, -1.0);
    assert!(found.iterations < 30, "{}", found.iterations);
}

/// Nothing is known beyond a curve that the steps want to cross, and the optimum lies just before it.
#[test]
fn undefined_designs_shorten_steps() {
    let mut case = Case::<2>::smooth(cube(2, 0.0, 2.0), 0, |_| unreachable!());
    case.functions = Box::new(|[x, y]| {
        let room = (
            -x.square() - y.square() + 1.0,
            x.re * x.re + y.re * y.re < 1.0,
        );
        room.1
            .then(|| (vec![vec![-*x - *y - room.0.sqrt() * 0.01]], vec![]))
    });
    let found = solve("undefined", &case, [0.1, 0.2]);
    // Of -x - y - e sqrt(1 - x^2 - y^2) the minimum is -sqrt(2 + e^2).
    is_optimum(&found, -(2.0_f64 + 1e-4).sqrt());
    assert_eq!(
        sqp(
            &case,
            &[1.5, 1.5],
            &SqpOptions::default(),
            &Alone,
            &mut silent
        )
        .ended,
        Ended::Undefined
    );
}

/// Multipliers are what the optimum gains where a constraint is eased.
#[test]
fn multipliers_are_derivatives_of_the_optimum() {
    let problem = |ease: [f64; 3]| {
        Case::<3>::pieces(
            vec![[-3.0, 3.0], [-3.0, 3.0], [-3.0, 0.3 + ease[2]]],
            2,
            move |[x, y, z]| {
                let one = (*x - 2.0).square() + y.square() + (*z - 1.0).square() * 2.0;
                let two = x.square() + (*y - 2.0).square() * 1.5 + (*z - 1.0).square() * 2.0;
                let sum = x.square() + y.square() + z.square() - 1.5 - ease[0];
                let halves = vec![*x - *y * 0.2 - 0.6 - ease[1], *x * 0.5 + *z - 3.0 - ease[1]];
                (vec![one, two], vec![vec![sum], halves])
            },
        )
    };
    let options = SqpOptions {
        optimality: 1e-11,
        ..SqpOptions::default()
    };
    let of = |ease: [f64; 3]| {
        sqp(
            &problem(ease),
            &[0.1, 0.1, 0.1],
            &options,
            &Alone,
            &mut silent,
        )
    };
    let found = of([0.0; 3]);
    assert!(found.ended.is_optimal(), "{found:?}");
    let costs = [
        found.multipliers.cost(0),
        found.multipliers.cost(1),
        found.multipliers.bounds[2][1],
    ];
    for k in 0..3 {
        let at = |ease: f64| {
            let mut all = [0.0; 3];
            all[k] = ease;
            of(all).objective()
        };
        let gain = (at(-1e-4) - at(1e-4)) / 2e-4;
        println!("cost {k}: {} {gain}", costs[k]);
        assert!((gain - costs[k]).abs() < 1e-5, "{k}: {gain} {}", costs[k]);
    }
    assert!(
        costs.iter().filter(|c| **c > 0.01).count() >= 2,
        "{costs:?}"
    );
}

#[test]
fn who_listens_may_stop_it() {
    let case = Case::<2>::smooth(cube(2, -2.0, 2.0), 0, |[x, y]| {
        (
            (*y - x.square()).square() * 100.0 + (-*x + 1.0).square(),
            vec![],
        )
    });
    let mut told = 0;
    let mut stop = |_: &kempe_optimize::Progress| {
        told += 1;
        if told > 4 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    let found = sqp(
        &case,
        &[-1.2, 1.0],
        &SqpOptions::default(),
        &Alone,
        &mut stop,
    );
    assert_eq!(found.ended, Ended::Stopped);
    assert!(found.objective() < 24.2 && found.iterations == 4);
}

/// A variable whose bounds meet is none.
#[test]
fn a_fixed_variable_stays() {
    let case = Case::<2>::smooth(vec![[0.5, 0.5], [-2.0, 2.0]], 0, |[x, y]| {
        ((*y - *x).square() + *y, vec![])
    });
    let found = solve("fixed", &case, [1.0, 1.0]);
    is_optimum(&found, 0.25);
    assert_eq!(found.design[0], 0.5);
}

/// A variable whose bounds meet stays where it is, to the bit; the others find their optimum beside it.
#[test]
fn a_variable_may_be_fixed() {
    let case = Case::<3>::smooth(
        vec![[-5.0, 5.0], [1.3, 1.3], [-5.0, 5.0]],
        1,
        |[x, y, z]| {
            let f = (*x - *y).square() + (*z + *y * 2.0).square() + x.square();
            (f, vec![-*x + 1.0])
        },
    );
    let found = solve("fixed", &case, [3.0, 1.3, 2.0]);
    is_optimum(&found, 0.09 + 1.0);
    assert_eq!(found.design[1], 1.3);
    assert_eq!(found.multipliers.bounds[1], [0.0; 2]);
}

/// The same constraint twice, in other units and nearly the same: together they cost what one would.
#[test]
fn constraints_twice_over_do_not_matter() {
    let case = Case::<2>::pieces(cube(2, -50.0, 50.0), 4, |[x, y]| {
        let g = -*x - *y + 1.0;
        let constraints = vec![vec![g, g], vec![g], vec![g * 2.0], vec![g * (1.0 + 1e-12)]];
        (vec![x.square() + y.square()], constraints)
    });
    let found = solve("twice", &case, [3.0, -2.0]);
    is_optimum(&found, 0.5);
    let costs = (0..4).zip([1.0, 1.0, 2.0, 1.0]);
    let cost: f64 = costs
        .map(|(k, size)| size * found.multipliers.cost(k))
        .sum();
    assert!((cost - 1.0).abs() < 1e-5, "{cost}");
}

/// First-order conditions hold at a design that is its own mirror image, be it the worst of all: it is left.
#[test]
fn a_worst_design_whose_slopes_are_nothing_is_left() {
    let case = Case::<2>::smooth(vec![[-1.0, 2.0], [-1.0, 2.0]], 0, |[x, y]| {
        (y.square() - x.square(), vec![])
    });
    let found = solve("a ridge, reached along it", &case, [0.0, 1.0]);
    is_optimum(&found, -4.0);
    let found = solve("a ridge from its saddle", &case, [0.0, 0.0]);
    is_optimum(&found, -4.0);
    // No variable alone leads down.
    let case = Case::<2>::smooth(cube(2, -1.0, 1.0), 0, |[x, y]| (*x * *y, vec![]));
    is_optimum(&solve("a product", &case, [0.0, 0.0]), -1.0);
    // Two variables that can change places.
    let case = Case::<2>::smooth(cube(2, -1.0, 1.0), 0, |[x, y]| {
        ((*x + *y - 1.0).square() - (*x - *y).square(), vec![])
    });
    is_optimum(&solve("interchangeable", &case, [0.2, 0.2]), -3.0);
}

/// The same of a violation.
#[test]
fn a_largest_violation_is_left() {
    let case = Case::<2>::smooth(cube(2, -2.0, 2.0), 1, |[x, y]| {
        (y.square() + x.square(), vec![-x.square() + 1.0])
    });
    let found = solve("outside of a strip", &case, [0.0, 1.0]);
    is_optimum(&found, 1.0);
}

/// A least design is not left, and costs no more than the ways that were not seen.
#[test]
fn a_least_design_stays() {
    let case = Case::<2>::smooth(cube(2, -1.0, 1.0), 0, |[x, y]| {
        (x.square() + y.square() + *x * *y, vec![])
    });
    let found = solve("a bowl", &case, [0.0, 0.0]);
    is_optimum(&found, 0.0);
    assert_eq!((found.evaluations, found.design), (1 + 8, vec![0.0, 0.0]));
}

/// Whatever is found by a way that was never taken, the place of rest that it left is the answer where that is better.
#[test]
fn a_place_of_rest_is_left_for_a_better_one_only() {
    let mut random = Random(7);
    let mut among = |from: f64, to: f64| from + (to - from) * random.uniform();
    for k in 0..2000 {
        let waves: [[f64; 4]; 8] =
            std::array::from_fn(|_| [1.0, 10.0, 10.0, 10.0].map(|most| among(-most, most)));
        let room = if k % 2 == 0 { 0.0 } else { among(0.0, 0.1) };
        let case = Case::<3>::smooth(cube(3, -1.0, 1.0), 1, move |[x, y, z]| {
            let wave =
                |[size, a, b, c]: [f64; 4]| (-(*x * a + *y * b + *z * c).sin_cos().1 + 1.0) * size;
            let [f, c] = [&waves[..4], &waves[4..]].map(|some| {
                some.iter()
                    .fold(x.square() * 0.0, |sum, it| sum + wave(*it))
            });
            (f, vec![c - room])
        });
        let found = solve("waves", &case, [0.0; 3]);
        let told = found.conflicts.is_empty() && found.ended != Ended::Infeasible;
        assert!(
            told && found.violation <= 1e-9 && found.objective() <= 0.0,
            "{waves:?} {room} {found:?}"
        );
    }
}

/// Designs outside of a region have no values at all: the edge of the region is a limit like any other, whatever shape it has. Against the same problems with
/// the region as a constraint.
#[test]
fn the_edge_of_what_can_be_evaluated_is_a_limit() {
    fn both<const N: usize>(name: &str, start: [f64; N], region: Of<N>, goal: Of<N>) {
        let edged = edged::<N>(move |x| (region(x).re <= 0.0).then(|| goal(x)));
        let limited =
            Case::<N>::smooth(cube(N, -10.0, 10.0), 1, move |x| (goal(x), vec![region(x)]));
        let found = solve(name, &edged, start);
        let wanted = solve(name, &limited, start);
        assert_eq!(found.ended, Ended::Edge, "{name}");
        let missed = (found.objective() - wanted.objective()).abs();
        assert!(
            missed < 1e-6 * wanted.objective().abs().max(1.0),
            "{name}: {missed}"
        );
        let beyond = found.beyond.clone().expect("a design beyond the edge");
        assert!(!edged.evaluate(&beyond).is_defined());
        assert!(edged.evaluate(&found.design).is_defined());
        // What is known of how far it is from the edge saves designs in most of these.
        let case = Lacking {
            case: edged,
            region,
        };
        let faster = sqp(&case, &start, &SqpOptions::default(), &Alone, &mut silent);
        println!("{name}: {} evaluations by lacks", faster.evaluations);
        assert_eq!(faster.ended, Ended::Edge, "{name}");
        assert!((faster.objective() - found.objective()).abs() < 1e-6);
        let saves = !matches!(name, "hollow" | "wave");
        assert!(
            !saves || 2 * faster.evaluations < found.evaluations,
            "{name}"
        );
    }
    both::<2>(
        "straight",
        [0.0, 0.0],
        |[x, y]| *x + *y * 2.0 - 3.0,
        |[x, y]| (*x - 5.0).square() + (*y - 4.0).square(),
    );
    both::<2>(
        "round",
        [0.0, 0.0],
        |[x, y]| x.square() + y.square() - 4.0,
        |[x, y]| -*x * 3.0 - *y,
    );
    both::<2>(
        "hollow",
        [5.0, 1.0],
        |[x, y]| -(x.square() + y.square()) + 4.0,
        |[x, y]| x.square() * 2.0 + (*y - 0.5).square(),
    );
    both::<3>(
        "ball",
        [0.0, 0.0, 0.0],
        |[x, y, z]| x.square() + y.square() * 2.0 + z.square() * 3.0 - 6.0,
        |[x, y, z]| -*x - *y - *z,
    );
    both::<4>(
        "wave",
        [0.0, -3.0, 0.0, 0.0],
        |[x, y, z, w]| *y - x.sin_cos().0 - z.square() * 0.1 - *w * 0.2,
        |[x, y, z, w]| -*y + x.square() * 0.05 + (*z - 1.0).square() * 0.4 + (*w - 1.0).square(),
    );
}

/// Towards the edge a goal may be steep without bound, as an angle is where a linkage locks.
#[test]
fn an_edge_holds_a_goal_that_is_steep_towards_it() {
    let case = edged::<2>(|[x, y]| {
        let inside = -*x - *y * 2.0 + 3.0 - y.square() * 0.1;
        (inside.re > 0.0).then(|| inside.sqrt() + (*x - 1.0).square() * 0.1)
    });
    let found = solve("steep", &case, [0.0, 0.0]);
    assert_eq!(found.ended, Ended::Edge);
    assert!(found.objective() < 1e-3, "{}", found.objective());
}

/// What bounds cost beside an edge is what they cost beside the same limit, however steep the goal is towards it, and what a goal comes to on the edge
/// alone is not what designs beside it have.
#[test]
fn what_bounds_cost_along_an_edge_is_told() {
    let region: Of<3> = |[x, y, z]| *x + *y * 2.0 + y.square() * 0.1 + *z * 0.3 - 3.0;
    let along: Of<3> =
        |[x, y, z]| ((*x - 5.0).square() + (*y - 4.0).square()) * 0.05 + *z * (*x + 20.0) * 0.02;
    let limited = Case::<3>::smooth(cube(3, -10.0, 10.0), 1, move |x| {
        (along(x), vec![region(x)])
    });
    let wanted = solve("limited", &limited, [0.0, 0.0, 0.0]);
    let cost = wanted.eased.bounds[2][0];
    assert!(cost > 0.05, "{wanted:?}");
    for root in [0.0, 0.3, 3.0, 10.0] {
        for jump in [0.0, 1.0, -1.0] {
            let case = edged::<3>(move |x| {
                let inside = -region(x);
                let on_edge = if inside.re < 5e-9 { jump } else { 0.0 };
                (inside.re > 0.0).then(|| along(x) + inside.sqrt() * root + on_edge)
            });
            let found = solve("edged", &case, [0.0, 0.0, 0.0]);
            assert_eq!(found.ended, Ended::Edge, "{root} {jump}");
            let above = found.objective() - wanted.objective();
            assert!(above.abs() < 1e-3 * (1.0 + root), "{root} {jump}: {above}");
            let missed = found.eased.bounds[2][0] / cost - 1.0;
            assert!(missed.abs() < 1e-3, "{root} {jump}: {missed}");
        }
    }
}

/// A function, as of what is positive outside of a region.
type Of<const N: usize> = fn(&[D<N>; N]) -> D<N>;

/// A problem of a region that tells how far designs are from it.
struct Lacking<const N: usize> {
    case: Case<N>,
    region: Of<N>,
}

impl<const N: usize> Problem for Lacking<N> {
    fn bounds(&self) -> &[[f64; 2]] {
        self.case.bounds()
    }

    fn evaluate(&self, design: &[f64]) -> Evaluation {
        let found = self.case.evaluate(design);
        match found.is_defined() {
            true => found,
            false => {
                let far = (self.region)(&std::array::from_fn(|k| D::variable(design[k], k)));
                Evaluation::lacking(far.re)
            }
        }
    }

    fn slopes(&self, design: &[f64]) -> Option<Slopes> {
        self.case.slopes(design)
    }
}

/// A goal that has values somewhere alone.
fn edged<const N: usize>(
    goal: impl Fn(&[D<N>; N]) -> Option<D<N>> + Send + Sync + 'static,
) -> Case<N> {
    Case {
        bounds: cube(N, -10.0, 10.0),
        objectives: 1,
        constraints: 0,
        functions: Box::new(move |x| Some((vec![vec![goal(x)?]], vec![]))),
        asked: AtomicUsize::new(0),
    }
}

/// A problem without derivatives where a variable is near its upper bound, as beside a change point.
struct BareAbove(Case<2>);

impl Problem for BareAbove {
    fn bounds(&self) -> &[[f64; 2]] {
        self.0.bounds()
    }

    fn constraints(&self) -> usize {
        self.0.constraints()
    }

    fn evaluate(&self, design: &[f64]) -> Evaluation {
        self.0.evaluate(design)
    }

    fn slopes(&self, design: &[f64]) -> Option<Slopes> {
        (design[1] < 0.9).then(|| self.0.slopes(design)).flatten()
    }
}

/// What contradicts each other is told where the best has no derivatives, too, and by how much it is missed: not what is left of it where it is eased.
#[test]
fn what_cannot_be_kept_is_told_of_a_design_without_derivatives() {
    let case = Case::<2>::smooth(vec![[0.0, 1.0], [0.0, 1.0]], 1, |[x, y]| {
        (-*y, vec![-*x + 2.0])
    });
    let start = [0.3, 0.2];
    let options = SqpOptions::default();
    let found = sqp(&BareAbove(case), &start, &options, &Alone, &mut silent);
    assert_eq!(found.ended, Ended::Infeasible, "{found:?}");
    assert_eq!(found.conflicts, [[(0, 1.0)]]);
    assert!(
        found.design[0] > 1.0 - 1e-9 && found.design[1] >= 0.9,
        "{found:?}"
    );
    assert!((found.evaluation.constraints[0] - 1.0).abs() < 1e-9);
    assert!(found.violation > 0.1, "{found:?}");
}

/// Beside a pole both goal and slope are decades more than anywhere else: the scales of the start would call a hundredfold goal an optimum, and a limit
/// that is missed a thousandfold kept.
#[test]
fn scales_fall_with_what_they_are_of() {
    for start in [1e-9, 1e-6, 1e-4, 1e-2, 3.0] {
        let box_ = || vec![[1e-12, 10.0], [-8.0, 10.0]];
        let goal = Case::<2>::smooth(box_(), 0, |[x, y]| {
            (D::from_f64(1.0) / *x + *x + (*y - *x).square(), vec![])
        });
        let found = solve("pole", &goal, [start, 0.0]);
        is_optimum(&found, 2.0);
        let limit = Case::<2>::smooth(box_(), 1, |[x, y]| {
            (*x + (*y - *x).square(), vec![D::from_f64(1.0) / *x - 10.0])
        });
        let found = solve("limit at a pole", &limit, [start, 0.0]);
        is_optimum(&found, 0.1);
        assert!((found.multipliers.cost(0) - 0.01).abs() < 1e-6);
        assert!((found.eased.cost(0) - 0.01).abs() < 1e-6);
        // A limit with the same pole is kept by far, though not beside its slope there.
        let both = Case::<2>::smooth(box_(), 1, |[x, y]| {
            let (one, rest) = (D::from_f64(1.0), (*y - *x).square());
            (one / *x + rest, vec![-one / powi(*x, 3) + 4.5])
        });
        let found = solve("limit with a pole", &both, [start, start]);
        is_optimum(&found, math::powf(4.5, 1.0 / 3.0));
        // That slope holds a goal without a pole by nothing.
        let far = Case::<2>::smooth(box_(), 1, |[x, y]| {
            let limit = -D::from_f64(1.0) / powi(*x, 3) + 4.5;
            ((*x - 3.0).square() + (*y - *x).square(), vec![limit])
        });
        let found = solve("slack limit with a pole", &far, [start, start]);
        let away = 3.0 - math::powf(4.5, -1.0 / 3.0);
        is_optimum(&found, away * away);
        // What contradicts each other there does so by as much as from elsewhere.
        let none = Case::<2>::smooth(box_(), 2, |[x, y]| {
            let rows = vec![D::from_f64(1.0) / *x - 10.0, *x - 0.05];
            (*x + (*y - *x).square(), rows)
        });
        let found = sqp(
            &none,
            &[start, 0.0],
            &SqpOptions::default(),
            &Alone,
            &mut silent,
        );
        assert_eq!(found.ended, Ended::Infeasible, "{start}");
        assert!(
            found.design[0] > 0.05 && found.design[0] < 0.1,
            "{start}: {:?}",
            found.design
        );
    }
    // What is nothing at its optimum keeps its scale.
    let square = Case::<2>::smooth(cube(2, -1.0, 1.0), 0, |[x, y]| {
        (x.square() + (*y - 0.5).square(), vec![])
    });
    let found = solve("square", &square, [1.0, 1.0]);
    is_optimum(&found, 0.0);
    assert!(found.evaluations < 60, "{}", found.evaluations);
}

/// A disc, a half plane beyond it, and another limit that contradicts the disc: eased by as little as the first two miss, they leave a single place, at which
/// the rest is missed by as little as can be there. The worst miss comes first.
#[test]
fn what_contradicts_what_is_eased_leaves_the_worst_as_it_is() {
    for start in [[0.0, 0.0], [0.01, 0.02], [0.1, -0.3], [0.5, 0.2]] {
        let case = Case::<2>::smooth(cube(2, -20.0, 20.0), 4, |[x, y]| {
            let one = D::from_f64(1.0);
            let rows = vec![
                x.square() + y.square() - 4.0,
                -*x - *y + 8.0,
                -*x + 3.0,
                *y - 15.0,
            ];
            ((*x - one).square() + (*y - one).square(), rows)
        });
        let found = sqp(&case, &start, &SqpOptions::default(), &Alone, &mut silent);
        assert_eq!(found.ended, Ended::Infeasible, "{start:?}");
        // At x = y the disc and the half plane are missed by as much, in their scales.
        let [disc, plane] = [0, 1].map(|k| found.scales.constraints[k]);
        let missed = |x: f64| (8.0 - 2.0 * x) / plane;
        let least = (0..200).fold([0.0, 4.0], |[a, b], _| {
            let x = 0.5 * (a + b);
            match (2.0 * x * x - 4.0) / disc < missed(x) {
                true => [x, b],
                false => [a, x],
            }
        });
        let least = missed(least[0]);
        assert!(
            (found.violation - least).abs() < 1e-5,
            "{start:?}: {} for {least}",
            found.violation
        );
        assert!(found.conflicts.len() == 2, "{:?}", found.conflicts);
    }
}

/// Limits that fall by decades on the way, without a pole: what the start came to would keep a limit that is missed many times over.
#[test]
fn limits_of_steep_functions_are_kept() {
    type Limit = fn(D<2>) -> D<2>;
    let tests: [(f64, Limit, f64); 3] = [
        (300.0, |x| x.exp() - 10.0, math::ln(10.0)),
        (100.0, |x| powi(x, 5) - 30.0, math::powf(30.0, 0.2)),
        (100.0, |x| powi(x, 4) - 16.0, 2.0),
    ];
    for (most, limit, wanted) in tests {
        for start in [3.0, 20.0] {
            let case = Case::<2>::smooth(vec![[0.0, most], [0.0, most]], 1, move |[x, y]| {
                let goal = (*x - 4.0).square() + (*y - 1.0).square();
                (goal, vec![limit(*x)])
            });
            let found = solve("steep", &case, [start, start]);
            is_optimum(&found, (4.0 - wanted) * (4.0 - wanted));
            assert!((found.design[0] - wanted).abs() < 1e-7, "{found:?}");
        }
    }
}
