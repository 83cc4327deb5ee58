//! Times of synthesis problems, the fastest of some repeats: `cargo bench -p kempe-synthesis`. Some of them stand beside other programs
//! (`cargo xtask peers`): these find the problems in `synthesis-problems.txt` of cargo's folder for benchmarks, and our runs in `synthesis.csv`.
//!
//! Aims: all dyads of five poses in 20 us, the curves of 1000 problems of four poses in 50 ms, nine points complete and proved in 0.5 s on two cores.

#[path = "../tests/support/mod.rs"]
mod support;

use std::fmt::Write as _;
use std::hint::black_box;
use std::ops::ControlFlow;
use std::time::Instant;

use kempe_alt_burmester::{Given, Kind, StartSet};
use kempe_number::Random;
use kempe_synthesis::{
    BurmesterCurve, C, CurveDrawing, DialZeros, Dyad, FourBarsThrough, Linkage, Pose,
    PrecisionPoint, dyads, four_bars_through, functions, paths_with_ground_pivots, timed_paths,
};
use support::RandomFourBar;

/// Problems of each kind, and repeats of which the fastest counts.
const PROBLEMS: usize = 1000;
const REPEATS: usize = 10;
/// Problems of poses and points.
const THROUGH: usize = 20;
/// Of the problems of poses so many are given to other programs.
const SHARED: usize = 100;

/// What other programs are given, and our runs beside theirs.
struct Shared {
    problems: String,
    runs: String,
}

impl Shared {
    fn new(poses: &[Vec<Pose>]) -> Self {
        let mut problems = String::new();
        for poses in poses.iter().take(SHARED) {
            let numbers = poses
                .iter()
                .flat_map(|p| [p.origin.re, p.origin.im, p.angle]);
            line(&mut problems, "poses", numbers);
        }
        Self {
            problems,
            runs: "case,peer,method,error,seconds\n".to_owned(),
        }
    }

    fn run(&mut self, case: &str, method: &str, error: f64, seconds: f64) {
        let _ = writeln!(
            self.runs,
            "{case},Kempe,\"{method}\",{error:.3e},{seconds:.6e}"
        );
    }

    /// Nine points with data and solutions from which a way leads to theirs.
    fn points(&mut self, points: &[C]) {
        let Some(start) = StartSet::found(Kind::NinePoints) else {
            return;
        };
        let after: Vec<C> = points[1..].iter().map(|p| *p - points[0]).collect();
        let target = Given::real(Kind::NinePoints, &after, &[]);
        for given in [Some(start.given), target].into_iter().flatten() {
            line(
                &mut self.problems,
                "data",
                flat(given.place.iter().chain(&given.hat)),
            );
        }
        for solution in &start.solutions {
            line(&mut self.problems, "solution", flat(solution.iter()));
        }
    }

    fn keep(self) {
        let folder = env!("CARGO_TARGET_TMPDIR");
        for (name, text) in [
            ("synthesis-problems.txt", self.problems),
            ("synthesis.csv", self.runs),
        ] {
            std::fs::write(format!("{folder}/{name}"), text).expect("a file in cargo's folder");
        }
    }
}

fn flat<'a>(numbers: impl Iterator<Item = &'a C> + 'a) -> impl Iterator<Item = f64> + 'a {
    numbers.flat_map(|z| [z.re, z.im])
}

fn line(text: &mut String, what: &str, numbers: impl Iterator<Item = f64>) {
    text.push_str(what);
    for number in numbers {
        let _ = write!(text, " {number:e}");
    }
    text.push('\n');
}

/// By how much the length of a link from a fixed to a moving pivot differs between poses, in parts of it.
fn spread(poses: &[Pose], fixed: C, moving: C) -> f64 {
    let lengths = poses.iter().map(|pose| (pose.place(moving) - fixed).norm());
    let (low, high) = lengths.fold((f64::INFINITY, 0.0_f64), |(low, high), length| {
        (low.min(length), high.max(length))
    });
    (high - low) / high
}

/// The worst of all dyads of two pins.
fn worst_of_dyads(poses: &[Pose]) -> f64 {
    let found = dyads(poses, &[]).unwrap_or_default();
    let spreads = found.iter().map(|it| match it.dyad {
        Dyad::Rr { fixed, moving, .. } => spread(poses, fixed, moving),
        _ => 0.0,
    });
    spreads.fold(0.0, f64::max)
}

/// The worst of all links of four-bars through points.
fn worst_of_bars(found: &FourBarsThrough) -> f64 {
    let spreads = found.four_bars.iter().flat_map(|it| {
        let bar = match &it.path.linkage {
            Linkage::FourBar(bar) => Some(*bar),
            _ => None,
        };
        let poses = &it.path.poses;
        bar.into_iter()
            .flat_map(move |bar| [0, 1].map(|k| spread(poses, bar.fixed[k], bar.moving[k])))
    });
    spreads.fold(0.0, f64::max)
}

fn fastest(mut work: impl FnMut()) -> f64 {
    (0..REPEATS)
        .map(|_| {
            let begin = Instant::now();
            work();
            begin.elapsed().as_secs_f64()
        })
        .fold(f64::INFINITY, f64::min)
}

fn main() {
    let mut random = Random(1);
    let mut problems: Vec<Vec<Pose>> = Vec::new();
    let mut turns: Vec<Vec<f64>> = Vec::new();
    let mut pivots: Vec<[C; 2]> = Vec::new();
    while problems.len() < PROBLEMS {
        let bar = RandomFourBar::new(&mut random);
        if let Some((poses, angles)) = bar.poses(&mut random, 5, 0.3) {
            problems.push(poses);
            turns.push(angles);
            pivots.push(bar.fixed);
        }
    }
    let each = 1e6 / PROBLEMS as f64;
    let mut shared = Shared::new(&problems);
    let five = fastest(|| {
        for poses in &problems {
            black_box(dyads(black_box(poses), &[]).ok());
        }
    });
    println!("five poses, all dyads      {:8.2} us", five * each);
    let off = problems.iter().take(SHARED).map(|p| worst_of_dyads(p));
    let off = off.fold(0.0, f64::max);
    shared.run("five poses", "two conics", off, five / PROBLEMS as f64);
    let mut points = 0;
    let mut off = 0.0_f64;
    let curves = fastest(|| {
        points = 0;
        for poses in &problems {
            let four = [poses[0], poses[1], poses[2], poses[3]];
            let Ok(curve) = BurmesterCurve::new(black_box(&four)) else {
                continue;
            };
            let drawn = curve.drawn(CurveDrawing::default());
            points += drawn.iter().map(|p| p.points.len()).sum::<usize>();
            black_box(drawn);
        }
    });
    for poses in problems.iter().take(SHARED) {
        let four = [poses[0], poses[1], poses[2], poses[3]];
        let drawn = BurmesterCurve::new(&four).map(|curve| curve.drawn(CurveDrawing::default()));
        let pivots = drawn.iter().flatten().flat_map(|piece| &piece.points);
        off = pivots.fold(off, |off, it| off.max(spread(&four, it.fixed, it.moving)));
    }
    let method = format!("{} points by need", points / PROBLEMS);
    shared.run("four-pose curves", &method, off, curves / PROBLEMS as f64);
    println!(
        "four poses, both curves    {:8.2} us, {} points",
        curves * each,
        points / PROBLEMS
    );

    let pairs: Vec<Vec<PrecisionPoint>> = (problems.iter().zip(&turns))
        .map(|(poses, angles)| {
            (poses.iter().zip(angles))
                .map(|(pose, angle)| PrecisionPoint::new(*angle, pose.angle))
                .collect()
        })
        .collect();
    let five = fastest(|| {
        for pairs in &pairs {
            black_box(functions(black_box(pairs), DialZeros::default()).ok());
        }
    });
    println!("five pairs, all four-bars  {:8.2} us", five * each);

    let points: Vec<Vec<C>> = (problems.iter())
        .map(|poses| poses.iter().map(|p| p.origin).collect())
        .collect();
    let timed = fastest(|| {
        for (points, turns) in points.iter().zip(&turns) {
            black_box(timed_paths(black_box(points), turns, &[], &[]).ok());
        }
    });
    println!("five timed points          {:8.2} us", timed * each);

    let count = 20;
    let led = fastest(|| {
        for (points, pivots) in points.iter().zip(&pivots).take(count) {
            black_box(paths_with_ground_pivots(black_box(points), *pivots, None).ok());
        }
    });
    println!(
        "five points, both pivots   {:8.2} ms",
        led * 1e3 / count as f64
    );

    for given in 0..=4 {
        through(given, &mut random, &mut shared);
    }
    shared.keep();
}

/// Problems of poses and points, each solved once: their mean and their slowest.
fn through(given: usize, random: &mut Random, shared: &mut Shared) {
    let points = if given == 0 { 9 } else { 10 - 2 * given };
    let (mut count, mut complete, mut real, mut certified) = (0, 0, 0, 0);
    let (mut sum, mut slowest, mut off) = (0.0, 0.0_f64, 0.0_f64);
    while count < THROUGH {
        let bar = RandomFourBar::new(random);
        let Some((all, _)) = bar.poses(random, given + points, 0.15) else {
            continue;
        };
        let (poses, rest) = all.split_at(given);
        let points: Vec<C> = rest.iter().map(|p| p.origin).collect();
        let go_on = |_, _| ControlFlow::Continue(());
        let begin = Instant::now();
        let found = four_bars_through(black_box(poses), &points, &go_on);
        let took = begin.elapsed().as_secs_f64();
        count += 1;
        let Ok(found) = found else { continue };
        off = off.max(worst_of_bars(&found));
        if given == 0 && count == 1 {
            shared.points(&points);
        }
        (sum, slowest) = (sum + took, slowest.max(took));
        complete += usize::from(found.finite == found.generic);
        real += found.four_bars.len();
        certified += found.four_bars.iter().filter(|f| f.certified).count();
    }
    println!(
        "{given} poses, {points} points        {:8.2} ms, slowest {:.2} ms; {complete} of {count} complete, {certified} of {real} real ones certified",
        sum * 1e3 / count as f64,
        slowest * 1e3
    );
    if given == 0 {
        let method = "1442 paths, real ones proved";
        shared.run("nine points", method, off, sum / count as f64);
    }
}
