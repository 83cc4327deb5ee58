//! What begins and ends within a step that could be long: simulated as if it had been waited for.
#![allow(clippy::unwrap_used)]

use kempe_model::Model;
use kempe_study::{Silent, StudyResult, run};

fn result(text: &str) -> StudyResult {
    let mut file = |_: &_| Ok("t [s],F [N]\n0,0\n5,0\n5.01,100\n5.02,100\n5.03,0\n10,0\n".into());
    let model = Model::from_toml(text, "steps", &mut file).unwrap().model;
    run(&model, &model.studies[0], &mut Silent).unwrap()
}

fn column(result: &StudyResult, name: &str) -> Vec<f64> {
    let found = result.table.column(name);
    found.unwrap_or_else(|| panic!("{name}")).values.clone()
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
