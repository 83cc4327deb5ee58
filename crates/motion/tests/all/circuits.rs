//! Whole circuits, wherever on them they start, and motions on which a part runs away.
#![allow(clippy::unwrap_used, clippy::disallowed_methods)]

use std::f64::consts::PI;

use crate::support::Case;
use kempe_motion::circuit::Circuit;
use kempe_motion::events::EventKind;
use kempe_motion::{EndReason, check};

/// Degrees, as they stand in the files.
const DEG: f64 = PI / 180.0;

/// The circuit of a file, closed, has these dead points, rising and each once for every time that it is passed; every row
/// of it has a pose.
fn has_dead_points(text: &str, dead: &[f64]) {
    let case = Case::read(text, "circuit.toml");
    let circuit = Circuit::new(&case.design).unwrap();
    assert!(circuit.closed, "{text}");
    let mut samplers =
        kempe_measure::circuit_samplers(&circuit, &[], &[], &mut kempe_motion::Silent).unwrap();
    let first = kempe_measure::circuit_row(&circuit, &mut samplers, 0.0).unwrap();
    let start = circuit.demanded.start;
    assert!(
        (first.parameter - start).abs() <= 1e-12,
        "{text}: begins at {} instead of {start}",
        first.parameter
    );
    for k in 0..=360 {
        let arc = circuit.length * f64::from(k) / 360.0;
        let row = kempe_measure::circuit_row(&circuit, &mut samplers, arc).unwrap();
        assert!(row.closure < 1e-12, "{text}: {k} {:?}", row.note);
    }
    // Every dead point belongs to the stretch before it and to the one behind it.
    let stretches = circuit.stretches.iter();
    let limits = stretches.flat_map(|s| {
        s.motion
            .events
            .iter()
            .filter(|e| e.kind == EventKind::Limit)
    });
    let mut met: Vec<f64> = limits.map(|e| e.at).collect();
    met.sort_by(f64::total_cmp);
    assert_eq!(met.len(), 2 * dead.len(), "{text}: {met:?}");
    for (at, expected) in met.iter().zip(dead.iter().flat_map(|d| [d; 2])) {
        assert!((at - expected).abs() < 1e-12, "{text}: {met:?}");
    }
}

/// A slider-crank driven by its block: dead points where crank and rod lie in line.
#[test]
fn a_circuit_starts_anywhere_near_its_dead_points() {
    let starts = [
        60.0,
        60.000001,
        60.001,
        60.1,
        60.5,
        61.0,
        61.5,
        65.0,
        100.0,
        135.0,
        138.0,
        139.0,
        139.9,
        139.9999,
        139.9999999,
        140.0,
    ];
    for from in starts {
        let text = format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}
[links]
frame = {{ A = [0, 0], E = [0, 0], F = [200, 0] }}
crank = {{ A-B = 40 }}
rod = {{ B-C = 100 }}
block = {{ C = [0, 0] }}
[joints]
guide = {{ slider = \"block\", at = \"C\", on = \"E -> F\" }}
[drives]
push = {{ slides = \"block\", from = {from}, to = 110, speed = 10 }}
[assembly]
B = \"left of A -> C\"
"
        );
        has_dead_points(&text, &[0.06, 0.14]);
    }
}

/// A double rocker: the crank turns as far as coupler and rocker reach, by the cosine rule.
#[test]
fn a_double_rockers_circuit_starts_near_its_dead_points() {
    let (a, b, c, d) = (45.0_f64, 30.0_f64, 40.0_f64, 60.0_f64);
    let cosine = (a * a + d * d - (b + c) * (b + c)) / (2.0 * a * d);
    let limit = cosine.acos();
    for away in [1e-7, 1e-5, 1e-3, 0.02, 0.08, 0.2, 0.5] {
        for side in [1.0, -1.0] {
            let from = side * (limit / DEG - away);
            let text = format!(
                "units = {{ length = \"mm\", angle = \"deg\" }}
[links]
frame = {{ A = [0, 0], D = [{d}, 0] }}
crank = {{ A-B = {a} }}
coupler = {{ B-C = {b} }}
rocker = {{ D-C = {c} }}
[drives]
motor = {{ turns = \"crank\", from = {from:e}, to = {:e}, speed = 1 }}
[assembly]
C = \"left of B -> D\"
",
                from - side
            );
            has_dead_points(&text, &[-limit, limit]);
        }
    }
}

/// A cylinder that turns an arm: shortest and longest where all lies in line.
#[test]
fn a_cylinders_circuit_starts_near_its_dead_points() {
    for from in [100.0001, 101.0, 105.0, 450.0, 895.0, 899.0, 899.9999] {
        let text = format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}
[links]
frame = {{ A = [0, 0], C = [300, -400] }}
arm = {{ A-B = 400 }}
[drives]
lift = {{ cylinder = \"C-B\", from = {from}, to = 500, speed = \"20 mm/s\" }}
[assembly]
B = \"right of A -> C\"
"
        );
        has_dead_points(&text, &[0.1, 0.9]);
    }
}

/// As the cylinder shortens the slide turns on and on while the drive comes to a stand: no limit, but a part that runs away.
#[test]
fn a_drive_that_comes_to_a_stand_has_no_limit_there() {
    let mut case = Case::read(include_str!("../models/comes-to-a-stand.toml"), "stand");
    let found = check(&case.design);
    let reach = found.reach.unwrap();
    assert_eq!(reach.ends, (EndReason::Runaway, EndReason::Limit));
    for to in ["2.4490325", "2.44903198"] {
        let text = case.text.replace("5.726162528285305", to);
        case = Case::read(&text, "stand");
        let motion = case.must_move();
        assert_eq!(motion.events, [], "{to}");
        let (low, _) = motion.reached();
        assert!(motion.reaches(to.parse().unwrap()), "{to}: {low}");
        // The coordinate runs one way as far as it can be told.
        let places = motion.node_parameters();
        assert!(places.windows(2).all(|w| w[0] < w[1]), "{to}");
        let text = case.text.replace(to, "5.726162528285305");
        case = Case::read(&text, "stand");
    }
}

/// Numbers over a circuit of two assemblies between dead points hold all of its rows and are met by them; what needs time has
/// none. Source: a dense table of the same circuit.
#[test]
fn numbers_over_a_circuit_are_those_of_all_its_rows() {
    let text = "units = { length = \"m\", angle = \"rad\" }
[links]
frame = { A = [0, 0], D = [3, 0] }
crank = { A-B = 2.5 }
rod = { B-C = 2, P = [1, 1] }
rocker = { D-C = 2.2 }
[drives]
motor = { turns = \"crank\", from = 0.7, to = 1, speed = 1 }
[assembly]
C = \"left of B -> D\"
[measures]
x = \"x(C)\"
y = \"y(P)\"
lowest = \"min(x)\"
highest = \"max(x)\"
span = \"range(y)\"
mean = \"mean(x)\"
fastest = \"max(speed(C))\"
of_both = \"max(x)/max(y)\"
nested = \"max(x/highest)\"
hidden = \"max(speed(C) / sqrt(x/1 m - 3))\"
late = \"max(time)\"
once = \"at(x, motor, 0.9)\"
when = \"at(x, time, 0.5)\"
";
    let case = Case::read(text, "circuit.toml");
    let circuit = Circuit::new(&case.design).unwrap();
    let measures: Vec<&kempe_model::Measure> =
        case.model.measures.iter().map(|m| &m.measure).collect();
    let arcs: Vec<f64> = (0..=20_000)
        .map(|k| circuit.length * f64::from(k) / 20_000.0)
        .collect();
    let silent = &mut kempe_motion::Silent;
    let mut samplers =
        kempe_measure::circuit_samplers(&circuit, &measures, &arcs[..2], silent).unwrap();
    let rows: Vec<Vec<f64>> = arcs
        .iter()
        .map(|arc| {
            kempe_measure::circuit_row(&circuit, &mut samplers, *arc)
                .unwrap()
                .values
        })
        .collect();
    let (least, most) = (
        |k: usize| rows.iter().map(|r| r[k]).fold(f64::INFINITY, f64::min),
        |k: usize| rows.iter().map(|r| r[k]).fold(f64::NEG_INFINITY, f64::max),
    );
    let expected = [least(0), most(0), most(1) - least(1)];
    let at = |p: f64| {
        let mut sampler = kempe_measure::Sampler::new(&circuit.demanded, &measures[..1]).unwrap();
        sampler.values_at_parameter(p)[0]
    };
    let first = at(0.9);
    for sampler in &samplers {
        for timeless in [5, 6, 8, 9, 10, 12] {
            assert_eq!(sampler.notes_of(measures[timeless]), []);
        }
    }
    for row in &rows {
        for (found, expected) in row[2..5].iter().zip(expected) {
            assert!((found - expected).abs() < 1e-6, "{found} is not {expected}");
        }
        assert!(row[2] <= row[0] && row[0] <= row[3]);
        assert!((row[7] - most(0) / most(1)).abs() < 1e-6);
        // Between the dead points the drawn assembly is the first that is travelled.
        assert!((row[11] - first).abs() < 1e-9);
        for timeless in [5, 6, 8, 9, 10, 12] {
            assert!(row[timeless].is_nan(), "{timeless}: {row:?}");
        }
    }
}
