//! Standard problems of optimisation, their designs asked and their times: `cargo bench -p kempe-optimize`. `cargo xtask peers optimize` sets other programs
//! beside them, which find our runs in `optimize.csv` of cargo's folder for benchmarks. Descents with exact derivatives on problems of Hock and Schittkowski,
//! from the published starts: the error is that of the goal, or what a constraint is missed by, in parts of the goal where this is above one. Fronts of
//! two goals: the part of the analytic volume that lies under the front, before and after it is led down and filled.

#[path = "../tests/support/mod.rs"]
mod support;

use std::fmt::Write as _;
use std::path::Path;
use std::time::Instant;

use kempe_optimize::{
    Alone, Nsga2Options, RefinedFront, SqpOptions, hypervolume, nsga2, refine, silent, sqp, widen,
};
use support::Case;
use support::hock_schittkowski::{
    Known, hs1, hs2, hs5, hs21, hs24, hs35, hs38, hs43, hs71, hs76, hs100, hs113,
};
use support::zdt::{zdt1, zdt2, zdt4, zdt6};

/// Repeats, of which the fastest counts.
const REPEATS: usize = 30;
/// Points of a front.
const POINTS: usize = 100;
/// Up to here volumes are counted.
const REFERENCE: [f64; 2] = [1.1; 2];

fn descent<const N: usize>(name: &str, of: fn() -> Known<N>, runs: &mut String) {
    let mut best = f64::INFINITY;
    let mut told = None;
    for _ in 0..REPEATS {
        let known = of();
        let clock = Instant::now();
        let found = sqp(
            &known.case,
            &known.start,
            &SqpOptions::default(),
            &Alone,
            &mut silent,
        );
        best = best.min(clock.elapsed().as_secs_f64());
        told = Some((found, known.optimum));
    }
    let Some((found, optimum)) = told else {
        return;
    };
    let scale = optimum.abs().max(1.0);
    let error = ((found.objective() - optimum).abs() / scale).max(found.violation);
    let asked = found.evaluations;
    println!(
        "{name:<8} {asked:>5} designs  error {error:8.1e}  {:10.3} ms",
        1e3 * best
    );
    let _ = writeln!(
        runs,
        "{name},Kempe,\"{asked} designs\",{error:.3e},{best:.6e}"
    );
}

fn volume(front: &RefinedFront) -> f64 {
    let points = front.members.iter();
    let points: Vec<Vec<f64>> = points
        .map(|m| m.candidate.evaluation.objectives.clone())
        .collect();
    hypervolume(&points, &REFERENCE)
}

/// The volume under a front of the second goal over the first, from `from` to one, by the middles of steps in the root of the first.
fn analytic(second: fn(f64) -> f64, from: f64) -> f64 {
    let steps = 200_000;
    let step = (1.0 - from.sqrt()) / f64::from(steps);
    let parts = (0..steps).map(|k| {
        let root = from.sqrt() + step * (f64::from(k) + 0.5);
        (1.1 - second(root * root)) * 2.0 * root * step
    });
    parts.sum::<f64>() + 0.1 * (1.1 - second(1.0))
}

fn front<const N: usize>(name: &str, case: fn() -> Case<N>, designs: usize, whole: f64) {
    let case: Case<N> = case();
    let clock = Instant::now();
    let options = Nsga2Options {
        population: POINTS,
        evaluations: designs,
        ..Nsga2Options::default()
    };
    let found = nsga2(&case, &options, &Alone, &mut silent);
    let points: Vec<Vec<f64>> = (found.members.iter())
        .map(|c| c.evaluation.objectives.clone())
        .collect();
    let before = hypervolume(&points, &REFERENCE);
    let took = clock.elapsed().as_secs_f64();
    let steps = SqpOptions::default();
    let all = (&steps, usize::MAX);
    let refined = refine(&case, &found.members, all, &Alone, &mut silent);
    let more = refined.evaluations;
    let filled = widen(&case, refined.members, POINTS, all, &Alone, &mut silent);
    println!(
        "{name:<8} {:>6} designs {:.5} in {:7.1} ms; {:>6} more {:.5} in {:7.1} ms",
        found.evaluations,
        before / whole,
        1e3 * took,
        more + filled.evaluations,
        volume(&filled) / whole,
        1e3 * clock.elapsed().as_secs_f64(),
    );
}

fn main() {
    let mut runs = "case,peer,method,error,seconds\n".to_owned();
    println!("down from the published starts");
    descent("HS1", hs1, &mut runs);
    descent("HS2", hs2, &mut runs);
    descent("HS5", hs5, &mut runs);
    descent("HS21", hs21, &mut runs);
    descent("HS24", hs24, &mut runs);
    descent("HS35", hs35, &mut runs);
    descent("HS38", hs38, &mut runs);
    descent("HS43", hs43, &mut runs);
    descent("HS71", hs71, &mut runs);
    descent("HS76", hs76, &mut runs);
    descent("HS100", hs100, &mut runs);
    descent("HS113", hs113, &mut runs);
    println!("fronts: part of the analytic volume by NSGA-II, and led down and filled");
    let convex = |f: f64| 1.0 - f.sqrt();
    let hollow = |f: f64| 1.0 - f * f;
    front("ZDT1", zdt1, 15_000, analytic(convex, 0.0));
    front("ZDT2", zdt2, 15_000, analytic(hollow, 0.0));
    front("ZDT4", zdt4, 30_000, analytic(convex, 0.0));
    front("ZDT6", zdt6, 20_000, analytic(hollow, 0.280_775_318_8));
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("optimize.csv");
    if let Err(error) = std::fs::write(&file, runs) {
        println!("{}: {error}", file.display());
    }
}
