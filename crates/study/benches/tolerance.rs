//! Time of a tolerance study beside a loop written by hand for its mechanism, in the same run: `cargo bench -p kempe-study`. A four-bar's
//! coupler point and its rocker's swing over 360 steps of the crank, for 1000 pieces: what the pieces take, what the whole study takes, and
//! what the same numbers take by hand on one thread; and the whole study of a million pieces, once. The ratios count; the milliseconds depend on the
//! machine.

use std::hint::black_box;
use std::time::Instant;

use kempe_batch::{Executor, Serial, Threads};
use kempe_model::Model;
use kempe_number::{Random, math};
use kempe_study::{Silent, run_with};

/// Repeats, of which the fastest counts.
const REPEATS: usize = 15;
const PIECES: usize = 1000;
/// Pieces in addition that tell what pieces alone take.
const MORE: usize = 20 * PIECES;
const MANY: usize = 1000 * PIECES;

fn model(column: &str, samples: usize) -> Model {
    let text = format!(
        "units = {{ length = \"mm\", angle = \"deg\" }}\n[parameters]\na = \"20 mm\"\nb = \"50 mm\"\nc = \"40 mm\"\nd = \"60 mm\"\n\
         [links]\nframe = {{ A = [0, 0], D = [\"d\", 0] }}\ncrank = {{ A-B = \"a\" }}\ncoupler = {{ B-C = \"b\", P = [25, 0] }}\nrocker = {{ D-C = \"c\" }}\n\
         [drives]\nmotor = {{ turns = \"crank\", from = 0, to = 360, speed = \"1 rad/s\" }}\n[assembly]\nC = \"left of B -> D\"\n\
         [studies.turn]\nkind = \"motion\"\nstep = 1\ncolumns = [\"x(P)\"]\n\
         [studies.pieces]\nkind = \"tolerance\"\nover = \"turn\"\nsamples = {samples}\n\
         vary = {{ a = \"0.1 mm\", b = \"0.1 mm\", c = \"0.1 mm\", d = {{ normal = \"0.05 mm\" }} }}\ncolumns = [\"{column}\"]\n"
    );
    let read = Model::from_toml(&text, "four-bar", &mut |_| Err(String::new()));
    read.expect("a model").model
}

/// Milliseconds of the fastest repeat.
fn fastest(mut work: impl FnMut()) -> f64 {
    let times = (0..REPEATS).map(|_| {
        let start = Instant::now();
        work();
        start.elapsed().as_secs_f64() * 1e3
    });
    times.fold(f64::INFINITY, f64::min)
}

fn study(column: &str, samples: usize, executor: &dyn Executor) -> f64 {
    let model = model(column, samples);
    fastest(|| {
        let result = run_with(&model, &model.studies[1], executor, &mut Silent);
        black_box(result.expect("a result"));
    })
}

/// The least and the greatest height of P, or the swing of the rocker, of pieces drawn at random: plain numbers, one after the other.
fn by_hand(angles: bool) -> f64 {
    let turns: Vec<(f64, f64)> = (0..=360)
        .map(|k| math::sin_cos(f64::from(k) * std::f64::consts::PI / 180.0))
        .collect();
    let mut random = Random(1);
    let pieces: Vec<[f64; 4]> = (0..PIECES)
        .map(|_| [20.0, 50.0, 40.0, 60.0].map(|x| x + 0.2 * (random.uniform() - 0.5)))
        .collect();
    fastest(|| {
        let mut sum = 0.0;
        for [a, b, c, d] in black_box(&pieces) {
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            for (sin, cos) in &turns {
                let (x, y) = (a * cos, a * sin);
                let (u, v) = (d - x, -y);
                let square = u * u + v * v;
                let along = (square + b * b - c * c) / (2.0 * square);
                let height = (b * b / square - along * along).sqrt();
                let (p, q) = (along * u - height * v, along * v + height * u);
                let value = match angles {
                    true => math::atan2(y + q, x + p - d),
                    false => y + 0.5 * q,
                };
                low = value.min(low);
                high = value.max(high);
            }
            sum += high - low;
        }
        black_box(sum);
    })
}

fn main() {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    println!("{PIECES} pieces of a four-bar at 361 places, ms (one thread; {threads} threads)");
    for (column, angles) in [("range(y(P))", false), ("range(angle(rocker))", true)] {
        let hand = by_hand(angles);
        let own = |executor: &dyn Executor| {
            let (whole, more) = (
                study(column, PIECES, executor),
                study(column, PIECES + MORE, executor),
            );
            (whole, (more - whole) * PIECES as f64 / MORE as f64)
        };
        let ((whole, pieces), (whole_on, pieces_on)) = (own(&Serial), own(&Threads(threads)));
        println!("{column}");
        println!("  by hand               {hand:7.2}");
        println!(
            "  pieces                {pieces:7.2} {pieces_on:7.2}   {:.2} times by hand",
            pieces / hand
        );
        println!("  with all that is told {whole:7.2} {whole_on:7.2}");
    }
    println!("{MANY} pieces, the whole study, s (one thread; {threads} threads)");
    for column in ["range(y(P))", "range(angle(rocker))"] {
        let model = model(column, MANY);
        let once = |executor: &dyn Executor| {
            let start = Instant::now();
            let result = run_with(&model, &model.studies[1], executor, &mut Silent);
            black_box(result.expect("a result"));
            start.elapsed().as_secs_f64()
        };
        let (alone, shared) = (once(&Serial), once(&Threads(threads)));
        println!("  {column:21} {alone:7.2} {shared:7.2}");
    }
}
