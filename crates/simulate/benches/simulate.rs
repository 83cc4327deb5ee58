//! Benchmarks of multibody dynamics in time, each with its error beside its time: `cargo bench -p kempe-simulate`. Times are those of the
//! whole call, from a model that is read to laws that are found, tracing included; the fastest of several counts. The pendulum and the
//! four-bars stand beside the same integrator on the one equation that they come to by hand. What the benchmarks come to is in
//! `known.csv`, which `peers/` reads too; runs are left for `cargo xtask peers` in `simulate.csv` of cargo's folder for benchmarks.

use std::fmt::Write as _;
use std::hint::black_box;
use std::time::{Duration, Instant};

use kempe_dynamics::ForceSampler;
use kempe_integrate::{Integrator, Tolerance};
use kempe_mechanism::{Design, Mechanism};
use kempe_model::{
    ClearanceAt, Contact, ContactStates, DriveId, Measure, Model, Released, StudyKind, value,
};
use kempe_motion::Silent;
use kempe_number::Jet;
use kempe_number::math::sin_cos;
use kempe_simulate::{Coordinates, Method, Question, Simulated, simulate};

const REPEATS: usize = 5;

/// A line for each benchmark of `examples/benchmarks`.
const KNOWN: &str = include_str!("known.csv");

/// A benchmark, with what its first drive and its rate are at the end.
struct Case {
    name: &'static str,
    until: f64,
    exact: [f64; 2],
}

/// The benchmarks of `known.csv`.
fn cases() -> Vec<Case> {
    let lines = KNOWN.lines().filter(|line| !line.starts_with('#'));
    let case = |line: &'static str| {
        let fields: Vec<&str> = line.split(',').collect();
        let [name, until, value, rate] = fields[..] else {
            panic!("{line}")
        };
        let number = |text: &str| text.parse().expect("a number");
        Case {
            name,
            until: number(until),
            exact: [number(value), number(rate)],
        }
    };
    lines.skip(1).map(case).collect()
}

/// Prints runs as they come, in the columns of the peers, and keeps them as they do.
struct Runs(String);

impl Runs {
    fn new() -> Self {
        println!(
            "{:<18} {:<38} {:>9} {:>14} {:>12} {:>9}",
            "Kempe", "method", "error", "time", "evaluations", "by hand"
        );
        Self("case,peer,method,error,seconds\n".into())
    }

    fn add(
        &mut self,
        case: &str,
        tolerance: f64,
        error: f64,
        took: Duration,
        evaluations: usize,
        beside: &str,
    ) {
        let method = format!("tolerance {tolerance:.0e}");
        println!(
            "{case:<18} {method:<38} {error:>9.1e} {:>11.3} ms {evaluations:>12} {beside:>9}",
            1e3 * took.as_secs_f64(),
        );
        let seconds = took.as_secs_f64();
        writeln!(self.0, "{case},Kempe,{method},{error:.3e},{seconds:.6e}")
            .expect("text takes text");
    }

    fn keep(self) {
        let path = concat!(env!("CARGO_TARGET_TMPDIR"), "/simulate.csv");
        std::fs::write(path, self.0).expect("a file in cargo's folder");
    }
}

fn question(model: &Model, tolerance: f64) -> (Design<f64>, Question) {
    let parameters = model.parameter_values();
    let design = Design::new(&Mechanism::new(model), &parameters);
    let study = model.studies.iter().find_map(|s| match &s.kind {
        StudyKind::Simulate(study) => Some(study),
        _ => None,
    });
    let study = study.expect("a simulation");
    let start = study.released.iter().map(|drive| {
        let at = model.drives[drive.index()].law.at(0.0, &parameters);
        let rate = study.start.iter().find(|s| s.drive == *drive);
        let rate = rate.and_then(|s| s.rate.as_ref());
        [at, rate.map_or(0.0, |rate| value(rate, &parameters))]
    });
    let question = Question {
        coordinates: Coordinates::Minimal,
        contacts: Vec::new(),
        free: study.released.clone(),
        start: start.collect(),
        until: value(&study.until, &parameters),
        tolerance,
        method: Method::Choose,
        stops: Vec::new(),
        end_when: Vec::new(),
    };
    (design, question)
}

fn best<T>(mut run: impl FnMut() -> T) -> (Duration, T) {
    let mut fastest = (Duration::MAX, None);
    for _ in 0..REPEATS {
        let clock = Instant::now();
        let found = black_box(run());
        let took = clock.elapsed();
        if took < fastest.0 {
            fastest = (took, Some(found));
        }
    }
    (fastest.0, fastest.1.expect("a run"))
}

/// The larger of the relative errors of the first drive and of its rate at the end; of an angle to whole turns, of a rate of nothing as it
/// is.
fn error(found: &Simulated, exact: [f64; 2], until: f64) -> f64 {
    let q: Jet<f64, 2> = found.laws[0].at(Jet::variable(until), &[]);
    let turn = std::f64::consts::TAU;
    let off = q.derivative(0) - exact[0];
    let off = off - (off / turn).round() * turn;
    let rate = q.derivative(1) - exact[1];
    let of = if exact[1] == 0.0 { 1.0 } else { exact[1] };
    (off / exact[0]).abs().max((rate / of).abs())
}

/// A model of `examples/benchmarks`, after a change to its text.
fn model(name: &str, change: impl Fn(String) -> String) -> Model {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/benchmarks");
    let path = format!("{folder}/{name}.toml");
    let text = change(std::fs::read_to_string(&path).expect("a benchmark"));
    let read = Model::from_toml(&text, name, &mut |_| Err("no files".into()));
    let Ok(read) = read else { panic!("{path}") };
    read.model
}

/// Andrews' squeezer at 30 ms in quadruple precision, by what a file measures: angles, their rates, and the multipliers, which are the forces
/// at E.
const SQUEEZED: [&[(&str, f64)]; 3] = [
    &[
        ("angle(k1)", 15.810_771_195_153_707),
        ("theta", -15.756_371_058_411_84),
        ("gamma", 0.040_822_240_119_645_8),
        ("phi", -0.534_730_116_342_079_6),
        ("delta", 0.524_409_965_879_954_1),
        ("omega", 0.534_730_116_342_079_6),
        ("epsilon", 1.048_080_741_041_938),
    ],
    &[
        ("rate(angle(k1))", 1_139.920_302_259_106_1),
        ("rate(theta)", -1_424.379_295_177_54),
        ("rate(gamma)", 11.032_911_910_618_594),
        ("rate(phi)", 19.293_374_105_032_04),
        ("rate(delta)", 0.573_569_914_829_502_5),
        ("rate(omega)", -19.293_374_105_032_04),
        ("rate(epsilon)", 0.323_179_149_249_130_9),
    ],
    &[
        ("reaction_x(E, k3)", 199.175_348_104_538_63),
        ("reaction_y(E, k3)", -29.755_309_974_971_763),
        ("reaction_x(E, k4)", 23.066_543_611_622_15),
        ("reaction_y(E, k4)", 31.452_725_275_771_137),
        ("reaction_x(E, k6)", 22.642_494_786_394_38),
        ("reaction_y(E, k6)", 11.617_392_352_611_256),
    ],
];

/// Andrews' squeezer by all of its angles, rates and multipliers: the largest relative error of each kind beside the time of the one run
/// that they come from.
fn squeezed(runs: &mut Runs) {
    let names = || SQUEEZED.iter().flat_map(|kind| kind.iter());
    let mut all = String::from("[measures]\n");
    for (k, (text, _)) in names().enumerate() {
        writeln!(all, "m{k} = \"{text}\"").expect("text takes text");
    }
    let model = model("andrews", |text| text.replace("[measures]\n", &all));
    let named = |k: usize| {
        let name = format!("m{k}");
        let found = model.measures.iter().find(|m| m.name == name);
        &found.expect("a measure").measure
    };
    let measures: Vec<&Measure> = (0..names().count()).map(named).collect();
    for tolerance in [1e-7, 1e-8, 1e-10, 1e-12, 1e-13] {
        let (design, question) = question(&model, tolerance);
        let (took, found) = best(|| simulate(&design, &question, &mut Silent).expect("a motion"));
        let motion = found.motion(&mut Silent).expect("a motion");
        let mut sampler = ForceSampler::new(&motion, &measures).expect("measures");
        let values = sampler.values_at_time(question.until);
        let mut values = values.iter();
        let kinds = ["andrews-angles", "andrews-rates", "andrews-forces"];
        for (case, kind) in kinds.iter().zip(SQUEEZED) {
            let off = kind.iter().zip(&mut values);
            let off = off.map(|((_, exact), found)| (found / exact - 1.0).abs());
            let off = off.fold(0.0, f64::max);
            runs.add(case, tolerance, off, took, found.evaluations, "");
        }
    }
}

/// P. Flores, R. Leine and C. Glocker's slider, thrown from its dead point, for 0.1 s. The error is that of the first impact, which is of
/// two corners at once: its time and the speed of the crank, of which ten
/// digits are known; what comes after is not.
fn thrown(runs: &mut Runs) {
    let model = model("clearance-slider", |text| text);
    let parameters = model.parameter_values();
    let design = Design::new(&Mechanism::new(&model), &parameters);
    let clearance = &model.clearances[0];
    let ClearanceAt::Joint(joint) = clearance.at else {
        panic!("no guide")
    };
    for tolerance in [1e-8, 1e-10, 1e-13] {
        let question = Question {
            coordinates: Coordinates::Minimal,
            contacts: vec![Contact {
                joint: Released::Joint(joint),
                clearance: value(&clearance.radial, &parameters),
                properties: clearance.contact.clone(),
                states: ContactStates::Three,
                start: [[0.0; 2]; 2],
                touches: Vec::new(),
                span: 0..0,
            }],
            free: vec![DriveId(0)],
            start: vec![[0.0, 150.0]],
            until: 0.1,
            tolerance,
            method: Method::Choose,
            stops: Vec::new(),
            end_when: Vec::new(),
        };
        let (took, found) = best(|| simulate(&design, &question, &mut Silent).expect("a motion"));
        let first = found.happenings[0].time;
        let rate: Jet<f64, 2> = found.laws[0].at(Jet::variable(first * (1.0 - 1e-12)), &[]);
        let off = [
            first / 0.002_692_502_752,
            rate.derivative(1) / 109.557_681_54,
        ];
        let off = off.map(|part| (part - 1.0).abs());
        let beside = format!("{} happen", found.happenings.len());
        let error = off[0].max(off[1]);
        let case = "clearance-slider";
        runs.add(case, tolerance, error, took, found.evaluations, &beside);
    }
}

/// `theta" = -a cos theta` by the same integrator.
fn by_hand(a: f64, start: [f64; 2], until: f64, tolerance: f64) -> [f64; 2] {
    let mut rates = |_: f64, y: &[f64], rates: &mut [f64]| {
        rates[0] = y[1];
        rates[1] = -a * sin_cos(y[0]).1;
        true
    };
    let tolerance = Tolerance {
        relative: tolerance,
        absolute: vec![tolerance],
    };
    let mut it =
        Integrator::with(Method::Explicit, &mut rates, 0.0, &start, 1.0, tolerance).expect("rates");
    while it.time() < until {
        it.step(&mut rates, until).expect("a step");
    }
    [it.state()[0], it.state()[1]]
}

/// How far the motion of a journal that rattles in its bore, B5 of the references, is known: the first three contacts of each,
/// when they begin (s) and how fast (m/s).
const CONTACTS: [[[f64; 2]; 3]; 2] = [
    [
        [2.272_860_320_398e-4, 4.385_783_145_3],
        [6.370_564_301_7e-4, 2.756_949_153],
        [7.497_002_798e-4, 1.826_699_07],
    ],
    [
        [2.272_860_320_398e-4, 4.385_783_145_3],
        [5.733_715_053_8e-4, 2.267_401_295],
        [7.191_523_59e-4, 2.119_139_99],
    ],
];

/// Two turns of a slider-crank with play at its wrist pin, without friction and with it. The error is the largest relative one of
/// the contacts that are known; motions like this one are chaotic, and after some more of them nothing can be compared.
fn rattle(runs: &mut Runs) {
    let model = model("clearance-slider-crank", |text| text);
    let mut parameters = model.parameter_values();
    let mu = (model.parameters.iter()).position(|p| p.name == "mu");
    let mu = mu.expect("a parameter `mu`");
    for (friction, known) in [0.0, 0.03].into_iter().zip(CONTACTS) {
        parameters[mu] = friction;
        let design = Design::new(&Mechanism::new(&model), &parameters);
        let clearance = &model.clearances[0];
        let ClearanceAt::Pin { point, .. } = clearance.at else {
            panic!("no pin")
        };
        let link = *model.points[point.index()].links.last().expect("links");
        for tolerance in [1e-8, 1e-9, 1e-10, 1e-13] {
            let question = Question {
                coordinates: Coordinates::Minimal,
                contacts: vec![Contact {
                    joint: Released::Pin { point, link },
                    clearance: value(&clearance.radial, &parameters),
                    properties: clearance.contact.clone(),
                    states: ContactStates::Three,
                    start: [[0.0; 2]; 2],
                    touches: Vec::new(),
                    span: 0..0,
                }],
                free: Vec::new(),
                start: Vec::new(),
                until: 0.024,
                tolerance,
                method: Method::Choose,
                stops: Vec::new(),
                end_when: Vec::new(),
            };
            let (took, found) =
                best(|| simulate(&design, &question, &mut Silent).expect("a motion"));
            let contacts = found.touched.iter().zip(&known);
            let off = contacts
                .flat_map(|(touch, [from, speed])| {
                    [touch.touching.from / from, touch.touching.speed / speed]
                })
                .map(|part| (part - 1.0).abs())
                .fold(0.0, f64::max);
            let case = match friction {
                0.0 => "rattle",
                _ => "rattle-rubbing",
            };
            let beside = format!("{} contacts", found.touched.len());
            runs.add(case, tolerance, off, took, found.evaluations, &beside);
        }
    }
}

fn main() {
    let mut runs = Runs::new();
    // Those whose names have this in them.
    let only = std::env::args().skip(1).find(|text| !text.starts_with('-'));
    let asked = |name: &str| {
        only.as_ref()
            .is_none_or(|only| name.contains(only.as_str()))
    };
    for case in cases() {
        if !asked(case.name) {
            continue;
        }
        let model = model(case.name, |text| text);
        for tolerance in [1e-4, 1e-7, 1e-8, 1e-10, 1e-13] {
            let (design, question) = question(&model, tolerance);
            assert!(question.until == case.until, "{}: another time", case.name);
            let (took, found) =
                best(|| simulate(&design, &question, &mut Silent).expect("a motion"));
            let n = match case.name {
                "n-four-bar-2" => Some(2.0),
                "n-four-bar-40" => Some(40.0),
                _ => None,
            };
            let a = match case.name {
                "pendulum" => Some(9.81),
                _ => n.map(|n: f64| 9.81 * ((n + 1.0) / 2.0 + n) / ((n + 1.0) / 3.0 + n)),
            };
            let hand = a.map_or(String::new(), |a| {
                let start = question.start[0];
                let (hand, _) = best(|| by_hand(a, start, question.until, tolerance));
                format!("{:.1} x", took.as_secs_f64() / hand.as_secs_f64())
            });
            let error = error(&found, case.exact, question.until);
            runs.add(case.name, tolerance, error, took, found.evaluations, &hand);
        }
    }
    if asked("andrews") {
        squeezed(&mut runs);
    }
    if asked("clearance-slider") {
        thrown(&mut runs);
    }
    if asked("rattle") {
        rattle(&mut runs);
    }
    runs.keep();
}
