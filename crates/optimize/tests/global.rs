//! Global methods and fronts on standard problems.
#![allow(clippy::unwrap_used)]

mod support;

use kempe_number::Number;
use kempe_optimize::{
    Even, Front, MultiStartOptions, PopulationOptions, Problem, SqpOptions, cma_es,
    differential_evolution, hypervolume, multi_start, nsga2, refine, silent,
};
use support::{D, Given, c, sq};

fn rastrigin(n: usize) -> Given {
    Given::new(&vec![[-5.12, 4.0]; n], [1, 0], |x| {
        let one = |x: &D| sq(*x) - c(10.0) * (*x * c(std::f64::consts::TAU)).sin_cos().1 + c(10.0);
        Some(vec![vec![x.iter().map(one).fold(c(0.0), |a, b| a + b)]])
    })
}

fn rosenbrock(n: usize) -> Given {
    Given::new(&vec![[-2.0, 3.0]; n], [1, 0], |x| {
        let pair = |w: &[D]| c(100.0) * sq(w[1] - sq(w[0])) + sq(c(1.0) - w[0]);
        Some(vec![vec![
            x.windows(2).map(pair).fold(c(0.0), |a, b| a + b),
        ]])
    })
}

/// G06 of the CEC 2006 set (C. A. Floudas and P. M. Pardalos 1987): -6961.81388.
fn g06() -> Given {
    Given::new(&[[13.0, 100.0], [0.0, 100.0]], [1, 2], |x| {
        let cube = |x: D| x * x * x;
        Some(vec![
            vec![cube(x[0] - c(10.0)) + cube(x[1] - c(20.0))],
            vec![c(100.0) - sq(x[0] - c(5.0)) - sq(x[1] - c(5.0))],
            vec![sq(x[0] - c(6.0)) + sq(x[1] - c(5.0)) - c(82.81)],
        ])
    })
}

#[test]
fn many_valleys() {
    let options = PopulationOptions {
        evaluations: 40_000,
        ..PopulationOptions::default()
    };
    let found =
        differential_evolution(&mut rastrigin(5), &[3.0; 5], &options, &mut silent).unwrap();
    assert!(found.evaluation.largest() < 1e-8, "{found:?}");
    let found = cma_es(&mut rastrigin(4), &[3.0; 4], &options, &mut silent).unwrap();
    assert!(found.evaluation.largest() < 1e-8, "{found:?}");
    let optima = multi_start(
        &mut rastrigin(2),
        &[3.0; 2],
        &MultiStartOptions {
            looked_at: 400,
            starts: 20,
            ..MultiStartOptions::default()
        },
        &mut silent,
    );
    assert!(optima.list[0].objective() < 1e-9, "{:?}", optima.list[0]);
    assert!(
        optima.list.len() > 5
            && optima
                .list
                .windows(2)
                .all(|w| w[0].objective() <= w[1].objective())
    );
}

#[test]
fn a_long_bent_valley() {
    let options = PopulationOptions {
        evaluations: 120_000,
        ..PopulationOptions::default()
    };
    let found = cma_es(&mut rosenbrock(10), &[-1.0; 10], &options, &mut silent).unwrap();
    assert!(found.evaluation.largest() < 1e-8, "{found:?}");
    let found =
        differential_evolution(&mut rosenbrock(8), &[-1.0; 8], &options, &mut silent).unwrap();
    assert!(found.evaluation.largest() < 1e-6, "{found:?}");
}

#[test]
fn constraints_are_kept_by_rank() {
    let options = PopulationOptions {
        evaluations: 20_000,
        ..PopulationOptions::default()
    };
    let found = differential_evolution(&mut g06(), &[50.0, 50.0], &options, &mut silent).unwrap();
    assert!(
        (found.evaluation.largest() + 6_961.813_875_580_1).abs() < 2e-2 && found.violation <= 1e-9,
        "{found:?}"
    );
    let found = cma_es(&mut g06(), &[50.0, 50.0], &options, &mut silent).unwrap();
    assert!(
        (found.evaluation.largest() + 6_961.813_875_580_1).abs() < 1.0 && found.violation <= 1e-9,
        "{found:?}"
    );
}

#[test]
fn a_seed_gives_the_same_bits_however_many_are_asked_at_once() {
    struct OneByOne(Given);
    impl Problem for OneByOne {
        fn bounds(&self) -> &[[f64; 2]] {
            self.0.bounds()
        }
        fn evaluate(&mut self, designs: &[Vec<f64>]) -> Vec<kempe_optimize::Evaluation> {
            designs
                .iter()
                .flat_map(|d| self.0.evaluate(std::slice::from_ref(d)))
                .collect()
        }
        fn slopes(&mut self, design: &[f64]) -> Option<kempe_optimize::Slopes> {
            self.0.slopes(design)
        }
    }
    let options = PopulationOptions {
        evaluations: 3000,
        seed: 9,
        ..PopulationOptions::default()
    };
    let a = differential_evolution(&mut rosenbrock(4), &[0.0; 4], &options, &mut silent).unwrap();
    let b = differential_evolution(
        &mut OneByOne(rosenbrock(4)),
        &[0.0; 4],
        &options,
        &mut silent,
    )
    .unwrap();
    assert_eq!(a, b);
    let other = PopulationOptions {
        seed: 10,
        ..options
    };
    assert_ne!(
        a,
        differential_evolution(&mut rosenbrock(4), &[0.0; 4], &other, &mut silent).unwrap()
    );
}

#[test]
fn even_points_fill_the_box() {
    let mut even = Even::new(3, 4);
    let mut boxes = [0; 64];
    for _ in 0..6400 {
        let p = even.point();
        let k: Vec<usize> = p.iter().map(|x| (x * 4.0) as usize).collect();
        boxes[k[0] * 16 + k[1] * 4 + k[2]] += 1;
    }
    assert!(boxes.iter().all(|n| (85..115).contains(n)), "{boxes:?}");
}

#[test]
fn volumes_of_boxes() {
    let one = vec![vec![0.0, 0.5], vec![0.5, 0.0]];
    assert!((hypervolume(&one, &[1.0, 1.0]) - 0.75).abs() < 1e-15);
    let three = vec![
        vec![0.0, 0.0, 0.5],
        vec![0.5, 0.5, 0.0],
        vec![2.0, 0.0, 0.0],
    ];
    assert!((hypervolume(&three, &[1.0; 3]) - (0.5 + 0.125)).abs() < 1e-15);
    let shell: Vec<Vec<f64>> = (0..4)
        .map(|k| (0..4).map(|j| if j == k { 0.5 } else { 0.0 }).collect())
        .collect();
    // All of the unit box but the corner where every coordinate is below a half.
    assert!((hypervolume(&shell, &[1.0; 4]) - (1.0 - 1.0 / 16.0)).abs() < 1e-15);
}

/// Zitzler, Deb and Thiele's problems (2000): f1 and f2 = g h.
fn zdt(which: usize) -> (Given, f64) {
    let unit = vec![[0.0, 1.0]; 10];
    match which {
        1 => (
            Given::new(&unit, [2, 0], |x| {
                let g = c(1.0) + x[1..].iter().fold(c(0.0), |a, b| a + *b) * c(1.0);
                Some(vec![
                    vec![x[0]],
                    vec![g * (c(1.0) - (x[0] / g + c(1e-300)).sqrt())],
                ])
            }),
            2.0 / 3.0 + 0.21,
        ),
        2 => (
            Given::new(&unit, [2, 0], |x| {
                let g = c(1.0) + x[1..].iter().fold(c(0.0), |a, b| a + *b) * c(1.0);
                Some(vec![vec![x[0]], vec![g * (c(1.0) - sq(x[0] / g))]])
            }),
            1.0 / 3.0 + 0.21,
        ),
        _ => (
            Given::new(&unit, [2, 0], |x| {
                let g = c(1.0) + x[1..].iter().fold(c(0.0), |a, b| a + *b) * c(1.0);
                let (s, _) = (x[0] * c(10.0 * std::f64::consts::PI)).sin_cos();
                let r = x[0] / g + c(1e-300);
                Some(vec![vec![x[0]], vec![g * (c(1.0) - r.sqrt() - r * s)]])
            }),
            f64::NAN,
        ),
    }
}

fn volume(front: &Front) -> f64 {
    let points: Vec<Vec<f64>> = front
        .points
        .iter()
        .map(|p| p.evaluation.objectives.clone())
        .collect();
    hypervolume(&points, &[1.1, 1.1])
}

#[test]
fn fronts_by_their_volume() {
    for which in [1, 2] {
        let (mut problem, whole) = zdt(which);
        let options = PopulationOptions {
            evaluations: 20_000,
            ..PopulationOptions::default()
        };
        let front = nsga2(&mut problem, &[0.5; 10], &options, &mut silent).unwrap();
        let got = volume(&front);
        assert!(
            got > whole - 0.02 && got < whole + 1e-9,
            "ZDT{which}: {got} of {whole}"
        );
        // Refined, its points lie on the front.
        let mut refined = front.clone();
        refine(
            &mut problem,
            &mut refined,
            &SqpOptions::default(),
            &mut silent,
        );
        assert!(refined.points.len() > 50 && volume(&refined) >= got - 1e-9);
        for p in &refined.points {
            let [f, g] = [p.evaluation.objectives[0], p.evaluation.objectives[1]];
            let on = match which {
                1 => 1.0 - f.sqrt(),
                _ => 1.0 - f * f,
            };
            assert!(
                (g - on).abs() < 1e-6 || f < 1e-6,
                "ZDT{which}: {f} {g} {on}"
            );
        }
    }
    let (mut problem, _) = zdt(3);
    let options = PopulationOptions {
        evaluations: 20_000,
        ..PopulationOptions::default()
    };
    let front = nsga2(&mut problem, &[0.5; 10], &options, &mut silent).unwrap();
    // Its parts end at these places of the first objective.
    let parts = [
        [0.0, 0.083_001_5],
        [0.182_228, 0.257_762],
        [0.409_313, 0.453_882],
        [0.618_396, 0.652_511],
        [0.823_331, 0.851_832],
    ];
    let mut seen = [false; 5];
    for p in &front.points {
        let f = p.evaluation.objectives[0];
        let k = parts
            .iter()
            .position(|[a, b]| *a - 0.01 <= f && f <= *b + 0.01);
        seen[k.unwrap_or_else(|| panic!("{f}"))] = true;
    }
    assert_eq!(seen, [true; 5]);
}

#[test]
fn three_objectives() {
    // DTLZ2 (K. Deb et al. 2005): a part of the unit sphere.
    let mut problem = Given::new(&[[0.0, 1.0]; 7], [3, 0], |x| {
        let half = c(std::f64::consts::FRAC_PI_2);
        let g = x[2..].iter().fold(c(1.0), |s, x| s + sq(*x - c(0.5)));
        let ((s0, c0), (s1, c1)) = ((x[0] * half).sin_cos(), (x[1] * half).sin_cos());
        Some(vec![vec![g * c0 * c1], vec![g * c0 * s1], vec![g * s0]])
    });
    let options = PopulationOptions {
        evaluations: 20_000,
        ..PopulationOptions::default()
    };
    let mut front = nsga2(&mut problem, &[0.5; 7], &options, &mut silent).unwrap();
    refine(
        &mut problem,
        &mut front,
        &SqpOptions::default(),
        &mut silent,
    );
    let points: Vec<Vec<f64>> = front
        .points
        .iter()
        .map(|p| p.evaluation.objectives.clone())
        .collect();
    for p in &points {
        assert!(
            (p.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-5,
            "{p:?}"
        );
    }
    let got = hypervolume(&points, &[1.1; 3]);
    let whole = 1.331 - std::f64::consts::PI / 6.0;
    assert!(got > whole - 0.12 && got < whole, "{got} of {whole}");
}
