//! Global methods on published problems, and the same bits however batches are split.

use std::f64::consts::{PI, TAU};

use crate::support::hock_schittkowski::hs5;
use crate::support::{Case, D, Threads, cube};
use kempe_number::{Number, powi};
use kempe_optimize::{
    Alone, CmaEs, CmaEsOptions, DifferentialEvolution, DifferentialEvolutionOptions, Ended,
    Evaluation, FEASIBLE, Found, Further, Generations, MultiStartOptions, Problem, Slopes,
    Standing, cma_es, differential_evolution, evaluate_all, generations, halton, multi_start,
    silent,
};

fn sine<const N: usize>(x: D<N>) -> D<N> {
    x.sin_cos().0
}

/// L. A. Rastrigin (1974), moved so that no symmetry of the box helps.
fn rastrigin<const N: usize>() -> Case<N> {
    Case::smooth(cube(N, -5.12, 5.12), 0, |x| {
        let term = |x: D<N>| {
            let x = x - 0.7;
            x.square() - (x * TAU).sin_cos().1 * 10.0 + 10.0
        };
        (
            x.iter().fold(D::constant(0.0), |sum, x| sum + term(*x)),
            vec![],
        )
    })
}

/// H. H. Rosenbrock's valley (1960) in many variables.
fn rosenbrock<const N: usize>() -> Case<N> {
    Case::smooth(cube(N, -5.0, 5.0), 0, |x| {
        let pair = |a: D<N>, b: D<N>| (b - a.square()).square() * 100.0 + (-a + 1.0).square();
        (
            x.windows(2)
                .fold(D::constant(0.0), |sum, w| sum + pair(w[0], w[1])),
            vec![],
        )
    })
}

/// C. A. Floudas and P. M. Pardalos (1987), G06 of Z. Michalewicz and M. Schoenauer (1996): optimum -6961.81388, 0.0066 % of the box is feasible.
fn g06() -> Case<2> {
    Case::smooth(vec![[13.0, 100.0], [0.0, 100.0]], 2, |[x, y]| {
        let rows = vec![
            -(*x - 5.0).square() - (*y - 5.0).square() + 100.0,
            (*x - 6.0).square() + (*y - 5.0).square() - 82.81,
        ];
        (powi(*x - 10.0, 3) + powi(*y - 20.0, 3), rows)
    })
}

/// G08 of the same collection: optimum -0.0958250414.
fn g08() -> Case<2> {
    let mut case = Case::smooth(cube(2, 0.0, 10.0), 2, |_| unreachable!());
    case.functions = Box::new(|[x, y]| {
        if x.re <= 0.0 {
            return None;
        }
        let f = -powi(sine(*x * TAU), 3) * sine(*y * TAU) / (powi(*x, 3) * (*x + *y));
        let rows = vec![
            vec![x.square() - *y + 1.0],
            vec![-*x + (*y - 4.0).square() + 1.0],
        ];
        Some((vec![vec![f]], rows))
    });
    case
}

fn show(name: &str, found: &Found, asked: usize) {
    let polished = found.polished.as_ref().map(|p| (p.ended, p.residual));
    println!(
        "{name}: {:?} evaluations {} asked {asked} {:?} {polished:?}",
        found.standing, found.evaluations, found.ended
    );
}

#[track_caller]
fn is_near(found: &Found, wanted: f64, tolerance: f64) {
    match found.standing {
        Standing::Feasible(value) => assert!(
            (value - wanted).abs() <= tolerance * wanted.abs().max(1.0),
            "{value} {wanted}"
        ),
        other => panic!("{other:?}"),
    }
}

fn evolution(evaluations: usize, polished: bool) -> DifferentialEvolutionOptions {
    let options = DifferentialEvolutionOptions {
        evaluations,
        ..DifferentialEvolutionOptions::default()
    };
    match polished {
        true => options,
        false => DifferentialEvolutionOptions {
            polish: None,
            ..options
        },
    }
}

fn strategy(evaluations: usize, polished: bool) -> CmaEsOptions {
    let options = CmaEsOptions {
        evaluations,
        ..CmaEsOptions::default()
    };
    match polished {
        true => options,
        false => CmaEsOptions {
            polish: None,
            ..options
        },
    }
}

#[test]
fn many_local_minima_are_passed() {
    let case = rastrigin::<5>();
    let found = differential_evolution(&case, &evolution(30_000, false), &Alone, &mut silent);
    show("DE Rastrigin 5", &found, case.asked.into_inner());
    is_near(&found, 0.0, 1e-8);
    let case = rastrigin::<5>();
    let found = cma_es(&case, &strategy(100_000, false), &Alone, &mut silent);
    show("CMA Rastrigin 5", &found, case.asked.into_inner());
    is_near(&found, 0.0, 1e-8);
}

#[test]
fn a_bent_valley_of_ten_variables_is_followed() {
    let case = rosenbrock::<10>();
    let found = differential_evolution(&case, &evolution(60_000, false), &Alone, &mut silent);
    show("DE Rosenbrock 10", &found, case.asked.into_inner());
    is_near(&found, 0.0, 1e-3);
    let case = rosenbrock::<10>();
    let found = cma_es(&case, &strategy(20_000, false), &Alone, &mut silent);
    show("CMA Rosenbrock 10", &found, case.asked.into_inner());
    is_near(&found, 0.0, 1e-12);
    let case = rosenbrock::<10>();
    let found = differential_evolution(&case, &evolution(20_000, true), &Alone, &mut silent);
    show(
        "DE Rosenbrock 10, polished",
        &found,
        case.asked.into_inner(),
    );
    is_near(&found, 0.0, 1e-10);
}

#[test]
fn constraints_are_kept() {
    for polished in [false, true] {
        let tolerance = if polished { 1e-9 } else { 1e-6 };
        for (name, case, wanted) in [
            ("G06", g06 as fn() -> Case<2>, -6_961.813_875_580_14),
            ("G08", g08, -0.095_825_041_418_03),
        ] {
            let own = case();
            let found =
                differential_evolution(&own, &evolution(8_000, polished), &Alone, &mut silent);
            show(
                &format!("DE {name} {polished}"),
                &found,
                own.asked.into_inner(),
            );
            is_near(&found, wanted, tolerance);
            let own = case();
            let found = cma_es(&own, &strategy(20_000, polished), &Alone, &mut silent);
            show(
                &format!("CMA {name} {polished}"),
                &found,
                own.asked.into_inner(),
            );
            is_near(&found, wanted, tolerance);
        }
    }
}

/// The optimum is in a corner of the box.
#[test]
fn bounds_are_reached() {
    let case = || {
        Case::<3>::smooth(cube(3, -1.0, 2.0), 0, |[x, y, z]| {
            (*x * 2.0 + (*y + 3.0).square() + (*z - 0.3).square(), vec![])
        })
    };
    let own = case();
    let found = cma_es(&own, &strategy(6_000, false), &Alone, &mut silent);
    show("CMA corner", &found, own.asked.into_inner());
    is_near(&found, 2.0, 1e-9);
    let own = case();
    let found = differential_evolution(&own, &evolution(12_000, false), &Alone, &mut silent);
    show("DE corner", &found, own.asked.into_inner());
    is_near(&found, 2.0, 1e-6);
}

/// Only a small disc can be evaluated at all; how far a design is from it leads there.
struct Disc {
    bounds: Vec<[f64; 2]>,
}

impl Problem for Disc {
    fn bounds(&self) -> &[[f64; 2]] {
        &self.bounds
    }

    fn evaluate(&self, design: &[f64]) -> Evaluation {
        let x = design;
        let far = ((x[0] - 7.0) * (x[0] - 7.0) + (x[1] - 2.0) * (x[1] - 2.0)).sqrt() - 0.05;
        match far > 0.0 {
            true => Evaluation::lacking(far),
            false => Evaluation {
                objectives: vec![x[0] + x[1]],
                constraints: vec![],
                lack: 0.0,
            },
        }
    }

    fn slopes(&self, _: &[f64]) -> Option<Slopes> {
        None
    }
}

#[test]
fn what_a_design_lacks_leads_to_where_it_can_be_evaluated() {
    let wanted = 9.0 - 0.05 * 2.0_f64.sqrt();
    let disc = Disc {
        bounds: cube(2, -10.0, 10.0),
    };
    let found = differential_evolution(&disc, &evolution(6_000, false), &Alone, &mut silent);
    is_near(&found, wanted, 1e-5);
    let found = cma_es(&disc, &strategy(6_000, false), &Alone, &mut silent);
    is_near(&found, wanted, 1e-5);
}

/// The six-hump camel back (L. C. W. Dixon and G. P. Szego, 1978) has six minima: two each of -1.0316, -0.2155 and 2.1042.
#[test]
fn all_local_optima_are_listed() {
    let case = Case::<2>::smooth(vec![[-3.0, 3.0], [-2.0, 2.0]], 0, |[x, y]| {
        let (x2, y2) = (x.square(), y.square());
        (
            (-x2 * 2.1 + x2 * x2 / 3.0 + 4.0) * x2 + *x * *y + (y2 * 4.0 - 4.0) * y2,
            vec![],
        )
    });
    let options = MultiStartOptions {
        starts: 40,
        ..MultiStartOptions::default()
    };
    let found = multi_start(&case, &options, &Alone, &mut silent);
    let optimal = found.optima.iter().filter(|(o, _)| o.ended.is_optimal());
    let values: Vec<f64> = optimal.map(|(o, _)| o.objective()).collect();
    println!(
        "camel: {values:?} evaluations {} starts {}",
        found.evaluations, found.starts
    );
    let wanted = [
        -1.031_628_453,
        -1.031_628_453,
        -0.215_463_824,
        -0.215_463_824,
        2.104_250_310,
        2.104_250_310,
    ];
    assert_eq!(found.ended, Ended::Converged);
    assert_eq!(values.len(), 6);
    assert!(values.iter().zip(wanted).all(|(v, w)| (v - w).abs() < 1e-7));
    assert_eq!(
        found.optima.iter().map(|o| o.1).sum::<usize>(),
        found.starts
    );
}

/// A method whose designs are evaluated as the callback likes.
fn in_parts(method: &mut dyn Generations, problem: &dyn Problem, part: usize) {
    while !method.is_finished() && method.evaluations() < method.budget() {
        let designs = method.ask();
        assert_eq!(designs, method.ask());
        let evaluations = designs
            .chunks(part)
            .flat_map(|some| evaluate_all(problem, some, &Alone))
            .collect();
        method.tell(evaluations);
    }
}

#[test]
fn the_same_seed_gives_the_same_bits() {
    let evolution = evolution(3_000, false);
    let strategy = strategy(3_000, false);
    let mut one = DifferentialEvolution::new(&g06(), &evolution);
    let mut two = one.clone();
    in_parts(&mut one, &g06(), 1);
    in_parts(&mut two, &g06(), 7);
    assert_eq!(one, two);
    let mut whole = DifferentialEvolution::new(&g06(), &evolution);
    generations(&g06(), &mut whole, &Alone, &mut silent);
    assert_eq!(one, whole);
    let mut one = CmaEs::new(&rastrigin::<5>(), &strategy);
    let mut two = one.clone();
    in_parts(&mut one, &rastrigin::<5>(), 1);
    in_parts(&mut two, &rastrigin::<5>(), 5);
    assert_eq!(one, two);
    let other = CmaEsOptions {
        seed: 2,
        ..strategy
    };
    let mut three = CmaEs::new(&rastrigin::<5>(), &other);
    in_parts(&mut three, &rastrigin::<5>(), 5);
    assert_ne!(one.best, three.best);
}

/// Of a plane's area, points that fill it evenly miss less than ones at random would.
#[test]
fn samples_fill_the_box_evenly() {
    for seed in 0..4 {
        let points = halton(seed, 1000, 6);
        for pair in [(0, 1), (2, 3), (4, 5)] {
            let inside = points
                .iter()
                .filter(|p| powi(p[pair.0], 2) + powi(p[pair.1], 2) < 1.0)
                .count();
            assert!(
                (inside as f64 / 1000.0 - PI / 4.0).abs() < 0.012,
                "{seed} {pair:?} {inside}"
            );
        }
        assert!(points.iter().flatten().all(|x| (0.0..1.0).contains(x)));
    }
}

/// Methods and descents that go side by side: the same bits whatever does the work.
#[test]
fn the_same_bits_for_any_number_of_threads() {
    let start = Some(vec![20.0, 3.0]);
    let evolution = DifferentialEvolutionOptions {
        start: start.clone(),
        ..evolution(3_000, true)
    };
    let strategy = CmaEsOptions {
        start,
        ..strategy(3_000, true)
    };
    let many = MultiStartOptions {
        start: Some(vec![3.0; 5]),
        ..MultiStartOptions::default()
    };
    let alone = (
        differential_evolution(&g06(), &evolution, &Alone, &mut silent),
        cma_es(&g06(), &strategy, &Alone, &mut silent),
        multi_start(&rastrigin::<5>(), &many, &Alone, &mut silent),
    );
    assert!(alone.2.optima.len() > 1 && alone.2.starts == 13);
    for threads in [2, 5] {
        let threads = Threads(threads);
        let found = (
            differential_evolution(&g06(), &evolution, &threads, &mut silent),
            cma_es(&g06(), &strategy, &threads, &mut silent),
            multi_start(&rastrigin::<5>(), &many, &threads, &mut silent),
        );
        assert_eq!(alone, found);
    }
}

/// A start that nothing can be evaluated at does not keep the others from being followed; one in the best valley is found by itself.
#[test]
fn a_given_start_is_followed_besides() {
    let options = |start: [f64; 5]| MultiStartOptions {
        start: Some(start.to_vec()),
        starts: 0,
        ..MultiStartOptions::default()
    };
    let found = multi_start(&rastrigin::<5>(), &options([0.8; 5]), &Alone, &mut silent);
    assert!(found.starts == 1 && found.optima[0].0.objective() < 1e-9);
    let found = multi_start(&rastrigin::<5>(), &options([1.6; 5]), &Alone, &mut silent);
    assert!(
        (found.optima[0].0.objective() - 5.0).abs() < 0.1,
        "{:?}",
        found.optima[0].0
    );
    // The first generation has it.
    let near = DifferentialEvolutionOptions {
        start: Some(vec![0.7; 5]),
        ..evolution(90, false)
    };
    let found = differential_evolution(&rastrigin::<5>(), &near, &Alone, &mut silent);
    is_near(&found, 0.0, 1e-12);
    let near = CmaEsOptions {
        start: Some(vec![0.7; 5]),
        ..strategy(8, false)
    };
    let found = cma_es(&rastrigin::<5>(), &near, &Alone, &mut silent);
    is_near(&found, 0.0, 1e-12);
}

/// A design that is given leads downhill to what a population of so few misses: a narrow well far from a wide bowl.
#[test]
fn a_population_does_not_miss_what_a_given_start_leads_to() {
    let case = || {
        Case::smooth(vec![[-50.0, 50.0]], 0, |[x]| {
            let well = (-(*x - 25.0).square() / 4.5).exp();
            ((*x + 30.0).square() * 0.001 - well * 6.0, vec![])
        })
    };
    let reached = |found: &Found| {
        let polished = found.polished.as_ref().unwrap();
        assert_eq!(polished.design, found.best.as_ref().unwrap().design);
        assert!(found.descents >= polished.evaluations);
        polished.ended.is_optimal() && polished.objective() < -2.5
    };
    for (start, wanted) in [(None, false), (Some(vec![21.0]), true)] {
        let few = DifferentialEvolutionOptions {
            start: start.clone(),
            ..evolution(20, true)
        };
        let found = differential_evolution(&case(), &few, &Alone, &mut silent);
        assert_eq!((reached(&found), found.from_given), (wanted, wanted));
        let few = CmaEsOptions {
            start,
            step: 0.01,
            ..strategy(20, true)
        };
        let found = cma_es(&case(), &few, &Alone, &mut silent);
        assert_eq!(reached(&found), wanted);
        // Where the given design is the best of all, it is led down once.
        assert!(wanted || !found.from_given);
    }
}

/// A population may end lower than any optimum by rounding: the optimum is the answer, with its conditions.
#[test]
fn what_is_as_good_but_for_rounding_is_shown_to_be_optimal() {
    for seed in 1..9 {
        let options = CmaEsOptions {
            seed,
            ..strategy(800, true)
        };
        let found = cma_es(&hs5().case, &options, &Alone, &mut silent);
        is_near(&found, hs5().optimum, 1e-8);
        let (best, polished) = (found.best.unwrap(), found.polished.unwrap());
        assert!(polished.ended.is_optimal() && polished.design == best.design);
    }
}

/// What was found when it was stopped is kept, even within the first generation.
#[test]
fn stopped_methods_keep_their_best() {
    for after in [40, 600] {
        let stop = |p: &kempe_optimize::Progress| match p.evaluations >= after {
            true => std::ops::ControlFlow::Break(()),
            false => std::ops::ControlFlow::Continue(()),
        };
        let found =
            differential_evolution(&rastrigin::<5>(), &evolution(3_000, true), &Alone, &mut {
                stop
            });
        assert_eq!(found.ended, Ended::Stopped);
        assert!(
            found.best.is_some() && found.evaluations >= after && found.evaluations < after + 40
        );
        let found = cma_es(&rastrigin::<5>(), &strategy(3_000, true), &Alone, &mut {
            stop
        });
        assert!(found.ended == Ended::Stopped && found.best.is_some());
        let found = multi_start(
            &rastrigin::<5>(),
            &MultiStartOptions::default(),
            &Alone,
            &mut { stop },
        );
        assert!(found.ended == Ended::Stopped && found.best_sample.is_some());
        assert_eq!(found.starts == 0, after < 500);
    }
}

/// No more designs than asked for, but for the step at hand of each descent.
#[test]
fn budgets_are_kept() {
    for evaluations in [37, 500, 1001] {
        let case = rastrigin::<5>();
        let found =
            differential_evolution(&case, &evolution(evaluations, false), &Alone, &mut silent);
        assert_eq!(
            (found.evaluations, case.asked.into_inner()),
            (evaluations, evaluations)
        );
        let case = rastrigin::<5>();
        let found = cma_es(&case, &strategy(evaluations, false), &Alone, &mut silent);
        assert_eq!(
            (found.evaluations, case.asked.into_inner()),
            (evaluations, evaluations)
        );
        let case = rastrigin::<5>();
        let options = MultiStartOptions {
            samples: Some(evaluations / 2),
            evaluations,
            ..MultiStartOptions::default()
        };
        let found = multi_start(&case, &options, &Alone, &mut silent);
        assert_eq!(found.evaluations, case.asked.into_inner());
        assert!(
            found.evaluations <= evaluations + found.starts * 38,
            "{}",
            found.evaluations
        );
    }
}

/// What all starts miss by as much is told apart by the objective: x cannot be 2, and y is best in the deeper of two valleys.
#[test]
fn of_equal_misses_the_best_objective_is_first() {
    let case = Case::<2>::smooth(vec![[0.0, 1.0], [-1.5, 1.5]], 1, |[x, y]| {
        let valleys = (y.square() - 1.0).square();
        (valleys + *y * 0.2, vec![-*x + 2.0])
    });
    for seed in 1..6 {
        let options = MultiStartOptions {
            seed,
            ..MultiStartOptions::default()
        };
        let found = multi_start(&case, &options, &Alone, &mut silent);
        let reached: Vec<f64> = found.optima.iter().map(|(it, _)| it.design[1]).collect();
        assert!(reached.iter().any(|y| *y > 0.9), "{reached:?}");
        let (best, _) = &found.optima[0];
        assert_eq!(best.ended, Ended::Infeasible);
        assert!(best.design[1] < -0.9, "{reached:?}");
    }
}

/// A constraint with a wide valley that does not reach down to what must be kept and a narrow one, away from it, that does: 0.02 % of the box.
fn narrow() -> Case<3> {
    Case::smooth(cube(3, 0.0, 1.0), 1, |x| {
        let far = |at: f64| {
            let squares = x.iter().map(|x| (*x - at).square());
            squares.fold(x[0] * 0.0, |sum, square| sum + square)
        };
        let well = (-far(0.2) / (0.09 * 0.09)).exp() * -1.2 + 1.0;
        (x[0], vec![(far(0.75) + 0.05) * well])
    })
}

/// Where ways down end in the wide valley the box is sampled again, whatever the method.
#[test]
fn what_keeps_the_constraints_is_found_in_a_narrow_valley() {
    let mut looked = [0; 3];
    for seed in 1..9 {
        let options = MultiStartOptions {
            samples: Some(72),
            starts: 6,
            seed,
            ..MultiStartOptions::default()
        };
        let found = multi_start(&narrow(), &options, &Alone, &mut silent);
        let (best, _) = &found.optima[0];
        assert!(best.violation <= FEASIBLE && best.ended.is_optimal());
        assert!((best.design[0] - 0.2).abs() < 0.1, "{:?}", best.design);
        looked[0] += usize::from(found.for_constraints > 0);
        let evolution = DifferentialEvolutionOptions {
            seed,
            ..evolution(600, true)
        };
        let strategy = CmaEsOptions {
            seed,
            ..strategy(600, true)
        };
        let populations = [
            differential_evolution(&narrow(), &evolution, &Alone, &mut silent),
            cma_es(&narrow(), &strategy, &Alone, &mut silent),
        ];
        for (k, found) in populations.into_iter().enumerate() {
            assert!(
                matches!(found.standing, Standing::Feasible(_)),
                "{seed} {k}"
            );
            let polished = found.polished.expect("a way down");
            assert!(polished.ended.is_optimal());
            looked[k + 1] += usize::from(found.for_constraints > 0);
        }
    }
    // Each of them needs it for most of the seeds.
    assert!(looked.iter().all(|times| *times >= 4), "{looked:?}");
}

/// J. Shekel's foxholes as in L. C. W. Dixon and G. P. Szegö (1978): so many valleys, of which the deepest reaches down to -10.1532, -10.4029 or -10.5364.
fn shekel(holes: usize) -> Case<4> {
    const AT: [[f64; 4]; 10] = [
        [4.0, 4.0, 4.0, 4.0],
        [1.0, 1.0, 1.0, 1.0],
        [8.0, 8.0, 8.0, 8.0],
        [6.0, 6.0, 6.0, 6.0],
        [3.0, 7.0, 3.0, 7.0],
        [2.0, 9.0, 2.0, 9.0],
        [5.0, 5.0, 3.0, 3.0],
        [8.0, 1.0, 8.0, 1.0],
        [6.0, 2.0, 6.0, 2.0],
        [7.0, 3.6, 7.0, 3.6],
    ];
    const WIDE: [f64; 10] = [0.1, 0.2, 0.2, 0.4, 0.4, 0.6, 0.3, 0.7, 0.5, 0.5];
    Case::smooth(cube(4, 0.0, 10.0), 0, move |x| {
        let holes = AT.iter().zip(WIDE).take(holes).map(|(at, wide)| {
            let squares = x.iter().zip(at).map(|(x, at)| (*x - *at).square());
            let far = squares.fold(D::constant(wide), |sum, square| sum + square);
            -D::constant(1.0) / far
        });
        (holes.fold(D::constant(0.0), |sum, hole| sum + hole), vec![])
    })
}

/// Rounds go on until no more than the part that was asked for is expected elsewhere, and find the deepest of many valleys, which one round may miss.
#[test]
fn further_rounds_find_the_deepest_valley() {
    let mut missed = 0;
    for (holes, deepest) in [(5, -10.1532), (7, -10.4029), (10, -10.5364)] {
        for seed in 1..9 {
            let once = MultiStartOptions {
                samples: Some(96),
                starts: 6,
                seed,
                ..MultiStartOptions::default()
            };
            let further = MultiStartOptions {
                further: Some(Further {
                    unseen: 0.05,
                    evaluations: 6000,
                }),
                ..once.clone()
            };
            let [once, further] = [once, further]
                .map(|options| multi_start(&shekel(holes), &options, &Alone, &mut silent));
            let is_deepest = |found: &kempe_optimize::Optima| {
                (found.optima[0].0.objective() - deepest).abs() < 1e-4
            };
            missed += usize::from(!is_deepest(&once));
            assert!(is_deepest(&further), "{holes} {seed}");
            let [before, after] = [&once, &further].map(|it| it.reached.unseen());
            assert!(before > 0.05 && after <= 0.05, "{before} {after}");
            assert!(further.samples > once.samples && further.evaluations < 6000);
        }
    }
    assert!(missed > 0);
}

/// No round begins where designs are used up, and what is left to find is told.
#[test]
fn rounds_end_where_designs_do() {
    let options = MultiStartOptions {
        samples: Some(96),
        starts: 6,
        further: Some(Further {
            unseen: 0.0,
            evaluations: 1000,
        }),
        ..MultiStartOptions::default()
    };
    let found = multi_start(&shekel(10), &options, &Alone, &mut silent);
    assert!(
        found.evaluations >= 1000 && found.evaluations < 1700,
        "{}",
        found.evaluations
    );
    assert!(found.reached.unseen() > 0.0 && found.ended == Ended::Converged);
}
