//! Counterweights and springs: what a study chooses is put into the file, and does there what was promised.
#![allow(
    clippy::disallowed_methods,
    reason = "numbers found by hand beside ours, not reproducible ones"
)]

use crate::told::column;
use kempe_model::{Diagnostic, Model};
use kempe_study::{Silent, StudyResult, run};

fn model(text: &str) -> Model {
    match Model::from_toml(text, "test", &mut |_| Err("no files".into())) {
        Ok(checked) => checked.model,
        Err(found) => panic!("{}", rendered(&found, text)),
    }
}

fn rendered(found: &[Diagnostic], text: &str) -> String {
    let lines = found.iter().map(|d| d.render_plain("test.toml", text));
    lines.collect()
}

fn ran(text: &str) -> StudyResult {
    let model = model(text);
    match run(&model, &model.studies[0], &mut Silent) {
        Ok(result) => result,
        Err(found) => panic!("{}", rendered(&found, text)),
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |a, b| a.max(b.abs()))
}

fn root_mean_square(values: &[f64]) -> f64 {
    // The first and the last row count half.
    let ends = values.first().map_or(0.0, |v| v * v) + values.last().map_or(0.0, |v| v * v);
    let sum = values.iter().map(|v| v * v).sum::<f64>() - 0.5 * ends;
    (sum / (values.len() - 1) as f64).sqrt()
}

fn scalar(result: &StudyResult, name: &str) -> f64 {
    let found = result.scalars.iter().find(|s| s.name.contains(name));
    found.map_or(f64::NAN, |s| s.value)
}

/// A four-bar whose coupler is two masses at its pins: two counterweights balance its force completely.
const TWO_MASS_COUPLER: &str = r#"
units = { length = "mm", angle = "deg" }
gravity = 0
[links]
frame   = { A = [0, 0], D = [60, 0] }
crank   = { A-B = 20, mass = "0.2 kg", inertia = "8 kg mm^2", center = [11, 2] }
coupler = { B-C = 50 }
rocker  = { D-C = 40, mass = "0.4 kg", inertia = "60 kg mm^2", center = [15, 3] }
[masses]
near = { on = "coupler", at = "B", mass = "0.3 kg" }
far  = { on = "coupler", at = "C", mass = "0.2 kg" }
[drives]
motor = { turns = "crank", from = 0, to = 360, speed = "20 rad/s" }
[assembly]
C = "left of B -> D"
[studies.quiet]
kind = "balance"
on = ["crank", "rocker"]
radius = "30 mm"
"#;

#[test]
fn a_four_bar_is_balanced_completely_by_two_counterweights() {
    let result = ran(TWO_MASS_COUPLER);
    let before = largest(&column(&result, "shaking_force before"));
    assert!(before > 1.0);
    assert!(largest(&column(&result, "shaking_force after")) < 1e-12 * before);
    // Berkof and Lowen: what turns about each pivot, pin masses included, has its centre there.
    let moment: [f64; 2] = [0.2 * 11e-3 + 0.3 * 20e-3, 0.2 * 2e-3];
    let mass = (moment[0] * moment[0] + moment[1] * moment[1]).sqrt() / 30e-3;
    let listing = &result.listings[0].rows;
    assert_eq!(listing.len(), 2, "{listing:?}");
    let written: f64 = listing[0][0]
        .split("mass = \"")
        .nth(1)
        .and_then(|t| t.split(' ').next()?.parse().ok())
        .unwrap_or(f64::NAN);
    assert!((written - mass).abs() < 1e-10, "{written} {mass}");
    // The lines go into the file as they are.
    let lines: String = listing.iter().map(|l| format!("{}\n", l[0])).collect();
    let text = TWO_MASS_COUPLER.replace("[drives]", &format!("{lines}[drives]"));
    let again = ran(&text);
    assert!(largest(&column(&again, "shaking_force before")) < 1e-9 * before);
    // And every harmonic is gone.
    let harmonics = &result.listings[1];
    assert_eq!((harmonics.head.len(), harmonics.rows.len()), (5, 6));
}

#[test]
fn one_counterweight_leaves_less_than_any_other() {
    let text = TWO_MASS_COUPLER.replace("[\"crank\", \"rocker\"]", "[\"crank\"]");
    let result = ran(&text);
    let (before, after) = (scalar(&result, "before"), scalar(&result, "after"));
    assert!(after < 0.9 * before, "{before} {after}");
    let line = &result.listings[0].rows[0][0];
    for factor in [0.98, 1.02] {
        let mass: f64 = line
            .split("mass = \"")
            .nth(1)
            .and_then(|t| t.split(' ').next()?.parse().ok())
            .unwrap_or(0.0);
        let other = line.replace(
            &format!("mass = \"{mass}"),
            &format!("mass = \"{}", mass * factor),
        );
        assert_ne!(&other, line);
        let again = ran(&text.replace("[drives]", &format!("{other}\n[drives]")));
        assert!(scalar(&again, "before") > after);
    }
}

#[test]
fn a_beam_hangs_in_balance() {
    let text = r#"
[links]
frame = { A = [0, 0] }
beam  = { A-B = 2, mass = "30 kg", inertia = "10 kg m^2", center = [0.7, 0.2] }
[loads]
hook = { force = [0, "-50 N"], at = "B" }
[drives]
motor = { turns = "beam", from = "0 deg", to = "70 deg", speed = "0.1 rad/s" }
[studies.hang]
kind = "balance"
goal = "statics"
on = ["beam"]
radius = "0.5 m"
"#;
    let result = ran(text);
    let load = column(&result, "reduced_load(motor) after");
    // What the hook asks for is no matter of weights: it stays.
    let angle = column(&result, "motor");
    for (load, angle) in load.iter().zip(angle) {
        let hook = -100.0 * angle.to_radians().cos();
        assert!((load - hook).abs() < 1e-10, "{load} {hook}");
    }
    assert!(scalar(&result, "after") < 1e-12 * scalar(&result, "before"));
}

/// A flap that a tension spring holds: with a free length of nothing it can hold it everywhere.
const FLAP: &str = r#"
[links]
frame = { A = [0, 0], S = [0, 0.4] }
flap  = { A-B = 0.8, P = [0.3, 0], mass = "12 kg", inertia = "0.7 kg m^2", center = [0.4, 0] }
[springs]
back = { between = "S-P", stiffness = "100 N/m", free = 0, preload = "5 N" }
[drives]
hand = { turns = "flap", from = "0 deg", to = "80 deg", speed = "0.01 rad/s" }
[studies.assist]
kind = "spring"
spring = "back"
"#;

#[test]
fn a_spring_of_no_length_holds_a_flap_everywhere() {
    let result = ran(FLAP);
    // k h r = m g c: potential of a zero-length spring is -k h r sin.
    let stiffness = 12.0 * 9.81 * 0.4 / (0.4 * 0.3);
    assert!(
        (scalar(&result, "stiffness") - stiffness).abs() < 1e-4 * stiffness,
        "{:?}",
        result.scalars
    );
    assert!(scalar(&result, "preload").abs() < 1e-2);
    let (before, after) = (
        column(&result, "torque(hand) before"),
        column(&result, "torque(hand) after"),
    );
    assert!(
        largest(&after) < 1e-4 * largest(&before),
        "{}",
        largest(&after)
    );
    let line = &result.listings[0].rows[0][0];
    let text = FLAP.replace(
        "stiffness = \"100 N/m\", free = 0, preload = \"5 N\"",
        &format!("free = 0, {line}"),
    );
    assert_ne!(text, FLAP);
    let again = ran(&text.replace(
        "kind = \"spring\"\nspring = \"back\"",
        "kind = \"forces\"\ncolumns = \"torque(hand)\"",
    ));
    assert!(largest(&column(&again, "torque(hand)")) < 1e-4 * largest(&before));
}

#[test]
fn bounds_and_a_wanted_effort_are_kept() {
    let text = format!(
        "{FLAP}wanted = \"10 N m * cos(hand)\"\nstiffness = [0, \"300 N/m\"]\npreload = [0, \"none\"]\n"
    );
    let result = ran(&text);
    assert!(scalar(&result, "stiffness") <= 300.0 && scalar(&result, "preload") >= 0.0);
    let (after, wanted) = (
        column(&result, "torque(hand) after"),
        column(&result, "wanted"),
    );
    assert!((wanted[0] - 10.0).abs() < 1e-12);
    let gap: Vec<f64> = after.iter().zip(&wanted).map(|(a, w)| a - w).collect();
    let diagnostic = scalar(&result, "mean square after");
    assert!(
        (root_mean_square(&gap) - diagnostic).abs() < 1e-9 * diagnostic,
        "{diagnostic}"
    );
    // A stop makes the spring another one than was chosen: that is said.
    let text = text.replace("free = 0,", "free = 0, acts = \"tension\",");
    assert!(
        ran(&text)
            .diagnostics
            .iter()
            .any(|d| d.code == "spring-not-linear")
    );
}

/// The garage door of the gallery. Stiffness and preload were computed apart from Kempe: the rollers' height by Pythagoras, the
/// effort by Lagrange's equation with slopes by differences of eighth order, and the normal equations of its squares over the
/// 86 rows, of which the first and the last count half.
#[test]
fn the_spring_of_the_garage_door_is_that_of_least_squares() {
    let text = include_str!("../../../../examples/gallery/garage-door.toml");
    let model = model(text);
    let study = model.studies.iter().find(|s| s.name == "choose").unwrap();
    let result = run(&model, study, &mut Silent).unwrap();
    let near = |name: &str, expected: f64| {
        let found = scalar(&result, name);
        assert!(
            (found - expected).abs() < 1e-7 * 11_647.0,
            "{name}: {found}"
        );
    };
    near("stiffness", 11_647.015_802);
    near("preload", -233.861_871 + 11_647.015_802 * 0.02);
    near("effort less wanted, root mean square before", 352.855_838_4);
    near("effort less wanted, root mean square after", 8.284_253_4);
}
