//! Whatever command reads a file, it says the same of its mechanism, and ends with the same code.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn kempe(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_kempe"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("kempe runs")
}

/// A four-bar with other lengths, another range and another assembly.
fn four_bar(coupler: &str, motor: &str, assembly: &str) -> String {
    format!(
        "units = {{ length = \"mm\", angle = \"deg\" }}\n\
         [parameters]\na = \"20 mm\"\n\
         [links]\nframe = {{ A = [0, 0], D = [60, 0] }}\ncrank = {{ A-B = \"a\" }}\n\
         coupler = {{ {coupler} }}\nrocker = {{ D-C = 40 }}\n\
         [drives]\nmotor = {{ turns = \"crank\", {motor}, speed = \"1 rad/s\" }}\n\
         [assembly]\n{assembly}\n[measures]\nswing = \"angle(rocker)\"\n"
    )
}

const TURN: &str = "from = 0, to = 360";
const LEFT: &str = "C = \"left of B -> D\"";

/// What each file is, what is to be told of it, and the code with which `check` and `run` end.
fn cases() -> Vec<(&'static str, String, Vec<&'static str>, i32)> {
    let plain = four_bar("B-C = 50", TURN, LEFT);
    vec![
        ("nothing to tell", plain.clone(), vec![], 0),
        (
            "an open choice",
            four_bar("B-C = 50", TURN, ""),
            vec!["several-assemblies"],
            1,
        ),
        (
            "a hint that is missed",
            four_bar("B-C = 50", TURN, "rocker = { near = \"200 deg\" }"),
            vec!["hint-missed"],
            1,
        ),
        (
            "an open chain",
            four_bar("B-E = 50", TURN, ""),
            vec!["idle-freedom"],
            1,
        ),
        (
            "a limit",
            four_bar("B-C = 25", TURN, LEFT),
            vec!["range-beyond-limit"],
            3,
        ),
        (
            "two drives that meet a limit",
            "units = { length = \"mm\", angle = \"deg\" }\n\
             [links]\nframe = { A = [0, 0], D = [60, 0] }\na = { A-B = 20 }\nd = { D-E = 20 }\n\
             b = { B-C = 30 }\nc = { E-C = 30 }\n\
             [drives]\nm = { turns = \"a\", from = 60, to = 200, speed = 10 }\n\
             n = { turns = \"d\", from = 120, to = -20, speed = 10 }\n\
             [assembly]\nC = \"left of B -> E\"\n[parameters]\nl = 1\n[measures]\nx = \"x(C)\"\n"
                .to_owned(),
            vec!["range-beyond-limit"],
            3,
        ),
        (
            "special dimensions",
            "units = { length = \"mm\", angle = \"deg\" }\n\
             [links]\nframe = { A = [0, 0], D = [60, 0], G = [30, 0] }\ncrank = { A-B = 20 }\n\
             coupler = { B = [0, 0], C = [60, 0], E = [30, 0] }\nrocker = { D-C = 20 }\nmiddle = { G-E = 20 }\n\
             [drives]\nmotor = { turns = \"crank\", from = 10, to = 80, speed = 10 }\n\
             [assembly]\nC = { near = [80, 5] }\n[parameters]\nl = 1\n[measures]\nx = \"x(C)\"\n"
                .to_owned(),
            vec!["overconstrained"],
            1,
        ),
        (
            "a derivative that is not there",
            plain.replace("angle(rocker)", "rate(rate(rate(rate(rate(rate(x(C)))))))"),
            vec!["not-measurable"],
            3,
        ),
    ]
}

/// The codes that a command tells.
fn told(output: &Output) -> Vec<String> {
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    let lines = text.lines().filter_map(|line| {
        let line = line
            .strip_prefix("warning[")
            .or_else(|| line.strip_prefix("error["))?;
        Some(line.split(']').next()?.to_owned())
    });
    let mut codes: Vec<String> = lines.collect();
    codes.sort();
    codes
}

#[test]
fn every_command_says_the_same_of_a_mechanism() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    for (what, text, codes, code) in cases() {
        fs::write(at.join("m.toml"), text).expect("written");
        let checked = kempe(at, &["check", "m.toml"]);
        assert_eq!(told(&checked), codes, "{what}: check");
        assert_eq!(checked.status.code(), Some(code), "{what}: check");

        let ran = kempe(at, &["run", "m.toml", "--out", "out"]);
        assert_eq!(ran.status.code(), Some(code), "{what}: run");
        let known = told(&ran);
        for code in &codes {
            assert!(
                known.iter().any(|c| c == code),
                "{what}: run tells {known:?}"
            );
        }
        // What the report says stands in it, and above everything else.
        if let Ok(report) = fs::read_to_string(at.join("out/report.html")) {
            for code in &codes {
                assert!(report.contains(code), "{what}: the report lacks {code}");
            }
            fs::remove_dir_all(at.join("out")).expect("removed");
        }

        let drawn = kempe(at, &["draw", "m.toml", "-o", "m.svg"]);
        // A picture of the pose there is whatever the motion lacks: at most a warning.
        assert_eq!(drawn.status.code(), Some(code.min(1)), "{what}: draw");
        let known = told(&drawn);
        for code in &codes {
            assert!(
                known.iter().any(|c| c == code),
                "{what}: draw tells {known:?}"
            );
        }

        let derived = kempe(at, &["sensitivities", "m.toml"]);
        if codes != ["not-measurable"] {
            assert_eq!(told(&derived), codes, "{what}: sensitivities");
            assert_eq!(derived.status.code(), Some(code), "{what}: sensitivities");
        }

        // Strictly, whatever is told is an error, and nothing is written.
        fs::remove_file(at.join("m.svg")).expect("drawn");
        for arguments in [
            vec!["check", "m.toml", "--strict"],
            vec!["run", "m.toml", "--strict", "--out", "out"],
            vec!["draw", "m.toml", "--strict", "-o", "m.svg"],
        ] {
            let strict = kempe(at, &arguments);
            let expected = if codes.is_empty() { 0 } else { 3 };
            assert_eq!(
                strict.status.code(),
                Some(expected),
                "{what}: {arguments:?}"
            );
        }
        assert_eq!(at.join("out").exists(), codes.is_empty(), "{what}");
        assert_eq!(at.join("m.svg").exists(), codes.is_empty(), "{what}");
        let _ = fs::remove_dir_all(at.join("out"));
        let _ = fs::remove_file(at.join("m.svg"));
    }
}

#[test]
fn nothing_is_said_twice() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let studies = "[studies.a]\nkind = \"motion\"\n[studies.b]\nkind = \"motion\"\nstep = 5\n";
    let text = four_bar("B-C = 50", TURN, "") + studies;
    fs::write(at.join("m.toml"), text).expect("written");
    assert_eq!(told(&kempe(at, &["run", "m.toml"])), ["several-assemblies"]);
}

/// Whatever goes wrong, `--json` prints one JSON object with what is told.
#[test]
fn json_is_printed_on_errors_too() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    fs::write(at.join("bad.toml"), "links = [").expect("written");
    fs::write(at.join("good.toml"), four_bar("B-C = 50", TURN, LEFT)).expect("written");
    for arguments in [
        vec!["check", "no-such-file.toml", "--json"],
        vec!["check", "bad.toml", "--json"],
        vec!["run", "bad.toml", "--json"],
        vec!["run", "good.toml", "no_such_study", "--json"],
        vec!["run", "good.toml", "--set", "nothing=1", "--json"],
        vec!["run", "good.toml", "--json", "--no-such-option"],
        vec!["run", "--json"],
        vec!["sensitivities", "good.toml", "--at", "moto=1", "--json"],
        vec!["verify", "no-such-folder", "--json"],
        vec!["measures", "no_such_measure", "--json"],
    ] {
        let output = kempe(at, &arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let value: serde_json::Value =
            serde_json::from_slice(&output.stdout).unwrap_or_else(|e| panic!("{arguments:?}: {e}"));
        let told = value["diagnostics"].as_array().expect("a list");
        assert!(!told.is_empty(), "{arguments:?}");
        for diagnostic in told {
            assert!(diagnostic["code"].is_string() && diagnostic["message"].is_string());
        }
    }
}

/// A number that is infinite is so for whoever asks: a study, a circuit and its derivatives.
#[test]
fn every_command_says_where_a_number_is_infinite() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let text = four_bar("B-C = 50", TURN, LEFT)
        + "most = \"max(mechanical_advantage(angle(rocker), motor))\"\n\
           pole = \"max(1/cos(motor))\"\n[studies.s]\nkind = \"motion\"\nrows = 7\n";
    fs::write(at.join("m.toml"), &text).expect("written");
    let circuit = text.replace("rows = 7", "rows = 7\ncircuit = true");
    fs::write(at.join("c.toml"), circuit).expect("written");
    for arguments in [
        ["run", "m.toml"],
        ["run", "c.toml"],
        ["sensitivities", "m.toml"],
    ] {
        let output = kempe(at, &arguments);
        let codes = told(&output);
        assert!(
            codes.iter().any(|c| c == "infinite"),
            "{arguments:?}: {codes:?}"
        );
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
    }
    let derived = kempe(at, &["sensitivities", "m.toml"]);
    let text = String::from_utf8_lossy(&derived.stdout).into_owned();
    for name in ["most", "pole"] {
        assert!(text.contains(&format!("{name}: left out")), "{text}");
    }
}
