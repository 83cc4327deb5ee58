//! Positions and forces of the level-luffing crane for many lengths of its tie rod, per second and thread: `cargo bench -p kempe --bench sweep`.
//!
//! The study of `kind = "sweep"` gives whole rows with the evidence of each, numbers over the motion besides; the library's `many` gives what is
//! asked for in vector lanes. Beside them the same poses by dyads written by hand. The ratios count.

use std::hint::black_box;
use std::time::Instant;

use kempe::batch::{Executor, Serial, Threads};
use kempe::model::Diagnostic;
use kempe::number::math;
use kempe::study::{Parts, Silent, run_in_parts};
use kempe::{Designs, Model, linspace};

const REPEATS: usize = 7;
const DESIGNS: usize = 128;

/// Keeps nothing and wants all rows.
struct Rows;

impl Parts for Rows {
    fn kept(&mut self, _: usize) -> Result<Option<Vec<u8>>, Box<Diagnostic>> {
        Ok(None)
    }

    fn keep(&mut self, _: usize, part: Vec<u8>) -> Result<(), Box<Diagnostic>> {
        black_box(part);
        Ok(())
    }
}

/// The fastest of all repeats, s.
fn fastest(mut work: impl FnMut()) -> f64 {
    let times = (0..REPEATS).map(|_| {
        let clock = Instant::now();
        work();
        clock.elapsed().as_secs_f64()
    });
    times.fold(f64::INFINITY, f64::min)
}

/// The crane's file with a sweep of its tie rod over one of its studies, in as many rows.
fn text(over: &str) -> String {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/seeds/");
    let own = std::fs::read_to_string(format!("{root}luffing-crane.toml")).expect("an example");
    format!(
        "{own}\n[studies.many]\nkind = \"sweep\"\nover = \"{over}\"\nvary = {{ l3 = {{ from = \"19.46 m\", to = \"19.86 m\", count = {DESIGNS} }} }}\n\
         columns = [\"drop\"]\nplot = [\"y_e\"]\n"
    )
}

/// Rows a second of the study.
fn study(over: &str, executor: &dyn Executor) -> f64 {
    let model: Model = text(over).parse().expect("a model");
    let model = model.data();
    let study = model.studies.last().expect("the sweep");
    let own = model.studies.iter().find(|it| it.name == over);
    let rows = kempe::study::run(model, own.expect("its study"), &mut Silent);
    let rows = rows.expect("rows").table.rows() * DESIGNS;
    let time = fastest(|| {
        let found = run_in_parts(model, study, (executor, &mut Rows), &mut Silent);
        black_box(found.expect("a result"));
    });
    rows as f64 / time
}

/// Values a second of the library's lanes, or of forces.
fn many(measure: &str) -> f64 {
    let model: Model = text("luffing").parse().expect("a model");
    let mut session = model.compile().expect("it moves").session();
    let rods = linspace(19.46, 19.86, DESIGNS);
    let designs = Designs::from_columns([("l3", rods)]).expect("designs");
    let (low, high) = session.motion().expect("a motion").reached;
    let places = linspace(low, high, 310);
    let time = fastest(|| {
        black_box(session.many(&designs, &places, [measure]).expect("values"));
    });
    (DESIGNS * places.len()) as f64 / time
}

/// Heights of the sheave a second, by the dyad of tie rod and arms.
fn by_hand() -> f64 {
    let rods = linspace(19.46, 19.86, DESIGNS);
    let angles = linspace(37.86_f64.to_radians(), 68.75_f64.to_radians(), 310);
    let turns: Vec<(f64, f64)> = angles.iter().map(|a| math::sin_cos(*a)).collect();
    let (jib, rear, front) = (20.0, 3.97, 9.64);
    let (sin, cos) = math::sin_cos(159.33_f64.to_radians());
    let time = fastest(|| {
        let mut sum = 0.0;
        for rod in black_box(&rods) {
            for (s, c) in &turns {
                let (x, y) = (jib * c, jib * s);
                let (u, v) = (-6.0 - x, 8.71 - y);
                let square = u * u + v * v;
                let along = (square + rear * rear - rod * rod) / (2.0 * square);
                let height = (rear * rear / square - along * along).sqrt();
                // From D to B, right of the line from D to C; then turned back by the angle between the arms.
                let (p, q) = (along * u + height * v, along * v - height * u);
                sum += y + front / rear * (q * cos - p * sin);
            }
        }
        black_box(sum);
    });
    (DESIGNS * turns.len()) as f64 / time
}

fn main() {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    println!(
        "the crane with {DESIGNS} tie rods, thousands a second (one thread; {threads} threads)"
    );
    let line = |what: &str, one: f64, all: Option<f64>| {
        let all = all.map_or(String::new(), |all| format!("{:9.0}", all / 1e3));
        println!("  {what:44} {:9.0} {all}", one / 1e3);
    };
    for (what, over) in [("positions", "luffing"), ("positions with forces", "loads")] {
        let (one, all) = (study(over, &Serial), study(over, &Threads(threads)));
        line(&format!("{what}, rows of the study"), one, Some(all));
    }
    line("positions, lanes of the library", many("y(E)"), None);
    line("torques, the library", many("torque(luff)"), None);
    line("positions, by hand", by_hand(), None);
}
