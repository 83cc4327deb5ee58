//! What people are told of common mistakes, by the program as they meet it.

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

/// What a command says of a model file, on both streams, and the code with which it ends.
fn said(text: &str, arguments: &[&str]) -> (String, Option<i32>) {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("m.toml"), text).expect("written");
    let output = kempe(folder.path(), arguments);
    let both = [output.stdout, output.stderr].concat();
    (
        String::from_utf8_lossy(&both).into_owned(),
        output.status.code(),
    )
}

fn four_bar(links: &str, rest: &str) -> String {
    format!(
        "units = {{ length = \"mm\" }}\n[links]\nframe = {{ A = [0, 0], D = [60, 0] }}\ncrank = {{ A-B = 20 }}\n{links}\n\
         [drives]\nmotor = {{ turns = \"crank\", from = 0, to = 90, speed = \"1 rad/s\" }}\n{rest}"
    )
}

const WHOLE: &str = "coupler = { B-C = 50 }\nrocker = { D-C = 40 }";

#[test]
fn a_pin_that_is_misspelt_once_is_asked_for_by_its_name() {
    let links = WHOLE.replace("D-C", "D1-C");
    let (text, code) = said(&four_bar(&links, ""), &["check", "m.toml"]);
    assert!(
        text.contains("D1 is on no other link") && text.contains("did you mean D?"),
        "{text}"
    );
    assert!(
        text.contains("m.toml:6:12") && !text.contains("add one"),
        "{text}"
    );
    assert_eq!(code, Some(3));
    // a mechanism that moves all the same
    let links = "coupler = { B-C2 = 50 }\nrocker = { D-C1 = 40 }";
    let (text, code) = said(&four_bar(links, ""), &["check", "m.toml"]);
    assert!(
        text.contains("idle-freedom") && text.contains("C2 is on no other link"),
        "{text}"
    );
    assert!(text.contains("did you mean C1?"), "{text}");
    assert_eq!(code, Some(1));
    // no name is near another
    let links = WHOLE.replace("D-C", "D-E");
    let (text, _) = said(&four_bar(&links, ""), &["check", "m.toml"]);
    assert!(
        text.contains("C on `coupler`; E on `rocker`") && text.contains("name it alike"),
        "{text}"
    );
}

#[test]
fn no_command_lets_a_text_reach_the_terminal_that_it_obeys() {
    let title = "title = \"\\u001b[2Jpwn\\u0007\\u009b\\u202e\"\n";
    let studies = "[assembly]\nC = \"left of B -> D\"\n[parameters]\na = 1\n[measures]\nm = \"x(C)\"\n[studies.turn]\nkind = \"motion\"\nrows = 3\n";
    let text = title.to_owned() + &four_bar(WHOLE, studies);
    let wrong = text.replace("x(C)", "x(\\u001b[31mC)");
    for text in [&text, &wrong] {
        for command in ["check", "run", "draw", "sensitivities"] {
            for json in [&["--json"][..], &[]] {
                let arguments = [&[command, "m.toml"], json].concat();
                let (said, _) = said(text, &arguments);
                let obeyed =
                    |c: char| (c.is_control() && c != '\n' && c != '\t') || c == '\u{202e}';
                assert!(!said.contains(obeyed), "{arguments:?}: {said:?}");
            }
        }
    }
    let (plain, _) = said(&text, &["check", "m.toml"]);
    assert!(plain.contains("\\u{1b}[2Jpwn"), "{plain}");
    let (json, _) = said(&text, &["check", "m.toml", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(json["title"], "\u{1b}[2Jpwn\u{7}\u{9b}\u{202e}");
}

#[test]
fn what_sensitivities_lack_is_named_and_is_the_files_mistake() {
    let assembly = "[assembly]\nC = \"left of B -> D\"\n";
    for (rest, lacks) in [
        ("[measures]\nm = \"x(C)\"\n", "has no [parameters]\n"),
        ("[parameters]\na = 1\n", "has no [measures]\n"),
        ("", "has no [measures] and no [parameters]\n"),
    ] {
        let text = four_bar(WHOLE, &format!("{assembly}{rest}"));
        let (text, code) = said(&text, &["sensitivities", "m.toml"]);
        assert!(text.contains(lacks), "{text}");
        assert_eq!(code, Some(2));
    }
}

#[test]
fn a_motion_with_numbers_only_tabulates_where_everything_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let rest = "[assembly]\nC = \"left of B -> D\"\n[measures]\nswing = \"range(angle(rocker))\"\n[studies.turn]\nkind = \"motion\"\nrows = 3\n";
    fs::write(folder.path().join("m.toml"), four_bar(WHOLE, rest)).expect("written");
    kempe(folder.path(), &["run", "m.toml", "--out", "out"]);
    let table = fs::read_to_string(folder.path().join("out/turn.csv")).expect("a table");
    assert!(
        table.contains("x(C)") && table.contains("angle(rocker)"),
        "{table}"
    );
}

#[test]
fn what_is_taken_for_granted_is_told() {
    let text = "[links]\nframe = { A = [0, 0], P = [3, 0], Q = [5, 0] }\ncrank = { A-B = 1 }\nrod = { B-C = 3 }\n\
                [joints]\nguide = { pin = \"C\", on = \"P -> Q\" }\n\
                [drives]\nmotor = { turns = \"crank\", from = 0, to = 90, speed = \"1 rad/s\" }\n[assembly]\nC = { near = [4, 0] }\n";
    let (text, _) = said(text, &["check", "m.toml"]);
    assert!(text.contains("`guide` without ends"), "{text}");
    let belt = "[links]\nframe = { A = [0, 0], D = [10, 0] }\ncrank = { A = [0, 0] , B = [1, 0] }\nwheel = { D = [0, 0], E = [1, 0] }\n\
                [joints]\nband = { belt = [\"crank\", \"wheel\"], radii = [1, 2] }\n\
                [drives]\nmotor = { turns = \"crank\", from = 0, to = 90, speed = \"1 rad/s\" }\n";
    let (text, _) = said(belt, &["check", "m.toml"]);
    assert!(
        text.contains("belt wheel") && !text.contains("gear"),
        "{text}"
    );
}
