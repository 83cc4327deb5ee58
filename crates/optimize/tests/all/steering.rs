//! The steering four-bar that a cylinder turns: the least largest force ratio over a window of turning. The values beside are
//! those of differential evolution and SLSQP in Python, which agreed.

use kempe_number::{Dual, Number};
use kempe_optimize::{
    Alone, DifferentialEvolutionOptions, Evaluation, MultiStartOptions, Optimum, Piece, Problem,
    Slopes, SqpOptions, differential_evolution, multi_start, silent,
};

/// Output crank, m.
const CRANK: f64 = 0.16;
/// Places of the window that are looked at.
const PLACES: usize = 120;

/// Push rod, arm, distance of frame pivots, place of the cylinder, and where in the rotation the window begins.
type Design<T> = [T; 6];

struct Steering {
    bounds: Vec<[f64; 2]>,
    window: f64,
}

impl Steering {
    fn new(window_degrees: f64) -> Self {
        let lengths = [0.1, 1.0];
        Self {
            bounds: vec![
                [CRANK, 1.0],
                [CRANK, 1.0],
                [CRANK, 1.0],
                lengths,
                lengths,
                [0.0, 1.0],
            ],
            window: window_degrees.to_radians(),
        }
    }

    /// Cosines at both dead points: of the direction of the crank, of the angle at B.
    fn cosines<T: Number>([rod, arm, base, ..]: Design<T>) -> [T; 4] {
        let (long, short) = (rod + CRANK, rod - CRANK);
        let angle =
            |a: T, b: T, opposite: T| (a.square() + b.square() - opposite.square()) / (a * b * 2.0);
        [
            angle(base, long, arm),
            angle(base, short, arm),
            angle(arm, long, base),
            angle(arm, short, base),
        ]
    }

    /// Constraints: rotation, both angles at B, B from D, and four lengths against each other.
    fn constraints<T: Number>(&self, design: Design<T>) -> (T, T, Vec<T>) {
        let [rod, arm, base, ..] = design;
        let [first, second, one, two] = Self::cosines(design).map(acos);
        let rotation = second + std::f64::consts::PI - first;
        let least = 40_f64.to_radians();
        let rows = vec![
            -rotation + self.window.max(200_f64.to_radians()),
            -one + least,
            -two + least,
            arm - rod - base + CRANK,
            rod - arm - base + CRANK,
            rod - arm,
            base - arm,
        ];
        (first, rotation, rows)
    }

    /// One over K at a part of the window, and how long the cylinder is.
    fn ratio<T: Number>(&self, design: Design<T>, first: T, rotation: T, part: f64) -> [T; 3] {
        let [rod, arm, base, x, y, offset] = design;
        let angle = first + (rotation - self.window) * offset + self.window * part;
        let (s, c) = angle.sin_cos();
        let a = [c * CRANK, s * CRANK];
        // B is left of the way from A to C.
        let way = [base - a[0], -a[1]];
        let square = way[0].square() + way[1].square();
        let along = (rod.square() - arm.square() + square) / (square * 2.0);
        let across = (rod.square() / square - along.square()).sqrt();
        let b = [
            a[0] + way[0] * along - way[1] * across,
            a[1] + way[1] * along + way[0] * across,
        ];
        let cross = |p: [T; 2], q: [T; 2]| p[0] * q[1] - p[1] * q[0];
        let less = |p: [T; 2], q: [T; 2]| [p[0] - q[0], p[1] - q[1]];
        let pivot = [base, T::zero()];
        let cylinder = less(b, [x, y]);
        let length = (cylinder[0].square() + cylinder[1].square()).sqrt();
        let abc = cross(less(b, a), less(pivot, a)).abs();
        let bcd = cross(less(b, pivot), less([x, y], pivot));
        let aob = cross(a, b).abs();
        [abc * length / (bcd.abs() * aob), length, bcd]
    }

    /// Ratios, lengths of the cylinder and its lever all over the window; `None` where there is no such linkage.
    fn places(&self, design: Design<f64>) -> Result<[Vec<f64>; 3], f64> {
        let cosines = Self::cosines(design);
        let beyond = cosines.iter().fold(-1.0_f64, |m, c| m.max(c.abs() - 1.0));
        if !(beyond <= -1e-9) {
            let [rod, ..] = design;
            let beyond = if beyond.is_finite() {
                beyond
            } else {
                10.0 + (CRANK - rod)
            };
            return Err(beyond.max(1e-9));
        }
        let (first, rotation, _) = self.constraints(design);
        if rotation <= self.window {
            return Err(self.window - rotation + 1e-6);
        }
        let mut all = [Vec::new(), Vec::new(), Vec::new()];
        for k in 0..=PLACES {
            let [ratio, length, lever] =
                self.ratio(design, first, rotation, k as f64 / PLACES as f64);
            all[0].push(ratio);
            all[1].push(length);
            all[2].push(lever);
        }
        // Where the cylinder points at C, the ratio is infinite.
        let against = |sign: f64| {
            all[2]
                .iter()
                .map(|l| (sign * l).max(0.0))
                .fold(0.0, f64::max)
        };
        let turned = against(1.0).min(against(-1.0));
        let sound = all[0].iter().all(|x| x.is_finite());
        if turned > 0.0 || !sound {
            Err(1e-3 + turned)
        } else {
            Ok(all)
        }
    }

    fn local_peaks(values: &[f64]) -> Vec<usize> {
        let last = values.len() - 1;
        let peak = |k: &usize| {
            (*k == 0 || values[k - 1] <= values[*k]) && (*k == last || values[k + 1] < values[*k])
        };
        (0..=last).filter(peak).collect()
    }
}

fn acos<T: Number>(cosine: T) -> T {
    (-cosine.square() + 1.0).sqrt().atan2(cosine)
}

impl Problem for Steering {
    fn bounds(&self) -> &[[f64; 2]] {
        &self.bounds
    }

    fn constraints(&self) -> usize {
        8
    }

    fn evaluate(&self, design: &[f64]) -> Evaluation {
        let design: Design<f64> = std::array::from_fn(|k| design[k]);
        match self.places(design) {
            Err(lack) => Evaluation::lacking(lack),
            Ok([ratios, lengths, _]) => {
                let mut constraints = self.constraints(design).2;
                constraints.push(0.02 - lengths.iter().copied().fold(f64::INFINITY, f64::min));
                Evaluation {
                    objectives: vec![ratios.iter().copied().fold(0.0, f64::max)],
                    constraints,
                    lack: 0.0,
                }
            }
        }
    }

    fn slopes(&self, design: &[f64]) -> Option<Slopes> {
        let [ratios, lengths, _] = self.places(std::array::from_fn(|k| design[k])).ok()?;
        let design: Design<Dual<f64, 6>> = std::array::from_fn(|k| Dual::variable(design[k], k));
        let (first, rotation, rows) = self.constraints(design);
        let piece = |d: Dual<f64, 6>| Piece {
            value: d.re,
            slope: d.eps.to_vec(),
        };
        let at = |k: usize| self.ratio(design, first, rotation, k as f64 / PLACES as f64);
        let peaks = Self::local_peaks(&ratios)
            .into_iter()
            .map(|k| piece(at(k)[0]))
            .collect();
        let shortest: Vec<f64> = lengths.iter().map(|l| -l).collect();
        let shortest = Self::local_peaks(&shortest)
            .into_iter()
            .map(|k| piece(-at(k)[1] + 0.02))
            .collect();
        let mut constraints: Vec<Vec<Piece>> =
            rows.into_iter().map(|row| vec![piece(row)]).collect();
        constraints.push(shortest);
        Some(Slopes {
            objectives: vec![peaks],
            constraints,
        })
    }
}

/// Windows in degrees, the least ratios that were known, and those found here with the cylinder at its least length.
const KNOWN: [(f64, f64, f64); 4] = [
    (200.0, 22.654_273_20, 22.625_178_95),
    (195.0, 20.496_915_88, 20.400_617_45),
    (190.0, 18.655_492_48, 18.518_557_53),
    (180.0, 15.695_725_21, 15.528_671_89),
];

#[test]
fn the_ratio_is_that_of_the_areas() {
    let problem = Steering::new(1.0);
    let design: Design<f64> = [0.45, 0.6, 0.5, 0.3, 0.9, 0.0];
    let (_, rotation, _) = problem.constraints(design);
    let [ratio, ..] = problem.ratio(design, 150_f64.to_radians(), rotation, 0.0);
    assert!((ratio - 6.708_970_457).abs() < 1e-8, "{ratio}");
}

#[test]
fn steps_from_many_starts_reach_the_least_ratio() {
    for (window, wanted, shortest) in KNOWN {
        let problem = Steering::new(window);
        let options = MultiStartOptions {
            samples: Some(4000),
            starts: 40,
            ..MultiStartOptions::default()
        };
        let found = multi_start(&problem, &options, &Alone, &mut silent);
        for (o, times) in &found.optima {
            println!(
                "{window}: {:.8} ({wanted}) x{times} residual {:.1e} violation {:.1e} steps {} evaluations {} {:?} {:?}",
                o.objective(),
                o.residual,
                o.violation,
                o.iterations,
                o.evaluations,
                o.ended,
                o.design
            );
        }
        println!(
            "{window}: all evaluations {} starts {}",
            found.evaluations, found.starts
        );
        let known = |o: &&Optimum| (o.objective() / wanted - 1.0).abs() < 1e-5;
        let optima: Vec<&Optimum> = found.optima.iter().map(|(o, _)| o).collect();
        let Some(known) = optima.iter().copied().find(known) else {
            panic!("{window}: {}", optima[0].objective());
        };
        assert!(known.ended.is_optimal());
        // Both angles at B and the height of the cylinder's pivot limit it.
        assert!(
            known.multipliers.cost(1) > 0.0
                && known.multipliers.cost(2) > 0.0
                && known.multipliers.bounds[4][1] > 0.0
        );
        // What is better yet is a cylinder that becomes as short as it may, which nobody builds.
        assert!((optima[0].objective() / shortest - 1.0).abs() < 1e-6);
        assert!(optima[0].multipliers.cost(7) > 0.0);
    }
}

#[test]
fn evolution_reaches_the_least_ratio() {
    for (window, wanted, _) in KNOWN {
        let problem = Steering::new(window);
        for polish in [None, Some(SqpOptions::default())] {
            let polished = polish.is_some();
            let evaluations = if polished { 6_000 } else { 40_000 };
            let options = DifferentialEvolutionOptions {
                evaluations,
                polish,
                ..DifferentialEvolutionOptions::default()
            };
            let found = differential_evolution(&problem, &options, &Alone, &mut silent);
            println!(
                "{window}: {:?} ({wanted}) polished {polished} evaluations {}",
                found.standing, found.evaluations
            );
            let best = found.best.expect("a design").evaluation.largest();
            assert!((best / wanted - 1.0).abs() < 1e-5, "{window}: {best}");
        }
    }
}
