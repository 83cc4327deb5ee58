//! What exact derivatives are worth to an optimisation, and what threads are: `cargo bench -p kempe-study --bench optimize`. The crane's drop and the
//! steering linkage's force, downhill from the file's own design: designs tried and time to the optimum, with exact derivatives over all peaks, and with
//! central differences of the goal and the limits; and a four-bar whose goal and limit have neither peaks nor corners, of which both find the same optimum.
//! Then by methods that look all over, on one thread and on all, and with every design asked alone, where
//! otherwise many are compared in lanes. The ratios count; the milliseconds depend on the machine.

use std::time::Instant;

use kempe_batch::{Executor, Serial, Threads};
use kempe_model::{Model, Study};
use kempe_study::{Otherwise, Silent, StudyResult, optimum_otherwise, run_with};

/// Repeats, of which the fastest counts.
const REPEATS: usize = 3;

/// A four-bar whose coupler point goes far along and little aside: all of it numbers of poses.
const FOUR_BAR: &str = r#"
[parameters]
a = "20 mm"
b = "50 mm"
c = "40 mm"
px = "25 mm"
py = "10 mm"
[links]
frame   = { A = [0, 0], D = ["60 mm", 0] }
crank   = { A-B = "a" }
coupler = { B-C = "b", P = ["px", "py"] }
rocker  = { D-C = "c" }
[drives]
motor = { turns = "crank", from = "0 deg", to = "360 deg", speed = "60 rpm" }
[assembly]
C = "left of B -> D"
[measures]
height = "range(y(P))"
[studies.turn]
kind = "motion"
[studies.best]
kind = "optimize"
method = "local"
over = "turn"
vary = { a = ["10 mm", "30 mm"], b = ["40 mm", "80 mm"], c = ["30 mm", "70 mm"], px = ["-20 mm", "60 mm"], py = ["-40 mm", "40 mm"] }
minimize = "height"
subject_to = ["range(x(P)) >= 40 mm", "transmission_angle(C) >= 40 deg"]
"#;

/// The same going along a line as nearly as it can, on the average: nothing of it is a peak.
fn smooth() -> String {
    FOUR_BAR
        .replace(
            "height = \"range(y(P))\"",
            "miss = \"mean((y(P) / (1 mm) - 20)^2)\"\nalong = \"at(x(P), motor, 0 deg) - at(x(P), motor, 180 deg)\"",
        )
        .replace("minimize = \"height\"", "minimize = \"miss\"")
        .replace(
            "[\"range(x(P)) >= 40 mm\", \"transmission_angle(C) >= 40 deg\"]",
            "\"along >= 40 mm\"",
        )
}

fn model(file: &str, change: &dyn Fn(String) -> String) -> Model {
    let path = format!("{}/../../examples/seeds/{file}", env!("CARGO_MANIFEST_DIR"));
    let text = change(match file {
        "four-bar" => FOUR_BAR.to_owned(),
        "four-bar, smooth" => smooth(),
        _ => std::fs::read_to_string(path).expect("a file"),
    });
    let read = Model::from_toml(&text, file, &mut |_| Err(String::new()));
    read.expect("a model").model
}

fn study<'m>(model: &'m Model, name: &str) -> &'m Study {
    let mut all = model.studies.iter();
    all.find(|study| study.name == name).expect("a study")
}

fn number(result: &StudyResult, name: &str) -> f64 {
    let mut all = result.scalars.iter();
    all.find(|it| it.name == name)
        .map_or(f64::NAN, |it| it.value)
}

/// The result, and milliseconds of the fastest repeat.
fn fastest(repeats: usize, work: impl Fn() -> StudyResult) -> (StudyResult, f64) {
    let start = Instant::now();
    let mut result = work();
    let mut time = start.elapsed().as_secs_f64() * 1e3;
    for _ in 1..repeats {
        let start = Instant::now();
        result = work();
        time = time.min(start.elapsed().as_secs_f64() * 1e3);
    }
    (result, time)
}

fn told(what: &str, goal: &str, (result, time): (StudyResult, f64)) {
    println!(
        "  {what:28} {goal} {:.9}  residual {:8.1e}  designs {:6}  derivatives {:4}  {time:9.1} ms",
        number(&result, goal),
        number(&result, "first-order residual"),
        number(&result, "designs tried"),
        number(&result, "derivatives taken"),
    );
}

fn main() {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let cases = [
        ("luffing-crane.toml", "level", "drop"),
        ("steering-optimum.toml", "best", "peak"),
        ("four-bar", "best", "height"),
    ];
    println!("downhill from the file's own design, one thread");
    let smooth = ("four-bar, smooth", "best", "miss");
    for (file, name, goal) in cases.into_iter().chain([smooth]) {
        let model = model(file, &|text| text);
        let study = study(&model, name);
        println!("{file}");
        told(
            "exact derivatives, all peaks",
            goal,
            fastest(REPEATS, || {
                run_with(&model, study, &Serial, &mut Silent).expect("a result")
            }),
        );
        told(
            "differences",
            goal,
            fastest(1, || {
                optimum_otherwise(&model, study, Otherwise::Differences, &Serial).expect("a result")
            }),
        );
    }
    println!("all over the box: one thread, then {threads}");
    for (file, name, goal) in cases {
        println!("{file}");
        for method in ["multi-start", "differential evolution", "cma-es"] {
            let method_of = |text: String| {
                let (head, tail) = text
                    .split_once(&format!("[studies.{name}]"))
                    .expect("a study");
                let of = format!("method = \"{method}\"\ndesigns = 1500\n");
                let at = tail.find("kind").expect("a kind");
                format!(
                    "{head}[studies.{name}]\n{of}{}",
                    &tail[at..].replacen("method", "# method", 1)
                )
            };
            let model = model(file, &method_of);
            let study = study(&model, name);
            let with = |executor: &dyn Executor| {
                fastest(1, || {
                    run_with(&model, study, executor, &mut Silent).expect("a result")
                })
            };
            told(method, goal, with(&Serial));
            told("", goal, with(&Threads(threads)));
            let alone = || optimum_otherwise(&model, study, Otherwise::Alone, &Serial);
            told(
                "  every design alone",
                goal,
                fastest(1, || alone().expect("a result")),
            );
        }
    }
}
