//! What begins and ends within a step that could be long: simulated as if it had been waited for.
#![allow(clippy::unwrap_used)]

use crate::told::column;
use kempe_model::Model;
use kempe_study::{Silent, StudyResult, run};

fn result(text: &str) -> StudyResult {
    with_table(
        text,
        "t [s],F [N]\n0,0\n5,0\n5.01,100\n5.02,100\n5.03,0\n10,0\n",
    )
}

fn with_table(text: &str, csv: &str) -> StudyResult {
    let mut file = |_: &_| Ok(csv.into());
    let model = Model::from_toml(text, "steps", &mut file).unwrap().model;
    run(&model, &model.studies[0], &mut Silent).unwrap()
}

fn near(found: f64, exact: f64, by: f64) {
    assert!((found - exact).abs() < by, "{found}, not {exact}");
}

/// A block of 1 kg on a line.
fn block(more: &str, study: &str) -> StudyResult {
    result(&format!(
        "units = {{ length = \"m\" }}\n[links]\nframe = {{ O = [0, 0], X = [10, 0] }}\nblock = {{ C = [0, 0], mass = 1, inertia = 1 }}\n\
         [joints]\nway = {{ slider = \"block\", at = \"C\", on = \"O -> X\" }}\n[drives]\ns = {{ slides = \"block\", at = 0 }}\n{more}\n\
         [studies.a]\nkind = \"simulate\"\nrows = 11\n{study}\n"
    ))
}

/// Momentum is what the pulse gives, told by a table or an expression, in a long time of nothing.
#[test]
fn a_pulse_is_felt() {
    for (force, impulse) in [
        (
            "{ table = \"pulse.csv\", over = \"time\", value = \"F\" }",
            2.0,
        ),
        ("\"max(0 N, 100 N * (1 - abs(time - 5.03 s)/50 ms))\"", 5.0),
        (
            "\"100 N * exp(-((time - 5.03 s)/20 ms)^2)\"",
            100.0 * 0.02 * std::f64::consts::PI.sqrt(),
        ),
    ] {
        let found = block(
            &format!("[loads]\nf = {{ force = [{force}, 0], at = \"C\" }}"),
            "until = \"10 s\"\nstart = { s_rate = \"0.01 m/s\" }\ncolumns = [\"rate(s)\"]",
        );
        assert!(found.diagnostics.is_empty(), "{:?}", found.diagnostics);
        near(
            *column(&found, "rate(s)").last().unwrap(),
            0.01 + impulse,
            1e-8,
        );
    }
}

/// A stop that is struck at the end of a long way out, whatever comes after.
#[test]
fn a_stop_is_struck_however_long_it_goes_on() {
    for until in [0.97, 2.0, 100.0, 1e4] {
        let found = block(
            "[loads]\nf = { force = [\"1 N\", 0], at = \"C\" }",
            &format!(
                "until = \"{until} s\"\nstart = {{ s_rate = \"-1 m/s\" }}\nstops = {{ s = {{ between = [\"-0.499 m\", \"none\"], restitution = 0.5 }} }}\n\
                 columns = [\"s\"]"
            ),
        );
        let struck = found.listings.iter().flat_map(|listing| &listing.rows);
        let struck = struck.filter(|row| row.iter().any(|cell| cell.contains("strikes")));
        assert!(struck.count() >= 1, "{until}");
        assert!(column(&found, "s").iter().all(|s| *s >= -0.499 - 1e-12));
    }
}

/// A condition that holds for thirty milliseconds, at a kink of what it asks.
#[test]
fn a_condition_ends_it_however_short_it_holds() {
    for until in [0.645, 0.66, 1.0, 10.0] {
        let found = block(
            "",
            &format!(
                "until = \"{until} s\"\nend_when = \"abs(rate(s)) <= 0.1 m/s\"\nstart = {{ s_rate = \"3.2 m/s\" }}\ncolumns = [\"s\"]"
            ),
        );
        // Nothing brakes it.
        assert_eq!(found.table.rows(), 11);
        let found = block(
            "[loads]\nf = { force = [\"-10 N\", 0], at = \"C\" }",
            &format!(
                "until = \"{until} s\"\nend_when = \"abs(rate(s)) <= 0.1 m/s\"\nstart = {{ s_rate = \"3.2 m/s\" }}\ncolumns = [\"time\"]"
            ),
        );
        near(*column(&found, "time").last().unwrap(), 0.31, 1e-9);
    }
}

/// A switch that goes on for a short while by the clock.
#[test]
fn a_switch_goes_on_for_a_short_while() {
    let found = block(
        "[switches]\nw = { on = \"abs(time - 5 s) <= 2 ms\" }\n[loads]\nf = { force = [\"20 N * switch(w)\", 0], at = \"C\" }",
        "until = \"10 s\"\ncolumns = [\"rate(s)\"]",
    );
    near(
        *column(&found, "rate(s)").last().unwrap(),
        20.0 * 0.004,
        1e-9,
    );
}

/// A pin that touches its bore at the top of a throw.
#[test]
fn a_pin_touches_its_bore_at_the_top_of_its_throw() {
    for law in ["exact", "hertz", "rigid"] {
        for until in [0.07, 0.1, 0.12] {
            let found = result(&format!(
                "units = {{ length = \"mm\" }}\ngravity = [0, \"-9.81 m/s^2\"]\n[links]\nframe = {{ O = [0, 0] }}\n\
                 rod = {{ O-P = 100, mass = 1, inertia = 1e-3, center = \"O\" }}\n[drives]\np = {{ turns = \"rod\", at = 0 }}\n\
                 [clearance]\nO = {{ radial = \"10 mm\", radius = \"5 mm\", law = \"{law}\", restitution = 0.5 }}\n\
                 [studies.c]\nkind = \"clearance\"\nmodel = \"three-state\"\nrelease = \"p\"\n\
                 start = {{ O = [0, \"-9.99 mm\"], O_rate = [0, \"0.6264323 m/s\"] }}\nuntil = \"{until} s\"\nrows = 301\n"
            ).replace(", restitution = 0.5", if law == "hertz" { "" } else { ", restitution = 0.5" }));
            let most = column(&found, "O play y").into_iter().fold(0.0, f64::max);
            let deep = if law == "rigid" { 1e-9 } else { 0.004 };
            assert!(most < 10.0 + deep, "{law} until {until}: {most}");
        }
    }
}

/// A straight guide has no dead point, however far the block goes, in times the size of the file.
#[test]
fn a_straight_guide_ends_nowhere() {
    let found = block(
        "[loads]\nf = { force = [\"1 N\", 0], at = \"C\" }",
        "until = \"300 s\"\ncolumns = [\"s\"]",
    );
    assert!(found.diagnostics.is_empty(), "{:?}", found.diagnostics);
    near(*column(&found, "s").last().unwrap(), 45_000.0, 1e-4);
}

/// A box that a shaft kicks once in every turn, over ten degrees of it, and that nothing moves meanwhile.
#[test]
fn a_kick_over_some_degrees_of_a_turn_is_felt() {
    for law in [
        "from = 0, to = 3600, speed = '360 deg/s'",
        "from = 3600, to = 0, speed = '-360 deg/s'",
    ] {
        let text = format!(
            r#"
units = {{ length = "mm", angle = "deg" }}
[links]
frame = {{ O = [0, 0], X = [4000, 0], D = [0, 500] }}
box   = {{ C = [0, 0], mass = "2 kg", inertia = 0 }}
wheel = {{ D-P = 100 }}
[joints]
way = {{ slider = "box", at = "C", on = "O -> X" }}
[drives]
slip = {{ slides = "box", at = 0 }}
turn = {{ turns = "wheel", {law} }}
[loads]
knock = {{ force = [{{ table = "kick.csv", over = "turn", period = 360 }}, 0], at = "C", on = "box" }}
[studies.go]
kind    = "simulate"
release = "slip"
until   = "10 s"
rows    = 11
columns = ["rate(slip)"]
"#
        );
        let found = with_table(&text, "phi [deg],F [N]\n0,0\n200,0\n205,100\n210,0\n");
        assert!(found.diagnostics.is_empty(), "{:?}", found.diagnostics);
        // Two cubics with level ends are as much as a triangle.
        let kick = 0.5 * 100.0 * 10.0 / 360.0;
        near(
            *column(&found, "rate(slip)").last().unwrap() / 1000.0,
            10.0 * kick / 2.0,
            1e-6,
        );
    }
}

/// A flywheel that punches once in every turn, by a table or an expression, and coasts meanwhile: each takes its work.
#[test]
fn a_punch_takes_its_work_from_a_flywheel() {
    let half = kempe_number::math::acos(0.9);
    let lens = 8000.0 * ((1.0_f64 - 0.81).sqrt() - 0.9 * half);
    for (torque, work) in [
        (
            "{ table = \"punch.csv\", over = \"turn\", period = 360 }",
            0.5 * 400.0 * 30_f64.to_radians(),
        ),
        ("\"-4000 N m * max(0, cos(turn - 215 deg) - 0.9)\"", lens),
    ] {
        let text = format!(
            r#"
units = {{ length = "mm", angle = "deg" }}
gravity = 0
[links]
frame = {{ O = [0, 0] }}
wheel = {{ O-P = 300, mass = "50 kg", inertia = "4 kg m^2", center = "O" }}
[drives]
turn = {{ turns = "wheel", at = 0 }}
[loads]
punch = {{ torque = {torque}, on = "wheel" }}
[studies.go]
kind    = "simulate"
start   = {{ turn_rate = "300 rpm" }}
until   = "1 s"
rows    = 11
columns = ["turn", "kinetic_energy", "load(punch)"]
"#
        );
        let csv = "phi [deg],M [N m]\n0,0\n200,0\n215,-400\n230,0\n";
        let found = with_table(&text, csv);
        assert!(found.diagnostics.is_empty(), "{:?}", found.diagnostics);
        let energy = column(&found, "kinetic_energy");
        let turned = *column(&found, "turn").last().unwrap();
        assert_eq!(*column(&found, "load(punch)").last().unwrap(), 0.0);
        let punches = ((turned + 145.0) / 360.0).floor();
        assert!(punches >= 2.0);
        near(energy[0] - energy[10], punches * work, 1e-4);
    }
}

/// A rope that a crank draws tight for a small part of each turn pulls a heavy box.
#[test]
fn a_rope_is_tight_for_a_while() {
    let found = |step: &str| {
        result(&format!(
            r#"
units = {{ length = "mm", angle = "deg" }}
[links]
frame = {{ O = [0, 0], X = [4000, 0], D = [-1500, 0] }}
box   = {{ C = [0, 0], mass = "200 kg", inertia = 0 }}
wheel = {{ D-P = 100 }}
[joints]
way = {{ slider = "box", at = "C", on = "O -> X" }}
[drives]
slip = {{ slides = "box", at = 0 }}
turn = {{ turns = "wheel", from = 0, to = 3600, speed = "360 deg/s" }}
[springs]
rope = {{ between = "P-C", on = "box", stiffness = "1 N/mm", free = "1595 mm", acts = "tension" }}
[studies.go]
kind    = "simulate"
release = "slip"
until   = "10 s"
{step}
columns = ["slip"]
"#
        ))
    };
    // By a solver of its own that steps no farther than a thousandth of a turn.
    for step in ["rows = 11", "step = \"10 ms\""] {
        let way = *column(&found(step), "slip").last().unwrap();
        near(way, -24.7436, 1e-3);
    }
}
