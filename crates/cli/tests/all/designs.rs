//! Mechanisms that a study finds, as files: whole, in a folder of their own, and none left from an earlier run.

use std::fs;
use std::path::Path;

use crate::support::{folder, kempe, names, said};

const FIVE: &str = "title = \"Generators\"\nunits = { length = \"mm\", angle = \"deg\" }\n[studies.five]\nkind = \"synthesize\"\ntask = \"function\"\n\
    zeros = [\"free\", \"free\"]\nfunction = { y = \"x^1.5\", x = [1, 4], input = [0, 90], output = [0, 90], points = 5 }\nground = 40\n";

fn ran(at: &Path, arguments: &[&str]) -> String {
    let output = kempe(at, arguments);
    let said = said(&output);
    assert!(output.status.success(), "{arguments:?}: {said}");
    said
}

#[test]
fn linkages_found_are_models_that_run() {
    let folder = folder();
    let at = folder.path();
    fs::write(at.join("five.toml"), FIVE).expect("written");
    ran(at, &["run", "five.toml", "--out", "out"]);
    let found = names(&at.join("out/five"));
    assert_eq!(
        found,
        [
            "01.svg", "01.toml", "02.svg", "02.toml", "03.svg", "03.toml"
        ]
    );
    for number in ["01", "02", "03"] {
        let file = format!("out/five/{number}.toml");
        ran(at, &["check", &file]);
        ran(at, &["run", &file, "--out", &format!("moved-{number}")]);
        ran(at, &["draw", &file, "--output", "picture.svg"]);
    }
    let page = fs::read_to_string(at.join("out/report.html")).expect("a report");
    for part in ["five: side by side", "01: ground 40 mm, crank", "five-03"] {
        assert!(page.contains(part), "{part}");
    }
}

#[test]
fn what_an_earlier_run_found_goes_unless_somebody_changed_it() {
    let folder = folder();
    let at = folder.path();
    fs::write(at.join("five.toml"), FIVE).expect("written");
    ran(at, &["run", "five.toml", "--out", "out"]);
    let own = "title = \"mine\"\n";
    fs::write(at.join("out/five/02.toml"), own).expect("written");
    fs::write(at.join("out/five/notes.txt"), "mine").expect("written");
    fs::write(at.join("five.toml"), format!("{FIVE}keep = 1\n")).expect("written");
    ran(at, &["run", "five.toml", "--out", "out"]);
    assert_eq!(
        names(&at.join("out/five")),
        ["01.svg", "01.toml", "02.toml", "notes.txt"]
    );
    assert_eq!(
        fs::read_to_string(at.join("out/five/02.toml")).expect("mine"),
        own
    );
    // what somebody changed is not replaced either
    fs::write(at.join("five.toml"), FIVE).expect("written");
    let output = kempe(at, &["run", "five.toml", "--out", "out"]);
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert!(said(&output).contains("02.toml"), "{}", said(&output));
    assert_eq!(
        names(&at.join("out/five")),
        ["01.svg", "01.toml", "02.toml", "notes.txt"]
    );
}

#[test]
fn a_file_in_the_place_of_their_folder_is_told() {
    let folder = folder();
    let at = folder.path();
    fs::write(at.join("five.toml"), FIVE).expect("written");
    fs::create_dir(at.join("out")).expect("made");
    fs::write(at.join("out/five"), "mine").expect("written");
    let output = kempe(at, &["run", "five.toml", "--out", "out"]);
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert_eq!(names(&at.join("out")), ["five"]);
}

#[test]
fn scripts_get_the_files_without_a_folder() {
    let folder = folder();
    let at = folder.path();
    fs::write(at.join("five.toml"), FIVE).expect("written");
    let output = kempe(at, &["run", "five.toml", "--json"]);
    let value: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let designs = value["studies"][0]["designs"].as_array().expect("designs");
    assert_eq!(designs.len(), 3);
    let text = designs[0]["model"].as_str().expect("a model");
    fs::write(at.join("one.toml"), text).expect("written");
    ran(at, &["run", "one.toml"]);
}
