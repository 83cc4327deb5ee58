//! What a caller of the library pays: a dragged pose beside one from scratch, a row of a sweep, a parameter set, a design of
//! many: `cargo bench -p kempe`. The ratios count; the nanoseconds depend on the machine.
//!
//! Every measurement is repeated in turn with the others of its mechanism, and the fastest repeat counts.

use std::hint::black_box;
use std::time::Instant;

use kempe::{Designs, Model, Session, linspace};

const REPEATS: usize = 15;
const ROWS: usize = 200;
const DESIGNS: usize = 1000;

/// The shortest time of all repeats, s.
fn fastest(best: &mut f64, work: impl FnOnce()) {
    let clock = Instant::now();
    work();
    *best = best.min(clock.elapsed().as_secs_f64());
}

fn main() {
    let cases = [
        ("crank-rocker", None),
        ("tractor-hitch", Some("force(lift)")),
        ("door-lock", Some("torque(lock)")),
    ];
    println!("per call, microseconds; ratios to a dragged pose");
    for (file, force) in cases {
        let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/seeds/");
        let model = Model::from_path(format!("{root}{file}.toml")).expect("an example");
        let compiled = model.compile().expect("it moves");
        let drive = compiled.drives().next().expect("a drive").to_owned();
        let measure = format!("x({})", compiled.points().last().expect("a point"));
        let mut s: Session = compiled.session();
        let (low, high) = s.motion().expect("a motion").reached;
        let places = linspace(low, high, ROWS);
        let [mut near, mut whole, mut row, mut loaded, mut many] = [f64::INFINITY; 5];
        for _ in 0..REPEATS {
            let start = s.start().expect("a start");
            fastest(&mut near, || {
                for place in &places {
                    black_box(s.pose_near(&start, &drive, *place).expect("a pose"));
                }
            });
            fastest(&mut whole, || {
                let mut fresh = compiled.session();
                black_box(fresh.pose([(drive.as_str(), high)]).expect("a pose"));
            });
            fastest(&mut row, || {
                black_box(s.sweep(&drive, &places, [&measure]).expect("rows"));
            });
            if let Some(force) = force {
                fastest(&mut loaded, || {
                    black_box(s.sweep(&drive, &places, [force]).expect("rows"));
                });
            }
            if let Some(name) = compiled.parameters().next() {
                let column = vec![s.value(name).expect("a parameter"); DESIGNS];
                let designs = Designs::from_columns([(name, column)]).expect("designs");
                fastest(&mut many, || {
                    black_box(s.many(&designs, [high], [&measure]).expect("values"));
                });
            }
        }
        let near = near / ROWS as f64;
        let line = |what: &str, seconds: f64| {
            if seconds.is_finite() {
                println!(
                    "{file:14} {what:26} {:10.3} {:9.2}",
                    1e6 * seconds,
                    seconds / near
                );
            }
        };
        line("pose_near", near);
        line("pose from scratch", whole);
        line("row of a sweep", row / ROWS as f64);
        line("row with its forces", loaded / ROWS as f64);
        line("design of many, in lanes", many / DESIGNS as f64);
    }
}
