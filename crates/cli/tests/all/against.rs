//! Two designs beside each other: what `kempe run --against` leaves, tells and refuses.

use std::fs;
use std::path::Path;

use crate::support::{MODEL, folder, kempe, names, said};
use serde_json::Value;

/// A column of a CSV file without quotes, by its head.
fn column(path: &Path, head: &str) -> Vec<f64> {
    let text = fs::read_to_string(path).expect("text");
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let heads = lines.next().expect("a head");
    let index = heads.iter().position(|h| *h == head).expect("a column");
    lines
        .map(|row| row[index].parse().unwrap_or(f64::NAN))
        .collect()
}

/// The rows of a comparison, by their kind and name.
fn line(path: &Path, kind: &str, name: &str) -> Vec<String> {
    let text = fs::read_to_string(path).expect("text");
    let mut lines = text
        .lines()
        .map(|l| l.split(',').map(str::to_owned).collect::<Vec<_>>());
    let found = lines.find(|fields| fields[1] == kind && fields[2] == name);
    found.unwrap_or_else(|| panic!("no {kind} {name}: {text}"))
}

fn number(field: &str) -> f64 {
    field.parse().expect("a number")
}

#[test]
fn both_designs_are_written_and_their_differences_are_those_of_their_tables() {
    let folder = folder();
    let at = folder.path();
    for out in ["one", "two"] {
        let ran = kempe(
            at,
            &["run", "m.toml", "--against-set", "a=25mm", "--out", out],
        );
        assert!(ran.status.success(), "{}", said(&ran));
    }
    let files = [
        "comparison.csv",
        "report.html",
        "turn-mechanism.svg",
        "turn-path-P.svg",
        "turn-swing.svg",
        "turn.against.csv",
        "turn.against.parquet",
        "turn.csv",
        "turn.parquet",
    ];
    assert_eq!(names(&at.join("one")), files);
    for file in files {
        let [one, two] = ["one", "two"].map(|out| fs::read(at.join(out).join(file)).expect("read"));
        assert_eq!(one, two, "{file}");
    }
    // each design's table is what it gives alone
    for (out, set) in [("small", "a=20mm"), ("large", "a=25mm")] {
        assert!(
            kempe(at, &["run", "m.toml", "--set", set, "--out", out])
                .status
                .success()
        );
    }
    for (file, alone) in [("turn.csv", "small"), ("turn.against.csv", "large")] {
        let both = fs::read(at.join("one").join(file)).expect("a file");
        assert_eq!(
            both,
            fs::read(at.join(alone).join("turn.csv")).expect("a file"),
            "{file}"
        );
    }
    let comparison = at.join("one/comparison.csv");
    for (kind, better) in [
        ("smallest", f64::min as fn(f64, f64) -> f64),
        ("largest", f64::max),
    ] {
        let best = |file: &str| {
            let path = at.join("one").join(file);
            let (values, motor) = (column(&path, "swing [deg]"), column(&path, "motor [deg]"));
            let value = values.iter().copied().fold(f64::NAN, better);
            let row = values.iter().position(|v| *v == value).expect("a row");
            (value, motor[row])
        };
        let (this, against) = (best("turn.csv"), best("turn.against.csv"));
        let told = line(&comparison, kind, "swing");
        assert_eq!(told[3], "deg");
        assert_eq!([number(&told[4]), number(&told[5])], [this.0, against.0]);
        assert_eq!(number(&told[6]), this.0 - against.0);
        assert_eq!([number(&told[9]), number(&told[12])], [this.1, against.1]);
    }
    assert_eq!(number(&line(&comparison, "parameter", "a")[6]), -5.0);
    // pictures have both
    for picture in ["turn-swing.svg", "turn-path-P.svg"] {
        let svg = fs::read_to_string(at.join("one").join(picture)).expect("text");
        assert!(
            svg.contains(">this</text>") && svg.contains(">against</text>"),
            "{picture}"
        );
    }
    let svg = fs::read_to_string(at.join("one/turn-mechanism.svg")).expect("text");
    assert!(svg.contains("class=\"other\"") && svg.contains("m.toml with a=25mm"));
}

#[test]
fn another_file_in_other_units_is_no_other_design() {
    let folder = folder();
    let at = folder.path();
    let inches = MODEL
        .replace("length = \"mm\"", "length = \"cm\"")
        .replace("\"20 mm\"", "\"2 cm\"")
        .replace("[60, 0]", "[6, 0]")
        .replace("B-C = 50, P = [25, 0]", "B-C = 5, P = [2.5, 0]")
        .replace("D-C = 40", "D-C = 4");
    fs::write(at.join("cm.toml"), inches).expect("written");
    let ran = kempe(
        at,
        &["run", "m.toml", "--against", "cm.toml", "--out", "out"],
    );
    assert!(ran.status.success(), "{}", said(&ran));
    let told = String::from_utf8_lossy(&ran.stdout).into_owned();
    assert!(told.contains("nothing differs"), "{told}");
    let report = fs::read_to_string(at.join("out/report.html")).expect("text");
    assert!(report.contains("The other model: cm.toml"));
}

/// `--set` is of this design alone, but where the other one is this file with other values.
#[test]
fn the_other_design_has_the_values_that_are_its_own() {
    let folder = folder();
    let at = folder.path();
    fs::write(
        at.join("b.toml"),
        MODEL.replace("[parameters]", "[parameters]\nb = \"1 mm\""),
    )
    .expect("written");
    let parameters = |arguments: &[&str]| -> Vec<(String, Value, Value)> {
        let ran = kempe(at, &[&["run", "b.toml", "--json"], arguments].concat());
        let value: Value = serde_json::from_slice(&ran.stdout).expect("JSON");
        let pairs = value["comparison"]["parameters"]
            .as_array()
            .expect("a list")
            .clone();
        let told = pairs.iter().map(|p| {
            let name = p["name"].as_str().expect("a name").to_owned();
            (name, p["this"].clone(), p["against"].clone())
        });
        told.collect()
    };
    let set = ["--set", "b=2mm", "--against-set", "a=25mm"];
    assert_eq!(
        parameters(&set),
        [("a".to_owned(), 20.0.into(), 25.0.into())]
    );
    let own = ["--set", "b=2mm", "--against", "b.toml"];
    assert_eq!(parameters(&own), [("b".to_owned(), 2.0.into(), 1.0.into())]);
    let over = ["--set", "a=19mm", "--against-set", "a=25mm"];
    assert_eq!(
        parameters(&over),
        [("a".to_owned(), 19.0.into(), 25.0.into())]
    );
    let both = ["--against", "m.toml", "--against-set", "a=25mm"];
    assert_eq!(
        parameters(&both),
        [
            ("b".to_owned(), 1.0.into(), Value::Null),
            ("a".to_owned(), 20.0.into(), 25.0.into())
        ]
    );
}

#[test]
fn a_design_that_cannot_run_does_not_lose_the_other() {
    let folder = folder();
    let at = folder.path();
    let ran = kempe(
        at,
        &["run", "m.toml", "--against-set", "a=75mm", "--out", "out"],
    );
    assert_eq!(ran.status.code(), Some(3));
    let told = said(&ran);
    assert!(
        told.contains("range-beyond-limit")
            && told.contains("of the other design, m.toml with a=75mm"),
        "{told}"
    );
    let out = at.join("out");
    assert!(out.join("report.html").exists() && out.join("turn.csv").exists());
    assert!(!out.join("turn.against.csv").exists());
    let table = fs::read_to_string(out.join("comparison.csv")).expect("text");
    assert!(
        table.contains("it could not run in the other design"),
        "{table}"
    );
    let report = fs::read_to_string(out.join("report.html")).expect("text");
    assert!(report.contains("of the other design, m.toml with a=75mm"));
    // with both the wrong way round nothing is written, as without a comparison
    let ran = kempe(
        at,
        &[
            "run",
            "m.toml",
            "--set",
            "a=75mm",
            "--against",
            "m.toml",
            "--out",
            "none",
        ],
    );
    assert_eq!(ran.status.code(), Some(3));
    assert!(!at.join("none").exists());
}

#[test]
fn what_cannot_be_compared_is_told_before_the_work() {
    let folder = folder();
    let at = folder.path();
    fs::write(
        at.join("bad.toml"),
        MODEL.replace("\"20 mm\"", "\"20 deg\""),
    )
    .expect("written");
    fs::write(
        at.join("studies.toml"),
        MODEL.replace("[studies.turn]", "[studies.spin]"),
    )
    .expect("written");
    for (arguments, words) in [
        (
            &["--against", "m.toml"][..],
            &["nothing-to-compare", "= help"][..],
        ),
        (
            &["--set", "a=19mm", "--against-set", "a=19mm"],
            &["nothing-to-compare", "with a=19mm"],
        ),
        (
            &["--against-set", "aa=19mm"],
            &["unknown-name", "--against-set", "did you mean `a`?"],
        ),
        (
            &["--against-set", "a=19"],
            &["--against-set a", "of the other design"],
        ),
        (
            &["--against-set", "a=-19mm"],
            &["of the other design", "= help"],
        ),
        (
            &["--against-set", "a=1mm", "--against-set", "a=2mm"],
            &["over-specified"],
        ),
        (
            &["--against", "n.toml"],
            &["no-file", "there is no file n.toml", "= help"],
        ),
        (
            &["--against", "bad.toml"],
            &["unit-mismatch", "bad.toml:", "of the other design"],
        ),
    ] {
        let ran = kempe(
            at,
            &[&["run", "m.toml", "--out", "out"], arguments].concat(),
        );
        let told = said(&ran);
        assert_eq!(ran.status.code(), Some(2), "{arguments:?}: {told}");
        assert!(
            words.iter().all(|word| told.contains(word)),
            "{arguments:?}: {told}"
        );
        assert!(!at.join("out").exists(), "{arguments:?}");
    }
    let ran = kempe(at, &["run", "m.toml", "--against", "studies.toml"]);
    assert_eq!(ran.status.code(), Some(1));
    assert!(said(&ran).contains("nothing-to-compare"), "{}", said(&ran));
    let told = String::from_utf8_lossy(&ran.stdout).into_owned();
    assert!(
        told.contains("there is no such study in the other design"),
        "{told}"
    );
    assert!(
        told.contains("there is no such study in this design"),
        "{told}"
    );
}

#[test]
fn nothing_of_others_is_replaced_by_a_comparison() {
    let folder = folder();
    let at = folder.path();
    fs::create_dir(at.join("out")).expect("a folder");
    for mine in ["comparison.csv", "turn.against.csv"] {
        fs::write(at.join("out").join(mine), "mine").expect("written");
        let ran = kempe(
            at,
            &["run", "m.toml", "--against-set", "a=25mm", "--out", "out"],
        );
        assert_eq!(ran.status.code(), Some(2));
        assert!(said(&ran).contains("file-exists"), "{}", said(&ran));
        assert_eq!(names(&at.join("out")), [mine]);
        fs::remove_file(at.join("out").join(mine)).expect("removed");
    }
    // the other design's file is read
    fs::write(at.join("turn.csv"), MODEL).expect("written");
    let ran = kempe(
        at,
        &[
            "run",
            "m.toml",
            "--against",
            "turn.csv",
            "--against-set",
            "a=25mm",
            "--out",
            ".",
        ],
    );
    assert!(said(&ran).contains("own-input"), "{}", said(&ran));
}

#[test]
fn a_study_may_be_called_comparison() {
    let folder = folder();
    let at = folder.path();
    fs::write(
        at.join("c.toml"),
        MODEL.replace("[studies.turn]", "[studies.comparison]"),
    )
    .expect("written");
    let ran = kempe(
        at,
        &["run", "c.toml", "--against-set", "a=25mm", "--out", "out"],
    );
    assert!(ran.status.success(), "{}", said(&ran));
    let all = names(&at.join("out"));
    assert!(all.contains(&"report.comparison.csv".to_owned()), "{all:?}");
    assert_eq!(
        column(&at.join("out/comparison.csv"), "swing [deg]").len(),
        37
    );
}

/// The page about it shows what is printed.
#[test]
fn the_page_shows_what_is_printed() {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/compare.md");
    let text = fs::read_to_string(page).expect("the page");
    let block = |start: &str| {
        let (_, rest) = text.split_once(start).expect("a block");
        rest.split_once("```").expect("its end").0.to_owned()
    };
    let folder = folder();
    let at = folder.path();
    fs::write(at.join("rocker.toml"), block("```toml\n")).expect("written");
    let shown = block("```\n$ kempe ");
    let (command, expected) = shown.split_once('\n').expect("a command");
    let ran = kempe(at, &command.split(' ').collect::<Vec<_>>());
    assert_eq!(said(&ran), "");
    // how well loops close is the last digits' business
    let plain = |text: &str| -> Vec<String> {
        let cut = |line: &str| {
            line.split(", loops closed to")
                .next()
                .unwrap_or("")
                .to_owned()
        };
        text.lines().map(cut).collect()
    };
    assert_eq!(
        plain(&String::from_utf8_lossy(&ran.stdout)),
        plain(expected)
    );
}
