//! Times of synthesis problems, the fastest of some repeats: `cargo bench -p kempe-synthesis`.
//!
//! Aims: all dyads of five poses in 20 us, the curves of 1000 problems of four poses in 50 ms, nine points complete and proved in 0.5 s on two cores.

#[path = "../tests/support/mod.rs"]
mod support;

use std::hint::black_box;
use std::ops::ControlFlow;
use std::time::Instant;

use kempe_number::Random;
use kempe_synthesis::{
    BurmesterCurve, C, CurveDrawing, DialZeros, Pose, PrecisionPoint, dyads, four_bars_through,
    functions, paths_with_ground_pivots, timed_paths,
};
use support::RandomFourBar;

/// Problems of each kind, and repeats of which the fastest counts.
const PROBLEMS: usize = 1000;
const REPEATS: usize = 10;
/// Problems of poses and points.
const THROUGH: usize = 20;

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
    let five = fastest(|| {
        for poses in &problems {
            black_box(dyads(black_box(poses), &[]).ok());
        }
    });
    println!("five poses, all dyads      {:8.2} us", five * each);
    let mut points = 0;
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
        through(given, &mut random);
    }
}

/// Problems of poses and points, each solved once: their mean and their slowest.
fn through(given: usize, random: &mut Random) {
    let points = if given == 0 { 9 } else { 10 - 2 * given };
    let (mut count, mut complete, mut real, mut certified) = (0, 0, 0, 0);
    let (mut sum, mut slowest) = (0.0, 0.0_f64);
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
}
