//! Global methods on published problems, and the same bits however batches are split.

mod support;

use std::f64::consts::{PI, TAU};

use kempe_number::{Number, powi};
use kempe_optimize::{
    CmaEs, CmaEsOptions, DifferentialEvolution, DifferentialEvolutionOptions, Ended, Evaluation,
    Found, Generations, MultiStartOptions, Problem, Slopes, Standing, cma_es,
    differential_evolution, generations, halton, multi_start, silent,
};
use support::{Case, D, cube};

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
    let mut case = rastrigin::<5>();
    let found = differential_evolution(&mut case, &evolution(30_000, false), &mut silent);
    show("DE Rastrigin 5", &found, case.asked);
    is_near(&found, 0.0, 1e-8);
    let mut case = rastrigin::<5>();
    let found = cma_es(&mut case, &strategy(100_000, false), &mut silent);
    show("CMA Rastrigin 5", &found, case.asked);
    is_near(&found, 0.0, 1e-8);
}

#[test]
fn a_bent_valley_of_ten_variables_is_followed() {
    let mut case = rosenbrock::<10>();
    let found = differential_evolution(&mut case, &evolution(60_000, false), &mut silent);
    show("DE Rosenbrock 10", &found, case.asked);
    is_near(&found, 0.0, 1e-3);
    let mut case = rosenbrock::<10>();
    let found = cma_es(&mut case, &strategy(20_000, false), &mut silent);
    show("CMA Rosenbrock 10", &found, case.asked);
    is_near(&found, 0.0, 1e-12);
    let mut case = rosenbrock::<10>();
    let found = differential_evolution(&mut case, &evolution(20_000, true), &mut silent);
    show("DE Rosenbrock 10, polished", &found, case.asked);
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
            let mut own = case();
            let found = differential_evolution(&mut own, &evolution(8_000, polished), &mut silent);
            show(&format!("DE {name} {polished}"), &found, own.asked);
            is_near(&found, wanted, tolerance);
            let mut own = case();
            let found = cma_es(&mut own, &strategy(20_000, polished), &mut silent);
            show(&format!("CMA {name} {polished}"), &found, own.asked);
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
    let mut own = case();
    let found = cma_es(&mut own, &strategy(6_000, false), &mut silent);
    show("CMA corner", &found, own.asked);
    is_near(&found, 2.0, 1e-9);
    let mut own = case();
    let found = differential_evolution(&mut own, &evolution(12_000, false), &mut silent);
    show("DE corner", &found, own.asked);
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

    fn evaluate(&mut self, designs: &[Vec<f64>]) -> Vec<Evaluation> {
        let one = |x: &Vec<f64>| {
            let far = ((x[0] - 7.0) * (x[0] - 7.0) + (x[1] - 2.0) * (x[1] - 2.0)).sqrt() - 0.05;
            match far > 0.0 {
                true => Evaluation::lacking(far),
                false => Evaluation {
                    objectives: vec![x[0] + x[1]],
                    constraints: vec![],
                    lack: 0.0,
                },
            }
        };
        designs.iter().map(one).collect()
    }

    fn slopes(&mut self, _: &[f64]) -> Option<Slopes> {
        None
    }
}

#[test]
fn what_a_design_lacks_leads_to_where_it_can_be_evaluated() {
    let wanted = 9.0 - 0.05 * 2.0_f64.sqrt();
    let mut disc = Disc {
        bounds: cube(2, -10.0, 10.0),
    };
    let found = differential_evolution(&mut disc, &evolution(6_000, false), &mut silent);
    is_near(&found, wanted, 1e-5);
    let found = cma_es(&mut disc, &strategy(6_000, false), &mut silent);
    is_near(&found, wanted, 1e-5);
}

/// The six-hump camel back (L. C. W. Dixon and G. P. Szego, 1978) has six minima: two each of -1.0316, -0.2155 and 2.1042.
#[test]
fn all_local_optima_are_listed() {
    let mut case = Case::<2>::smooth(vec![[-3.0, 3.0], [-2.0, 2.0]], 0, |[x, y]| {
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
    let found = multi_start(&mut case, &options, &mut silent);
    let values: Vec<f64> = found.optima.iter().map(|(o, _)| o.objective()).collect();
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
fn in_parts(method: &mut dyn Generations, problem: &mut dyn Problem, part: usize) {
    while !method.is_finished() && method.evaluations() < method.budget() {
        let designs = method.ask();
        assert_eq!(designs, method.ask());
        let evaluations = designs
            .chunks(part)
            .flat_map(|some| problem.evaluate(some))
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
    in_parts(&mut one, &mut g06(), 1);
    in_parts(&mut two, &mut g06(), 7);
    assert_eq!(one, two);
    let mut whole = DifferentialEvolution::new(&g06(), &evolution);
    generations(&mut g06(), &mut whole, &mut silent);
    assert_eq!(one, whole);
    let mut one = CmaEs::new(&rastrigin::<5>(), &strategy);
    let mut two = one.clone();
    in_parts(&mut one, &mut rastrigin::<5>(), 1);
    in_parts(&mut two, &mut rastrigin::<5>(), 5);
    assert_eq!(one, two);
    let other = CmaEsOptions {
        seed: 2,
        ..strategy
    };
    let mut three = CmaEs::new(&rastrigin::<5>(), &other);
    in_parts(&mut three, &mut rastrigin::<5>(), 5);
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
