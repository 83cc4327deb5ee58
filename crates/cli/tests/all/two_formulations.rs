//! An example simulated in minimal coordinates and in those of a spanning tree: one table, two ways to it.

use std::fs;
use std::path::Path;
use std::process::Output;

use crate::support::{folder, kempe, said};

/// The columns of a table by their heads, of which some have commas in quotes.
fn table(path: &Path) -> (Vec<String>, Vec<Vec<f64>>) {
    let text = fs::read_to_string(path).expect("a table");
    let mut lines = text.lines();
    let (mut head, mut quoted) = (vec![String::new()], false);
    for letter in lines.next().expect("a head").chars() {
        match letter {
            '"' => quoted = !quoted,
            ',' if !quoted => head.push(String::new()),
            _ => head.last_mut().expect("a column").push(letter),
        }
    }
    let cell = |cell: &str| cell.parse().unwrap_or(f64::NAN);
    let row = |line: &str| line.split(',').map(cell).collect();
    (head, lines.map(row).collect())
}

#[test]
fn a_spanning_tree_tells_the_same_motion_and_says_that_it_did() {
    let folder = folder();
    let at = folder.path();
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/benchmarks");
    let text = fs::read_to_string(examples.join("andrews.toml")).expect("an example");
    let kind = "kind    = \"simulate\"";
    assert!(text.contains(kind));
    let with = text.replace(kind, &format!("{kind}\ncoordinates = \"spanning-tree\""));
    for (name, text) in [("minimal", &text), ("tree", &with)] {
        fs::write(at.join(format!("{name}.toml")), text).expect("written");
    }
    let run = |name: &str| kempe(at, &["run", &format!("{name}.toml"), "--out", name]);
    let (minimal, tree) = (run("minimal"), run("tree"));
    assert!(minimal.status.success() && tree.status.success());
    let told = |output: &Output| String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(told(&minimal).contains("minimal coordinates, explicit"));
    let told = told(&tree);
    assert!(
        told.contains("7 coordinates of a spanning tree with 6 ties, explicit"),
        "{told}"
    );
    assert!(told.contains("closed in every state"), "{told}");
    let [(head, one), (other, two)] =
        ["minimal", "tree"].map(|name| table(&at.join(name).join("squeeze.csv")));
    assert_eq!(head, other);
    let check = kempe(at, &["check", "tree.toml"]);
    let check = String::from_utf8_lossy(&check.stdout).into_owned();
    assert!(
        check.contains("in coordinates of a spanning tree"),
        "{check}"
    );
    assert_eq!(one.len(), two.len());
    for (column, name) in head.iter().enumerate() {
        let size = one.iter().map(|row| row[column].abs()).fold(0.0, f64::max);
        // What tells how well it was done, and notes.
        if size < 1e-9 || name == "note" {
            continue;
        }
        for (a, b) in one.iter().zip(&two) {
            let off = (a[column] - b[column]).abs();
            assert!(
                off <= 1e-8 * size,
                "{name}: {} and {}",
                a[column],
                b[column]
            );
        }
    }
}

#[test]
fn what_a_spanning_tree_cannot_do_is_refused_with_what_to_do() {
    let folder = folder();
    let at = folder.path();
    let model = "units = { length = \"mm\" }\n[links]\nframe = { O = [0, 0], X = [200, 0], Y = [0, 200] }\n\
        rod = { P-Q = 100, mass = 1, inertia = 0 }\n[joints]\na = { pin = \"P\", on = \"O -> X\" }\n\
        [drives]\nturn = { turns = \"rod\", at = 30 }\nshift = { slides = \"a\", at = 50 }\n\
        [studies.s]\nkind = \"simulate\"\nuntil = \"10 ms\"\ncoordinates = \"tree\"\n";
    fs::write(at.join("m.toml"), model).expect("written");
    let told = said(&kempe(at, &["check", "m.toml"]));
    assert!(told.contains("spanning-tree"), "{told}");
    let model = model.replace("\"tree\"", "\"spanning-tree\"");
    fs::write(at.join("m.toml"), model).expect("written");
    let output = kempe(at, &["run", "m.toml"]);
    assert!(output.status.success(), "{}", said(&output));
}
