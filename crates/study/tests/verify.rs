//! Validation cases: what passes, what misses, and what is wrong with a case.

use kempe_study::verify::{Case, compare};

const MODEL: &str = r#"
units = { length = "mm", angle = "deg" }
[links]
frame   = { A = [0, 0], D = [60, 0] }
crank   = { A-B = 20 }
coupler = { B-C = 50, P = [25, 0] }
rocker  = { D-C = 40 }
[drives]
motor = { turns = "crank", from = 0, to = 360, speed = "1 rad/s" }
[assembly]
C = "left of B -> D"
"#;

const CASE: &str = r#"
title = "Crank-rocker"
model = "model.toml"
source = "closed form"
[[table]]
rows = """
motor [deg], angle(rocker) [deg], angular_speed(rocker) [rad/s], x(P) [mm]
60, 97.56221763934, 0.29159577615, 32.36794544674
300, 135.77542834108, -0.43445291901, 20.66776883897
"""
[[value]]
measure = "range(angle(rocker))"
expect = "60.032348552120 deg"
[[value]]
at = "motor = 90 deg"
measure = "y(P)"
expect = "28.9 mm"
[[value]]
check = "mobility_rank"
expect = 1
"#;

fn nothing(_: &str) -> Result<String, String> {
    Err("no files".into())
}

#[test]
fn references_are_met_to_their_digits() {
    let case = Case::parse(CASE, &mut nothing).unwrap();
    let found = compare(&case, MODEL, &mut nothing).unwrap();
    assert_eq!(found.len(), 9);
    for c in &found {
        assert!(c.passed && c.source == "closed form", "{c:?}");
    }
}

#[test]
fn a_miss_is_a_miss() {
    let text = CASE
        .replace("60.032348552120", "60.032348553")
        .replace("28.9", "28.8");
    let case = Case::parse(&text, &mut nothing).unwrap();
    let found = compare(&case, MODEL, &mut nothing).unwrap();
    let missed: Vec<&str> = found
        .iter()
        .filter(|c| !c.passed)
        .map(|c| c.what.as_str())
        .collect();
    assert_eq!(missed, ["range(angle(rocker))", "y(P)"]);
}

#[test]
fn angles_count_modulo_turns_and_dimensions_are_checked() {
    let text = CASE
        .replace("97.56221763934", "-262.43778236066")
        .replace("28.9 mm", "28.9 deg");
    let case = Case::parse(&text, &mut nothing).unwrap();
    let found = compare(&case, MODEL, &mut nothing).unwrap();
    assert!(found[0].passed);
    let wrong = found.iter().find(|c| c.what == "y(P)").unwrap();
    assert!(!wrong.passed && wrong.problem.is_some());
}

#[test]
fn broken_cases_are_refused() {
    for (text, word) in [
        ("model = 3", "text"),
        ("", "model"),
        ("model = \"m\"\nvalu = 3", "no key"),
        ("model = \"m\"\n[[value]]\nmeasure = \"x\"", "expect"),
        (
            "model = \"m\"\n[[value]]\nevent = \"x\"\nexpect = 3",
            "one of",
        ),
        ("model = \"m\"\n[[table]]\nfile = \"t.csv\"", "no files"),
        (
            "model = \"m\"\n[[table]]\nrows = \"a [furlong], b\"",
            "no unit",
        ),
        ("model = [", ""),
    ] {
        let error = Case::parse(text, &mut nothing).unwrap_err();
        assert!(error.to_string().contains(word), "{text}: {error}");
    }
}
