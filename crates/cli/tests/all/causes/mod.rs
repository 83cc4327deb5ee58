//! Causes of wrong answers that were found and mended, each with variants, as the program meets them.
//!
//! What is held elsewhere is not repeated here:
//!
//! | cause | where it is held |
//! |---|---|
//! | numbers over narrow features, cards and knots of laws | `numbers.rs`; `crates/measure/tests/all/narrow.rs`, `crates/study/tests/all/forces.rs`, `crates/model/src/law.rs` |
//! | poles of a mechanical advantage; means of what is fast, weakly infinite or divergent | `numbers.rs`; `crates/measure/tests/all/narrow.rs` |
//! | `check` and `run` of motions with a limit, that run away, or are too long | `answers.rs`; `one_voice.rs` |
//! | what part of the demanded range is proved, and what is left for want of work | `answers.rs`; `crates/proof/tests/certify.rs` |
//! | links upon each other, nearly redundant bars, locked groups | `assembling.rs`; `crates/study/tests/all/motion.rs` |
//! | near and exact change points, starts on them | `starting.rs`; `crates/motion/tests/all/starts.rs`, `limits.rs` |
//! | circuits from a dead point | `starting.rs`; `crates/motion/tests/all/circuits.rs` |
//! | self-locking | `numbers.rs`; `crates/dynamics/tests/all/joints.rs` |
//! | large blocks in little time (by counted work) | `crates/motion/tests/all/large_blocks.rs` |
//! | the reach where a drive is held | `answers.rs` |
//! | racks without teeth in pictures | `answers.rs` |
//! | a run and its own input | `nothing_lost.rs` |
//! | sizes that cannot be computed with | `crates/study/tests/all/scale.rs`, `crates/model/tests/bad/out-of-range.toml`, `table-values.cells.toml` |
//! | derivatives that are not there, open choices, missed hints, open chains | `one_voice.rs` |
//! | terminal escapes, pivots misspelt | `messages.rs` |
//! | a load at a pin of rod and piston | `crates/study/tests/all/forces.rs` |
//! | brackets, decimal commas, pictures as numbers | `crates/model/tests/bad/toml-syntax.*.toml`, `not-a-value.picture.toml` |

#![allow(clippy::disallowed_methods)]

mod answers;
mod assembling;
mod numbers;
mod starting;
use crate::support;

use std::collections::BTreeMap;
use std::fs;

use serde_json::Value;

/// The head of a file in millimetres and degrees.
const HEAD: &str = "units = { length = \"mm\", angle = \"deg\" }\n";

/// A crank-rocker in a file, with what else it has.
fn crank_rocker(rest: &str) -> String {
    format!(
        "{HEAD}[links]\nframe = {{ A = [0, 0], D = [60, 0] }}\ncrank = {{ A-B = 20 }}\n\
         coupler = {{ B-C = 50, P = [25, 10] }}\nrocker = {{ D-C = 40 }}\n\
         [drives]\nm = {{ turns = \"crank\", from = 0, to = 360, speed = \"5 rad/s\" }}\n\
         [assembly]\nC = \"left of B -> D\"\n{rest}"
    )
}

/// A slider-crank in a file, driven by its crank, with what else it has.
fn slider_crank(drive: &str, links: &str, rest: &str) -> String {
    format!(
        "{HEAD}[links]\nframe = {{ O = [0, 0], G = [300, 0] }}\ncrank = {{ O-A = 50 }}\n{links}\n\
         rod = {{ A-B = 150 }}\nblock = {{ B = [0, 0] }}\n\
         [joints]\nbore = {{ slider = \"block\", at = \"B\", on = \"O -> G\" }}\n\
         [drives]\nm = {{ {drive}, speed = \"1 rad/s\" }}\n[assembly]\nB = {{ near = [200, 0] }}\n{rest}"
    )
}

/// What a command with `--json` answers.
struct Answer {
    folder: tempfile::TempDir,
    value: Value,
    exit: i32,
}

/// Asks the program about a model, with tables beside it. A command that writes, writes into `out`.
fn ask(arguments: &[&str], model: &str, tables: &[(&str, &str)]) -> Answer {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("m.toml"), model).expect("written");
    for (name, text) in tables {
        fs::write(folder.path().join(name), text).expect("written");
    }
    let mut all = arguments.to_vec();
    all.extend(["m.toml", "--json"]);
    if arguments[0] == "run" {
        all.extend(["--out", "out"]);
    }
    let output = support::kempe(folder.path(), &all);
    let value = serde_json::from_slice(&output.stdout)
        .unwrap_or_else(|e| panic!("{e}: {}\n{model}", support::said(&output)));
    let exit = output.status.code().expect("it ends by itself");
    Answer {
        folder,
        value,
        exit,
    }
}

fn check(model: &str) -> Answer {
    ask(&["check"], model, &[])
}

fn run(model: &str) -> Answer {
    ask(&["run"], model, &[])
}

impl Answer {
    fn diagnostics(&self) -> impl Iterator<Item = &Value> {
        let told = self.value["diagnostics"].as_array();
        told.expect("a list").iter()
    }

    fn codes(&self) -> Vec<&str> {
        self.diagnostics()
            .filter_map(|d| d["code"].as_str())
            .collect()
    }

    /// All that is told, as one text.
    fn words(&self) -> String {
        self.diagnostics().map(|d| format!("{d}\n")).collect()
    }

    /// The numbers over the motion of the first study.
    fn numbers(&self) -> BTreeMap<&str, f64> {
        let values = self.value["studies"][0]["values"].as_array();
        values
            .into_iter()
            .flatten()
            .filter_map(|v| Some((v["name"].as_str()?, v["value"].as_f64()?)))
            .collect()
    }

    /// The rows of a study's table, by the heads of their columns without units.
    fn rows(&self, study: &str) -> Vec<BTreeMap<String, String>> {
        let path = self.folder.path().join(format!("out/{study}.csv"));
        let text = fs::read_to_string(path).expect("a table");
        let mut lines = text.lines().map(cells);
        let heads: Vec<String> = (lines.next().expect("heads").iter())
            .map(|h| h.split(" [").next().unwrap_or(h).to_owned())
            .collect();
        lines
            .map(|cells| heads.iter().cloned().zip(cells).collect())
            .collect()
    }

    /// A column of a table; cells without a number are left out.
    fn column(&self, study: &str, name: &str) -> Vec<f64> {
        let rows = self.rows(study);
        assert!(rows.iter().all(|r| r.contains_key(name)), "no {name}");
        rows.iter().filter_map(|r| r[name].parse().ok()).collect()
    }
}

/// The cells of a line, in quotes where they hold commas.
fn cells(line: &str) -> Vec<String> {
    let mut cells = vec![String::new()];
    let mut quoted = false;
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(String::new()),
            c => cells.last_mut().expect("one at least").push(c),
        }
    }
    cells
}
