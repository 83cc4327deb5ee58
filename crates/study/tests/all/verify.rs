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

/// What a case may ask of the contacts of a study, and what it is told where there is no such thing.
#[test]
fn contacts_are_asked_for_one_by_one() {
    let model = MODEL
        .replace("A-B = 20 ", "A-B = 20, mass = 1, inertia = 0 ")
        .replace("P = [25, 0]", "P = [25, 0], mass = 1, inertia = 0")
        .replace("1 rad/s", "30 rad/s")
        + "[clearance]\nB = { radial = \"50 um\", law = \"rigid\", restitution = 0.3 }\n[studies.rattle]\nkind = \"clearance\"\n\
           model = \"three-state\"\nuntil = \"2.3 ms\"\nrows = 3\ncolumns = [\"y(P)\"]\n";
    let asked = [
        ("contacts", "", "1"),
        ("contacts at B", "", "1"),
        ("contacts at C", "", "1"),
        ("time", "contact = 1", "1 s"),
        ("speed", "contact at B = 1", "1 m/s"),
        ("speed", "contact at B = 1", "1 s"),
        ("speed", "contact at C = 1", "1 m/s"),
        ("speed", "contact = 2", "1 m/s"),
        ("speed", "contact = first", "1 m/s"),
        ("deepest", "contact = 1", "1 m"),
        ("motor", "contact = 1", "1 deg"),
        ("nothing", "contact = 1", "1 deg"),
    ];
    let values = asked.map(|(measure, at, expect)| {
        let at = if at.is_empty() {
            String::new()
        } else {
            format!("at = \"{at}\"\n")
        };
        format!("[[value]]\n{at}measure = \"{measure}\"\nexpect = \"{expect}\"\n")
    });
    let text = format!("model = \"x\"\nstudy = \"rattle\"\n{}", values.concat());
    let case = Case::parse(&text, &mut nothing).unwrap();
    let found = compare(&case, &model, &mut nothing).unwrap();
    let ours: Vec<f64> = found.iter().map(|c| c.ours).collect();
    assert_eq!(ours[..2], [1.0, 1.0]);
    let (time, speed, motor) = (ours[3], ours[4], ours[10]);
    assert!(time > 0.0 && time < 2.3e-3 && speed > 0.0, "{time} {speed}");
    assert!((motor.to_radians() - 30.0 * time).abs() < 1e-12, "{motor}");
    let told: Vec<&str> = found.iter().filter_map(|c| c.problem.as_deref()).collect();
    let starts = [
        "the study has no contact at `C`",
        "ours is a speed",
        "the study has no contact at `C`",
        "the study has no contact = 2",
        "write `contact = 2`",
        "this contact takes no time",
        "unknown name `nothing`",
    ];
    for (told, start) in told.iter().zip(starts) {
        assert!(told.starts_with(start), "{told}");
    }
    assert_eq!(told.len(), starts.len());
}
