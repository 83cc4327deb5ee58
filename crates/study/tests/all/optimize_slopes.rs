//! Optimisation where a number has a value and no exact derivative: lengths of ways that end at rest, speeds at rest, norms that are nothing; and where it
//! has its largest value many times.
#![allow(clippy::unwrap_used)]

use crate::read::read;
use crate::told::scalar;
use kempe_study::{Silent, StudyResult, run};

/// A four-bar whose crank goes from rest to rest, with what is asked of it.
fn rocker(law: &str, study: &str) -> StudyResult {
    let model = read(&format!(
        r#"
units = {{ length = "mm", angle = "deg" }}
[parameters]
a = "20 mm"
b = "50 mm"
[links]
frame   = {{ A = [0, 0], D = [60, 0] }}
crank   = {{ A-B = "a" }}
coupler = {{ B-C = "b", P = [25, 10] }}
rocker  = {{ D-C = 40 }}
[drives]
motor = {{ turns = "crank", from = 20, {law} }}
[assembly]
C = "left of B -> D"
[studies.turn]
kind = "motion"
[studies.best]
kind = "optimize"
vary = {{ a = ["15 mm", "24 mm"], b = ["45 mm", "65 mm"] }}
{study}
"#
    ));
    run(&model, &model.studies[1], &mut Silent).unwrap()
}

const CYCLOIDAL: &str = "to = 200, law = 'cycloidal', in = '1 s'";
const DWELL: &str =
    "law = [{ to = 100, in = '0.5 s' }, { dwell = '0.2 s' }, { to = 200, in = '0.3 s' }]";
const EVEN: &str = "to = 200, speed = '180 deg/s'";

/// It is shown to be an optimum, and nothing is said against it.
fn is_shown(result: &StudyResult) {
    let told: Vec<_> = result.diagnostics.iter().map(|d| d.code).collect();
    let odd = ["infeasible", "not-converged", "no-answer"];
    assert!(!told.iter().any(|code| odd.contains(code)), "{told:?}");
    assert!(scalar(result, "largest violation") < 1e-9);
}

#[track_caller]
fn near(result: &StudyResult, wanted: &[(&str, f64)]) {
    for (name, wanted) in wanted {
        let found = scalar(result, name);
        assert!(
            (found - wanted).abs() < 2e-4 * wanted.abs(),
            "{name}: {found}, not {wanted}"
        );
    }
}

/// The shortest way of the coupler's point that is 28 mm wide, by a dense grid and the simplex method: whatever the law, it is as long.
#[test]
fn the_length_of_a_way_that_ends_at_rest_is_a_goal() {
    let wanted = [("max(path_length(P))", 40.2774), ("a", 15.0), ("b", 57.949)];
    let goal = "minimize = 'max(path_length(P))'\nsubject_to = ['range(x(P)) >= 28 mm']";
    for law in [CYCLOIDAL, DWELL, EVEN] {
        let result = rocker(law, goal);
        is_shown(&result);
        near(&result, &wanted);
    }
    let evolved = rocker(
        CYCLOIDAL,
        &format!("method = 'differential evolution'\n{goal}"),
    );
    is_shown(&evolved);
    near(&evolved, &wanted);
}

/// Places are met at parts of the way's length: how the law goes along it changes nothing. The optimum by the simplex method.
#[test]
fn a_fit_by_arc_length_hangs_on_no_law() {
    let fit = "fit = { point = 'P', to = [[18, 32], [11, 38], [1, 39], [-7, 34], [-12, 26]], timing = 'arc-length' }";
    for law in [CYCLOIDAL, DWELL, EVEN] {
        let result = rocker(law, fit);
        is_shown(&result);
        near(
            &result,
            &[("sum of squares", 749.27), ("a", 15.8152), ("b", 51.9263)],
        );
    }
}

/// What a point at rest does is a limit that all designs keep, or none.
#[test]
fn a_point_at_rest_has_the_speed_nothing() {
    let goal = "minimize = 'max(x(P))'\nsubject_to = ['speed(P) >= SPEED', 'range(x(P)) >= 28 mm']";
    let plain = rocker(
        CYCLOIDAL,
        "minimize = 'max(x(P))'\nsubject_to = ['range(x(P)) >= 28 mm']",
    );
    let kept = rocker(CYCLOIDAL, &goal.replace("SPEED", "0 mm/s"));
    is_shown(&kept);
    near(&kept, &[("max(x(P))", scalar(&plain, "max(x(P))"))]);
    let missed = rocker(CYCLOIDAL, &goal.replace("SPEED", "5 mm/s"));
    let told = (missed.diagnostics.iter()).find(|d| d.code == "infeasible");
    let notes = &told.unwrap().notes;
    assert_eq!(
        notes.as_slice(),
        [
            "the least violation that was reached: `speed(P) >= 5 mm/s` is missed by 5 mm/s",
            "there `speed(P) >= 5 mm/s` cannot be kept, whatever the others"
        ]
    );
}

/// A crank and a rocker with counterweights that balance all forces: by the masses' first moments, 1/6 kg and 11/30 kg.
#[test]
fn what_is_balanced_already_is_an_optimum() {
    let model = read(
        r#"
units = { length = "mm", angle = "deg" }
gravity = 0
[parameters]
m1 = "0.16666666666666666 kg"
m2 = "0.36666666666666664 kg"
[links]
frame   = { A = [0, 0], D = [60, 0] }
crank   = { A-B = 20, mass = "0.2 kg", inertia = "1e-4 kg m^2" }
coupler = { B-C = 50, mass = "0.3 kg", inertia = "1e-4 kg m^2" }
rocker  = { D-C = 40, mass = "0.25 kg", inertia = "1e-4 kg m^2" }
[masses]
w1 = { on = "crank", at = [-30, 0], mass = "m1" }
w2 = { on = "rocker", at = [-30, 0], mass = "m2" }
[drives]
motor = { turns = "crank", from = 0, to = 360, speed = "600 rpm" }
[assembly]
C = "left of B -> D"
[studies.f]
kind = "forces"
[studies.best]
kind = "optimize"
over = "f"
method = "local"
vary = { m1 = ["0 kg", "1 kg"], m2 = ["0 kg", "1 kg"] }
minimize = "max(shaking_force)"
"#,
    );
    let result = run(&model, &model.studies[1], &mut Silent).unwrap();
    is_shown(&result);
    assert!(scalar(&result, "max(shaking_force)") < 1e-9);
    near(&result, &[("m1", 1.0 / 6.0), ("m2", 11.0 / 30.0)]);
}

/// A point that is one with another cannot be nearer to it.
#[test]
fn a_distance_of_nothing_is_an_optimum() {
    for own in ["0 mm", "20 mm"] {
        let model = read(&format!(
            r#"
units = {{ length = "mm", angle = "deg" }}
[parameters]
px = "{own}"
py = "{own}"
[links]
frame   = {{ A = [0, 0], D = [60, 0] }}
crank   = {{ A-B = 20 }}
coupler = {{ B-C = 50, P = ["px", "py"] }}
rocker  = {{ D-C = 40 }}
[drives]
motor = {{ turns = "crank", from = 0, to = 20, speed = "60 rpm" }}
[assembly]
C = "left of B -> D"
[studies.turn]
kind = "motion"
[studies.best]
kind = "optimize"
method = "local"
vary = {{ px = ["-10 mm", "50 mm"], py = ["-30 mm", "30 mm"] }}
minimize = "max(distance(P, B))"
"#
        ));
        let result = run(&model, &model.studies[1], &mut Silent).unwrap();
        is_shown(&result);
        assert!(scalar(&result, "max(distance(P, B))") < 1e-6, "from {own}");
        // The tip of a cone: its slope says how far it is.
        assert!(scalar(&result, "designs tried") < 60.0, "from {own}");
    }
}

/// A slider-crank behind gears turns ten times: its acceleration is largest ten times, and where that is least, two different peaks are as large. By a
/// search on a slider-crank alone, sequential linear steps on its peaks: 36 238.840 mm/s^2.
#[test]
fn what_comes_ten_times_is_one_peak() {
    let model = read(
        r#"
units = { length = "mm", angle = "deg" }
[parameters]
e = "8 mm"
l = "60 mm"
h = "10 mm"
[links]
frame = { A = [0, 0], D = [100, 0], E = [100, "h"], F = [300, "h"] }
big = { A-K = 20 }
small = { D-B = "e" }
rod = { B-C = "l" }
slide = { C = [0, 0] }
[joints]
mesh = { gears = ["big", "small"], teeth = [120, 12] }
bore = { slider = "slide", at = "C", on = "E -> F" }
[drives]
motor = { turns = "big", from = 0, to = 360, speed = "60 rpm" }
[assembly]
C = { near = [160, 0] }
[studies.turn]
kind = "motion"
[studies.best]
kind = "optimize"
vary = { l = ["20 mm", "100 mm"], h = ["-30 mm", "30 mm"], e = ["4 mm", "12 mm"] }
minimize = "max(abs(acceleration(C)))"
subject_to = ["range(x(C)) >= 17 mm", "max(x(C)) <= 155 mm"]
method = "local"
"#,
    );
    let result = run(&model, &model.studies[1], &mut Silent).unwrap();
    is_shown(&result);
    let least = scalar(&result, "max(abs(acceleration(C)))");
    assert!((least - 36_238.84).abs() < 0.05, "{least}");
    // It took 222 and did not end.
    let tried = scalar(&result, "designs tried");
    assert!(tried < 40.0, "{tried}");
}

/// A Scott-Russell linkage: where the crank is half as long as the rod, the rod's end goes along a straight line through the crank's pivot, and does not move
/// sideways at all. What is nothing there but for rounding is no reason to look at it ever more closely.
fn russell(study: &str) -> StudyResult {
    let model = read(&format!(
        r#"
units = {{ length = "mm", angle = "deg" }}
[parameters]
a = "45 mm"
p = "-44 mm"
[links]
frame = {{ A = [0, 0], F = [300, 0] }}
crank = {{ A-B = "a" }}
rod = {{ B-C = 50, P = ["p", 0] }}
slide = {{ C = [0, 0] }}
[joints]
bore = {{ slider = "slide", at = "C", on = "A -> F" }}
[drives]
motor = {{ turns = "crank", from = 20, to = 70, speed = "60 rpm" }}
[assembly]
C = {{ near = [90, 0] }}
[studies.turn]
kind = "motion"
[studies.best]
kind = "optimize"
vary = {{ a = ["40 mm", "55 mm"], p = ["-60 mm", "-40 mm"] }}
{study}
"#
    ));
    run(&model, &model.studies[1], &mut Silent).unwrap()
}

#[test]
fn rates_that_are_to_be_nothing_are_brought_there() {
    for (goal, most) in [
        ("max(abs(rate(x(P), 2)))", 1e-5),
        ("max(abs(rate(x(P))))", 1e-6),
    ] {
        let result = russell(&format!("minimize = '{goal}'"));
        is_shown(&result);
        near(&result, &[("a", 50.0), ("p", -50.0)]);
        let least = scalar(&result, goal);
        assert!(least < most, "{goal}: {least}");
        let tried = scalar(&result, "designs tried");
        assert!(tried < 1200.0, "{goal}: {tried}");
    }
    let kept =
        russell("minimize = 'max(y(P))'\nsubject_to = ['max(abs(rate(x(P), 2))) <= 0 mm/s^2']");
    is_shown(&kept);
    // The end is as high as twice the crank's pin.
    let high = 100.0 * kempe_number::math::sin(70_f64.to_radians());
    near(&kept, &[("a", 50.0), ("p", -50.0), ("max(y(P))", high)]);
}

/// What it costs that a point may be no distance away from another: by how much the goal, which has a slope of one and of two in two directions, falls where it may.
#[test]
fn a_distance_of_nothing_costs_what_easing_it_brings() {
    for (own, most) in [("0 mm", "0 mm"), ("20 mm", "0 mm"), ("20 mm", "0.01 mm")] {
        let model = read(&format!(
            r#"
units = {{ length = "mm", angle = "deg" }}
[parameters]
px = "{own}"
py = "{own}"
[links]
frame   = {{ A = [0, 0], D = [60, 0] }}
crank   = {{ A-B = 20 }}
coupler = {{ B-C = 50, P = ["px", "py"] }}
rocker  = {{ D-C = 40 }}
[drives]
motor = {{ turns = "crank", from = 30, to = 50, speed = "60 rpm" }}
[assembly]
C = "left of B -> D"
[studies.turn]
kind = "motion"
[studies.best]
kind = "optimize"
vary = {{ px = ["-10 mm", "50 mm"], py = ["-30 mm", "30 mm"] }}
minimize = "at(x(P), motor, 30) + 2 * at(y(P), motor, 30)"
subject_to = ["max(distance(P, B)) <= {most}"]
"#
        ));
        let result = run(&model, &model.studies[1], &mut Silent).unwrap();
        is_shown(&result);
        let mut costs = result.listings.iter();
        let costs = costs.find(|it| it.title.starts_with("what holds")).unwrap();
        assert_eq!(costs.rows.len(), 1, "{costs:?}");
        assert_eq!(costs.rows[0][2], "-2.23607 mm", "from {own} to {most}");
    }
}
