//! Studies that ask for outputs that rest: what they find, moved again; files, names and bad requests.

use crate::beside::{HEAD, SYMMETRIC, code, column, found, moved, random_bar, tried};
use crate::told::scalar;
use kempe_model::{Model, set_value};
use kempe_number::Random;
use kempe_study::StudyResult;

fn asked(task: &str) -> String {
    format!("\n[studies.s]\nkind = \"synthesize\"\ntask = \"dwell\"\n{task}\n")
}

/// Moves all that was found again: it rests where it is said to, by as much as it is said to, and goes as far as it is said to.
fn assert_rests(result: &StudyResult, length: f64, output: &str, whole: &str) {
    let [from, stir, all] = ["rest_from", "stir", whole].map(|name| column(result, name));
    let miss = column(result, "miss");
    assert_eq!(result.designs.len(), from.len());
    for (k, design) in result.designs.iter().enumerate() {
        let own = moved(&design.file);
        let (at, values) = (column(&own, "motor"), column(&own, output));
        let inside = |at: f64| {
            [0.0, 360.0]
                .iter()
                .any(|turn| (from[k]..=from[k] + length).contains(&(at + turn)))
        };
        let range = |values: &mut dyn Iterator<Item = f64>| {
            let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| {
                (l.min(x), h.max(x))
            });
            high - low
        };
        let rested = range(
            &mut at
                .iter()
                .zip(&values)
                .filter(|(at, _)| inside(**at))
                .map(|(_, x)| *x),
        );
        assert!(
            rested <= stir[k] * (1.0 + 1e-6) + 1e-9,
            "{rested} of {}: {k}\n{}",
            stir[k],
            design.file.toml
        );
        // Rows do not stand at both ends of the rest.
        assert!(
            rested > 0.7 * stir[k] - 1e-9,
            "{rested} of {}: {k}\n{}",
            stir[k],
            design.file.toml
        );
        let moved = range(&mut values.iter().copied());
        assert!(
            (moved / all[k] - 1.0).abs() < 2e-3,
            "{moved} of {}: {k}\n{}",
            all[k],
            design.file.toml
        );
        assert!(miss[k] < 1e-9);
        assert!(own.diagnostics.is_empty(), "{:?}", own.diagnostics);
    }
}

/// How far it moves during the rest is that of the lengths that a file has, not of those that were found.
#[test]
fn other_lengths_stir_as_far_as_their_rows_say() {
    let asked = asked("point = \"P\"\ndwell = 135\nswing = 25");
    let result = found(&format!("{HEAD}{SYMMETRIC}{asked}"));
    let design = &result.designs[0];
    let from = column(&result, "rest_from")[0];
    let own = column(&result, "rod_length")[0];
    let mut last = column(&result, "stir")[0];
    for longer in [2.0, 5.0, 10.0] {
        let mut file = design.file.clone();
        let length = format!("\"{} mm\"", own + longer);
        file.toml =
            set_value(&file.toml, &["parameters", "rod_length"], &length).expect("a length");
        let moved = moved(&file);
        let (at, values) = (column(&moved, "motor"), column(&moved, "lever"));
        let rests = at.iter().zip(&values);
        let rests = rests.filter(|(at, _)| (from - 1e-6..=from + 135.0 + 1e-6).contains(*at));
        let (low, high) = rests.fold((f64::MAX, f64::MIN), |(l, h), (_, x)| {
            (l.min(*x), h.max(*x))
        });
        let stir = scalar(&moved, "stir");
        assert!(
            stir >= high - low - 1e-9 && stir <= 1.1 * (high - low),
            "{longer}: {stir} of {}",
            high - low
        );
        assert!(stir > last, "{longer}");
        last = stir;
    }
}

#[test]
fn the_gallery_s_six_bar_is_found_from_its_four_bar() {
    let result = found(&format!(
        "{HEAD}{SYMMETRIC}{}",
        asked("point = \"P\"\ndwell = 135")
    ));
    assert!((column(&result, "rest_from")[0] - 112.5).abs() < 0.1);
    assert!(column(&result, "deviation")[0] < 0.1);
    assert!(!result.designs.is_empty());
    assert_rests(&result, 135.0, "lever", "swing");
    let file = &result.designs[0].file.toml;
    for kept in [
        "# A comment that stays.",
        "# two pivots",
        "title = \"t: s 01\"",
        "O = [",
    ] {
        assert!(file.contains(kept), "{kept}\n{file}");
    }
    assert!(!file.contains("synthesize"), "{file}");
}

#[test]
fn a_swing_is_kept_and_the_best_transmission_comes_with_it() {
    let task = "point = \"P\"\ndwell = 135\nswing = 25\nrank = \"-min(transmission_angle)\"\naccept = [\"stir <= 0.2 deg\"]";
    let result = found(&format!("{HEAD}{SYMMETRIC}{}", asked(task)));
    assert!(!result.designs.is_empty());
    assert!(
        column(&result, "swing")
            .iter()
            .all(|s| (s - 25.0).abs() < 1e-6)
    );
    assert_rests(&result, 135.0, "lever", "swing");
    let transmission = column(&result, "min(transmission_angle)");
    assert!(
        transmission[0] > 50.0 && transmission.is_sorted_by(|a, b| a >= b),
        "{transmission:?}"
    );
}

#[test]
fn a_drawn_mechanism_stays_drawn() {
    let drawn = r#"[places]
A = [0, 0]
B = [-40, 0]
C = [40, 126.886]
D = [120, 0]
P = [182.844, 172.661]
[links]
frame   = ["A", "D"]
crank   = ["A", "B"]
coupler = ["B", "C", "P"]
rocker  = ["D", "C"]
[drives]
motor = { turns = "crank", from = 0, to = 360, speed = "60 rpm" }
"#;
    for output in ["output = \"lever\"", "output = \"slider\""] {
        let task = format!("point = \"P\"\ndwell = 135\n{output}");
        let result = found(&format!("{HEAD}{drawn}{}", asked(&task)));
        assert!(!result.designs.is_empty(), "{output}");
        match output.contains("slider") {
            true => assert_rests(&result, 135.0, "travel", "stroke"),
            false => assert_rests(&result, 135.0, "lever", "swing"),
        }
    }
}

#[test]
fn all_that_is_accepted_rests_and_moves_as_said() {
    let mut random = Random(3);
    let mut designs = [0; 3];
    for _ in 0..9 {
        let bar = random_bar(&mut random);
        let length = (40.0 + 100.0 * random.uniform()).round();
        let tasks = [
            ("lever", "swing", ""),
            ("slider", "stroke", ""),
            ("slot", "swing", "swing = 30"),
        ];
        for (k, (output, whole, more)) in tasks.into_iter().enumerate() {
            let task = format!("point = \"P\"\ndwell = {length}\noutput = \"{output}\"\n{more}");
            let result = found(&format!("{bar}{}", asked(&task)));
            designs[k] += result.designs.len();
            let measure = if output == "slider" {
                "travel"
            } else {
                "lever"
            };
            if !result.designs.is_empty() {
                assert_rests(&result, length, measure, whole);
            }
        }
    }
    assert!(designs.iter().all(|count| *count > 8), "{designs:?}");
}

/// An output of which much of its way falls into the rest is told, and not taken.
#[test]
fn what_moves_through_its_rest_is_rejected() {
    let text = r#"[links]
frame   = { A = [0, 0], D = [60, 0] }
crank   = { A-B = 20 }
coupler = { B-C = 50, P = [25, 10] }
rocker  = { D-C = 40 }
[drives]
motor = { turns = "crank", from = 0, to = 360, speed = "60 rpm" }
[assembly]
C = "left of B -> D"
"#;
    let result = found(&format!(
        "{HEAD}{text}{}",
        asked("point = \"P\"\ndwell = 100")
    ));
    let pairs = column(&result, "stir").into_iter();
    let mut pairs = pairs.zip(column(&result, "swing"));
    assert!(pairs.len() > 2 && pairs.all(|(stir, swing)| stir <= 0.1 * swing));
    let title = "found, but not accepted";
    let listing = result.listings.iter().find(|l| l.title == title);
    let reason = &listing.expect("a listing").rows[0][1];
    assert!(
        reason.starts_with("it does not rest: it moves by 43.0"),
        "{reason}"
    );
}

#[test]
fn a_drive_may_go_to_and_fro_or_straight() {
    // A crank that goes part of a turn: rests lie within its range.
    let part = SYMMETRIC.replace("from = 0, to = 360", "from = 60, to = 300");
    let result = found(&format!(
        "{HEAD}{part}{}",
        asked("point = \"P\"\ndwell = 135")
    ));
    assert!(!result.designs.is_empty());
    assert_rests(&result, 135.0, "lever", "swing");
    assert!(
        column(&result, "rest_from")
            .iter()
            .all(|from| (60.0..=165.0001).contains(from))
    );
    // A cylinder between the frame and the crank: the rest is a length.
    let pushed = SYMMETRIC
        .replace(
            "frame   = { A = [0, 0], ",
            "frame   = { A = [0, 0], E = [-100, -60], ",
        )
        .replace(
            "motor = { turns = \"crank\", from = 0, to = 360, speed = \"60 rpm\" }",
            "motor = { cylinder = \"E-B\", from = 90, to = 150, speed = \"10 mm/s\" }",
        );
    let pushed = format!(
        "{HEAD}{pushed}B = \"left of E -> A\"\n{}",
        asked("point = \"P\"\ndwell = \"30 mm\"")
    );
    let result = found(&pushed);
    assert!(!result.designs.is_empty());
    assert_rests(&result, 30.0, "lever", "swing");
}

#[test]
fn names_that_the_file_has_are_left_to_it() {
    let text = format!(
        "{HEAD}{}{}",
        SYMMETRIC
            .replace("crank   =", "rod = ")
            .replace("\"crank\"", "\"rod\""),
        "[measures]\nstir = \"angle(rocker)\"\nswing = \"range(stir)\"\n"
    );
    let result = found(&format!(
        "{text}{}",
        asked("point = \"P\"\ndwell = 135\nrank = \"swing2\"\ncolumns = [\"swing\", \"stir2\"]")
    ));
    assert!(!result.designs.is_empty());
    let file = &result.designs[0].file.toml;
    assert!(file.contains("rod2 = { P-Q = \"rod_length\" }"), "{file}");
    let own = column(&result, "swing");
    assert!(own.iter().all(|swing| (swing - own[0]).abs() < 1e-9));
    assert!(column(&result, "swing2").is_sorted());
}

#[test]
fn bad_requests_say_what_is_wrong() {
    let with = |task: &str| format!("{HEAD}{SYMMETRIC}{}", asked(task));
    for (task, wanted) in [
        ("point = \"D\"\ndwell = 60", "bad-choice"),
        ("point = \"B\"\ndwell = 60", "data-contradictory"),
        ("point = \"P\"\ndwell = 360", "data-out-of-range"),
        ("point = \"P\"\ndwell = 1000", "data-out-of-range"),
        ("point = \"P\"\ndwell = -3", "bad-size"),
        ("point = \"P\"\ndwell = \"3 mm\"", "unit-mismatch"),
        ("point = \"P\"", "missing-key"),
        ("dwell = 60", "missing-key"),
        (
            "point = \"P\"\ndwell = 60\noutput = \"slot\"",
            "missing-key",
        ),
        ("point = \"P\"\ndwell = 60\nstroke = 3", "bad-choice"),
        (
            "point = \"P\"\ndwell = 60\noutput = \"slider\"\nswing = 3",
            "bad-choice",
        ),
        (
            "point = \"P\"\ndwell = 60\noutput = \"slider\"\npivots_in = [[0, 0], [1, 1]]",
            "idle-key",
        ),
        (
            "point = \"P\"\ndwell = 60\noutput = \"wheel\"",
            "bad-choice",
        ),
        (
            "point = \"P\"\ndwell = 60\npivots_in = [[0, 0], [1, 1]]",
            "no-linkage",
        ),
        (
            "point = \"P\"\ndwell = 60\naccept = [\"stir >= 40 deg\"]",
            "none-accepted",
        ),
        (
            "point = \"P\"\ndwell = 60\nrank = \"torque(motor)\"",
            "needs-forces-study",
        ),
        (
            "point = \"P\"\ndwell = 60\nrank = \"stirr\"",
            "unknown-name",
        ),
    ] {
        let found = match wanted {
            // A warning of the reader.
            "idle-key" => {
                let text = with(task);
                let read = Model::from_toml(&text, "t", &mut |_| Err("no files".into()));
                read.expect("a model")
                    .warnings
                    .first()
                    .map_or("", |d| d.code)
            }
            _ => code(&with(task)),
        };
        assert_eq!(found, wanted, "{task}");
    }
    // What does not go through its range, and what has two drives that move.
    let beyond = SYMMETRIC.replace("A-B = 40", "A-B = 100");
    let beyond = beyond.replace("[120, 0]", "[220, 0]");
    assert_eq!(
        code(&format!(
            "{HEAD}{beyond}{}",
            asked("point = \"P\"\ndwell = 60")
        )),
        "not-reached"
    );
    let text = format!("{HEAD}{}", asked("point = \"P\"\ndwell = 60"));
    assert_eq!(code(&text), "missing-key");
}

/// What is joined to a pin may leave a measure of the file without its meaning: it is told which.
#[test]
fn a_measure_that_loses_its_meaning_is_named() {
    let watt = include_str!("../../../../examples/gallery/watt-i.toml");
    let text = format!("{watt}{}", asked("point = \"F\"\ndwell = 60"));
    let told = tried(&text).expect_err("three links meet at F");
    assert_eq!(told[0].code, "ambiguous-transmission");
    let line = "where it says `gamma_f = \"transmission_angle(F)\"`";
    assert!(
        told[0].notes.iter().any(|note| note == line),
        "{:?}",
        told[0].notes
    );
    let named = text.replace("transmission_angle(F)", "transmission_angle(F, E, G)");
    assert!(!found(&named).designs.is_empty());
}
