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

#[test]
fn a_file_in_the_way_of_what_is_looked_for_is_told_before_the_search() {
    let folder = folder();
    let at = folder.path();
    // More designs than anybody waits for: were they looked at first, this test would not end.
    let search = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\na = \"30 mm\"\nb = \"80 mm\"\n[links]\nframe = { O = [0, 0], C = [100, 0] }\n\
         crank = { O-A = \"a\" }\ncoupler = { A-B = \"b\" }\nrocker = { B-C = 70 }\n[drives]\nmotor = { turns = \"crank\", from = 0, to = 360, speed = 1 }\n\
         [assembly]\nB = { near = [90, 70] }\n[studies.turn]\nkind = \"motion\"\n[studies.best]\nkind = \"optimize\"\nover = \"turn\"\n\
         vary = { a = [\"20 mm\", \"35 mm\"], b = [\"70 mm\", \"90 mm\"] }\nmaximize = \"range(angle(rocker))\"\nmethod = \"differential evolution\"\ndesigns = 100000000\n";
    fs::write(at.join("best.toml"), search).expect("written");
    fs::create_dir_all(at.join("out/best")).expect("made");
    fs::write(at.join("out/best/01.toml"), "mine").expect("written");
    let output = kempe(at, &["run", "best.toml", "--out", "out"]);
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    let said = said(&output);
    assert!(
        said.contains("file-exists") && said.contains("01.toml"),
        "{said}"
    );
    assert_eq!(
        fs::read(at.join("out/best/01.toml")).expect("mine"),
        b"mine"
    );
}

/// A table that the model names goes with every design that is found, and stands beside them once.
#[test]
fn designs_share_a_table() {
    let folder = folder();
    let at = folder.path();
    let table = "t [s],angle [deg]\n0,30\n0.2,30\n0.4,30\n0.6,80\n0.8,110\n1.0,110\n1.2,110\n1.4,60\n1.6,30\n";
    fs::write(at.join("law.csv"), table).expect("written");
    let model = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\na = \"20 mm\"\n\
        [links]\nframe = { A = [0, 0], D = [60, 0] }\ncrank = { A-B = \"a\" }\ncoupler = { B-C = 50 }\nrocker = { D-C = 40 }\n\
        [assembly]\nC = \"left of B -> D\"\n\
        [drives]\nmotor = { turns = \"crank\", law = { table = \"law.csv\", time = \"t\", value = \"angle\" } }\n\
        [studies.turn]\nkind = \"motion\"\n\
        [studies.best]\nkind = \"optimize\"\nover = \"turn\"\nvary = { a = [\"12 mm\", \"25 mm\"] }\n\
        minimize = [\"range(angle(rocker))\", \"-max(x(C))\"]\ndesigns = 60\n";
    fs::write(at.join("m.toml"), model).expect("written");
    let output = kempe(at, &["run", "m.toml", "best", "--out", "out"]);
    let told = said(&output);
    assert!(at.join("out/best/02.toml").exists(), "{told}");
    for design in ["01.toml", "02.toml"] {
        let checked = kempe(&at.join("out/best"), &["check", design]);
        assert!(checked.status.success(), "{}", said(&checked));
    }
}
